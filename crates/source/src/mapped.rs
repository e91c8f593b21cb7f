//! Text that was decoded from a file, with the way back to where each byte is written.
//!
//! XML holds program text in CDATA sections (verbatim) and in character data whose entities are
//! shorter decoded than written. A [`MappedText`] is the decoded text plus a list of pieces, so
//! that a byte range of the text becomes an exact [`Span`] in the file.

use crate::{FileId, Span};
use std::ops::Range;

/// A run of decoded bytes and the file bytes it was decoded from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Piece {
    text_start: u32,
    source_start: u32,
    source_end: u32,
    /// Decoded and written bytes are the same; otherwise the piece is one entity.
    verbatim: bool,
}

/// Decoded text and, for every byte of it, the place in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MappedText {
    text: String,
    pieces: Vec<Piece>,
    whole: Span,
}

impl MappedText {
    /// An empty text at a place, to be filled piece by piece in file order.
    pub fn empty(whole: Span) -> Self {
        Self {
            text: String::new(),
            pieces: Vec::new(),
            whole,
        }
    }

    /// A text that stands in the file as it is, from `start`.
    pub fn verbatim(file: FileId, start: u32, text: impl Into<String>) -> Self {
        let text = text.into();
        let whole = Span::new(file, start, start + text.len() as u32);
        let mut mapped = Self::empty(whole);
        mapped.push_verbatim(&text, start);
        mapped
    }

    /// Appends text that stands in the file unchanged from `source_start`.
    pub fn push_verbatim(&mut self, text: &str, source_start: u32) {
        self.push(text, source_start..source_start + text.len() as u32, true);
    }

    /// Appends text that stands in the file in another form (an entity) at `source`.
    pub fn push_decoded(&mut self, text: &str, source: Range<u32>) {
        self.push(text, source, false);
    }

    fn push(&mut self, text: &str, source: Range<u32>, verbatim: bool) {
        if text.is_empty() {
            return;
        }
        let text_start = self.text.len() as u32;
        let (source_start, source_end) = (source.start, source.end);
        self.pieces.push(Piece {
            text_start,
            source_start,
            source_end,
            verbatim,
        });
        self.text.push_str(text);
    }

    /// The decoded text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Where the text stands as a whole, mark-up between its pieces included.
    pub fn whole(&self) -> Span {
        self.whole
    }

    /// The place of a byte range of the decoded text; an empty range gives a point.
    pub fn span(&self, range: Range<usize>) -> Span {
        if self.pieces.is_empty() {
            return Span::point(self.whole.file, self.whole.end);
        }
        let start = self.start_of(range.start as u32);
        let end = if range.is_empty() {
            start
        } else {
            self.end_of(range.end as u32)
        };
        Span::new(self.whole.file, start, end.max(start))
    }

    /// File offset of the byte at `offset`; behind the last byte it is the end of the last piece.
    fn start_of(&self, offset: u32) -> u32 {
        if offset as usize >= self.text.len() {
            return self.end_of(offset);
        }
        let piece = self.piece_of(offset);
        piece.source_start
            + if piece.verbatim {
                offset - piece.text_start
            } else {
                0
            }
    }

    /// File offset just behind the byte before `offset`.
    fn end_of(&self, offset: u32) -> u32 {
        let last = offset.saturating_sub(1);
        let piece = self.piece_of(last);
        let verbatim_end = piece.source_start + (last - piece.text_start) + 1;
        if piece.verbatim {
            verbatim_end.min(piece.source_end)
        } else {
            piece.source_end
        }
    }

    fn piece_of(&self, offset: u32) -> Piece {
        let behind = self
            .pieces
            .partition_point(|piece| piece.text_start <= offset);
        self.pieces[behind.saturating_sub(1)]
    }

    /// The text without white space at both ends, still mapped.
    #[must_use]
    pub fn trimmed(&self) -> Self {
        let start = self.text.len() - self.text.trim_start().len();
        let end = self.text.trim_end().len().max(start);
        let mut trimmed = Self::empty(self.span(start..end));
        for (index, piece) in self.pieces.iter().enumerate() {
            let piece_end = self
                .pieces
                .get(index + 1)
                .map_or(self.text.len(), |next| next.text_start as usize);
            let (from, to) = ((piece.text_start as usize).max(start), piece_end.min(end));
            if from < to {
                let span = self.span(from..to);
                trimmed.push(&self.text[from..to], span.start..span.end, piece.verbatim);
            }
        }
        trimmed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text `a&lt;b` at offset 10 in a file, then CDATA text `cd` at offset 30.
    fn sample() -> MappedText {
        let file = FileId::from_index(0);
        let mut text = MappedText::empty(Span::new(file, 10, 35));
        text.push_verbatim("a", 10);
        text.push_decoded("<", 11..15);
        text.push_verbatim("b", 15);
        text.push_verbatim("cd", 30);
        text
    }

    fn range(text: &MappedText, range: Range<usize>) -> Range<usize> {
        text.span(range).range()
    }

    #[test]
    fn ranges_map_to_the_bytes_they_were_decoded_from() {
        let text = sample();
        assert_eq!(text.text(), "a<bcd");
        assert_eq!(range(&text, 0..1), 10..11);
        assert_eq!(range(&text, 1..2), 11..15, "the entity as a whole");
        assert_eq!(range(&text, 2..3), 15..16);
        assert_eq!(range(&text, 3..5), 30..32);
        assert_eq!(range(&text, 0..5), 10..32);
    }

    #[test]
    fn an_empty_range_is_a_point_also_behind_the_end() {
        let text = sample();
        assert_eq!(range(&text, 2..2), 15..15);
        assert_eq!(range(&text, 5..5), 32..32);
        let file = FileId::from_index(0);
        assert_eq!(range(&MappedText::empty(Span::new(file, 4, 9)), 0..0), 9..9);
    }

    #[test]
    fn trimming_keeps_places() {
        let file = FileId::from_index(0);
        let text = MappedText::verbatim(file, 100, "\r\n  XIC(a);\n").trimmed();
        assert_eq!(text.text(), "XIC(a);");
        assert_eq!(range(&text, 0..3), 104..107);
        assert_eq!(text.whole().range(), 104..111);
        let blank = MappedText::verbatim(file, 100, " \n ").trimmed();
        assert_eq!(blank.text(), "");
        assert_eq!(blank.whole().range(), 103..103);
    }
}
