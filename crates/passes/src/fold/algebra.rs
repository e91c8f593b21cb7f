//! Rules for unary and binary integer operations. Floats have none: rounding, signed zeros and
//! NaNs make nearly every law of algebra false for them.

use super::constant;
use super::simplify::{Rewriter, Step, binary as make, not};
use iecc_ir::{BinaryOp, CompareOp, InstData, Type, UnaryOp, Value};

/// Simplifies a unary operation.
pub(super) fn unary(rewriter: &Rewriter<'_>, op: UnaryOp, arg: Value) -> Step {
    match (op, rewriter.func.def_inst(arg)) {
        (UnaryOp::Not, Some(InstData::Unary { op: inner, arg })) if *inner == UnaryOp::Not => {
            Step::Same(*arg)
        }
        (UnaryOp::Neg, Some(InstData::Unary { op: inner, arg })) if *inner == UnaryOp::Neg => {
            Step::Same(*arg)
        }
        (UnaryOp::Neg, Some(InstData::Binary { op, args: [a, b] })) if *op == BinaryOp::Sub => {
            make(BinaryOp::Sub, *b, *a)
        }
        (UnaryOp::Not, Some(InstData::Compare { op, args })) => inverted(*op, *args),
        (
            UnaryOp::Not | UnaryOp::Neg | UnaryOp::Fneg | UnaryOp::Fabs | UnaryOp::Fsqrt,
            Some(_) | None,
        ) => Step::Keep,
    }
}

fn inverted(op: CompareOp, args: [Value; 2]) -> Step {
    match op.inverted() {
        Some(op) => Step::Data(InstData::Compare { op, args }),
        None => Step::Keep,
    }
}

/// Simplifies a binary operation.
pub(super) fn binary(rewriter: &mut Rewriter<'_>, op: BinaryOp, [a, b]: [Value; 2]) -> Step {
    let ty = rewriter.ty(a);
    if op.is_commutative() && rewriter.constant(a).is_some() && rewriter.constant(b).is_none() {
        return make(op, b, a);
    }
    match op {
        BinaryOp::And | BinaryOp::Or => lattice(rewriter, op, a, b),
        BinaryOp::Xor => xor(rewriter, a, b),
        BinaryOp::Add => add(rewriter, a, b),
        BinaryOp::Sub => sub(rewriter, ty, a, b),
        BinaryOp::Mul => mul(rewriter, ty, a, b),
        BinaryOp::Sdiv | BinaryOp::Udiv => divide(rewriter, op, ty, a, b),
        BinaryOp::Srem | BinaryOp::Urem => remainder(rewriter, op, ty, a, b),
        BinaryOp::Shl | BinaryOp::Ushr | BinaryOp::Sshr => shift(rewriter, op, ty, a, b),
        BinaryOp::Fadd | BinaryOp::Fsub | BinaryOp::Fmul | BinaryOp::Fdiv => Step::Keep,
    }
}

/// `and` and `or` are duals: what `and` does with 0 and ones, `or` does with ones and 0.
fn lattice(rewriter: &mut Rewriter<'_>, op: BinaryOp, a: Value, b: Value) -> Step {
    let ty = rewriter.ty(a);
    let (dual, neutral, absorbing) = if op == BinaryOp::And {
        (BinaryOp::Or, ty.mask(), 0)
    } else {
        (BinaryOp::And, 0, ty.mask())
    };
    if a == b || rewriter.constant(b) == Some(neutral) {
        return Step::Same(a);
    }
    if rewriter.constant(b) == Some(absorbing) || rewriter.are_inverse(a, b) {
        return Step::Data(constant(ty, absorbing));
    }
    if let (Some((x, inner)), Some(outer)) = (rewriter.binary_const(a, op), rewriter.constant(b)) {
        let bits = if op == BinaryOp::And {
            inner & outer
        } else {
            inner | outer
        };
        return rewriter.with_number(op, x, bits);
    }
    for (x, other) in [(a, b), (b, a)] {
        if let Some(step) = with_operation(rewriter, op, dual, absorbing, x, other) {
            return step;
        }
    }
    common_factor(rewriter, dual, a, b)
}

/// `x op (l same-op r)` and `x op (l dual r)`, where l or r is x or its inverse.
fn with_operation(
    rewriter: &Rewriter<'_>,
    op: BinaryOp,
    dual: BinaryOp,
    absorbing: u64,
    x: Value,
    other: Value,
) -> Option<Step> {
    if let Some([l, r]) = rewriter.binary_of(other, op) {
        if l == x || r == x {
            return Some(Step::Same(other));
        }
        if rewriter.are_inverse(l, x) || rewriter.are_inverse(r, x) {
            return Some(Step::Data(constant(rewriter.ty(x), absorbing)));
        }
    }
    let [l, r] = rewriter.binary_of(other, dual)?;
    if l == x || r == x {
        return Some(Step::Same(x));
    }
    if rewriter.are_inverse(l, x) {
        return Some(make(op, x, r));
    }
    rewriter.are_inverse(r, x).then(|| make(op, x, l))
}

/// `(f dual x) op (f dual not x)` is f.
fn common_factor(rewriter: &Rewriter<'_>, dual: BinaryOp, a: Value, b: Value) -> Step {
    let (Some([p, q]), Some([r, s])) = (rewriter.binary_of(a, dual), rewriter.binary_of(b, dual))
    else {
        return Step::Keep;
    };
    for (factor, x, other, y) in [(p, q, r, s), (p, q, s, r), (q, p, r, s), (q, p, s, r)] {
        if factor == other && rewriter.are_inverse(x, y) {
            return Step::Same(factor);
        }
    }
    Step::Keep
}

