//! Ranges under assumptions.
//!
//! A [`Case`] is a set of facts "this value lies in that range". Facts propagate against the
//! direction of computation (if `a and b` is 1, both are), and ranges are computed forwards under
//! them. At a `select` whose condition is open the case splits in two. All walks are bounded in
//! depth; beyond the bound the range without assumptions stands in, which is sound.

use super::Analysis;
use iecc_ir::analysis::{Range, interval};
use iecc_ir::{BinaryOp, CompareOp, ConvertOp, InstData, Root, Type, UnaryOp, Value};
use std::collections::BTreeMap;

/// How far a range is followed into the operands.
pub(super) const DEPTH: u32 = 16;
/// How far facts look into operands.
const FACT_DEPTH: u32 = 5;
/// How far bits are followed: facts about them do more than looking at rungs.
const BIT_DEPTH: u32 = 3;
/// How many selects may split one case.
const SPLITS: u32 = 4;
/// How many steps from an assumption facts are followed: a rung is not worth it.
const FAR: u32 = 4;
/// How many facts a case follows before it stops learning.
const FACTS: usize = 64;
/// How many ranges one question may compute, in all the cases it splits into.
pub(super) const WORK: u32 = 2_000;

/// Facts that hold together. `None` from a method means they contradict each other: the case
/// cannot happen.
#[derive(Clone)]
pub(super) struct Case<'a, 'm> {
    analysis: &'a Analysis<'m>,
    facts: BTreeMap<Value, Range>,
    /// Facts to follow, and how many steps they are from what was assumed.
    assumed: Vec<(Value, u32)>,
    /// Steps of the fact that is being followed.
    distance: u32,
    /// Flags (leaf indices) whose value at the start of the scan is known.
    flags: BTreeMap<usize, bool>,
    /// Ranges computed under the facts, and how deep that looked.
    computed: BTreeMap<Value, u32>,
    splits: u32,
}

impl<'a, 'm> Case<'a, 'm> {
    /// A case without assumptions: the start of a question.
    pub(super) fn new(analysis: &'a Analysis<'m>) -> Self {
        analysis.work.set(WORK);
        Self {
            analysis,
            facts: BTreeMap::new(),
            assumed: Vec::new(),
            distance: 0,
            flags: BTreeMap::new(),
            computed: BTreeMap::new(),
            splits: 0,
        }
    }

    /// Assumes that a flag has this value at the start of the scan.
    pub(super) fn assume_flag(&mut self, leaf: usize, flag: bool) -> Option<()> {
        self.flags.insert(leaf, flag);
        match self.analysis.form.leaves[leaf].load {
            Some(load) => self.assume(load, Range::constant(i64::from(flag))),
            None => Some(()),
        }
    }

    /// Assumes that a value lies in a range, with all that follows.
    pub(super) fn assume(&mut self, value: Value, range: Range) -> Option<()> {
        self.distance = 0;
        self.learn(value, range)?;
        // Looking at operands for a fact is no place to split the case.
        let splits = std::mem::replace(&mut self.splits, SPLITS);
        let possible = self.follow_all();
        self.splits = splits;
        self.computed.clear();
        possible
    }

    /// New facts may decide earlier ones; a few rounds settle it, more would only be sharper.
    fn follow_all(&mut self) -> Option<()> {
        for _ in 0..4 {
            let before = self.assumed.len();
            self.computed.clear();
            for index in 0..self.assumed.len() {
                let (value, distance) = self.assumed[index];
                self.distance = distance + 1;
                self.follow(value)?;
            }
            self.check_loads()?;
            if self.assumed.len() == before {
                break;
            }
        }
        Some(())
    }

    /// What is known of loads must be possible with the flags that are known by now.
    fn check_loads(&self) -> Option<()> {
        for (value, fact) in &self.facts {
            if let Some(leaf) = self.analysis.leaf_of(*value) {
                self.analysis.state[leaf]
                    .given(&self.flags)?
                    .intersection(*fact)?;
            }
        }
        Some(())
    }

