//! Turns the typed program into the IR.
//!
//! * Every routine becomes one function, `@"Program/Routine"`; the rung condition is an SSA value.
//!   Instructions run strictly from left to right; every leg of a branch runs; nothing is skipped
//!   because its result cannot matter.
//! * The state mirrors the tags, I/O words included. The scan function copies inputs into these
//!   words, calls the main routines in order, and copies the words to the outputs.
//! * Timers and counters are library functions in the text form of the IR, linked here.
//! * `prescan` walks every routine once and does what the instruction table says.
//!
//! Lowering decides nothing about meaning and cannot fail on a program without errors.

mod ladder;
mod library;
mod scan;
mod text;
mod types;
mod values;

use cranelift_entity::PrimaryMap;
use iecc_ir::{FuncId, Function, Image, Layout, Module, Origin, OriginData, Place};
use iecc_sema::hir;
use iecc_source::Span;
use library::Library;
use types::TypeMap;

/// One millisecond, the unit of Logix timers.
pub const MILLISECOND_NS: u64 = 1_000_000;

/// Choices that change how timers count.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Options {
    /// Unit of all timers but those below, in nanoseconds.
    pub timer_unit_ns: u64,
    /// Timers with a unit of their own.
    pub timer_units: Vec<(hir::Place, u64)>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            timer_unit_ns: MILLISECOND_NS,
            timer_units: Vec::new(),
        }
    }
}

/// Lowers a program that has no errors.
pub fn lower(program: &hir::Program, options: &Options) -> Module {
    let mut types = TypeMap::new(program);
    let state = types.state_struct();
    let input = types.io_struct("input", &program.inputs);
    let output = types.io_struct("output", &program.outputs);
    let mut lowering = Lowering {
        program,
        options,
        funcs: PrimaryMap::new(),
        origins: PrimaryMap::new(),
        library: Library::new(),
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
    let scan = scan::scan(&mut lowering);
    let prescan = scan::prescan(&mut lowering);
    let scan = lowering.funcs.push(scan);
    let prescan = lowering.funcs.push(prescan);
    let layout = Layout::new(lowering.types.table());
    let mut image = Image::zero(&layout, lowering.types.table(), state);
    for (place, bits) in initial_leaves(program) {
        image.set_place(&layout, lowering.types.table(), state, &place, bits);
    }
    Module {
        name: program.name.clone(),
        types: lowering.types.into_table(),
        state,
        input,
        output,
        image,
        funcs: lowering.funcs,
        scan,
        prescan: Some(prescan),
        names: names(program),
        origins: lowering.origins,
    }
}

/// What is built while functions are lowered.
struct Lowering<'p> {
    program: &'p hir::Program,
    options: &'p Options,
    funcs: PrimaryMap<FuncId, Function>,
    origins: PrimaryMap<Origin, OriginData>,
    library: Library,
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
        self.origins.push(OriginData {
            label: label.to_owned(),
            span,
        })
    }

    /// A library function, linked on first use.
    fn library(&mut self, name: &str, unit_ns: u64) -> FuncId {
        self.library
            .link(name, unit_ns, &mut self.funcs, &mut self.types)
    }

    fn timer_unit_ns(&self, timer: &hir::Place) -> u64 {
        let own = self.options.timer_units.iter();
        let own = own.rev().find(|(place, _)| place == timer);
        own.map_or(self.options.timer_unit_ns, |(_, unit)| *unit)
    }
}

fn initial_leaves(program: &hir::Program) -> impl Iterator<Item = (Place, u64)> + '_ {
    program.tags.iter().enumerate().flat_map(|(index, tag)| {
        tag.initial.iter().map(move |(path, bits)| {
            let place = hir::Place {
                tag: hir::TagId::from_index(index),
                path: path.clone(),
            };
            (types::place(&place), *bits)
        })
    })
}

fn names(program: &hir::Program) -> Vec<(String, Place)> {
    let names = program.names.iter();
    names
        .map(|(name, place)| (name.clone(), types::place(place)))
        .collect()
}
