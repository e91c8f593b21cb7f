//! Sums, differences and multiples of durations and points in time.

use crate::hir::code::{BinaryOp as Op, ExprId, ExprKind, PathId, Root, StmtKind};
use crate::hir::{Arithmetic, Elementary, Type};
use crate::st::body::operator::fold::fold_int;
use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::{El, Family};
use crate::st::types::TypeId;
use iecc_ast::st::BinaryOp;
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// The time of the scan; in a program that runs tests that of the test.
    pub(crate) fn now(&mut self, range: TextRange) -> ExprId {
        let lint = El::Ltime.storage();
        match self.an.clock() {
            None => self.add_expr(ExprKind::Now, lint, range),
            Some(clock) => {
                let path = self.add_path(Root::Tag(clock), Vec::new(), range);
                self.add_expr(ExprKind::Load(path), lint, range)
            }
        }
    }

    /// The time since what is at a place was renewed, and renews it. The time of a test never goes
    /// back, so a difference is what an engine gives.
    pub(crate) fn time_since(
        &mut self,
        kind: ExprKind,
        ty: Elementary,
        last: PathId,
        range: TextRange,
    ) -> ExprId {
        if !matches!(kind, ExprKind::Elapsed(_)) || self.an.clock().is_none() {
            return self.add_expr(kind, ty, range);
        }
        let lint = El::Ltime.storage();
        let (now, before) = (
            self.now(range),
            self.add_expr(ExprKind::Load(last), lint, range),
        );
        let passed = self.add_expr(ExprKind::Binary(Op::Subtract, now, before), lint, range);
        let local = self.add_local("elapsed", Type::Elementary(lint));
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        self.before(StmtKind::Assign(path, passed), range);
        let now = self.now(range);
        self.before(StmtKind::Assign(last, now), range);
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        self.add_expr(ExprKind::Load(path), lint, range)
    }

    /// Addition and the like on durations and points in time; `None` if neither operand is one.
    pub(crate) fn time_arithmetic(
        &mut self,
        op: BinaryOp,
        what: Arithmetic,
        left: &Operand,
        right: &Operand,
        range: TextRange,
    ) -> Option<Operand> {
        let types = &self.an.types;
        let (a, b) = (types.elementary(left.ty), types.elementary(right.ty));
        let is_time = |el: Option<El>| el.is_some_and(|el| el.is_duration() || el.is_date());
        if !is_time(a) && !is_time(b) {
            return None;
        }
        let result = time_result(what, a, b);
        let Some((result, wrap_day)) = result else {
            let scaled = match what {
                Arithmetic::Multiply if is_time(a) => Some((left, right)),
                Arithmetic::Multiply => Some((right, left)),
                Arithmetic::Divide => Some((left, right)),
                Arithmetic::Add | Arithmetic::Subtract | Arithmetic::Modulo => None,
            };
            if let Some((time, factor)) = scaled
                && self
                    .an
                    .types
                    .elementary(time.ty)
                    .is_some_and(El::is_duration)
            {
                return Some(self.scale_time(op, what, time, factor, range));
            }
            self.no_common_type(op, left, right, range);
            return Some(Operand::error(range));
        };
        let ty = TypeId::of(result);
        if let (Some(Const::Int(a)), Some(Const::Int(b))) = (left.as_const(), right.as_const()) {
            let value = fold_int(what, *a, *b).expect("sums fit");
            let day = 86_400_000_000_000;
            let value = if wrap_day {
                value.rem_euclid(day)
            } else {
                value
            };
            return Some(self.folded(Const::Int(value), ty, range));
        }
        let hir_op = if what == Arithmetic::Add {
            Op::Add
        } else {
            Op::Subtract
        };
        let storage = result.storage();
        let (a, mut b) = (self.raw(left), self.raw(right));
        if wrap_day {
            // Else the sum itself could wrap.
            let day = self.add_const(86_400_000_000_000, storage, range);
            b = self.add_expr(ExprKind::Binary(Op::Modulo, b, day), storage, range);
        }
        let mut value = self.add_expr(ExprKind::Binary(hir_op, a, b), storage, range);
        if wrap_day {
            value = self.wrap_day(value, range);
        }
        Some(Operand::value(value, ty, range))
    }

    /// A time of day that is off by less than a day, brought back between midnight and midnight.
    fn wrap_day(&mut self, value: ExprId, range: TextRange) -> ExprId {
        let storage = El::Tod.storage();
        let day = self.add_const(86_400_000_000_000, storage, range);
        let sum = self.add_expr(ExprKind::Binary(Op::Add, value, day), storage, range);
        self.add_expr(ExprKind::Binary(Op::Modulo, sum, day), storage, range)
    }

    /// A duration times or divided by a number.
    fn scale_time(
        &mut self,
        op: BinaryOp,
        what: Arithmetic,
        time: &Operand,
        factor: &Operand,
        range: TextRange,
    ) -> Operand {
        let el = self.an.types.elementary(time.ty).expect("a duration");
        let factor_el = match self.an.types.elementary(factor.ty) {
            Some(el) if el.is_num() => el,
            None if factor.ty == TypeId::UNTYPED_INT => El::Lint,
            None if factor.ty == TypeId::UNTYPED_REAL => El::Lreal,
            Some(_) | None => {
                self.no_common_type(op, time, factor, range);
                return Operand::error(range);
            }
        };
        let storage = el.storage();
        let ty = TypeId::of(el);
        if factor_el.is_real() {
            let real = El::Lreal;
            let wide = self.raw(time);
            let wide = self.convert_value(wide, real, range);
            let factor = self.as_scalar(factor, TypeId::of(factor_el));
            let factor = self.convert_value(factor, real, range);
            let hir_op = if what == Arithmetic::Multiply {
                Op::Multiply
            } else {
                Op::DivideUnchecked
            };
            let kind = ExprKind::Binary(hir_op, wide, factor);
            let value = self.add_expr(kind, real.storage(), range);
            let value = self.convert_value(value, el, range);
            return Operand::value(value, ty, range);
        }
        if self.divides_by_zero(what, factor_el, factor) {
            return self.error(Message::E2028, factor.range, "division by zero");
        }
        if let (Some(Const::Int(a)), Some(Const::Int(b))) = (time.as_const(), factor.as_const()) {
            return self.folded_int(fold_int(what, *a, *b), ty, range);
        }
        let constant = factor.as_const().is_some();
        let factor = self.as_scalar(factor, TypeId::of(factor_el));
        let factor = self.convert_value(factor, el, range);
        let time_value = self.raw(time);
        let hir_op = if what == Arithmetic::Multiply {
            Op::Multiply
        } else if constant {
            Op::DivideUnchecked
        } else {
            Op::Divide
        };
        let kind = ExprKind::Binary(hir_op, time_value, factor);
        let value = self.add_expr(kind, storage, range);
        Operand::value(value, ty, range)
    }
}

