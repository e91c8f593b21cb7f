//! Numbers: conversions between types and arithmetic in one type.
//!
//! Integers are extended by their sign, except for logical operations, which fill with 0. Narrower
//! destinations keep the low bits. A float becomes an integer by rounding half to even and keeping
//! the low bits of the 64-bit result.

use crate::types::scalar;
use iecc_ir::{BinaryOp, CompareOp, ConvertOp, FunctionBuilder, Type, UnaryOp, Value};
use iecc_sema::hir::{Arithmetic, CompareOp as Compare, Const, Elementary, Logical};

/// How a narrow integer is widened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extend {
    /// By its sign, if its type has one.
    Sign,
    /// With 0, as logical operations do.
    Zero,
}

/// A literal as a value of a type.
pub(crate) fn constant(builder: &mut FunctionBuilder, constant: Const, ty: Elementary) -> Value {
    let ir = scalar(ty);
    match (constant, ty) {
        (Const::Float { single, .. }, Elementary::Real) => {
            builder.constant(ir, u64::from(single.to_bits()))
        }
        (Const::Float { double, .. }, Elementary::Lreal) => builder.constant(ir, double.to_bits()),
        (_, _) => {
            let own = constant.ty();
            let bits = match constant {
                Const::Integer { bits, .. } => bits,
                Const::Float { single, .. } => u64::from(single.to_bits()),
            };
            let value = builder.constant(scalar(own), bits);
            convert(builder, value, own, ty, Extend::Sign)
        }
    }
}

/// A value of type `from` as one of type `to`.
pub(crate) fn convert(
    builder: &mut FunctionBuilder,
    value: Value,
    from: Elementary,
    to: Elementary,
    extend: Extend,
) -> Value {
    match (from.is_float(), to.is_float()) {
        (false, false) => resize(
            builder,
            value,
            scalar(to),
            from.is_signed() && extend == Extend::Sign,
        ),
        (false, true) if from.is_signed() => {
            builder.convert(ConvertOp::SintToFloat, scalar(to), value)
        }
        (false, true) => builder.convert(ConvertOp::UintToFloat, scalar(to), value),
        (true, true) => refloat(builder, value, scalar(to)),
        (true, false) => {
            let wide = round(builder, value, to);
            resize(builder, wide, scalar(to), true)
        }
    }
}

fn resize(builder: &mut FunctionBuilder, value: Value, to: Type, signed: bool) -> Value {
    let from = builder.value_type(value);
    if to.bits() < from.bits() {
        builder.convert(ConvertOp::Trunc, to, value)
    } else if to == from {
        value
    } else if signed {
        builder.convert(ConvertOp::Sext, to, value)
    } else {
        builder.convert(ConvertOp::Zext, to, value)
    }
}

fn refloat(builder: &mut FunctionBuilder, value: Value, to: Type) -> Value {
    let from = builder.value_type(value);
    if to.bits() < from.bits() {
        builder.convert(ConvertOp::Demote, to, value)
    } else if to == from {
        value
    } else {
        builder.convert(ConvertOp::Promote, to, value)
    }
}

/// The nearest whole number in 64 bits, of which the destination keeps the low ones.
fn round(builder: &mut FunctionBuilder, value: Value, to: Elementary) -> Value {
    let signed = builder.convert(ConvertOp::FloatToSint, Type::I64, value);
    if to != Elementary::Ulint {
        return signed;
    }
    // The upper half of ULINT is beyond what a signed number of 64 bits holds.
    let unsigned = builder.convert(ConvertOp::FloatToUint, Type::I64, value);
    let zero = builder.constant(builder.value_type(value), 0);
    let negative = builder.compare(CompareOp::Flt, value, zero);
    builder.select(negative, signed, unsigned)
}

/// Whether a comparison in a type holds.
pub(crate) fn compare(
    builder: &mut FunctionBuilder,
    op: Compare,
    ty: Elementary,
    left: Value,
    right: Value,
) -> Value {
    builder.compare(compare_op(op, ty), left, right)
}

fn compare_op(op: Compare, ty: Elementary) -> CompareOp {
    match (op, ty.is_float(), ty.is_signed()) {
        (Compare::Equal, false, _) => CompareOp::Eq,
        (Compare::Equal, true, _) => CompareOp::Feq,
        (Compare::NotEqual, false, _) => CompareOp::Ne,
        (Compare::NotEqual, true, _) => CompareOp::Fne,
        (Compare::Greater, true, _) => CompareOp::Fgt,
        (Compare::Greater, false, true) => CompareOp::Sgt,
        (Compare::Greater, false, false) => CompareOp::Ugt,
        (Compare::GreaterEqual, true, _) => CompareOp::Fge,
        (Compare::GreaterEqual, false, true) => CompareOp::Sge,
        (Compare::GreaterEqual, false, false) => CompareOp::Uge,
        (Compare::Less, true, _) => CompareOp::Flt,
        (Compare::Less, false, true) => CompareOp::Slt,
        (Compare::Less, false, false) => CompareOp::Ult,
        (Compare::LessEqual, true, _) => CompareOp::Fle,
        (Compare::LessEqual, false, true) => CompareOp::Sle,
        (Compare::LessEqual, false, false) => CompareOp::Ule,
    }
}

