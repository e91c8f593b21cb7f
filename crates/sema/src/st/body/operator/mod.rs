//! Operators: which types they take, what type comes out, and what they are for constants.

mod bits_as_numbers;
mod compare;
mod fold;
mod time;
mod untyped;

use super::{Body, Operand, OperandKind};
use crate::hir::code::{BinaryOp as Op, Conversion, ExprId, ExprKind, UnaryOp as Unary};
use crate::hir::{Arithmetic, CompareOp, Logical};
use crate::st::constant::Const;
use crate::st::elementary::{El, Family};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, BinaryOp, UnaryOp};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

/// What an operator between two operands does.
#[derive(Debug, Clone, Copy)]
pub(super) enum Class {
    /// Computes with numbers and times.
    Arithmetic(Arithmetic),
    /// Works on each bit.
    Logical(Logical),
    /// Compares.
    Compare(CompareOp),
    /// `**`, a function of the library.
    Power,
    /// Evaluates its right side only if it counts.
    Lazy,
}

/// What an operator does.
pub(super) fn class(op: BinaryOp) -> Class {
    match op {
        BinaryOp::Add => Class::Arithmetic(Arithmetic::Add),
        BinaryOp::Subtract => Class::Arithmetic(Arithmetic::Subtract),
        BinaryOp::Multiply => Class::Arithmetic(Arithmetic::Multiply),
        BinaryOp::Divide => Class::Arithmetic(Arithmetic::Divide),
        BinaryOp::Modulo => Class::Arithmetic(Arithmetic::Modulo),
        BinaryOp::And => Class::Logical(Logical::And),
        BinaryOp::Or => Class::Logical(Logical::Or),
        BinaryOp::Xor => Class::Logical(Logical::Xor),
        BinaryOp::Equal => Class::Compare(CompareOp::Equal),
        BinaryOp::NotEqual => Class::Compare(CompareOp::NotEqual),
        BinaryOp::Less => Class::Compare(CompareOp::Less),
        BinaryOp::LessEqual => Class::Compare(CompareOp::LessEqual),
        BinaryOp::Greater => Class::Compare(CompareOp::Greater),
        BinaryOp::GreaterEqual => Class::Compare(CompareOp::GreaterEqual),
        BinaryOp::Power => Class::Power,
        BinaryOp::AndThen | BinaryOp::OrElse => Class::Lazy,
    }
}

/// Whether an operator compares.
pub(super) fn compares(op: BinaryOp) -> bool {
    matches!(class(op), Class::Compare(_))
}

impl Body<'_, '_> {
    pub(super) fn unary(
        &mut self,
        op: UnaryOp,
        operand: st::Id<st::Expr>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let operand = self.expr(operand, want);
        self.unary_on(op, operand, range, want)
    }

    pub(super) fn unary_on(
        &mut self,
        op: UnaryOp,
        operand: Operand,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if operand.is_error() {
            return Operand::error(range);
        }
        match op {
            UnaryOp::Not => self.not(operand, range, want),
            UnaryOp::Plus => {
                if self.signed_operand(&operand, "+") {
                    Operand { range, ..operand }
                } else {
                    Operand::error(range)
                }
            }
            UnaryOp::Negate => self.negate(operand, range),
        }
    }

