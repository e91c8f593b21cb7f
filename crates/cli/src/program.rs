//! What commands that read a program have in common: the files, how to take them, and the stimulus.

use crate::messages::Messages;
use clap::ValueEnum;
use iecc_diag::Code;
use iecc_driver::run::{Stimulus, parse_duration};
use iecc_driver::{Dialect, Edits, FrontOptions, Init, Level, Levels, Sources, TimerBase, load};
use iecc_ir::Module;
use std::path::{Path, PathBuf};

/// The program and choices it does not make.
#[derive(Debug, clap::Args)]
pub(crate) struct Program {
    /// The program: a Logix export (.L5X), or files of Structured Text (.st, .iecst); a folder
    /// stands for all that lies in it
    #[arg(value_name = "FILE", required = true)]
    paths: Vec<PathBuf>,

    /// Whose Structured Text it is
    #[arg(long, value_enum, default_value = "iec", help_heading = "Program")]
    dialect: DialectChoice,

    /// What becomes of warnings: `error`, `warn` or `allow`, for all, or with =CODE for one
    #[arg(short = 'W', long = "warnings", value_name = "LEVEL[=CODE]", value_parser = parse_level,
          help_heading = "Program")]
    warnings: Vec<WarningRule>,

    /// Do not show this warning, as -W allow=CODE
    #[arg(short = 'A', long = "allow", value_name = "CODE", value_parser = parse_allowed,
          help_heading = "Program")]
    allowed: Vec<WarningRule>,

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

#[derive(Debug, Clone, Copy, ValueEnum)]
enum DialectChoice {
    /// IEC 61131-3, edition 3
    Iec,
    /// IEC 61131-3, edition 2
    Iec2,
    /// CODESYS and TwinCAT
    Codesys,
}

/// What becomes of a warning, or of all.
#[derive(Debug, Clone, Copy)]
struct WarningRule {
    level: Level,
    code: Option<Code>,
}

fn parse_level(text: &str) -> Result<WarningRule, String> {
    let (level, code) = match text.split_once('=') {
        Some((level, code)) => (level, Some(code)),
        None => (text, None),
    };
    let level = match level.to_ascii_lowercase().as_str() {
        "error" => Level::Error,
        "warn" => Level::Warn,
        "allow" => Level::Allow,
        _ => return Err("a level is error, warn or allow".to_owned()),
    };
    rule(level, code)
}

fn parse_allowed(code: &str) -> Result<WarningRule, String> {
    rule(Level::Allow, Some(code))
}

fn rule(level: Level, code: Option<&str>) -> Result<WarningRule, String> {
    let code = match code {
        None => None,
        Some(code) => {
            let found = Code::parse(code).ok_or_else(|| format!("there is no code `{code}`"))?;
            Levels::default().set(found, level)?;
            Some(found)
        }
    };
    Ok(WarningRule { level, code })
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
            timer_base: self.timer_base(),
            dialect: match self.dialect {
                DialectChoice::Iec => Dialect::Iec,
                DialectChoice::Iec2 => Dialect::IecEdition2,
                DialectChoice::Codesys => Dialect::Codesys,
            },
            levels: self.levels(),
        }
    }

    fn timer_base(&self) -> TimerBase {
        let mut timer_base = TimerBase::default();
        for base in &self.timer_base {
            match &base.timer {
                Some(timer) => timer_base.timers.push((timer.clone(), base.unit_ns)),
                None => timer_base.unit_ns = base.unit_ns,
            }
        }
        timer_base
    }

    fn levels(&self) -> Levels {
        let mut levels = Levels::default();
        for rule in self.allowed.iter().chain(&self.warnings) {
            match rule.code {
                None => levels.set_others(rule.level),
                Some(code) => levels.set(code, rule.level).expect("it was tried"),
            }
        }
        levels
    }

    /// Reads the program and compiles it to a module ready for its first scan.
    pub(crate) fn compile(&self, messages: &mut Messages) -> Option<Module> {
        let (map, diagnostics) = (&mut messages.map, &mut messages.diagnostics);
        let options = self.options();
        let sources = Sources::load(map, &self.paths, &options.levels, diagnostics)?;
        iecc_driver::compile(map, &sources, &options, diagnostics)
    }
}

/// Reads a stimulus; `None` after mistakes.
pub(crate) fn load_stimulus(path: &Path, messages: &mut Messages) -> Option<Stimulus> {
    let file = load(&mut messages.map, path, &mut messages.diagnostics)?;
    let text = messages.map.file(file).text();
    Stimulus::parse(file, text, &mut messages.diagnostics)
}
