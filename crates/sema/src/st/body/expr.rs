//! Expressions: any is looked at here first. Where only constants are allowed it is one, or a
//! message is given.

use super::{Body, Operand};
use crate::st::constant::Const;
use crate::st::types::{ReferenceKind, TypeId};
use iecc_ast::st::{self, ExprKind as Written};
use iecc_diag::Code as Message;

impl Body<'_, '_> {
    /// Looks at an expression. `want` is the type that its use needs, which literals take; the
    /// result may still be of another type. Where only constants are allowed, it is one.
    pub(crate) fn expr(&mut self, id: st::Id<st::Expr>, want: Option<TypeId>) -> Operand {
        if !self.constant_only {
            return self.any_expr(id, want);
        }
        // The code of this expression alone is run.
        let code = std::mem::take(&mut self.code);
        let pending = std::mem::take(&mut self.pending);
        let operand = self.any_expr(id, want);
        let operand = self.known(operand);
        (self.code, self.pending) = (code, pending);
        operand
    }

    fn any_expr(&mut self, id: st::Id<st::Expr>, want: Option<TypeId>) -> Operand {
        let arena = self.arena();
        let written = arena[id];
        let range = written.range;
        match written.kind {
            Written::Literal(literal) => self.literal(&arena[literal], range),
            Written::Typed { ty, value } => self.typed_literal(ty, value, range),
            Written::Name(_)
            | Written::Member { .. }
            | Written::Part { .. }
            | Written::Index { .. }
            | Written::Deref(_)
            | Written::Direct(_)
            | Written::This
            | Written::Super => self.place(id, want),
            Written::Null => Operand::constant(Const::Null, TypeId::NULL, range),
            Written::Ref(operand) => self.reference_to(operand, ReferenceKind::RefTo, range),
            Written::Call { callee, arguments } => self.call(id, callee, arguments, range, want),
            Written::Unary { op, operand } => self.unary(op, operand, range, want),
            Written::Binary {
                op, left, right, ..
            } => self.binary(op, left, right, range, want),
            Written::ArrayValue(_) | Written::Repeat { .. } | Written::StructValue(_) => self
                .error(
                    Message::E3001,
                    range,
                    "values of arrays and structures stand in declarations only",
                ),
            Written::Error => Operand::error(range),
        }
    }

    /// A value whose type must be there, as a number of that type.
    pub(crate) fn scalar_expr(
        &mut self,
        id: st::Id<st::Expr>,
        ty: TypeId,
    ) -> crate::hir::code::ExprId {
        let operand = self.expr(id, Some(ty));
        self.as_scalar(&operand, ty)
    }
}
