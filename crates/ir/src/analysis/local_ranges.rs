//! What the integers of one function can be, block by block, whatever memory and arguments hold.
//!
//! A fixpoint over the function: a parameter of a block can be what the jumps to the block pass. Behind a
//! branch its condition holds, so a value can be less there than where it was defined. Around a loop
//! a number that grows jumps to the next constant it is compared with, and then to the end of its type, so
//! few rounds do. Where a loop is bounded ([`Trips`]), what it adds to other numbers is, too.
//!
//! Irreducible loops are sound as well; their numbers just grow to the ends of their types.

use super::{Cfg, Dominators, Loops, Range, interval, trips};
use crate::{BinaryOp, Block, CompareOp, Function, InstData, Terminator, Type, UnaryOp, Value};
use cranelift_entity::SecondaryMap;
use std::collections::BTreeMap;

pub use super::trips::{Counted, Trips};

/// Rounds before growth jumps to thresholds, and before it jumps to the end of the type.
const EXACT_ROUNDS: u32 = 2;
const THRESHOLD_ROUNDS: u32 = 16;
/// How many branches on the way to a block are looked at for a value.
const BRANCHES: usize = 24;

/// A comparison that holds.
#[derive(Debug, Clone, Copy)]
struct Fact {
    op: CompareOp,
    args: [Value; 2],
}

/// What the integers of a function can be.
#[derive(Debug, Clone)]
pub struct LocalRanges {
    /// Where a value is defined; `None` where it never is.
    base: SecondaryMap<Value, Option<Range>>,
    /// What holds from a block on.
    facts: SecondaryMap<Block, Vec<Fact>>,
    /// The next block above that says something.
    above: SecondaryMap<Block, Option<Block>>,
    /// How often each natural loop goes back to its header, by header.
    trips: BTreeMap<Block, (Trips, Option<Counted>)>,
}

impl LocalRanges {
    /// Solves for a function.
    pub fn new(func: &Function, cfg: &Cfg, dominators: &Dominators, loops: &Loops) -> Self {
        let mut ranges = Self {
            base: SecondaryMap::new(),
            facts: SecondaryMap::new(),
            above: SecondaryMap::new(),
            trips: BTreeMap::new(),
        };
        ranges.collect_facts(func, cfg, dominators);
        let thresholds = thresholds(func);
        ranges.solve(func, cfg, &thresholds, &BTreeMap::new());
        for each in &loops.natural {
            if let Some(trips) = trips::of(func, cfg, dominators, &ranges, each) {
                ranges.trips.insert(each.header, trips);
            }
        }
        let caps = trips::caps(func, cfg, &ranges, loops);
        if !caps.is_empty() {
            ranges.base.clear();
            ranges.solve(func, cfg, &thresholds, &caps);
        }
        ranges
    }

    /// What an integer can be while a block runs in which it is known.
    pub fn at(&self, func: &Function, value: Value, block: Block) -> Range {
        self.range_at(value, block)
            .unwrap_or_else(|| Range::of_type(func.value_type(value)))
    }

    /// What an integer can be when a block is left for another.
    pub fn on_way(&self, func: &Function, value: Value, from: Block, to: Block) -> Range {
        let facts = facts_of_jump(func, from, to);
        let range = self.at(func, value, from);
        facts
            .iter()
            .fold(range, |range, &fact| self.under(fact, value, range))
    }

    /// How often the loop with this header goes back to it, if that is bounded.
    pub fn trips(&self, header: Block) -> Option<Trips> {
        self.trips.get(&header).map(|(trips, _)| *trips)
    }

    /// What bounds the loop with this header, if it is known before the loop.
    pub fn counted(&self, header: Block) -> Option<Counted> {
        self.trips.get(&header).and_then(|(_, counted)| *counted)
    }

    /// What a value can be where it is defined.
    pub(super) fn base(&self, func: &Function, value: Value) -> Range {
        self.base[value].unwrap_or_else(|| Range::of_type(func.value_type(value)))
    }

