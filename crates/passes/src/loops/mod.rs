//! Loops as machine code likes them: what they do, they do in the same order as before.
//!
//! * `fill`: a loop that makes an array 0 is a `clear`.
//! * `rotate`: `WHILE` looks at its condition once before the loop and then at the end of each round.
//! * `unroll`: the body of a short loop whose rounds are counted is written several times.

mod fill;
mod rotate;
mod unroll;

use crate::fold::{Regions, fold_function};
use crate::rewrite::goes_back;
use iecc_ir::analysis::{Cfg, Dominators, LocalRanges, Loops};
use iecc_ir::{Function, Module, TypeTable};

/// Rewrites the loops of every function, and folds where that changed something.
pub(crate) fn loops(module: &mut Module) {
    let regions = Regions::of(module);
    for func in module.funcs.values_mut() {
        if goes_back(func) && rewrite(&module.types, regions, func) {
            fold_function(&module.types, regions, func);
        }
    }
}

fn rewrite(types: &TypeTable, regions: Regions, func: &mut Function) -> bool {
    let mut known = Known::of(func);
    if known.loops.is_empty() {
        return false;
    }
    let filled = fill::fill(types, regions, func, &known.loops, &known.ranges);
    if filled {
        known = Known::of(func);
    }
    let rotated = rotate::rotate(func, &known.cfg, &known.loops);
    if rotated {
        known = Known::of(func);
    }
    let unrolled = unroll::unroll(func, &known.loops, &known.ranges);
    rotated || filled || unrolled
}

/// A function as it stands.
struct Known {
    cfg: Cfg,
    loops: Loops,
    ranges: LocalRanges,
}

impl Known {
    fn of(func: &Function) -> Self {
        let cfg = Cfg::new(func);
        let dominators = Dominators::new(&cfg);
        let loops = Loops::new(&cfg, &dominators);
        let ranges = LocalRanges::new(func, &cfg, &dominators, &loops);
        Self { cfg, loops, ranges }
    }
}
