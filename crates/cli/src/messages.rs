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
    /// What is said of a run instead of how many errors there are.
    pub(crate) verdict: Option<String>,
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
        let (errors, warnings) = (self.count(Severity::Error), self.count(Severity::Warning));
        if let Some(verdict) = &self.verdict {
            terminal::print(&format!("{verdict}\n"));
        } else if format == Format::Text && errors + warnings > 0 {
            terminal::complain(&summary(errors, warnings));
        }
        if errors == 0 {
            ExitCode::SUCCESS
        } else {
            terminal::errors()
        }
    }

    fn count(&self, severity: Severity) -> usize {
        let of_severity = |d: &&iecc_diag::Diagnostic| d.severity == severity;
        self.diagnostics.iter().filter(of_severity).count()
    }
}

/// "3 errors, 2 warnings".
fn summary(errors: usize, warnings: usize) -> String {
    let counted = [(errors, "error"), (warnings, "warning")];
    let parts = counted.into_iter().filter(|(count, _)| *count > 0);
    let parts = parts.map(|(count, word)| {
        let plural = if count == 1 { "" } else { "s" };
        format!("{count} {word}{plural}")
    });
    parts.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::summary;

    #[test]
    fn the_summary_counts_what_there_is() {
        assert_eq!(summary(1, 0), "1 error");
        assert_eq!(summary(0, 2), "2 warnings");
        assert_eq!(summary(3, 1), "3 errors, 1 warning");
    }
}