    fn range_at(&self, value: Value, block: Block) -> Option<Range> {
        let mut range = self.base[value]?;
        let mut place = Some(block);
        for _ in 0..BRANCHES {
            let Some(block) = place else { break };
            for fact in &self.facts[block] {
                range = self.under(*fact, value, range);
            }
            place = self.above[block];
        }
        Some(range)
    }

    /// The range of a value where a fact holds. Where it cannot hold, nothing runs.
    fn under(&self, fact: Fact, value: Value, range: Range) -> Range {
        let [a, b] = fact.args;
        let (op, other) = match (a == value, b == value) {
            (true, false) => (fact.op, b),
            (false, true) => (fact.op.swapped(), a),
            (true, true) | (false, false) => return range,
        };
        let Some(other) = self.base[other] else {
            return range;
        };
        interval::given(op, range, other).unwrap_or(range)
    }

    fn collect_facts(&mut self, func: &Function, cfg: &Cfg, dominators: &Dominators) {
        for &block in cfg.reverse_postorder() {
            if let &[from] = cfg.predecessors(block) {
                self.facts[block] = facts_of_jump(func, from, block);
            }
            self.above[block] = dominators.immediate(block).and_then(|parent| {
                match self.facts[parent].is_empty() {
                    true => self.above[parent],
                    false => Some(parent),
                }
            });
        }
    }

    fn solve(
        &mut self,
        func: &Function,
        cfg: &Cfg,
        thresholds: &SecondaryMap<Value, Vec<i64>>,
        caps: &BTreeMap<Value, Range>,
    ) {
        for &param in &func.block(func.entry()).params {
            if func.value_type(param).is_int() {
                self.base[param] = Some(Range::of_type(func.value_type(param)));
            }
        }
        let mut round = 0;
        let mut changed = true;
        while changed {
            changed = false;
            for &block in cfg.reverse_postorder() {
                self.results(func, block);
                changed |= self.jumps(func, block, round, thresholds, caps);
            }
            round += 1;
        }
    }

    fn results(&mut self, func: &Function, block: Block) {
        for &inst in &func.block(block).insts {
            for &value in func.results_of(inst) {
                let ty = func.value_type(value);
                if ty.is_int() {
                    self.base[value] = self.result(func, func.inst(inst), ty, block);
                }
            }
        }
    }

    fn result(&self, func: &Function, inst: &InstData, ty: Type, block: Block) -> Option<Range> {
        let at = |value: Value| self.range_at(value, block);
        let is_int = |value: Value| func.value_type(value).is_int();
        let whole = Range::of_type(ty);
        Some(match inst {
            InstData::Const { bits, .. } => Range::of_bits(ty, *bits),
            InstData::Unary { op, arg } => interval::unary(*op, ty, at(*arg)?),
            InstData::Binary { op, args } => interval::binary(*op, ty, at(args[0])?, at(args[1])?),
            InstData::Compare { op, args } if is_int(args[0]) => {
                interval::compare(*op, at(args[0])?, at(args[1])?)
            }
            InstData::Convert { op, arg, .. } if is_int(*arg) => {
                interval::convert(*op, func.value_type(*arg), ty, at(*arg)?)
            }
            InstData::Select { args, .. } => match (at(args[0]), at(args[1])) {
                (Some(a), Some(b)) => a.union(b),
                (one, other) => one.or(other)?,
            },
            InstData::Elapsed { .. } | InstData::Step { .. } => Range::new(0, whole.hi),
            InstData::Compare { .. }
            | InstData::Convert { .. }
            | InstData::Load { .. }
            | InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Address { .. }
            | InstData::Now
            | InstData::Call { .. } => whole,
        })
    }

