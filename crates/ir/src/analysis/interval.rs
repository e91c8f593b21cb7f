//! Interval arithmetic: the range of a result from the ranges of the operands.
//!
//! Every function is sound: it holds all results of operands in the given ranges. Where wrapping
//! is possible the answer is everything the type holds.

use super::Range;
use crate::{BinaryOp, CompareOp, ConvertOp, Type, UnaryOp};

/// The range from exact bounds, or the whole type if they do not fit.
fn exact(ty: Type, lo: i128, hi: i128) -> Range {
    let whole = Range::of_type(ty);
    if lo < i128::from(whole.lo) || hi > i128::from(whole.hi) {
        return whole;
    }
    Range::new(lo as i64, hi as i64)
}

fn corners(ty: Type, a: Range, b: Range, f: impl Fn(i128, i128) -> i128) -> Range {
    let at = |x: i64, y: i64| f(i128::from(x), i128::from(y));
    let all = [
        at(a.lo, b.lo),
        at(a.lo, b.hi),
        at(a.hi, b.lo),
        at(a.hi, b.hi),
    ];
    exact(
        ty,
        *all.iter().min().expect("four"),
        *all.iter().max().expect("four"),
    )
}

/// The result of a unary operation on an integer type.
pub fn unary(op: UnaryOp, ty: Type, x: Range) -> Range {
    match op {
        UnaryOp::Not if ty == Type::I1 => Range::new(1 - x.hi, 1 - x.lo),
        UnaryOp::Not => Range::new(!x.hi, !x.lo),
        UnaryOp::Neg => exact(ty, -i128::from(x.hi), -i128::from(x.lo)),
        UnaryOp::Fneg | UnaryOp::Fabs | UnaryOp::Fsqrt => panic!("integers only"),
    }
}

/// The result of a binary operation on an integer type.
pub fn binary(op: BinaryOp, ty: Type, a: Range, b: Range) -> Range {
    match op {
        BinaryOp::Add => exact(
            ty,
            i128::from(a.lo) + i128::from(b.lo),
            i128::from(a.hi) + i128::from(b.hi),
        ),
        BinaryOp::Sub => exact(
            ty,
            i128::from(a.lo) - i128::from(b.hi),
            i128::from(a.hi) - i128::from(b.lo),
        ),
        BinaryOp::Mul => corners(ty, a, b, |x, y| x * y),
        BinaryOp::And => bit_and(ty, a, b),
        BinaryOp::Or | BinaryOp::Xor => bit_or_xor(op, ty, a, b),
        BinaryOp::Sdiv => divide(ty, a, b),
        BinaryOp::Srem => remainder(a, b),
        BinaryOp::Udiv if a.lo >= 0 && b.lo >= 0 => divide(ty, a, b),
        BinaryOp::Urem if a.lo >= 0 && b.lo >= 0 => remainder(a, b),
        BinaryOp::Shl => shift(ty, b, |count| {
            exact(ty, i128::from(a.lo) << count, i128::from(a.hi) << count)
        }),
        BinaryOp::Ushr if a.lo >= 0 => {
            shift(ty, b, |count| Range::new(a.lo >> count, a.hi >> count))
                .intersection(Range::new(0, a.hi))
                .unwrap_or(Range::constant(0))
        }
        BinaryOp::Sshr => shift(ty, b, |count| Range::new(a.lo >> count, a.hi >> count)),
        BinaryOp::Udiv | BinaryOp::Urem | BinaryOp::Ushr => Range::of_type(ty),
        BinaryOp::Fadd | BinaryOp::Fsub | BinaryOp::Fmul | BinaryOp::Fdiv => {
            panic!("integers only")
        }
    }
}

/// Only a constant count below the width says something.
fn shift(ty: Type, count: Range, f: impl Fn(u32) -> Range) -> Range {
    match count.as_constant() {
        Some(count) if (0..i64::from(ty.bits())).contains(&count) => f(count as u32),
        _ => Range::of_type(ty),
    }
}

