//! What values and state leaves can hold, as data. The range analysis fills it; back ends narrow
//! registers and wires with it.

use crate::{Place, Type, Value};
use cranelift_entity::SecondaryMap;
use std::collections::BTreeMap;

/// All integers from `lo` to `hi`, both included. Values of `i8` to `i64` are read as signed, `i1`
/// as 0 or 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Range {
    /// Smallest.
    pub lo: i64,
    /// Largest; not below `lo`.
    pub hi: i64,
}

impl Range {
    /// The numbers from `lo` to `hi`.
    pub fn new(lo: i64, hi: i64) -> Self {
        debug_assert!(lo <= hi);
        Self { lo, hi }
    }

    /// One number.
    pub fn constant(value: i64) -> Self {
        Self {
            lo: value,
            hi: value,
        }
    }

    /// Everything an integer type holds.
    pub fn of_type(ty: Type) -> Self {
        match ty {
            Type::I1 => Self { lo: 0, hi: 1 },
            Type::I8 | Type::I16 | Type::I32 | Type::I64 => Self {
                lo: i64::MIN >> (64 - ty.bits()),
                hi: i64::MAX >> (64 - ty.bits()),
            },
            Type::F32 | Type::F64 => panic!("floats have no integer range"),
        }
    }

    /// The number a value of this type and these bits stands for.
    pub fn of_bits(ty: Type, bits: u64) -> Self {
        Self::constant(if ty == Type::I1 {
            bits as i64
        } else {
            ty.signed(bits)
        })
    }

    /// The only number, if there is one.
    pub fn as_constant(self) -> Option<i64> {
        (self.lo == self.hi).then_some(self.lo)
    }

    /// Whether the number is inside.
    pub fn contains(self, value: i64) -> bool {
        (self.lo..=self.hi).contains(&value)
    }

    /// The smallest range that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    /// What both hold; `None` if nothing.
    #[must_use]
    pub fn intersection(self, other: Self) -> Option<Self> {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        (lo <= hi).then_some(Self { lo, hi })
    }

    /// Whether negative numbers are inside; if so, a narrow form needs a sign bit.
    pub fn is_signed(self) -> bool {
        self.lo < 0
    }

    /// Fewest bits that hold every number: plain binary if none is negative, else two's complement.
    /// At least 1.
    pub fn bits(self) -> u32 {
        let magnitude = |x: i64| 64 - (if x < 0 { !x } else { x }).leading_zeros();
        let bits = magnitude(self.lo).max(magnitude(self.hi)) + u32::from(self.is_signed());
        bits.max(1)
    }
}

/// Ranges of the integer values of the scan function and of the integer leaves of the state. What
/// is missing can hold everything its type can.
#[derive(Debug, Clone, Default)]
pub struct Ranges {
    /// By value of the scan function.
    pub values: SecondaryMap<Value, Option<Range>>,
    /// By scalar place of the state, at scan boundaries.
    pub state: BTreeMap<Place, Range>,
}

impl Ranges {
    /// The range of a value of an integer type.
    pub fn value(&self, value: Value, ty: Type) -> Range {
        self.values[value].unwrap_or_else(|| Range::of_type(ty))
    }

    /// The range of a state leaf of an integer type at scan boundaries.
    pub fn leaf(&self, place: &Place, ty: Type) -> Range {
        self.state
            .get(place)
            .copied()
            .unwrap_or_else(|| Range::of_type(ty))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_the_fewest_that_hold_the_range() {
        for (lo, hi, bits) in [
            (0, 0, 1),
            (0, 1, 1),
            (0, 7, 3),
            (0, 8, 4),
            (-1, 0, 1),
            (-8, 7, 4),
            (-9, 0, 5),
            (0, 2000, 11),
        ] {
            assert_eq!(Range::new(lo, hi).bits(), bits, "{lo}..={hi}");
        }
        assert_eq!(Range::of_type(Type::I64).bits(), 64);
        assert_eq!(
            Range::of_type(Type::I32),
            Range::new(-2147483648, 2147483647)
        );
    }
}
