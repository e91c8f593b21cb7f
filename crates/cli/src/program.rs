//! What commands that read a program have in common: the file, how to take it, and the stimulus.

use crate::messages::Messages;
use clap::ValueEnum;
use iecc_driver::run::{Stimulus, parse_duration};
use iecc_driver::{Edits, FrontOptions, Init, TimerBase, load};
use iecc_ir::Module;
use std::path::{Path, PathBuf};

/// The program and choices it does not make.
#[derive(Debug, clap::Args)]
pub(crate) struct Program {
    /// The program: a Logix export (.L5X)
    pub(crate) file: PathBuf,

    /// What tags hold at the start
    #[arg(long, value_enum, default_value = "cold", help_heading = "Program")]
    init: InitChoice,

    /// Which side of pending edits runs [default: the one that ran at export]
    #[arg(long, value_enum, help_heading = "Program")]
    edits: Option<EditsChoice>,

    /// The unit of timer presets: of all timers (1us), or of some (twait1=1us,twaitw=1us)
    /// [default: 1ms]
    #[arg(long, value_name = "UNITS", value_parser = parse_base, value_delimiter = ',',
          help_heading = "Program")]
    timer_base: Vec<Base>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum InitChoice {
    /// Zero, but presets and constants as exported
    Cold,
    /// Every value as exported
    Export,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum EditsChoice {
    /// The rungs before the edits
    Orig,
    /// The edited rungs
    Test,
}

/// A unit, of one timer or of all.
#[derive(Debug, Clone)]
struct Base {
    timer: Option<String>,
    unit_ns: u64,
}

fn parse_base(text: &str) -> Result<Base, String> {
    let (timer, unit) = match text.rsplit_once('=') {
        Some((timer, unit)) => (Some(timer.trim().to_owned()), unit),
        None => (None, text),
    };
    let unit_ns = parse_duration(unit.trim()).map_err(|diagnostic| diagnostic.message)?;
    if unit_ns == 0 {
        return Err("a unit is not zero".to_owned());
    }
    Ok(Base { timer, unit_ns })
}

impl Program {
    fn options(&self) -> FrontOptions {
        let mut timer_base = TimerBase::default();
        for base in &self.timer_base {
            match &base.timer {
                Some(timer) => timer_base.timers.push((timer.clone(), base.unit_ns)),
                None => timer_base.unit_ns = base.unit_ns,
            }
        }
        FrontOptions {
            init: match self.init {
                InitChoice::Cold => Init::Cold,
                InitChoice::Export => Init::Export,
            },
            edits: match self.edits {
                None => Edits::AsExported,
                Some(EditsChoice::Orig) => Edits::Original,
                Some(EditsChoice::Test) => Edits::Test,
            },
            timer_base,
        }
    }

    /// Reads the program and compiles it to a module ready for its first scan.
    pub(crate) fn compile(&self, messages: &mut Messages) -> Option<Module> {
        let (map, diagnostics) = (&mut messages.map, &mut messages.diagnostics);
        let file = load(map, &self.file, diagnostics)?;
        iecc_driver::compile(map, file, &self.options(), diagnostics)
    }
}

/// Reads a stimulus; `None` after mistakes.
pub(crate) fn load_stimulus(path: &Path, messages: &mut Messages) -> Option<Stimulus> {
    let file = load(&mut messages.map, path, &mut messages.diagnostics)?;
    let text = messages.map.file(file).text();
    Stimulus::parse(file, text, &mut messages.diagnostics)
}
