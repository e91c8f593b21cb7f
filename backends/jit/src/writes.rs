//! Which bytes of state and outputs a scan may change: what must be kept to undo a scan that a fault
//! abandons.
//!
//! An over-estimate. An index that the program computes stands for the whole array, and a function
//! that writes through a reference for all that the reference stands for.

use crate::plan::Plan;
use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::{
    FuncId, Function, Index, InstData, Layout, MemType, Module, Place, Projection, RefParam, Root,
};
use std::collections::BTreeMap;

/// Most pieces that are saved one by one; above, neighbours are joined.
const MAX_SPANS: usize = 16;

/// Pieces with less than this between them are one.
const SMALLEST_GAP: u64 = 32;

/// A region that a scan writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Target {
    State,
    Output,
}

/// Some bytes of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Span {
    pub(crate) target: Target,
    pub(crate) offset: u64,
    pub(crate) len: u64,
}

/// What a scan may change.
#[derive(Debug, Default)]
pub(crate) struct Writes {
    /// Length by start, for each region; pieces may overlap.
    pieces: BTreeMap<(Target, u64), u64>,
}

impl Writes {
    /// Looks at every function of the plan.
    pub(crate) fn new(module: &Module, layout: &Layout, plan: &Plan) -> Self {
        let (mut writes, whole) = (Self::default(), Place::root(Root::State));
        let mut through = SecondaryMap::<FuncId, EntitySet<RefParam>>::new();
        for &id in &plan.order {
            let func = &module.funcs[id];
            for place in written_places(func, &through) {
                match place.root {
                    Root::State => writes.add(module, layout, Target::State, place),
                    Root::Output => writes.add(module, layout, Target::Output, place),
                    Root::Input => panic!("inputs are read-only"),
                    Root::Local(_) => {}
                    // Anywhere in the state.
                    Root::Deref { .. } => writes.add(module, layout, Target::State, &whole),
                    Root::Ref(param) => {
                        through[id].insert(param);
                    }
                }
            }
        }
        writes
    }

    fn add(&mut self, module: &Module, layout: &Layout, target: Target, place: &Place) {
        let region = match target {
            Target::State => module.state,
            Target::Output => module.output,
        };
        let (offset, len) = extent(module, layout, MemType::Struct(region), &place.path);
        let known = self.pieces.entry((target, offset)).or_insert(0);
        *known = len.max(*known);
    }

    /// The pieces without overlap, in order, and few of them.
    pub(crate) fn spans(&self) -> Vec<Span> {
        let mut gap = SMALLEST_GAP;
        loop {
            let spans = self.joined(gap);
            if spans.len() <= MAX_SPANS {
                return spans;
            }
            gap *= 2;
        }
    }

    fn joined(&self, gap: u64) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for (&(target, offset), &len) in &self.pieces {
            match spans.last_mut() {
                Some(last) if last.target == target && offset <= last.offset + last.len + gap => {
                    last.len = last.len.max(offset + len - last.offset);
                }
                Some(_) | None => spans.push(Span {
                    target,
                    offset,
                    len,
                }),
            }
        }
        spans
    }
}

/// The places a function writes, itself or through references it passes on.
fn written_places<'f>(
    func: &'f Function,
    through: &SecondaryMap<FuncId, EntitySet<RefParam>>,
) -> Vec<&'f Place> {
    let mut places = Vec::new();
    let insts = func.layout.iter().flat_map(|&b| &func.block(b).insts);
    for &inst in insts {
        match func.inst(inst) {
            InstData::Store { place, .. }
            | InstData::Copy { to: place, .. }
            | InstData::Clear { place }
            | InstData::Elapsed { place, .. } => places.push(place),
            InstData::Call { func, refs, .. } => {
                let written = |index: &usize| {
                    through[*func].contains(cranelift_entity::EntityRef::new(*index))
                };
                places.extend((0..refs.len()).filter(written).map(|index| &refs[index]));
            }
            InstData::Const { .. }
            | InstData::Unary { .. }
            | InstData::Binary { .. }
            | InstData::Compare { .. }
            | InstData::Convert { .. }
            | InstData::Select { .. }
            | InstData::Load { .. }
            | InstData::Address { .. }
            | InstData::Now
            | InstData::Step { .. } => {}
        }
    }
    places
}

/// The bytes a path can lead to.
fn extent(module: &Module, layout: &Layout, start: MemType, path: &[Projection]) -> (u64, u64) {
    let types = &module.types;
    let is_static = |step: &Projection| match step {
        Projection::Field(_) | Projection::Index(Index::Const(_)) => true,
        Projection::Index(Index::Value(_)) | Projection::Bit(_) => false,
    };
    let end = path.iter().position(|step| !is_static(step));
    let path = &path[..end.unwrap_or(path.len())];
    let (offset, ty, _) = layout.resolve(types, start, path);
    (offset, layout.size(types, ty))
}
