//! Places: names and the ways from them to members, elements, bits, and what references refer to.

mod element;
mod enumerator;
mod member;
mod name;
mod part;
mod pointer;
mod reference;
mod rights;

pub(crate) use part::{enter_bits, shared_bytes};

use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::code::{PathStep, Root};
use crate::st::signature::PouId;
use crate::st::types::{ReferenceKind, TypeId};
use iecc_ast::st::{self, ExprKind as Written, PouKind};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// A path to something, or an enumerator.
    pub(crate) fn place(&mut self, id: st::Id<st::Expr>, want: Option<TypeId>) -> Operand {
        let found = self.place_or_shared(id, want);
        self.as_one(found)
    }

    /// As `place`; it may also be an array that shares its bytes, of which only elements can be used.
    fn place_or_shared(&mut self, id: st::Id<st::Expr>, want: Option<TypeId>) -> Operand {
        let written = self.arena()[id];
        let range = written.range;
        match written.kind {
            Written::Name(name) => self.name(name, range, want),
            Written::Member { base, member } => self.member(base, member, range),
            Written::Index { base, indices } => self.index(base, indices, range),
            Written::Part { base, part } => self.part(base, part, range),
            Written::Deref(base) => self.deref(base, range),
            Written::This if self.wants_pointer(want) => {
                self.reference_to(id, ReferenceKind::Pointer, range)
            }
            Written::This => self.this(range),
            Written::Direct(_) => self.direct(id, None, range),
            Written::Super => self.error(Message::E3003, range, "SUPER stands in calls only"),
            Written::Literal(_)
            | Written::Typed { .. }
            | Written::Null
            | Written::Ref(_)
            | Written::Call { .. }
            | Written::Unary { .. }
            | Written::Binary { .. }
            | Written::ArrayValue(_)
            | Written::Repeat { .. }
            | Written::StructValue(_)
            | Written::Error => self.expr(id, want),
        }
    }

    fn not_constant(&mut self, range: TextRange) -> Operand {
        self.error(Message::E2030, range, "a constant is needed here")
    }

    pub(super) fn place_operand(
        &mut self,
        root: Root,
        steps: Vec<PathStep>,
        rights: Rights,
        ty: TypeId,
        range: TextRange,
    ) -> Operand {
        if self.constant_only {
            return self.not_constant(range);
        }
        if ty == TypeId::ERROR {
            return Operand::error(range);
        }
        let place = Place {
            root,
            steps,
            rights,
        };
        let operand = Operand {
            kind: OperandKind::Place(place),
            ty,
            range,
        };
        match self.an.types.implicit_target(ty) {
            Some(target) => self.follow(&operand, target, range),
            None => operand,
        }
    }

    /// What lies at an address.
    pub(super) fn at_address(
        &mut self,
        address: crate::st::address::Address,
        ty: TypeId,
        rights: Rights,
        range: TextRange,
    ) -> Operand {
        if self.constant_only {
            return self.not_constant(range);
        }
        match self.an.spot(address, ty) {
            Some(spot) => self.place_operand(Root::Tag(spot.tag), spot.steps, rights, ty, range),
            None => {
                let (text, name) = (address.text(), self.type_name(ty));
                let message = format!("{name} at {text}, which others overlap, is not compiled");
                self.error(Message::E2010, range, message)
            }
        }
    }

    /// A direct address, as a value of a type of its width or as bits.
    pub(super) fn direct(
        &mut self,
        id: st::Id<st::Expr>,
        want: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let Some(address) = self.an.address(self.unit, id) else {
            if self.an.is_partly(self.unit, id) {
                let message = "an address with `*` stands behind AT only";
                return self.error(Message::E3003, range, message);
            }
            return Operand::error(range);
        };
        let rights = match address.area {
            st::Area::Input => Rights::OwnInput,
            st::Area::Output | st::Area::Memory => Rights::All,
        };
        let ty = want.unwrap_or(address.plain_type());
        self.at_address(address, ty, rights, range)
    }

    /// `base^`.
    fn deref(&mut self, base: st::Id<st::Expr>, range: TextRange) -> Operand {
        if self.an.options.codesys && self.arena()[base].kind == Written::This {
            return self.this(range);
        }
        let base = self.place(base, None);
        if base.is_error() {
            return base;
        }
        match self.an.types.target(base.ty) {
            Some(target) => self.follow(&base, target, range),
            None => {
                let message = format!("{} is no reference", self.type_name(base.ty));
                self.error(Message::E2034, range, message)
            }
        }
    }

    /// What a reference stands for.
    pub(super) fn follow(
        &mut self,
        reference: &Operand,
        target: TypeId,
        range: TextRange,
    ) -> Operand {
        if let Some(pou) = self.an.types.instance(target) {
            self.an.complete(pou);
        }
        let address = self.raw(reference);
        if let OperandKind::Place(place) = &reference.kind {
            self.followed.insert(address, place.clone());
        }
        let ty = self.an.storage(target);
        let root = Root::Deref {
            address,
            ty,
            checked: false,
        };
        self.place_operand(root, Vec::new(), Rights::All, target, range)
    }

    /// Whether a unit is one that a path can call as a function.
    pub(super) fn is_function(&self, pou: PouId) -> bool {
        self.an.pou(pou).kind == PouKind::Function
    }
}
