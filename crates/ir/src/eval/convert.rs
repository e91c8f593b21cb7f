//! Conversions from one type to another.

use super::float::{bits_32, bits_64, not_a_float, widened};
use crate::{ConvertOp, Type};

/// The result, of type `to`, of converting an operand of type `from`.
pub fn eval_convert(op: ConvertOp, from: Type, to: Type, arg: u64) -> u64 {
    match op {
        ConvertOp::Trunc => arg & to.mask(),
        ConvertOp::Zext | ConvertOp::FloatBits | ConvertOp::BitsFloat => arg,
        ConvertOp::Sext => from.signed(arg) as u64 & to.mask(),
        ConvertOp::Promote => bits_64(widened(from, arg)),
        ConvertOp::Demote => bits_32(widened(from, arg) as f32),
        ConvertOp::SintToFloat => signed_to_float(to, from.signed(arg)),
        ConvertOp::UintToFloat => unsigned_to_float(to, arg),
        ConvertOp::FloatToSint => float_to_signed(to, widened(from, arg)) as u64 & to.mask(),
        ConvertOp::FloatToUint => float_to_unsigned(to, widened(from, arg)),
    }
}

/// `as` rounds integers to the nearest float, ties to even; via `f64` an `f32` would be rounded
/// twice.
fn signed_to_float(to: Type, number: i64) -> u64 {
    match to {
        Type::F32 => bits_32(number as f32),
        Type::F64 => bits_64(number as f64),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => not_a_float(to),
    }
}

fn unsigned_to_float(to: Type, number: u64) -> u64 {
    match to {
        Type::F32 => bits_32(number as f32),
        Type::F64 => bits_64(number as f64),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => not_a_float(to),
    }
}

/// `as` saturates at the bounds of 64 bits and takes NaN to 0.
fn float_to_signed(to: Type, number: f64) -> i64 {
    let widest = number.round_ties_even() as i64;
    let max = i64::MAX >> (64 - to.bits());
    widest.clamp(!max, max)
}

fn float_to_unsigned(to: Type, number: f64) -> u64 {
    let widest = number.round_ties_even() as u64;
    widest.min(to.mask())
}
