//! Kinds of files, by the ending of their names.

use std::path::Path;

/// A language that programs are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Language {
    /// A Logix export.
    Logix,
    /// Structured Text.
    StructuredText,
}

/// How files of a language are told from others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrontEnd {
    /// The language.
    pub language: Language,
    /// What one of its files is, as in "a Logix export".
    pub name: &'static str,
    /// Endings of their names, in lower case; the case does not matter.
    pub endings: &'static [&'static str],
    /// Whether a program may have several files.
    pub many: bool,
}

/// All languages that are read.
pub const FRONTENDS: &[FrontEnd] = &[
    FrontEnd {
        language: Language::Logix,
        name: "Logix export",
        endings: &["l5x"],
        many: false,
    },
    FrontEnd {
        language: Language::StructuredText,
        name: "file of Structured Text",
        endings: &["st", "iecst"],
        many: true,
    },
];

/// Files with programs that are not read, and why not: the rest of a sentence that begins with the
/// file.
const OTHERS: &[(&str, &str)] = &[
    ("acd", "a project of Studio 5000: export it as L5X"),
    ("l5k", "an export in the L5K format: export it as L5X"),
    ("rss", "a project of RSLogix 500, which is not read"),
    (
        "scl",
        "Siemens SCL, which is not Structured Text of IEC 61131-3",
    ),
    ("awl", "Siemens STL, which is not read"),
    ("il", "Instruction List, which is not compiled yet"),
    ("exp", "an export of CoDeSys 2, which is not read"),
    (
        "tcpou",
        "a TwinCAT file, which is not read: export its text",
    ),
    (
        "tcdut",
        "a TwinCAT file, which is not read: export its text",
    ),
    (
        "tcgvl",
        "a TwinCAT file, which is not read: export its text",
    ),
];

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A source file.
    Source(Language),
    /// A program that is not read.
    Other(&'static str),
    /// No program as far as its name tells.
    Unknown,
}

impl Language {
    /// Its row in the table.
    pub fn front_end(self) -> &'static FrontEnd {
        let row = FRONTENDS.iter().find(|row| row.language == self);
        row.expect("every language has a row")
    }
}

pub(super) fn kind_of(path: &Path) -> Kind {
    let ending = path
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    let ending = ending.as_deref().unwrap_or("");
    let source = FRONTENDS.iter().find(|row| row.endings.contains(&ending));
    if let Some(row) = source {
        return Kind::Source(row.language);
    }
    let other = OTHERS.iter().find(|(known, _)| *known == ending);
    other.map_or(Kind::Unknown, |(_, what)| Kind::Other(what))
}

/// The endings of source files, for messages.
pub(super) fn known_endings() -> String {
    let endings = FRONTENDS.iter().map(|row| {
        let endings: Vec<String> = row.endings.iter().map(|e| format!(".{e}")).collect();
        format!("{} ({})", endings.join(", "), row.language.title())
    });
    endings.collect::<Vec<_>>().join(" and ")
}

impl Language {
    fn title(self) -> &'static str {
        match self {
            Self::Logix => "Logix exports",
            Self::StructuredText => "Structured Text",
        }
    }
}
