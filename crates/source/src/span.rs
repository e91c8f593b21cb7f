//! Byte ranges that know their file.

use std::ops::Range;

/// Names one file of a [`SourceMap`](crate::SourceMap).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(u32);

impl FileId {
    /// The id of the `index`-th file of a map.
    pub fn from_index(index: usize) -> Self {
        Self(u32::try_from(index).expect("fewer than 2^32 source files"))
    }

    /// Position in the map.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A byte range `start..end` in one file. Offsets are `u32`: readers refuse larger texts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// The file the offsets count in.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// One behind the last byte.
    pub end: u32,
}

impl Span {
    /// The span `start..end` of `file`.
    pub fn new(file: FileId, start: u32, end: u32) -> Self {
        debug_assert!(start <= end);
        Self { file, start, end }
    }

    /// An empty span at `offset`.
    pub fn point(file: FileId, offset: u32) -> Self {
        Self::new(file, offset, offset)
    }

    /// The byte range for indexing the text.
    pub fn range(self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// The smallest span that holds both. Both must be in the same file.
    pub fn to(self, other: Span) -> Span {
        debug_assert_eq!(self.file, other.file);
        Span::new(
            self.file,
            self.start.min(other.start),
            self.end.max(other.end),
        )
    }
}

/// A byte range counted from some start that its owner knows, for example that of a program unit.
/// It stays the same when text before that start changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct TextRange {
    /// First byte.
    pub start: u32,
    /// One behind the last byte.
    pub end: u32,
}

impl TextRange {
    /// The range `start..end`.
    pub fn new(start: u32, end: u32) -> Self {
        debug_assert!(start <= end);
        Self { start, end }
    }

    /// The smallest range that holds both.
    pub fn to(self, other: TextRange) -> TextRange {
        Self::new(self.start.min(other.start), self.end.max(other.end))
    }

    /// The span in a file, of a range that counts from `base`.
    pub fn in_file(self, file: FileId, base: u32) -> Span {
        Span::new(file, base + self.start, base + self.end)
    }
}

/// Something together with the place where it is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Spanned<T> {
    /// What is written.
    pub node: T,
    /// Where.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// Pairs `node` with its place.
    pub fn new(node: T, span: Span) -> Self {
        Self { node, span }
    }
}
