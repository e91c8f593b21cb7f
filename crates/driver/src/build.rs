//! Builds hardware: passes, then the Verilog back end.

use crate::engine::verified;
use crate::pipeline::Pipeline;
use crate::refusal;
use iecc_diag::{Code, Diagnostic};
use iecc_ir::Module;
use iecc_ir::analysis::Ranges;
use iecc_passes::{Settings, ranges, ranges_given};
use iecc_target::{Artifact, Target};
use iecc_verilog::{Board, Clock, Options, Verilog, max_step};

/// The clock of hardware for no board, in hertz.
const USUAL_CLOCK_HZ: u64 = 50_000_000;

/// What the user asks of the hardware.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VerilogRequest {
    /// Frequency of the clock; that of the board, else 50 MHz, if `None`. One scan runs in every
    /// clock.
    pub clock_hz: Option<u64>,
    /// The base tick that coarser units of time are counted from; the finest unit in use if `None`.
    pub tick_ns: Option<u64>,
    /// A board that the compiler knows.
    pub board: Option<String>,
    /// The text of a pin file for the board.
    pub pins: Option<String>,
}

/// The files of a program as hardware.
///
/// # Errors
/// All reasons why it cannot be hardware.
pub fn build_verilog(
    mut module: Module,
    request: &VerilogRequest,
) -> Result<Vec<Artifact>, Vec<Diagnostic>> {
    let board = request.board().map_err(|message| vec![option(message)])?;
    let clock = request.clock(board.as_ref());
    let clock = clock.ok_or_else(|| vec![option("the frequency of the clock is 0".to_owned())])?;
    let options = Options {
        tick_ns: request.tick_ns,
        ranges: hardware_passes(&mut module, clock),
        board,
        ..Options::new(clock)
    };
    let files = Verilog.compile(verified(&module), &options);
    files.map_err(|errors| refusal::to_diagnostics(&module, &errors))
}

/// Runs the passes for hardware, which may rely on a scan in every clock, and says what the values
/// of the result can be. The state is bounded before the passes that hide why it is.
pub(crate) fn hardware_passes(module: &mut Module, clock: Clock) -> Ranges {
    let settings = Settings {
        longest_period_ns: Some(max_step(clock, 1)),
    };
    let steps = |unit_ns| max_step(clock, unit_ns);
    Pipeline::Hardware.run(module, &settings);
    let known = ranges(module, &steps);
    Pipeline::HardwareSpeed.run(module, &settings);
    ranges_given(module, &known, &steps)
}

impl VerilogRequest {
    fn board(&self) -> Result<Option<Board>, String> {
        let Some(name) = &self.board else {
            return match self.pins {
                None => Ok(None),
                Some(_) => Err("pins need a board".to_owned()),
            };
        };
        let board = Board::named(name).ok_or_else(|| {
            let names: Vec<_> = Board::names().collect();
            format!("there is no board `{name}`, but {}", names.join(", "))
        })?;
        match &self.pins {
            None => Ok(Some(board)),
            Some(pins) => match board.with_pins(pins) {
                Ok(board) => Ok(Some(board)),
                Err(error) => Err(format!("the pin file: {error}")),
            },
        }
    }

    fn clock(&self, board: Option<&Board>) -> Option<Clock> {
        match (self.clock_hz, board) {
            (Some(hertz), _) => Clock::hertz(hertz),
            (None, Some(board)) => Some(board.clock()),
            (None, None) => Clock::hertz(USUAL_CLOCK_HZ),
        }
    }
}

fn option(message: String) -> Diagnostic {
    Diagnostic::without_place(Code::E7008, message)
}
