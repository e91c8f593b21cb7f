//! From a source file to a module whose image is ready for the first scan.
//!
//! [`Sources`] are read, `check` decides what the program means, `compile` goes on to the IR and runs
//! prescan over the initial values with the interpreter. Each reports everything it finds; each
//! gives a result only when there is no error.

use crate::evaluate::Constants;
use crate::rename::{Rename, rename};
use crate::run::parse_duration;
use crate::{Language, Levels, Sources};
use iecc_ast::Names;
use iecc_ast::st::{File, list_name};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_grammar::st::{Dialect, parse_file};
use iecc_interp::run_prescan;
use iecc_ir::{Module, verify};
use iecc_lower::{MILLISECOND_NS, OnFault};
use iecc_sema::hir::{self, StructKind, Trigger};
use iecc_sema::st::testing::{Suite, Tests};
use iecc_sema::{logix, st};
use iecc_source::{FileId, SourceMap};

/// Choices that the source does not make.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FrontOptions {
    /// What tags hold at the start.
    pub init: logix::Init,
    /// Which side of pending edits runs.
    pub edits: logix::Edits,
    /// What timers count.
    pub timer_base: TimerBase,
    /// Whose Structured Text it is.
    pub dialect: Dialect,
    /// What errors of the running program do: a wrong index, a division by zero.
    pub on_fault: OnFault,
    /// What becomes of warnings.
    pub levels: Levels,
    /// The name of the program, in place of the one that its source gives.
    pub name: Option<String>,
    /// The program that runs, where the source leaves it open.
    pub entry: Option<String>,
    /// What becomes of unit tests.
    pub tests: Tests,
    /// Inputs and outputs that get another name.
    pub renames: Vec<Rename>,
}

/// The unit of timer presets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimerBase {
    /// Of all timers but those below, in nanoseconds.
    pub unit_ns: u64,
    /// Timers, as users write them, with a unit of their own; the last of several counts.
    pub timers: Vec<(String, u64)>,
}

impl Default for TimerBase {
    fn default() -> Self {
        Self {
            unit_ns: MILLISECOND_NS,
            timers: Vec::new(),
        }
    }
}

impl TimerBase {
    /// Sets a unit: that of all timers (`1us`), or that of one (`twait1=1us`).
    ///
    /// # Errors
    /// Says what is wrong with the text.
    pub fn set(&mut self, text: &str) -> Result<(), String> {
        let (timer, unit) = match text.rsplit_once('=') {
            Some((timer, unit)) => (Some(timer.trim()), unit),
            None => (None, text),
        };
        let unit_ns = parse_duration(unit.trim()).map_err(|diagnostic| diagnostic.message)?;
        if unit_ns == 0 {
            return Err("a unit is not zero".to_owned());
        }
        match timer {
            Some(timer) => self.timers.push((timer.to_owned(), unit_ns)),
            None => self.unit_ns = unit_ns,
        }
        Ok(())
    }
}

