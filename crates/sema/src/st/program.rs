//! From checked units to a program that can run: instances, tasks, inputs and outputs.

use super::analysis::Analysis;
use super::memory::MAX_POINTS;
use super::signature::{PouId, Storage, UnitId};
use super::types::{Parts, TypeId, TypeKind};
use crate::hir::code::Code;
use crate::hir::{self, Body, IoPoint, Place, Step, TagId, Task, Trigger, Type};
use iecc_ast::st::{self, Direction, PouKind, UnitKind};
use iecc_diag::{Code as Message, Diagnostic, closest};
use iecc_source::Span;

impl Analysis<'_> {
    /// Makes the tasks and instances; a message if there is nothing to run.
    pub(crate) fn assemble(&mut self) {
        let units = (0..).map(UnitId).zip(&self.units);
        let mut configurations = units.filter_map(|(id, unit)| match &unit.unit.kind {
            UnitKind::Configuration(configuration) => Some((id, &**configuration)),
            UnitKind::Types { .. }
            | UnitKind::Pou(_)
            | UnitKind::Test(_)
            | UnitKind::Globals(_)
            | UnitKind::Using(_)
            | UnitKind::Nothing
            | UnitKind::Error => None,
        });
        let first = configurations.next();
        let others: Vec<_> = configurations.collect();
        if let Some((unit, first)) = first {
            let first = self.span(unit, first.name.range);
            for (unit, other) in others {
                self.second_configuration(unit, other, first);
            }
        }
        match first {
            Some((unit, configuration)) => {
                self.no_entry();
                self.configuration(unit, configuration);
            }
            None => self.single_program(),
        }
        self.limit_points();
    }

    /// So many values have no use, and each has a name.
    fn limit_points(&mut self) {
        let points = self.hir.inputs.len().max(self.hir.outputs.len());
        if points > MAX_POINTS {
            let message =
                format!("a program exchanges at most {MAX_POINTS} inputs and as many outputs");
            self.report(Diagnostic::without_place(Message::E2007, message));
        }
    }

    /// A program is what one controller runs.
    fn second_configuration(&mut self, unit: UnitId, other: &st::Configuration, first: Span) {
        let name = self.text(other.name.name);
        let message = format!("`{name}` is a second configuration; a program has one");
        let span = self.span(unit, other.name.range);
        let diagnostic = Diagnostic::new(Message::E6045, span, message);
        let note =
            "each is compiled with the files that it needs, see `sources` in the project file";
        self.report(diagnostic.also(first, "the first one").note(note));
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
        self.public_points(program, tag, &[]);
        self.access_names(program, tag);
        self.check_places(program, tag, &name, &[]);
        let connections = super::body::Connections::none(self.pou(program).unit);
        let call = self.program_call(program, tag, &name, &connections);
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
                let names = programs.iter().map(|id| self.text(self.pou(*id).name));
                let names = names.collect::<Vec<_>>().join(", ");
                Diagnostic::new(Message::E6020, self.pou(*second).span, message)
                    .note(format!("the programs are {names}"))
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
        let span = self.pou(program).span;
        self.take_memory(ty, span);
        let storage = self.storage(ty);
        let init = self.default_init(ty);
        let span = self.pou(program).span;
        let tag = self.add_tag(name, storage, hir::View::Number, init, Some(span));
        self.tag_names.insert(name.to_ascii_lowercase());
        self.program_tags.entry(program).or_default().push(tag);
        tag
    }

    /// The name of a new tag; one that is taken, as by a variable of another namespace, gets a number.
    pub(crate) fn free_tag_name(&mut self, name: String) -> String {
        let (mut free, mut number) = (name.clone(), 2);
        while !self.tag_names.insert(free.to_ascii_lowercase()) {
            free = format!("{name}'{number}");
            number += 1;
        }
        free
    }

    /// The instance that the name of a program stands for (CODESYS): the one that a task runs, or one
    /// made for it. `None` if there are several.
    pub(crate) fn named_program(&mut self, program: PouId) -> Option<TagId> {
        match self.program_tags.get(&program).map(Vec::as_slice) {
            Some([tag]) => Some(*tag),
            Some([_, ..]) => None,
            Some([]) | None => {
                let name = self.text(self.pou(program).name).to_owned();
                let name = self.free_tag_name(name);
                let tag = self.program_instance(program, &name);
                self.check_places(program, tag, &name, &[]);
                Some(tag)
            }
        }
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
    pub(crate) fn public_points(
        &mut self,
        program: PouId,
        tag: TagId,
        connected: &[iecc_ast::Symbol],
    ) {
        for var in self.pou(program).vars.clone() {
            let Storage::Field(field) = var.storage else {
                continue;
            };
            let place = Place::whole(tag).step(Step::Field(field));
            let name = self.text(var.name).to_owned();
            match var.section.direction() {
                // Only its method sees it.
                _ if name.contains('.') => {}
                // What sets it is its source; the name is free for another thing.
                _ if connected.contains(&var.name) => {}
                _ if var.partly.is_some() => self.hir.names.push((name, place)),
                Some(Direction::In) => self.points(&name, place.clone(), var.ty, true),
                Some(Direction::Out) => self.points(&name, place.clone(), var.ty, false),
                Some(Direction::InOut) | None => self.hir.names.push((name, place)),
            }
        }
    }

    /// A point for every number of a variable.
    pub(crate) fn points(&mut self, name: &str, place: Place, ty: TypeId, input: bool) {
        let points = if input {
            &mut self.hir.inputs
        } else {
            &mut self.hir.outputs
        };
        let whole = self.types.is_scalar(ty) || self.types.is_text(ty);
        if whole {
            // Whoever has more is told so.
            if points.len() > MAX_POINTS {
                return;
            }
            points.push(IoPoint {
                name: name.to_owned(),
                place,
            });
            return;
        }
        match self.types.parts(ty) {
            Parts::Elements {
                dimensions,
                element,
            } => {
                let dimensions = dimensions.to_vec();
                self.array_points(name, place, &dimensions, element, input, String::new());
            }
            Parts::Members(def) => {
                if let Some(overlay) = &def.overlay {
                    let last = i64::from(overlay.bytes) - 1;
                    let byte = TypeId::of(super::elementary::El::Byte);
                    self.array_points(name, place, &[(0, last)], byte, input, String::new());
                    return;
                }
                let members = def.members.clone();
                for (position, member) in (0..).zip(members) {
                    let name = format!("{name}.{}", self.text(member.name));
                    let place = place.clone().step(Step::Field(position));
                    self.points(&name, place, member.ty, input);
                }
            }
            Parts::Variables(_) | Parts::None => {}
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
}
