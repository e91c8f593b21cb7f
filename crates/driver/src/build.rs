//! Builds files: passes for the target, then its back end.

use crate::comments::source_comments;
use crate::constants::constants;
use crate::engine::verified;
use crate::pipeline::Pipeline;
use crate::refusal;
use crate::run::{Schedule, Session, Stimulus};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_ir::analysis::Ranges;
use iecc_ir::{Module, Region};
use iecc_jit::{Cpu, Object, ObjectOptions};
use iecc_passes::{Settings, ranges, ranges_given};
use iecc_source::SourceMap;
use iecc_target::{Artifact, Target, region_bytes};
use iecc_verilog::{Board, Clock, Options, Verilog, max_step};

/// The clock of hardware for no board, in hertz.
const USUAL_CLOCK_HZ: u64 = 50_000_000;

/// Most scans and most bytes of inputs a testbench replays: simulators hold them all.
const MAX_REPLAY_SCANS: u64 = 100_000;
const MAX_REPLAY_BYTES: u64 = 64 << 20;

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
    /// What the testbench replays.
    pub replay: Option<Replay>,
}

/// Inputs for a testbench, which gives every scan its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Replay {
    /// What is set when; scans are one period of the clock apart.
    pub stimulus: Stimulus,
    /// How many scans.
    pub scans: u64,
}

/// The files of a program as hardware. The map holds the program's source.
///
/// # Errors
/// All reasons why it cannot be hardware.
pub fn build_verilog(
    mut module: Module,
    request: &VerilogRequest,
    map: &SourceMap,
) -> Result<Vec<Artifact>, Vec<Diagnostic>> {
    let board = request.board().map_err(|message| vec![option(message)])?;
    let clock = request.clock(board.as_ref());
    let clock = clock.ok_or_else(|| vec![option("the frequency of the clock is 0".to_owned())])?;
    let stimulus = match &request.replay {
        None => Vec::new(),
        Some(replay) => replay.inputs(&module, clock)?,
    };
    let options = Options {
        tick_ns: request.tick_ns,
        constants: constants(&module, clock, &settings(clock)),
        source_comments: source_comments(&module, map),
        ranges: hardware_passes(&mut module, clock),
        board,
        stimulus,
        ..Options::new(clock)
    };
    let files = Verilog.compile(verified(&module), &options);
    files.map_err(|errors| refusal::to_diagnostics(&module, &errors))
}

/// The object file of a program for this kind of computer, and its header.
///
/// # Errors
/// All reasons why it cannot be machine code.
pub fn build_object(mut module: Module, cpu: Cpu) -> Result<Vec<Artifact>, Vec<Diagnostic>> {
    Pipeline::Software.run(&mut module, &Settings::default());
    let files = Object.compile(verified(&module), &ObjectOptions { cpu });
    files.map_err(|errors| refusal::to_diagnostics(&module, &errors))
}

/// Runs the passes for hardware, which may rely on a scan in every clock, and says what the values
/// of the result can be. The state is bounded before the passes that hide why it is.
pub(crate) fn hardware_passes(module: &mut Module, clock: Clock) -> Ranges {
    let settings = settings(clock);
    let steps = |unit_ns| max_step(clock, unit_ns);
    Pipeline::Hardware.run(module, &settings);
    let known = ranges(module, &steps);
    Pipeline::HardwareSpeed.run(module, &settings);
    ranges_given(module, &known, &steps)
}

fn settings(clock: Clock) -> Settings {
    Settings {
        longest_period_ns: Some(max_step(clock, 1)),
    }
}

impl Replay {
    /// The input region before each scan.
    fn inputs(&self, module: &Module, clock: Clock) -> Result<Vec<Vec<u8>>, Vec<Diagnostic>> {
        let period_ns = clock.whole_period_ns().ok_or_else(|| {
            let message = format!(
                "a clock of {clock} has no period in whole nanoseconds, and a stimulus has no other times"
            );
            vec![option(message)]
        })?;
        let bytes = region_bytes(module, Region::Input).len() as u64;
        let most = MAX_REPLAY_SCANS.min(MAX_REPLAY_BYTES / bytes.max(1));
        if self.scans > most {
            let message = format!(
                "the testbench is to replay {} scans, but at most {most} for this program",
                self.scans
            );
            return Err(vec![option(message)]);
        }
        let schedule = Schedule::for_scans(period_ns, self.scans).map_err(|error| vec![error])?;
        let mut found = Diagnostics::new();
        let inputs = Session::replay(module, &self.stimulus, schedule, &mut found);
        inputs.ok_or_else(|| found.iter().cloned().collect())
    }
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
