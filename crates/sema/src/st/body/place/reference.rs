//! References to variables and instances: what has one, what one may become, `?=`, copies.

use crate::hir::code::{ExprId, ExprKind, PathStep, Root, StmtId, StmtKind};
use crate::hir::{self, Elementary, Type};
use crate::st::body::place::shared_bytes;
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::objects::InstancePart;
use crate::st::signature::{PouId, Storage};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, SectionKind};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// Why nothing may refer to a place, if so.
    pub(crate) fn no_reference(&self, place: &Place) -> Option<String> {
        if let Some(what) = shared_bytes(place) {
            return Some(format!("{what} has no reference"));
        }
        if place.rights == Rights::Value {
            let copy = "the value of a property is a copy, which nothing can refer to";
            return Some(copy.to_owned());
        }
        if place.rights == Rights::Constant {
            return Some("a constant has no reference".to_owned());
        }
        let temporary = match place.root {
            Root::Local(_) => true,
            Root::Ref(reference) => self.is_passed_copy(reference),
            Root::Tag(_) | Root::Deref { .. } => false,
        };
        let gone = "this variable is gone when the call ends, so nothing can refer to it";
        temporary.then(|| gone.to_owned())
    }

    /// Whether a reference parameter stands for a copy: an input, an output, the result.
    fn is_passed_copy(&self, reference: u32) -> bool {
        if self.home().is_some() && reference == 0 {
            return false;
        }
        let Some(pou) = self.pou else { return false };
        let mut vars = self.an.pou(pou).vars.iter();
        let var = vars.find(|var| var.storage == Storage::Ref(reference));
        var.is_none_or(|var| var.section != SectionKind::InOut)
    }

    /// The place of an instance as one of a type that it extends.
    pub(crate) fn as_base(&self, place: &Place, from: TypeId, to: TypeId) -> Option<Place> {
        let types = &self.an.types;
        let (TypeKind::Instance(from), TypeKind::Instance(to)) = (types.base(from), types.base(to))
        else {
            return None;
        };
        let distance = self.an.base_distance(*from, *to)?;
        let mut place = place.clone();
        let steps = std::iter::repeat_n(PathStep::Field(0), distance);
        place.steps.extend(steps);
        Some(place)
    }

    /// Whether what a reference to one type stands for may be looked at as the other.
    pub(crate) fn refers_alike(&self, from: TypeId, to: TypeId) -> bool {
        let types = &self.an.types;
        if let (TypeKind::Instance(from), TypeKind::Instance(to)) =
            (types.base(from), types.base(to))
        {
            return self.an.conforms(*from, *to);
        }
        types.strip(from) == types.strip(to)
    }

    /// An instance or interface as an interface.
    pub(crate) fn interface_value(
        &mut self,
        operand: &Operand,
        interface: PouId,
    ) -> Option<ExprId> {
        let (TypeKind::Interface(from) | TypeKind::Instance(from)) =
            *self.an.types.base(operand.ty)
        else {
            return None;
        };
        if !self.an.conforms(from, interface) {
            return None;
        }
        if !self.an.pou(from).has_instances() {
            return Some(self.raw(operand));
        }
        let OperandKind::Place(place) = &operand.kind else {
            return None;
        };
        let place = place.clone();
        let path = self.path_of(&place, operand.range);
        Some(self.add_expr(ExprKind::Address(path), Elementary::Ulint, operand.range))
    }

    /// What an attempt may turn into something else: an interface, or a reference to an instance.
    fn attempted(&self, ty: TypeId) -> Option<PouId> {
        if let TypeKind::Interface(pou) = *self.an.types.base(ty) {
            return Some(pou);
        }
        self.an.types.instance(self.an.types.target(ty)?)
    }

    /// `target ?= value`.
    pub(crate) fn attempt(
        &mut self,
        target: st::Id<st::Expr>,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) {
        let place = self.place(target, None);
        let want = (!place.is_error()).then_some(place.ty);
        let value = self.expr(value, want);
        let Some(to) = self.writable(&place) else {
            return;
        };
        if value.is_error() {
            return;
        }
        let simple = value.ty == TypeId::NULL
            || self.an.types.strip(value.ty) == self.an.types.strip(place.ty);
        let (into, from) = (self.attempted(place.ty), self.attempted(value.ty));
        match (into, from) {
            (Some(into), Some(from)) if !self.an.conforms(from, into) => {
                self.checked_attempt(&to, into, from, &value, range);
            }
            (Some(_), Some(_)) => {
                // Both are one address, and it always fits.
                let value = self.raw(&value);
                let path = self.path_of(&to, range);
                self.before(StmtKind::Assign(path, value), range);
            }
            _ if simple && matches!(self.an.types.base(place.ty), TypeKind::Reference(..)) => {
                self.store(&to, place.ty, &value, range);
            }
            (Some(_), None) if simple => self.store(&to, place.ty, &value, range),
            _ => {
                let message = format!(
                    "?= is between interfaces and references to instances, not from {} to {}",
                    self.type_name(value.ty),
                    self.type_name(place.ty)
                );
                self.error(Message::E2035, range, message);
            }
        }
    }

    /// Keeps the address if the type of the instance fits, else NULL.
    fn checked_attempt(
        &mut self,
        to: &Place,
        into: PouId,
        from: PouId,
        value: &Operand,
        range: TextRange,
    ) {
        let fitting: Vec<PouId> = self.an.concrete_types(into);
        let fitting: Vec<PouId> = fitting
            .into_iter()
            .filter(|ty| self.an.conforms(*ty, from))
            .collect();
        if fitting.is_empty() || !self.may_be_numbered(from) {
            let message = format!(
                "nothing is both a {} and a {}, so this always gives NULL",
                self.text(self.an.pou(from).name),
                self.text(self.an.pou(into).name)
            );
            self.error(Message::E2036, range, message);
            return;
        }
        let mut numbers: Vec<u32> = fitting.iter().map(|ty| self.an.type_number(*ty)).collect();
        numbers.sort_unstable();
        let ty = self.an.types.strip(value.ty);
        let held = self.temporary("attempt", ty);
        let address = self.raw(value);
        let path = self.path_of(&held, range);
        self.before(StmtKind::Assign(path, address), range);
        let keep = self.store_held(to, Some(&held), range);
        let drop = self.store_held(to, None, range);
        let selector = self.number_of(&held, range);
        let ranges = numbers.iter().map(|n| (u64::from(*n), u64::from(*n)));
        let kind = StmtKind::Case {
            selector,
            arms: vec![(ranges.collect(), vec![keep])],
            otherwise: vec![drop],
        };
        self.before(kind, range);
    }

    fn may_be_numbered(&self, pou: PouId) -> bool {
        !self.an.pou(pou).has_instances() || self.an.is_numbered(pou)
    }

    fn store_held(&mut self, to: &Place, held: Option<&Place>, range: TextRange) -> StmtId {
        let value = match held {
            Some(held) => self.load_held(held, range),
            None => self.add_const(0, Elementary::Ulint, range),
        };
        let path = self.path_of(to, range);
        self.add_stmt(StmtKind::Assign(path, value), range)
    }

    fn load_held(&mut self, held: &Place, range: TextRange) -> ExprId {
        let path = self.path_of(held, range);
        self.add_expr(ExprKind::Load(path), Elementary::Ulint, range)
    }

    /// The type number of the instance at an address, 0 for NULL.
    fn number_of(&mut self, held: &Place, range: TextRange) -> ExprId {
        let (value, address) = (self.load_held(held, range), self.load_held(held, range));
        let none = self.add_const(0, Elementary::Ulint, range);
        let compare = ExprKind::Compare(hir::CompareOp::NotEqual, value, none);
        let there = self.add_expr(compare, Elementary::Bool, range);
        let root = Root::Deref {
            address,
            ty: Type::Elementary(Elementary::Udint),
            checked: true,
        };
        let path = self.add_path(root, Vec::new(), range);
        let number = self.add_expr(ExprKind::Load(path), Elementary::Udint, range);
        let zero = self.add_const(0, Elementary::Udint, range);
        let kind = ExprKind::Choose(there, number, zero);
        self.add_expr(kind, Elementary::Udint, range)
    }

    /// Copies an instance, but never what says of which type it is and whether it is a mock.
    pub(crate) fn copy_instance(&mut self, pou: PouId, to: &Place, from: &Place, range: TextRange) {
        if !self.an.is_numbered(pou) && !self.an.testing.mocks {
            let (to, from) = (self.path_of(to, range), self.path_of(from, range));
            self.before(StmtKind::Copy(to, from), range);
            return;
        }
        for (position, part) in (0..).zip(self.an.instance_parts(pou)) {
            let step = |place: &Place| {
                let mut place = place.clone();
                place.steps.push(PathStep::Field(position));
                place
            };
            let (to, from) = (step(to), step(from));
            match part {
                InstancePart::TypeNumber | InstancePart::Mock => {}
                InstancePart::Base(base) => self.copy_instance(base, &to, &from, range),
                InstancePart::Var(index) => {
                    let ty = self.an.pou(pou).vars[index].ty;
                    self.copy_field(ty, &to, &from, range);
                }
                InstancePart::Edge(_) => self.copy_field(TypeId::BOOL, &to, &from, range),
            }
        }
    }

    fn copy_field(&mut self, ty: TypeId, to: &Place, from: &Place, range: TextRange) {
        let (to, from) = (self.path_of(to, range), self.path_of(from, range));
        let kind = if self.an.types.is_scalar(ty) {
            let scalar = self.an.scalar(ty);
            StmtKind::Assign(to, self.add_expr(ExprKind::Load(from), scalar, range))
        } else {
            StmtKind::Copy(to, from)
        };
        self.before(kind, range);
    }
}
