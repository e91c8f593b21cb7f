//! Random programs in Structured Text that the compiler has to accept: well-typed by construction, and every
//! loop ends after a few passes.
//!
//! They hold all elementary types and conversions between them, strings, arrays, structures,
//! enumerations, subranges, references; functions with outputs and in-outs, blocks with state and
//! methods, an interface with two classes behind it, blocks of the library; every statement.
//! Errors of the running program are seldom, but possible: divisors of 0, subscripts out of bounds,
//! values outside of subranges, NULL.
//!
//! A seed and options always give the same program.

mod calls;
mod draft;
mod literals;
mod program;
mod run;
mod scope;
mod signatures;
mod statements;
mod types;
mod units;
mod values;

pub use draft::Draft;
pub use run::{Outcome, check, check_seed, policy};

use crate::rng::Rng;
use scope::Route;
use signatures::{Signature, Unit, standard_blocks, standard_functions};
use types::{Elementary, Type, Types};

/// What a program may contain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Statements of the program, from so many to twice as many.
    pub statements: usize,
    /// Functions at most.
    pub functions: usize,
    /// Blocks at most.
    pub blocks: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            statements: 8,
            functions: 3,
            blocks: 2,
        }
    }
}

/// The program of a seed.
pub fn random_program(seed: u64, options: Options) -> Draft {
    let rng = &mut Rng::new(seed);
    let mut types = Types::default();
    let units = standard_blocks(&mut types);
    let mut generator = Generator {
        standard: units.len(),
        rng,
        options,
        draft: Draft::default(),
        types,
        units,
        functions: standard_functions(),
        stdlib_functions: standard_functions().len(),
        constants: Vec::new(),
        routes: Vec::new(),
        counters: Vec::new(),
        left: 0,
        cost: 0,
        turns: 1,
        loops: 0,
        nested: 0,
    };
    generator.write();
    generator.draft
}

/// A program being written.
struct Generator<'r> {
    rng: &'r mut Rng,
    options: Options,
    draft: Draft,
    types: Types,
    /// Blocks, classes and interfaces, the first ones of the library.
    units: Vec<Unit>,
    standard: usize,
    /// Functions, the first ones of the library.
    functions: Vec<Signature>,
    stdlib_functions: usize,
    /// Named constants of the present unit.
    constants: Vec<(String, Type)>,
    // The rest is about the present body.
    routes: Vec<Route>,
    /// Variables that no loop around counts in.
    counters: Vec<(String, Elementary)>,
    /// Statements still to be written.
    left: usize,
    /// Statements that are executed at most so far, and how often the present one is.
    cost: u64,
    turns: u64,
    /// Loops around the present statement.
    loops: u32,
    /// Subscripts and calls around the present expression.
    nested: u32,
}

impl Generator<'_> {
    fn write(&mut self) {
        self.types_section();
        for index in 0..self.rng.below(self.options.functions + 1) {
            self.function(index);
        }
        for index in 0..self.rng.below(self.options.blocks + 1) {
            self.block_unit(index);
        }
        if self.rng.one_in(3) {
            self.relatives();
        }
        self.programs();
    }
}
