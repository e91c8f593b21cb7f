//! Runs the unit tests of a program: one module for all of them, or for many, one scan for each, every one
//! from the state at the start.

mod junit;
mod parts;
mod verdict;

pub use iecc_sema::st::testing::Test;
pub use junit::junit;

use crate::engine::{for_software, verified};
use crate::refusal;
use crate::run::{Probe, Probes};
use crate::{FrontOptions, Sources};
use iecc_diag::{Diagnostic, Diagnostics};
use iecc_interp::Interpreter;
use iecc_ir::{Module, Region};
use iecc_jit::Jit;
use iecc_sema::st::testing::Suite;
use iecc_source::SourceMap;
use iecc_target::{Engine, Fault, region_bytes};
use parts::Part;
use std::time::{Duration, Instant};

/// What executes tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TestEngine {
    /// The reference interpreter.
    Interp,
    /// Machine code of this computer.
    Jit,
}

/// The tests of a program, compiled.
#[derive(Debug, Clone)]
pub struct TestProgram {
    parts: Vec<Part>,
    suite: Suite,
}

impl TestProgram {
    /// Compiles all tests of some sources; `None` after mistakes.
    pub fn compile(
        map: &SourceMap,
        sources: &Sources,
        options: &FrontOptions,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        let (parts, suite) = parts::compile(map, sources, options, diagnostics)?;
        Some(Self { parts, suite })
    }

    /// The tests, by file and in their order.
    pub fn tests(&self) -> &[Test] {
        &self.suite.tests
    }

    /// The positions of the tests whose `file: title` holds a text, ignoring case.
    pub fn matching(&self, map: &SourceMap, text: &str) -> Vec<usize> {
        let text = text.to_lowercase();
        let fits = |test: &Test| {
            let name = format!("{}: {}", map.file(test.file).name(), test.title);
            name.to_lowercase().contains(&text)
        };
        let tests = self.suite.tests.iter().enumerate();
        tests
            .filter(|(_, test)| fits(test))
            .map(|(position, _)| position)
            .collect()
    }

    /// Makes the tests ready to run on an engine.
    pub fn start(&self, engine: TestEngine) -> TestRun<'_> {
        TestRun {
            program: self,
            engine,
            prepared: None,
        }
    }

    /// The outputs that tell what failed.
    fn outputs(&self) -> Vec<String> {
        let shown = self.suite.checks.iter().flat_map(|check| &check.operands);
        let mut outputs: Vec<String> = shown.map(|shown| shown.output.clone()).collect();
        outputs.sort();
        outputs.dedup();
        outputs.insert(0, Suite::FAILED.to_owned());
        outputs
    }
}

/// Tests that are ready to run.
#[derive(Debug)]
pub struct TestRun<'p> {
    program: &'p TestProgram,
    engine: TestEngine,
    /// The part that ran last, by position.
    prepared: Option<(usize, Prepared)>,
}

/// What became of a test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TestResult {
    /// Its position among the tests of the program.
    pub position: usize,
    /// Why it did not pass.
    pub failure: Option<Failure>,
    /// How long it took.
    pub time: Duration,
}

/// Why a test did not pass.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Whether a fault ended it; else an assertion did not hold.
    pub fault: bool,
    /// The message.
    pub diagnostic: Diagnostic,
}

impl TestRun<'_> {
    /// Runs a test.
    ///
    /// # Errors
    /// All reasons why the engine cannot run it.
    ///
    /// # Panics
    /// If there is no test at the position.
    pub fn run(&mut self, position: usize) -> Result<TestResult, Vec<Diagnostic>> {
        let part = self.part_of(position);
        let prepared = match self.prepared.take() {
            Some((known, prepared)) if known == part => prepared,
            Some(_) | None => Prepared::new(self.program, part, self.engine)?,
        };
        let (_, prepared) = self.prepared.insert((part, prepared));
        Ok(prepared.result(&self.program.suite, position))
    }

    fn part_of(&self, position: usize) -> usize {
        let mut parts = self.program.parts.iter();
        let part = parts.position(|part| part.tests.contains(&position));
        part.expect("every test is in a part")
    }
}

