//! Conversions between elementary types, as Structured Text has them.

use crate::types::scalar;
use crate::values::{self, Extend};
use iecc_ir::{BinaryOp, CompareOp, ConvertOp, FunctionBuilder, Type, Value};
use iecc_sema::hir::Elementary;
use iecc_sema::hir::code::Conversion;

/// A value of type `from` as one of type `to`.
pub(super) fn convert(
    builder: &mut FunctionBuilder,
    conversion: Conversion,
    value: Value,
    from: Elementary,
    to: Elementary,
) -> Value {
    match conversion {
        Conversion::Value => by_value(builder, value, from, to),
        Conversion::Truncate if from.is_float() && to.is_integer() => {
            let whole = values::truncate(builder, value);
            by_value(builder, whole, from, to)
        }
        Conversion::Truncate => by_value(builder, value, from, to),
        Conversion::Bits => by_bits(builder, value, to),
    }
}

fn by_value(
    builder: &mut FunctionBuilder,
    value: Value,
    from: Elementary,
    to: Elementary,
) -> Value {
    if to == Elementary::Bool {
        return not_zero(builder, value, from);
    }
    match (from.is_float(), to.is_float()) {
        (true, false) if to.is_signed() => {
            builder.convert(ConvertOp::FloatToSint, scalar(to), value)
        }
        (true, false) => builder.convert(ConvertOp::FloatToUint, scalar(to), value),
        // As in ladder: widened by sign, cut, rounded.
        (_, _) => values::convert(builder, value, from, to, Extend::Sign),
    }
}

/// Whether a number is not 0; NaN counts as 0.
fn not_zero(builder: &mut FunctionBuilder, value: Value, from: Elementary) -> Value {
    if from == Elementary::Bool {
        return value;
    }
    let zero = builder.constant(scalar(from), 0);
    if !from.is_float() {
        return builder.compare(CompareOp::Ne, value, zero);
    }
    let below = builder.compare(CompareOp::Flt, value, zero);
    let above = builder.compare(CompareOp::Fgt, value, zero);
    builder.binary(BinaryOp::Or, below, above)
}

fn by_bits(builder: &mut FunctionBuilder, value: Value, to: Elementary) -> Value {
    let bits = float_bits(builder, value);
    let to = scalar(to);
    let sized = resize(builder, bits, bits_type(to));
    if to.is_float() {
        builder.convert(ConvertOp::BitsFloat, to, sized)
    } else {
        sized
    }
}

/// The pattern of a float; an integer as it is.
pub(super) fn float_bits(builder: &mut FunctionBuilder, value: Value) -> Value {
    let ty = builder.value_type(value);
    if ty.is_float() {
        builder.convert(ConvertOp::FloatBits, bits_type(ty), value)
    } else {
        value
    }
}

/// The integer type of a type's width.
pub(super) fn bits_type(ty: Type) -> Type {
    match ty {
        Type::F32 => Type::I32,
        Type::F64 => Type::I64,
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => ty,
    }
}

/// An integer with 0 in front or cut.
pub(super) fn resize(builder: &mut FunctionBuilder, value: Value, to: Type) -> Value {
    let from = builder.value_type(value);
    if to.bits() < from.bits() {
        builder.convert(ConvertOp::Trunc, to, value)
    } else if to == from {
        value
    } else {
        builder.convert(ConvertOp::Zext, to, value)
    }
}
