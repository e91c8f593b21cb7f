//! What the tests here share.

use iecc_ast::Names;
use iecc_ast::st::{File, dump, print_file};
use iecc_diag::{Code, Diagnostics};
use iecc_grammar::st::{Dialect, parse_file};
use iecc_source::FileId;

pub(crate) fn file_id() -> FileId {
    FileId::from_index(0)
}

/// A parsed text.
pub(crate) struct Parsed {
    pub(crate) file: File,
    pub(crate) names: Names,
    pub(crate) diagnostics: Diagnostics,
}

pub(crate) fn parse(text: &str, dialect: Dialect) -> Parsed {
    let (mut names, mut diagnostics) = (Names::new(), Diagnostics::new());
    let file = parse_file(file_id(), text, dialect, &mut names, &mut diagnostics);
    Parsed {
        file,
        names,
        diagnostics,
    }
}

impl Parsed {
    pub(crate) fn outline(&self) -> String {
        let units = self.file.units.iter();
        units.map(|unit| dump(unit, &self.names)).collect()
    }

    pub(crate) fn print(&self) -> String {
        print_file(&self.file, &self.names)
    }
}

/// The outline of a text that is right. Its canonical text must have the same outline, and be its
/// own canonical text.
pub(crate) fn outline_in(text: &str, dialect: Dialect) -> String {
    let parsed = parse(text, dialect);
    assert!(
        parsed.diagnostics.is_empty(),
        "{text}\n{:#?}",
        parsed.diagnostics
    );
    let printed = parsed.print();
    let again = parse(&printed, dialect);
    assert!(
        again.diagnostics.is_empty(),
        "{printed}\n{:#?}",
        again.diagnostics
    );
    assert_eq!(again.outline(), parsed.outline(), "{printed}");
    assert_eq!(again.print(), printed);
    parsed.outline()
}

pub(crate) fn outline(text: &str) -> String {
    outline_in(text, Dialect::Iec)
}

/// The outline of statements, without the program around them.
pub(crate) fn statements(text: &str) -> String {
    let outline = outline(&format!("PROGRAM p {text} END_PROGRAM"));
    let lines = outline.lines().skip(1);
    lines.map(|line| format!("{}\n", &line[2..])).collect()
}

/// The outline of an expression.
pub(crate) fn expression(text: &str) -> String {
    let outline = statements(&format!("x := {text};"));
    let value = outline.strip_prefix(":= x ").expect("an assignment");
    value.trim_end().to_owned()
}

/// The codes of all messages of a text, each with the text at its place.
pub(crate) fn messages(text: &str) -> Vec<(Code, String)> {
    let parsed = parse(text, Dialect::Iec);
    let place = |diagnostic: &iecc_diag::Diagnostic| {
        let label = diagnostic.primary.as_ref().expect("a place");
        text[label.span.range()].to_owned()
    };
    let messages = parsed.diagnostics.iter();
    messages
        .map(|diagnostic| (diagnostic.code, place(diagnostic)))
        .collect()
}

/// The messages of statements in a program.
pub(crate) fn messages_in_body(body: &str) -> Vec<(Code, String)> {
    messages(&format!("PROGRAM p\n{body}\nEND_PROGRAM\n"))
}

/// Asserts that the statements give one message, with this code at this text.
#[track_caller]
pub(crate) fn one(body: &str, code: Code, place: &str) {
    assert_eq!(messages_in_body(body), [(code, place.to_owned())], "{body}");
}
