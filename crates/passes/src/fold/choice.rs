//! Rules for `select`: a choice that is known, or between what is alike, is none.

use super::simplify::{Rewriter, Step, binary, not};
use iecc_ir::{BinaryOp, CompareOp, InstData, Type, Value};

/// Simplifies `select cond, yes, no`.
pub(super) fn select(rewriter: &mut Rewriter<'_>, cond: Value, [yes, no]: [Value; 2]) -> Step {
    if yes == no {
        return Step::Same(yes);
    }
    match rewriter.constant(cond) {
        Some(0) => return Step::Same(no),
        Some(_) => return Step::Same(yes),
        None => {}
    }
    if let Some(inverse) = rewriter.not_of(cond) {
        return data(inverse, no, yes);
    }
    if rewriter.ty(yes) == Type::I1 {
        let step = bool_select(rewriter, cond, yes, no);
        if !matches!(step, Step::Keep) {
            return step;
        }
    }
    match limits(rewriter, cond, yes, no) {
        Step::Keep => nested(rewriter, cond, yes, no),
        limited => limited,
    }
}

fn data(cond: Value, yes: Value, no: Value) -> Step {
    Step::Data(InstData::Select {
        cond,
        args: [yes, no],
    })
}

/// A choice between bits is logic as soon as one of them is known or is the condition.
fn bool_select(rewriter: &mut Rewriter<'_>, cond: Value, yes: Value, no: Value) -> Step {
    let known = |value: Value, when_cond: bool| match rewriter.constant(value) {
        None if value == cond => Some(when_cond),
        None if rewriter.are_inverse(value, cond) => Some(!when_cond),
        bits => bits.map(|bits| bits == 1),
    };
    match (known(yes, true), known(no, false)) {
        (Some(true), Some(false)) => Step::Same(cond),
        (Some(false), Some(true)) => not(cond),
        (Some(true), None) => binary(BinaryOp::Or, cond, no),
        (None, Some(false)) => binary(BinaryOp::And, cond, yes),
        (Some(false), None) => {
            let inverse = rewriter.inverse(cond);
            binary(BinaryOp::And, inverse, no)
        }
        (None, Some(true)) => {
            let inverse = rewriter.inverse(cond);
            binary(BinaryOp::Or, inverse, yes)
        }
        (Some(bit), Some(_)) => Step::Data(super::constant(Type::I1, u64::from(bit))),
        (None, None) if rewriter.are_inverse(yes, no) => {
            let differ = rewriter.emit(
                InstData::Binary {
                    op: BinaryOp::Xor,
                    args: [cond, yes],
                },
                Type::I1,
            );
            not(differ)
        }
        (None, None) => Step::Keep,
    }
}

/// Selects whose arms are selects on the same condition or with a common arm.
fn nested(rewriter: &mut Rewriter<'_>, cond: Value, yes: Value, no: Value) -> Step {
    if let Some((inner, [a, b])) = rewriter.select_of(yes) {
        if inner == cond {
            return data(cond, a, no);
        }
        if rewriter.are_inverse(inner, cond) {
            return data(cond, b, no);
        }
        if b == no {
            let both = join(rewriter, BinaryOp::And, cond, inner);
            return data(both, a, no);
        }
        if a == no {
            let inverse = rewriter.inverse(inner);
            let both = join(rewriter, BinaryOp::And, cond, inverse);
            return data(both, b, no);
        }
    }
    if let Some((inner, [a, b])) = rewriter.select_of(no) {
        if inner == cond {
            return data(cond, yes, b);
        }
        if rewriter.are_inverse(inner, cond) {
            return data(cond, yes, a);
        }
        if a == yes {
            let either = join(rewriter, BinaryOp::Or, cond, inner);
            return data(either, yes, b);
        }
        if b == yes {
            let inverse = rewriter.inverse(inner);
            let either = join(rewriter, BinaryOp::Or, cond, inverse);
            return data(either, yes, a);
        }
    }
    Step::Keep
}

fn join(rewriter: &mut Rewriter<'_>, op: BinaryOp, a: Value, b: Value) -> Value {
    rewriter.emit(InstData::Binary { op, args: [a, b] }, Type::I1)
}

/// `x > 9 ? 9 : t` where t is `x < 1 ? 1 : x` becomes `t > 9 ? 9 : t`, a minimum of a maximum: t is
/// either x, or 1 where x is not above 9 and 1 is not either. NaN stays NaN in both.
fn limits(rewriter: &mut Rewriter<'_>, cond: Value, yes: Value, no: Value) -> Step {
    let Some((inner, [bound, inside])) = rewriter.select_of(no) else {
        return Step::Keep;
    };
    let (Some(outer), Some(inner)) = (
        float_bound(rewriter, cond, inside),
        float_bound(rewriter, inner, inside),
    ) else {
        return Step::Keep;
    };
    let apart = match (outer.op, inner.op) {
        (CompareOp::Fgt, CompareOp::Flt) => inner.limit <= outer.limit,
        (CompareOp::Flt, CompareOp::Fgt) => inner.limit >= outer.limit,
        _ => false,
    };
    if !(apart && yes == outer.value && bound == inner.value) {
        return Step::Keep;
    }
    let compare = InstData::Compare {
        op: outer.op,
        args: [no, yes],
    };
    let cond = rewriter.emit(compare, Type::I1);
    data(cond, yes, no)
}

/// `x op limit` with a constant.
struct FloatBound {
    op: CompareOp,
    value: Value,
    limit: f64,
}

/// A comparison of `x` with a constant float, written with `x` first.
fn float_bound(rewriter: &Rewriter<'_>, cond: Value, x: Value) -> Option<FloatBound> {
    let Some(InstData::Compare { op, args }) = rewriter.func.def_inst(cond) else {
        return None;
    };
    let (op, value) = match args {
        [first, value] if *first == x => (*op, *value),
        [value, second] if *second == x => (op.swapped(), *value),
        _ => return None,
    };
    let bits = rewriter.constant(value)?;
    let limit = match rewriter.ty(value) {
        Type::F32 => f64::from(f32::from_bits(bits as u32)),
        Type::F64 => f64::from_bits(bits),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => return None,
    };
    Some(FloatBound { op, value, limit })
}
