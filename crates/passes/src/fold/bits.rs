//! Rules for conversions, and for single bits that were put into words and are taken out again.

use super::constant;
use super::simplify::{Rewriter, Step, binary};
use iecc_ir::{BinaryOp, ConvertOp, InstData, Type, Value};

/// How many insertions into a word are looked through for the one that made a bit. A word of 64
/// bits set one by one has three instructions for each.
const MAX_LOOK: usize = 256;

/// Simplifies a conversion.
pub(super) fn convert(rewriter: &mut Rewriter<'_>, op: ConvertOp, to: Type, arg: Value) -> Step {
    match op {
        ConvertOp::Trunc => trunc(rewriter, to, arg),
        ConvertOp::Zext => zext(rewriter, to, arg),
        ConvertOp::Sext => match conversion(rewriter, arg) {
            Some((ConvertOp::Sext, inner)) => make(ConvertOp::Sext, to, inner),
            Some((ConvertOp::Zext, inner)) => make(ConvertOp::Zext, to, inner),
            Some(_) | None => Step::Keep,
        },
        ConvertOp::FloatBits => there_and_back(rewriter, ConvertOp::BitsFloat, arg),
        ConvertOp::BitsFloat => there_and_back(rewriter, ConvertOp::FloatBits, arg),
        ConvertOp::Promote
        | ConvertOp::Demote
        | ConvertOp::SintToFloat
        | ConvertOp::UintToFloat
        | ConvertOp::FloatToSint
        | ConvertOp::FloatToUint => Step::Keep,
    }
}

fn make(op: ConvertOp, to: Type, arg: Value) -> Step {
    Step::Data(InstData::Convert { op, to, arg })
}

fn conversion(rewriter: &Rewriter<'_>, value: Value) -> Option<(ConvertOp, Value)> {
    match rewriter.func.def_inst(value) {
        Some(InstData::Convert { op, arg, .. }) => Some((*op, *arg)),
        Some(_) | None => None,
    }
}

fn there_and_back(rewriter: &Rewriter<'_>, back: ConvertOp, arg: Value) -> Step {
    match conversion(rewriter, arg) {
        Some((op, inner)) if op == back => Step::Same(inner),
        Some(_) | None => Step::Keep,
    }
}

fn zext(rewriter: &mut Rewriter<'_>, to: Type, arg: Value) -> Step {
    match conversion(rewriter, arg) {
        Some((ConvertOp::Zext, inner)) => make(ConvertOp::Zext, to, inner),
        Some((ConvertOp::Trunc, inner)) if rewriter.ty(inner) == to => {
            rewriter.with_number(BinaryOp::And, inner, rewriter.ty(arg).mask())
        }
        Some(_) | None => Step::Keep,
    }
}

fn trunc(rewriter: &mut Rewriter<'_>, to: Type, arg: Value) -> Step {
    if let Some((op @ (ConvertOp::Zext | ConvertOp::Sext | ConvertOp::Trunc), inner)) =
        conversion(rewriter, arg)
    {
        let from = rewriter.ty(inner);
        return match to.bits().cmp(&from.bits()) {
            std::cmp::Ordering::Equal => Step::Same(inner),
            std::cmp::Ordering::Less => make(ConvertOp::Trunc, to, inner),
            std::cmp::Ordering::Greater => make(op, to, inner),
        };
    }
    if let Some((inner, mask)) = rewriter.binary_const(arg, BinaryOp::And)
        && mask & to.mask() == to.mask()
    {
        return make(ConvertOp::Trunc, to, inner);
    }
    if to == Type::I1 {
        lowest_bit(rewriter, arg)
    } else {
        Step::Keep
    }
}

/// Where a bit of a word comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// It is known.
    Known(bool),
    /// It is this `i1`.
    Value(Value),
    /// It is this bit of another word.
    Bit(Value, u32),
}

/// `trunc` to one bit: the bit itself, if it was put into the word on its own.
fn lowest_bit(rewriter: &mut Rewriter<'_>, word: Value) -> Step {
    match bit_source(rewriter, word, 0, MAX_LOOK) {
        Source::Known(bit) => Step::Data(constant(Type::I1, u64::from(bit))),
        Source::Value(value) => Step::Same(value),
        Source::Bit(source, _) if source == word => Step::Keep,
        Source::Bit(source, 0) => make(ConvertOp::Trunc, Type::I1, source),
        Source::Bit(source, bit) => {
            // Already as simple as it gets: one shift, one truncation.
            if rewriter.binary_const(word, BinaryOp::Ushr) == Some((source, u64::from(bit))) {
                return Step::Keep;
            }
            let ty = rewriter.ty(source);
            let count = rewriter.number(ty, u64::from(bit));
            let Step::Data(shift) = binary(BinaryOp::Ushr, source, count) else {
                return Step::Keep;
            };
            let shifted = rewriter.emit(shift, ty);
            make(ConvertOp::Trunc, Type::I1, shifted)
        }
    }
}

