//! From checked units to a program that can run: instances, tasks, inputs and outputs.

use super::analysis::Analysis;
use super::body::Rights;
use super::signature::{PouId, Storage, UnitId, Var};
use super::types::{TypeId, TypeKind};
use crate::hir::code::{
    Call, Code, Expr, ExprId, ExprKind, Path, PathId, Root, Stmt, StmtId, StmtKind,
};
use crate::hir::{self, Body, Elementary, IoPoint, Place, Step, TagId, Task, Trigger, Type};
use iecc_ast::st::{self, PouKind, SectionKind, UnitKind};
use iecc_diag::{Code as Message, Diagnostic, closest};

impl Analysis<'_> {
    /// Makes the tasks and instances; a message if there is nothing to run.
    pub(crate) fn assemble(&mut self) {
        let configuration =
            self.units
                .iter()
                .enumerate()
                .find_map(|(index, unit)| match &unit.unit.kind {
                    UnitKind::Configuration(configuration) => {
                        Some((UnitId(index as u32), configuration))
                    }
                    _ => None,
                });
        match configuration {
            Some((unit, configuration)) => {
                self.no_entry();
                self.configuration(unit, configuration);
            }
            None => self.single_program(),
        }
    }

    /// Where a configuration says what runs, nobody else does.
    fn no_entry(&mut self) {
        if let Some(entry) = self.options.entry {
            let entry = self.text(entry);
            let message = format!("`{entry}` is to run, but a CONFIGURATION says what runs");
            self.report(Diagnostic::without_place(Message::E6020, message));
        }
    }

    /// Without a configuration the only program runs in every scan.
    fn single_program(&mut self) {
        let programs: Vec<PouId> = (0..self.pous.len() as u32)
            .map(PouId)
            .filter(|id| self.pou(*id).kind == PouKind::Program && self.pou(*id).owner.is_none())
            .collect();
        let Some(program) = self.entry(&programs) else {
            return;
        };
        let name = self.text(self.pou(program).name).to_owned();
        let tag = self.program_instance(program, &name);
        self.public_points(program, tag);
        let call = self.program_call(program, tag, &name);
        self.hir.name.clone_from(&name);
        self.hir.tasks.push(Task {
            name,
            trigger: Trigger::EveryScan,
            priority: 0,
            calls: vec![call],
        });
    }

    /// Which of the programs runs; a message if that is open.
    fn entry(&mut self, programs: &[PouId]) -> Option<PouId> {
        let diagnostic = match (self.options.entry, programs) {
            // A library of blocks can be checked; there is nothing to run.
            (None, []) => return None,
            (None, [program]) => return Some(*program),
            (None, [_, second, ..]) => {
                let message =
                    "there are several programs but no CONFIGURATION that says which runs";
                Diagnostic::new(Message::E6020, self.pou(*second).span, message)
                    .note("`--entry NAME`, or `entry` in the project file, says it as well")
            }
            (Some(entry), programs) => {
                let found = programs.iter().find(|id| self.pou(**id).name == entry);
                if let Some(program) = found {
                    return Some(*program);
                }
                let names = programs.iter().map(|id| self.text(self.pou(*id).name));
                let entry = self.text(entry);
                let message = format!("there is no program `{entry}` to run");
                let diagnostic = Diagnostic::without_place(Message::E6020, message);
                match closest(entry, names) {
                    Some(name) => diagnostic.note(format!("did you mean `{name}`?")),
                    None => diagnostic,
                }
            }
        };
        self.report(diagnostic);
        None
    }

    /// The storage of a program instance.
    pub(crate) fn program_instance(&mut self, program: PouId, name: &str) -> TagId {
        self.complete(program);
        let ty = self.types.intern(TypeKind::Instance(program));
        let storage = self.storage(ty);
        let init = self.default_init(ty);
        let span = self.pou(program).span;
        self.add_tag(name, storage, hir::View::Number, init, Some(span))
    }

    pub(crate) fn add_tag(
        &mut self,
        name: &str,
        ty: Type,
        view: hir::View,
        init: Option<hir::InitId>,
        span: Option<iecc_source::Span>,
    ) -> TagId {
        self.hir.tags.push(hir::Tag {
            name: name.to_owned(),
            ty,
            view,
            init,
            initial: Vec::new(),
            span,
        });
        TagId::from_index(self.hir.tags.len() - 1)
    }

    /// VAR_INPUT and VAR_OUTPUT of the only program are what is exchanged; all its variables can
    /// be named without it.
    pub(crate) fn public_points(&mut self, program: PouId, tag: TagId) {
        for var in self.pou(program).vars.clone() {
            let Storage::Field(field) = var.storage else {
                continue;
            };
            let place = Place::whole(tag).step(Step::Field(field));
            let name = self.text(var.name).to_owned();
            match var.section {
                SectionKind::Input => self.points(&name, place.clone(), var.ty, true),
                SectionKind::Output => self.points(&name, place.clone(), var.ty, false),
                _ => self.hir.names.push((name, place)),
            }
        }
    }

    /// A point for every number of a variable.
    fn points(&mut self, name: &str, place: Place, ty: TypeId, input: bool) {
        let points = if input {
            &mut self.hir.inputs
        } else {
            &mut self.hir.outputs
        };
        let whole =
            self.types.is_scalar(ty) || matches!(self.types.base(ty), TypeKind::Text { .. });
        if whole {
            points.push(IoPoint {
                name: name.to_owned(),
                place,
            });
            return;
        }
        match self.types.base(ty).clone() {
            TypeKind::Array {
                dimensions,
                element,
            } => self.array_points(name, place, &dimensions, element, input, String::new()),
            TypeKind::Struct(index) => {
                let members = self.types.structs[index as usize].members.clone();
                for (position, member) in (0..).zip(members) {
                    let name = format!("{name}.{}", self.text(member.name));
                    let place = place.clone().step(Step::Field(position));
                    self.points(&name, place, member.ty, input);
                }
            }
            _ => {}
        }
    }

    fn array_points(
        &mut self,
        name: &str,
        place: Place,
        dimensions: &[(i64, i64)],
        element: TypeId,
        input: bool,
        subscripts: String,
    ) {
        let Some(((low, high), inner)) = dimensions.split_first() else {
            let name = format!("{name}[{subscripts}]");
            self.points(&name, place, element, input);
            return;
        };
        for (position, subscript) in (0..).zip(*low..=*high) {
            let subscripts = match subscripts.as_str() {
                "" => subscript.to_string(),
                outer => format!("{outer},{subscript}"),
            };
            let place = place.clone().step(Step::Index(position));
            self.array_points(name, place, inner, element, input, subscripts);
        }
    }

    /// A unit without parameters that runs a program instance.
    pub(crate) fn program_call(&mut self, program: PouId, tag: TagId, name: &str) -> hir::PouId {
        let span = self.pou(program).span;
        let callee = self.want(program);
        let mut code = Code::default();
        code.paths.push(Path {
            root: Root::Tag(tag),
            steps: Vec::new(),
            span,
        });
        code.calls.push(Call {
            callee,
            refs: vec![PathId(0)],
            args: Vec::new(),
            outputs: Vec::new(),
        });
        code.exprs.push(Expr {
            kind: ExprKind::Call(crate::hir::code::CallId(0)),
            ty: Elementary::Bool,
            span,
        });
        code.stmts.push(Stmt {
            kind: StmtKind::Eval(ExprId(0)),
            span,
        });
        code.body.push(StmtId(0));
        self.synthetic(format!("{name}'"), code, span)
    }

    /// A unit that no source declares. Ids follow those of the units that are wanted, so it is kept
    /// aside until all are known.
    pub(crate) fn synthetic(
        &mut self,
        name: String,
        code: Code,
        span: iecc_source::Span,
    ) -> hir::PouId {
        let id = hir::PouId::from_index(self.wanted.len());
        self.wanted.push(PouId(u32::MAX));
        self.synthetics.push((
            id,
            hir::Pou {
                name,
                parameters: Vec::new(),
                results: Vec::new(),
                body: Body::Text(Box::new(code)),
                span,
            },
        ));
        id
    }

    /// What a direct address stands for.
    pub(crate) fn direct_place(
        &mut self,
        unit: UnitId,
        id: st::Id<st::Expr>,
    ) -> Option<(Place, TypeId, Rights)> {
        let range = self.unit(unit).arena[id].range;
        self.unsupported(unit, range, "a direct address");
        None
    }

    /// A variable at an address.
    pub(crate) fn located(&mut self, id: PouId, var: &mut Var, location: st::Id<st::Expr>) {
        let unit = self.pou(id).unit;
        let range = self.unit(unit).arena[location].range;
        self.unsupported(unit, range, "a variable at an address");
        var.ty = TypeId::ERROR;
    }

    fn configuration(&mut self, unit: UnitId, configuration: &st::Configuration) {
        let arena = &self.unit(unit).arena;
        for section in &arena[configuration.sections] {
            self.unsupported(unit, section.range, section.kind.as_str());
        }
        for resource in &arena[configuration.resources] {
            for section in &arena[resource.sections] {
                self.unsupported(unit, section.range, section.kind.as_str());
            }
            let tasks: Vec<(iecc_ast::Symbol, Task)> = arena[resource.tasks]
                .iter()
                .map(|task| (task.name.name, self.task(unit, task)))
                .collect();
            let base = self.hir.tasks.len();
            self.hir
                .tasks
                .extend(tasks.iter().map(|(_, task)| task.clone()));
            let single = arena[resource.programs].len() == 1;
            for program in &arena[resource.programs] {
                self.program_config(unit, program, &tasks, base, single);
            }
        }
        self.hir.name = self.text(configuration.name.name).to_owned();
    }

    fn task(&mut self, unit: UnitId, task: &st::Task) -> Task {
        let scope = super::resolve::TypeScope {
            unit,
            namespace: super::signature::NamespaceId::GLOBAL,
            bindings: None,
            pou: None,
        };
        let (mut interval_ns, mut priority) = (0, 0);
        for parameter in &self.unit(unit).arena[task.parameters] {
            let (st::ArgumentKind::Input(name), Some(value)) = (parameter.kind, parameter.value)
            else {
                continue;
            };
            if name.name == self.words.interval {
                let ty = TypeId::of(super::elementary::El::Time);
                let value = self.constant(scope, value, ty).and_then(|v| v.as_int());
                interval_ns = value.and_then(|v| u64::try_from(v).ok()).unwrap_or(0);
            } else if name.name == self.words.priority {
                let ty = TypeId::of(super::elementary::El::Uint);
                priority = self
                    .constant(scope, value, ty)
                    .and_then(|v| v.as_int())
                    .unwrap_or(0) as u32;
            } else {
                self.unsupported(unit, name.range, "this parameter of a task");
            }
        }
        Task {
            name: self.text(task.name.name).to_owned(),
            trigger: Trigger::Timed {
                interval_ns,
                single: None,
            },
            priority,
            calls: Vec::new(),
        }
    }

    fn program_config(
        &mut self,
        unit: UnitId,
        program: &st::ProgramConfig,
        tasks: &[(iecc_ast::Symbol, Task)],
        base: usize,
        single: bool,
    ) {
        let arena = &self.unit(unit).arena;
        let namespace = self.units[unit.index()].namespace;
        for element in &arena[program.elements] {
            let (st::ProgramElement::Source { variable, .. }
            | st::ProgramElement::Sink { variable, .. }
            | st::ProgramElement::Task {
                block: variable, ..
            }) = element;
            let range = arena[*variable].range;
            self.unsupported(unit, range, "a connection of a program instance");
        }
        let def = self.path(unit, namespace, program.program);
        let def = def.and_then(|defs| defs.first().copied());
        let Some(super::signature::Def::Pou(pou)) = def else {
            let span = self.span(unit, arena[program.program].range);
            self.error(Message::E1009, span, "no program has this name");
            return;
        };
        let name = self.text(program.name.name).to_owned();
        let tag = self.program_instance(pou, &name);
        if single {
            self.public_points(pou, tag);
        }
        let call = self.program_call(pou, tag, &name);
        let task = program.task.and_then(|task| {
            let found = tasks.iter().position(|(known, _)| *known == task.name);
            if found.is_none() {
                let span = self.span(unit, task.range);
                let message = format!("no task is named `{}`", self.text(task.name));
                self.error(Message::E6042, span, message);
            }
            found
        });
        match task {
            Some(task) => self.hir.tasks[base + task].calls.push(call),
            None => self.hir.tasks.push(Task {
                name,
                trigger: Trigger::EveryScan,
                priority: u32::MAX,
                calls: vec![call],
            }),
        }
    }
}
