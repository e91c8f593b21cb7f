//! Addresses of variables: `REF(x)`, and of CODESYS `ADR(x)`, `r REF= x` and `__ISVALIDREF(r)`.
//!
//! A REFERENCE stands for its target wherever it is named, so what is known of it is kept beside the
//! address that was read from it. Pointers refer to what their types say; nothing is computed with them.

use crate::hir::code::{ExprId, ExprKind, Root, StmtKind};
use crate::hir::{self, Elementary};
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::constant::Const;
use crate::st::types::{ReferenceKind, TypeId, TypeKind};
use iecc_ast::st::{self, BinaryOp};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// `REF(operand)`, `ADR(operand)`.
    pub(crate) fn reference_to(
        &mut self,
        operand: st::Id<st::Expr>,
        kind: ReferenceKind,
        range: TextRange,
    ) -> Operand {
        let target = self.expr(operand, None);
        match self.address_of(&target) {
            Some(value) => {
                let ty = TypeKind::Reference(kind, target.ty);
                let ty = self.an.types.intern(ty);
                Operand::value(value, ty, range)
            }
            None => Operand::error(range),
        }
    }

    /// The address of a variable; a message if it has none.
    pub(crate) fn address_of(&mut self, target: &Operand) -> Option<ExprId> {
        if target.is_error() {
            return None;
        }
        let OperandKind::Place(place) = &target.kind else {
            let why = "only a variable has a reference";
            self.error(Message::E3002, target.range, why);
            return None;
        };
        if let Some(why) = self.no_reference(place) {
            self.error(Message::E3002, target.range, why);
            return None;
        }
        let place = place.clone();
        Some(self.address_at(&place, target.range))
    }

    fn address_at(&mut self, place: &Place, range: TextRange) -> ExprId {
        // What a reference stands for is where it points, also if that is nowhere.
        if let (Root::Deref { address, .. }, []) = (place.root, &place.steps[..])
            && self.an.options.codesys
        {
            return address;
        }
        let path = self.path_of(place, range);
        self.add_expr(ExprKind::Address(path), Elementary::Ulint, range)
    }

    /// A variable for a REFERENCE that is passed; `None` if the types do not fit.
    pub(crate) fn passed_reference(&mut self, operand: &Operand, target: TypeId) -> Option<ExprId> {
        if !self.refers_alike(operand.ty, target) {
            return None;
        }
        Some(match self.address_of(operand) {
            Some(address) => address,
            None => self.add_const(0, Elementary::Ulint, operand.range),
        })
    }

    /// The place of the REFERENCE that an operand was read through, and its target type.
    fn behind(&self, operand: &Operand) -> Option<(Place, TypeId)> {
        let OperandKind::Place(place) = &operand.kind else {
            return None;
        };
        let (Root::Deref { address, .. }, []) = (place.root, &place.steps[..]) else {
            return None;
        };
        let reference = self.followed.get(&address)?;
        Some((reference.clone(), operand.ty))
    }

    /// `target REF= value`.
    pub(crate) fn rebind(
        &mut self,
        target: st::Id<st::Expr>,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) {
        let read = self.place(target, None);
        let value = self.expr(value, None);
        if read.is_error() {
            return;
        }
        let variable = self.behind(&read);
        let variable = variable.filter(|(place, _)| place.rights != Rights::Temporary);
        let Some((place, ty)) = variable else {
            let name = self.type_name(read.ty);
            let message = format!("`REF=` is for a REFERENCE, not {name}");
            self.error(Message::E2034, read.range, message);
            return;
        };
        let reference = Operand {
            kind: OperandKind::Place(place),
            ..read
        };
        let Some(place) = self.writable(&reference) else {
            return;
        };
        if value.is_error() {
            return;
        }
        let none = matches!(value.as_const(), Some(Const::Null | Const::Int(0)));
        let address = if none {
            Some(self.add_const(0, Elementary::Ulint, range))
        } else if self.refers_alike(value.ty, ty) {
            self.address_of(&value)
        } else {
            self.mismatch(&value, ty);
            None
        };
        if let Some(address) = address {
            let path = self.path_of(&place, range);
            self.before(StmtKind::Assign(path, address), range);
        }
    }

    /// `__ISVALIDREF(r)`.
    pub(crate) fn is_valid_reference(
        &mut self,
        operand: st::Id<st::Expr>,
        range: TextRange,
    ) -> Operand {
        let read = self.place(operand, None);
        if read.is_error() {
            return Operand::error(range);
        }
        if self.behind(&read).is_none() {
            let name = self.type_name(read.ty);
            let message = format!("__ISVALIDREF takes a REFERENCE, not {name}");
            return self.error(Message::E2034, read.range, message);
        }
        let OperandKind::Place(Place {
            root: Root::Deref { address, .. },
            ..
        }) = read.kind
        else {
            unreachable!("read through a reference")
        };
        let none = self.add_const(0, Elementary::Ulint, range);
        let kind = ExprKind::Compare(hir::CompareOp::NotEqual, address, none);
        let value = self.add_expr(kind, Elementary::Bool, range);
        Operand::value(value, TypeId::BOOL, range)
    }

    /// Whether THIS is the address of the instance: in CODESYS it is a pointer, where one is needed.
    pub(super) fn wants_pointer(&self, want: Option<TypeId>) -> bool {
        let pointer = |ty| {
            let kind = self.an.types.base(ty);
            matches!(kind, TypeKind::Reference(ReferenceKind::Pointer, _))
        };
        self.an.options.codesys && want.is_some_and(pointer)
    }

    /// `p = 0`: a pointer or interface that stands for nothing (CODESYS).
    pub(crate) fn zero_as_null(&self, left: Operand, right: Operand) -> (Operand, Operand) {
        let zero = |operand: &Operand| {
            operand.ty == TypeId::UNTYPED_INT && operand.as_const() == Some(&Const::Int(0))
        };
        let null = |operand: &Operand| Operand::constant(Const::Null, TypeId::NULL, operand.range);
        if !self.an.options.codesys {
            return (left, right);
        }
        if zero(&right) && self.an.is_address(left.ty) {
            let right = null(&right);
            return (left, right);
        }
        if zero(&left) && self.an.is_address(right.ty) {
            let left = null(&left);
            return (left, right);
        }
        (left, right)
    }

    /// Refuses sums and the like of pointers.
    pub(crate) fn pointer_arithmetic(
        &mut self,
        op: BinaryOp,
        left: &Operand,
        right: &Operand,
        range: TextRange,
    ) -> bool {
        let is_pointer = |operand: &Operand| {
            let kind = self.an.types.base(operand.ty);
            matches!(kind, TypeKind::Reference(..))
        };
        let found = self.an.options.codesys && (is_pointer(left) || is_pointer(right));
        if found {
            self.no_arithmetic(&format!("`{}` computes with a pointer", op.as_str()), range);
        }
        found
    }

    /// Says that nothing is computed with pointers.
    pub(crate) fn no_arithmetic(&mut self, what: &str, range: TextRange) {
        let message = format!("{what}, which is not compiled");
        let why = "a pointer stands for one variable: where others lie beside it differs from target to target";
        let note = "let it point to the whole array, and use a subscript: p^[i]";
        let diagnostic = Diagnostic::new(Message::E2037, self.span(range), message);
        self.report(diagnostic.note(why).note(note));
    }
}
