//! Simulated Verilog as an engine: the module the back end makes, run by Icarus Verilog.
//!
//! The files are compiled into a folder of their own, which is removed at the end. The simulator
//! then runs one scan for each line of inputs. One scan is one clock, so scans must come at
//! multiples of one period.
#![expect(
    clippy::disallowed_methods,
    reason = "the simulator is another program and reads files"
)]

use iecc_ir::{Module, Verified};
use iecc_target::{Engine, Fault, TargetError};
use iecc_verilog::{Clock, Options, Simulation, simulation};
use std::fmt;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use tempfile::TempDir;

/// Lines sent before any is read back; far below what a pipe holds.
const WINDOW: usize = 64;

/// Why a simulation did not start.
#[derive(Debug)]
pub enum SimError {
    /// The back end cannot express the program.
    Refused(Vec<TargetError>),
    /// The period is 0.
    Period,
    /// A program of the simulator is missing or a file cannot be written.
    Io(&'static str, io::Error),
    /// The simulator does not accept the module: a mistake of this compiler.
    Compile(String),
}

impl fmt::Display for SimError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(reasons) => {
                let reasons: Vec<&str> = reasons.iter().map(|r| r.message.as_str()).collect();
                f.write_str(&reasons.join("\n"))
            }
            Self::Period => f.write_str("the period of a simulation is at least 1 ns"),
            Self::Io(what, error) => write!(
                f,
                "{what}: {error}; the engine `verilog` needs Icarus Verilog (package iverilog)"
            ),
            Self::Compile(text) => write!(f, "the simulator refuses the module:\n{text}"),
        }
    }
}

impl std::error::Error for SimError {}

/// A running simulation.
#[derive(Debug)]
pub struct VerilogSim {
    simulation: Simulation,
    period_ns: u64,
    next_ns: u64,
    process: Child,
    lines_in: Option<BufWriter<ChildStdin>>,
    lines_out: BufReader<ChildStdout>,
    _folder: TempDir,
}

impl VerilogSim {
    /// Starts the simulation of a module in the form the back end takes. The clock of the options
    /// is replaced by one scan every `period_ns`; their ranges must allow for its steps.
    ///
    /// # Errors
    /// What keeps it from starting.
    pub fn start(
        module: Verified<'_>,
        options: &Options,
        period_ns: u64,
    ) -> Result<Self, SimError> {
        let mut options = options.clone();
        options.clock = Clock::period_ns(period_ns).ok_or(SimError::Period)?;
        let simulation = simulation(module, &options).map_err(SimError::Refused)?;
        let folder = tempfile::tempdir().map_err(|e| SimError::Io("temporary folder", e))?;
        compile(&simulation, folder.path())?;
        let mut process = Command::new("vvp")
            .args(["-n", "scan.vvp"])
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|e| SimError::Io("vvp", e))?;
        let lines_in = process.stdin.take().expect("piped");
        let lines_out = process.stdout.take().expect("piped");
        Ok(Self {
            simulation,
            period_ns,
            next_ns: 0,
            process,
            lines_in: Some(BufWriter::new(lines_in)),
            lines_out: BufReader::new(lines_out),
            _folder: folder,
        })
    }

    /// Runs one scan for each row of inputs and gives the rows of outputs, each of
    /// `output_len` bytes. Faster than single steps.
    pub fn run(&mut self, module: &Module, inputs: &[Vec<u8>]) -> Vec<Vec<u8>> {
        let empty = iecc_target::region_bytes(module, iecc_ir::Region::Output);
        let mut rows = Vec::with_capacity(inputs.len());
        for window in inputs.chunks(WINDOW) {
            for row in window {
                self.send(row);
            }
            self.flush();
            for _ in window {
                let mut row = empty.clone();
                self.receive(&mut row);
                rows.push(row);
            }
        }
        rows
    }

    fn send(&mut self, inputs: &[u8]) {
        let line = self.simulation.encode(inputs);
        let pipe = self.lines_in.as_mut().expect("open until dropped");
        writeln!(pipe, "{line}").expect("the simulator listens");
        self.next_ns += self.period_ns;
    }

    fn flush(&mut self) {
        let pipe = self.lines_in.as_mut().expect("open until dropped");
        pipe.flush().expect("the simulator listens");
    }

    fn receive(&mut self, outputs: &mut [u8]) {
        let mut line = String::new();
        self.lines_out
            .read_line(&mut line)
            .expect("the simulator answers");
        let known = self.simulation.decode(&line, outputs);
        assert!(known.is_some(), "outputs are never unknown: {line:?}");
    }
}

impl Engine for VerilogSim {
    /// # Panics
    /// If the scan does not come one period after the one before, the first at 0.
    fn step(&mut self, now_ns: u64, inputs: &[u8], outputs: &mut [u8]) -> Result<(), Fault> {
        assert_eq!(now_ns, self.next_ns, "one scan every period, from 0");
        self.send(inputs);
        self.flush();
        self.receive(outputs);
        Ok(())
    }
}

impl Drop for VerilogSim {
    /// The simulator ends at the end of its input.
    fn drop(&mut self) {
        drop(self.lines_in.take());
        if !matches!(self.process.wait(), Ok(status) if status.success()) {
            let _ = self.process.kill();
        }
    }
}

fn compile(simulation: &Simulation, folder: &Path) -> Result<(), SimError> {
    let mut names = Vec::new();
    for file in &simulation.files {
        std::fs::write(folder.join(&file.name), &file.bytes)
            .map_err(|e| SimError::Io("temporary file", e))?;
        names.push(file.name.as_str());
    }
    let output = Command::new("iverilog")
        .args(["-g2005", "-Wall", "-o", "scan.vvp", "-s", &simulation.top])
        .args(&names)
        .current_dir(folder)
        .output()
        .map_err(|e| SimError::Io("iverilog", e))?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() && !text.contains("error") {
        Ok(())
    } else {
        Err(SimError::Compile(text))
    }
}
