//! Shows that nobody sees whether a counter stops or goes on.
//!
//! Two programs are compared: the old one counts X without end and remembers a wrap in the flag V;
//! the new one counts Y up to `top`, never wraps, and its V stays 0. They are related at scan
//! boundaries if
//!
//! * V = 0 in the old one, X is not negative and Y = min(X, top), or
//! * V = 1 in the old one and Y = top; X may be anything;
//!
//! and all other state is the same. From related states every scan must give the same outputs, the
//! same other state, and related states again. The cases are: V = 1; V = 0 with X at its largest
//! number; V = 0 below that; each on every way to the next value of the counter. In a case every
//! `i1` of the block is computed for both programs, as 0, 1 or open, together with whether both
//! have the same. Comparisons below `top` are decided by it.

use super::{Counter, Observation, Step, Way};
use crate::scan_form::ScanForm;
use iecc_ir::{BinaryOp, Function, InstData, Root, Type, UnaryOp, Value};
use std::collections::BTreeMap;

/// Whether V (a flag leaf, 0 at first) hides the difference.
pub(super) fn is_invisible(
    func: &Function,
    form: &ScanForm,
    counter: &Counter,
    flag: usize,
) -> bool {
    counter.choices.ways().flatten().all(|way| {
        [Situation::Wrapped, Situation::AtMax, Situation::Below]
            .into_iter()
            .all(|situation| holds(func, form, counter, flag, &way, situation))
    })
}

/// Where the old counter stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Situation {
    /// V = 1.
    Wrapped,
    /// V = 0, X is the largest number.
    AtMax,
    /// V = 0, X is smaller.
    Below,
}

/// A value in both programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Pair {
    old: Option<bool>,
    new: Option<bool>,
    same: bool,
}

impl Pair {
    const OPEN: Self = Self {
        old: None,
        new: None,
        same: true,
    };
    const DIFFERENT: Self = Self {
        old: None,
        new: None,
        same: false,
    };

    fn known(bit: bool) -> Self {
        Self::of(Some(bit), Some(bit), true)
    }

    /// Equal known bits are the same, whatever was said.
    fn of(old: Option<bool>, new: Option<bool>, same: bool) -> Self {
        Self {
            old,
            new,
            same: same || (old.is_some() && old == new),
        }
    }

    fn map(self, f: impl Fn(Option<bool>) -> Option<bool>) -> Self {
        Self::of(f(self.old), f(self.new), self.same)
    }

    fn join(self, other: Self, f: impl Fn(Option<bool>, Option<bool>) -> Option<bool>) -> Self {
        Self::of(
            f(self.old, other.old),
            f(self.new, other.new),
            self.same && other.same,
        )
    }
}

fn holds(
    func: &Function,
    form: &ScanForm,
    counter: &Counter,
    flag: usize,
    way: &Way,
    situation: Situation,
) -> bool {
    let mut case = Case {
        func,
        counter,
        flag_load: form.leaves[flag].load,
        way,
        situation,
        pairs: BTreeMap::new(),
    };
    let mut related = true;
    for &inst in &func.block(form.block).insts {
        match func.inst(inst) {
            InstData::Store { place, value }
                if place.root == Root::State && *place == form.leaves[flag].place =>
            {
                related &= case.flag_after(*value);
            }
            InstData::Store { place, .. } if *place == form.leaves[counter.leaf].place => {}
            InstData::Store { value, .. } => related &= case.pair(*value).same,
            data => {
                if let &[value] = func.results_of(inst) {
                    let pair = case.compute(data, value);
                    // A way that a known condition excludes proves everything.
                    if case.is_excluded(value, pair) {
                        return true;
                    }
                    let pair = case.on_way(value, pair);
                    case.pairs.insert(value, pair);
                }
            }
        }
    }
    // The ways are taken alike only if their conditions are the same in both.
    related
        && way
            .conditions
            .keys()
            .all(|&condition| case.pair(condition).same)
}

struct Case<'a> {
    func: &'a Function,
    counter: &'a Counter,
    flag_load: Option<Value>,
    way: &'a Way,
    situation: Situation,
    pairs: BTreeMap<Value, Pair>,
}

