//! Two operands, one type.

use super::*;
use iecc_ir::BinaryOp::{
    self, Add, And, Fadd, Fdiv, Fmul, Fsub, Mul, Or, Sdiv, Shl, Srem, Sshr, Sub, Udiv, Urem, Ushr,
    Xor,
};
use iecc_ir::Type::{F32, F64, I1, I8, I16, I32, I64};
use iecc_ir::{Type, eval::eval_binary};

const MIN_32: u64 = 0x8000_0000;
const MIN_64: u64 = 0x8000_0000_0000_0000;

type Row = (BinaryOp, Type, u64, u64, u64);

/// -n in the bits of a type.
fn minus(ty: Type, number: u64) -> u64 {
    number.wrapping_neg() & ty.mask()
}

fn arithmetic() -> Vec<Row> {
    vec![
        (Add, I8, 0x7f, 1, 0x80),
        (Add, I8, 0xff, 1, 0),
        (Add, I16, 0x8000, 0x8000, 0),
        (Add, I32, 0x7fff_ffff, 1, MIN_32),
        (Add, I64, u64::MAX, 2, 1),
        (Sub, I8, 0x80, 1, 0x7f),
        (Sub, I16, 0, 1, 0xffff),
        (Sub, I32, 5, 7, minus(I32, 2)),
        (Sub, I64, 0, 1, u64::MAX),
        (Mul, I8, 0x10, 0x10, 0),
        (Mul, I8, 0xff, 0xff, 1),
        (Mul, I16, 300, 300, 90_000 - 65_536),
        (Mul, I32, 0x1_0000, 0x1_0001, 0x1_0000),
        (Mul, I64, 1 << 63, 3, 1 << 63),
        (Sdiv, I8, 7, 2, 3),
        (Sdiv, I8, minus(I8, 7), 2, minus(I8, 3)),
        (Sdiv, I8, 7, minus(I8, 2), minus(I8, 3)),
        (Sdiv, I8, 0x80, 0xff, 0x80),
        (Sdiv, I16, 0x8000, 0xffff, 0x8000),
        (Sdiv, I32, MIN_32, minus(I32, 1), MIN_32),
        (Sdiv, I64, MIN_64, u64::MAX, MIN_64),
        (Sdiv, I32, 5, 0, 0),
        (Sdiv, I64, MIN_64, 0, 0),
        (Udiv, I8, 0xff, 2, 0x7f),
        (Udiv, I16, 1, 0, 0),
        (Udiv, I32, MIN_32, 0xffff_ffff, 0),
        (Udiv, I64, u64::MAX, 1, u64::MAX),
        (Srem, I8, 7, 2, 1),
        (Srem, I8, minus(I8, 7), 2, minus(I8, 1)),
        (Srem, I8, 7, minus(I8, 2), 1),
        (Srem, I8, 0x80, 0xff, 0),
        (Srem, I16, minus(I16, 7), 0, minus(I16, 7)),
        (Srem, I32, MIN_32, minus(I32, 1), 0),
        (Srem, I64, MIN_64, u64::MAX, 0),
        (Srem, I64, 9, 0, 9),
        (Urem, I8, 0xff, 16, 15),
        (Urem, I16, 7, 0, 7),
        (Urem, I32, MIN_32, 0xffff_ffff, MIN_32),
        (Urem, I64, u64::MAX, 10, 5),
    ]
}

fn bits() -> Vec<Row> {
    vec![
        (And, I1, 1, 1, 1),
        (And, I1, 1, 0, 0),
        (And, I8, 0xcc, 0xaa, 0x88),
        (And, I64, u64::MAX, 1 << 63, 1 << 63),
        (Or, I1, 0, 1, 1),
        (Or, I1, 0, 0, 0),
        (Or, I16, 0xcc, 0xaa, 0xee),
        (Xor, I1, 1, 1, 0),
        (Xor, I1, 1, 0, 1),
        (Xor, I32, 0xcc, 0xaa, 0x66),
        (Shl, I8, 0x81, 1, 0x02),
        (Shl, I8, 1, 7, 0x80),
        (Shl, I8, 1, 8, 0),
        // The count is unsigned: -1 is 255.
        (Shl, I8, 1, 0xff, 0),
        (Shl, I16, 1, 0x100, 0),
        (Shl, I32, 1, 31, MIN_32),
        (Shl, I32, 1, 32, 0),
        (Shl, I32, 1, 0xffff_ffff, 0),
        (Shl, I64, 1, 63, MIN_64),
        (Shl, I64, 1, 64, 0),
        (Shl, I64, 1, 1 << 32, 0),
        (Ushr, I8, 0x80, 7, 1),
        (Ushr, I8, 0xff, 8, 0),
        (Ushr, I16, 0x8000, 1, 0x4000),
        (Ushr, I32, 0xffff_ffff, 32, 0),
        (Ushr, I64, u64::MAX, 63, 1),
        (Ushr, I64, u64::MAX, 64, 0),
        (Sshr, I8, 0x80, 1, 0xc0),
        (Sshr, I8, 0x80, 7, 0xff),
        (Sshr, I8, 0x80, 8, 0xff),
        (Sshr, I8, 0x7f, 8, 0),
        (Sshr, I8, 0x40, 6, 1),
        (Sshr, I16, 0x8000, 0xffff, 0xffff),
        (Sshr, I32, MIN_32, 31, 0xffff_ffff),
        (Sshr, I32, MIN_32, 32, 0xffff_ffff),
        (Sshr, I64, MIN_64, 64, u64::MAX),
        (Sshr, I64, MIN_64, 1 << 40, u64::MAX),
        (Sshr, I64, 8, 3, 1),
    ]
}

