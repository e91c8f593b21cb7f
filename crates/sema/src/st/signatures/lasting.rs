//! What outlasts a call (CODESYS): variables of VAR_STAT, one for all instances and calls, are global
//! variables that only their unit sees; those of VAR_INST in a method are variables of the instance
//! that only the method sees.

use crate::st::analysis::Analysis;
use crate::st::resolve::TypeScope;
use crate::st::signature::{Global, GlobalId, Initial, Part, PouId, State, Storage, UnitId, Var};
use crate::st::types::TypeId;
use iecc_ast::Symbol;
use iecc_ast::st::{
    self, Declarations, Member, ModifierKind, SectionKind, UnitKind, VarDecl, VarSection,
};
use iecc_source::TextRange;

impl Analysis<'_> {
    /// Declares the variables of VAR_STAT; `path` is what they belong to.
    pub(crate) fn declare_statics(
        &mut self,
        unit: UnitId,
        sections: st::List<VarSection>,
        path: String,
    ) {
        let arena = &self.unit(unit).arena;
        for section in &arena[sections] {
            let (SectionKind::Static, Declarations::Variables(variables)) =
                (section.kind, section.declarations)
            else {
                continue;
            };
            let modifiers = &arena[section.modifiers];
            let constant = modifiers.iter().any(|m| m.kind == ModifierKind::Constant);
            for decl in &arena[variables] {
                for ident in &arena[decl.names] {
                    let id = GlobalId(self.globals.len() as u32);
                    self.statics.insert((unit, ident.range), id);
                    self.globals.push(Global {
                        name: ident.name,
                        path: Some(format!("{path}.{}", self.text(ident.name))),
                        list: None,
                        qualified: false,
                        ty: TypeId::ERROR,
                        constant,
                        initial: decl.initial.map(|expr| Initial { unit, expr }),
                        span: self.span(unit, ident.range),
                        value: None,
                        spot: None,
                        unit,
                        decl: *decl,
                        state: State::Declared,
                    });
                }
            }
        }
    }

    /// A variable of VAR_STAT, seen in its unit.
    pub(crate) fn own_static(&mut self, unit: UnitId, var: &mut Var) {
        let Some(&global) = self.statics.get(&(unit, var.range)) else {
            var.ty = TypeId::ERROR;
            return;
        };
        self.complete_global(global);
        var.ty = self.global(global).ty;
        var.storage = Storage::Global(global);
    }

    /// Gives a block the variables that its methods keep in it.
    pub(crate) fn keep_for_methods(&mut self, id: PouId) {
        for (name, method) in self.pou(id).members.clone() {
            let Some(sections) = self.sections_of_member(method) else {
                continue;
            };
            let unit = self.pou(id).unit;
            for section in &self.unit(unit).arena[sections] {
                if let (SectionKind::Instance, Declarations::Variables(variables)) =
                    (section.kind, section.declarations)
                {
                    for decl in &self.unit(unit).arena[variables] {
                        self.keep(id, name, decl);
                    }
                }
            }
        }
    }

    fn keep(&mut self, id: PouId, method: Symbol, decl: &VarDecl) {
        let unit = self.pou(id).unit;
        let scope = self.pou_scope(id);
        let ty = self.kept_type(scope.as_scope(), decl);
        for ident in &self.unit(unit).arena[decl.names] {
            let mut var = Var {
                name: self.hidden_name(method, self.text(ident.name)),
                range: ident.range,
                section: SectionKind::Var,
                ty,
                initial: decl.initial.map(|expr| Initial { unit, expr }),
                constant: false,
                edge: None,
                access: Some(ModifierKind::Private),
                storage: Storage::Local,
                partly: None,
            };
            var.ty = self.check_instance(id, SectionKind::Var, &var);
            let pou = &mut self.pous[id.index()];
            let position = pou.vars.len() as u32;
            pou.by_name.entry(var.name).or_insert(position);
            pou.vars.push(var);
        }
    }

    fn kept_type(&mut self, scope: TypeScope<'_>, decl: &VarDecl) -> TypeId {
        let unit = self.unit(scope.unit);
        let ty = self.type_of_spec(scope, decl.ty);
        self.complete_contained(ty, unit.span(unit.arena[decl.ty].range))
    }

    /// A variable of VAR_INST, seen in its method.
    pub(crate) fn own_kept(&mut self, id: PouId, var: &mut Var) {
        let method = self.pou(id);
        let kept = method.owner.and_then(|owner| {
            let name = self.hidden_name(method.name, self.text(var.name));
            self.pou(owner).var(name)
        });
        let (ty, storage) = kept.map_or((TypeId::ERROR, Storage::Local), |kept| {
            (kept.ty, kept.storage.clone())
        });
        (var.ty, var.storage) = (ty, storage);
    }

    fn sections_of_member(&self, member: PouId) -> Option<st::List<VarSection>> {
        let pou = self.pou(member);
        let unit = self.unit(pou.unit);
        let UnitKind::Pou(whole) = &unit.kind else {
            return None;
        };
        let written = |index: u32| &unit.arena[whole.members][index as usize];
        match (pou.part, pou.part_index().map(written)?) {
            (Part::Member(_), Member::Method(method)) => Some(method.sections),
            (Part::Getter(_), Member::Property(property)) => property.get.map(|get| get.sections),
            (Part::Setter(_), Member::Property(property)) => property.set.map(|set| set.sections),
            _ => None,
        }
    }

    /// The value that a SET gets is a variable with the name of the property.
    pub(crate) fn value_of_setter(&mut self, id: PouId) {
        let pou = self.pou(id);
        let (Part::Setter(index), unit) = (pou.part, pou.unit) else {
            return;
        };
        let UnitKind::Pou(whole) = &self.unit(unit).kind else {
            return;
        };
        let Member::Property(property) = self.unit(unit).arena[whole.members][index as usize]
        else {
            return;
        };
        let scope = self.pou_scope(id);
        let ty = self.type_of_spec(scope.as_scope(), property.ty);
        let var = Var {
            name: property.name.name,
            range: property.name.range,
            section: SectionKind::Input,
            ty,
            initial: None,
            constant: false,
            edge: None,
            access: None,
            storage: Storage::Local,
            partly: None,
        };
        let pou = &mut self.pous[id.index()];
        pou.by_name.insert(var.name, 0);
        pou.vars.push(var);
    }

    /// Reports a property that has the name of something else in its unit.
    pub(crate) fn check_properties(&mut self, id: PouId) {
        let mut named: Vec<(Symbol, TextRange)> = Vec::new();
        let unit = self.pou(id).unit;
        let UnitKind::Pou(written) = &self.unit(unit).kind else {
            return;
        };
        for member in &self.unit(unit).arena[written.members] {
            if let Member::Property(property) = member {
                named.push((property.name.name, property.name.range));
            }
        }
        for (name, range) in named {
            let (pou, span) = (self.pou(id), self.span(unit, range));
            let var = pou.var(name).map(|var| self.span(unit, var.range));
            let mut members = pou.members.iter();
            let method = members.find(|(known, _)| *known == name);
            let method = method.map(|(_, method)| self.pou(*method).span);
            if let Some(other) = var.or(method) {
                self.declared_twice(name, span, other);
            }
        }
    }
}
