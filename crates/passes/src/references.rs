//! Which reference parameters surely refer to something.
//!
//! A reference to an array element by index value may be to no element: then a load gives 0 and a
//! store does nothing, so what was stored cannot be assumed to be there.

use crate::functions::callees_first;
use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::{FuncId, InstData, Module, Place, RefParam, Root};

/// The references of each function that some call may bind to nothing.
#[derive(Debug)]
pub(crate) struct References(SecondaryMap<FuncId, EntitySet<RefParam>>);

impl References {
    /// Looks at all calls, callers before callees.
    pub(crate) fn of(module: &Module) -> Self {
        let mut uncertain: SecondaryMap<FuncId, EntitySet<RefParam>> = SecondaryMap::new();
        for caller in callees_first(module).into_iter().rev() {
            let func = &module.funcs[caller];
            let blocks = func.layout.iter().map(|&block| func.block(block));
            for &inst in blocks.flat_map(|block| &block.insts) {
                let InstData::Call {
                    func: callee, refs, ..
                } = func.inst(inst)
                else {
                    continue;
                };
                let params = module.funcs[*callee].refs.keys();
                for (param, place) in params.zip(refs) {
                    if !is_certain(&uncertain[caller], place) {
                        uncertain[*callee].insert(param);
                    }
                }
            }
        }
        Self(uncertain)
    }

    /// Whether a root of a function is memory in every call.
    pub(crate) fn certain(&self, func: FuncId, root: Root) -> bool {
        is_certain(&self.0[func], &Place::root(root))
    }
}

fn is_certain(uncertain: &EntitySet<RefParam>, place: &Place) -> bool {
    let root = match place.root {
        Root::State | Root::Input | Root::Output | Root::Local(_) => true,
        Root::Deref { .. } => false,
        Root::Ref(param) => !uncertain.contains(param),
    };
    root && place.is_static()
}