fn floats() -> Vec<Row> {
    vec![
        (Fadd, F32, f32_bits(1.5), f32_bits(2.25), f32_bits(3.75)),
        // 2^24 + 1 lies in the middle of two floats; the even one is 2^24, of 2^24 + 3 it is + 4.
        (
            Fadd,
            F32,
            f32_bits(16_777_216.0),
            f32_bits(1.0),
            f32_bits(16_777_216.0),
        ),
        (
            Fadd,
            F32,
            f32_bits(16_777_218.0),
            f32_bits(1.0),
            f32_bits(16_777_220.0),
        ),
        (Fadd, F32, MINUS_0_32, 0, 0),
        (Fadd, F32, MINUS_0_32, MINUS_0_32, MINUS_0_32),
        (Fadd, F32, INF_32, MINUS_INF_32, NAN_32),
        (Fadd, F32, OTHER_NAN_32, f32_bits(1.0), NAN_32),
        (Fadd, F32, f32_bits(f32::MAX), f32_bits(f32::MAX), INF_32),
        (
            Fadd,
            F64,
            f64_bits(9_007_199_254_740_992.0),
            f64_bits(1.0),
            f64_bits(9_007_199_254_740_992.0),
        ),
        (Fadd, F64, f64_bits(1.0), SIGNALLING_64, NAN_64),
        (Fsub, F32, f32_bits(1.0), f32_bits(1.0), 0),
        (Fsub, F32, 0, 0, 0),
        (Fsub, F32, MINUS_0_32, 0, MINUS_0_32),
        (Fsub, F32, INF_32, INF_32, NAN_32),
        (Fsub, F64, INF_64, INF_64, NAN_64),
        (Fsub, F64, f64_bits(0.5), f64_bits(0.75), f64_bits(-0.25)),
        (Fmul, F32, f32_bits(1.5), f32_bits(-2.0), f32_bits(-3.0)),
        (Fmul, F32, MINUS_0_32, f32_bits(3.0), MINUS_0_32),
        (Fmul, F32, 0, INF_32, NAN_32),
        // The smallest subnormal halved: half of it is a tie and goes to 0.
        (Fmul, F32, 1, f32_bits(0.5), 0),
        // Three of them halved: 1.5 goes to 2.
        (Fmul, F32, 3, f32_bits(0.5), 2),
        (Fmul, F64, f64_bits(1e200), f64_bits(1e200), INF_64),
        (Fmul, F64, OTHER_NAN_64, OTHER_NAN_64, NAN_64),
        (Fdiv, F32, f32_bits(1.0), 0, INF_32),
        (Fdiv, F32, f32_bits(1.0), MINUS_0_32, MINUS_INF_32),
        (Fdiv, F32, 0, 0, NAN_32),
        // 1/3 = 0.0101…b; the 25th digit onwards rounds up: 0x3eaaaaab.
        (Fdiv, F32, f32_bits(1.0), f32_bits(3.0), 0x3eaa_aaab),
        (
            Fdiv,
            F64,
            f64_bits(1.0),
            f64_bits(3.0),
            0x3fd5_5555_5555_5555,
        ),
        (Fdiv, F64, INF_64, INF_64, NAN_64),
        (Fdiv, F64, f64_bits(-1.0), 0, MINUS_INF_64),
    ]
}

#[test]
fn binary_operations() {
    let table = [arithmetic(), bits(), floats()].concat();
    for &(op, ty, left, right, expected) in &table {
        let found = eval_binary(op, ty, left, right);
        assert_eq!(
            found, expected,
            "{op} {ty} {left:#x}, {right:#x} gave {found:#x}"
        );
    }
    covers(BinaryOp::ALL, table.iter().map(|row| row.0));
}

#[test]
fn commutative_operations_commute() {
    for (op, ty, left, right, _) in [arithmetic(), bits(), floats()].concat() {
        if op.is_commutative() {
            let (one, other) = (
                eval_binary(op, ty, left, right),
                eval_binary(op, ty, right, left),
            );
            assert_eq!(one, other, "{op} {ty} {left:#x}, {right:#x}");
        }
    }
}