    fn known(&self, value: Value) -> Range {
        let base = self.analysis.base(value);
        self.facts.get(&value).copied().unwrap_or(base)
    }

    fn learn(&mut self, value: Value, range: Range) -> Option<()> {
        let known = self.known(value);
        let narrowed = known.intersection(range)?;
        if narrowed != known {
            self.facts.insert(value, narrowed);
            if self.assumed.len() < FACTS && self.distance <= FAR {
                self.assumed.push((value, self.distance));
            }
            if let Some(leaf) = self.analysis.flag_of(value)
                && let Some(flag) = narrowed.as_constant()
            {
                self.flags.insert(leaf, flag == 1);
            }
        }
        Some(())
    }

    fn learn_bit(&mut self, value: Value, bit: bool) -> Option<()> {
        self.learn(value, Range::constant(i64::from(bit)))
    }

    fn bit(&mut self, value: Value) -> Option<Option<bool>> {
        Some(
            self.range(value, FACT_DEPTH)?
                .as_constant()
                .map(|bit| bit == 1),
        )
    }

    /// What the fact about a value says about its operands.
    fn follow(&mut self, value: Value) -> Option<()> {
        let func = self.analysis.func;
        let fact = self.known(value);
        let Some(inst) = func.def_inst(value) else {
            return Some(());
        };
        match inst {
            InstData::Unary {
                op: UnaryOp::Not,
                arg,
            } if func.value_type(*arg) == Type::I1 => {
                self.learn(*arg, Range::new(1 - fact.hi, 1 - fact.lo))
            }
            InstData::Binary {
                op: op @ (BinaryOp::And | BinaryOp::Or),
                args,
            } if func.value_type(value) == Type::I1 => self.follow_gate(*op, *args, fact),
            InstData::Binary {
                op: BinaryOp::Add,
                args,
            } => self.follow_sum(*args, value, fact),
            InstData::Select { cond, args } => self.follow_select(*cond, *args, fact),
            InstData::Compare { op, args } if func.value_type(args[0]).is_int() => {
                match fact.as_constant() {
                    Some(1) => self.follow_compare(*op, *args),
                    Some(_) => op
                        .inverted()
                        .map_or(Some(()), |op| self.follow_compare(op, *args)),
                    None => Some(()),
                }
            }
            InstData::Convert {
                op: ConvertOp::Zext,
                arg,
                ..
            } => {
                let narrow = Range::of_type(func.value_type(*arg));
                let inside = fact.intersection(Range::new(0, narrow.hi));
                // A negative operand reads as a large number; such facts say nothing simple.
                match inside {
                    Some(inside) if self.known(*arg).lo >= 0 => self.learn(*arg, inside),
                    _ => Some(()),
                }
            }
            _ => Some(()),
        }
    }

    /// `a and b`, `a or b`: the dominating result fixes both, the other fixes one when the other
    /// operand is known.
    fn follow_gate(&mut self, op: BinaryOp, args: [Value; 2], fact: Range) -> Option<()> {
        let Some(result) = fact.as_constant() else {
            return Some(());
        };
        let both = i64::from(op == BinaryOp::And);
        if result == both {
            self.learn_bit(args[0], both == 1)?;
            return self.learn_bit(args[1], both == 1);
        }
        for (this, other) in [(args[0], args[1]), (args[1], args[0])] {
            if self.bit(this)? == Some(both == 1) {
                self.learn_bit(other, both == 0)?;
            }
        }
        Some(())
    }

    /// `x + k` without wrapping.
    fn follow_sum(&mut self, args: [Value; 2], sum: Value, fact: Range) -> Option<()> {
        for (x, k) in [(args[0], args[1]), (args[1], args[0])] {
            let Some(k) = self.known(k).as_constant() else {
                continue;
            };
            let whole = Range::of_type(self.analysis.func.value_type(sum));
            let known = self.known(x);
            let fits = [known.lo, known.hi]
                .iter()
                .all(|x| x.checked_add(k).is_some_and(|s| whole.contains(s)));
            if let (true, Some(lo), Some(hi)) =
                (fits, fact.lo.checked_sub(k), fact.hi.checked_sub(k))
            {
                self.learn(x, Range::new(lo, hi))?;
            }
        }
        Some(())
    }

