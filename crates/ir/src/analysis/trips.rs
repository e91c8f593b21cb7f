//! How often loops go round.
//!
//! A counted loop has a number that grows (or shrinks) by a step each time, and a comparison of it that
//! every round passes and that leaves the loop. What the comparison allows, divided by the smallest step, bounds the
//! rounds; and each round adds to other numbers what one round adds.

use super::{Cfg, Dominators, LocalRanges, Loop, Loops, Range};
use crate::{BinaryOp, Block, CompareOp, Function, InstData, Terminator, Type, Value, ValueDef};
use std::collections::BTreeMap;

/// How often a loop goes back to its header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Trips {
    /// At most so often each time the loop is entered.
    pub most: u64,
    /// It does so exactly, unless a fault ends the scan.
    pub is_exact: bool,
}

/// What ends a loop, as values that are known before it: it goes back as often as `step` fits between what `param`
/// is at first and `limit`. Nothing else ends it, but for a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counted {
    /// The parameter of the header that counts.
    pub param: Value,
    /// What is added or taken away in a round; never 0.
    pub step: Value,
    /// Where it ends.
    pub limit: Value,
    /// Whether it grows.
    pub grows: bool,
    /// Whether the limit itself ends the loop.
    pub excludes_limit: bool,
    /// Whether the comparison looks at what the parameter is, not at what it becomes: then there is a round
    /// for the first number, too.
    pub counts_first: bool,
}

/// A parameter of a header, and what it becomes from round to round: always by adding.
struct Counter {
    first: Range,
    /// What the latches pass.
    next: Value,
    step: Range,
    /// What is added, or taken away.
    by: Value,
}

impl Counter {
    fn of(
        func: &Function,
        cfg: &Cfg,
        ranges: &LocalRanges,
        each: &Loop,
        param: Value,
    ) -> Option<Self> {
        let ValueDef::Param(header, index) = func.value_def(param) else {
            return None;
        };
        let (mut first, mut next): (Option<Range>, Option<Value>) = (None, None);
        for &from in cfg
            .predecessors(header)
            .iter()
            .filter(|&&b| cfg.is_reachable(b))
        {
            for target in func.terminator(from).targets() {
                if target.block != header {
                    continue;
                }
                let arg = target.args[index as usize];
                if each.blocks.contains(&from) {
                    if next.is_some_and(|next| next != arg) {
                        return None;
                    }
                    next = Some(arg);
                } else {
                    let range = ranges.at(func, arg, from);
                    first = Some(first.map_or(range, |first| first.union(range)));
                }
            }
        }
        let (first, next) = (first?, next?);
        let (step, by) = step(func, ranges, param, next)?;
        Some(Self {
            first,
            next,
            step,
            by,
        })
    }
}

/// What is added to a parameter in a round.
fn step(
    func: &Function,
    ranges: &LocalRanges,
    param: Value,
    next: Value,
) -> Option<(Range, Value)> {
    let Some(InstData::Binary { op, args: [a, b] }) = func.def_inst(next) else {
        return None;
    };
    if *op == BinaryOp::Add && (*a == param || *b == param) {
        let by = if *a == param { *b } else { *a };
        return Some((ranges.base(func, by), by));
    }
    if *op == BinaryOp::Sub && *a == param {
        let range = ranges.base(func, *b);
        let negated = Range::new(range.hi.checked_neg()?, range.lo.checked_neg()?);
        return Some((negated, *b));
    }
    None
}

/// How often a loop goes back to its header, if a comparison bounds that.
pub(super) fn of(
    func: &Function,
    cfg: &Cfg,
    dominators: &Dominators,
    ranges: &LocalRanges,
    each: &Loop,
) -> Option<(Trips, Option<Counted>)> {
    let exits = exits(func, cfg, each);
    let always = |block: Block| {
        each.latches
            .iter()
            .all(|&latch| dominators.dominates(block, latch))
    };
    let bounds = exits.iter().filter(|&&block| always(block));
    let bounds = bounds.filter_map(|&block| bound(func, cfg, ranges, each, block));
    let (mut trips, counted) = bounds.min_by_key(|(trips, _)| trips.most)?;
    let is_only_exit = exits.len() == 1;
    trips.is_exact &= is_only_exit;
    Some((trips, counted.filter(|_| is_only_exit)))
}

/// Blocks from which the loop can be left, but for a fault.
fn exits(func: &Function, cfg: &Cfg, each: &Loop) -> Vec<Block> {
    let leaves = |to: &&Block| {
        let is_fault = matches!(func.terminator(**to), Terminator::Fault(_));
        !each.blocks.contains(to) && !is_fault
    };
    let blocks = each.blocks.iter().copied();
    let has_exit = |&block: &Block| {
        let is_return = matches!(func.terminator(block), Terminator::Return(_));
        is_return || cfg.successors(block).iter().any(|to| leaves(&to))
    };
    blocks.filter(has_exit).collect()
}