    /// Passes arguments on to parameters; whether one of them can be more than before.
    fn jumps(
        &mut self,
        func: &Function,
        from: Block,
        round: u32,
        thresholds: &SecondaryMap<Value, Vec<i64>>,
        caps: &BTreeMap<Value, Range>,
    ) -> bool {
        let mut changed = false;
        for target in func.terminator(from).targets() {
            let facts = facts_of_jump(func, from, target.block);
            let params = &func.block(target.block).params;
            for (&param, &arg) in params.iter().zip(&target.args) {
                if !func.value_type(param).is_int() {
                    continue;
                }
                let Some(mut range) = self.range_at(arg, from) else {
                    continue;
                };
                for fact in &facts {
                    range = self.under(*fact, arg, range);
                }
                let old = self.base[param];
                let mut new = old.map_or(range, |old| {
                    widened(
                        func.value_type(param),
                        round,
                        &thresholds[param],
                        old,
                        range,
                    )
                });
                if let Some(inside) = caps.get(&param).and_then(|&cap| new.intersection(cap)) {
                    new = inside;
                }
                changed |= old != Some(new);
                self.base[param] = Some(new);
            }
        }
        changed
    }
}

/// What holds if a block is left for another.
fn facts_of_jump(func: &Function, from: Block, to: Block) -> Vec<Fact> {
    let mut facts = Vec::new();
    if let Terminator::Brif {
        cond,
        then,
        otherwise,
    } = func.terminator(from)
        && then.block != otherwise.block
    {
        let mut pending = vec![(*cond, then.block == to)];
        // Each condition is looked at once for each use, so a bound is needed.
        for _ in 0..BRANCHES {
            let Some((cond, holds)) = pending.pop() else {
                break;
            };
            match func.def_inst(cond) {
                Some(InstData::Compare { op, args }) if func.value_type(args[0]).is_int() => {
                    let op = if holds { Some(*op) } else { op.inverted() };
                    facts.extend(op.map(|op| Fact { op, args: *args }));
                }
                Some(InstData::Binary { op, args })
                    if (*op == BinaryOp::And && holds) || (*op == BinaryOp::Or && !holds) =>
                {
                    pending.extend(args.iter().map(|&arg| (arg, holds)));
                }
                Some(InstData::Unary {
                    op: UnaryOp::Not,
                    arg,
                }) => pending.push((*arg, !holds)),
                Some(_) | None => {}
            }
        }
    }
    facts
}

/// For each parameter, where its growth may stop: constants it or what it becomes is compared with, and their
/// neighbours.
fn thresholds(func: &Function) -> SecondaryMap<Value, Vec<i64>> {
    let mut compared: SecondaryMap<Value, Vec<i64>> = SecondaryMap::new();
    for &block in &func.layout {
        for &inst in &func.block(block).insts {
            let InstData::Compare { args: [a, b], .. } = func.inst(inst) else {
                continue;
            };
            for (value, other) in [(*a, *b), (*b, *a)] {
                let ty = func.value_type(other);
                if let Some(bits) = func.constant(other).filter(|_| ty.is_int()) {
                    let number = ty.signed(bits);
                    let near = [-1, 0, 1].map(|step| number.saturating_add(step));
                    compared[value].extend(near);
                }
            }
        }
    }
    let mut thresholds: SecondaryMap<Value, Vec<i64>> = SecondaryMap::new();
    for &block in &func.layout {
        for target in func.terminator(block).targets() {
            let params = &func.block(target.block).params;
            for (&param, &arg) in params.iter().zip(&target.args) {
                let own = compared[param].iter().chain(&compared[arg]);
                thresholds[param].extend(own);
            }
        }
    }
    for values in thresholds.values_mut() {
        values.sort_unstable();
        values.dedup();
    }
    thresholds
}

/// The union of old and new; growth jumps so that it ends.
fn widened(ty: Type, round: u32, thresholds: &[i64], old: Range, new: Range) -> Range {
    let (union, whole) = (old.union(new), Range::of_type(ty));
    if union == old || round < EXACT_ROUNDS {
        return union;
    }
    let thresholds = if round < EXACT_ROUNDS + THRESHOLD_ROUNDS {
        thresholds
    } else {
        &[]
    };
    let above = thresholds.iter().copied().find(|&t| t >= union.hi);
    let below = thresholds.iter().rev().copied().find(|&t| t <= union.lo);
    let hi = above.map_or(whole.hi, |t| t.min(whole.hi));
    let lo = below.map_or(whole.lo, |t| t.max(whole.lo));
    Range::new(
        if union.lo < old.lo { lo } else { old.lo },
        if union.hi > old.hi { hi } else { old.hi },
    )
}
