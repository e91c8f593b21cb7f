//! Values known at compile time.
//!
//! Whole numbers are exact; a result that does not fit its type is a mistake, never wrapped. Reals
//! are IEEE 754 in the width of their type.

use super::elementary::{El, Family};
use std::rc::Rc;

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub enum Const {
    /// A whole number, truth value (0, 1), bit string, time, character or enumerator.
    Int(i128),
    /// A real; of a `REAL` one that a `REAL` can hold.
    Real(f64),
    /// A literal with a fraction, rounded once to each width.
    Literal(f32, f64),
    /// The characters of a string.
    Text(Rc<[u16]>),
    /// `NULL`.
    Null,
}

impl Const {
    /// Its bits in a type that holds it.
    pub fn bits(&self, el: El) -> u64 {
        match self {
            Self::Int(value) if el.is_real() => Self::Real(*value as f64).bits(el),
            Self::Int(value) => (*value as u64) & (u64::MAX >> (64 - el.bits())),
            Self::Real(value) if el == El::Real => u64::from((*value as f32).to_bits()),
            Self::Real(value) => value.to_bits(),
            Self::Literal(single, _) if el == El::Real => u64::from(single.to_bits()),
            Self::Literal(_, double) => double.to_bits(),
            Self::Null => 0,
            Self::Text(units) => u64::from(units.first().copied().unwrap_or(0)),
        }
    }

    /// The value of an elementary type with some bits.
    pub fn from_bits(el: El, bits: u64) -> Self {
        match el.family() {
            Family::Real if el == El::Real => Self::Real(f64::from(f32::from_bits(bits as u32))),
            Family::Real => Self::Real(f64::from_bits(bits)),
            Family::Signed
            | Family::Duration
            | Family::Date
            | Family::TimeOfDay
            | Family::DateTime => {
                let shift = 64 - el.bits();
                Self::Int(i128::from(((bits << shift) as i64) >> shift))
            }
            Family::Bits | Family::Unsigned | Family::Character => Self::Int(i128::from(bits)),
        }
    }

    /// As a truth value.
    pub fn as_bool(&self) -> Option<bool> {
        match self {
            Self::Int(value) => Some(*value != 0),
            Self::Real(_) | Self::Literal(..) | Self::Text(_) | Self::Null => None,
        }
    }

    /// As a whole number.
    pub fn as_int(&self) -> Option<i128> {
        match self {
            Self::Int(value) => Some(*value),
            Self::Real(_) | Self::Literal(..) | Self::Text(_) | Self::Null => None,
        }
    }
}

/// A real rounded to the width of its type.
pub fn round_to(el: El, value: f64) -> f64 {
    if el == El::Real {
        f64::from(value as f32)
    } else {
        value
    }
}