    fn signed_operand(&mut self, operand: &Operand, sign: &str) -> bool {
        let untyped = matches!(operand.ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
        let fits = |el: El| el.is_num() || el.is_duration();
        if untyped || self.an.types.elementary(operand.ty).is_some_and(fits) {
            return true;
        }
        let name = self.type_name(operand.ty);
        let message = format!("`{sign}` takes a number or a duration, not {name}");
        self.error(Message::E2027, operand.range, message);
        false
    }

    fn negate(&mut self, operand: Operand, range: TextRange) -> Operand {
        if !self.signed_operand(&operand, "-") {
            return Operand::error(range);
        }
        let el = self.an.types.elementary(operand.ty);
        if let Some(value) = operand.as_const() {
            let value = match value {
                Const::Int(number) => {
                    return self.folded_int(number.checked_neg(), operand.ty, range);
                }
                Const::Real(number) => Const::Real(-number),
                Const::Literal(single, double) => Const::Literal(-single, -double),
                Const::Text(_) | Const::Null => value.clone(),
            };
            return self.folded(value, operand.ty, range);
        }
        if el.is_some_and(|el| el.family() == Family::Unsigned) {
            let message = format!("{} has no negative values", self.type_name(operand.ty));
            return self.error(Message::E2027, range, message);
        }
        let el = el.expect("computed operands have a type");
        let value = self.raw(&operand);
        let value = self.add_expr(ExprKind::Unary(Unary::Negate, value), el.storage(), range);
        Operand::value(value, TypeId::of(el), range)
    }

    fn not(&mut self, operand: Operand, range: TextRange, want: Option<TypeId>) -> Operand {
        let operand = self.bit_operand(operand, want, "NOT");
        if operand.is_error() {
            return Operand::error(range);
        }
        let el = self.an.types.elementary(operand.ty).expect("a bit string");
        if let Some(Const::Int(value)) = operand.as_const() {
            let mask = el.range().1;
            return Operand::constant(Const::Int(!value & mask), TypeId::of(el), range);
        }
        let value = self.raw(&operand);
        let value = self.add_expr(ExprKind::Unary(Unary::Not, value), el.storage(), range);
        Operand::value(value, TypeId::of(el), range)
    }

    /// An operand that must be a bit string; literals become one of the type that is wanted.
    fn bit_operand(&mut self, operand: Operand, want: Option<TypeId>, op: &str) -> Operand {
        if operand.ty == TypeId::UNTYPED_INT {
            let wanted = want.and_then(|ty| self.an.types.elementary(ty));
            let el = wanted.filter(|el| el.is_bits()).unwrap_or_else(|| {
                let value = operand.as_const().and_then(Const::as_int).unwrap_or(0);
                let fits = |el: &&El| el.is_bits() && el.range().1 >= value;
                *El::ALL.iter().find(fits).unwrap_or(&El::Lword)
            });
            return match self.constant_to(&operand, TypeId::of(el)) {
                Some(value) => Operand::constant(value, TypeId::of(el), operand.range),
                None => Operand::error(operand.range),
            };
        }
        if self
            .an
            .types
            .elementary(operand.ty)
            .is_some_and(El::is_bits)
            || operand.is_error()
        {
            return operand;
        }
        let name = self.type_name(operand.ty);
        let message = format!("{op} takes BOOL or a bit string, not {name}");
        self.error(Message::E2027, operand.range, message)
    }

    pub(super) fn binary(
        &mut self,
        op: BinaryOp,
        left: st::Id<st::Expr>,
        right: st::Id<st::Expr>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        // What a comparison is used for says nothing about its operands.
        let inner = want.filter(|_| !compares(op));
        if matches!(op, BinaryOp::AndThen | BinaryOp::OrElse) {
            return self.short_circuit(op, left, right, range);
        }
        let chained = compares(op) && self.is_comparison(left);
        self.in_place(|body| {
            let (left, right) = body.operands(left, right, inner);
            if chained && body.is_chain(&right) {
                return body.chain_of_comparisons(range);
            }
            body.binary_on(op, left, right, range, want)
        })
    }

    fn chain_of_comparisons(&mut self, range: TextRange) -> Operand {
        let message = "this compares what a comparison gives, which is a BOOL, with a number";
        let diagnostic = Diagnostic::new(Message::E2029, self.span(range), message);
        self.report(diagnostic.note("two comparisons are joined: `0 < x AND x < 10`"));
        Operand::error(range)
    }

    fn is_comparison(&self, expr: st::Id<st::Expr>) -> bool {
        matches!(self.arena()[expr].kind, st::ExprKind::Binary { op, .. } if compares(op))
    }

    /// Whether what a comparison is compared with is a number that is no truth value.
    fn is_chain(&self, right: &Operand) -> bool {
        let el = self.an.types.elementary(right.ty);
        let literal = match right.as_const() {
            Some(Const::Int(value)) => right.ty == TypeId::UNTYPED_INT && !(0..=1).contains(value),
            Some(_) | None => right.ty == TypeId::UNTYPED_REAL,
        };
        literal || el.is_some_and(El::is_num)
    }

    /// An operator on operands that were looked at.
    pub(super) fn binary_on(
        &mut self,
        op: BinaryOp,
        left: Operand,
        right: Operand,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if left.is_error() || right.is_error() {
            return Operand::error(range);
        }
        match class(op) {
            Class::Compare(compared) => {
                let (left, right) = self.numbers_as_durations(left, right);
                let (left, right) = self.zero_as_null(left, right);
                self.compare(op, compared, left, right, range)
            }
            Class::Logical(logical) => self.bitwise(op, logical, left, right, range, want),
            Class::Arithmetic(what) => self.arithmetic(op, what, left, right, range, want),
            Class::Power => self.power(left, right, range, want),
            Class::Lazy => unreachable!("handled before"),
        }
    }

    fn short_circuit(
        &mut self,
        op: BinaryOp,
        left: st::Id<st::Expr>,
        right: st::Id<st::Expr>,
        range: TextRange,
    ) -> Operand {
        let left = self.scalar_expr(left, TypeId::BOOL);
        let outer = std::mem::take(&mut self.pending);
        let right = self.scalar_expr(right, TypeId::BOOL);
        let inner = std::mem::replace(&mut self.pending, outer);
        let bool_storage = crate::hir::Elementary::Bool;
        let right = if inner.is_empty() {
            right
        } else {
            self.add_expr(ExprKind::After(inner, right), bool_storage, range)
        };
        let known = self.add_const(u64::from(op == BinaryOp::OrElse), bool_storage, range);
        let kind = if op == BinaryOp::AndThen {
            ExprKind::Choose(left, right, known)
        } else {
            ExprKind::Choose(left, known, right)
        };
        let value = self.add_expr(kind, bool_storage, range);
        Operand::value(value, TypeId::BOOL, range)
    }

    fn bitwise(
        &mut self,
        op: BinaryOp,
        logical: Logical,
        left: Operand,
        right: Operand,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let hint = |other: &Operand| {
            if other.ty == TypeId::UNTYPED_INT {
                want
            } else {
                Some(other.ty)
            }
        };
        let (left_hint, right_hint) = (hint(&right), hint(&left));
        let alike = left.ty == right.ty;
        let left = self.bit_operand(left, left_hint, op.as_str());
        if left.is_error() && alike {
            return Operand::error(range);
        }
        let right = self.bit_operand(right, right_hint, op.as_str());
        if left.is_error() || right.is_error() {
            return Operand::error(range);
        }
        let elementary = |ty| self.an.types.elementary(ty).expect("a bit string");
        let (a, b) = (elementary(left.ty), elementary(right.ty));
        let el = a.common(b).expect("bit strings widen to one another");
        let ty = TypeId::of(el);
        if let (Some(Const::Int(a)), Some(Const::Int(b))) = (left.as_const(), right.as_const()) {
            let value = match logical {
                Logical::And => a & b,
                Logical::Or => a | b,
                Logical::Xor => a ^ b,
            };
            return Operand::constant(Const::Int(value), ty, range);
        }
        let op = match logical {
            Logical::And => Op::And,
            Logical::Or => Op::Or,
            Logical::Xor => Op::Xor,
        };
        let (left, right) = (self.as_scalar(&left, ty), self.as_scalar(&right, ty));
        let value = self.add_expr(ExprKind::Binary(op, left, right), el.storage(), range);
        Operand::value(value, ty, range)
    }

    fn arithmetic(
        &mut self,
        op: BinaryOp,
        what: Arithmetic,
        left: Operand,
        right: Operand,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if self.pointer_arithmetic(op, &left, &right, range) {
            return Operand::error(range);
        }
        let (left, right) = match what {
            Arithmetic::Add | Arithmetic::Subtract => self.numbers_as_durations(left, right),
            Arithmetic::Multiply | Arithmetic::Divide | Arithmetic::Modulo => (left, right),
        };
        if let Some(result) = self.divided_durations(what, &left, &right, range) {
            return result;
        }
        if let Some(result) = self.time_arithmetic(op, what, &left, &right, range) {
            return result;
        }
        let Some(ty) = self.number_type(op, &left, &right, want, range) else {
            return Operand::error(range);
        };
        if left.as_const().is_some() && right.as_const().is_some() {
            return self.fold_arithmetic(what, &left, &right, ty, range);
        }
        let el = self
            .an
            .types
            .elementary(ty)
            .expect("computed operands have a type");
        if self.divides_by_zero(what, el, &right) {
            return self.error(Message::E2028, right.range, "division by zero");
        }
        let hir_op = match what {
            Arithmetic::Add => Op::Add,
            Arithmetic::Subtract => Op::Subtract,
            Arithmetic::Multiply => Op::Multiply,
            Arithmetic::Modulo => Op::Modulo,
            Arithmetic::Divide if el.is_real() || right.as_const().is_some() => Op::DivideUnchecked,
            Arithmetic::Divide => Op::Divide,
        };
        let (left, right) = (self.as_scalar(&left, ty), self.as_scalar(&right, ty));
        let value = self.add_expr(ExprKind::Binary(hir_op, left, right), el.storage(), range);
        Operand::value(value, ty, range)
    }

    pub(super) fn divides_by_zero(&self, what: Arithmetic, el: El, right: &Operand) -> bool {
        what == Arithmetic::Divide
            && !el.is_real()
            && matches!(right.as_const(), Some(Const::Int(0)))
    }

    /// The type in which two numbers are computed with; a message if there is none.
    fn number_type(
        &mut self,
        op: BinaryOp,
        left: &Operand,
        right: &Operand,
        want: Option<TypeId>,
        range: TextRange,
    ) -> Option<TypeId> {
        for operand in [left, right] {
            let untyped = matches!(operand.ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
            let el = self.an.types.elementary(operand.ty);
            let fits = |el: El| self.counts(el) || (el.is_real() && op != BinaryOp::Modulo);
            if !untyped && !el.is_some_and(fits) {
                let name = self.type_name(operand.ty);
                let message = if op == BinaryOp::Modulo {
                    format!("MOD takes integers, not {name}")
                } else {
                    format!("`{}` takes numbers, not {name}", op.as_str())
                };
                let mut diagnostic =
                    Diagnostic::new(Message::E2027, self.span(operand.range), message);
                let text = matches!(self.an.types.base(operand.ty), TypeKind::Text { .. });
                if text && op == BinaryOp::Add {
                    diagnostic = diagnostic.note("CONCAT joins strings: CONCAT(a, b)");
                }
                self.report(diagnostic);
                return None;
            }
        }
        let ty = self.common_number(left, right, want);
        if ty.is_none() {
            self.no_common_type(op, left, right, range);
        }
        ty
    }

    pub(super) fn no_common_type(
        &mut self,
        op: BinaryOp,
        left: &Operand,
        right: &Operand,
        range: TextRange,
    ) {
        let (a, b) = (self.type_name(left.ty), self.type_name(right.ty));
        if self.an.types.strip(left.ty) == self.an.types.strip(right.ty) {
            let message = format!("`{}` does not take {a}", op.as_str());
            self.error(Message::E2027, range, message);
            return;
        }
        let message = format!(
            "`{}` has operands of types that no type holds: {a} and {b}",
            op.as_str()
        );
        let diagnostic = Diagnostic::new(Message::E2029, self.span(range), message)
            .also(self.span(left.range), format!("this is {a}"))
            .also(self.span(right.range), format!("this is {b}"))
            .note("convert one of them");
        self.report(diagnostic);
    }

    /// The type of two operands together: literals take that of the other, or the wanted one.
    pub(super) fn common_number(
        &mut self,
        left: &Operand,
        right: &Operand,
        want: Option<TypeId>,
    ) -> Option<TypeId> {
        let untyped = |ty| matches!(ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
        match (untyped(left.ty), untyped(right.ty)) {
            (true, true) => {
                let fraction = left.ty == TypeId::UNTYPED_REAL || right.ty == TypeId::UNTYPED_REAL;
                let wanted = want.filter(|ty| {
                    let el = self.an.types.elementary(*ty);
                    el.is_some_and(|el| if fraction { el.is_real() } else { el.is_num() })
                });
                let own = if fraction {
                    TypeId::UNTYPED_REAL
                } else {
                    TypeId::UNTYPED_INT
                };
                let wanted = wanted.and_then(|ty| self.an.types.elementary(ty));
                Some(wanted.map_or(own, TypeId::of))
            }
            (true, false) => Some(self.literal_beside(left, right, want)),
            (false, true) => Some(self.literal_beside(right, left, want)),
            (false, false) => {
                let a = self.an.types.elementary(left.ty)?;
                let b = self.an.types.elementary(right.ty)?;
                self.common(a, b).map(TypeId::of)
            }
        }
    }

    /// The type of a literal and a typed operand: that of the operand, but a fraction makes an integer the
    /// real number that holds it, or the one that is wanted.
    pub(super) fn literal_beside(
        &self,
        literal: &Operand,
        typed: &Operand,
        want: Option<TypeId>,
    ) -> TypeId {
        let Some(el) = self.an.types.elementary(typed.ty) else {
            return typed.ty;
        };
        if literal.ty != TypeId::UNTYPED_REAL || !el.is_int() {
            return TypeId::of(el);
        }
        let wanted = want.and_then(|ty| self.an.types.elementary(ty));
        let real = match wanted {
            Some(El::Lreal) => Some(El::Lreal),
            Some(_) | None => el.common(El::Real),
        };
        TypeId::of(real.unwrap_or(el))
    }

    /// A number by value in another storage.
    pub(super) fn convert_value(&mut self, value: ExprId, to: El, range: TextRange) -> ExprId {
        if self.code.expr(value).ty == to.storage() {
            return value;
        }
        let kind = ExprKind::Convert(Conversion::Value, value);
        self.add_expr(kind, to.storage(), range)
    }

    /// `left ** right`.
    fn power(
        &mut self,
        left: Operand,
        right: Operand,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        for operand in [&left, &right] {
            let untyped = matches!(operand.ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
            let number = self.an.types.elementary(operand.ty).is_some_and(El::is_num);
            if !untyped && !number {
                let name = self.type_name(operand.ty);
                let message = format!("`**` takes numbers, not {name}");
                return self.error(Message::E2027, operand.range, message);
            }
        }
        self.stdlib_call("EXPT", vec![left, right], range, want)
    }

    /// Whether an operand is a place of an instance.
    pub(super) fn is_instance(&self, operand: &Operand) -> bool {
        matches!(operand.kind, OperandKind::Place(_))
            && matches!(self.an.types.base(operand.ty), TypeKind::Instance(_))
    }
}