fn xor(rewriter: &mut Rewriter<'_>, a: Value, b: Value) -> Step {
    let ty = rewriter.ty(a);
    if a == b {
        return Step::Data(constant(ty, 0));
    }
    if rewriter.constant(b) == Some(0) {
        return Step::Same(a);
    }
    if rewriter.is_ones(b) {
        return not(a);
    }
    if rewriter.are_inverse(a, b) {
        return Step::Data(constant(ty, ty.mask()));
    }
    if let (Some((x, inner)), Some(outer)) = (
        rewriter.binary_const(a, BinaryOp::Xor),
        rewriter.constant(b),
    ) {
        return rewriter.with_number(BinaryOp::Xor, x, inner ^ outer);
    }
    if let (Some(x), Some(y)) = (rewriter.not_of(a), rewriter.not_of(b)) {
        return make(BinaryOp::Xor, x, y);
    }
    Step::Keep
}

fn add(rewriter: &mut Rewriter<'_>, a: Value, b: Value) -> Step {
    let Some(outer) = rewriter.constant(b) else {
        return Step::Keep;
    };
    if outer == 0 {
        return Step::Same(a);
    }
    match rewriter.binary_const(a, BinaryOp::Add) {
        Some((x, inner)) => rewriter.with_number(BinaryOp::Add, x, inner.wrapping_add(outer)),
        None => Step::Keep,
    }
}

fn sub(rewriter: &mut Rewriter<'_>, ty: Type, a: Value, b: Value) -> Step {
    if a == b {
        return Step::Data(constant(ty, 0));
    }
    if rewriter.constant(a) == Some(0) {
        return Step::Data(InstData::Unary {
            op: UnaryOp::Neg,
            arg: b,
        });
    }
    match rewriter.constant(b) {
        Some(0) => Step::Same(a),
        Some(bits) => rewriter.with_number(BinaryOp::Add, a, bits.wrapping_neg()),
        None => Step::Keep,
    }
}

fn mul(rewriter: &mut Rewriter<'_>, ty: Type, a: Value, b: Value) -> Step {
    match rewriter.constant(b) {
        Some(0) => Step::Data(constant(ty, 0)),
        Some(1) => Step::Same(a),
        Some(bits) if bits == ty.mask() => Step::Data(InstData::Unary {
            op: UnaryOp::Neg,
            arg: a,
        }),
        Some(bits) if bits.is_power_of_two() => {
            rewriter.with_number(BinaryOp::Shl, a, u64::from(bits.trailing_zeros()))
        }
        Some(_) | None => Step::Keep,
    }
}

/// `x / 0` is 0. `x / x` stays: it is 0 for 0.
fn divide(rewriter: &mut Rewriter<'_>, op: BinaryOp, ty: Type, a: Value, b: Value) -> Step {
    if rewriter.constant(a) == Some(0) {
        return Step::Same(a);
    }
    match rewriter.constant(b) {
        Some(0) => Step::Data(constant(ty, 0)),
        Some(1) => Step::Same(a),
        Some(bits) if op == BinaryOp::Udiv && bits.is_power_of_two() => {
            rewriter.with_number(BinaryOp::Ushr, a, u64::from(bits.trailing_zeros()))
        }
        Some(bits) if op == BinaryOp::Sdiv && bits == ty.mask() => Step::Data(InstData::Unary {
            op: UnaryOp::Neg,
            arg: a,
        }),
        Some(_) | None => Step::Keep,
    }
}

/// `x rem 0` is x.
fn remainder(rewriter: &mut Rewriter<'_>, op: BinaryOp, ty: Type, a: Value, b: Value) -> Step {
    if a == b {
        return Step::Data(constant(ty, 0));
    }
    match rewriter.constant(b) {
        Some(0) => Step::Same(a),
        Some(1) => Step::Data(constant(ty, 0)),
        Some(bits) if op == BinaryOp::Urem && bits.is_power_of_two() => {
            rewriter.with_number(BinaryOp::And, a, bits - 1)
        }
        Some(bits) if op == BinaryOp::Srem && bits == ty.mask() => Step::Data(constant(ty, 0)),
        Some(_) | None => Step::Keep,
    }
}

fn shift(rewriter: &mut Rewriter<'_>, op: BinaryOp, ty: Type, a: Value, b: Value) -> Step {
    let width = u64::from(ty.bits());
    if rewriter.constant(a) == Some(0) {
        return Step::Same(a);
    }
    let Some(count) = rewriter.constant(b) else {
        return Step::Keep;
    };
    if count == 0 {
        return Step::Same(a);
    }
    if count >= width && op == BinaryOp::Sshr {
        return rewriter.with_number(op, a, width - 1);
    }
    if count >= width {
        return Step::Data(constant(ty, 0));
    }
    if let Some((x, inner)) = rewriter.binary_const(a, op).filter(|(_, n)| *n < width) {
        return rewriter.with_number(op, x, inner + count);
    }
    there_and_back(rewriter, op, ty, a, count)
}

/// `x << n >> n` and `x >> n << n` clear bits.
fn there_and_back(
    rewriter: &mut Rewriter<'_>,
    op: BinaryOp,
    ty: Type,
    a: Value,
    count: u64,
) -> Step {
    if op == BinaryOp::Sshr {
        return Step::Keep;
    }
    let (back, mask) = if op == BinaryOp::Ushr {
        (BinaryOp::Shl, ty.mask() >> count)
    } else {
        (BinaryOp::Ushr, ty.mask() << count)
    };
    match rewriter.binary_const(a, back) {
        Some((x, inner)) if inner == count => rewriter.with_number(BinaryOp::And, x, mask),
        Some(_) | None => Step::Keep,
    }
}
