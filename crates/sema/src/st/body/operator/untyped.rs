//! Times as numbers (CODESYS): a whole number beside a duration counts milliseconds, beside a long
//! one nanoseconds, as in conversions; the quotient of two durations is a number; `TIME()` is the clock.

use crate::hir::Arithmetic;
use crate::hir::code::{BinaryOp as Op, ExprKind};
use crate::st::body::operator::bits_as_numbers::counts_as;
use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::types::TypeId;
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind as Written};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

/// What a number counts beside a TIME.
const MILLISECOND: i128 = 1_000_000;

impl Body<'_, '_> {
    /// Operands of a sum, a difference or a comparison, a number beside a duration made one.
    pub(crate) fn numbers_as_durations(
        &mut self,
        left: Operand,
        right: Operand,
    ) -> (Operand, Operand) {
        if !self.an.options.codesys {
            return (left, right);
        }
        match (self.duration(&left), self.duration(&right)) {
            (Some(el), None) => {
                let right = self.number_as(right, el);
                (left, right)
            }
            (None, Some(el)) => (self.number_as(left, el), right),
            (Some(_), Some(_)) | (None, None) => (left, right),
        }
    }

    fn duration(&self, operand: &Operand) -> Option<El> {
        let el = self.an.types.elementary(operand.ty);
        el.filter(|el| el.is_duration())
    }

    /// A whole number or bit string as a duration; others stay what they are.
    fn number_as(&mut self, operand: Operand, to: El) -> Operand {
        let (ty, range) = (TypeId::of(to), operand.range);
        let unit = if to.is_long_time() { 1 } else { MILLISECOND };
        let el = self.an.types.elementary(operand.ty);
        let whole = |el: El| el.is_int() || (el.is_bits() && el != El::Bool);
        if operand.ty != TypeId::UNTYPED_INT && !el.is_some_and(whole) {
            return operand;
        }
        if let Some(Const::Int(number)) = operand.as_const() {
            return self.folded(Const::Int(number * unit), ty, range);
        }
        let value = self.raw(&operand);
        let value = self.scaled_to(value, El::Lint, unit as i64, range);
        Operand::value(value, ty, range)
    }

    /// The quotient of two durations, and what is left of the division.
    pub(crate) fn divided_durations(
        &mut self,
        op: Arithmetic,
        left: &Operand,
        right: &Operand,
        range: TextRange,
    ) -> Option<Operand> {
        let (a, b) = (self.duration(left)?, self.duration(right)?);
        let ty = match op {
            Arithmetic::Divide => TypeId::of(El::Lint),
            Arithmetic::Modulo => TypeId::of(if a.is_long_time() { a } else { b }),
            Arithmetic::Add | Arithmetic::Subtract | Arithmetic::Multiply => return None,
        };
        if !self.an.options.codesys {
            return None;
        }
        if self.divides_by_zero(op, El::Lint, right) {
            return Some(self.error(Message::E2028, right.range, "division by zero"));
        }
        if let (Some(Const::Int(a)), Some(Const::Int(b))) = (left.as_const(), right.as_const()) {
            return Some(self.folded_int(
                crate::st::body::operator::fold::fold_int(op, *a, *b),
                ty,
                range,
            ));
        }
        let op = if op == Arithmetic::Modulo {
            Op::Modulo
        } else {
            Op::Divide
        };
        let (left, right) = (self.raw(left), self.raw(right));
        let storage = El::Lint.storage();
        let value = self.add_expr(ExprKind::Binary(op, left, right), storage, range);
        Some(Operand::value(value, ty, range))
    }

    /// `TIME_TO_DWORD`, `DWORD_TO_TIME` and their like: by way of the number of the same width.
    pub(crate) fn time_and_bits(
        &mut self,
        name: Symbol,
        function: &str,
        operand: &Operand,
        range: TextRange,
    ) -> Option<Operand> {
        let target = self.an.named_elementary(function.strip_prefix("TO_")?)?;
        let to = self.an.types.elementary(target)?;
        let from = self.an.types.elementary(operand.ty)?;
        let bits = |el: El| el.is_bits() && el != El::Bool;
        let (from_number, to_number) = match (from.is_duration(), to.is_duration()) {
            (true, false) if bits(to) => (from, counts_as(to)),
            (false, true) if bits(from) => (counts_as(from), to),
            _ => return None,
        };
        if !self.an.options.codesys {
            self.an.foreign(self.unit, range, self.text(name));
            return Some(Operand::error(range));
        }
        let value = self.raw(operand);
        let value = self.convert_expr(value, from_number, to_number, false, range);
        Some(Operand::value(value, target, range))
    }

    /// `TIME()`, `LTIME()`: the time of the scan.
    pub(crate) fn clock(
        &mut self,
        callee: st::Id<st::Expr>,
        arguments: st::List<st::Argument>,
        range: TextRange,
    ) -> Option<Operand> {
        let Written::Name(name) = self.arena()[callee].kind else {
            return None;
        };
        let ty = self.an.elementary_names.get(&name).copied()?;
        let clock = self.an.types.elementary(ty).is_some_and(El::is_duration);
        if !clock || !arguments.is_empty() || !self.an.options.codesys || self.constant_only {
            return None;
        }
        let value = self.add_expr(ExprKind::Now, El::Ltime.storage(), range);
        Some(Operand::value(value, ty, range))
    }
}
