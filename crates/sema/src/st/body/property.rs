//! Properties (CODESYS): what looks like a variable is read by a call of its GET and assigned by a
//! call of its SET. Which of them runs is chosen as for other methods. What is read is a copy, so
//! nothing in it can be changed.

use super::call::Callee;
use super::{Body, Operand, OperandKind, Rights};
use crate::st::declare::Property;
use crate::st::signature::PouId;
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind as Written};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

/// What a path leads to.
pub(super) enum Target {
    Place(Operand),
    Property(PropertyOf),
}

/// A property of something.
pub(super) struct PropertyOf {
    name: st::Ident,
    property: Property,
    of: Owner,
}

/// Whose property it is.
enum Owner {
    /// That of the instance the body works on.
    This,
    /// Of what the instance extends.
    Super,
    /// Of an instance, or of what an interface stands for.
    Other(Operand),
}

#[derive(Clone, Copy)]
enum Access {
    Get,
    Set,
}

impl Body<'_, '_> {
    /// What `base.member` leads to.
    pub(super) fn member_target(
        &mut self,
        base: st::Id<st::Expr>,
        member: st::Ident,
        range: TextRange,
    ) -> Target {
        if let Some(operand) = self.qualified(base, member, range) {
            return Target::Place(operand);
        }
        let base = self.pointed_self(base);
        if matches!(self.arena()[base].kind, Written::Super)
            && let Some(property) = self.super_property(member)
        {
            return Target::Property(property);
        }
        let base = self.place(base, None);
        match self.property_in(&base, member.name) {
            Some(property) => Target::Property(PropertyOf {
                name: member,
                property,
                of: Owner::Other(base),
            }),
            None => Target::Place(self.member_of(base, member, range)),
        }
    }

    fn super_property(&self, member: st::Ident) -> Option<PropertyOf> {
        let base = self.an.base_of(self.home()?)?;
        let property = self.an.property(base, member.name)?;
        Some(PropertyOf {
            name: member,
            property,
            of: Owner::Super,
        })
    }

    /// The property of what an operand is, unless a variable has the name.
    fn property_in(&self, base: &Operand, name: Symbol) -> Option<Property> {
        let of = self.an.types.object(base.ty)?;
        if self.an.instance_var(of, name).is_some() {
            return None;
        }
        self.an.property(of, name)
    }

    /// A property named alone.
    pub(super) fn own_property(&mut self, name: Symbol, range: TextRange) -> Option<Operand> {
        let property = self.own_property_named(name, range)?;
        Some(self.read_property(property, range))
    }

    fn own_property_named(&self, name: Symbol, range: TextRange) -> Option<PropertyOf> {
        let property = self.an.property(self.home()?, name)?;
        Some(PropertyOf {
            name: st::Ident { name, range },
            property,
            of: Owner::This,
        })
    }

    /// What a path leads to that may end at a property; `None` if no property can be meant.
    fn target_with_properties(&mut self, written: st::Expr) -> Option<Target> {
        if let Written::Member { base, member } = written.kind {
            return Some(self.member_target(base, member, written.range));
        }
        let name = written
            .kind
            .name()
            .filter(|name| !self.is_variable(*name))?;
        let property = self.own_property_named(name, written.range);
        property.map(Target::Property)
    }

    /// What an assignment goes to.
    pub(super) fn assign_target(&mut self, target: st::Id<st::Expr>) -> Target {
        let written = self.arena()[target];
        match self.target_with_properties(written) {
            // A reference that is read is what it stands for.
            Some(Target::Property(property)) if self.gives_a_variable(&property) => {
                let read = self.read_property(property, written.range);
                Target::Place(read)
            }
            Some(Target::Place(place)) => Target::Place(self.as_one(place)),
            Some(Target::Property(property)) => Target::Property(property),
            None => Target::Place(self.place(target, None)),
        }
    }

