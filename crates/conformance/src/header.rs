//! The comment at the start of a case: keys with values, each with its line.

use crate::case::CaseError;

/// How the comment begins.
const OPENER: &str = "(*!";

/// The last key: the lines behind it are a table.
const TABLE: &str = "trace";

/// The keys of a case.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Header {
    /// Keys, values, and the lines of the keys.
    pub(crate) keys: Vec<Key>,
    /// The rows of the table, if there is one.
    pub(crate) table: Option<Vec<TableLine>>,
    /// Number of lines the comment has.
    pub(crate) lines: usize,
}

/// A key with its value; lines that begin with no key continue the value before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Key {
    pub(crate) name: String,
    pub(crate) value: String,
    pub(crate) line: usize,
}

/// A line of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TableLine {
    pub(crate) text: String,
    pub(crate) line: usize,
}

/// Reads the comment.
pub(crate) fn header(text: &str) -> Result<Header, CaseError> {
    let body = text
        .strip_prefix(OPENER)
        .ok_or_else(|| CaseError::at(1, format!("a case begins with `{OPENER}`")))?;
    let end = body
        .find("*)")
        .ok_or_else(|| CaseError::at(1, "the comment at the start is not closed"))?;
    let body = &body[..end];
    let mut header = Header {
        lines: body.lines().count(),
        ..Header::default()
    };
    for (line, text) in (1..).zip(body.lines()) {
        header.take(line, text.trim())?;
    }
    Ok(header)
}

impl Header {
    fn take(&mut self, line: usize, text: &str) -> Result<(), CaseError> {
        if text.contains("(*") {
            return Err(CaseError::at(
                line,
                "the comment of a case holds no other comment",
            ));
        }
        if text.is_empty() {
            return Ok(());
        }
        if let Some(table) = &mut self.table {
            let text = text.to_owned();
            table.push(TableLine { text, line });
            return Ok(());
        }
        match split_key(text) {
            Some((TABLE, "")) => self.table = Some(Vec::new()),
            Some((TABLE, _)) => {
                return Err(CaseError::at(
                    line,
                    "the table of a trace begins on the next line",
                ));
            }
            Some((name, value)) => self.add(line, name, value)?,
            None => self.go_on(line, text)?,
        }
        Ok(())
    }

    fn add(&mut self, line: usize, name: &str, value: &str) -> Result<(), CaseError> {
        if self.keys.iter().any(|key| key.name == name) {
            return Err(CaseError::at(
                line,
                format!("the key `{name}` is there twice"),
            ));
        }
        self.keys.push(Key {
            name: name.to_owned(),
            value: value.to_owned(),
            line,
        });
        Ok(())
    }

    fn go_on(&mut self, line: usize, text: &str) -> Result<(), CaseError> {
        let Some(key) = self.keys.last_mut() else {
            return Err(CaseError::at(line, "a key such as `covers:` is missing"));
        };
        if !key.value.is_empty() {
            key.value.push(' ');
        }
        key.value.push_str(text);
        Ok(())
    }
}

/// `name: value`, where the name is lower-case letters and underlines.
fn split_key(text: &str) -> Option<(&str, &str)> {
    let (name, value) = text.split_once(':')?;
    let is_key = !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    let separate = value.is_empty() || value.starts_with(char::is_whitespace);
    (is_key && separate).then_some((name, value.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(name: &str, value: &str, line: usize) -> Key {
        Key {
            name: name.to_owned(),
            value: value.to_owned(),
            line,
        }
    }

    #[test]
    fn keys_may_go_on_and_the_table_is_the_rest() {
        let text = "(*! covers: ed3:71:8,\n      ed2:55:6\n    about: a fact: it holds\n    trace:\n      t | | x\n\n      0ms | | 1\n*)\nPROGRAM";
        let header = header(text).unwrap();
        assert_eq!(
            header.keys,
            [
                key("covers", "ed3:71:8, ed2:55:6", 1),
                key("about", "a fact: it holds", 3),
            ]
        );
        let rows = header.table.unwrap();
        let rows: Vec<_> = rows
            .iter()
            .map(|row| (row.line, row.text.as_str()))
            .collect();
        assert_eq!(rows, [(5, "t | | x"), (7, "0ms | | 1")]);
        assert_eq!(header.lines, 7);
    }

    #[test]
    fn what_is_no_header_is_refused_with_its_line() {
        for (text, line) in [
            ("PROGRAM p", 1),
            ("(*! about: x", 1),
            ("(*! about: x\n about: y *)", 2),
            ("(*!\n text without a key *)", 2),
            ("(*! about: x\n trace: t | | *)", 2),
            ("(*! about: (* inner *) *)", 1),
        ] {
            assert_eq!(header(text).unwrap_err().line, line, "{text}");
        }
    }
}
