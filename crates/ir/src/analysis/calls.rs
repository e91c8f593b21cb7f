//! The order of functions in which each comes behind those it calls.

use crate::{FuncId, Module};
use cranelift_entity::EntitySet;
use std::collections::BTreeSet;

/// Functions that some roots lead to, callees before callers. Functions do not call themselves, and
/// chains of calls may be deep: the stack is our own.
pub fn callees_first(module: &Module, roots: impl IntoIterator<Item = FuncId>) -> Vec<FuncId> {
    let callees = |id: FuncId| {
        let called: BTreeSet<FuncId> = module.funcs[id].calls().collect();
        called.into_iter()
    };
    let (mut order, mut seen) = (Vec::new(), EntitySet::<FuncId>::new());
    for root in roots {
        let mut path = Vec::new();
        if seen.insert(root) {
            path.push((root, callees(root)));
        }
        while let Some((func, rest)) = path.last_mut() {
            match rest.next() {
                Some(callee) if seen.insert(callee) => path.push((callee, callees(callee))),
                Some(_) => {}
                None => {
                    order.push(*func);
                    path.pop();
                }
            }
        }
    }
    order
}
