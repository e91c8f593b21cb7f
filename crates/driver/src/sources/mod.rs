//! The sources of one program: which files, in which language.
//!
//! Paths of files and folders come in; a folder stands for the source files below it. The order is
//! that of the paths, and by name within a folder, so it is the same on every machine. A file that
//! is named twice is read once. Nothing is left out in silence: a named file must be of a known
//! kind, and known kinds that are not read give a warning where they stand in a folder.

mod folder;
mod kinds;

pub(crate) use folder::{Folder, entries};
pub use kinds::{FRONTENDS, FrontEnd, Language};

use crate::Levels;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{FileId, SourceMap};
use kinds::{Kind, kind_of, known_endings};

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The files of a program, all in one language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sources {
    language: Language,
    files: Vec<FileId>,
    stdlib: Vec<FileId>,
}

impl Sources {
    /// A Logix export.
    pub fn logix(map: &mut SourceMap, file: FileId) -> Self {
        Self::with_library(map, Language::Logix, vec![file], iecc_stdlib::ROCKWELL)
    }

    /// Files of Structured Text.
    pub fn text(map: &mut SourceMap, files: Vec<FileId>) -> Self {
        Self::with_library(map, Language::StructuredText, files, iecc_stdlib::IEC)
    }

    /// The texts of the library follow the others in the map.
    fn with_library(
        map: &mut SourceMap,
        language: Language,
        files: Vec<FileId>,
        library: &[iecc_stdlib::File],
    ) -> Self {
        let library = library.iter();
        let library = library.map(|file| map.add(file.path, file.text)).collect();
        Self {
            language,
            files,
            stdlib: library,
        }
    }

    /// Reads the files at the paths and in the folders at the paths; `None` after mistakes.
    pub fn load(
        map: &mut SourceMap,
        paths: &[PathBuf],
        levels: &Levels,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        Self::load_without(map, paths, &[], levels, diagnostics)
    }

    /// As [`Sources::load`], but for the files at some paths and in the folders at some paths.
    pub(crate) fn load_without(
        map: &mut SourceMap,
        paths: &[PathBuf],
        without: &[PathBuf],
        levels: &Levels,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        let mut found = Diagnostics::new();
        let sources = Search::new(&mut found)
            .leave_out(without)
            .all(paths)
            .and_then(|chosen| chosen.read(map, &mut found));
        levels.apply(&mut found);
        let failed = found.has_errors();
        diagnostics.append(found);
        sources.filter(|_| !failed)
    }

    /// Their language.
    pub fn language(&self) -> Language {
        self.language
    }

    /// The files, in order.
    pub fn files(&self) -> &[FileId] {
        &self.files
    }

    /// The files of the standard library, in order.
    pub(crate) fn stdlib(&self) -> &[FileId] {
        &self.stdlib
    }
}

/// Reads a file into the map.
#[expect(
    clippy::disallowed_methods,
    reason = "the driver is where files are read"
)]
pub fn load(map: &mut SourceMap, path: &Path, diagnostics: &mut Diagnostics) -> Option<FileId> {
    let name = path.display().to_string();
    if fs::metadata(path).is_ok_and(|data| data.len() > MAX_BYTES) {
        let message = format!("{name} has more than {} MiB", MAX_BYTES >> 20);
        diagnostics.push(Diagnostic::without_place(Code::E0003, message));
        return None;
    }
    let bytes = match fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            diagnostics.push(unreadable(path, &error));
            return None;
        }
    };
    match String::from_utf8(bytes) {
        Ok(text) => Some(map.add(name, text)),
        Err(error) => {
            let offset = error.utf8_error().valid_up_to();
            let message = match error.as_bytes() {
                [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => format!("{name} is UTF-16 text"),
                _ => format!("{name}: byte {offset} begins no UTF-8 character"),
            };
            let diagnostic = Diagnostic::without_place(Code::E0002, message);
            diagnostics.push(diagnostic.note("save the file in the encoding UTF-8"));
            None
        }
    }
}

/// Places in a text count in 32 bits; this is far below.
const MAX_BYTES: u64 = 256 << 20;

fn unreadable(path: &Path, error: &std::io::Error) -> Diagnostic {
    Diagnostic::without_place(Code::E0001, format!("{}: {error}", path.display()))
}

/// Files that were found, each with its language.
#[derive(Debug, Default)]
struct Chosen {
    files: Vec<(PathBuf, Language)>,
}

/// Looks for source files.
struct Search<'d> {
    chosen: Chosen,
    /// What was taken already, by its real path.
    taken: BTreeSet<PathBuf>,
    diagnostics: &'d mut Diagnostics,
}

