//! Turns the typed program into the IR.
//!
//! * Every routine becomes one function, `@"Program/Routine"`; the rung condition is an SSA value.
//!   Instructions run strictly from left to right; every leg of a branch runs; nothing is skipped
//!   because its result cannot matter.
//! * The state mirrors the tags, I/O words included. The scan function copies inputs into these
//!   words, calls the main routines in order, and copies the words to the outputs.
//! * Timers and counters are library functions, linked here.
//! * Bodies in text become one function each, by the name of the unit; their errors are tested for
//!   under the policy of [`OnFault`].
//! * Tasks run in one scan function, see [`tasks`].
//! * `prescan` walks every routine once and does what the instruction table says.
//!
//! Lowering decides nothing about meaning and cannot fail on a program without errors.

mod initial;
mod ladder;
mod library;
mod scan;
mod tasks;
mod text;
mod types;
mod values;

use cranelift_entity::PrimaryMap;
use iecc_ir::{FieldDef, FuncId, Function, MemType, Module, Origin, OriginData, Place, Type, View};
use iecc_sema::hir;
use iecc_source::Span;
use library::Library;
use std::collections::BTreeSet;
use std::sync::Arc;
use types::TypeMap;

/// One millisecond, the unit of Logix timers.
pub const MILLISECOND_NS: u64 = 1_000_000;

/// Passes that a loop of a body in text may take, unless said otherwise.
pub const LOOP_LIMIT: u64 = 10_000_000;

/// What an error of a body in text does, such as an index out of bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnFault {
    /// Abandons the scan.
    #[default]
    Trap,
    /// Sets bit n-1 of the `USINT` `__status` in the state, n being the number of the fault, and goes on
    /// with a value that is defined for every error. The bits stay set.
    Continue,
}

/// Choices of the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Options {
    /// Unit of all timers but those below, in nanoseconds.
    pub timer_unit_ns: u64,
    /// Timers with a unit of their own.
    pub timer_units: Vec<(hir::Place, u64)>,
    /// What errors of bodies in text do.
    pub on_fault: OnFault,
    /// Passes that each entry of a loop of a body in text may take.
    pub loop_limit: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            timer_unit_ns: MILLISECOND_NS,
            timer_units: Vec::new(),
            on_fault: OnFault::default(),
            loop_limit: LOOP_LIMIT,
        }
    }
}

/// Lowers a program that has no errors.
pub fn lower(program: &hir::Program, options: &Options) -> Module {
    let mut types = TypeMap::new(program);
    let mut fields = types.tag_fields();
    let tasks = tasks::add_state(program, &mut types, &mut fields);
    let status = status(program, options, &mut fields);
    let state = types.state_struct(fields);
    let input = types.io_struct("input", &program.inputs);
    let output = types.io_struct("output", &program.outputs);
    let mut lowering = Lowering {
        program,
        options,
        status,
        funcs: PrimaryMap::new(),
        origins: PrimaryMap::new(),
        stdlib: Library::new(program),
        types,
    };
    lowering.declare_units();
    for (index, pou) in program.pous.iter().enumerate() {
        let function = match &pou.body {
            hir::Body::Ladder(rungs) => ladder::unit(&mut lowering, pou, rungs),
            hir::Body::Text(code) => text::unit(&mut lowering, pou, code),
        };
        lowering.funcs[FuncId::from_u32(index as u32)] = function;
    }
    let scan = scan::scan(&mut lowering, &tasks);
    let scan = lowering.funcs.push(scan);
    let prescan = scan::prescan(&mut lowering);
    let prescan = lowering.funcs.push(prescan);
    Module {
        name: program.name.clone(),
        image: initial::image(program, &lowering.types, state),
        types: lowering.types.into_table(),
        state,
        input,
        output,
        funcs: lowering.funcs,
        scan,
        prescan: Some(prescan),
        names: names(program, &tasks),
        origins: lowering.origins,
    }
}

/// Adds the status to the state, where errors of bodies in text do not stop.
fn status(program: &hir::Program, options: &Options, fields: &mut Vec<FieldDef>) -> Option<u32> {
    let is_text = |pou: &hir::Pou| matches!(pou.body, hir::Body::Text(_));
    if options.on_fault == OnFault::Trap || !program.pous.iter().any(is_text) {
        return None;
    }
    let taken = |name: &str| fields.iter().any(|field| field.name == name);
    let name = fresh("__status", taken);
    let ty = MemType::Scalar(Type::I8);
    fields.push(FieldDef::new(name, ty).with_view(View::Bits));
    Some(fields.len() as u32 - 1)
}

/// A place of the program in the state of its module.
pub fn state_place(place: &hir::Place) -> Place {
    types::place(place)
}

/// A name of our own beside those of the user.
fn fresh(name: &str, taken: impl Fn(&str) -> bool) -> String {
    let mut name = name.to_owned();
    while taken(&name) {
        name.push('\'');
    }
    name
}

/// What is built while functions are lowered.
struct Lowering<'p> {
    program: &'p hir::Program,
    options: &'p Options,
    /// The field of the state that says which errors there were.
    status: Option<u32>,
    funcs: PrimaryMap<FuncId, Function>,
    origins: PrimaryMap<Origin, OriginData>,
    stdlib: Library,
    types: TypeMap<'p>,
}

impl Lowering<'_> {
    /// Ids of units are those of the program, so that calls may stand before the callee.
    fn declare_units(&mut self) {
        for pou in &self.program.pous {
            self.funcs.push(Function::new(pou.name.clone(), Vec::new()));
        }
    }

    fn origin(&mut self, label: &str, span: Option<Span>) -> Origin {
        self.shared_origin(&Arc::from(label), span)
    }

    fn shared_origin(&mut self, label: &Arc<str>, span: Option<Span>) -> Origin {
        self.origins.push(OriginData {
            label: Arc::clone(label),
            span,
        })
    }

    /// A name for a function of our own.
    fn fresh_function(&self, name: &str) -> String {
        fresh(name, |name| {
            self.funcs.values().any(|func| func.name == name)
        })
    }

    /// A library function, linked on first use.
    fn stdlib_function(&mut self, name: &str, unit_ns: u64) -> FuncId {
        self.stdlib
            .link(name, unit_ns, &mut self.funcs, &mut self.types)
    }

    fn timer_unit_ns(&self, timer: &hir::Place) -> u64 {
        let own = self.options.timer_units.iter();
        let own = own.rev().find(|(place, _)| place == timer);
        own.map_or(self.options.timer_unit_ns, |(_, unit)| *unit)
    }
}

/// Names for places: those of the program, then ours where they are free.
fn names(program: &hir::Program, tasks: &tasks::TaskState) -> Vec<(String, Place)> {
    let own = program.names.iter();
    let mut names: Vec<(String, Place)> = own
        .map(|(name, place)| (name.clone(), types::place(place)))
        .collect();
    let ours = tasks::names(program, tasks);
    if ours.is_empty() {
        return names;
    }
    let tags = program.tags.iter().map(|tag| &tag.name);
    let taken: BTreeSet<String> = tags
        .chain(names.iter().map(|(name, _)| name))
        .map(|name| name.to_ascii_lowercase())
        .collect();
    let is_free = |name: &str| !taken.contains(&name.to_ascii_lowercase());
    names.extend(ours.into_iter().filter(|(name, _)| is_free(name)));
    names.sort_by_key(|(name, _)| name.to_ascii_lowercase());
    names
}
