//! Floats as bits: arithmetic on either width with canonical NaN results.

use crate::Type;

/// The bits of the only NaN that arithmetic gives.
pub fn canonical_nan(ty: Type) -> u64 {
    match ty {
        Type::F32 => 0x7fc0_0000,
        Type::F64 => 0x7ff8_0000_0000_0000,
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => not_a_float(ty),
    }
}

/// The bits of a result, NaN made canonical.
pub(super) fn bits_32(result: f32) -> u64 {
    if result.is_nan() {
        canonical_nan(Type::F32)
    } else {
        u64::from(result.to_bits())
    }
}

/// The bits of a result, NaN made canonical.
pub(super) fn bits_64(result: f64) -> u64 {
    if result.is_nan() {
        canonical_nan(Type::F64)
    } else {
        result.to_bits()
    }
}

/// The number these bits stand for.
pub(super) fn float_32(bits: u64) -> f32 {
    f32::from_bits(bits as u32)
}

/// The number these bits stand for, exact for both widths.
pub(super) fn widened(ty: Type, bits: u64) -> f64 {
    match ty {
        Type::F32 => f64::from(float_32(bits)),
        Type::F64 => f64::from_bits(bits),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => not_a_float(ty),
    }
}

/// Applies the operation of the type's width.
pub(super) fn map(ty: Type, arg: u64, on_32: fn(f32) -> f32, on_64: fn(f64) -> f64) -> u64 {
    match ty {
        Type::F32 => bits_32(on_32(float_32(arg))),
        Type::F64 => bits_64(on_64(f64::from_bits(arg))),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => not_a_float(ty),
    }
}

/// Applies the operation of the type's width.
pub(super) fn zip(
    ty: Type,
    args: [u64; 2],
    on_32: fn(f32, f32) -> f32,
    on_64: fn(f64, f64) -> f64,
) -> u64 {
    let [a, b] = args;
    match ty {
        Type::F32 => bits_32(on_32(float_32(a), float_32(b))),
        Type::F64 => bits_64(on_64(f64::from_bits(a), f64::from_bits(b))),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => not_a_float(ty),
    }
}

pub(super) fn not_a_float(ty: Type) -> ! {
    panic!("{ty} is not a float; the verifier refuses this")
}
