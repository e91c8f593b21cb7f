//! Every engine that can run a program, behind one door.

use crate::pipeline::Pipeline;
use crate::refusal;
use iecc_diag::Diagnostic;
use iecc_interp::Interpreter;
use iecc_ir::{Module, Verified, verify};
use iecc_jit::Jit;
use iecc_passes::Settings;
use iecc_target::Engine;

/// What executes the scans.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineKind {
    /// The reference interpreter, on the module as lowered: the definition of what it means.
    Interp,
    /// Machine code of this computer.
    Jit,
}

impl EngineKind {
    /// Makes a module ready to run, in the state of its image.
    ///
    /// # Errors
    /// All reasons why the engine cannot run it.
    pub fn start(self, module: &Module) -> Result<Box<dyn Engine>, Vec<Diagnostic>> {
        match self {
            Self::Interp => Ok(Box::new(Interpreter::new(verified(module)))),
            Self::Jit => {
                let mut module = module.clone();
                Pipeline::Software.run(&mut module, &Settings::default());
                let jit = Jit::new(verified(&module));
                let jit = jit.map_err(|errors| refusal::to_diagnostics(&module, &errors))?;
                Ok(Box::new(jit))
            }
        }
    }
}

/// What lowering and passes give keeps the rules of the IR.
pub(crate) fn verified(module: &Module) -> Verified<'_> {
    verify(module).unwrap_or_else(|errors| panic!("the compiler broke a rule: {}", errors[0]))
}