fn bit_and(ty: Type, a: Range, b: Range) -> Range {
    match (a.lo >= 0, b.lo >= 0) {
        (true, true) if ty == Type::I1 => Range::new(a.lo & b.lo, a.hi & b.hi),
        (true, true) => Range::new(0, a.hi.min(b.hi)),
        (true, false) => Range::new(0, a.hi),
        (false, true) => Range::new(0, b.hi),
        (false, false) => Range::of_type(ty),
    }
}

fn bit_or_xor(op: BinaryOp, ty: Type, a: Range, b: Range) -> Range {
    if let (Some(a), Some(b)) = (a.as_constant(), b.as_constant()) {
        return Range::constant(if op == BinaryOp::Or { a | b } else { a ^ b });
    }
    if a.lo < 0 || b.lo < 0 {
        return Range::of_type(ty);
    }
    let top = a.hi | b.hi;
    let all_ones = (1i128 << (64 - top.leading_zeros())) - 1;
    let lo = if op == BinaryOp::Or {
        a.lo.max(b.lo)
    } else {
        0
    };
    exact(ty, i128::from(lo), all_ones)
}

/// Truncated quotient; `x / 0 = 0`.
fn divide(ty: Type, a: Range, b: Range) -> Range {
    if b.contains(0) {
        // At most |a|, and 0 for the zero divisor; MIN / -1 wraps to MIN.
        let bound = i128::from(a.lo).abs().max(i128::from(a.hi).abs());
        return exact(ty, -bound, bound);
    }
    corners(ty, a, b, |x, y| x / y)
}

/// Remainder with the sign of `a`; `x rem 0 = x`.
fn remainder(a: Range, b: Range) -> Range {
    let magnitude = i128::from(b.lo).abs().max(i128::from(b.hi).abs()) - 1;
    let bound = if b.contains(0) { i128::MAX } else { magnitude };
    let lo = i128::from(a.lo.min(0)).max(-bound);
    let hi = i128::from(a.hi.max(0)).min(bound);
    Range::new(lo as i64, hi as i64)
}

/// The result of a comparison of integers of one type.
pub fn compare(op: CompareOp, a: Range, b: Range) -> Range {
    let known = |truth: bool| Range::constant(i64::from(truth));
    let open = Range::new(0, 1);
    let nonnegative = a.lo >= 0 && b.lo >= 0;
    match op {
        CompareOp::Eq if a.intersection(b).is_none() => known(false),
        CompareOp::Eq if a.as_constant().is_some() && a == b => known(true),
        CompareOp::Ne if a.intersection(b).is_none() => known(true),
        CompareOp::Ne if a.as_constant().is_some() && a == b => known(false),
        CompareOp::Eq | CompareOp::Ne => open,
        CompareOp::Slt => less(a, b),
        CompareOp::Sgt => less(b, a),
        CompareOp::Sge => inverted(less(a, b)),
        CompareOp::Sle => inverted(less(b, a)),
        CompareOp::Ult if nonnegative => less(a, b),
        CompareOp::Ugt if nonnegative => less(b, a),
        CompareOp::Uge if nonnegative => inverted(less(a, b)),
        CompareOp::Ule if nonnegative => inverted(less(b, a)),
        CompareOp::Ult | CompareOp::Ugt | CompareOp::Uge | CompareOp::Ule => open,
        CompareOp::Feq
        | CompareOp::Fne
        | CompareOp::Flt
        | CompareOp::Fle
        | CompareOp::Fgt
        | CompareOp::Fge => open,
    }
}

fn less(a: Range, b: Range) -> Range {
    Range::new(i64::from(a.hi < b.lo), i64::from(a.lo < b.hi))
}

fn inverted(x: Range) -> Range {
    Range::new(1 - x.hi, 1 - x.lo)
}

