//! Comparisons.

use super::*;
use iecc_ir::CompareOp::{
    self, Eq, Feq, Fge, Fgt, Fle, Flt, Fne, Ne, Sge, Sgt, Sle, Slt, Uge, Ugt, Ule, Ult,
};
use iecc_ir::Type::{F32, F64, I1, I8, I16, I32, I64};
use iecc_ir::{Type, eval::eval_compare};

type Row = (CompareOp, Type, u64, u64, bool);

/// The six answers for one pair: eq ne lt le gt ge.
fn six(ops: [CompareOp; 6], ty: Type, left: u64, right: u64, answers: [u8; 6]) -> Vec<Row> {
    let rows = ops.into_iter().zip(answers);
    rows.map(|(op, answer)| (op, ty, left, right, answer == 1))
        .collect()
}

const SIGNED: [CompareOp; 6] = [Eq, Ne, Slt, Sle, Sgt, Sge];
const UNSIGNED: [CompareOp; 6] = [Eq, Ne, Ult, Ule, Ugt, Uge];
const FLOAT: [CompareOp; 6] = [Feq, Fne, Flt, Fle, Fgt, Fge];

const LESS: [u8; 6] = [0, 1, 1, 1, 0, 0];
const EQUAL: [u8; 6] = [1, 0, 0, 1, 0, 1];
const GREATER: [u8; 6] = [0, 1, 0, 0, 1, 1];
const UNORDERED: [u8; 6] = [0, 1, 0, 0, 0, 0];

fn table() -> Vec<Row> {
    let pairs = [
        six(SIGNED, I8, 0x80, 0x7f, LESS),
        six(UNSIGNED, I8, 0x80, 0x7f, GREATER),
        six(SIGNED, I16, 0xffff, 0, LESS),
        six(UNSIGNED, I16, 0xffff, 0, GREATER),
        six(SIGNED, I32, 5, 5, EQUAL),
        six(UNSIGNED, I32, 5, 5, EQUAL),
        six(SIGNED, I32, 1, 0x8000_0000, GREATER),
        six(UNSIGNED, I32, 1, 0x8000_0000, LESS),
        six(SIGNED, I64, 1 << 63, u64::MAX, LESS),
        six(UNSIGNED, I64, u64::MAX, 1 << 63, GREATER),
        six(FLOAT, F32, f32_bits(1.0), f32_bits(2.0), LESS),
        six(FLOAT, F32, MINUS_0_32, 0, EQUAL),
        six(FLOAT, F32, NAN_32, NAN_32, UNORDERED),
        six(FLOAT, F32, f32_bits(1.0), OTHER_NAN_32, UNORDERED),
        six(FLOAT, F32, MINUS_INF_32, INF_32, LESS),
        six(FLOAT, F64, f64_bits(0.1), f64_bits(0.1), EQUAL),
        six(FLOAT, F64, f64_bits(3.0), f64_bits(-3.0), GREATER),
        six(FLOAT, F64, SIGNALLING_64, INF_64, UNORDERED),
    ];
    let bits = [
        (Eq, I1, 1, 1, true),
        (Eq, I1, 0, 1, false),
        (Ne, I1, 0, 1, true),
        (Ne, I1, 0, 0, false),
    ];
    pairs.concat().into_iter().chain(bits).collect()
}

#[test]
fn comparisons() {
    let table = table();
    for &(op, ty, left, right, expected) in &table {
        let found = eval_compare(op, ty, left, right);
        assert_eq!(found, expected, "{op} {ty} {left:#x}, {right:#x}");
        let swapped = eval_compare(op.swapped(), ty, right, left);
        assert_eq!(swapped, expected, "{op} swapped");
        if let Some(inverted) = op.inverted() {
            assert_eq!(
                eval_compare(inverted, ty, left, right),
                !expected,
                "{op} inverted"
            );
        }
    }
    covers(CompareOp::ALL, table.iter().map(|row| row.0));
}
