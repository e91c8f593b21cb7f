//! Verified IR in, synthesisable Verilog-2005 out: one scan of the program in every clock.
//!
//! * **In:** a module whose scan function is one block with static places, no calls, floats,
//!   absolute time or varying divisors. Anything else is refused with all reasons ([`Target`]).
//! * **Out:** the module, the tick dividers it needs, a testbench, a report, and for a board the
//!   pins and the project.
//! * **Meaning:** register contents after a clock are the state after the scan; outputs are registers,
//!   so an input reaches an output in one clock edge, three with synchronisers.
//!
//! Phases: `check` refuses; `facts` finds widths; `scan` (with `relate` and `divide`) makes a
//! `net`list through the constructors of `build`; `design` keeps what reaches an output; `emit` writes.
//!
//! Absent on purpose: signed declarations, `/`, `%`, latches, `x`, derived clocks, any IO.

mod board;
mod build;
mod check;
mod clock;
mod design;
mod divide;
mod emit;
mod facts;
mod names;
mod net;
mod options;
mod relate;
mod report;
mod scan;

pub use board::{Board, PinFileError};
pub use clock::{Clock, max_step};
pub use names::place_text;
pub use options::Options;

use design::{Design, design};
use emit::module::ModuleText;
use iecc_ir::{Type, Verified};
use iecc_target::{Artifact, Target, TargetError};

/// The Verilog target.
#[derive(Debug, Clone, Copy, Default)]
pub struct Verilog;

impl Target for Verilog {
    type Options = Options;

    fn compile(
        &self,
        module: Verified<'_>,
        options: &Options,
    ) -> Result<Vec<Artifact>, Vec<TargetError>> {
        let (design, text) = hardware(module, options)?;
        let mut files = sources(&text);
        let name = text.name.clone();
        if let Some(board) = &options.board {
            let assignment = board::assign(board, &design)?;
            files.extend(board::files(board, &assignment, &design, &text));
        }
        files.push(Artifact::text(
            format!("{name}_tb.v"),
            emit::testbench::emit(&design, &text, options),
        ));
        files.push(Artifact::text(
            format!("{name}_stimulus.hex"),
            emit::testbench::stimulus(&design, options),
        ));
        let (words, json) = report::report(&design, &text, options);
        files.push(Artifact::text(format!("{name}.report.txt"), words));
        files.push(Artifact::text(format!("{name}.report.json"), json));
        Ok(files)
    }
}

/// The module for a simulator, and how to talk to it.
#[derive(Debug, Clone)]
pub struct Simulation {
    /// Every file to compile.
    pub files: Vec<Artifact>,
    /// The module to elaborate.
    pub top: String,
    inputs: Vec<(usize, Type)>,
    outputs: Vec<(usize, Type)>,
}

impl Simulation {
    /// The line to send for one scan, without its end.
    pub fn encode(&self, inputs: &[u8]) -> String {
        emit::simulator::encode(&self.inputs, inputs)
    }

    /// Fills the output region from the line received; `None` if it is not a line of known bits.
    pub fn decode(&self, line: &str, outputs: &mut [u8]) -> Option<()> {
        emit::simulator::decode(&self.outputs, line, outputs)
    }
}

/// Makes the module ready for a simulator that runs one scan for each line of inputs.
///
/// # Errors
/// All reasons why the program cannot be expressed.
pub fn simulation(module: Verified<'_>, options: &Options) -> Result<Simulation, Vec<TargetError>> {
    let mut options = options.clone();
    options.synchronisers = false;
    let (design, text) = hardware(module, &options)?;
    let mut files = sources(&text);
    let top = emit::simulator::HARNESS.to_owned();
    let harness = emit::simulator::emit(&design, &text);
    files.push(Artifact::text(format!("{top}.v"), harness));
    let fields = |port: &design::Port| (port.offset as usize, port.ty);
    Ok(Simulation {
        files,
        top,
        inputs: design.inputs.iter().map(|i| fields(&i.port)).collect(),
        outputs: design.outputs.iter().map(|o| fields(&o.port)).collect(),
    })
}

fn hardware(
    module: Verified<'_>,
    options: &Options,
) -> Result<(Design, ModuleText), Vec<TargetError>> {
    let errors = check::check(&module, options);
    if !errors.is_empty() {
        return Err(errors);
    }
    let design = design(&module, options);
    let text = emit::module::emit(&module, &design, options);
    Ok((design, text))
}

/// The module and its runtime.
fn sources(text: &ModuleText) -> Vec<Artifact> {
    let own = Artifact::text(format!("{}.v", text.name), text.text.clone());
    let runtime = text
        .runtime
        .iter()
        .map(|&(name, text)| Artifact::text(name, text));
    std::iter::once(own).chain(runtime).collect()
}
