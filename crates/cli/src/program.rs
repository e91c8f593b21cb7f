//! What commands that read a program have in common: the files, how to take them, and the stimulus.

use crate::messages::Messages;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use iecc_diag::Code;
use iecc_driver::run::Stimulus;
use iecc_driver::testing::TestProgram;
use iecc_driver::{
    Choice, Compiled, DIALECTS, Dialect, EDITS, Edits, FAULTS, Found, FrontOptions, INITS, Init,
    LEVELS, Level, Levels, OnFault, Project, Sources, Tests, TimerBase, check_options,
    compile_with_tick, find, find_choice, load,
};
use std::path::{Path, PathBuf};

/// The program and choices it does not make.
#[derive(Debug, clap::Args)]
pub(crate) struct Program {
    /// The program: a Logix export (.L5X), or files of Structured Text (.st, .iecst); a folder
    /// stands for all that lies in it, or for its project file [default: the project file iecc.toml
    /// here or above, else the source files here]
    #[arg(value_name = "FILE")]
    paths: Vec<PathBuf>,

    /// Structured Text: whose it is [default: iec]
    #[arg(long, value_parser = choice(DIALECTS), help_heading = "Program")]
    dialect: Option<Dialect>,

    /// Structured Text without a CONFIGURATION: the PROGRAM that runs [default: the only one]
    #[arg(long, value_name = "NAME", help_heading = "Program")]
    entry: Option<String>,

    /// Structured Text: what a wrong index, a division by zero and the like do [default: trap]
    #[arg(long, value_parser = choice(FAULTS), help_heading = "Program")]
    on_fault: Option<OnFault>,

    /// Logix: what tags hold at the start [default: cold]
    #[arg(long, value_parser = choice(INITS), help_heading = "Program")]
    init: Option<Init>,

    /// Logix: which side of pending edits runs [default: as-exported]
    #[arg(long, value_parser = choice(EDITS), help_heading = "Program")]
    edits: Option<Edits>,

    /// Logix: the unit of timer presets: of all timers (1us), or of some (twait1=1us,twaitw=1us)
    /// [default: 1ms]
    #[arg(long, value_name = "UNITS", value_parser = timer_unit, value_delimiter = ',',
          help_heading = "Program")]
    timer_base: Vec<String>,

    /// What becomes of warnings: `error`, `warn` or `allow`, for all, or with =CODE for one
    #[arg(short = 'W', long = "warnings", value_name = "LEVEL[=CODE]", value_parser = parse_level,
          help_heading = "Program")]
    warnings: Vec<WarningRule>,

    /// Do not show this warning, as -W allow=CODE
    #[arg(short = 'A', long = "allow", value_name = "CODE", value_parser = parse_allowed,
          help_heading = "Program")]
    allowed: Vec<WarningRule>,
}

/// The values of an option, by name.
fn choice<T: Copy + Send + Sync>(
    choices: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let values = choices
        .iter()
        .map(|choice| PossibleValue::new(choice.name).help(choice.help));
    PossibleValuesParser::new(values)
        .map(|name| find_choice(choices, &name).expect("clap knows the names"))
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
    let level = find_choice(LEVELS, level).ok_or("a level is error, warn or allow")?;
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

fn timer_unit(text: &str) -> Result<String, String> {
    TimerBase::default().set(text).map(|()| text.to_owned())
}

impl Program {
    /// Puts what the command line says over what the project file says.
    fn override_options(&self, options: &mut FrontOptions) {
        fn set<T: Clone>(option: &mut T, value: Option<&T>) {
            if let Some(value) = value {
                option.clone_from(value);
            }
        }
        set(&mut options.dialect, self.dialect.as_ref());
        set(&mut options.on_fault, self.on_fault.as_ref());
        set(&mut options.init, self.init.as_ref());
        set(&mut options.edits, self.edits.as_ref());
        if self.entry.is_some() {
            options.entry.clone_from(&self.entry);
        }
        for unit in &self.timer_base {
            options.timer_base.set(unit).expect("it was tried");
        }
        for rule in self.allowed.iter().chain(&self.warnings) {
            match rule.code {
                None => options.levels.set_others(rule.level),
                Some(code) => options.levels.set(code, rule.level).expect("it was tried"),
            }
        }
    }

    /// Reads the program and says what is wrong with it.
    pub(crate) fn check(&self, messages: &mut Messages) {
        if let Some((sources, project)) = self.read(messages, Tests::Checked) {
            let (map, diagnostics) = (&messages.map, &mut messages.diagnostics);
            check_options(map, &sources, &project.options, diagnostics);
        }
    }

    /// Whether an option says which program runs.
    pub(crate) fn names_entry(&self) -> bool {
        self.entry.is_some()
    }

    /// Reads the program and compiles its tests.
    pub(crate) fn compile_tests(&self, messages: &mut Messages) -> Option<TestProgram> {
        let (sources, project) = self.read(messages, Tests::RUN_ALL)?;
        let (map, diagnostics) = (&messages.map, &mut messages.diagnostics);
        TestProgram::compile(map, &sources, &project.options, diagnostics)
    }

    /// Reads the program and compiles it.
    pub(crate) fn compile(&self, messages: &mut Messages) -> Option<(Compiled, Project)> {
        let (sources, project) = self.read(messages, Tests::LeftOut)?;
        let (map, diagnostics) = (&messages.map, &mut messages.diagnostics);
        let compiled = compile_with_tick(map, &sources, &project.options, diagnostics)?;
        Some((compiled, project))
    }

    /// The sources, and the options of the project file and the command line.
    fn read(&self, messages: &mut Messages, tests: Tests) -> Option<(Sources, Project)> {
        let (map, diagnostics) = (&mut messages.map, &mut messages.diagnostics);
        let (mut project, paths) = match find(map, &self.paths, diagnostics)? {
            Found::Project(project) => (*project, None),
            Found::Paths(paths) => (Project::default(), Some(paths)),
        };
        self.override_options(&mut project.options);
        project.options.tests = tests;
        let levels = &project.options.levels;
        let sources = match paths {
            Some(paths) => Sources::load(map, &paths, levels, diagnostics),
            None => project.load(map, levels, diagnostics),
        };
        Some((sources?, project))
    }
}

/// Reads a stimulus; `None` after mistakes.
pub(crate) fn load_stimulus(path: &Path, messages: &mut Messages) -> Option<Stimulus> {
    let file = load(&mut messages.map, path, &mut messages.diagnostics)?;
    let text = messages.map.file(file).text();
    Stimulus::parse(file, text, &mut messages.diagnostics)
}
