//! Conversions.

use super::*;
use iecc_ir::ConvertOp::{
    self, BitsFloat, Demote, FloatBits, FloatToSint, FloatToUint, Promote, Sext, SintToFloat,
    Trunc, UintToFloat, Zext,
};
use iecc_ir::Type::{F32, F64, I1, I8, I16, I32, I64};
use iecc_ir::{Type, eval::eval_convert};

type Row = (ConvertOp, Type, Type, u64, u64);

fn integers() -> Vec<Row> {
    vec![
        (Trunc, I8, I1, 0xfe, 0),
        (Trunc, I64, I1, 3, 1),
        (Trunc, I32, I8, 0x1234, 0x34),
        (Trunc, I64, I32, u64::MAX, 0xffff_ffff),
        (Zext, I1, I32, 1, 1),
        (Zext, I8, I16, 0x80, 0x80),
        (Zext, I32, I64, 0xffff_ffff, 0xffff_ffff),
        (Sext, I1, I8, 1, 0xff),
        (Sext, I1, I64, 0, 0),
        (Sext, I8, I16, 0x80, 0xff80),
        (Sext, I8, I32, 0x7f, 0x7f),
        (Sext, I32, I64, 0x8000_0000, 0xffff_ffff_8000_0000),
    ]
}

fn to_floats() -> Vec<Row> {
    vec![
        (
            Promote,
            F32,
            F64,
            f32_bits(0.1),
            f64_bits(0.100_000_001_490_116_12),
        ),
        (Promote, F32, F64, MINUS_0_32, MINUS_0_64),
        (Promote, F32, F64, OTHER_NAN_32, NAN_64),
        // The smallest subnormal of f32 is 2^-149: exponent 1023 - 149 = 0x36a.
        (Promote, F32, F64, 1, 0x36a0_0000_0000_0000),
        (Demote, F64, F32, f64_bits(0.1), f32_bits(0.1)),
        (
            Demote,
            F64,
            F32,
            f64_bits(16_777_217.0),
            f32_bits(16_777_216.0),
        ),
        (
            Demote,
            F64,
            F32,
            f64_bits(16_777_219.0),
            f32_bits(16_777_220.0),
        ),
        (Demote, F64, F32, f64_bits(1e39), INF_32),
        (Demote, F64, F32, f64_bits(-1e-60), MINUS_0_32),
        (Demote, F64, F32, OTHER_NAN_64, NAN_32),
        (Demote, F64, F32, MINUS_INF_64, MINUS_INF_32),
        (SintToFloat, I1, F32, 1, f32_bits(-1.0)),
        (SintToFloat, I8, F32, 0x80, f32_bits(-128.0)),
        (SintToFloat, I32, F32, 16_777_217, f32_bits(16_777_216.0)),
        (SintToFloat, I32, F32, 16_777_219, f32_bits(16_777_220.0)),
        (SintToFloat, I32, F64, 0xffff_ffff, f64_bits(-1.0)),
        (
            SintToFloat,
            I64,
            F64,
            9_007_199_254_740_993,
            f64_bits(9_007_199_254_740_992.0),
        ),
        (
            SintToFloat,
            I64,
            F64,
            1 << 63,
            f64_bits(-9_223_372_036_854_775_808.0),
        ),
        // 2^62 + 2^38 + 1 is just above the middle of two f32; through f64 it would become the
        // middle and go down to the even one.
        (
            SintToFloat,
            I64,
            F32,
            (1 << 62) + (1 << 38) + 1,
            0x5e80_0001,
        ),
        (SintToFloat, I64, F32, (1 << 62) + (1 << 38), 0x5e80_0000),
        (UintToFloat, I1, F64, 1, f64_bits(1.0)),
        (UintToFloat, I8, F32, 0xff, f32_bits(255.0)),
        (
            UintToFloat,
            I32,
            F64,
            0xffff_ffff,
            f64_bits(4_294_967_295.0),
        ),
        (
            UintToFloat,
            I64,
            F32,
            u64::MAX,
            f32_bits(18_446_744_073_709_551_616.0),
        ),
        (
            UintToFloat,
            I64,
            F64,
            u64::MAX,
            f64_bits(18_446_744_073_709_551_616.0),
        ),
        (BitsFloat, I32, F32, 0x3fc0_0000, f32_bits(1.5)),
        (BitsFloat, I32, F32, OTHER_NAN_32, OTHER_NAN_32),
        (BitsFloat, I64, F64, SIGNALLING_64, SIGNALLING_64),
    ]
}

fn from_floats() -> Vec<Row> {
    let minus = |ty: Type, number: u64| number.wrapping_neg() & ty.mask();
    vec![
        (FloatToSint, F32, I32, f32_bits(0.5), 0),
        (FloatToSint, F32, I32, f32_bits(1.5), 2),
        (FloatToSint, F32, I32, f32_bits(2.5), 2),
        (FloatToSint, F32, I32, f32_bits(-0.5), 0),
        (FloatToSint, F32, I32, f32_bits(-1.5), minus(I32, 2)),
        (FloatToSint, F32, I32, f32_bits(-2.5), minus(I32, 2)),
        (FloatToSint, F32, I32, f32_bits(2.75), 3),
        (FloatToSint, F32, I32, f32_bits(3e9), 0x7fff_ffff),
        (FloatToSint, F32, I32, MINUS_INF_32, 0x8000_0000),
        (FloatToSint, F32, I32, NAN_32, 0),
        (FloatToSint, F64, I8, f64_bits(127.5), 0x7f),
        (FloatToSint, F64, I8, f64_bits(127.4), 0x7f),
        (FloatToSint, F64, I8, f64_bits(-128.5), 0x80),
        (FloatToSint, F64, I8, f64_bits(-1000.0), 0x80),
        (FloatToSint, F64, I16, f64_bits(32_767.5), 0x7fff),
        (FloatToSint, F64, I64, f64_bits(9.3e18), i64::MAX as u64),
        (FloatToSint, F64, I64, f64_bits(-9.3e18), i64::MIN as u64),
        (FloatToSint, F64, I64, OTHER_NAN_64, 0),
        (FloatToUint, F32, I8, f32_bits(254.5), 254),
        (FloatToUint, F32, I8, f32_bits(255.5), 255),
        (FloatToUint, F32, I16, f32_bits(-1.0), 0),
        (
            FloatToUint,
            F32,
            I32,
            f32_bits(4_294_967_296.0),
            0xffff_ffff,
        ),
        (
            FloatToUint,
            F64,
            I32,
            f64_bits(4_294_967_294.5),
            4_294_967_294,
        ),
        (FloatToUint, F64, I64, INF_64, u64::MAX),
        (FloatToUint, F64, I64, f64_bits(-0.4), 0),
        (FloatToUint, F64, I64, NAN_64, 0),
        (FloatBits, F32, I32, OTHER_NAN_32, OTHER_NAN_32),
        (FloatBits, F32, I32, f32_bits(-0.0), MINUS_0_32),
        (FloatBits, F64, I64, f64_bits(1.0), 0x3ff0_0000_0000_0000),
    ]
}

#[test]
fn conversions() {
    let table = [integers(), to_floats(), from_floats()].concat();
    for &(op, from, to, arg, expected) in &table {
        assert!(op.accepts(from, to), "{op} {from} to {to}");
        let found = eval_convert(op, from, to, arg);
        assert_eq!(
            found, expected,
            "{op} {from} {arg:#x} to {to} gave {found:#x}"
        );
    }
    covers(ConvertOp::ALL, table.iter().map(|row| row.0));
}
