//! `base.member`: of structures, instances, namespaces and enumerations.

use super::rights::outside_rights;
use crate::hir::code::{PathStep, Root};
use crate::st::body::property::Target;
use crate::st::body::{Body, Operand, OperandKind, Rights};
use crate::st::signature::{Def, Storage, Var};
use crate::st::types::{Parts, TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind as Written, PouKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// `base.member`.
    pub(super) fn member(
        &mut self,
        base: st::Id<st::Expr>,
        member: st::Ident,
        range: TextRange,
    ) -> Operand {
        match self.member_target(base, member, range) {
            Target::Place(operand) => operand,
            Target::Property(property) => self.read_property(property, range),
        }
    }

    /// `base.member`, of what was looked at.
    pub(crate) fn member_of(
        &mut self,
        base: Operand,
        member: st::Ident,
        range: TextRange,
    ) -> Operand {
        if base.is_error() {
            return base;
        }
        let OperandKind::Place(place) = &base.kind else {
            let message = format!("{} has no members", self.type_name(base.ty));
            return self.error(Message::E1002, member.range, message);
        };
        let (mut steps, root, rights) = (place.steps.clone(), place.root, place.rights);
        match self.an.types.parts(base.ty) {
            Parts::Members(def) => {
                let Some(&position) = def.by_name.get(&member.name) else {
                    let candidates = def.members.iter().map(|m| m.name).collect();
                    return self.no_member(base.ty, member, candidates);
                };
                let ty = def.members[position as usize].ty;
                let overlay = def.overlay.as_ref();
                match overlay.map(|o| (o.first[position as usize], o.bytes)) {
                    Some((first, bytes)) => {
                        steps.extend(self.an.shared_steps(first, bytes, ty));
                    }
                    None => steps.push(PathStep::Field(position)),
                }
                self.place_operand(root, steps, rights, ty, range)
            }
            Parts::Variables(pou) => {
                let place = place.clone();
                self.instance_member(pou, &place, member, range)
            }
            Parts::Elements { .. } | Parts::None => {
                let message = format!("{} has no members", self.type_name(base.ty));
                self.error(Message::E1002, member.range, message)
            }
        }
    }

    pub(crate) fn no_member(
        &mut self,
        ty: TypeId,
        member: st::Ident,
        candidates: Vec<Symbol>,
    ) -> Operand {
        if self.an.may_have_more_members(ty) {
            return Operand::error(member.range);
        }
        let name = self.text(member.name);
        let message = format!("{} has no member `{name}`", self.type_name(ty));
        let mut diagnostic = Diagnostic::new(Message::E1002, self.span(member.range), message);
        if let Some(close) = self.an.similar(member.name, candidates) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
        Operand::error(member.range)
    }

    /// `namespace.name` and `Enumeration.Value`; `None` if the base is something else.
    pub(crate) fn qualified(
        &mut self,
        base: st::Id<st::Expr>,
        member: st::Ident,
        range: TextRange,
    ) -> Option<Operand> {
        if let Written::Name(name) = self.arena()[base].kind
            && self.own_symbol(name)
        {
            return None;
        }
        let def = self
            .an
            .path(self.unit, self.namespace, base)?
            .first()
            .copied()?;
        match def {
            Def::Namespace(namespace) => {
                if self.an.found(self.unit, self.namespace, base).is_none() {
                    return Some(Operand::error(range));
                }
                let Some(inner) = self
                    .an
                    .found_in(self.unit, self.namespace, namespace, member)
                else {
                    return Some(Operand::error(range));
                };
                Some(match inner.first().copied() {
                    Some(Def::Global(id)) => self.global_place(id, false, range),
                    Some(Def::Pou(pou)) if self.an.pou(pou).kind == PouKind::Program => {
                        self.program(pou, range)
                    }
                    Some(def) if self.an.is_damaged(def) => Operand::error(range),
                    Some(_) => {
                        let message = format!("`{}` is no variable", self.text(member.name));
                        self.error(Message::E1012, range, message)
                    }
                    None => {
                        let message = format!("the namespace has no `{}`", self.text(member.name));
                        self.error(Message::E1012, member.range, message)
                    }
                })
            }
            Def::Type(id) => {
                let ty = self.an.declared_type(id);
                let is_enum = matches!(self.an.types.base(ty), TypeKind::Enum(_));
                if is_enum && !self.an.options.codesys && !self.an.is_library(self.unit) {
                    let what = "a value of an enumeration behind a dot";
                    self.an.foreign(self.unit, range, what);
                    return Some(Operand::error(range));
                }
                is_enum.then(|| self.enumerator_of(ty, member.name, range))
            }
            Def::Pou(_) | Def::Global(_) => None,
        }
    }

    /// A variable of an instance at a place.
    pub(crate) fn instance_variable(
        &mut self,
        root: Root,
        mut steps: Vec<PathStep>,
        var: &Var,
        outside: bool,
        range: TextRange,
    ) -> Operand {
        match &var.storage {
            Storage::Const(value) => Operand::constant(value.clone(), var.ty, range),
            Storage::Field(_) if var.edge.is_some() && !outside => {
                let name = self.text(var.name);
                let message = format!("the edge of `{name}` can be seen in the body only");
                self.error(Message::E1013, range, message)
            }
            Storage::Field(field) => {
                steps.push(PathStep::Field(*field));
                let rights = if outside {
                    outside_rights(var)
                } else {
                    self.own_rights(var)
                };
                self.place_operand(root, steps, rights, var.ty, range)
            }
            Storage::Global(id) => {
                let id = *id;
                self.global_place(id, var.constant, range)
            }
            Storage::Located(address) => {
                let rights = match address.area {
                    st::Area::Input => Rights::OwnInput,
                    st::Area::Output | st::Area::Memory => self.own_rights(var),
                };
                let address = *address;
                self.at_address(address, var.ty, rights, range)
            }
            // What is wrong with its declaration was reported there.
            Storage::Local | Storage::Ref(_) if var.ty == TypeId::ERROR => Operand::error(range),
            Storage::Local | Storage::Ref(_) => {
                let message = format!("`{}` exists only while the block runs", self.text(var.name));
                self.error(Message::E1013, range, message)
            }
        }
    }
}
