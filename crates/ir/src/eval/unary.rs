//! Operations with one operand; those of integers wrap, those of floats give the canonical NaN.

use super::float;
use crate::{Type, UnaryOp};

/// The result of a unary operation.
pub fn eval_unary(op: UnaryOp, ty: Type, arg: u64) -> u64 {
    match op {
        UnaryOp::Not => !arg & ty.mask(),
        UnaryOp::Neg => arg.wrapping_neg() & ty.mask(),
        UnaryOp::Fneg => float::map(ty, arg, |x| -x, |x| -x),
        UnaryOp::Fabs => float::map(ty, arg, f32::abs, f64::abs),
        UnaryOp::Fsqrt => float::map(ty, arg, f32::sqrt, f64::sqrt),
    }
}