    fn follow_select(&mut self, cond: Value, args: [Value; 2], fact: Range) -> Option<()> {
        if self.analysis.func.value_type(args[0]).is_float() {
            return Some(());
        }
        let possible =
            |case: &mut Self, arm| Some(case.range(arm, FACT_DEPTH)?.intersection(fact).is_some());
        // An arm whose own range is a contradiction cannot be taken either.
        let yes = possible(self, args[0]).unwrap_or(false);
        let no = possible(self, args[1]).unwrap_or(false);
        let taken = match (self.known(cond).as_constant(), yes, no) {
            (Some(1), ..) | (None, true, false) => 0,
            (Some(_), ..) | (None, false, true) => 1,
            (None, true, true) => return Some(()),
            (None, false, false) => return None,
        };
        self.learn_bit(cond, taken == 0)?;
        self.learn(args[taken], fact)
    }

    fn follow_compare(&mut self, op: CompareOp, [a, b]: [Value; 2]) -> Option<()> {
        let (ra, rb) = (self.range(a, FACT_DEPTH)?, self.range(b, FACT_DEPTH)?);
        let unsigned_is_signed = ra.lo >= 0 && rb.lo >= 0;
        match op {
            CompareOp::Eq => {
                self.learn(a, rb)?;
                self.learn(b, ra)
            }
            CompareOp::Ne => {
                self.learn(a, without(ra, rb)?)?;
                self.learn(b, without(rb, ra)?)
            }
            CompareOp::Slt => self.learn_less(a, b, ra, rb, 1),
            CompareOp::Sle => self.learn_less(a, b, ra, rb, 0),
            CompareOp::Sgt => self.learn_less(b, a, rb, ra, 1),
            CompareOp::Sge => self.learn_less(b, a, rb, ra, 0),
            CompareOp::Ult if unsigned_is_signed => self.learn_less(a, b, ra, rb, 1),
            CompareOp::Ule if unsigned_is_signed => self.learn_less(a, b, ra, rb, 0),
            CompareOp::Ugt if unsigned_is_signed => self.learn_less(b, a, rb, ra, 1),
            CompareOp::Uge if unsigned_is_signed => self.learn_less(b, a, rb, ra, 0),
            CompareOp::Ult | CompareOp::Ule | CompareOp::Ugt | CompareOp::Uge => Some(()),
            CompareOp::Feq
            | CompareOp::Fne
            | CompareOp::Flt
            | CompareOp::Fle
            | CompareOp::Fgt
            | CompareOp::Fge => Some(()),
        }
    }

    /// `a + gap <= b`.
    fn learn_less(&mut self, a: Value, b: Value, ra: Range, rb: Range, gap: i64) -> Option<()> {
        let (top, bottom) = (rb.hi.checked_sub(gap)?, ra.lo.checked_add(gap)?);
        if ra.lo > top || bottom > rb.hi {
            return None;
        }
        self.learn(a, Range::new(ra.lo, top.max(ra.lo)))?;
        self.learn(b, Range::new(bottom, rb.hi))
    }

    /// The range of an integer value in this case.
    pub(super) fn range(&mut self, value: Value, depth: u32) -> Option<Range> {
        let known = self.known(value);
        let is_bit = self.analysis.func.value_type(value) == Type::I1;
        let depth = if is_bit { depth.min(BIT_DEPTH) } else { depth };
        let looked = self.computed.get(&value).copied().unwrap_or(0);
        if depth <= looked || known.as_constant().is_some() || !self.may_work() {
            return Some(known);
        }
        self.computed.insert(value, depth);
        let computed = self.compute(value, depth - 1)?;
        let narrowed = known.intersection(computed)?;
        if narrowed != known {
            self.facts.insert(value, narrowed);
        }
        Some(narrowed)
    }

    fn may_work(&self) -> bool {
        let left = self.analysis.work.get();
        self.analysis.work.set(left.saturating_sub(1));
        left > 0
    }

