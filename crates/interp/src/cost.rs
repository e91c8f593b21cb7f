//! An upper bound of the fuel a scan takes, to know whether it can run out.

use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::{Cfg, Dominators, Loops, callees_first};
use iecc_ir::{Block, FuncId, Function, Layout, Module};
use std::collections::BTreeMap;

/// Bytes that are moved or made 0 at the cost of one instruction.
const BYTES_PER_FUEL: u64 = 64;

/// The fuel one pass through each block takes, without that of the functions it calls.
#[derive(Debug)]
pub(crate) struct Costs(SecondaryMap<FuncId, SecondaryMap<Block, u64>>);

impl Costs {
    /// Of every block of a module.
    pub(crate) fn new(module: &Module) -> Self {
        let layout = Layout::new(&module.types);
        let mut costs = Self(SecondaryMap::new());
        for (id, func) in module.funcs.iter() {
            for &block in &func.layout {
                let insts = &func.block(block).insts;
                let moved = insts
                    .iter()
                    .map(|&inst| layout.moved_bytes(module, func, func.inst(inst)) / BYTES_PER_FUEL)
                    .fold(0, u64::saturating_add);
                costs.0[id][block] = moved.saturating_add(insts.len() as u64 + 1);
            }
            let (_, local_bytes) = layout.locals(&module.types, func);
            costs.0[id][func.entry()] += local_bytes / BYTES_PER_FUEL;
        }
        costs
    }

    /// Of one block.
    pub(crate) fn of(&self, func: FuncId, block: Block) -> u64 {
        self.0[func][block]
    }
}

/// The most fuel a scan can take; `u64::MAX` if it contains a loop.
pub(crate) fn worst_case_cost(module: &Module, blocks: &Costs) -> u64 {
    let mut costs = BTreeMap::new();
    for id in callees_first(module, [module.scan]) {
        let cost = function_cost(id, &module.funcs[id], blocks, &costs);
        costs.insert(id, cost);
    }
    costs[&module.scan]
}

/// Every block once: without loops no way through the function is longer.
fn function_cost(
    id: FuncId,
    func: &Function,
    blocks: &Costs,
    costs: &BTreeMap<FuncId, u64>,
) -> u64 {
    let cfg = Cfg::new(func);
    if !Loops::new(&cfg, &Dominators::new(&cfg)).is_empty() {
        return u64::MAX;
    }
    let blocks = func.layout.iter().map(|&block| blocks.of(id, block));
    let calls = func.calls().map(|callee| costs[&callee]);
    blocks.chain(calls).fold(0, u64::saturating_add)
}
