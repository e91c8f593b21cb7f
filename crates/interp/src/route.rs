//! Places prepared for execution: a byte offset, and a stride for every index known only then.

use cranelift_entity::SecondaryMap;
use iecc_ir::{
    FuncId, Function, Index, Inst, InstData, Layout, MemType, Module, Place, Projection, Root,
    Type, Value,
};

/// A step over array elements by an index known at run time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stride {
    pub(crate) index: Value,
    pub(crate) len: u32,
    pub(crate) bytes: u64,
}

/// How to reach a place.
#[derive(Debug, Clone)]
pub(crate) struct Route {
    pub(crate) root: Root,
    /// Of all fields and constant indices together.
    pub(crate) offset: u64,
    pub(crate) strides: Vec<Stride>,
    /// What lies there, or holds the bit.
    pub(crate) ty: MemType,
    pub(crate) bit: Option<Index>,
}

impl Route {
    fn new(module: &Module, layout: &Layout, func: &Function, place: &Place) -> Self {
        let start = module.root_type(func, place.root);
        let mut route = Self {
            root: place.root,
            offset: 0,
            strides: Vec::new(),
            ty: start.expect("verified roots exist"),
            bit: None,
        };
        for &step in &place.path {
            route.follow(module, layout, step);
        }
        route
    }

    fn follow(&mut self, module: &Module, layout: &Layout, step: Projection) {
        match (self.ty, step) {
            (MemType::Struct(id), Projection::Field(field)) => {
                self.offset += layout.field_offset(id, field);
                self.ty = module.types.structs[id].fields[field as usize].ty;
            }
            (MemType::Array(id), Projection::Index(index)) => {
                let array = module.types.array_type(id);
                let bytes = layout.size(&module.types, array.element);
                self.ty = array.element;
                match index {
                    Index::Const(index) => self.offset += u64::from(index) * bytes,
                    Index::Value(index) => self.strides.push(Stride {
                        index,
                        len: array.len,
                        bytes,
                    }),
                }
            }
            (MemType::Scalar(_), Projection::Bit(bit)) => self.bit = Some(bit),
            (MemType::Struct(_) | MemType::Array(_) | MemType::Scalar(_), _) => {
                panic!("verified places follow their types")
            }
        }
    }

    /// The type of the scalar at the end, or of the one that holds the bit.
    pub(crate) fn scalar(&self) -> Type {
        match self.ty {
            MemType::Scalar(ty) => ty,
            MemType::Struct(_) | MemType::Array(_) => {
                panic!("verified loads and stores are scalar")
            }
        }
    }
}

/// The routes of all places of a module: one of a load, store or `elapsed`, one per reference of a
/// call.
#[derive(Debug)]
pub(crate) struct Routes(SecondaryMap<FuncId, SecondaryMap<Inst, Vec<Route>>>);

impl Routes {
    pub(crate) fn new(module: &Module) -> Self {
        let layout = Layout::new(&module.types);
        let mut routes = Self(SecondaryMap::new());
        for (id, func) in module.funcs.iter() {
            let insts = func
                .layout
                .iter()
                .flat_map(|&block| &func.block(block).insts);
            for &inst in insts {
                let places = places(func.inst(inst)).iter();
                routes.0[id][inst] = places
                    .map(|place| Route::new(module, &layout, func, place))
                    .collect();
            }
        }
        routes
    }

    pub(crate) fn of(&self, func: FuncId, inst: Inst) -> &[Route] {
        &self.0[func][inst]
    }
}

fn places(inst: &InstData) -> &[Place] {
    match inst {
        InstData::Load { place }
        | InstData::Store { place, .. }
        | InstData::Elapsed { place, .. } => std::slice::from_ref(place),
        InstData::Call { refs, .. } => refs,
        InstData::Const { .. }
        | InstData::Unary { .. }
        | InstData::Binary { .. }
        | InstData::Compare { .. }
        | InstData::Convert { .. }
        | InstData::Select { .. }
        | InstData::Now
        | InstData::Step { .. } => &[],
    }
}
