//! Modules: regions, image, functions, names and origins.

use crate::{Function, Image, InstData, MemType, Place, Root, StructId, TypeTable};
use cranelift_entity::{PrimaryMap, entity_impl};
use iecc_source::Span;
use std::sync::Arc;

/// Names a function of a module.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FuncId(u32);
entity_impl!(FuncId, "func");

/// Names an entry of a module's table of origins.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Origin(u32);
entity_impl!(Origin, "origin");

/// Where code comes from, for messages and for comments in generated text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OriginData {
    /// For people: "MainProgram/MainRoutine rung 5".
    pub label: Arc<str>,
    /// The source text, when there is one.
    pub span: Option<Span>,
}

/// One of the three memory regions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Region {
    /// Kept from scan to scan.
    State,
    /// Latched before a scan.
    Input,
    /// Published after a scan.
    Output,
}

/// A controller.
#[derive(Debug, Clone)]
pub struct Module {
    /// Name; becomes the name of the hardware module or object file.
    pub name: String,
    /// Structs and arrays.
    pub types: TypeTable,
    /// Layout of the state region.
    pub state: StructId,
    /// Layout of the input region; the fields are the public inputs.
    pub input: StructId,
    /// Layout of the output region; the fields are the public outputs.
    pub output: StructId,
    /// Initial contents of the state region.
    pub image: Image,
    /// Functions; callees need not stand before callers.
    pub funcs: PrimaryMap<FuncId, Function>,
    /// The function of one scan: no parameters, no results.
    pub scan: FuncId,
    /// Runs once over the image before the first scan, with all inputs 0 and `now` 0.
    pub prescan: Option<FuncId>,
    /// Other names for places, as a user may spell them; sorted, unique ignoring ASCII case.
    pub names: Vec<(String, Place)>,
    /// Where code comes from.
    pub origins: PrimaryMap<Origin, OriginData>,
}

impl Module {
    /// The struct of a region.
    pub fn region(&self, region: Region) -> StructId {
        match region {
            Region::State => self.state,
            Region::Input => self.input,
            Region::Output => self.output,
        }
    }

    /// The type a root has inside a function.
    pub fn root_type(&self, func: &Function, root: Root) -> Option<MemType> {
        match root {
            Root::State => Some(MemType::Struct(self.state)),
            Root::Input => Some(MemType::Struct(self.input)),
            Root::Output => Some(MemType::Struct(self.output)),
            Root::Ref(param) => func.refs.get(param).map(|data| data.ty),
            Root::Local(local) => func.locals.get(local).map(|data| data.ty),
            Root::Deref { ty, .. } => Some(ty),
        }
    }

    /// Whether anything takes or follows addresses of the state. Then offsets in it mean something,
    /// and the types of its fields do not say how it is accessed.
    pub fn has_addresses(&self) -> bool {
        let deref = |place: &&Place| matches!(place.root, Root::Deref { .. });
        self.funcs.values().any(|func| {
            let blocks = func.layout.iter().map(|&block| func.block(block));
            blocks.flat_map(|block| &block.insts).any(|&inst| {
                let data = func.inst(inst);
                matches!(data, InstData::Address { .. }) || data.places().iter().any(deref)
            })
        })
    }

    /// The function with this name.
    pub fn func_named(&self, name: &str) -> Option<FuncId> {
        self.funcs
            .iter()
            .find(|(_, func)| func.name == name)
            .map(|(id, _)| id)
    }
}