impl Case<'_> {
    fn pair(&self, value: Value) -> Pair {
        self.pairs.get(&value).copied().unwrap_or(Pair::OPEN)
    }

    fn on_way(&self, value: Value, pair: Pair) -> Pair {
        match self.way.conditions.get(&value) {
            // If both have the same, this way fixes both.
            Some(&taken) if pair.same => Pair::known(taken),
            _ => pair,
        }
    }

    fn is_excluded(&self, value: Value, pair: Pair) -> bool {
        let wanted = self.way.conditions.get(&value);
        wanted.is_some_and(|&taken| pair.same && pair.old == Some(!taken))
    }

    /// What the flag must be after the scan in the old program, and 0 in the new one.
    fn flag_after(&self, next: Value) -> bool {
        let old = match (self.situation, self.way.next) {
            (_, Step::Set(_)) => false,
            (Situation::Wrapped, Step::Keep | Step::Count) => true,
            (Situation::AtMax, Step::Count) => true,
            (Situation::AtMax | Situation::Below, Step::Keep) | (Situation::Below, Step::Count) => {
                false
            }
        };
        let pair = self.pair(next);
        pair.old == Some(old) && pair.new == Some(false)
    }

    fn compute(&self, data: &InstData, value: Value) -> Pair {
        if Some(value) == self.flag_load {
            return Pair::of(
                Some(self.situation == Situation::Wrapped),
                Some(false),
                false,
            );
        }
        if self.counter.is_counter_value(value) {
            return Pair::DIFFERENT;
        }
        if let Some(&observation) = self.counter.at_max.get(&value) {
            return self.at_max(observation);
        }
        if self.counter.low.contains_key(&value) {
            return self.low(value);
        }
        self.gate(data, value)
    }

    /// What is compared on this way.
    fn step(&self, observation: Observation) -> Step {
        self.way
            .steps
            .get(&observation.of)
            .copied()
            .unwrap_or(Step::Keep)
    }

    /// `X == MAX` or its opposite; Y never is.
    fn at_max(&self, observation: Observation) -> Pair {
        let below = observation.outcome(0);
        if let Step::Set(k) = self.step(observation) {
            return Pair::known(observation.outcome(k));
        }
        let old = match self.situation {
            Situation::Wrapped => None,
            Situation::AtMax => Some(!below),
            Situation::Below => Some(below),
        };
        Pair::of(old, Some(below), false)
    }

    /// A comparison that is settled from `top` on.
    fn low(&self, value: Value) -> Pair {
        let observation = self.counter.low[&value];
        let settled = observation.outcome(self.counter.top);
        let wrapped = observation.outcome(-self.counter.max - 1);
        let step = self.step(observation);
        match (self.situation, step) {
            (_, Step::Set(k)) => Pair::known(observation.outcome(k)),
            (Situation::Below, _) => Pair::OPEN,
            (Situation::Wrapped, Step::Keep | Step::Count) => Pair::of(None, Some(settled), false),
            (Situation::AtMax, Step::Keep) => Pair::known(settled),
            (Situation::AtMax, Step::Count) => Pair::of(Some(wrapped), Some(settled), false),
        }
    }

    fn gate(&self, data: &InstData, value: Value) -> Pair {
        let bit = self.func.value_type(value) == Type::I1;
        match data {
            InstData::Const { bits, .. } if bit => Pair::known(*bits == 1),
            InstData::Unary {
                op: UnaryOp::Not,
                arg,
            } if bit => self.pair(*arg).map(|x| x.map(|x| !x)),
            InstData::Binary {
                op: op @ (BinaryOp::And | BinaryOp::Or),
                args,
            } if bit => {
                let dominant = *op == BinaryOp::Or;
                self.pair(args[0])
                    .join(self.pair(args[1]), |a, b| match (a, b) {
                        (Some(x), _) | (_, Some(x)) if x == dominant => Some(dominant),
                        (Some(_), Some(_)) => Some(!dominant),
                        _ => None,
                    })
            }
            InstData::Select { cond, args } if bit => self.select(*cond, *args),
            _ => {
                let same = data.values().into_iter().all(|v| self.pair(v).same);
                if same { Pair::OPEN } else { Pair::DIFFERENT }
            }
        }
    }

    fn select(&self, cond: Value, args: [Value; 2]) -> Pair {
        let (cond, yes, no) = (self.pair(cond), self.pair(args[0]), self.pair(args[1]));
        let pick = |c: Option<bool>, yes: Option<bool>, no: Option<bool>| match c {
            Some(true) => yes,
            Some(false) => no,
            None if yes == no => yes,
            None => None,
        };
        let arms_same = match (cond.same, cond.old) {
            (true, Some(true)) => yes.same,
            (true, Some(false)) => no.same,
            (true, None) => yes.same && no.same,
            (false, _) => false,
        };
        Pair::of(
            pick(cond.old, yes.old, no.old),
            pick(cond.new, yes.new, no.new),
            arms_same,
        )
    }
}
