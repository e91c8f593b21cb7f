//! Expressions.

use super::{Body, Operand, OperandKind};
use crate::hir::code::ExprKind;
use crate::st::constant::Const;
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, ExprKind as Written};
use iecc_diag::Code as Message;

impl Body<'_, '_> {
    /// Looks at an expression. `want` is the type that its use needs, which literals take; the
    /// result may still be of another type. Where only constants are allowed, it is one.
    pub(crate) fn expr(&mut self, id: st::Id<st::Expr>, want: Option<TypeId>) -> Operand {
        let operand = self.any_expr(id, want);
        if self.constant_only {
            return self.known(operand);
        }
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
            Written::Ref(operand) => self.reference_to(operand, range),
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

    /// `REF(operand)`.
    fn reference_to(
        &mut self,
        operand: st::Id<st::Expr>,
        range: iecc_source::TextRange,
    ) -> Operand {
        let target = self.expr(operand, None);
        if target.is_error() {
            return Operand::error(range);
        }
        let OperandKind::Place(place) = &target.kind else {
            return self.error(
                Message::E3002,
                target.range,
                "only a variable has a reference",
            );
        };
        if let Some(why) = self.no_reference(place) {
            return self.error(Message::E3002, target.range, why);
        }
        let place = place.clone();
        let path = self.path_of(&place, target.range);
        let value = self.add_expr(
            ExprKind::Address(path),
            crate::hir::Elementary::Ulint,
            range,
        );
        let kind = crate::st::types::ReferenceKind::RefTo;
        let ty = self.an.types.intern(TypeKind::Reference(kind, target.ty));
        Operand::value(value, ty, range)
    }
}