    fn compute(&mut self, value: Value, depth: u32) -> Option<Range> {
        let func = self.analysis.func;
        let ty = func.value_type(value);
        let Some(inst) = func.def_inst(value) else {
            return Some(Range::of_type(ty));
        };
        match inst {
            InstData::Unary { op, arg } => Some(interval::unary(*op, ty, self.range(*arg, depth)?)),
            InstData::Binary { op, args } => {
                let (a, b) = (self.range(args[0], depth)?, self.range(args[1], depth)?);
                Some(interval::binary(*op, ty, a, b))
            }
            InstData::Compare { op, args } if func.value_type(args[0]).is_int() => {
                self.compare(*op, *args, depth)
            }
            InstData::Convert { op, arg, .. } if func.value_type(*arg).is_int() => {
                let from = func.value_type(*arg);
                Some(interval::convert(*op, from, ty, self.range(*arg, depth)?))
            }
            InstData::Select { cond, args } => self.select(*cond, *args, depth),
            InstData::Load { place } if place.root == Root::State => self.load(value),
            _ => Some(self.analysis.base(value)),
        }
    }

    fn compare(&mut self, op: CompareOp, [a, b]: [Value; 2], depth: u32) -> Option<Range> {
        let (ra, rb) = (self.range(a, depth)?, self.range(b, depth)?);
        let by_range = interval::compare(op, ra, rb);
        // `x + d < x`, the usual question whether a sum wrapped: not if it cannot and d is not negative.
        let grown = |case: &mut Self, sum, x| case.is_at_least(sum, x, depth);
        let below = match op {
            CompareOp::Slt => grown(self, a, b)?,
            CompareOp::Sgt => grown(self, b, a)?,
            _ => false,
        };
        Some(if below { Range::constant(0) } else { by_range })
    }

    /// Whether `sum` is `x + d` without wrapping and d is not negative.
    fn is_at_least(&mut self, sum: Value, x: Value, depth: u32) -> Option<bool> {
        let func = self.analysis.func;
        let Some(InstData::Binary {
            op: BinaryOp::Add,
            args,
        }) = func.def_inst(sum)
        else {
            return Some(false);
        };
        let added = if args[0] == x { args[1] } else { args[0] };
        if !args.contains(&x) {
            return Some(false);
        }
        let (x, d) = (self.range(x, depth)?, self.range(added, depth)?);
        let top = Range::of_type(func.value_type(sum)).hi;
        Some(d.lo >= 0 && x.hi.checked_add(d.hi).is_some_and(|sum| sum <= top))
    }

    fn load(&self, value: Value) -> Option<Range> {
        let Some(index) = self.analysis.leaf_of(value) else {
            return Some(self.known(value));
        };
        self.analysis.state[index].given(&self.flags)
    }

    fn select(&mut self, cond: Value, args: [Value; 2], depth: u32) -> Option<Range> {
        match self.range(cond, depth)?.as_constant() {
            Some(1) => return self.range(args[0], depth),
            Some(_) => return self.range(args[1], depth),
            None => {}
        }
        if self.splits == SPLITS {
            let (yes, no) = (self.range(args[0], depth)?, self.range(args[1], depth)?);
            return Some(yes.union(no));
        }
        let arms = [(args[0], true), (args[1], false)].map(|(arm, taken)| {
            let mut case = self.clone();
            case.splits += 1;
            case.assume(cond, Range::constant(i64::from(taken)))?;
            case.range(arm, depth)
        });
        match arms {
            [Some(a), Some(b)] => Some(a.union(b)),
            [one, other] => one.or(other),
        }
    }
}

/// `range` without the number that `other` is, if that is at its edge.
fn without(range: Range, other: Range) -> Option<Range> {
    match other.as_constant() {
        Some(k) if range.as_constant() == Some(k) => None,
        Some(k) if k == range.lo => Some(Range::new(k + 1, range.hi)),
        Some(k) if k == range.hi => Some(Range::new(range.lo, k - 1)),
        _ => Some(range),
    }
}
