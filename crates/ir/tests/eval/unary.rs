//! One operand.

use super::*;
use iecc_ir::Type::{F32, F64, I1, I8, I16, I32, I64};
use iecc_ir::UnaryOp::{self, Fabs, Fneg, Fsqrt, Neg, Not};
use iecc_ir::{Type, eval::eval_unary};

#[test]
fn unary_operations() {
    let table: &[(UnaryOp, Type, u64, u64)] = &[
        (Not, I1, 0, 1),
        (Not, I1, 1, 0),
        (Not, I8, 0x0f, 0xf0),
        (Not, I16, 0, 0xffff),
        (Not, I32, 0x1234_5678, 0xedcb_a987),
        (Not, I64, 0, u64::MAX),
        (Neg, I8, 1, 0xff),
        (Neg, I8, 0x80, 0x80),
        (Neg, I16, 0xffff, 1),
        (Neg, I32, 0x8000_0000, 0x8000_0000),
        (Neg, I32, 0, 0),
        (Neg, I64, 5, 5u64.wrapping_neg()),
        (Neg, I64, 1 << 63, 1 << 63),
        (Fneg, F32, 0, MINUS_0_32),
        (Fneg, F32, MINUS_0_32, 0),
        (Fneg, F32, f32_bits(1.5), f32_bits(-1.5)),
        (Fneg, F32, INF_32, MINUS_INF_32),
        (Fneg, F32, NAN_32, NAN_32),
        (Fneg, F32, OTHER_NAN_32, NAN_32),
        (Fneg, F64, f64_bits(-2.25), f64_bits(2.25)),
        (Fneg, F64, NAN_64, NAN_64),
        (Fabs, F32, MINUS_0_32, 0),
        (Fabs, F32, MINUS_INF_32, INF_32),
        (Fabs, F32, SIGNALLING_32, NAN_32),
        (Fabs, F64, f64_bits(-0.1), f64_bits(0.1)),
        (Fabs, F64, OTHER_NAN_64, NAN_64),
        (Fsqrt, F32, f32_bits(9.0), f32_bits(3.0)),
        // sqrt 2 = 1.41421356237…, between 0x3fb504f3 and 0x3fb504f4 and nearer to the first.
        (Fsqrt, F32, f32_bits(2.0), 0x3fb5_04f3),
        (Fsqrt, F32, MINUS_0_32, MINUS_0_32),
        (Fsqrt, F32, f32_bits(-1.0), NAN_32),
        (Fsqrt, F32, INF_32, INF_32),
        (Fsqrt, F64, f64_bits(2.0), 0x3ff6_a09e_667f_3bcd),
        (Fsqrt, F64, MINUS_INF_64, NAN_64),
        (Fsqrt, F64, SIGNALLING_64, NAN_64),
    ];
    for &(op, ty, arg, expected) in table {
        let found = eval_unary(op, ty, arg);
        assert_eq!(found, expected, "{op} {ty} {arg:#x} gave {found:#x}");
    }
    covers(UnaryOp::ALL, table.iter().map(|row| row.0));
}