/// What comes out of a sum or difference of times, and whether it stays within a day.
fn time_result(op: Arithmetic, a: Option<El>, b: Option<El>) -> Option<(El, bool)> {
    let (a, b) = (a?, b?);
    let long = a.is_long_time();
    // Short and long families do not mix, but a long operand may have a short duration beside it.
    if long != b.is_long_time() && !(b == El::Time || a == El::Time) {
        return None;
    }
    let duration = if long || (b.is_long_time() && a.is_duration()) {
        El::Ltime
    } else {
        El::Time
    };
    match (op, a.family(), b.family()) {
        (Arithmetic::Add | Arithmetic::Subtract, Family::Duration, Family::Duration) => {
            Some((duration, false))
        }
        (Arithmetic::Add | Arithmetic::Subtract, Family::TimeOfDay, Family::Duration)
            if long || b == El::Time =>
        {
            Some((a, true))
        }
        (Arithmetic::Add | Arithmetic::Subtract, Family::DateTime, Family::Duration)
            if long || b == El::Time =>
        {
            Some((a, false))
        }
        (Arithmetic::Subtract, Family::Date, Family::Date)
        | (Arithmetic::Subtract, Family::TimeOfDay, Family::TimeOfDay)
        | (Arithmetic::Subtract, Family::DateTime, Family::DateTime)
            if a == b =>
        {
            Some((duration, false))
        }
        _ => None,
    }
}
