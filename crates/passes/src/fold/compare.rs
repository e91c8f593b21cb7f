//! Rules for comparisons of integers.

use super::constant;
use super::simplify::{Rewriter, Step, not};
use iecc_ir::eval::{eval_compare, eval_convert};
use iecc_ir::{BinaryOp, CompareOp, ConvertOp, InstData, Type, Value};

/// Simplifies a comparison.
pub(super) fn compare(rewriter: &mut Rewriter<'_>, op: CompareOp, [a, b]: [Value; 2]) -> Step {
    let ty = rewriter.ty(a);
    if ty.is_float() {
        return Step::Keep;
    }
    if a == b {
        let bit = eval_compare(op, ty, 0, 0);
        return Step::Data(constant(Type::I1, u64::from(bit)));
    }
    if rewriter.constant(a).is_some() {
        return data(op.swapped(), b, a);
    }
    let Some(bits) = rewriter.constant(b) else {
        return Step::Keep;
    };
    match op {
        CompareOp::Eq | CompareOp::Ne => equality(rewriter, op, ty, a, bits),
        CompareOp::Slt
        | CompareOp::Sle
        | CompareOp::Sgt
        | CompareOp::Sge
        | CompareOp::Ult
        | CompareOp::Ule
        | CompareOp::Ugt
        | CompareOp::Uge => order(rewriter, op, ty, a, bits),
        CompareOp::Feq
        | CompareOp::Fne
        | CompareOp::Flt
        | CompareOp::Fle
        | CompareOp::Fgt
        | CompareOp::Fge => Step::Keep,
    }
}

fn data(op: CompareOp, a: Value, b: Value) -> Step {
    Step::Data(InstData::Compare { op, args: [a, b] })
}

fn with_number(rewriter: &mut Rewriter<'_>, op: CompareOp, a: Value, bits: u64) -> Step {
    let b = rewriter.number(rewriter.ty(a), bits);
    data(op, a, b)
}

fn equality(rewriter: &mut Rewriter<'_>, op: CompareOp, ty: Type, a: Value, bits: u64) -> Step {
    let equal = op == CompareOp::Eq;
    if ty == Type::I1 {
        return if equal == (bits == 1) {
            Step::Same(a)
        } else {
            not(a)
        };
    }
    match rewriter.func.def_inst(a).cloned() {
        Some(InstData::Convert { op: via, arg, .. }) => extended(rewriter, op, via, ty, arg, bits),
        Some(InstData::Binary { op: via, args }) => match (via, rewriter.constant(args[1])) {
            (BinaryOp::Add, Some(n)) => with_number(rewriter, op, args[0], bits.wrapping_sub(n)),
            (BinaryOp::Xor, Some(n)) => with_number(rewriter, op, args[0], bits ^ n),
            _ => Step::Keep,
        },
        Some(InstData::Select { cond, args }) => selected(rewriter, equal, cond, args, bits),
        Some(_) | None => Step::Keep,
    }
}

/// An extended integer equals a constant if the narrow one does, or never.
fn extended(
    rewriter: &mut Rewriter<'_>,
    op: CompareOp,
    via: ConvertOp,
    ty: Type,
    arg: Value,
    bits: u64,
) -> Step {
    if !matches!(via, ConvertOp::Zext | ConvertOp::Sext) {
        return Step::Keep;
    }
    let from = rewriter.ty(arg);
    if eval_convert(via, from, ty, bits & from.mask()) == bits {
        with_number(rewriter, op, arg, bits)
    } else {
        Step::Data(constant(Type::I1, u64::from(op == CompareOp::Ne)))
    }
}

/// A choice between two constants, compared with a constant, is the condition or fixed.
fn selected(
    rewriter: &mut Rewriter<'_>,
    equal: bool,
    cond: Value,
    [yes, no]: [Value; 2],
    bits: u64,
) -> Step {
    let (Some(yes), Some(no)) = (rewriter.constant(yes), rewriter.constant(no)) else {
        return Step::Keep;
    };
    match ((yes == bits) == equal, (no == bits) == equal) {
        (true, false) => Step::Same(cond),
        (false, true) => not(cond),
        (both, _) => Step::Data(constant(Type::I1, u64::from(both))),
    }
}

/// At the ends of the type's range an order is an equality or fixed.
fn order(rewriter: &mut Rewriter<'_>, op: CompareOp, ty: Type, a: Value, bits: u64) -> Step {
    let sign = 1u64 << (ty.bits() - 1);
    let signed = matches!(
        op,
        CompareOp::Slt | CompareOp::Sle | CompareOp::Sgt | CompareOp::Sge
    );
    let (min, max) = if signed {
        (sign, sign - 1)
    } else {
        (0, ty.mask())
    };
    // Strict forms, for which the ends are simplest: x <= k is x < k + 1 unless k is the maximum.
    let below = matches!(
        op,
        CompareOp::Slt | CompareOp::Sle | CompareOp::Ult | CompareOp::Ule
    );
    let inclusive = matches!(
        op,
        CompareOp::Sle | CompareOp::Sge | CompareOp::Ule | CompareOp::Uge
    );
    let (far, near) = if below { (max, min) } else { (min, max) };
    match (inclusive, bits) {
        (true, bits) if bits == far => Step::Data(constant(Type::I1, 1)),
        (false, bits) if bits == near => Step::Data(constant(Type::I1, 0)),
        (true, bits) if bits == near => with_number(rewriter, CompareOp::Eq, a, bits),
        (false, bits) if bits == far => with_number(rewriter, CompareOp::Ne, a, bits),
        _ => narrow(rewriter, op, ty, a, bits),
    }
}

/// `zext x` against k: fixed if k is outside what x can be, on either side and read either way. A
/// bit has two values, so the comparison is a choice between two results.
fn narrow(rewriter: &Rewriter<'_>, op: CompareOp, ty: Type, a: Value, bits: u64) -> Step {
    let Some(InstData::Convert {
        op: ConvertOp::Zext,
        arg,
        ..
    }) = rewriter.func.def_inst(a)
    else {
        return Step::Keep;
    };
    let from = rewriter.ty(*arg);
    let fixed = |bit: bool| Step::Data(constant(Type::I1, u64::from(bit)));
    if bits > from.mask() {
        return fixed(eval_compare(op, ty, 0, bits));
    }
    if from != Type::I1 {
        return Step::Keep;
    }
    match (eval_compare(op, ty, 1, bits), eval_compare(op, ty, 0, bits)) {
        (true, false) => Step::Same(*arg),
        (false, true) => not(*arg),
        (both, _) => fixed(both),
    }
}