fn bit_source(rewriter: &Rewriter<'_>, word: Value, bit: u32, look: usize) -> Source {
    let (mut word, mut bit) = (word, bit);
    for _ in 0..look {
        let found = one_step(rewriter, word, bit);
        let Source::Bit(next, next_bit) = found else {
            return found;
        };
        if (next, next_bit) == (word, bit) {
            return found;
        }
        (word, bit) = (next, next_bit);
    }
    Source::Bit(word, bit)
}

fn one_step(rewriter: &Rewriter<'_>, word: Value, bit: u32) -> Source {
    let stay = Source::Bit(word, bit);
    match rewriter.func.def_inst(word) {
        Some(InstData::Const { bits, .. }) => Source::Known(bits >> bit & 1 == 1),
        Some(InstData::Convert { op, arg, .. }) => converted(rewriter, *op, *arg, bit, stay),
        Some(InstData::Binary { op, args: [a, b] }) => {
            let number = rewriter.constant(*b);
            match (op, number) {
                (BinaryOp::And, Some(mask)) if mask >> bit & 1 == 0 => Source::Known(false),
                (BinaryOp::And, Some(_)) => Source::Bit(*a, bit),
                (BinaryOp::Or, Some(mask)) if mask >> bit & 1 == 1 => Source::Known(true),
                (BinaryOp::Or, Some(_)) => Source::Bit(*a, bit),
                (BinaryOp::Or, None) if is_zero(rewriter, *b, bit) => Source::Bit(*a, bit),
                (BinaryOp::Or, None) if is_zero(rewriter, *a, bit) => Source::Bit(*b, bit),
                (BinaryOp::Shl, Some(count)) => shifted_up(*a, bit, count),
                (BinaryOp::Ushr, Some(count)) => shifted_down(*a, bit, count, rewriter.ty(word)),
                _ => stay,
            }
        }
        Some(_) | None => stay,
    }
}

fn converted(rewriter: &Rewriter<'_>, op: ConvertOp, arg: Value, bit: u32, stay: Source) -> Source {
    let from = rewriter.ty(arg);
    match op {
        ConvertOp::Trunc => Source::Bit(arg, bit),
        ConvertOp::Zext if bit >= from.bits() => Source::Known(false),
        ConvertOp::Zext | ConvertOp::Sext if from == Type::I1 => Source::Value(arg),
        ConvertOp::Zext => Source::Bit(arg, bit),
        ConvertOp::Sext => Source::Bit(arg, bit.min(from.bits() - 1)),
        ConvertOp::Promote
        | ConvertOp::Demote
        | ConvertOp::SintToFloat
        | ConvertOp::UintToFloat
        | ConvertOp::FloatToSint
        | ConvertOp::FloatToUint
        | ConvertOp::FloatBits
        | ConvertOp::BitsFloat => stay,
    }
}

fn shifted_up(word: Value, bit: u32, count: u64) -> Source {
    match u64::from(bit).checked_sub(count) {
        Some(bit) => Source::Bit(word, bit as u32),
        None => Source::Known(false),
    }
}

fn shifted_down(word: Value, bit: u32, count: u64, ty: Type) -> Source {
    match u64::from(bit).checked_add(count) {
        Some(bit) if bit < u64::from(ty.bits()) => Source::Bit(word, bit as u32),
        Some(_) | None => Source::Known(false),
    }
}

/// Whether the bit is 0 because of a mask or shift close by; it need not find all.
fn is_zero(rewriter: &Rewriter<'_>, word: Value, bit: u32) -> bool {
    match rewriter.func.def_inst(word) {
        Some(InstData::Const { bits, .. }) => bits >> bit & 1 == 0,
        Some(InstData::Convert {
            op: ConvertOp::Zext,
            arg,
            ..
        }) => bit >= rewriter.ty(*arg).bits(),
        Some(InstData::Binary { op, args: [a, b] }) => match (op, rewriter.constant(*b)) {
            (BinaryOp::And, Some(mask)) => mask >> bit & 1 == 0,
            (BinaryOp::Shl, Some(count)) => match u64::from(bit).checked_sub(count) {
                None => true,
                Some(from) => matches!(
                    rewriter.func.def_inst(*a),
                    Some(InstData::Convert { op: ConvertOp::Zext, arg, .. })
                        if from >= u64::from(rewriter.ty(*arg).bits())
                ),
            },
            _ => false,
        },
        Some(_) | None => false,
    }
}
