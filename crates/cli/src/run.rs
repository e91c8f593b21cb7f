//! `iecc run`: scans on an engine, with a stimulus, into traces.

use crate::messages::Messages;
use crate::program::{Program, load_stimulus};
use crate::terminal;
use clap::ValueEnum;
use iecc_diag::Diagnostic;
use iecc_driver::EngineKind;
use iecc_driver::run::{LastRow, Request, Schedule, Session, Trace, TraceFile, parse_duration};
use iecc_ir::Module;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal};
use std::path::PathBuf;
use std::time::Duration;

/// The time from one scan to the next where nothing says it.
const USUAL_PERIOD_NS: u64 = 10_000_000;

/// Execute scans of a program on this computer
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    program: Program,

    /// How many scans
    #[arg(
        long,
        value_name = "N",
        required_unless_present = "length",
        conflicts_with = "length"
    )]
    scans: Option<u64>,

    /// For how long, such as 300s or 1m30s
    #[arg(long = "for", id = "length", value_name = "TIME", value_parser = time)]
    length_ns: Option<u64>,

    /// The time from one scan to the next [default: the largest that fits into all intervals of the
    /// tasks, or 10ms]
    #[arg(long = "period", value_name = "TIME", value_parser = time)]
    period_ns: Option<u64>,

    /// What inputs and tags are set to, and when: a CSV file with a column t_ms or t_us
    #[arg(long, value_name = "FILE")]
    stimulus: Option<PathBuf>,

    /// Where to write inputs, outputs and watched tags after each scan: FILE.csv or FILE.vcd; may
    /// be given again. Without it, what they are after the last scan is printed
    #[arg(long, value_name = "FILE")]
    trace: Vec<PathBuf>,

    /// Leave out rows of a CSV trace in which nothing changed
    #[arg(long)]
    changes: bool,

    /// Tags to show in the traces, such as cycles.ACC,Step
    #[arg(long, value_name = "TAGS", value_delimiter = ',')]
    watch: Vec<String>,

    /// What executes the scans
    #[arg(long, value_enum, default_value = "jit")]
    engine: EngineChoice,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum EngineChoice {
    /// Machine code of this computer
    Jit,
    /// The reference interpreter: the definition of what the program means
    Interp,
    /// The hardware of `iecc build`, simulated by Icarus Verilog
    Verilog,
}

fn time(text: &str) -> Result<u64, String> {
    parse_duration(text).map_err(|diagnostic| diagnostic.message)
}

pub(crate) fn run(arguments: &Arguments, messages: &mut Messages) {
    let Some((compiled, project)) = arguments.program.compile(messages) else {
        return;
    };
    let period_ns = arguments.period_ns.or(project.period_ns);
    let period_ns = period_ns.or(compiled.tick_ns).unwrap_or(USUAL_PERIOD_NS);
    let Some((module, session)) = arguments.prepare(compiled.module, messages) else {
        return;
    };
    if let Err(found) = arguments.execute(&module, &session, period_ns) {
        for diagnostic in found {
            messages.diagnostics.push(diagnostic);
        }
    }
}

impl Arguments {
    /// Opens the module to what is set and shown.
    fn prepare(&self, mut module: Module, messages: &mut Messages) -> Option<(Module, Session)> {
        let stimulus = match &self.stimulus {
            None => None,
            Some(path) => Some(load_stimulus(path, messages)?),
        };
        let request = Request {
            watches: &self.watch,
            stimulus: stimulus.as_ref(),
        };
        let session = Session::prepare(&mut module, &request, &mut messages.diagnostics)?;
        Some((module, session))
    }

    fn schedule(&self, period_ns: u64) -> Result<Schedule, Diagnostic> {
        match (self.scans, self.length_ns) {
            (Some(scans), _) => Schedule::for_scans(period_ns, scans),
            (None, length_ns) => {
                let length_ns = length_ns.expect("clap asks for one of the two");
                Schedule::for_duration(period_ns, length_ns)
            }
        }
    }

    fn execute(
        &self,
        module: &Module,
        session: &Session,
        period_ns: u64,
    ) -> Result<(), Vec<Diagnostic>> {
        let schedule = self.schedule(period_ns).map_err(|d| vec![d])?;
        let mut traces = Traces::default();
        for path in &self.trace {
            let columns = session.columns();
            let trace = TraceFile::create(path, &module.name, columns, schedule, self.changes);
            traces.files.push(trace.map_err(|d| vec![d])?);
        }
        let mut engine = self.engine().start(module, period_ns)?;
        let bar = progress_bar(schedule.scans());
        let told = session.run(engine.as_mut(), schedule, &mut traces, &mut |scan| {
            bar.set_position(scan);
        });
        bar.finish_and_clear();
        // After a fault the scans before it are worth seeing.
        let told = told.map_err(|error| error.to_diagnostic(module));
        if self.trace.is_empty() {
            terminal::print(&traces.last.text(session.columns()));
        }
        let written = traces.finish();
        told.and(written).map_err(|d| vec![d])
    }

    fn engine(&self) -> EngineKind {
        match self.engine {
            EngineChoice::Jit => EngineKind::Jit,
            EngineChoice::Interp => EngineKind::Interp,
            EngineChoice::Verilog => EngineKind::Verilog,
        }
    }
}

/// All traces of a run.
#[derive(Default)]
struct Traces {
    files: Vec<TraceFile>,
    last: LastRow,
}

impl Trace for Traces {
    fn row(&mut self, now_ns: u64, values: &[u64]) -> io::Result<()> {
        self.last.row(now_ns, values)?;
        let mut files = self.files.iter_mut();
        files.try_for_each(|trace| trace.row(now_ns, values))
    }
}

impl Traces {
    fn finish(self) -> Result<(), Diagnostic> {
        self.files.into_iter().try_for_each(TraceFile::finish)
    }
}

/// Shown on a terminal only, and only when the run takes long enough to be worth it.
fn progress_bar(scans: u64) -> ProgressBar {
    if !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} scans, {eta} left");
    let bar = ProgressBar::no_length().with_style(style.expect("the template is right"));
    bar.set_length(scans);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
