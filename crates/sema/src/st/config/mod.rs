//! Configurations: tasks, program instances, access paths, VAR_CONFIG.

mod paths;

pub(crate) use paths::{Found, place_of};

use super::analysis::Analysis;
use super::body::Connections;
use super::signature::{Def, PouId, Storage, UnitId, Var};
use super::types::{TypeId, TypeKind};
use crate::hir::code::Init;
use crate::hir::{IoPoint, Place, TagId, Task, Trigger};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Area, Declarations, PouKind, ProgramElement, SectionKind};
use iecc_diag::Code as Message;

/// A task of a resource.
#[derive(Debug, Clone, Copy)]
struct Declared {
    name: Symbol,
    /// Among the tasks of the program.
    index: usize,
}

impl Analysis<'_> {
    pub(crate) fn configuration(&mut self, unit: UnitId, configuration: &st::Configuration) {
        let arena = &self.unit(unit).arena;
        self.hir.name = self.text(configuration.name.name).to_owned();
        self.outer_sections(unit, configuration.sections);
        let count: usize = arena[configuration.resources]
            .iter()
            .map(|resource| resource.programs.len())
            .sum();
        for resource in &arena[configuration.resources] {
            self.outer_sections(unit, resource.sections);
            let tasks = self.declared_tasks(resource);
            for program in &arena[resource.programs] {
                self.program_config(unit, program, &tasks, count == 1);
            }
            self.task_triggers(unit, resource, &tasks);
        }
        if count == 0 {
            let span = self.span(unit, configuration.name.range);
            self.error(Message::E6020, span, "the configuration runs no program");
        }
        let mut placed = Vec::new();
        for section in &arena[configuration.sections] {
            match section.declarations {
                Declarations::Accesses(accesses) => self.accesses(unit, accesses),
                Declarations::Instances(instances) => {
                    for config in &arena[instances] {
                        placed.extend(self.instance_config(unit, config));
                    }
                }
                Declarations::Variables(_) => {}
            }
        }
        for (name, program, tag) in self.program_instances.clone() {
            self.check_places(program, tag, self.text(name), &placed);
        }
    }

    /// Sections beside programs and tasks. Global variables are declared elsewhere.
    fn outer_sections(&mut self, unit: UnitId, sections: st::List<st::VarSection>) {
        let arena = &self.unit(unit).arena;
        for section in &arena[sections] {
            self.modifiers_go_together(unit, None, section);
            let Declarations::Variables(variables) = section.declarations else {
                continue;
            };
            if section.kind != SectionKind::External {
                continue;
            }
            let scope = self.global_scope(unit);
            let constant = arena[section.modifiers]
                .iter()
                .any(|m| m.kind == st::ModifierKind::Constant);
            for decl in &arena[variables] {
                let ty = self.type_of_spec(scope, decl.ty);
                for ident in &arena[decl.names] {
                    let var = Var {
                        name: ident.name,
                        range: ident.range,
                        section: section.kind,
                        ty,
                        initial: None,
                        constant,
                        edge: None,
                        access: None,
                        storage: Storage::Local,
                        partly: None,
                    };
                    self.external_of(unit, scope.namespace, &var);
                }
            }
        }
    }

    fn declared_tasks(&mut self, resource: &st::Resource) -> Vec<Declared> {
        let mut declared: Vec<Declared> = Vec::new();
        let Some(unit) = self.configuration_unit() else {
            return declared;
        };
        for task in &self.unit(unit).arena[resource.tasks] {
            let name = task.name.name;
            if declared.iter().any(|known| known.name == name) {
                let span = self.span(unit, task.name.range);
                let message = format!("task `{}` is declared twice", self.text(name));
                self.error(Message::E1003, span, message);
                continue;
            }
            declared.push(Declared {
                name,
                index: self.hir.tasks.len(),
            });
            self.hir.tasks.push(Task {
                name: self.text(name).to_owned(),
                trigger: Trigger::default(),
                priority: 0,
                calls: Vec::new(),
            });
        }
        declared
    }

    fn configuration_unit(&self) -> Option<UnitId> {
        let is = |unit: &super::analysis::UnitRef<'_>| {
            matches!(unit.unit.kind, st::UnitKind::Configuration(_))
        };
        self.units
            .iter()
            .position(is)
            .map(|index| UnitId(index as u32))
    }

    /// SINGLE, INTERVAL and PRIORITY. Programs are known by now, since SINGLE may name their outputs.
    fn task_triggers(&mut self, unit: UnitId, resource: &st::Resource, tasks: &[Declared]) {
        for task in &self.unit(unit).arena[resource.tasks] {
            let known = tasks.iter().find(|known| known.name == task.name.name);
            if let Some(known) = known {
                let (trigger, priority) = self.trigger(unit, task);
                let made = &mut self.hir.tasks[known.index];
                (made.trigger, made.priority) = (trigger, priority);
            }
        }
    }

    fn trigger(&mut self, unit: UnitId, task: &st::Task) -> (Trigger, u32) {
        let (mut interval_ns, mut single, mut priority) = (0, None, None);
        let mut says_when = false;
        for parameter in &self.unit(unit).arena[task.parameters] {
            let (st::ArgumentKind::Input(name), Some(value)) = (parameter.kind, parameter.value)
            else {
                let span = self.span(unit, parameter.range);
                let message = "a task takes SINGLE := …, INTERVAL := … and PRIORITY := …";
                self.error(Message::E1019, span, message);
                continue;
            };
            if name.name == self.words.interval {
                interval_ns = self.interval(unit, value);
                says_when = true;
            } else if name.name == self.words.single {
                single = self.single(unit, value);
                says_when = true;
            } else if name.name == self.words.priority {
                priority = Some(self.priority(unit, value));
            } else {
                let span = self.span(unit, name.range);
                let message = format!("a task has no parameter `{}`", self.text(name.name));
                self.error(Message::E1019, span, message);
            }
        }
        let span = self.span(unit, task.name.range);
        if priority.is_none() {
            self.error(Message::E6026, span, "the task has no PRIORITY");
        }
        if !says_when {
            let message = "the task never runs: it has neither INTERVAL nor SINGLE";
            self.error(Message::E6026, span, message);
        }
        let trigger = Trigger::Timed {
            interval_ns,
            single,
        };
        (trigger, priority.unwrap_or(0))
    }

    fn interval(&mut self, unit: UnitId, value: st::Id<st::Expr>) -> u64 {
        let ty = TypeId::of(super::elementary::El::Time);
        let scope = self.global_scope(unit);
        let ns = self.constant(scope, value, ty).and_then(|v| v.as_int());
        let Some(ns) = ns else { return 0 };
        u64::try_from(ns).unwrap_or_else(|_| {
            let span = self.span(unit, self.unit(unit).arena[value].range);
            self.error(Message::E6026, span, "an INTERVAL is not below 0");
            0
        })
    }

    fn priority(&mut self, unit: UnitId, value: st::Id<st::Expr>) -> u32 {
        let ty = TypeId::of(super::elementary::El::Uint);
        let scope = self.global_scope(unit);
        let value = self.constant(scope, value, ty).and_then(|v| v.as_int());
        value.unwrap_or(0) as u32
    }

    fn single(&mut self, unit: UnitId, value: st::Id<st::Expr>) -> Option<Place> {
        let found = self.outside_path(unit, value)?;
        if self.types.strip(found.ty) == TypeId::BOOL {
            return found.place;
        }
        let span = self.span(unit, self.unit(unit).arena[value].range);
        let message = format!("SINGLE is a BOOL, not {}", self.type_name(found.ty));
        self.error(Message::E2020, span, message);
        None
    }

    fn program_config(
        &mut self,
        unit: UnitId,
        program: &st::ProgramConfig,
        tasks: &[Declared],
        only: bool,
    ) {
        let Some(pou) = self.program_type(unit, program) else {
            return;
        };
        let arena = &self.unit(unit).arena;
        let name = program.name.name;
        let span = self.span(unit, program.name.range);
        let namespace = self.units[unit.index()].namespace;
        let global = matches!(self.lookup_in(namespace, name), [Def::Global(_)]);
        if global || self.program_instances.iter().any(|one| one.0 == name) {
            let message = format!("`{}` is declared twice", self.text(name));
            self.error(Message::E1003, span, message);
            return;
        }
        let text = self.text(name).to_owned();
        let tag = self.program_instance(pou, &text);
        self.program_instances.push((name, pou, tag));
        let connections = Connections {
            unit,
            elements: arena[program.elements].to_vec(),
            range: program.name.range,
        };
        // The instance of the type Main may be named without its name.
        let main = self.text(self.pou(pou).name).eq_ignore_ascii_case("main");
        if only || (main && self.is_first_of(pou)) {
            self.public_points(pou, tag, &self.connected_names(unit, &connections));
        }
        self.access_names(pou, tag);
        let call = self.program_call(pou, tag, &text, &connections);
        match program.task {
            Some(task) => {
                if let Some(index) = self.task_named(unit, task, tasks) {
                    self.hir.tasks[index].calls.push(call);
                }
            }
            None => self.hir.tasks.push(Task {
                name: text.clone(),
                trigger: Trigger::EveryScan,
                priority: u32::MAX,
                calls: vec![call],
            }),
        }
        self.own_tasks(unit, program, pou, tag, tasks);
    }

    fn is_first_of(&self, pou: PouId) -> bool {
        let of = self.program_instances.iter().filter(|one| one.1 == pou);
        of.count() == 1
    }

    fn connected_names(&self, unit: UnitId, connections: &Connections) -> Vec<Symbol> {
        let arena = &self.unit(unit).arena;
        let names = connections.elements.iter().filter_map(|element| {
            let ProgramElement::Source { variable, .. } = element else {
                return None;
            };
            arena[*variable].kind.name()
        });
        names.collect()
    }

    fn program_type(&mut self, unit: UnitId, program: &st::ProgramConfig) -> Option<PouId> {
        let namespace = self.units[unit.index()].namespace;
        let def = self.path(unit, namespace, program.program);
        let def = def.and_then(|defs| defs.first().copied());
        if let Some(Def::Pou(pou)) = def
            && self.pou(pou).kind == PouKind::Program
        {
            return Some(pou);
        }
        let span = self.span(unit, self.unit(unit).arena[program.program].range);
        self.error(Message::E1009, span, "no program has this name");
        None
    }

    fn task_named(&mut self, unit: UnitId, task: st::Ident, tasks: &[Declared]) -> Option<usize> {
        let found = tasks.iter().find(|known| known.name == task.name);
        if found.is_none() {
            let span = self.span(unit, task.range);
            let message = format!("no task is named `{}`", self.text(task.name));
            let mut diagnostic = iecc_diag::Diagnostic::new(Message::E6042, span, message);
            let names = tasks.iter().map(|known| known.name);
            if let Some(close) = self.similar(task.name, names) {
                diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
            }
            self.report(diagnostic);
        }
        found.map(|known| known.index)
    }

    /// `block WITH task`
    fn own_tasks(
        &mut self,
        unit: UnitId,
        program: &st::ProgramConfig,
        pou: PouId,
        tag: TagId,
        tasks: &[Declared],
    ) {
        for element in &self.unit(unit).arena[program.elements] {
            let ProgramElement::Task { block, task } = *element else {
                continue;
            };
            if let Some(index) = self.task_named(unit, task, tasks)
                && let Some(call) = self.own_task(unit, pou, tag, block)
            {
                self.hir.tasks[index].calls.push(call);
            }
        }
    }

    /// What a task of its own runs for a block.
    fn own_task(
        &mut self,
        unit: UnitId,
        pou: PouId,
        tag: TagId,
        block: st::Id<st::Expr>,
    ) -> Option<crate::hir::PouId> {
        let arena = &self.unit(unit).arena;
        let span = self.span(unit, arena[block].range);
        let names = names_of(arena, block).unwrap_or_default();
        let text: Vec<&str> = names.iter().map(|name| self.text(*name)).collect();
        let text = text.join(".");
        let found = self.inside_path(unit, pou, tag, block);
        let found = found
            .and_then(|found| Some((found.place?, self.types.instance(found.ty)?)))
            .filter(|(_, block)| self.pou(*block).kind == PouKind::FunctionBlock);
        let Some((place, called)) = found else {
            let message = format!("`{text}` is no block of the program");
            self.error(Message::E1018, span, message);
            return None;
        };
        if self.calls_block(pou, &names) {
            let message = format!("`{text}` has a task of its own, but its program calls it");
            self.error(Message::E6043, span, message);
            return None;
        }
        if let Some(&in_out) = self.call_shape(called).refs.first() {
            let in_out = self.text(self.pou(called).vars[in_out].name);
            let message = format!("a task calls `{text}`, so in-out `{in_out}` has no argument");
            self.error(Message::E3016, span, message);
            return None;
        }
        let name = self.hir.display(&place);
        Some(self.block_run(called, &place, &name, unit))
    }

    /// Whether a program calls a block in it, or a block on the way there does.
    fn calls_block(&self, program: PouId, names: &[Symbol]) -> bool {
        let (mut home, mut rest) = (Some(program), names);
        while let (Some(pou), Some((first, inner))) = (home, rest.split_first()) {
            let lineage = self.lineage(pou);
            if lineage.iter().any(|base| self.calls_path(*base, rest)) {
                return true;
            }
            let mut vars = lineage
                .iter()
                .filter_map(|base| self.pou(*base).var(*first));
            home = vars.next().and_then(|var| self.instances_in(var.ty));
            rest = inner;
        }
        false
    }

    /// What a variable is an instance of, or its elements.
    fn instances_in(&self, ty: TypeId) -> Option<PouId> {
        if let TypeKind::Array { element, .. } = self.types.base(ty) {
            return self.types.instance(*element);
        }
        self.types.instance(ty)
    }

    /// Whether a unit calls what it has at a path, with whatever subscripts.
    fn calls_path(&self, pou: PouId, path: &[Symbol]) -> bool {
        let arena = &self.unit(self.pou(pou).unit).arena;
        arena.all::<st::Expr>().iter().any(|expr| {
            matches!(expr.kind, st::ExprKind::Call { callee, .. }
                if names_of(arena, callee).is_some_and(|called| called == path))
        })
    }

    /// VAR_ACCESS of the configuration.
    fn accesses(&mut self, unit: UnitId, accesses: st::List<st::AccessDecl>) {
        for access in &self.unit(unit).arena[accesses] {
            let Some(found) = self.outside_path(unit, access.path) else {
                continue;
            };
            if self.same_type(unit, access.ty, found.ty) {
                let name = self.text(access.name.name).to_owned();
                self.add_found(unit, access, name, found.place);
            }
        }
    }

    fn add_found(
        &mut self,
        unit: UnitId,
        access: &st::AccessDecl,
        name: String,
        place: Option<Place>,
    ) {
        match place {
            Some(place) => self.add_name(unit, access.name, name, place),
            None => {
                let range = self.unit(unit).arena[access.path].range;
                let what = "a path to a number that shares its bytes with others";
                self.unsupported(unit, range, what);
            }
        }
    }

    fn add_name(&mut self, unit: UnitId, ident: st::Ident, name: String, place: Place) {
        let taken = |other: &str| other.eq_ignore_ascii_case(&name);
        let known = self.hir.names.iter().find(|(other, _)| taken(other));
        let same = known.is_some_and(|(_, known)| *known == place);
        let tag = self.hir.tags.iter().position(|tag| taken(&tag.name));
        let same_tag = tag.is_some_and(|tag| place == Place::whole(TagId::from_index(tag)));
        if same || same_tag {
            return;
        }
        if known.is_some() || tag.is_some() {
            let span = self.span(unit, ident.range);
            let message = format!("`{name}` is a name of something else already");
            self.error(Message::E1003, span, message);
            return;
        }
        self.hir.names.push((name, place));
    }

    /// VAR_ACCESS of a program.
    pub(crate) fn access_names(&mut self, program: PouId, tag: TagId) {
        let unit = self.pou(program).unit;
        let arena = &self.unit(unit).arena;
        let st::UnitKind::Pou(written) = &self.unit(unit).kind else {
            return;
        };
        if !self.is_first_of(program) && !self.program_instances.is_empty() {
            return;
        }
        for section in &arena[written.sections] {
            let Declarations::Accesses(accesses) = section.declarations else {
                continue;
            };
            for access in &arena[accesses] {
                let found = arena[access.path].kind.name().and_then(|name| {
                    let start = self.found_program(program, tag);
                    self.path_member(start, name)
                });
                let Some(found) = found else {
                    let span = self.span(unit, arena[access.path].range);
                    let message = "this is no variable of the program";
                    self.error(Message::E1012, span, message);
                    continue;
                };
                if self.same_type(unit, access.ty, found.ty) {
                    let name = self.text(access.name.name).to_owned();
                    self.add_found(unit, access, name, found.place);
                }
            }
        }
    }

    fn same_type(&mut self, unit: UnitId, written: st::Id<st::TypeSpec>, ty: TypeId) -> bool {
        let scope = self.global_scope(unit);
        let here = self.type_of_spec(scope, written);
        if here == TypeId::ERROR || ty == TypeId::ERROR {
            return false;
        }
        if self.types.strip(here) == self.types.strip(ty) {
            return true;
        }
        let span = self.span(unit, self.unit(unit).arena[written].range);
        let (there, here) = (self.type_name(ty), self.type_name(here));
        let message = format!("the variable is of type {there}, not {here}");
        self.error(Message::E6040, span, message);
        false
    }

    /// VAR_CONFIG: gives the place it says something of, if that is an address.
    fn instance_config(&mut self, unit: UnitId, config: &st::InstanceConfig) -> Option<Place> {
        let found = self.outside_path(unit, config.path)?;
        if !self.same_type(unit, config.ty, found.ty) {
            return None;
        }
        if let Some(initial) = config.initial {
            self.instance_initial(unit, initial, &found);
        }
        let location = config.location?;
        let span = self.span(unit, self.unit(unit).arena[location].range);
        let address = self.address(unit, location)?;
        if !self.fits_address(unit, location, address, found.ty) {
            return found.place;
        }
        if !found.partly {
            let message = "the declaration of this variable has no address with `*`";
            self.error(Message::E6043, span, message);
            return None;
        }
        let text = address.text();
        let taken = self.hir.names.iter().any(|(name, _)| *name == text);
        if taken || self.is_used(address) {
            let range = self.unit(unit).arena[location].range;
            self.unsupported(
                unit,
                range,
                "an address for this variable that the program names elsewhere too",
            );
            return found.place;
        }
        let place = found.place?;
        self.hir.names.push((text.clone(), place.clone()));
        let point = IoPoint {
            name: text,
            place: place.clone(),
        };
        match address.area {
            Area::Input => self.hir.inputs.push(point),
            Area::Output => self.hir.outputs.push(point),
            Area::Memory => {}
        }
        Some(place)
    }

    /// An initial value for one instance, in place of the one that its type gives.
    fn instance_initial(&mut self, unit: UnitId, initial: st::Id<st::Expr>, found: &Found) {
        let scope = self.global_scope(unit);
        let value = self.value_of(scope, initial, found.ty);
        let value = value.unwrap_or_else(|| self.init(Init::Zero));
        if let Some(address) = found.address {
            let span = self.span(unit, self.unit(unit).arena[initial].range);
            return self.set_initial(address, found.ty, value, span);
        }
        if let Some(place) = &found.place {
            let tag = place.tag.index();
            let init = self.with_part(self.hir.tags[tag].init, &place.path, value);
            self.hir.tags[tag].init = Some(init);
        }
    }
}

/// The names on a path, without subscripts; `None` if it is no such path. Recursion is bounded by the
/// depth of expressions.
fn names_of(arena: &st::Arena, id: st::Id<st::Expr>) -> Option<Vec<Symbol>> {
    let written = arena[id].kind;
    if let st::ExprKind::Name(name) = written {
        Some(vec![name])
    } else if let st::ExprKind::Member { base, member } = written {
        let mut names = names_of(arena, base)?;
        names.push(member.name);
        Some(names)
    } else if let st::ExprKind::Index { base, .. } = written {
        names_of(arena, base)
    } else {
        (written == st::ExprKind::This).then(Vec::new)
    }
}