/// What is left of `x` where `x op y` holds, y being any number of `b`; `None` if it never does.
pub fn given(op: CompareOp, x: Range, b: Range) -> Option<Range> {
    let (min, max) = (i64::MIN, i64::MAX);
    let below = |top: Option<i64>| x.intersection(Range::new(min, top?));
    let above = |bottom: Option<i64>| x.intersection(Range::new(bottom?, max));
    match op {
        CompareOp::Eq => x.intersection(b),
        CompareOp::Ne => without(x, b.as_constant()),
        CompareOp::Slt => below(b.hi.checked_sub(1)),
        CompareOp::Sle => below(Some(b.hi)),
        CompareOp::Sgt => above(b.lo.checked_add(1)),
        CompareOp::Sge => above(Some(b.lo)),
        // Unsigned, every negative number is above all others.
        CompareOp::Ult if b.lo >= 0 => x.intersection(Range::new(0, b.hi.max(1) - 1)),
        CompareOp::Ule if b.lo >= 0 => x.intersection(Range::new(0, b.hi)),
        CompareOp::Ugt if x.lo >= 0 && b.lo >= 0 => above(b.lo.checked_add(1)),
        CompareOp::Uge if x.lo >= 0 && b.lo >= 0 => above(Some(b.lo)),
        CompareOp::Ult | CompareOp::Ule | CompareOp::Ugt | CompareOp::Uge => Some(x),
        CompareOp::Feq
        | CompareOp::Fne
        | CompareOp::Flt
        | CompareOp::Fle
        | CompareOp::Fgt
        | CompareOp::Fge => Some(x),
    }
}

/// Only the ends of a range can be taken away.
fn without(x: Range, number: Option<i64>) -> Option<Range> {
    match number {
        Some(number) if x.lo == number && x.hi == number => None,
        Some(number) if x.lo == number => Some(Range::new(number + 1, x.hi)),
        Some(number) if x.hi == number => Some(Range::new(x.lo, number - 1)),
        Some(_) | None => Some(x),
    }
}

