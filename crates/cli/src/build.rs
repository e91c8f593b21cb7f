//! `iecc build`: a program as files of a target.

use crate::messages::Messages;
use crate::program::{Program, load_stimulus};
use crate::terminal;
use clap::ValueEnum;
use iecc_diag::{Code, Diagnostic};
use iecc_driver::run::parse_duration;
use iecc_driver::{
    Compiled, Cpu, Replay, VerilogRequest, VerilogSettings, build_object, build_verilog, load,
    write_artifacts,
};
use std::path::PathBuf;

/// Make hardware or an object file of a program
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    program: Program,

    /// What to make
    #[arg(long, value_enum)]
    target: TargetChoice,

    /// Where the files go
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,

    /// Which processors an object file is for [default: generic]
    #[arg(long, value_enum, help_heading = "Target jit")]
    cpu: Option<CpuChoice>,

    /// Frequency of the hardware's clock in hertz; one scan runs in every clock [default: that of
    /// the board, else 50000000]
    #[arg(long, value_name = "HZ", help_heading = HARDWARE, value_parser = clap::value_parser!(u64).range(1..))]
    clock_hz: Option<u64>,

    /// The tick from which the hardware counts all times, such as 1ms or 1us; it changes the
    /// hardware, never the results [default: the finest unit in use]
    #[arg(long = "tick", value_name = "TIME", help_heading = HARDWARE, value_parser = tick)]
    tick_ns: Option<u64>,

    /// Make a project for a board, such as de2-115 or hx8k
    #[arg(long, value_name = "NAME", help_heading = HARDWARE)]
    board: Option<String>,

    /// Which port is on which pin of the board
    #[arg(long, value_name = "FILE", help_heading = HARDWARE)]
    pins: Option<PathBuf>,

    /// What the testbench sets the inputs to, and when: a CSV file as for `iecc run`; scans are one
    /// period of the clock apart
    #[arg(long, value_name = "FILE", requires = "scans", help_heading = HARDWARE)]
    stimulus: Option<PathBuf>,

    /// How many scans the testbench runs with the stimulus
    #[arg(long, value_name = "N", requires = "stimulus", help_heading = HARDWARE,
          value_parser = clap::value_parser!(u64).range(1..))]
    scans: Option<u64>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum TargetChoice {
    /// Verilog for any FPGA
    Verilog,
    /// Machine code of this kind of computer: an object file to link, and a header for C
    Jit,
}

impl TargetChoice {
    fn name(self) -> &'static str {
        match self {
            Self::Verilog => "verilog",
            Self::Jit => "jit",
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum CpuChoice {
    /// All of the kind; the same program gives the same file everywhere
    Generic,
    /// This one and those that have all its instructions
    Native,
}

/// The heading of what only hardware takes.
const HARDWARE: &str = "Target verilog";

fn tick(text: &str) -> Result<u64, String> {
    match parse_duration(text) {
        Ok(0) => Err("a tick is not zero".to_owned()),
        Ok(tick_ns) => Ok(tick_ns),
        Err(diagnostic) => Err(diagnostic.message),
    }
}

pub(crate) fn run(arguments: &Arguments, messages: &mut Messages) {
    if let Some(found) = arguments.misplaced() {
        return messages.diagnostics.push(found);
    }
    let Some((Compiled { module, .. }, project)) = arguments.program.compile(messages) else {
        return;
    };
    let made = match arguments.target {
        TargetChoice::Verilog => {
            let Some(request) = arguments.request(&project.verilog, messages) else {
                return;
            };
            build_verilog(module, &request, &messages.map)
        }
        TargetChoice::Jit => build_object(module, arguments.processor()),
    };
    let written = made.and_then(|files| {
        write_artifacts(&arguments.output, &files).map_err(|diagnostic| vec![diagnostic])
    });
    match written {
        Ok(paths) => {
            for path in paths {
                terminal::print(&format!("{}\n", path.display()));
            }
        }
        Err(found) => found.into_iter().for_each(|d| messages.diagnostics.push(d)),
    }
}

impl Arguments {
    /// An option that the target would ignore.
    fn misplaced(&self) -> Option<Diagnostic> {
        let options: &[(&str, bool)] = match self.target {
            TargetChoice::Verilog => &[("--cpu", self.cpu.is_some())],
            TargetChoice::Jit => &[
                ("--clock-hz", self.clock_hz.is_some()),
                ("--tick", self.tick_ns.is_some()),
                ("--board", self.board.is_some()),
                ("--pins", self.pins.is_some()),
                ("--stimulus", self.stimulus.is_some()),
                ("--scans", self.scans.is_some()),
            ],
        };
        let (option, _) = options.iter().find(|(_, given)| *given)?;
        let message = format!("the target {} has no option {option}", self.target.name());
        Some(Diagnostic::without_place(Code::E7008, message))
    }

    fn processor(&self) -> Cpu {
        match self.cpu {
            None | Some(CpuChoice::Generic) => Cpu::Generic,
            Some(CpuChoice::Native) => Cpu::Native,
        }
    }

    fn request(
        &self,
        project: &VerilogSettings,
        messages: &mut Messages,
    ) -> Option<VerilogRequest> {
        let pins = match self.pins.as_ref().or(project.pins.as_ref()) {
            None => None,
            Some(path) => {
                let file = load(&mut messages.map, path, &mut messages.diagnostics)?;
                Some(messages.map.file(file).text().to_owned())
            }
        };
        Some(VerilogRequest {
            clock_hz: self.clock_hz.or(project.clock_hz),
            tick_ns: self.tick_ns.or(project.tick_ns),
            board: self.board.clone().or_else(|| project.board.clone()),
            pins,
            replay: match (&self.stimulus, self.scans) {
                (Some(path), Some(scans)) => Some(Replay {
                    stimulus: load_stimulus(path, messages)?,
                    scans,
                }),
                (Some(_) | None, _) => None,
            },
        })
    }
}
