//! Comparisons: in which type two operands are compared, and what that gives for constants.

use crate::hir::CompareOp;
use crate::hir::code::ExprKind;
use crate::st::body::operator::fold::as_real;
use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::BinaryOp;
use iecc_source::TextRange;
use std::cmp::Ordering;

impl Body<'_, '_> {
    /// Two operands compared; `compared` is what `op` means.
    pub(crate) fn compare(
        &mut self,
        op: BinaryOp,
        compared: CompareOp,
        left: Operand,
        right: Operand,
        range: TextRange,
    ) -> Operand {
        let left = self.beside_text(left, &right);
        let right = self.beside_text(right, &left);
        let Some(ty) = self.compared_type(op, &left, &right, range) else {
            return Operand::error(range);
        };
        if let (Some(a), Some(b)) = (left.as_const(), right.as_const())
            && let Some(value) = fold_compare(compared, a, b)
        {
            return Operand::constant(Const::Int(i128::from(value)), TypeId::BOOL, range);
        }
        if let TypeKind::Text { .. } = self.an.types.base(ty) {
            return self.compare_texts(compared, left, right, range);
        }
        let (left, right) = (self.as_scalar(&left, ty), self.as_scalar(&right, ty));
        if self.an.types.elementary(ty).is_some_and(El::is_real) {
            self.real_equality(compared, left, right, range);
        }
        let value = self.add_expr(
            ExprKind::Compare(compared, left, right),
            crate::hir::Elementary::Bool,
            range,
        );
        Operand::value(value, TypeId::BOOL, range)
    }

    /// A character beside a string becomes one, but beside a literal of one character, which is one.
    fn beside_text(&mut self, operand: Operand, other: &Operand) -> Operand {
        let single = matches!(
            self.an.types.base(other.ty),
            TypeKind::Text { length: 1, .. }
        );
        if single && other.as_const().is_some() {
            return operand;
        }
        let text = self.character_as_text(&operand, other.ty);
        text.unwrap_or(operand)
    }

    /// The type in which two operands are compared; a message if there is none.
    fn compared_type(
        &mut self,
        op: BinaryOp,
        left: &Operand,
        right: &Operand,
        range: TextRange,
    ) -> Option<TypeId> {
        let (a, b) = (self.an.types.strip(left.ty), self.an.types.strip(right.ty));
        let equality = matches!(op, BinaryOp::Equal | BinaryOp::NotEqual);
        let types = &self.an.types;
        let found = match (types.kind(a), types.kind(b)) {
            (TypeKind::Enum(x), TypeKind::Enum(y)) if x == y && equality => Some(a),
            (TypeKind::Reference(..) | TypeKind::Interface(_), TypeKind::Null) if equality => {
                Some(a)
            }
            (TypeKind::Null, TypeKind::Reference(..) | TypeKind::Interface(_)) if equality => {
                Some(b)
            }
            (TypeKind::Reference(_, x), TypeKind::Reference(_, y))
                if equality && (self.refers_alike(*x, *y) || self.refers_alike(*y, *x)) =>
            {
                Some(a)
            }
            (TypeKind::Interface(_), TypeKind::Interface(_)) if equality => Some(a),
            (TypeKind::Text { wide: x, .. }, TypeKind::Text { wide: y, .. }) if x == y => Some(a),
            (TypeKind::Text { length: 1, .. }, TypeKind::Elementary(El::Char | El::Wchar)) => {
                left.as_const().is_some().then_some(b)
            }
            (TypeKind::Elementary(El::Char | El::Wchar), TypeKind::Text { length: 1, .. }) => {
                right.as_const().is_some().then_some(a)
            }
            _ => self.compared_elementary(left, right),
        };
        if found.is_none() {
            self.no_common_type(op, left, right, range);
        }
        found
    }

    fn compared_elementary(&self, left: &Operand, right: &Operand) -> Option<TypeId> {
        let untyped = |ty| matches!(ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
        let types = &self.an.types;
        match (untyped(left.ty), untyped(right.ty)) {
            (true, true) => Some(TypeId::UNTYPED_REAL),
            (true, false) => types
                .elementary(right.ty)
                .map(|_| self.literal_beside(left, right, None)),
            (false, true) => types
                .elementary(left.ty)
                .map(|_| self.literal_beside(right, left, None)),
            (false, false) => {
                let (a, b) = (types.elementary(left.ty)?, types.elementary(right.ty)?);
                self.common(a, b).map(TypeId::of)
            }
        }
    }

    fn compare_texts(
        &mut self,
        op: CompareOp,
        left: Operand,
        right: Operand,
        range: TextRange,
    ) -> Operand {
        let order = self.stdlib_call("__COMPARE", vec![left, right], range, None);
        if order.is_error() {
            return order;
        }
        let value = self.raw(&order);
        let storage = self.code.expr(value).ty;
        let zero = self.add_const(0, storage, range);
        let kind = ExprKind::Compare(op, value, zero);
        let value = self.add_expr(kind, crate::hir::Elementary::Bool, range);
        Operand::value(value, TypeId::BOOL, range)
    }
}

fn fold_compare(op: CompareOp, a: &Const, b: &Const) -> Option<bool> {
    let order = match (a, b) {
        (Const::Int(a), Const::Int(b)) => Some(a.cmp(b)),
        (Const::Text(a), Const::Text(b)) => Some(a.cmp(b)),
        (Const::Null, Const::Null) => Some(Ordering::Equal),
        (Const::Text(_) | Const::Null, _) | (_, Const::Text(_) | Const::Null) => return None,
        (a, b) => as_real(a).partial_cmp(&as_real(b)),
    };
    Some(match op {
        CompareOp::Equal => order == Some(Ordering::Equal),
        CompareOp::NotEqual => order != Some(Ordering::Equal),
        CompareOp::Less => order == Some(Ordering::Less),
        CompareOp::LessEqual => matches!(order, Some(Ordering::Less | Ordering::Equal)),
        CompareOp::Greater => order == Some(Ordering::Greater),
        CompareOp::GreaterEqual => matches!(order, Some(Ordering::Greater | Ordering::Equal)),
    })
}