/// The result of a conversion between integer types.
pub fn convert(op: ConvertOp, from: Type, to: Type, x: Range) -> Range {
    match op {
        ConvertOp::Sext if from == Type::I1 => Range::new(-x.hi, -x.lo),
        ConvertOp::Sext => x,
        ConvertOp::Zext if x.lo >= 0 => x,
        ConvertOp::Zext => Range::new(0, from.mask() as i64),
        ConvertOp::Trunc => {
            let whole = Range::of_type(to);
            if whole.contains(x.lo) && whole.contains(x.hi) {
                x
            } else {
                whole
            }
        }
        ConvertOp::Promote
        | ConvertOp::Demote
        | ConvertOp::SintToFloat
        | ConvertOp::UintToFloat
        | ConvertOp::FloatToSint
        | ConvertOp::FloatToUint
        | ConvertOp::FloatBits
        | ConvertOp::BitsFloat => Range::of_type(to),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OPS: &[BinaryOp] = BinaryOp::ALL;

    fn small() -> impl Iterator<Item = Range> {
        let points = [-128, -127, -3, -1, 0, 1, 2, 7, 126, 127];
        points.into_iter().flat_map(move |lo| {
            points
                .into_iter()
                .filter(move |&hi| hi >= lo)
                .map(move |hi| Range::new(lo, hi))
        })
    }

    fn i8_result(op: BinaryOp, x: i64, y: i64) -> Option<i64> {
        let (a, b) = (x as i8, y as i8);
        let count = b as u8;
        Some(i64::from(match op {
            BinaryOp::Add => a.wrapping_add(b),
            BinaryOp::Sub => a.wrapping_sub(b),
            BinaryOp::Mul => a.wrapping_mul(b),
            BinaryOp::Sdiv => {
                if b == 0 {
                    0
                } else {
                    a.wrapping_div(b)
                }
            }
            BinaryOp::Srem => {
                if b == 0 {
                    a
                } else {
                    a.wrapping_rem(b)
                }
            }
            BinaryOp::Udiv => {
                if b == 0 {
                    0
                } else {
                    (a as u8 / b as u8) as i8
                }
            }
            BinaryOp::Urem => {
                if b == 0 {
                    a
                } else {
                    (a as u8 % b as u8) as i8
                }
            }
            BinaryOp::And => a & b,
            BinaryOp::Or => a | b,
            BinaryOp::Xor => a ^ b,
            BinaryOp::Shl => {
                if count > 7 {
                    0
                } else {
                    a << count
                }
            }
            BinaryOp::Ushr => {
                if count > 7 {
                    0
                } else {
                    ((a as u8) >> count) as i8
                }
            }
            BinaryOp::Sshr => {
                if count > 7 {
                    a >> 7
                } else {
                    a >> count
                }
            }
            BinaryOp::Fadd | BinaryOp::Fsub | BinaryOp::Fmul | BinaryOp::Fdiv => return None,
        }))
    }

    #[test]
    fn binary_ranges_hold_every_result_of_sampled_operands() {
        for &op in OPS {
            for a in small() {
                for b in small() {
                    for x in [a.lo, a.hi, (a.lo + a.hi) / 2] {
                        for y in [b.lo, b.hi, (b.lo + b.hi) / 2] {
                            let Some(result) = i8_result(op, x, y) else {
                                continue;
                            };
                            let range = binary(op, Type::I8, a, b);
                            assert!(
                                range.contains(result),
                                "{op} {x} {y} = {result} not in {range:?} from {a:?} {b:?}"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn what_a_comparison_leaves_is_bounded_by_the_other_side() {
        let x = Range::new(-5, 100);
        for (op, b, left) in [
            (CompareOp::Slt, Range::new(3, 7), Some(Range::new(-5, 6))),
            (CompareOp::Sge, Range::new(3, 7), Some(Range::new(3, 100))),
            (CompareOp::Sgt, Range::constant(100), None),
            (CompareOp::Ult, Range::constant(10), Some(Range::new(0, 9))),
            (CompareOp::Ult, Range::new(-1, 10), Some(x)),
            (CompareOp::Uge, Range::constant(10), Some(x)),
            (
                CompareOp::Ne,
                Range::constant(100),
                Some(Range::new(-5, 99)),
            ),
            (CompareOp::Ne, Range::constant(7), Some(x)),
            (
                CompareOp::Eq,
                Range::new(50, 200),
                Some(Range::new(50, 100)),
            ),
        ] {
            assert_eq!(given(op, x, b), left, "{op} {b:?}");
        }
    }

    #[test]
    fn sums_are_exact_until_they_may_wrap() {
        let sum = binary(
            BinaryOp::Add,
            Type::I32,
            Range::new(0, 1999),
            Range::new(0, 1),
        );
        assert_eq!(sum, Range::new(0, 2000));
        let wraps = binary(
            BinaryOp::Add,
            Type::I8,
            Range::new(0, 127),
            Range::new(0, 1),
        );
        assert_eq!(wraps, Range::of_type(Type::I8));
    }

    #[test]
    fn comparisons_are_decided_by_disjoint_ranges() {
        assert_eq!(
            compare(CompareOp::Sge, Range::new(5, 9), Range::constant(5)),
            Range::constant(1)
        );
        assert_eq!(
            compare(CompareOp::Slt, Range::new(5, 9), Range::constant(5)),
            Range::constant(0)
        );
        assert_eq!(
            compare(CompareOp::Ult, Range::new(-1, 3), Range::constant(5)),
            Range::new(0, 1)
        );
        assert_eq!(
            compare(CompareOp::Eq, Range::new(6, 9), Range::constant(5)),
            Range::constant(0)
        );
    }
}
