//! The call graph: callees before callers, and removal of functions nobody calls.

use cranelift_entity::{EntitySet, PrimaryMap, SecondaryMap, packed_option::PackedOption};
use iecc_ir::{FuncId, Function, InstData, Module};
use std::collections::BTreeSet;

/// Functions that `scan` and `prescan` lead to, callees before callers.
pub(crate) fn callees_first(module: &Module) -> Vec<FuncId> {
    let mut order = Vec::new();
    let mut seen = EntitySet::<FuncId>::new();
    let mut stack: Vec<(FuncId, Vec<FuncId>)> = Vec::new();
    for root in [Some(module.scan), module.prescan].into_iter().flatten() {
        if seen.insert(root) {
            stack.push((root, callees(&module.funcs[root])));
        }
        while let Some((func, rest)) = stack.last_mut() {
            match rest.pop() {
                Some(callee) if seen.insert(callee) => {
                    stack.push((callee, callees(&module.funcs[callee])));
                }
                Some(_) => {}
                None => {
                    order.push(*func);
                    stack.pop();
                }
            }
        }
    }
    order
}

fn callees(func: &Function) -> Vec<FuncId> {
    let called: BTreeSet<FuncId> = calls(func).collect();
    called.into_iter().rev().collect()
}

/// The callee of every call of a function, in layout order.
pub(crate) fn calls(func: &Function) -> impl Iterator<Item = FuncId> + '_ {
    let insts = func
        .layout
        .iter()
        .flat_map(|&block| &func.block(block).insts);
    insts.filter_map(|&inst| {
        let InstData::Call { func, .. } = func.inst(inst) else {
            return None;
        };
        Some(*func)
    })
}

/// The name, with as many primes as make it new.
pub(crate) fn unique(name: &str, taken: &BTreeSet<String>) -> String {
    let mut name = name.to_owned();
    while taken.contains(&name) {
        name.push('\'');
    }
    name
}

/// Drops the functions that neither `scan` nor `prescan` lead to.
pub(crate) fn remove_uncalled(module: &mut Module) {
    let mut called = EntitySet::<FuncId>::new();
    for id in callees_first(module) {
        called.insert(id);
    }
    if module.funcs.keys().all(|id| called.contains(id)) {
        return;
    }
    let mut new_ids: SecondaryMap<FuncId, PackedOption<FuncId>> = SecondaryMap::new();
    let mut kept: PrimaryMap<FuncId, Function> = PrimaryMap::new();
    for (id, func) in std::mem::take(&mut module.funcs) {
        if called.contains(id) {
            new_ids[id] = kept.push(func).into();
        }
    }
    let renamed = |id: FuncId| new_ids[id].expect("called functions are kept");
    for func in kept.values_mut() {
        rename_calls(func, renamed);
    }
    module.funcs = kept;
    module.scan = renamed(module.scan);
    module.prescan = module.prescan.map(renamed);
}

fn rename_calls(func: &mut Function, renamed: impl Fn(FuncId) -> FuncId) {
    for block in func.layout.clone() {
        for inst in func.block(block).insts.clone() {
            if let InstData::Call { func: callee, .. } = func.inst_mut(inst) {
                *callee = renamed(*callee);
            }
        }
    }
}
