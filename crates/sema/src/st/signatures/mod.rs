//! Resolves signatures: the variables of a unit, where they live, and how it is called.

mod contained;
mod globals;
mod lasting;
mod shape;

pub(crate) use shape::CallShape;

use super::analysis::{Analysis, MAX_RESOLUTION_DEPTH};
use super::resolve::TypeScope;
use super::signature::{Initial, Part, PouId, State, Storage, Var};
use super::types::TypeId;
use iecc_ast::st::{self, Declarations, Member, ModifierKind, PouKind, SectionKind, UnitKind};
use iecc_diag::Code;

/// The interface of a unit as it is written.
#[derive(Clone, Copy)]
struct WrittenPou {
    sections: st::List<st::VarSection>,
    result: Option<st::Id<st::TypeSpec>>,
    kind: PouKind,
}

impl Analysis<'_> {
    /// Completes the signature of a unit. An instance that contains itself is reported where it is
    /// declared.
    pub(crate) fn complete(&mut self, id: PouId) {
        if self.pou(id).state != State::Declared {
            return;
        }
        self.pous[id.index()].state = State::InProgress;
        if let Some(owner) = self.pou(id).owner {
            self.complete(owner);
        }
        if let Some(base) = self
            .base_of(id)
            .filter(|_| self.pou(id).part == Part::Whole)
        {
            self.complete(base);
            self.inherit_in_outs(id, base);
        }
        self.value_of_setter(id);
        if let Some(written) = self.written_pou(id) {
            let scope = self.pou_scope(id);
            let scope = scope.as_scope();
            let result = written.result.map(|ty| self.type_of_spec(scope, ty));
            self.pous[id.index()].result = result;
            let sections = &self.unit(scope.unit).arena[written.sections];
            for section in sections {
                self.section(id, written.kind, section);
            }
        }
        if self.pou(id).has_instances() {
            self.keep_for_methods(id);
        }
        self.place_vars(id);
        self.pous[id.index()].state = State::Done;
    }

    /// Where the types of a unit are looked up.
    pub(crate) fn pou_scope(&self, id: PouId) -> OwnedScope {
        let pou = self.pou(id);
        OwnedScope {
            unit: pou.unit,
            namespace: pou.namespace,
            bindings: pou.bindings.clone(),
            pou: id,
        }
    }

    fn written_pou(&self, id: PouId) -> Option<WrittenPou> {
        let pou = self.pou(id);
        let unit = self.unit(pou.unit);
        let whole = match &unit.kind {
            UnitKind::Pou(whole) => whole,
            UnitKind::Test(test) => {
                return Some(WrittenPou {
                    sections: test.sections,
                    result: None,
                    kind: pou.kind,
                });
            }
            UnitKind::Types { .. }
            | UnitKind::Configuration(_)
            | UnitKind::Globals(_)
            | UnitKind::Using(_)
            | UnitKind::Nothing
            | UnitKind::Error => return None,
        };
        let member = |index: u32| &unit.arena[whole.members][index as usize];
        let function = PouKind::Function;
        match pou.part {
            Part::Whole => Some(WrittenPou {
                sections: whole.sections,
                result: whole.result,
                kind: whole.kind,
            }),
            Part::Member(index) => match member(index) {
                Member::Method(method) => Some(WrittenPou {
                    sections: method.sections,
                    result: method.result,
                    kind: function,
                }),
                Member::Action(_) | Member::Property(_) => None,
            },
            Part::Getter(index) | Part::Setter(index) => match member(index) {
                Member::Property(property) => {
                    let (accessor, result) = match pou.part {
                        Part::Getter(_) => (property.get, Some(property.ty)),
                        Part::Whole | Part::Member(_) | Part::Setter(_) => (property.set, None),
                    };
                    accessor.map(|accessor| WrittenPou {
                        sections: accessor.sections,
                        result,
                        kind: function,
                    })
                }
                Member::Method(_) | Member::Action(_) => None,
            },
        }
    }

    fn section(&mut self, id: PouId, kind: PouKind, section: &st::VarSection) {
        let unit_id = self.pou(id).unit;
        let unit = self.unit(unit_id);
        let modifiers = &unit.arena[section.modifiers];
        let constant = modifiers.iter().any(|m| m.kind == ModifierKind::Constant);
        let access = modifiers.iter().map(|m| m.kind).find(|kind| {
            matches!(
                kind,
                ModifierKind::Public
                    | ModifierKind::Protected
                    | ModifierKind::Private
                    | ModifierKind::Internal
            )
        });
        self.allowed_section(id, kind, section);
        let Declarations::Variables(variables) = section.declarations else {
            return;
        };
        self.modifiers_go_together(unit_id, Some(kind), section);
        // Their types are those of what keeps them.
        if matches!(section.kind, SectionKind::Static | SectionKind::Instance) {
            self.kept_section(id, variables, section.kind, constant);
            return;
        }
        for decl in &unit.arena[variables] {
            if !self.ahead.contains(&(id, decl.range)) {
                self.variable(id, kind, section.kind, constant, access, decl);
            }
        }
    }

    /// Looks at a constant of a unit before its turn, because something names it that stands before it.
    pub(crate) fn constant_ahead(&mut self, id: PouId, name: iecc_ast::Symbol) {
        if self.pou(id).state != State::InProgress || self.depth >= MAX_RESOLUTION_DEPTH {
            return;
        }
        let Some(written) = self.written_pou(id) else {
            return;
        };
        let arena = &self.unit(self.pou(id).unit).arena;
        for section in &arena[written.sections] {
            let mut modifiers = arena[section.modifiers].iter();
            let constant = modifiers.any(|m| m.kind == ModifierKind::Constant);
            let (SectionKind::Var, true, Declarations::Variables(variables)) =
                (section.kind, constant, section.declarations)
            else {
                continue;
            };
            let named = |decl: &&st::VarDecl| arena[decl.names].iter().any(|one| one.name == name);
            let Some(decl) = arena[variables].iter().find(named) else {
                continue;
            };
            if self.ahead.insert((id, decl.range)) {
                self.depth += 1;
                self.variable(id, written.kind, section.kind, constant, None, decl);
                self.depth -= 1;
            }
            return;
        }
    }

    /// The variables of one declaration.
    fn variable(
        &mut self,
        id: PouId,
        kind: PouKind,
        section: SectionKind,
        constant: bool,
        access: Option<ModifierKind>,
        decl: &st::VarDecl,
    ) {
        let unit_id = self.pou(id).unit;
        let unit = self.unit(unit_id);
        let owned = self.pou_scope(id);
        let names = &unit.arena[decl.names];
        // Each name has the type of its own argument.
        let bound = |ident: &st::Ident| owned.open_type(ident.name);
        let mut declared = match names.iter().all(|ident| bound(ident).is_some()) {
            true => TypeId::ERROR,
            false => self.variable_type(owned.as_scope(), decl),
        };
        if decl.edge.is_some() && !self.edge_fits(unit_id, kind, section, decl, declared) {
            declared = TypeId::ERROR;
        }
        for ident in names {
            let ty = bound(ident).unwrap_or(declared);
            let fits = !decl.bound || super::declare::is_reference(unit, decl);
            let initial = decl.initial.filter(|_| fits).map(|expr| Initial {
                unit: unit_id,
                expr,
            });
            let mut var = Var {
                name: ident.name,
                range: ident.range,
                section,
                ty,
                initial,
                constant,
                edge: decl.edge,
                access,
                storage: Storage::Local,
                partly: None,
            };
            if let Some(location) = decl.location
                && section != SectionKind::Global
            {
                self.located(id, kind, &mut var, location);
            }
            var.ty = self.check_instance(id, section, &var);
            if section == SectionKind::Global {
                self.own_global(id, &mut var);
            } else if section == SectionKind::External {
                self.external(id, &mut var);
            } else if constant && section.direction().is_none() {
                self.fold_constant(id, &mut var);
            }
            self.check_place_of_instance(id, &var);
            self.add_var(id, var);
        }
    }

    /// Variables of VAR_STAT and VAR_INST.
    fn kept_section(
        &mut self,
        id: PouId,
        variables: st::List<st::VarDecl>,
        section: SectionKind,
        constant: bool,
    ) {
        let unit = self.pou(id).unit;
        let arena = &self.unit(unit).arena;
        for ident in arena[variables].iter().flat_map(|decl| &arena[decl.names]) {
            let mut var = Var {
                name: ident.name,
                range: ident.range,
                section,
                ty: TypeId::ERROR,
                initial: None,
                constant,
                edge: None,
                access: None,
                storage: Storage::Local,
                partly: None,
            };
            if section == SectionKind::Static {
                self.own_static(unit, &mut var);
            } else {
                self.own_kept(id, &mut var);
            }
            self.add_var(id, var);
        }
    }

    /// Whether an input may have R_EDGE or F_EDGE.
    fn edge_fits(
        &mut self,
        unit: super::signature::UnitId,
        kind: PouKind,
        section: SectionKind,
        decl: &st::VarDecl,
        ty: TypeId,
    ) -> bool {
        if ty == TypeId::ERROR {
            return true;
        }
        let span = self.span(unit, decl.range);
        let owner = matches!(kind, PouKind::FunctionBlock | PouKind::Program);
        if section != SectionKind::Input || !owner {
            let message = "R_EDGE and F_EDGE stand in VAR_INPUT of blocks and programs only";
            self.error(Code::E1011, span, message);
            return false;
        }
        if self.types.strip(ty) != TypeId::BOOL {
            let message = format!("an edge is one of a BOOL, not of {}", self.type_name(ty));
            self.error(Code::E2022, span, message);
            return false;
        }
        true
    }

    fn allowed_section(&mut self, id: PouId, kind: PouKind, section: &st::VarSection) {
        use SectionKind as S;
        let (unit, in_method) = (self.pou(id).unit, self.pou(id).owner.is_some());
        let allowed = match (kind, section.kind) {
            (PouKind::Interface, _) => false,
            (PouKind::Class, kind) => matches!(kind, S::Var | S::External),
            (_, S::Var | S::Temp | S::Input | S::Output | S::InOut | S::External) => true,
            (_, S::Static) => true,
            (_, S::Instance) => in_method,
            (PouKind::Program, S::Global | S::Access) => true,
            (_, S::Global | S::Access | S::Config) => false,
        };
        let test = match &self.unit(unit).kind {
            UnitKind::Test(test) => Some(test.kind.as_str()),
            UnitKind::Types { .. }
            | UnitKind::Pou(_)
            | UnitKind::Configuration(_)
            | UnitKind::Globals(_)
            | UnitKind::Using(_)
            | UnitKind::Nothing
            | UnitKind::Error => None,
        };
        let passed = matches!(section.kind, S::Input | S::Output | S::InOut);
        if !allowed || test.is_some() && passed {
            let span = self.span(unit, section.range);
            let message = format!(
                "{} cannot stand in a {}",
                section.kind.as_str(),
                test.unwrap_or(kind.as_str())
            );
            self.error(Code::E1011, span, message);
        }
    }

    fn variable_type(&mut self, scope: TypeScope<'_>, decl: &st::VarDecl) -> TypeId {
        let unit = self.unit(scope.unit);
        let ty = self.type_of_spec(scope, decl.ty);
        self.complete_contained(ty, unit.span(unit.arena[decl.ty].range))
    }

    fn fold_constant(&mut self, id: PouId, var: &mut Var) {
        if !self.types.is_scalar(var.ty) || var.ty == TypeId::ERROR {
            return;
        }
        let owned = self.pou_scope(id);
        let value = match var.initial {
            Some(initial) => self.constant(owned.as_scope(), initial.expr, var.ty),
            None => Some(self.default_const(var.ty)),
        };
        match value {
            Some(value) => var.storage = Storage::Const(value),
            None => var.ty = TypeId::ERROR,
        }
    }

    fn add_var(&mut self, id: PouId, var: Var) {
        let unit = self.pou(id).unit;
        let span = self.span(unit, var.range);
        if let Some(first) = self.pou(id).var(var.name) {
            let first = self.span(unit, first.range);
            // The names of a damaged declaration are guessed.
            if var.ty != TypeId::ERROR {
                self.declared_twice(var.name, span, first);
            }
            return;
        }
        let pou = &mut self.pous[id.index()];
        pou.by_name.insert(var.name, pou.vars.len() as u32);
        pou.vars.push(var);
    }
}

/// A [`TypeScope`] that borrows nothing.
#[derive(Debug, Clone)]
pub(crate) struct OwnedScope {
    unit: super::signature::UnitId,
    namespace: super::signature::NamespaceId,
    bindings: super::signature::Bindings,
    pou: PouId,
}

impl OwnedScope {
    /// The type of an open string or array, where a call has given it one.
    fn open_type(&self, name: iecc_ast::Symbol) -> Option<TypeId> {
        let mut open = self.bindings.open.iter();
        open.find(|(known, _)| *known == name).map(|(_, ty)| *ty)
    }

    pub(crate) fn as_scope(&self) -> TypeScope<'_> {
        TypeScope {
            unit: self.unit,
            namespace: self.namespace,
            bindings: Some(&self.bindings),
            pou: Some(self.pou),
        }
    }
}
