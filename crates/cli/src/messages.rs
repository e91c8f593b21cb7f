//! Messages of one run: collected with their sources, shown at the end.

use crate::terminal;
use clap::ValueEnum;
use iecc_diag::{Diagnostics, Severity, render_json, render_text};
use iecc_source::SourceMap;
use std::io::{IsTerminal, stderr};
use std::process::ExitCode;

/// How messages are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Format {
    /// For people, with the lines of source
    #[default]
    Text,
    /// One JSON object a line
    Json,
}

/// The sources that were read and what is to be said of them.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    pub(crate) map: SourceMap,
    pub(crate) diagnostics: Diagnostics,
}

impl Messages {
    /// Shows everything. The exit code says whether there were errors.
    pub(crate) fn finish(&self, format: Format) -> ExitCode {
        let colour = stderr().is_terminal();
        for diagnostic in &self.diagnostics {
            match format {
                Format::Text => {
                    terminal::complain(render_text(&self.map, diagnostic, colour).trim_end());
                    terminal::complain("");
                }
                Format::Json => terminal::complain(&render_json(&self.map, diagnostic)),
            }
        }
        let errors = self.count(Severity::Error);
        if errors == 0 {
            return ExitCode::SUCCESS;
        }
        if format == Format::Text {
            let plural = if errors == 1 { "" } else { "s" };
            terminal::complain(&format!("{errors} error{plural}"));
        }
        terminal::errors()
    }

    fn count(&self, severity: Severity) -> usize {
        let of_severity = |d: &&iecc_diag::Diagnostic| d.severity == severity;
        self.diagnostics.iter().filter(of_severity).count()
    }
}
