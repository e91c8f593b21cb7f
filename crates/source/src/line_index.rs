//! Byte offset -> line and column, for people and for editors.

/// A position as people count: both 1-based, columns in Unicode scalar values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct LineColumn {
    /// Line, from 1.
    pub line: u32,
    /// Column, from 1.
    pub column: u32,
}

/// A position as editors count: both 0-based, columns in UTF-16 code units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Utf16Position {
    /// Line, from 0.
    pub line: u32,
    /// UTF-16 code units from the start of the line.
    pub character: u32,
}

/// Offsets of line starts. Lines end at `\n`; a `\r` before it belongs to the line.
#[derive(Debug, Clone)]
pub struct LineIndex {
    starts: Vec<u32>,
}

impl LineIndex {
    /// Scans a text once.
    pub fn new(text: &str) -> Self {
        let newlines = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n');
        let starts = std::iter::once(0)
            .chain(newlines.map(|(i, _)| i as u32 + 1))
            .collect();
        Self { starts }
    }

    /// Where a line (from 0) begins, for all lines that the text has.
    pub fn start_of(&self, line: usize) -> Option<u32> {
        self.starts.get(line).copied()
    }

    /// 0-based line that holds the offset; offsets past the end count as the last line.
    pub fn line_of(&self, offset: u32) -> usize {
        self.starts.partition_point(|&start| start <= offset) - 1
    }

    fn prefix<'t>(&self, text: &'t str, offset: u32) -> (usize, &'t str) {
        let line = self.line_of(offset);
        let start = self.starts[line] as usize;
        let mut end = (offset as usize).min(text.len()).max(start);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        // A byte order mark is not something a person sees in column 1.
        (line, text[start..end].trim_start_matches('\u{feff}'))
    }

    /// The position a person would name.
    pub fn line_column(&self, text: &str, offset: u32) -> LineColumn {
        let (line, prefix) = self.prefix(text, offset);
        LineColumn {
            line: line as u32 + 1,
            column: prefix.chars().count() as u32 + 1,
        }
    }

    /// The position an editor would name.
    pub fn utf16(&self, text: &str, offset: u32) -> Utf16Position {
        let (line, prefix) = self.prefix(text, offset);
        Utf16Position {
            line: line as u32,
            character: prefix.encode_utf16().count() as u32,
        }
    }

    /// How many lines the text has; a text without a newline has one.
    pub fn line_count(&self) -> usize {
        self.starts.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_for_people_and_utf16_units_for_editors() {
        let text = "\u{feff}ab\r\nx\u{1F600}y\n";
        let index = LineIndex::new(text);
        assert_eq!(
            index.line_column(text, 3),
            LineColumn { line: 1, column: 1 }
        );
        let y = text.find('y').unwrap() as u32;
        assert_eq!(
            index.line_column(text, y),
            LineColumn { line: 2, column: 3 }
        );
        assert_eq!(
            index.utf16(text, y),
            Utf16Position {
                line: 1,
                character: 3
            }
        );
        assert_eq!(
            index.line_column(text, 999),
            LineColumn { line: 3, column: 1 }
        );
        assert_eq!(index.line_count(), 3);
    }
}