/// The result of arithmetic in a type. What division by zero gives does not matter: the
/// destination is kept then.
pub(crate) fn arithmetic(
    builder: &mut FunctionBuilder,
    op: Arithmetic,
    ty: Elementary,
    left: Value,
    right: Value,
) -> Value {
    if ty.is_float() && op == Arithmetic::Modulo {
        return float_modulo(builder, left, right);
    }
    builder.binary(arithmetic_op(op, ty), left, right)
}

fn arithmetic_op(op: Arithmetic, ty: Elementary) -> BinaryOp {
    match (op, ty.is_float(), ty.is_signed()) {
        (Arithmetic::Add, false, _) => BinaryOp::Add,
        (Arithmetic::Add, true, _) => BinaryOp::Fadd,
        (Arithmetic::Subtract, false, _) => BinaryOp::Sub,
        (Arithmetic::Subtract, true, _) => BinaryOp::Fsub,
        (Arithmetic::Multiply, false, _) => BinaryOp::Mul,
        (Arithmetic::Multiply, true, _) => BinaryOp::Fmul,
        (Arithmetic::Divide, true, _) => BinaryOp::Fdiv,
        (Arithmetic::Divide, false, true) => BinaryOp::Sdiv,
        (Arithmetic::Divide, false, false) => BinaryOp::Udiv,
        (Arithmetic::Modulo, false, true) => BinaryOp::Srem,
        (Arithmetic::Modulo, false, false) => BinaryOp::Urem,
        (Arithmetic::Modulo, true, _) => unreachable!("has a formula of its own"),
    }
}

/// A - TRN(A / B) * B, the vendor's formula.
fn float_modulo(builder: &mut FunctionBuilder, left: Value, right: Value) -> Value {
    let quotient = builder.binary(BinaryOp::Fdiv, left, right);
    let whole = truncate(builder, quotient);
    let product = builder.binary(BinaryOp::Fmul, whole, right);
    builder.binary(BinaryOp::Fsub, left, product)
}

/// The float without its fraction. The conversion rounds to the nearest, so one is taken back
/// where that went away from 0; from 2^52 on (and for NaN) floats have no fraction.
pub(crate) fn truncate(builder: &mut FunctionBuilder, value: Value) -> Value {
    let ty = builder.value_type(value);
    let float = |builder: &mut FunctionBuilder, number: f64| {
        let bits = if ty == Type::F32 {
            u64::from((number as f32).to_bits())
        } else {
            number.to_bits()
        };
        builder.constant(ty, bits)
    };
    let size = builder.unary(UnaryOp::Fabs, value);
    let whole = builder.convert(ConvertOp::FloatToSint, Type::I64, size);
    let nearest = builder.convert(ConvertOp::SintToFloat, ty, whole);
    let one = float(builder, 1.0);
    let below = builder.binary(BinaryOp::Fsub, nearest, one);
    let above = builder.compare(CompareOp::Fgt, nearest, size);
    let down = builder.select(above, below, nearest);
    let zero = float(builder, 0.0);
    let negative = builder.compare(CompareOp::Flt, value, zero);
    let minus = builder.unary(UnaryOp::Fneg, down);
    let signed = builder.select(negative, minus, down);
    let limit = float(builder, 4_503_599_627_370_496.0);
    let small = builder.compare(CompareOp::Flt, size, limit);
    builder.select(small, signed, value)
}

/// 0 - x.
pub(crate) fn negate(builder: &mut FunctionBuilder, ty: Elementary, value: Value) -> Value {
    let op = if ty.is_float() {
        UnaryOp::Fneg
    } else {
        UnaryOp::Neg
    };
    builder.unary(op, value)
}

/// The size of a number; that of the smallest integer wraps to itself.
pub(crate) fn absolute(builder: &mut FunctionBuilder, ty: Elementary, value: Value) -> Value {
    if ty.is_float() {
        return builder.unary(UnaryOp::Fabs, value);
    }
    if !ty.is_signed() {
        return value;
    }
    let zero = builder.constant(scalar(ty), 0);
    let negative = builder.compare(CompareOp::Slt, value, zero);
    let minus = builder.unary(UnaryOp::Neg, value);
    builder.select(negative, minus, value)
}

/// A bitwise operation.
pub(crate) fn logical(op: Logical) -> BinaryOp {
    match op {
        Logical::And => BinaryOp::And,
        Logical::Or => BinaryOp::Or,
        Logical::Xor => BinaryOp::Xor,
    }
}
