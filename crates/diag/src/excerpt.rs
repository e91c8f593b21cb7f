//! The parts of source texts that one message shows.
//!
//! A line that no person wrote can be the whole file: tools save exports without line ends. So
//! long lines are cut around the labels of the message, and a label on a long line is shortened.
//! Numbers of lines and columns stay those of the file. Nothing is scanned but what is shown.

use crate::Diagnostic;
use codespan_reporting::files::{Error, Files};
use iecc_source::{FileId, SourceFile, SourceMap, Span};
use std::collections::BTreeMap;
use std::ops::Range;

/// Lines of at most this many bytes are shown whole.
const LONG_LINE: usize = 400;
/// On longer lines, bytes shown before and after a label.
const CONTEXT: usize = 60;
/// On longer lines, bytes of a label that are underlined.
const LONG_LABEL: usize = 120;

/// The sources as one message shows them.
pub(crate) struct Excerpt<'m> {
    map: &'m SourceMap,
    /// Offsets inside long lines at which a new line begins for the reader, ascending.
    cuts: BTreeMap<usize, Vec<usize>>,
}

impl<'m> Excerpt<'m> {
    pub(crate) fn new(map: &'m SourceMap, diagnostic: &Diagnostic) -> Self {
        let labels = diagnostic.primary.iter().chain(&diagnostic.secondary);
        let spans: Vec<Span> = labels.map(|label| label.span).collect();
        let mut excerpt = Self {
            map,
            cuts: BTreeMap::new(),
        };
        for &span in &spans {
            excerpt.cut_around(span);
        }
        excerpt.heal(&spans);
        excerpt
    }

    /// The range to underline: all of a span, or its beginning where it lies on a long line.
    pub(crate) fn shown(&self, span: Span) -> Range<usize> {
        let line = real_line(self.map.file(span.file), span.range().start);
        let range = span.range();
        if line.len() <= LONG_LINE || range.end > line.end || range.len() <= LONG_LABEL {
            return range;
        }
        let text = self.map.file(span.file).text();
        range.start..text.floor_char_boundary(range.start + LONG_LABEL)
    }

    fn cut_around(&mut self, span: Span) {
        let file = self.map.file(span.file);
        let text = file.text();
        let shown = self.shown(span);
        let before = text.floor_char_boundary(shown.start.saturating_sub(CONTEXT));
        self.cut(span.file, &real_line(file, shown.start), before);
        let behind = text.ceil_char_boundary(shown.end + CONTEXT);
        let line = real_line(file, shown.end);
        self.cut(span.file, &line, behind);
        // A single line between two labels would be shown as context, so there are always two.
        self.cut(span.file, &line, text.ceil_char_boundary(behind + 1));
    }

    fn cut(&mut self, file: FileId, line: &Range<usize>, cut: usize) {
        if line.len() > LONG_LINE && line.start < cut && cut < line.end {
            self.cuts.entry(file.index()).or_default().push(cut);
        }
    }

    /// Takes back cuts that would go through another label, and sorts the rest.
    fn heal(&mut self, spans: &[Span]) {
        let shown: Vec<_> = spans
            .iter()
            .map(|&s| (s.file.index(), self.shown(s)))
            .collect();
        for (file, cuts) in &mut self.cuts {
            let inside = |cut: usize| {
                let of_file = shown.iter().filter(|(other, _)| other == file);
                of_file
                    .into_iter()
                    .any(|(_, r)| r.start < cut && cut < r.end)
            };
            cuts.retain(|&cut| !inside(cut));
            cuts.sort_unstable();
            cuts.dedup();
        }
    }

    fn cuts(&self, id: FileId) -> &[usize] {
        self.cuts.get(&id.index()).map_or(&[], Vec::as_slice)
    }

    /// Where a line as the reader counts begins. Each cut stands among the real lines before it.
    fn start_of(&self, id: FileId, line: usize) -> Option<usize> {
        let lines = self.map.file(id).lines();
        let mut before = 0;
        for (count, &cut) in self.cuts(id).iter().enumerate() {
            let at = lines.line_of(cut as u32) + 1 + count;
            if at == line {
                return Some(cut);
            }
            before += usize::from(at < line);
        }
        lines.start_of(line - before).map(|start| start as usize)
    }
}

/// The line that holds an offset, without its line end.
fn real_line(file: &SourceFile, offset: usize) -> Range<usize> {
    let lines = file.lines();
    let line = lines.line_of(offset as u32);
    let start = lines.start_of(line).unwrap_or(0) as usize;
    let next = lines.start_of(line + 1);
    start..next.map_or(file.text().len(), |next| next as usize - 1)
}

