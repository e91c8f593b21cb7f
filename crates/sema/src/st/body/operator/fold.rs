//! Arithmetic on constants: whole numbers exactly, reals in the width of their type.

use crate::hir::Arithmetic;
use crate::st::body::{Body, Operand};
use crate::st::constant::{Const, round_to};
use crate::st::elementary::El;
use crate::st::types::TypeId;
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// `left op right` in a type, or in that of literals.
    pub(crate) fn fold_arithmetic(
        &mut self,
        op: Arithmetic,
        left: &Operand,
        right: &Operand,
        ty: TypeId,
        range: TextRange,
    ) -> Operand {
        let real =
            ty == TypeId::UNTYPED_REAL || self.an.types.elementary(ty).is_some_and(El::is_real);
        let operands = if matches!(ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL) {
            left.as_const().cloned().zip(right.as_const().cloned())
        } else {
            self.constant_to(left, ty).zip(self.constant_to(right, ty))
        };
        let Some((a, b)) = operands else {
            return Operand::error(range);
        };
        let value = if real {
            let el = self.an.types.elementary(ty).unwrap_or(El::Lreal);
            Some(Const::Real(round_to(
                el,
                fold_real(op, as_real(&a), as_real(&b)),
            )))
        } else {
            match (a, b) {
                (Const::Int(_), Const::Int(0)) if op == Arithmetic::Divide => {
                    return self.error(Message::E2028, right.range, "division by zero");
                }
                (Const::Int(a), Const::Int(b)) => fold_int(op, a, b).map(Const::Int),
                _ => None,
            }
        };
        match value {
            Some(value) => self.folded(value, ty, range),
            None => self.folded_int(None, ty, range),
        }
    }

    /// A folded constant, which must fit its type.
    pub(crate) fn folded(&mut self, value: Const, ty: TypeId, range: TextRange) -> Operand {
        if let (Const::Int(number), Some(el)) = (&value, self.an.types.elementary(ty))
            && !el.is_real()
        {
            let (low, high) = el.range();
            if !(low..=high).contains(number) {
                let message = format!(
                    "the result {number} does not fit {} ({low} to {high})",
                    el.name()
                );
                return self.error(Message::E2005, range, message);
            }
            return Operand::constant(value, TypeId::of(el), range);
        }
        Operand::constant(value, ty, range)
    }

    /// A folded whole number; a message if it has none.
    pub(crate) fn folded_int(
        &mut self,
        value: Option<i128>,
        ty: TypeId,
        range: TextRange,
    ) -> Operand {
        match value {
            Some(value) => self.folded(Const::Int(value), ty, range),
            None => self.error(Message::E2005, range, "the result does not fit 128 bits"),
        }
    }
}

/// A number as a real.
pub(crate) fn as_real(value: &Const) -> f64 {
    match value {
        Const::Int(number) => *number as f64,
        Const::Real(number) | Const::Literal(_, number) => *number,
        Const::Text(_) | Const::Null => 0.0,
    }
}

fn fold_real(op: Arithmetic, a: f64, b: f64) -> f64 {
    match op {
        Arithmetic::Add => a + b,
        Arithmetic::Subtract => a - b,
        Arithmetic::Multiply => a * b,
        Arithmetic::Divide => a / b,
        Arithmetic::Modulo => unreachable!("MOD takes integers"),
    }
}

/// `a op b`, if that fits 128 bits; MOD by 0 is 0 by definition.
pub(crate) fn fold_int(op: Arithmetic, a: i128, b: i128) -> Option<i128> {
    match op {
        Arithmetic::Add => a.checked_add(b),
        Arithmetic::Subtract => a.checked_sub(b),
        Arithmetic::Multiply => a.checked_mul(b),
        Arithmetic::Divide => a.checked_div(b),
        Arithmetic::Modulo if b == 0 => Some(0),
        Arithmetic::Modulo => a.checked_rem(b),
    }
}