/// The rounds that the branch at the end of a block allows.
fn bound(
    func: &Function,
    cfg: &Cfg,
    ranges: &LocalRanges,
    each: &Loop,
    block: Block,
) -> Option<(Trips, Option<Counted>)> {
    let Terminator::Brif {
        cond,
        then,
        otherwise,
    } = func.terminator(block)
    else {
        return None;
    };
    let stays = [then, otherwise].map(|target| each.blocks.contains(&target.block));
    let Some(InstData::Compare { op, args }) = func.def_inst(*cond) else {
        return None;
    };
    let op = match stays {
        [true, false] => *op,
        [false, true] => op.inverted()?,
        [true, true] | [false, false] => return None,
    };
    for &param in &func.block(each.header).params {
        if !func.value_type(param).is_int() {
            continue;
        }
        let Some(counter) = Counter::of(func, cfg, ranges, each, param) else {
            continue;
        };
        for (op, [x, limit]) in [(op, *args), (op.swapped(), [args[1], args[0]])] {
            if x == param || x == counter.next {
                let last = ranges.at(func, limit, block);
                let ty = Range::of_type(func.value_type(param));
                if let Some(trips) = rounds(&counter, op, last, ty, x == param) {
                    let counted = Counted {
                        param,
                        step: counter.by,
                        limit,
                        grows: counter.step.lo > 0,
                        excludes_limit: matches!(op, CompareOp::Slt | CompareOp::Sgt),
                        counts_first: x == param,
                    };
                    let known = [counted.step, limit]
                        .iter()
                        .all(|&v| is_outside(func, each, v));
                    return Some((trips, known.then_some(counted)));
                }
            }
        }
    }
    None
}

/// Whether a value is the same in all rounds.
fn is_outside(func: &Function, each: &Loop, value: Value) -> bool {
    if func.constant(value).is_some() {
        return true;
    }
    match func.value_def(value) {
        ValueDef::Param(block, _) => !each.blocks.contains(&block),
        ValueDef::Result(inst, _) => {
            let inside = |&block: &Block| func.block(block).insts.contains(&inst);
            !each.blocks.iter().any(inside)
        }
    }
}

/// The rounds of a counter while `x op limit`, where x is what it is in the round or, else, what it becomes.
fn rounds(
    counter: &Counter,
    op: CompareOp,
    limit: Range,
    ty: Range,
    is_first: bool,
) -> Option<Trips> {
    let step = counter.step;
    // How far the last number is for which the loop goes on, and whether the one behind it exists.
    let is_below = matches!(op, CompareOp::Slt | CompareOp::Sle) && step.lo > 0;
    let is_above = matches!(op, CompareOp::Sgt | CompareOp::Sge) && step.hi < 0;
    let excluded = i128::from(matches!(op, CompareOp::Slt | CompareOp::Sgt));
    let (distance, fits) = if is_below {
        let last = i128::from(limit.hi) - excluded;
        let end = last.max(counter.first.hi.into()) + i128::from(step.hi);
        (last - i128::from(counter.first.lo), end <= ty.hi.into())
    } else if is_above {
        let last = i128::from(limit.lo) + excluded;
        let end = last.min(counter.first.lo.into()) + i128::from(step.lo);
        (i128::from(counter.first.hi) - last, end >= ty.lo.into())
    } else {
        return None;
    };
    if !fits {
        // It may wrap around and go on for ever.
        return None;
    }
    let smallest = i128::from(step.lo).abs().min(i128::from(step.hi).abs());
    let is_exact = [counter.first, step, limit]
        .iter()
        .all(|range| range.as_constant().is_some());
    let full = if distance < 0 {
        0
    } else {
        distance / smallest + i128::from(is_first)
    };
    Some(Trips {
        most: u64::try_from(full).ok()?,
        is_exact,
    })
}

/// What the counters of bounded loops can be at most, where that is less than is known.
pub(super) fn caps(
    func: &Function,
    cfg: &Cfg,
    ranges: &LocalRanges,
    loops: &Loops,
) -> BTreeMap<Value, Range> {
    let mut caps = BTreeMap::new();
    for each in &loops.natural {
        let Some(trips) = ranges.trips(each.header) else {
            continue;
        };
        for &param in &func.block(each.header).params {
            if !func.value_type(param).is_int() {
                continue;
            }
            let counter = Counter::of(func, cfg, ranges, each, param);
            let cap = counter.and_then(|counter| cap(&counter, trips, func.value_type(param)));
            let known = ranges.base(func, param);
            let smaller = cap.and_then(|cap| known.intersection(cap));
            if let Some(smaller) = smaller.filter(|&smaller| smaller != known) {
                caps.insert(param, smaller);
            }
        }
    }
    caps
}

/// What a counter can be after so many rounds, unless it may wrap around on the way.
fn cap(counter: &Counter, trips: Trips, ty: Type) -> Option<Range> {
    let most = i128::from(trips.most);
    let lo = i128::from(counter.first.lo) + most * i128::from(counter.step.lo.min(0));
    let hi = i128::from(counter.first.hi) + most * i128::from(counter.step.hi.max(0));
    let whole = Range::of_type(ty);
    let fits = lo >= whole.lo.into() && hi <= whole.hi.into();
    fits.then(|| Range::new(lo as i64, hi as i64))
}
