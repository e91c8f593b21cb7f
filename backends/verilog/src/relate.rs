//! Comparisons: decided by ranges where possible, against the end of a range as equality, else in
//! the fewest bits that hold both numbers.

use crate::net::{Gate, Net, Relation};
use crate::scan::Lowering;
use iecc_ir::Value;
use iecc_ir::analysis::Range;

/// Bounds of a value in the order of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Bounds {
    lo: i128,
    hi: i128,
}

impl Lowering<'_> {
    pub(crate) fn relate(&mut self, relation: Relation, signed: bool, args: [Value; 2]) -> Net {
        let bounds = args.map(|arg| self.bounds(arg, signed));
        if let Some(holds) = decide(relation, bounds) {
            return self.net().constant(1, u128::from(holds));
        }
        let (relation, args, [left, right]) = match bounds {
            [a, b] if a.lo == a.hi => (relation.swapped(), [args[1], args[0]], [b, a]),
            [a, b] => (relation, args, [a, b]),
        };
        if right.lo == right.hi
            && let Some((relation, end)) = against_end(relation, left, right.lo)
        {
            let value = self.ordered_bits(args[0], signed);
            let width = self.net().width(value);
            let end = self.net().constant(width, end as u128);
            return self.equality(relation, value, end);
        }
        self.general(relation, signed, args)
    }

    fn bounds(&self, value: Value, signed: bool) -> Bounds {
        let Range { lo, hi } = self.range(value);
        let (lo, hi) = (i128::from(lo), i128::from(hi));
        if signed || lo >= 0 {
            return Bounds { lo, hi };
        }
        // Read as unsigned, negative numbers stand above all others.
        let all = 1 << self.func.value_type(value).bits();
        if hi < 0 {
            Bounds {
                lo: lo + all,
                hi: hi + all,
            }
        } else {
            Bounds { lo: 0, hi: all - 1 }
        }
    }

    /// The value in the bits that order it.
    fn ordered_bits(&mut self, value: Value, signed: bool) -> Net {
        if signed {
            self.number(value).net
        } else {
            self.unsigned(value)
        }
    }

    /// `x == 1` of a single bit is the bit.
    fn equality(&mut self, relation: Relation, a: Net, b: Net) -> Net {
        if self.net().width(a) > 1 {
            return self.net().compare(relation, false, a, b);
        }
        let differ = self.net().gate(Gate::Xor, a, b);
        if relation == Relation::Ne {
            differ
        } else {
            self.net().not(differ)
        }
    }

    fn general(&mut self, relation: Relation, signed: bool, args: [Value; 2]) -> Net {
        let both = self.range(args[0]).union(self.range(args[1]));
        let width = if signed || !both.is_signed() {
            both.bits()
        } else {
            self.func.value_type(args[0]).bits()
        };
        let [a, b] = args.map(|arg| self.bits(arg, width));
        match relation {
            Relation::Eq | Relation::Ne => self.equality(relation, a, b),
            Relation::Lt | Relation::Le | Relation::Gt | Relation::Ge => {
                self.net()
                    .compare(relation, signed && both.is_signed(), a, b)
            }
        }
    }
}

/// The answer, if it is the same for all numbers within the bounds.
fn decide(relation: Relation, [a, b]: [Bounds; 2]) -> Option<bool> {
    let less = || match () {
        () if a.hi < b.lo => Some(true),
        () if a.lo >= b.hi => Some(false),
        () => None,
    };
    let greater = || match () {
        () if a.lo > b.hi => Some(true),
        () if a.hi <= b.lo => Some(false),
        () => None,
    };
    let equal = || match () {
        () if a.hi < b.lo || a.lo > b.hi => Some(false),
        () if a.lo == a.hi && a == b => Some(true),
        () => None,
    };
    match relation {
        Relation::Eq => equal(),
        Relation::Ne => equal().map(|holds| !holds),
        Relation::Lt => less(),
        Relation::Ge => less().map(|holds| !holds),
        Relation::Gt => greater(),
        Relation::Le => greater().map(|holds| !holds),
    }
}

/// A comparison that only the smallest or only the largest number passes or fails, as equality
/// with that number.
fn against_end(relation: Relation, left: Bounds, constant: i128) -> Option<(Relation, i128)> {
    let Bounds { lo, hi } = left;
    // All in terms of `value >= limit`.
    let (limit, holds) = match relation {
        Relation::Ge => (constant, true),
        Relation::Lt => (constant, false),
        Relation::Gt => (constant + 1, true),
        Relation::Le => (constant + 1, false),
        Relation::Eq | Relation::Ne => return None,
    };
    let (end, at_end) = match limit {
        _ if limit == hi => (hi, holds),
        _ if limit == lo + 1 => (lo, !holds),
        _ => return None,
    };
    Some((if at_end { Relation::Eq } else { Relation::Ne }, end))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMER: Bounds = Bounds { lo: 0, hi: 2000 };

    #[test]
    fn a_comparison_with_the_end_of_the_range_is_an_equality() {
        for (relation, constant, expected) in [
            (Relation::Ge, 2000, Some((Relation::Eq, 2000))),
            (Relation::Gt, 1999, Some((Relation::Eq, 2000))),
            (Relation::Lt, 2000, Some((Relation::Ne, 2000))),
            (Relation::Le, 1999, Some((Relation::Ne, 2000))),
            (Relation::Gt, 0, Some((Relation::Ne, 0))),
            (Relation::Le, 0, Some((Relation::Eq, 0))),
            (Relation::Ge, 1999, None),
            (Relation::Eq, 2000, None),
        ] {
            assert_eq!(against_end(relation, TIMER, constant), expected);
        }
    }

    #[test]
    fn disjoint_ranges_decide() {
        let above = Bounds { lo: 2001, hi: 3000 };
        let one = Bounds { lo: 5, hi: 5 };
        assert_eq!(decide(Relation::Lt, [TIMER, above]), Some(true));
        assert_eq!(decide(Relation::Ge, [TIMER, above]), Some(false));
        assert_eq!(decide(Relation::Eq, [TIMER, above]), Some(false));
        assert_eq!(decide(Relation::Eq, [one, one]), Some(true));
        assert_eq!(decide(Relation::Le, [TIMER, one]), None);
        let top = Bounds { lo: 2000, hi: 2000 };
        assert_eq!(decide(Relation::Le, [TIMER, top]), Some(true));
    }
}
