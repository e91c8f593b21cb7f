//! Says where text is.
//!
//! A [`Span`] is a byte range in one file of a [`SourceMap`]; a [`LineIndex`] turns byte offsets
//! into the line and column a person (1-based, UTF-8 characters) or an editor (0-based, UTF-16
//! units) counts; a [`MappedText`] is text that was decoded from a file and knows the way
//! back. Nothing here reads files: the text comes in as an argument.

mod hash;
mod line_index;
mod mapped;
mod span;

pub use hash::{ContentHash, fold_hash};
pub use line_index::{LineColumn, LineIndex, Utf16Position};
pub use mapped::MappedText;
pub use span::{FileId, Span, Spanned, TextRange};

/// One source text and the name under which messages show it.
#[derive(Debug, Clone)]
pub struct SourceFile {
    name: String,
    text: String,
    lines: LineIndex,
}

impl SourceFile {
    /// The name shown in messages, usually the path as the user gave it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text, exactly as read (including any byte order mark).
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The line table of the text.
    pub fn lines(&self) -> &LineIndex {
        &self.lines
    }
}

/// All source texts of one run. Files are never taken away, so a [`FileId`] never dangles; spans
/// are good until [`replace`](SourceMap::replace) gives their file another text.
#[derive(Debug, Clone, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
}

impl SourceMap {
    /// An empty map.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a text under a display name.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> FileId {
        let text = text.into();
        let lines = LineIndex::new(&text);
        self.files.push(SourceFile {
            name: name.into(),
            text,
            lines,
        });
        FileId::from_index(self.files.len() - 1)
    }

    /// Gives a file another text.
    pub fn replace(&mut self, id: FileId, text: impl Into<String>) {
        let file = &mut self.files[id.index()];
        file.text = text.into();
        file.lines = LineIndex::new(&file.text);
    }

    /// The file of an id that this map gave out.
    pub fn file(&self, id: FileId) -> &SourceFile {
        &self.files[id.index()]
    }

    /// The text under a span.
    pub fn slice(&self, span: Span) -> &str {
        &self.file(span.file).text[span.range()]
    }

    /// Line and column (1-based) of the start of a span.
    pub fn start(&self, span: Span) -> LineColumn {
        let file = self.file(span.file);
        file.lines.line_column(&file.text, span.start)
    }

    /// Line and column (1-based) just behind the end of a span.
    pub fn end(&self, span: Span) -> LineColumn {
        let file = self.file(span.file);
        file.lines.line_column(&file.text, span.end)
    }

    /// All ids, in the order the files were added.
    pub fn ids(&self) -> impl Iterator<Item = FileId> + use<> {
        (0..self.files.len()).map(FileId::from_index)
    }
}
