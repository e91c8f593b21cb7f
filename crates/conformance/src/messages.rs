//! What messages a case expects: marks at the ends of lines, `(*~ E2003 *)` for errors and
//! `(*~ W: E3007 *)` for warnings, several codes in one mark or several marks on a line.

use crate::case::CaseError;
use iecc_diag::{Code, Diagnostic, Diagnostics, Severity};
use iecc_source::{FileId, SourceMap};
use std::fmt;

/// How a mark begins.
const OPENER: &str = "(*~";

/// A message, by what is promised about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Expected {
    /// The line it is about; 0 if it is about none.
    pub line: usize,
    /// Its code.
    pub code: Code,
    /// Its severity.
    pub severity: Severity,
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (severity, code) = (self.severity.as_str(), self.code);
        match self.line {
            0 => write!(f, "{severity} {code} without a line"),
            line => write!(f, "{severity} {code} in line {line}"),
        }
    }
}

/// The messages a text expects, sorted.
pub(crate) fn expected(text: &str) -> Result<Vec<Expected>, CaseError> {
    let mut found = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        for mark in text.split(OPENER).skip(1) {
            let (mark, _) = mark
                .split_once("*)")
                .ok_or_else(|| CaseError::at(line, "the mark of a message is not closed"))?;
            found.extend(codes(mark, line)?);
        }
    }
    found.sort_unstable();
    Ok(found)
}

fn codes(mark: &str, line: usize) -> Result<Vec<Expected>, CaseError> {
    let (severity, mark) = match mark.trim().strip_prefix("W:") {
        Some(rest) => (Severity::Warning, rest),
        None => (Severity::Error, mark),
    };
    let expected = |name: &str| match Code::parse(name) {
        Some(code) => Ok(Expected {
            line,
            code,
            severity,
        }),
        None => Err(CaseError::at(line, format!("there is no code `{name}`"))),
    };
    let codes: Result<Vec<_>, _> = mark.split_whitespace().map(expected).collect();
    let codes = codes?;
    if codes.is_empty() {
        return Err(CaseError::at(line, "the mark of a message has no code"));
    }
    Ok(codes)
}

/// Compares what was said with what is expected about a file; gives what is missing and what is too
/// much. What is said about another file, such as one of the library, is too much.
pub(crate) fn compare(
    expected: &[Expected],
    diagnostics: &Diagnostics,
    map: &SourceMap,
    file: FileId,
) -> Result<(), String> {
    let mut open = expected.to_vec();
    let mut faults = Vec::new();
    for diagnostic in diagnostics {
        let (own, found) = describe(diagnostic, map, file);
        let wanted = open.iter().position(|message| own && *message == found);
        match wanted {
            Some(index) => drop(open.remove(index)),
            None => {
                let place = place_elsewhere(diagnostic, map, file);
                faults.push(format!("unexpected {found}{place}: {}", diagnostic.message));
            }
        }
    }
    faults.extend(open.iter().map(|message| format!("missing {message}")));
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults.join("; "))
    }
}

/// Whether a message is about the file, and what is promised about messages.
fn describe(diagnostic: &Diagnostic, map: &SourceMap, file: FileId) -> (bool, Expected) {
    let place = diagnostic.primary.as_ref();
    let found = Expected {
        line: place.map_or(0, |label| map.start(label.span).line as usize),
        code: diagnostic.code,
        severity: diagnostic.severity,
    };
    (place.is_none_or(|label| label.span.file == file), found)
}

/// The name of the file that a message is about, if it is not the one.
fn place_elsewhere(diagnostic: &Diagnostic, map: &SourceMap, file: FileId) -> String {
    let other = diagnostic.primary.as_ref().map(|label| label.span.file);
    let other = other.filter(|other| *other != file);
    other.map_or(String::new(), |other| {
        format!(" of {}", map.file(other).name())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use iecc_source::Span;

    const TEXT: &str = "a (*~ E0010 *)\n\nb (*~ W: E0011 E0012 *) (*~ E0013 *)\n";

    fn message(line: usize, code: Code, severity: Severity) -> Expected {
        Expected {
            line,
            code,
            severity,
        }
    }

    #[test]
    fn marks_name_codes_at_lines() {
        let expected = expected(TEXT).unwrap();
        assert_eq!(
            expected,
            [
                message(1, Code::E0010, Severity::Error),
                message(3, Code::E0011, Severity::Warning),
                message(3, Code::E0012, Severity::Warning),
                message(3, Code::E0013, Severity::Error),
            ]
        );
    }

    #[test]
    fn marks_that_name_nothing_are_refused() {
        for text in ["(*~ E0010", "(*~ *)", "(*~ W: *)", "(*~ E0000 *)"] {
            assert_eq!(expected(text).unwrap_err().line, 1, "{text}");
        }
    }

    #[test]
    fn exactly_the_expected_messages_are_right() {
        let mut map = SourceMap::new();
        let file = map.add("case.st", TEXT);
        let other = map.add("library.st", TEXT);
        let expected = [message(1, Code::E0010, Severity::Error)];
        let said_about = |about, codes: &[(Code, u32)]| {
            let mut diagnostics = Diagnostics::new();
            for &(code, at) in codes {
                diagnostics.push(Diagnostic::new(code, Span::point(file, at), "text"));
            }
            compare(&expected, &diagnostics, &map, about)
        };
        let said = |codes: &[(Code, u32)]| said_about(file, codes);
        assert_eq!(said(&[(Code::E0010, 0)]), Ok(()));
        let error = said(&[]).unwrap_err();
        assert_eq!(error, "missing error E0010 in line 1");
        let error = said(&[(Code::E0010, 0), (Code::E0010, 1)]).unwrap_err();
        assert_eq!(error, "unexpected error E0010 in line 1: text");
        let error = said(&[(Code::E0010, 17)]).unwrap_err();
        assert_eq!(
            error,
            "unexpected error E0010 in line 3: text; missing error E0010 in line 1"
        );
        let error = said_about(other, &[(Code::E0010, 0)]).unwrap_err();
        assert_eq!(
            error,
            "unexpected error E0010 in line 1 of case.st: text; missing error E0010 in line 1"
        );
    }
}
