//! Comparisons: of floats as IEEE 754 says, with NaN unordered.

use super::float::widened;
use crate::{CompareOp, Type};

/// The result of a comparison.
pub fn eval_compare(op: CompareOp, ty: Type, left: u64, right: u64) -> bool {
    let signed = || (ty.signed(left), ty.signed(right));
    // Widening is exact, so one comparison serves both widths.
    let floats = || (widened(ty, left), widened(ty, right));
    match op {
        CompareOp::Eq => left == right,
        CompareOp::Ne => left != right,
        CompareOp::Slt => signed().0 < signed().1,
        CompareOp::Sle => signed().0 <= signed().1,
        CompareOp::Sgt => signed().0 > signed().1,
        CompareOp::Sge => signed().0 >= signed().1,
        CompareOp::Ult => left < right,
        CompareOp::Ule => left <= right,
        CompareOp::Ugt => left > right,
        CompareOp::Uge => left >= right,
        CompareOp::Feq => floats().0 == floats().1,
        CompareOp::Fne => floats().0 != floats().1,
        CompareOp::Flt => floats().0 < floats().1,
        CompareOp::Fle => floats().0 <= floats().1,
        CompareOp::Fgt => floats().0 > floats().1,
        CompareOp::Fge => floats().0 >= floats().1,
    }
}
