//! The call graph: callees before callers, and removal of functions nobody calls.

use cranelift_entity::{EntitySet, PrimaryMap, SecondaryMap, packed_option::PackedOption};
use iecc_ir::{FuncId, Function, InstData, Module, analysis};
use std::collections::BTreeSet;

/// Functions that `scan` and `prescan` lead to, callees before callers.
pub(crate) fn callees_first(module: &Module) -> Vec<FuncId> {
    let roots = [Some(module.scan), module.prescan];
    analysis::callees_first(module, roots.into_iter().flatten())
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
