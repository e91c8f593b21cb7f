//! CSV text as records whose cells know where they stand in the file.

use csv_core::{ReadFieldResult, Reader};
use iecc_source::{FileId, Span};
use std::ops::Range;

/// One cell, without quotes and surrounding blanks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) text: String,
    pub(super) span: Span,
}

/// The records of a text, with blank lines left out. Offsets fit `u32`: readers refuse larger files.
pub(super) fn records(file: FileId, text: &str) -> Vec<Vec<Cell>> {
    let mut reader = Reader::new();
    let mut offset = if text.starts_with('\u{feff}') { 3 } else { 0 };
    let (mut records, mut record) = (Vec::new(), Vec::new());
    let (mut start, mut length) = (offset, 0);
    // No cell is longer than the text.
    let mut buffer = vec![0; text.len() + 1];
    loop {
        let input = &text.as_bytes()[offset..];
        let (result, read, written) = reader.read_field(input, &mut buffer[length..]);
        offset += read;
        length += written;
        match result {
            // All has been read; the next call, with empty input, ends the cell.
            ReadFieldResult::InputEmpty => {}
            ReadFieldResult::OutputFull => panic!("the buffer is longer than the text"),
            ReadFieldResult::Field { record_end } => {
                record.push(cell(file, text, start..offset, &buffer[..length]));
                (start, length) = (offset, 0);
                if record_end {
                    records.push(std::mem::take(&mut record));
                }
            }
            ReadFieldResult::End => return records,
        }
    }
}

fn cell(file: FileId, text: &str, raw: Range<usize>, content: &[u8]) -> Cell {
    let (start, end) = trimmed(text, raw.start, raw.end);
    let content = String::from_utf8_lossy(content);
    Cell {
        text: content.trim().to_owned(),
        span: Span::new(file, start as u32, end as u32),
    }
}

/// The bytes of a cell without line ends, the comma behind it, and blanks.
fn trimmed(text: &str, start: usize, end: usize) -> (usize, usize) {
    let raw = &text[start..end];
    let raw = raw.strip_suffix(',').unwrap_or(raw);
    let start = start + (raw.len() - raw.trim_start().len());
    (start, start + raw.trim().len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(text: &str) -> Vec<Vec<(String, String)>> {
        let file = FileId::from_index(0);
        let cell = |cell: Cell| (cell.text, text[cell.span.range()].to_owned());
        let record = |record: Vec<Cell>| record.into_iter().map(cell).collect();
        records(file, text).into_iter().map(record).collect()
    }

    fn same(parts: &[&str]) -> Vec<(String, String)> {
        parts
            .iter()
            .map(|&p| (p.to_owned(), p.to_owned()))
            .collect()
    }

    #[test]
    fn cells_are_cut_at_commas_and_know_their_place() {
        let expected = vec![
            same(&["t_ms", "Start"]),
            same(&["0", "1"]),
            same(&["10", ""]),
        ];
        assert_eq!(cells("t_ms,Start\n0,1\n10,\n"), expected);
        assert_eq!(cells("\u{feff}t_ms, Start \r\n\r\n 0,1\r\n10,"), expected);
        assert_eq!(cells(""), Vec::<Vec<(String, String)>>::new());
    }

    #[test]
    fn quotes_hold_commas_and_are_removed() {
        let found = cells("\"a,b\",\"say \"\"hi\"\"\"\n");
        let expected = [("a,b", "\"a,b\""), ("say \"hi\"", "\"say \"\"hi\"\"\"")];
        assert_eq!(
            found,
            [expected.map(|(a, b)| (a.to_owned(), b.to_owned())).to_vec()]
        );
        assert_eq!(cells("\"open").len(), 1, "an open quote ends with the text");
    }
}
