//! Numbers that the loops and branches of a function decide: an index that counts within its array
//! is not compared with its bounds, nor the rounds of a loop that ends with their limit; and what a counter is
//! behind its loop is a constant, if it is the same always.

use crate::rewrite::goes_back;
use iecc_ir::analysis::{Cfg, Dominators, LocalRanges, Loops};
use iecc_ir::{Block, Function, InstData, Module, Terminator, Value};

/// Replaces decided numbers by constants, in functions with loops.
pub(crate) fn bounds(module: &mut Module) {
    let with_loops = |func: &&mut Function| goes_back(func);
    for func in module.funcs.values_mut().filter(with_loops) {
        let cfg = Cfg::new(func);
        let dominators = Dominators::new(&cfg);
        let loops = Loops::new(&cfg, &dominators);
        if !loops.is_empty() {
            let ranges = LocalRanges::new(func, &cfg, &dominators, &loops);
            for &block in cfg.reverse_postorder() {
                results(func, &ranges, block);
                arguments(func, &ranges, block);
            }
        }
    }
}

/// Decided comparisons.
fn results(func: &mut Function, ranges: &LocalRanges, block: Block) {
    for inst in func.block(block).insts.clone() {
        if !matches!(func.inst(inst), InstData::Compare { .. }) {
            continue;
        }
        let result = func.result(inst);
        if let Some(bit) = ranges.at(func, result, block).as_constant() {
            let (ty, bits) = (func.value_type(result), bit as u64);
            *func.inst_mut(inst) = InstData::Const { ty, bits };
        }
    }
}

/// What is passed to other blocks and is the same always.
fn arguments(func: &mut Function, ranges: &LocalRanges, block: Block) {
    let mut terminator = func.terminator(block).clone();
    if !matches!(terminator, Terminator::Brif { .. } | Terminator::Jump(_)) {
        return;
    }
    let mut changed = false;
    for target in terminator.targets_mut() {
        let to = target.block;
        for arg in &mut target.args {
            if func.value_type(*arg).is_int() && func.constant(*arg).is_none() {
                let range = ranges.on_way(func, *arg, block, to);
                if let Some(number) = range.as_constant() {
                    *arg = constant(func, block, *arg, number);
                    changed = true;
                }
            }
        }
    }
    if changed {
        let origin = func.block(block).terminator_origin;
        func.set_terminator(block, terminator, origin);
    }
}

/// A constant of the type of a value, at the end of a block.
fn constant(func: &mut Function, block: Block, like: Value, number: i64) -> Value {
    let ty = func.value_type(like);
    let bits = number as u64 & ty.mask();
    let inst = func.append_inst(block, InstData::Const { ty, bits }, &[ty], None);
    func.result(inst)
}
