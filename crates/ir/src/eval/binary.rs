//! Operations with two operands of one type and a result of that type.

use super::float;
use crate::{BinaryOp, Type};
use std::ops::{Add, Div, Mul, Sub};

/// The result of a binary operation.
pub fn eval_binary(op: BinaryOp, ty: Type, left: u64, right: u64) -> u64 {
    let args = [left, right];
    let bits = match op {
        BinaryOp::Add => left.wrapping_add(right),
        BinaryOp::Sub => left.wrapping_sub(right),
        BinaryOp::Mul => left.wrapping_mul(right),
        BinaryOp::Sdiv => signed_quotient(ty.signed(left), ty.signed(right)) as u64,
        BinaryOp::Udiv => left.checked_div(right).unwrap_or(0),
        BinaryOp::Srem => signed_remainder(ty.signed(left), ty.signed(right)) as u64,
        BinaryOp::Urem => left.checked_rem(right).unwrap_or(left),
        BinaryOp::And => left & right,
        BinaryOp::Or => left | right,
        BinaryOp::Xor => left ^ right,
        BinaryOp::Shl => match count(ty, right) {
            Some(count) => left << count,
            None => 0,
        },
        BinaryOp::Ushr => match count(ty, right) {
            Some(count) => left >> count,
            None => 0,
        },
        BinaryOp::Sshr => {
            let sign_count = ty.bits() - 1;
            (ty.signed(left) >> count(ty, right).unwrap_or(sign_count)) as u64
        }
        BinaryOp::Fadd => float::zip(ty, args, f32::add, f64::add),
        BinaryOp::Fsub => float::zip(ty, args, f32::sub, f64::sub),
        BinaryOp::Fmul => float::zip(ty, args, f32::mul, f64::mul),
        BinaryOp::Fdiv => float::zip(ty, args, f32::div, f64::div),
    };
    bits & ty.mask()
}

/// `MIN / -1` of a narrow type leaves its range; the caller's mask brings it back to `MIN`.
fn signed_quotient(left: i64, right: i64) -> i64 {
    match right {
        0 => 0,
        _ => left.wrapping_div(right),
    }
}

fn signed_remainder(left: i64, right: i64) -> i64 {
    match right {
        0 => left,
        _ => left.wrapping_rem(right),
    }
}

/// A shift count below the width.
fn count(ty: Type, bits: u64) -> Option<u32> {
    (bits < u64::from(ty.bits())).then_some(bits as u32)
}
