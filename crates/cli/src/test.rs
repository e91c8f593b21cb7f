//! `iecc test`: runs the unit tests of a program and says what failed.

use crate::messages::Messages;
use crate::program::Program;
use crate::terminal;
use clap::ValueEnum;
use iecc_driver::testing::{TestEngine, TestProgram, TestResult, junit};
use iecc_driver::write_file;
use iecc_source::SourceMap;
use std::path::PathBuf;

/// Run the unit tests of a program
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    program: Program,

    /// Run the tests with this text in `file: title` only, upper or lower case
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,

    /// What executes the tests
    #[arg(long, value_enum, default_value = "jit")]
    engine: EngineChoice,

    /// Write the results for CI servers, in the XML of JUnit
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum EngineChoice {
    /// Machine code of this computer
    Jit,
    /// The reference interpreter: the definition of what the program means
    Interp,
}

/// Runs the tests; results and what is wrong go into the messages.
///
/// # Errors
/// There is no test, or none that fits, or an option means nothing for tests.
pub(crate) fn run(arguments: &Arguments, messages: &mut Messages) -> Result<(), String> {
    if arguments.program.names_entry() {
        return Err("--entry means nothing for tests, which call what is to run".to_owned());
    }
    let Some(program) = arguments.program.compile_tests(messages) else {
        return Ok(());
    };
    let chosen = arguments.chosen(&messages.map, &program)?;
    let engine = match arguments.engine {
        EngineChoice::Jit => TestEngine::Jit,
        EngineChoice::Interp => TestEngine::Interp,
    };
    let mut tests = program.start(engine);
    let mut listing = Listing::default();
    let mut results = Vec::with_capacity(chosen.len());
    for position in chosen {
        match tests.run(position) {
            Ok(result) => {
                listing.show(&messages.map, &program, &result);
                results.push(result);
            }
            Err(refused) => {
                let refused = refused.into_iter();
                refused.for_each(|diagnostic| messages.diagnostics.push(diagnostic));
                return Ok(());
            }
        }
    }
    terminal::print("\n");
    if let Some(path) = &arguments.junit {
        let text = junit(&messages.map, &program, &results);
        if let Err(diagnostic) = write_file(path, &text) {
            messages.diagnostics.push(diagnostic);
        }
    }
    messages.verdict = Some(verdict(&results));
    let failures = results.into_iter().filter_map(|result| result.failure);
    failures.for_each(|failure| messages.diagnostics.push(failure.diagnostic));
    Ok(())
}

impl Arguments {
    /// The positions of the tests to run.
    fn chosen(&self, map: &SourceMap, program: &TestProgram) -> Result<Vec<usize>, String> {
        let text = self.filter.as_deref().unwrap_or("");
        let chosen = program.matching(map, text);
        match &self.filter {
            _ if program.tests().is_empty() => Err("there are no tests here".to_owned()),
            Some(text) if chosen.is_empty() => Err(format!("no test matches `{text}`")),
            Some(_) | None => Ok(chosen),
        }
    }
}

/// The results as a list, under the files of the tests.
#[derive(Default)]
struct Listing {
    file: Option<iecc_source::FileId>,
}

impl Listing {
    fn show(&mut self, map: &SourceMap, program: &TestProgram, result: &TestResult) {
        let test = &program.tests()[result.position];
        if self.file.replace(test.file) != Some(test.file) {
            terminal::print(&format!("{}\n", map.file(test.file).name()));
        }
        let word = match result.failure {
            None => "ok    ",
            Some(_) => "FAILED",
        };
        // A title is one line, whatever stands in it.
        let title = test.title.replace(char::is_control, "\u{fffd}");
        terminal::print(&format!("  {word}  {title}\n"));
    }
}

/// "3 tests: 2 passed, 1 failed".
fn verdict(results: &[TestResult]) -> String {
    let failed = results
        .iter()
        .filter(|result| result.failure.is_some())
        .count();
    let plural = if results.len() == 1 { "" } else { "s" };
    let passed = results.len() - failed;
    format!(
        "{} test{plural}: {passed} passed, {failed} failed",
        results.len()
    )
}
