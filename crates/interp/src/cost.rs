//! An upper bound of the fuel a scan takes, to know whether it can run out.

use iecc_ir::analysis::{Cfg, Dominators, Loops};
use iecc_ir::{FuncId, Function, InstData, Module};
use std::collections::{BTreeMap, BTreeSet};

/// The fuel one pass through a block takes, without that of the functions it calls.
pub(crate) fn block_cost(instructions: usize) -> u64 {
    instructions as u64 + 1
}

/// The most fuel a scan can take; `u64::MAX` if it contains a loop.
pub(crate) fn worst_case_cost(module: &Module) -> u64 {
    let mut costs = BTreeMap::new();
    let mut stack = vec![module.scan];
    // The call graph is acyclic: a function is done once its callees are.
    while let Some(&id) = stack.last() {
        let func = &module.funcs[id];
        let open = callees(func).filter(|id| !costs.contains_key(id));
        let open: BTreeSet<FuncId> = open.collect();
        if costs.contains_key(&id) {
            stack.pop();
        } else if open.is_empty() {
            costs.insert(id, function_cost(func, &costs));
        } else {
            stack.extend(open);
        }
    }
    costs[&module.scan]
}

/// Every block once: without loops no way through the function is longer.
fn function_cost(func: &Function, costs: &BTreeMap<FuncId, u64>) -> u64 {
    let cfg = Cfg::new(func);
    if !Loops::new(&cfg, &Dominators::new(&cfg)).is_empty() {
        return u64::MAX;
    }
    let blocks = func
        .layout
        .iter()
        .map(|&b| block_cost(func.block(b).insts.len()));
    let calls = callees(func).map(|callee| costs[&callee]);
    blocks.chain(calls).fold(0, u64::saturating_add)
}

/// The callee of every call, in order, as often as it is called.
fn callees(func: &Function) -> impl Iterator<Item = FuncId> {
    let insts = func
        .layout
        .iter()
        .flat_map(|&block| &func.block(block).insts);
    insts.filter_map(|&inst| match func.inst(inst) {
        InstData::Call { func, .. } => Some(*func),
        InstData::Const { .. }
        | InstData::Unary { .. }
        | InstData::Binary { .. }
        | InstData::Compare { .. }
        | InstData::Convert { .. }
        | InstData::Select { .. }
        | InstData::Load { .. }
        | InstData::Store { .. }
        | InstData::Now
        | InstData::Elapsed { .. }
        | InstData::Step { .. } => None,
    })
}