/// An engine with all that its scans need.
#[derive(Debug)]
struct Prepared {
    machine: Machine,
    /// The state before every test.
    start: Vec<u8>,
    inputs: Vec<u8>,
    outputs: Vec<u8>,
    probes: Probes,
    module: Module,
}

impl Prepared {
    fn new(
        program: &TestProgram,
        part: usize,
        engine: TestEngine,
    ) -> Result<Self, Vec<Diagnostic>> {
        let mut module = program.parts[part].module.clone();
        let seen = program.outputs();
        let probes = Probes::open(&mut module, &[Suite::CHOICE.to_owned()], &seen)?;
        let machine = Machine::new(&module, engine)?;
        Ok(Self {
            start: machine.state().to_vec(),
            inputs: region_bytes(&module, Region::Input),
            outputs: region_bytes(&module, Region::Output),
            machine,
            probes,
            module,
        })
    }

    #[expect(
        clippy::disallowed_methods,
        reason = "people want to know how long tests take"
    )]
    fn result(&mut self, suite: &Suite, position: usize) -> TestResult {
        let test = &suite.tests[position];
        let begin = Instant::now();
        let ended = self.run(position);
        let time = begin.elapsed();
        let failure = match ended {
            Ok(()) => self.failed_check().map(|number| Failure {
                fault: false,
                diagnostic: self.assertion(suite, number, test),
            }),
            Err(fault) => Some(Failure {
                fault: true,
                diagnostic: verdict::fault(&self.module, test, fault),
            }),
        };
        TestResult {
            position,
            failure,
            time,
        }
    }

    fn run(&mut self, position: usize) -> Result<(), Fault> {
        self.machine.set_state(&self.start);
        self.probes.set[0].set(&mut self.inputs, &[position as u64 + 1]);
        self.machine
            .engine()
            .step(0, &self.inputs, &mut self.outputs)
    }

    /// The position of the check that failed, if one did.
    fn failed_check(&self) -> Option<usize> {
        let number = self.value(&self.probes.seen[0])[0];
        usize::try_from(number).ok()?.checked_sub(1)
    }

    fn value(&self, probe: &Probe) -> Vec<u64> {
        probe.get(&self.inputs, &self.outputs)
    }

    fn assertion(&self, suite: &Suite, number: usize, test: &Test) -> Diagnostic {
        let check = &suite.checks[number];
        let operands = check.operands.iter().map(|shown| {
            let mut probes = self.probes.seen.iter();
            let probe = probes.find(|probe| probe.path == shown.output);
            let probe = probe.expect("every operand is an output");
            verdict::shown(&self.value(probe), probe, &shown.form)
        });
        let operands: Vec<String> = operands.collect();
        verdict::assertion(check, test, &operands)
    }
}

/// An engine whose state can be set back.
#[derive(Debug)]
enum Machine {
    Interp(Box<Interpreter>),
    Jit(Box<Jit>),
}

impl Machine {
    fn new(module: &Module, engine: TestEngine) -> Result<Self, Vec<Diagnostic>> {
        match engine {
            TestEngine::Interp => {
                let interpreter = Interpreter::new(verified(module));
                Ok(Self::Interp(Box::new(interpreter)))
            }
            TestEngine::Jit => {
                let module = for_software(module);
                let jit = Jit::new(verified(&module));
                jit.map(|jit| Self::Jit(Box::new(jit)))
                    .map_err(|errors| refusal::to_diagnostics(&module, &errors))
            }
        }
    }

    fn engine(&mut self) -> &mut dyn Engine {
        match self {
            Self::Interp(interpreter) => interpreter.as_mut(),
            Self::Jit(jit) => jit.as_mut(),
        }
    }

    fn state(&self) -> &[u8] {
        match self {
            Self::Interp(interpreter) => interpreter.state(),
            Self::Jit(jit) => jit.state(),
        }
    }

    fn set_state(&mut self, state: &[u8]) {
        match self {
            Self::Interp(interpreter) => interpreter.set_state(state),
            Self::Jit(jit) => jit.set_state(state),
        }
    }
}
