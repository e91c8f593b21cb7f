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
    /// Machine code of this computer.
    Jit,
    /// The hardware that the Verilog back end makes, in a simulator.
    Verilog,
}

impl EngineKind {
    /// Makes a module ready to run, in the state of its image, with a scan every `period_ns`.
    ///
    /// # Errors
    /// All reasons why the engine cannot run it.
    pub fn start(
        self,
        module: &Module,
        period_ns: u64,
    ) -> Result<Box<dyn Engine>, Vec<Diagnostic>> {
        match self {
            Self::Interp => Ok(Box::new(Interpreter::new(verified(module)))),
            Self::Jit => {
                let mut module = module.clone();
                Pipeline::Software.run(&mut module, &Settings::default());
                let jit = Jit::new(verified(&module));
                let jit = jit.map_err(|errors| refusal::to_diagnostics(&module, &errors))?;
                Ok(Box::new(jit))
            }
            Self::Verilog => simulate(module, period_ns),
        }
    }
}

fn simulate(module: &Module, period_ns: u64) -> Result<Box<dyn Engine>, Vec<Diagnostic>> {
    let mut module = module.clone();
    let clock = Clock::period_ns(period_ns.max(1)).expect("a period of at least 1 ns");
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
