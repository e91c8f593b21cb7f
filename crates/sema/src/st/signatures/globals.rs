//! Global variables: those of configurations, resources, programs and files.
//!
//! Types and values are found on demand, since constants may stand in types and in each other.
//! Storage is given to all of them at once, in the order of declaration.

use crate::hir::Place;
use crate::st::analysis::Analysis;
use crate::st::signature::{
    Def, Global, GlobalId, Initial, NamespaceId, PouId, Spot, State, Storage, UnitId, Var,
};
use crate::st::types::TypeId;
use iecc_ast::st::{
    self, Area, Declarations, Modifier, ModifierKind, PouKind, SectionKind, VarSection,
};
use iecc_diag::{Code, Diagnostic};

impl Analysis<'_> {
    /// Declares the variables of a section, if they are global.
    pub(crate) fn declare_globals(
        &mut self,
        unit: UnitId,
        namespace: NamespaceId,
        section: &VarSection,
    ) {
        let (SectionKind::Global, Declarations::Variables(variables)) =
            (section.kind, section.declarations)
        else {
            return;
        };
        let arena = &self.unit(unit).arena;
        let constant = has(&arena[section.modifiers], ModifierKind::Constant);
        for decl in &arena[variables] {
            for ident in &arena[decl.names] {
                let span = self.span(unit, ident.range);
                let id = GlobalId(self.globals.len() as u32);
                self.globals.push(Global {
                    name: ident.name,
                    path: None,
                    list: None,
                    qualified: false,
                    ty: TypeId::ERROR,
                    constant,
                    initial: decl.initial.map(|expr| Initial { unit, expr }),
                    span,
                    value: None,
                    spot: None,
                    unit,
                    decl: *decl,
                    state: State::Declared,
                });
                self.define(namespace, ident.name, Def::Global(id), span);
            }
        }
    }

    /// Finds the type of a global variable, and the value of a constant.
    pub(crate) fn complete_global(&mut self, id: GlobalId) {
        let global = self.global(id).clone();
        match global.state {
            State::Done => return,
            State::InProgress => {
                let name = self.text(global.name);
                let message = format!("constant `{name}` needs its own value");
                self.error(Code::E2030, global.span, message);
                // It counts as wrong from here on.
                self.globals[id.index()].ty = TypeId::ERROR;
                return;
            }
            State::Declared => {}
        }
        self.globals[id.index()].state = State::InProgress;
        let scope = self.global_scope(global.unit);
        let ty = self.type_of_spec(scope, global.decl.ty);
        let unit = self.unit(global.unit);
        let span = unit.span(unit.arena[global.decl.ty].range);
        let ty = self.complete_contained(ty, span);
        self.globals[id.index()].ty = ty;
        self.take_memory(ty, span);
        if global.constant && ty != TypeId::ERROR && self.types.is_scalar(ty) {
            let value = match global.initial {
                Some(initial) => self.constant(scope, initial.expr, ty),
                None => Some(self.default_const(ty)),
            };
            let value = value.filter(|_| self.global(id).ty != TypeId::ERROR);
            if value.is_none() {
                self.globals[id.index()].ty = TypeId::ERROR;
            }
            self.globals[id.index()].value = value;
        }
        self.globals[id.index()].state = State::Done;
    }

    /// Gives all global variables their storage, then their initial values, which may refer to one
    /// another.
    pub(crate) fn place_globals(&mut self) {
        for index in 0..self.globals.len() {
            let global = self.globals[index].clone();
            if global.value.is_none() && global.ty != TypeId::ERROR {
                self.globals[index].spot = self.place_global(&global);
                if self.globals[index].spot.is_none() {
                    self.globals[index].ty = TypeId::ERROR;
                }
            }
        }
        for index in 0..self.globals.len() {
            let global = self.globals[index].clone();
            if let Some(spot) = &global.spot {
                self.start_global(&global, spot);
            }
        }
        self.nameless_globals();
    }

    fn start_global(&mut self, global: &Global, spot: &Spot) {
        let init = match global.initial {
            Some(initial) => self.initial_value(initial, global.ty),
            None => self.default_init(global.ty),
        };
        let Some(location) = global.decl.location else {
            self.hir.tags[spot.tag.index()].init = init;
            return;
        };
        if let (Some(init), Some(address)) = (init, self.address(global.unit, location)) {
            self.set_initial(address, global.ty, init, global.span);
        }
    }

    fn place_global(&mut self, global: &Global) -> Option<Spot> {
        let Some(location) = global.decl.location else {
            let name = self.global_name(global);
            let name = self.free_tag_name(name);
            let (storage, view) = (self.storage(global.ty), self.view(global.ty));
            let tag = self.add_tag(&name, storage, view, None, Some(global.span));
            if let Some(list) = global.list.filter(|_| !global.qualified) {
                let name = format!("{}.{name}", self.text(list));
                self.hir.names.push((name, Place::whole(tag)));
            }
            let steps = Vec::new();
            return Some(Spot { tag, steps });
        };
        let partly = self.partly_area(global.unit, location);
        if let Some(area) = partly.filter(|_| self.options.codesys) {
            return Some(self.linked_global(global, area));
        }
        if partly.is_some() {
            let range = self.unit(global.unit).arena[location].range;
            self.foreign(
                global.unit,
                range,
                "a global variable at an address with `*`",
            );
            return None;
        }
        let address = self.address(global.unit, location)?;
        if !self.fits_address(global.unit, location, address, global.ty) {
            return None;
        }
        let spot = self.spot(address, global.ty);
        if spot.is_none() {
            let range = self.unit(global.unit).arena[location].range;
            self.unsupported(global.unit, range, "this type at addresses that overlap");
        }
        spot
    }

    /// `AT %IX0.0 : BOOL := TRUE;` without a name.
    fn nameless_globals(&mut self) {
        for index in self.first_user_unit..self.units.len() as u32 {
            let unit = UnitId(index);
            let arena = &self.unit(unit).arena;
            let nameless = |decl: &&st::VarDecl| decl.names.is_empty();
            for decl in arena.all::<st::VarDecl>().iter().filter(nameless) {
                self.nameless(unit, decl);
            }
        }
    }

    fn nameless(&mut self, unit: UnitId, decl: &st::VarDecl) {
        let Some(location) = decl.location else {
            return;
        };
        let Some(address) = self.address(unit, location) else {
            return;
        };
        let ty = self.type_of_spec(self.global_scope(unit), decl.ty);
        if ty == TypeId::ERROR || !self.fits_address(unit, location, address, ty) {
            return;
        }
        let init = match decl.initial {
            Some(expr) => self.initial_value(Initial { unit, expr }, ty),
            None => self.default_init(ty),
        };
        if let Some(init) = init {
            let span = self.span(unit, decl.range);
            self.set_initial(address, ty, init, span);
        }
    }

    /// Whether a global variable is an input.
    pub(crate) fn is_input(&self, id: GlobalId) -> bool {
        let global = self.global(id);
        let location = global.decl.location;
        let arena = &self.unit(global.unit).arena;
        location.is_some_and(|location| {
            matches!(arena[location].kind, st::ExprKind::Direct(direct)
                if direct.area == Some(Area::Input))
        })
    }

    /// A global variable seen in the program that declares it.
    pub(crate) fn own_global(&mut self, id: PouId, var: &mut Var) {
        let namespace = self.pou(id).namespace;
        if let [Def::Global(global)] = *self.lookup_in(namespace, var.name) {
            self.complete_global(global);
            var.ty = self.global(global).ty;
            var.storage = Storage::Global(global);
        } else {
            var.ty = TypeId::ERROR;
        }
    }

    /// VAR_EXTERNAL.
    pub(crate) fn external(&mut self, id: PouId, var: &mut Var) {
        let (unit, namespace) = (self.pou(id).unit, self.pou(id).namespace);
        match self.external_of(unit, namespace, var) {
            Some(global) => {
                var.storage = Storage::Global(global);
                if self.global(global).ty == TypeId::ERROR {
                    var.ty = TypeId::ERROR;
                }
            }
            None => var.ty = TypeId::ERROR,
        }
    }

    /// The global variable that VAR_EXTERNAL names; a message if the declarations differ.
    pub(crate) fn external_of(
        &mut self,
        unit: UnitId,
        namespace: NamespaceId,
        var: &Var,
    ) -> Option<GlobalId> {
        let span = self.span(unit, var.range);
        let [Def::Global(global)] = *self.lookup(namespace, var.name) else {
            self.unknown_global(namespace, var, span);
            return None;
        };
        self.complete_global(global);
        let declared = self.global(global).clone();
        let name = self.text(var.name);
        let known = declared.ty != TypeId::ERROR && var.ty != TypeId::ERROR;
        let message = if known && self.types.strip(declared.ty) != self.types.strip(var.ty) {
            let (there, here) = (self.type_name(declared.ty), self.type_name(var.ty));
            format!("`{name}` is of type {there} where it is declared, not {here}")
        } else if declared.constant && !var.constant {
            format!("`{name}` is a constant, so this is VAR_EXTERNAL CONSTANT")
        } else if var.constant && !declared.constant {
            format!("`{name}` is no constant where it is declared")
        } else if var.initial.is_some() {
            format!("the initial value of `{name}` stands where it is declared")
        } else {
            return Some(global);
        };
        let diagnostic = Diagnostic::new(Code::E6040, span, message);
        self.report(diagnostic.also(declared.span, "declared here"));
        None
    }

    fn unknown_global(&mut self, namespace: NamespaceId, var: &Var, span: iecc_source::Span) {
        let message = format!("no global variable is named `{}`", self.text(var.name));
        let mut diagnostic = Diagnostic::new(Code::E6041, span, message);
        let globals = self.visible(namespace).into_iter();
        let globals =
            globals.filter(|name| matches!(self.lookup(namespace, *name), [Def::Global(_)]));
        let globals: Vec<_> = globals.collect();
        if let Some(close) = self.similar(var.name, globals) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
    }

    /// A variable at an address.
    pub(crate) fn located(
        &mut self,
        id: PouId,
        kind: PouKind,
        var: &mut Var,
        location: st::Id<st::Expr>,
    ) {
        let unit = self.pou(id).unit;
        let span = self.span(unit, self.unit(unit).arena[location].range);
        let owner = matches!(kind, PouKind::Program | PouKind::FunctionBlock);
        let in_var = matches!(var.section, SectionKind::Var);
        let partly = self.partly_area(unit, location);
        let partly_io =
            partly.is_some() && matches!(var.section, SectionKind::Input | SectionKind::Output);
        if !owner || !(in_var || partly_io) {
            let what = var.section.as_str();
            let message = format!("a variable of {what} cannot stand at an address here");
            self.error(Code::E1011, span, message);
            var.ty = TypeId::ERROR;
            return;
        }
        if partly.is_some() {
            var.partly = partly;
            return;
        }
        match self.address(unit, location) {
            Some(address) if self.fits_address(unit, location, address, var.ty) => {
                var.storage = Storage::Located(address);
            }
            Some(_) | None => var.ty = TypeId::ERROR,
        }
    }

    /// CONSTANT goes with neither RETAIN nor NON_RETAIN; retained is what lives on.
    pub(crate) fn modifiers_go_together(
        &mut self,
        unit: UnitId,
        kind: Option<PouKind>,
        section: &VarSection,
    ) {
        use ModifierKind as M;
        let modifiers = &self.unit(unit).arena[section.modifiers];
        let retained = modifiers
            .iter()
            .find(|m| matches!(m.kind, M::Retain | M::NonRetain | M::Persistent));
        let Some(retained) = retained else { return };
        let word = retained.kind.as_str();
        let other = modifiers.iter().map(|m| m.kind).find(|kind| {
            matches!(
                (kind, retained.kind),
                (M::Constant, _)
                    | (M::NonRetain, M::Retain | M::Persistent)
                    | (M::Retain | M::Persistent, M::NonRetain)
            )
        });
        let message = match (other, section.kind) {
            (Some(other), _) => format!("{word} does not go with {}", other.as_str()),
            (None, SectionKind::InOut | SectionKind::Temp | SectionKind::External) => {
                format!("{word} means nothing in {}", section.kind.as_str())
            }
            (None, _) if kind == Some(PouKind::Function) => {
                format!("{word} means nothing in a function or method: nothing in it lives on")
            }
            (None, _) => return,
        };
        let span = self.span(unit, retained.range);
        self.error(Code::E1011, span, message);
    }
}

fn has(modifiers: &[Modifier], kind: ModifierKind) -> bool {
    modifiers.iter().any(|modifier| modifier.kind == kind)
}