    /// Whether the unit has a variable or a result with this name.
    fn is_variable(&self, name: Symbol) -> bool {
        let Some(pou) = self.pou else { return true };
        let own = self.an.pou(pou);
        let result = own.result.is_some() && own.result_name == name;
        let inherited = || {
            let home = self.home()?;
            self.an.instance_var(home, name)
        };
        own.by_name.contains_key(&name) || result || inherited().is_some()
    }

    /// Whether a property gives a reference and nothing else.
    fn gives_a_variable(&mut self, property: &PropertyOf) -> bool {
        let Property {
            get: Some(get),
            set: None,
        } = property.property
        else {
            return false;
        };
        self.an.complete(get);
        let result = self.an.pou(get).result;
        result.is_some_and(|ty| self.an.types.implicit_target(ty).is_some())
    }

    /// Reads a property.
    pub(super) fn read_property(&mut self, property: PropertyOf, range: TextRange) -> Operand {
        if self.constant_only {
            return self.error(Message::E2030, range, "a constant is needed here");
        }
        let name = property.name;
        let Some(callee) = self.accessor(property, Access::Get) else {
            return Operand::error(range);
        };
        let Callee::Method(mut target) = callee else {
            return Operand::error(name.range);
        };
        self.an.complete(target.signature);
        let presence = std::mem::take(&mut target.presence);
        let read = self.if_present(presence, None, range, |body| {
            body.finish_call(target, Vec::new(), Vec::new(), None, range)
        });
        self.as_value(read)
    }

    /// The result of a call, of which a REFERENCE stands for its target.
    pub(super) fn as_target(&mut self, result: Operand) -> Operand {
        match self.an.types.implicit_target(result.ty) {
            Some(target) if !result.is_error() => {
                let range = result.range;
                let held = self.hold(result);
                self.follow(&held, target, range)
            }
            Some(_) | None => result,
        }
    }

    /// What a GET gives: a copy, or what a REFERENCE stands for.
    fn as_value(&mut self, read: Operand) -> Operand {
        let ty = read.ty;
        let read = self.as_target(read);
        if read.ty != ty || read.is_error() {
            return read;
        }
        match read.kind {
            OperandKind::Place(mut place) => {
                place.rights = Rights::Value;
                Operand {
                    kind: OperandKind::Place(place),
                    ..read
                }
            }
            kind @ (OperandKind::Error | OperandKind::Const(_) | OperandKind::Value(_)) => {
                Operand { kind, ..read }
            }
        }
    }

    /// Assigns a property.
    pub(super) fn write_property(
        &mut self,
        property: PropertyOf,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) {
        let Some(Callee::Method(mut target)) = self.accessor(property, Access::Set) else {
            self.expr(value, None);
            return;
        };
        self.an.complete(target.signature);
        let Some(var) = self.an.pou(target.signature).vars.first().cloned() else {
            return;
        };
        let presence = std::mem::take(&mut target.presence);
        self.if_present(presence, None, range, |body| {
            let value = body.expr(value, Some(var.ty));
            body.finish_call(target, vec![(var, value)], Vec::new(), None, range)
        });
    }

    /// The accessor that runs; a message if there is none.
    fn accessor(&mut self, property: PropertyOf, access: Access) -> Option<Callee> {
        let PropertyOf { name, property, of } = property;
        let (found, word, what): (Option<PouId>, _, _) = match access {
            Access::Get => (property.get, "GET", "read"),
            Access::Set => (property.set, "SET", "assigned"),
        };
        let Some(found) = found else {
            let text = self.text(name.name);
            let message = format!("property `{text}` has no {word}, so it cannot be {what}");
            self.error(Message::E3023, name.range, message);
            return None;
        };
        let method = st::Ident {
            name: self.an.pou(found).name,
            range: name.range,
        };
        match of {
            Owner::This => self.own_method(method.name, name.range),
            Owner::Super => Some(self.super_method(method, name.range)),
            Owner::Other(operand) => self.method_callee(&operand, method),
        }
    }
}