impl<'d> Search<'d> {
    fn new(diagnostics: &'d mut Diagnostics) -> Self {
        Self {
            chosen: Chosen::default(),
            taken: BTreeSet::new(),
            diagnostics,
        }
    }

    /// Takes files as read already.
    fn leave_out(mut self, paths: &[PathBuf]) -> Self {
        for path in paths {
            match Folder::read(path) {
                Ok(folder) => folder
                    .files
                    .iter()
                    .for_each(|file| self.leave_out_file(file)),
                Err(_) => self.leave_out_file(path),
            }
        }
        self
    }

    fn leave_out_file(&mut self, path: &Path) {
        let real = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        self.taken.insert(real);
    }

    fn all(mut self, paths: &[PathBuf]) -> Option<Chosen> {
        for path in paths {
            match fs::metadata(path) {
                Ok(data) if data.is_dir() => self.folder(path),
                Ok(_) => self.file(path),
                Err(error) => self.diagnostics.push(unreadable(path, &error)),
            }
        }
        (!self.diagnostics.has_errors()).then_some(self.chosen)
    }

    fn file(&mut self, path: &Path) {
        let refused = match kind_of(path) {
            Kind::Source(language) => return self.take(path, language),
            Kind::Other(what) => format!("`{}` is {what}", path.display()),
            Kind::Unknown => format!("`{}` is of no kind that iecc knows", path.display()),
        };
        let diagnostic = Diagnostic::without_place(Code::E6050, refused);
        self.diagnostics.push(diagnostic.note(what_is_read()));
    }

    fn take(&mut self, path: &Path, language: Language) {
        let real = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if self.taken.insert(real) {
            self.chosen.files.push((path.to_owned(), language));
        }
    }

    fn folder(&mut self, path: &Path) {
        let folder = match Folder::read(path) {
            Ok(folder) => folder,
            Err(diagnostic) => return self.diagnostics.push(diagnostic),
        };
        let mut sources = 0;
        for file in &folder.files {
            match kind_of(file) {
                Kind::Source(language) => {
                    sources += 1;
                    self.take(file, language);
                }
                Kind::Other(what) => {
                    let message = format!("`{}` is {what}; it is left out", file.display());
                    self.diagnostics
                        .push(Diagnostic::without_place(Code::E6053, message));
                }
                Kind::Unknown => {}
            }
        }
        if sources == 0 {
            let message = format!("there is no source file in `{}`", path.display());
            self.diagnostics.push(nothing(message));
        }
    }
}

/// Whether a path names a source file.
pub(crate) fn is_source(path: &Path) -> bool {
    matches!(kind_of(path), Kind::Source(_))
}

pub(crate) fn nothing(message: String) -> Diagnostic {
    Diagnostic::without_place(Code::E6052, message).note(what_is_read())
}

fn what_is_read() -> String {
    format!("iecc reads {}", known_endings())
}

impl Chosen {
    fn read(self, map: &mut SourceMap, diagnostics: &mut Diagnostics) -> Option<Sources> {
        let language = self.language(diagnostics)?;
        let paths = self.files.iter();
        let files: Vec<Option<FileId>> = paths
            .map(|(path, _)| load(map, path, diagnostics))
            .collect();
        let files: Vec<FileId> = files.into_iter().collect::<Option<_>>()?;
        Some(match language {
            Language::Logix => Sources::logix(map, files[0]),
            Language::StructuredText => Sources::text(map, files),
        })
    }

    /// The language of all of them.
    fn language(&self, diagnostics: &mut Diagnostics) -> Option<Language> {
        let Some((first, language)) = self.files.first() else {
            diagnostics.push(nothing("there is no source file".to_owned()));
            return None;
        };
        let fits = |other: &Language| other == language && language.front_end().many;
        let misfit = self.files[1..].iter().find(|(_, other)| !fits(other));
        let Some((path, other)) = misfit else {
            return Some(*language);
        };
        let (name, other_name) = (language.front_end().name, other.front_end().name);
        let message = if other == language {
            format!("`{}` is a second {name}", path.display())
        } else {
            format!(
                "`{}` is a {other_name}, and a {name} is there already",
                path.display()
            )
        };
        let note = format!(
            "`{}` came first; a program is one Logix export, or files of Structured Text",
            first.display()
        );
        diagnostics.push(Diagnostic::without_place(Code::E6051, message).note(note));
        None
    }
}

#[cfg(test)]
mod tests;