/// Decides what the program means.
pub fn check(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<hir::Program> {
    let (program, _) = check_tests(map, sources, options, diagnostics)?;
    Some(program)
}

/// As [`check`], and says what the outputs of a program that runs tests mean.
pub(crate) fn check_tests(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<(hir::Program, Suite)> {
    let mut found = Diagnostics::new();
    misfits(sources.language(), options, &mut found);
    let program = match sources.language() {
        Language::Logix => check_logix(map, sources, options, &mut found)
            .map(|program| (program, Suite::default())),
        Language::StructuredText => check_text(map, sources, options, &mut found),
    };
    options.levels.apply(&mut found);
    found.sort();
    let failed = found.has_errors();
    diagnostics.append(found);
    program.filter(|_| !failed)
}

/// Choices that mean nothing for the language are refused, not passed over.
fn misfits(language: Language, options: &FrontOptions, found: &mut Diagnostics) {
    let usual = FrontOptions::default();
    let (wrong, what) = match language {
        Language::Logix => (
            [
                (options.dialect != usual.dialect, "a dialect"),
                (options.entry.is_some(), "an entry program"),
                (options.on_fault != usual.on_fault, "a policy for faults"),
            ],
            "a Logix export",
        ),
        Language::StructuredText => (
            [
                (options.init != usual.init, "the choice of initial values"),
                (options.edits != usual.edits, "the choice of edits"),
                (options.timer_base != usual.timer_base, "a unit of timers"),
            ],
            "Structured Text",
        ),
    };
    for (_, option) in wrong.into_iter().filter(|(is_wrong, _)| *is_wrong) {
        let message = format!("{option} is given, which means nothing for {what}");
        found.push(Diagnostic::without_place(Code::E6065, message));
    }
}

fn check_logix(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    found: &mut Diagnostics,
) -> Option<hir::Program> {
    let file = sources.files()[0];
    let project = iecc_l5x::read(file, map.file(file).text(), found)?;
    let options = logix::Options {
        init: options.init,
        edits: options.edits,
    };
    let mut names = Names::new();
    let library = library(map, sources.stdlib(), &mut names);
    let functions = logix::stdlib_functions();
    let library = st::library(&library, &names, &functions, &Constants);
    Some(logix::analyze(&project, library, &options, found))
}

fn check_text(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    found: &mut Diagnostics,
) -> Option<(hir::Program, Suite)> {
    let mut names = Names::new();
    let library = library(map, sources.stdlib(), &mut names);
    let parse = |id: &FileId| {
        let source = map.file(*id);
        let mut file = parse_file(*id, source.text(), options.dialect, &mut names, found);
        file.name = list_name(source.name()).map(|name| names.intern(name));
        file
    };
    let files: Vec<File> = sources.files().iter().map(parse).collect();
    Some(meaning(&library, &files, &mut names, options, found))
}

/// What the trees of some files mean.
pub(crate) fn meaning(
    library: &[File],
    files: &[File],
    names: &mut Names,
    options: &FrontOptions,
    found: &mut Diagnostics,
) -> (hir::Program, Suite) {
    st::intern_hidden(names, files);
    let options = st::Options {
        codesys: options.dialect == Dialect::Codesys,
        entry: options.entry.as_deref().map(|entry| names.intern(entry)),
        tests: options.tests,
    };
    let evaluator = &Constants;
    st::analyze_tests(library, files, names, options, evaluator, found)
}

/// The trees of the standard library. To be parsed before the files of the user.
pub(crate) fn library(map: &SourceMap, files: &[FileId], names: &mut Names) -> Vec<File> {
    let mut found = Diagnostics::new();
    let files = files.iter();
    let parse = |file: &FileId| {
        parse_file(
            *file,
            map.file(*file).text(),
            Dialect::Iec,
            names,
            &mut found,
        )
    };
    let library = files.map(parse).collect();
    if let Some(mistake) = found.iter().next() {
        panic!("the library does not follow the grammar: {mistake:?}");
    }
    st::intern_words(names);
    library
}

/// A program that compiles.
#[derive(Debug, Clone)]
pub struct Compiled {
    /// Keeps the rules of the IR; its image is that after prescan.
    pub module: Module,
    /// The time from one scan to the next in which no task is late: the largest that all intervals of
    /// tasks are multiples of. `None` if no task has an interval.
    pub tick_ns: Option<u64>,
}

/// Compiles the program to a module that keeps the rules of the IR and whose image is that after
/// prescan.
pub fn compile(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<Module> {
    let program = check(map, sources, options, diagnostics)?;
    named_module(&program, options, diagnostics)
}

/// As [`compile`], for whoever wants to run the program: it must have something to run. Says what tick
/// the tasks want.
pub fn compile_with_tick(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<Compiled> {
    let program = check(map, sources, options, diagnostics)?;
    if program.tasks.is_empty() {
        let message = "there is no program to run";
        diagnostics.push(Diagnostic::without_place(Code::E6020, message));
        return None;
    }
    let tick_ns = tick_ns(&program);
    let module = named_module(&program, options, diagnostics)?;
    Some(Compiled { module, tick_ns })
}

fn named_module(
    program: &hir::Program,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<Module> {
    let mut module = lowered(program, options, diagnostics)?;
    rename(&mut module, &options.renames, diagnostics)?;
    if let Some(name) = &options.name {
        module.name.clone_from(name);
    }
    Some(module)
}

/// The module of a program, with the image after prescan.
pub(crate) fn lowered(
    program: &hir::Program,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<Module> {
    let lowering = lower_options(program, options, diagnostics)?;
    let mut module = iecc_lower::lower(program, &lowering);
    let verified = match verify(&module) {
        Ok(verified) => verified,
        Err(errors) => panic!("lowering broke the rules of the IR: {}", errors[0]),
    };
    // Prescan has no faults: it only stores.
    module.image = run_prescan(verified).unwrap_or_else(|fault| panic!("prescan failed: {fault}"));
    Some(module)
}

/// Says everything that [`compile`] says. A module is made only where an option is about it.
pub fn check_options(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) {
    if options.renames.is_empty() {
        if let Some(program) = check(map, sources, options, diagnostics) {
            lower_options(&program, options, diagnostics);
        }
    } else {
        compile(map, sources, options, diagnostics);
    }
}

fn tick_ns(program: &hir::Program) -> Option<u64> {
    let intervals = program.tasks.iter().filter_map(|task| match task.trigger {
        Trigger::EveryScan | Trigger::Timed { interval_ns: 0, .. } => None,
        Trigger::Timed { interval_ns, .. } => Some(interval_ns),
    });
    intervals.reduce(greatest_common_divisor)
}

fn greatest_common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

fn lower_options(
    program: &hir::Program,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<iecc_lower::Options> {
    let base = &options.timer_base;
    let mut timer_units = Vec::with_capacity(base.timers.len());
    for (name, unit_ns) in &base.timers {
        match program.find(name).filter(|place| is_timer(program, place)) {
            Some(place) => timer_units.push((place, *unit_ns)),
            None => {
                let message = format!("the time base names `{name}`, which is no timer");
                diagnostics.push(Diagnostic::without_place(Code::E6030, message));
            }
        }
    }
    (timer_units.len() == base.timers.len()).then_some(iecc_lower::Options {
        timer_unit_ns: base.unit_ns,
        timer_units,
        on_fault: options.on_fault,
        ..iecc_lower::Options::default()
    })
}

fn is_timer(program: &hir::Program, place: &hir::Place) -> bool {
    let kind = program.types.struct_kind(program.type_of(place));
    kind == Some(StructKind::Timer)
}

#[cfg(test)]
mod tests {
    use super::greatest_common_divisor;

    #[test]
    fn the_tick_fits_into_all_intervals() {
        for (intervals, tick) in [(&[10][..], 10), (&[20, 50], 10), (&[6, 10, 15], 1)] {
            let found = intervals.iter().copied().reduce(greatest_common_divisor);
            assert_eq!(found, Some(tick), "{intervals:?}");
        }
    }
}
