//! Conversions between elementary types that are asked for by name.

use crate::hir::code::{BinaryOp as Op, Conversion, ExprId, ExprKind};
use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::types::TypeId;
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// A conversion of a constant by a function with this name. A number that does not fit is a mistake;
    /// bits are cut.
    pub(crate) fn folded_conversion(
        &mut self,
        function: &str,
        operand: &Operand,
        range: TextRange,
    ) -> Option<Operand> {
        let (target, truncates) = match function.strip_prefix("TRUNC_") {
            Some(target) => (target, true),
            None => (function.strip_prefix("TO_")?, false),
        };
        let ty = self.an.named_elementary(target)?;
        let to = self.an.types.elementary(ty)?;
        let from = self.an.types.elementary(operand.ty)?;
        let value = operand.as_const()?;
        if let Some(folded) = fold_conversion(value, from, to, truncates) {
            return Some(Operand::constant(folded, ty, range));
        }
        let shown = match value {
            Const::Int(number) => number.to_string(),
            Const::Real(number) | Const::Literal(_, number) => number.to_string(),
            Const::Text(_) | Const::Null => return None,
        };
        (from.is_num() && to.is_int()).then(|| {
            let (low, high) = to.range();
            let message = format!("{shown} does not fit {} ({low} to {high})", to.name());
            self.error(Message::E2005, range, message)
        })
    }

    /// `convert`, `trunc`: the result type is the wanted one, which the library declares.
    pub(crate) fn conversion(
        &mut self,
        name: &str,
        operand: Operand,
        want: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let Some(to) = want.and_then(|ty| self.an.types.elementary(ty)) else {
            return self.error(
                Message::E3021,
                range,
                "the type of the result is not known here",
            );
        };
        let from_ty = self.settle(&operand);
        let Some(from) = self.an.types.elementary(from_ty) else {
            self.mismatch(&operand, TypeId::of(to));
            return Operand::error(range);
        };
        let truncates = name.starts_with("trunc");
        if let Some(value) = operand.as_const()
            && let Some(value) = fold_conversion(value, from, to, truncates)
        {
            return Operand::constant(value, TypeId::of(to), range);
        }
        let value = self.as_scalar(&operand, from_ty);
        let value = self.convert_expr(value, from, to, truncates, range);
        Operand::value(value, TypeId::of(to), range)
    }

    pub(crate) fn convert_expr(
        &mut self,
        value: ExprId,
        from: El,
        to: El,
        truncates: bool,
        range: TextRange,
    ) -> ExprId {
        // Short times count milliseconds as numbers, long ones nanoseconds (9.3).
        const MILLISECOND: i64 = 1_000_000;
        let time = |el: El| el.is_duration() || el.is_date();
        let scaled = |el: El| time(el) && !el.is_long_time();
        if scaled(from) && to.is_num() {
            return self.scaled_from(value, to, MILLISECOND, range);
        }
        if scaled(to) && from.is_num() {
            return self.scaled_to(value, from, MILLISECOND, range);
        }
        let how = match (from.is_bits(), to.is_bits()) {
            _ if truncates => Conversion::Truncate,
            (true, _) | (_, true) if !(from.is_int() && to == El::Bool) => Conversion::Bits,
            _ => Conversion::Value,
        };
        if from.storage() == to.storage() {
            return value;
        }
        self.add_expr(ExprKind::Convert(how, value), to.storage(), range)
    }

    pub(crate) fn scaled_from(
        &mut self,
        value: ExprId,
        to: El,
        unit: i64,
        range: TextRange,
    ) -> ExprId {
        let wide = if to.is_real() { El::Lreal } else { El::Lint };
        let value = self.convert_value(value, wide, range);
        let unit = Const::Int(i128::from(unit)).bits(wide);
        let unit = self.add_const(unit, wide.storage(), range);
        let kind = ExprKind::Binary(Op::DivideUnchecked, value, unit);
        let value = self.add_expr(kind, wide.storage(), range);
        self.convert_value(value, to, range)
    }

    pub(crate) fn scaled_to(
        &mut self,
        value: ExprId,
        from: El,
        unit: i64,
        range: TextRange,
    ) -> ExprId {
        let wide = if from.is_real() { El::Lreal } else { El::Lint };
        let value = self.convert_value(value, wide, range);
        let unit = Const::Int(i128::from(unit)).bits(wide);
        let unit = self.add_const(unit, wide.storage(), range);
        let value = self.add_expr(
            ExprKind::Binary(Op::Multiply, value, unit),
            wide.storage(),
            range,
        );
        self.convert_value(value, El::Lint, range)
    }
}

/// A conversion of a constant, where its value fits.
fn fold_conversion(value: &Const, from: El, to: El, truncates: bool) -> Option<Const> {
    let time = |el: El| el.is_duration() || el.is_date();
    if time(from) || time(to) {
        return None;
    }
    let real = match value {
        Const::Int(number) => {
            if to.is_real() {
                return (!from.is_bits())
                    .then(|| Const::Real(crate::st::constant::round_to(to, *number as f64)));
            }
            if from.is_bits() && to == El::Bool {
                return Some(Const::Int(number & 1));
            }
            let (low, high) = to.range();
            return (low..=high).contains(number).then_some(Const::Int(*number));
        }
        Const::Real(real) | Const::Literal(_, real) => *real,
        Const::Text(_) | Const::Null => return None,
    };
    if to.is_real() {
        return Some(Const::Real(crate::st::constant::round_to(to, real)));
    }
    if !to.is_int() {
        return None;
    }
    let whole = if truncates {
        real.trunc()
    } else {
        real.round_ties_even()
    };
    let (low, high) = to.range();
    (whole >= low as f64 && whole <= high as f64)
        .then_some(Const::Int(whole as i128))
        .filter(|value| value.as_int().is_some_and(|v| (low..=high).contains(&v)))
}
