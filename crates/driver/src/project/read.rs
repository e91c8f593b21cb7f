//! TOML to a project: syntax, then each key by the table of keys.

use super::Project;
use super::keys::{KEYS, TABLES, Table};
use crate::Choice;
use crate::run::parse_duration;
use iecc_diag::{Code, Diagnostic, Diagnostics, closest};
use iecc_source::{FileId, Span, Spanned};
use std::ops::Range;
use std::path::PathBuf;
use toml::de::{DeTable, DeValue};

/// A value of the file with its place.
pub(super) type Value<'t> = toml::Spanned<DeValue<'t>>;

/// Reads the text of a project file; `None` after mistakes.
pub(super) fn project(
    file: FileId,
    text: &str,
    folder: PathBuf,
    diagnostics: &mut Diagnostics,
) -> Option<Project> {
    let mut reader = Reader {
        file,
        found: Diagnostics::new(),
    };
    let (table, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        let span = reader.span(error.span().unwrap_or(0..0));
        let message = format!("this is no TOML: {}", error.message());
        reader
            .found
            .push(Diagnostic::new(Code::E6060, span, message));
    }
    let mut project = Project {
        folder,
        ..Project::default()
    };
    // Keys of a damaged file would only give more messages about the same place.
    if reader.found.is_empty() {
        reader.top(table.get_ref(), &mut project);
    }
    reader.found.sort();
    let failed = reader.found.has_errors();
    diagnostics.append(reader.found);
    (!failed).then_some(project)
}

/// Reads values, and takes notes of what is wrong.
pub(super) struct Reader {
    file: FileId,
    found: Diagnostics,
}

impl Reader {
    /// The place of a range of the text.
    pub(super) fn span(&self, range: Range<usize>) -> Span {
        Span::new(self.file, range.start as u32, range.end as u32)
    }

    /// Says that a value is not as it should be.
    pub(super) fn refuse(&mut self, span: Span, message: impl Into<String>) {
        self.found.push(Diagnostic::new(Code::E6062, span, message));
    }

    fn top(&mut self, table: &DeTable<'_>, project: &mut Project) {
        for (key, value) in table {
            let name: &str = key.get_ref();
            let span = self.span(key.span());
            if let Some(key) = KEYS.iter().find(|key| key.name == name) {
                (key.read)(self, project, value);
            } else if let Some(known) = TABLES.iter().find(|table| table.name == name) {
                self.table(known, value, project);
            } else {
                let keys = KEYS.iter().map(|key| key.name);
                let known = keys.chain(TABLES.iter().map(|table| table.name));
                self.unknown(span, name, &known.collect::<Vec<_>>());
            }
        }
    }

    fn table(&mut self, known: &Table, value: &Value<'_>, project: &mut Project) {
        let (name, span) = (known.name, self.span(value.span()));
        let DeValue::Table(table) = value.get_ref() else {
            return self.refuse(span, format!("`{name}` is a table, written `[{name}]`"));
        };
        for (key, value) in table {
            let written: &str = key.get_ref();
            let span = self.span(key.span());
            if let Some(key) = known.keys.iter().find(|key| key.name == written) {
                (key.read)(self, project, value);
            } else if let Some(others) = known.others {
                let name = Spanned::new(written.to_owned(), span);
                others(self, project, &name, value);
            } else {
                let keys = known.keys.iter().map(|key| key.name);
                self.unknown(span, written, &keys.collect::<Vec<_>>());
            }
        }
    }

    fn unknown(&mut self, span: Span, name: &str, known: &[&str]) {
        let message = format!("there is no key `{name}` here");
        let diagnostic = Diagnostic::new(Code::E6061, span, message).label("not known");
        let diagnostic = match closest(name, known.iter().copied()) {
            Some(meant) => diagnostic.note(format!("did you mean `{meant}`?")).fix(
                format!("write `{meant}`"),
                span,
                meant,
            ),
            None => diagnostic.note(format!("known are {}", known.join(", "))),
        };
        self.found.push(diagnostic);
    }

    /// Says that a key is no code.
    pub(super) fn no_code(&mut self, name: &Spanned<String>) {
        let message = format!("there is no code `{}`", name.node);
        let note = "known are `all` and the codes that `iecc explain` lists";
        self.found
            .push(Diagnostic::new(Code::E6061, name.span, message).note(note));
    }

    /// A text that is not empty.
    pub(super) fn text(&mut self, value: &Value<'_>) -> Option<Spanned<String>> {
        let span = self.span(value.span());
        match value.get_ref().as_str() {
            Some("") => {
                self.refuse(span, "the text is empty");
                None
            }
            Some(text) => Some(Spanned::new(text.to_owned(), span)),
            None => {
                self.refuse(span, "a text between quotation marks is expected");
                None
            }
        }
    }

    /// A text or a list of texts.
    pub(super) fn texts(&mut self, value: &Value<'_>) -> Option<Vec<Spanned<String>>> {
        let DeValue::Array(list) = value.get_ref() else {
            return Some(vec![self.text(value)?]);
        };
        let texts: Vec<_> = list.iter().map(|value| self.text(value)).collect();
        texts.into_iter().collect()
    }

    /// A duration above 0.
    pub(super) fn duration(&mut self, value: &Value<'_>) -> Option<u64> {
        let text = self.text(value)?;
        let wrong = match parse_duration(&text.node) {
            Ok(0) => "the time is 0".to_owned(),
            Ok(time_ns) => return Some(time_ns),
            Err(diagnostic) => diagnostic.message,
        };
        self.refuse(text.span, wrong);
        None
    }

    /// A whole number above 0.
    pub(super) fn number(&mut self, value: &Value<'_>) -> Option<u64> {
        let number = value.get_ref().as_integer();
        let digits = number.map(|number| (number.as_str().replace(['_', '+'], ""), number.radix()));
        let number = digits.and_then(|(digits, radix)| u64::from_str_radix(&digits, radix).ok());
        let number = number.filter(|&number| number > 0);
        if number.is_none() {
            let span = self.span(value.span());
            self.refuse(span, "a whole number above 0 is expected");
        }
        number
    }

    /// One of some words.
    pub(super) fn choice<T: Copy>(
        &mut self,
        value: &Value<'_>,
        choices: &[Choice<T>],
    ) -> Option<T> {
        let text = self.text(value)?;
        if let Some(value) = crate::choices::find(choices, &text.node) {
            return Some(value);
        }
        let names: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
        let message = format!("`{}` is none of {}", text.node, names.join(", "));
        let mut diagnostic = Diagnostic::new(Code::E6062, text.span, message);
        if let Some(meant) = closest(&text.node, names) {
            diagnostic = diagnostic.note(format!("did you mean `{meant}`?"));
        }
        self.found.push(diagnostic);
        None
    }
}
