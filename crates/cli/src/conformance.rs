//! `iecc conformance`: runs the conformance suite on every engine, and writes the compliance statement.

use crate::messages::Messages;
use crate::terminal;
use iecc_conformance::{Case, failures, read_suite, run_case, statement, summary};
use iecc_diag::{Code, Diagnostic};
use iecc_driver::{Levels, Sources, parallel_map};
use std::path::PathBuf;

/// Run the conformance suite of IEC 61131-3
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The folder with the cases, or one of them
    #[arg(default_value = "tests/conformance")]
    path: PathBuf,

    /// Write the compliance statement, as Markdown, from the results
    #[arg(long, conflicts_with = "filter")]
    statement: bool,

    /// Run only cases with this in their names, such as t46 or t46/on_delay
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,
}

pub(crate) fn run(arguments: &Arguments, messages: &mut Messages) {
    let Some(cases) = arguments.cases(messages) else {
        return;
    };
    let results = parallel_map(&cases, run_case);
    for failure in failures(&cases, &results) {
        let diagnostic = Diagnostic::without_place(Code::E6081, failure);
        messages.diagnostics.push(diagnostic);
    }
    if arguments.statement {
        terminal::print(&statement(&cases, &results));
    } else {
        terminal::print(&summary(&results));
    }
}

impl Arguments {
    fn cases(&self, messages: &mut Messages) -> Option<Vec<Case>> {
        let (map, diagnostics) = (&mut messages.map, &mut messages.diagnostics);
        let paths = std::slice::from_ref(&self.path);
        let sources = Sources::load(map, paths, &Levels::default(), diagnostics)?;
        match read_suite(map, sources.files()) {
            Ok(mut cases) => {
                let wanted = self.filter.as_deref().unwrap_or("");
                cases.retain(|case| case.name.contains(wanted));
                Some(cases)
            }
            Err(misread) => {
                for file in misread {
                    let message = file.to_string();
                    diagnostics.push(Diagnostic::without_place(Code::E6080, message));
                }
                None
            }
        }
    }
}