impl<'m> Files<'m> for Excerpt<'m> {
    type FileId = FileId;
    type Name = &'m str;
    type Source = &'m str;

    fn name(&'m self, id: FileId) -> Result<&'m str, Error> {
        Ok(self.map.file(id).name())
    }

    fn source(&'m self, id: FileId) -> Result<&'m str, Error> {
        Ok(self.map.file(id).text())
    }

    fn line_index(&'m self, id: FileId, byte_index: usize) -> Result<usize, Error> {
        let cuts = self.cuts(id).partition_point(|&cut| cut <= byte_index);
        Ok(self.map.file(id).lines().line_of(byte_index as u32) + cuts)
    }

    fn line_number(&'m self, id: FileId, line_index: usize) -> Result<usize, Error> {
        let start = self.line_range(id, line_index)?.start;
        Ok(self.map.file(id).lines().line_of(start as u32) + 1)
    }

    fn column_number(&'m self, id: FileId, _: usize, byte_index: usize) -> Result<usize, Error> {
        let file = self.map.file(id);
        let position = file.lines().line_column(file.text(), byte_index as u32);
        Ok(position.column as usize)
    }

    fn line_range(&'m self, id: FileId, line_index: usize) -> Result<Range<usize>, Error> {
        let missing = || Error::LineTooLarge {
            given: line_index,
            max: self.map.file(id).lines().line_count() + self.cuts(id).len() - 1,
        };
        let start = self.start_of(id, line_index).ok_or_else(missing)?;
        let length = self.map.file(id).text().len();
        Ok(start..self.start_of(id, line_index + 1).unwrap_or(length))
    }
}

#[cfg(test)]
mod tests {
    use crate::{Code, Diagnostic, render_text};
    use iecc_source::{SourceMap, Span};

    fn render(text: &str, word: &str) -> String {
        let mut map = SourceMap::new();
        let file = map.add("a.L5X", text);
        let start = text.find(word).expect("the word is there");
        let span = Span::new(file, start as u32, (start + word.len()) as u32);
        let diagnostic = Diagnostic::new(Code::E5003, span, "wrong").label("here");
        render_text(&map, &diagnostic, false)
    }

    #[test]
    fn short_lines_are_shown_whole() {
        let shown = render("one\r\ntwo BAD two\r\nthree\r\n", "BAD");
        assert_eq!(
            shown,
            "error[E5003]: wrong\n  ┌─ a.L5X:2:5\n  │\n2 │ two BAD two\n  │     ^^^ here\n\n"
        );
    }

    #[test]
    fn a_long_line_is_cut_around_the_label_and_keeps_its_numbers() {
        let text = format!("one\n{}BAD{}\nthree\n", "é".repeat(5000), "y".repeat(5000));
        let shown = render(&text, "BAD");
        assert!(shown.contains("a.L5X:2:5001\n"), "{shown}");
        assert!(shown.contains(&format!("2 │ {}BAD{}\n", "é".repeat(30), "y".repeat(60))));
        assert!(
            shown.contains(&format!("│ {}^^^ here", " ".repeat(30))),
            "{shown}"
        );
        assert!(shown.len() < 700, "{shown}");
    }

    #[test]
    fn a_long_label_on_a_long_line_is_shortened() {
        let word = "w".repeat(100_000);
        let shown = render(&format!("{}{word}", "x".repeat(1000)), &word);
        assert!(shown.contains(&"^".repeat(120)), "{shown}");
        assert!(shown.len() < 1000, "{shown}");
    }

    #[test]
    fn the_end_of_a_text_without_a_line_end_can_be_shown() {
        let text = format!("{}BAD", "x".repeat(1000));
        let shown = render(&text, "BAD");
        assert!(shown.contains("a.L5X:1:1001\n"), "{shown}");
    }

    #[test]
    fn two_labels_on_one_long_line_are_both_underlined() {
        let text = format!(
            "{}AAA{}BBB{}",
            "x".repeat(900),
            "y".repeat(900),
            "z".repeat(900)
        );
        let mut map = SourceMap::new();
        let file = map.add("a", text.as_str());
        let diagnostic = Diagnostic::new(Code::E5003, Span::new(file, 900, 903), "wrong")
            .label("first")
            .also(Span::new(file, 1803, 1806), "second");
        let shown = render_text(&map, &diagnostic, false);
        assert!(
            shown.contains("^^^ first") && shown.contains("--- second"),
            "{shown}"
        );
        assert!(shown.len() < 900, "{shown}");
    }
}
