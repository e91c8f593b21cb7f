//! From left to right: what an operand was when its turn came, whatever those behind it change.
//!
//! What a call needs before it, and what it does behind it, are statements. Where its value is a number, they
//! run where the value is needed. Structures and strings are made before the statement
//! they stand in, in their order; a number in front of them is read before them.

use crate::hir::code::ExprKind;
use crate::hir::code::Root;
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};

impl Body<'_, '_> {
    /// An operand whose statements run where its value is needed, if that is a number.
    pub(crate) fn in_place(&mut self, make: impl FnOnce(&mut Self) -> Operand) -> Operand {
        let outer = std::mem::take(&mut self.pending);
        let made = make(self);
        let mut before = std::mem::replace(&mut self.pending, outer);
        let scalar = !made.is_error() && self.an.types.is_scalar(made.ty);
        let value = match &made.kind {
            _ if before.is_empty() || !scalar => None,
            OperandKind::Value(value) => Some(*value),
            OperandKind::Place(place) if is_temporary(place) => {
                let path = self.path_of(place, made.range);
                let ty = self.an.scalar(made.ty);
                Some(self.add_expr(ExprKind::Load(path), ty, made.range))
            }
            OperandKind::Place(_) | OperandKind::Const(_) | OperandKind::Error => None,
        };
        let Some(value) = value else {
            self.pending.append(&mut before);
            return made;
        };
        let ty = self.code.expr(value).ty;
        let value = self.add_expr(ExprKind::After(before, value), ty, made.range);
        Operand::value(value, made.ty, made.range)
    }

    /// The next of several operands. Where it may change what those before it name, they are evaluated before it.
    pub(crate) fn next_operand<'o>(
        &mut self,
        earlier: impl IntoIterator<Item = &'o mut Operand>,
        make: impl FnOnce(&mut Self) -> Operand,
    ) -> Operand {
        let (mark, effects) = (self.pending.len(), self.effects);
        let made = make(self);
        if self.effects != effects {
            let mut behind = self.pending.split_off(mark);
            for operand in earlier {
                self.keep(operand);
            }
            self.pending.append(&mut behind);
        }
        made
    }

    /// As `next_operand`, for arguments: those behind it that are copied see what it changed.
    pub(crate) fn next_argument<'o>(
        &mut self,
        earlier: impl IntoIterator<Item = &'o mut Operand>,
        make: impl FnOnce(&mut Self) -> Operand,
    ) -> Operand {
        let effects = self.effects;
        let mut made = self.next_operand(earlier, make);
        if self.effects != effects {
            self.keep(&mut made);
        }
        made
    }

    /// Evaluates an operand now.
    fn keep(&mut self, operand: &mut Operand) {
        let changes = match &operand.kind {
            OperandKind::Value(_) => true,
            OperandKind::Place(place) => !is_temporary(place),
            OperandKind::Const(_) | OperandKind::Error => false,
        };
        if !changes || operand.is_error() || self.an.types.instance(operand.ty).is_some() {
            return;
        }
        let place = self.temporary("held", operand.ty);
        self.store(&place, operand.ty, operand, operand.range);
        operand.kind = OperandKind::Place(place);
    }
}

fn is_temporary(place: &Place) -> bool {
    place.rights == Rights::Temporary && matches!(place.root, Root::Local(_))
}
