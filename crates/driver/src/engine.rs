//! Every engine that can run a program, behind one door.

use crate::build::hardware_passes;
use crate::pipeline::Pipeline;
use crate::refusal;
use crate::sim::{SimError, VerilogSim};
use iecc_diag::{Code, Diagnostic};
use iecc_interp::Interpreter;
use iecc_ir::{Module, Verified, verify};
use iecc_jit::Jit;
use iecc_passes::Settings;
use iecc_target::Engine;
use iecc_verilog::{Clock, Options};

/// What executes the scans.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineKind {
    /// The reference interpreter, on the module as lowered: the definition of what it means.
    Interp,
    /// The interpreter behind the passes for software: what the JIT is given.
    InterpSoftware,
    /// The interpreter behind the passes for hardware: what the Verilog back end is given.
    InterpHardware,
    /// Machine code of this computer, of the module as lowered.
    JitPlain,
    /// Machine code of this computer.
    Jit,
    /// The hardware that the Verilog back end makes, in a simulator.
    Verilog,
}

impl EngineKind {
    /// All of them, the definition first.
    pub const ALL: [Self; 6] = [
        Self::Interp,
        Self::InterpSoftware,
        Self::InterpHardware,
        Self::JitPlain,
        Self::Jit,
        Self::Verilog,
    ];

    /// What it is, in a few words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Interp => "interpreter",
            Self::InterpSoftware => "interpreter after the passes for software",
            Self::InterpHardware => "interpreter after the passes for hardware",
            Self::JitPlain => "machine code without passes",
            Self::Jit => "machine code",
            Self::Verilog => "simulated Verilog",
        }
    }

    /// Makes a module ready to run, in the state of its image, with a scan every `period_ns`; other
    /// engines than hardware take scans that come sooner as well.
    ///
    /// # Errors
    /// All reasons why the engine cannot run it.
    pub fn start(
        self,
        module: &Module,
        period_ns: u64,
    ) -> Result<Box<dyn Engine>, Vec<Diagnostic>> {
        match self {
            Self::Interp => Ok(interpret(module)),
            Self::InterpSoftware => Ok(interpret(&for_software(module))),
            Self::InterpHardware => {
                let mut module = module.clone();
                hardware_passes(&mut module, clock(period_ns));
                Ok(interpret(&module))
            }
            Self::JitPlain => translate(module),
            Self::Jit => translate(&for_software(module)),
            Self::Verilog => simulate(module, period_ns),
        }
    }
}

pub(crate) fn for_software(module: &Module) -> Module {
    let mut module = module.clone();
    Pipeline::Software.run(&mut module, &Settings::default());
    module
}

fn clock(period_ns: u64) -> Clock {
    Clock::period_ns(period_ns.max(1)).expect("a period of at least 1 ns")
}

fn interpret(module: &Module) -> Box<dyn Engine> {
    Box::new(Interpreter::new(verified(module)))
}

fn translate(module: &Module) -> Result<Box<dyn Engine>, Vec<Diagnostic>> {
    match Jit::new(verified(module)) {
        Ok(jit) => Ok(Box::new(jit)),
        Err(errors) => Err(refusal::to_diagnostics(module, &errors)),
    }
}

fn simulate(module: &Module, period_ns: u64) -> Result<Box<dyn Engine>, Vec<Diagnostic>> {
    let mut module = module.clone();
    let clock = clock(period_ns);
    let ranges = hardware_passes(&mut module, clock);
    let cannot = |error: SimError| match error {
        SimError::Refused(errors) => refusal::to_diagnostics(&module, &errors),
        SimError::Compile(text) => panic!("the simulator refuses the module:\n{text}"),
        error @ (SimError::Period | SimError::Io(..)) => {
            vec![Diagnostic::without_place(Code::E7009, error.to_string())]
        }
    };
    let options = Options {
        ranges,
        ..Options::new(clock)
    };
    match VerilogSim::start(verified(&module), &options, period_ns) {
        Ok(simulator) => Ok(Box::new(simulator)),
        Err(error) => Err(cannot(error)),
    }
}

/// What lowering and passes give keeps the rules of the IR.
pub(crate) fn verified(module: &Module) -> Verified<'_> {
    verify(module).unwrap_or_else(|errors| panic!("the compiler broke a rule: {}", errors[0]))
}
