//! What calls may touch, by function.

use crate::functions::callees_first;
use cranelift_entity::SecondaryMap;
use iecc_ir::{FuncId, Function, InstData, Module, Place, Projection, Root};
use std::collections::BTreeSet;

/// What a function and its callees touch, other than through references.
#[derive(Debug, Clone, Default)]
pub(super) struct Summary {
    /// Fields of the state.
    pub(super) state: BTreeSet<u32>,
    /// Whether it passes on or moves the state as a whole, or follows addresses in it.
    pub(super) whole_state: bool,
    /// Whether it stores outputs.
    pub(super) outputs: bool,
}

/// The summaries of all functions that are called.
#[derive(Debug)]
pub(super) struct Summaries(SecondaryMap<FuncId, Summary>);

impl Summaries {
    pub(super) fn of(module: &Module) -> Self {
        let mut summaries = Self(SecondaryMap::new());
        for id in callees_first(module) {
            summaries.0[id] = summaries.summary(&module.funcs[id]);
        }
        summaries
    }

    /// What a call of the function touches.
    pub(super) fn call(&self, func: FuncId) -> &Summary {
        &self.0[func]
    }

    fn summary(&self, func: &Function) -> Summary {
        let mut summary = Summary::default();
        let blocks = func.layout.iter().map(|&block| func.block(block));
        for &inst in blocks.flat_map(|block| &block.insts) {
            let data = func.inst(inst);
            data.places()
                .into_iter()
                .for_each(|place| summary.touch(place));
            if let InstData::Call { func, .. } = data {
                summary.whole_state |= self.0[*func].whole_state;
                summary.state.extend(&self.0[*func].state);
                summary.outputs |= self.0[*func].outputs;
            }
        }
        summary
    }
}

impl Summary {
    fn touch(&mut self, place: &Place) {
        match (place.root, place.path.first()) {
            (Root::State, Some(Projection::Field(field))) => {
                self.state.insert(*field);
            }
            (Root::State | Root::Deref { .. }, _) => self.whole_state = true,
            (Root::Output, _) => self.outputs = true,
            (Root::Input | Root::Ref(_) | Root::Local(_), _) => {}
        }
    }
}
