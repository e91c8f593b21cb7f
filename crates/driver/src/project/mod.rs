//! The project file `iecc.toml`: what a program is made of, and the choices that its source does not
//! make, so that nobody has to write them on every command line.
//!
//! Every key is known or refused with its place; nothing in the file is ignored. Paths count from
//! the folder of the file. What the command line says goes before what the file says.

mod keys;
mod pattern;
mod read;
#[cfg(test)]
mod tests;

use crate::sources::{Folder, entries, is_source, nothing};
use crate::{FrontOptions, Levels, Sources, Tests, load};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{SourceMap, Span, Spanned};
use pattern::Pattern;
use std::env;
use std::path::{Path, PathBuf};

/// The name of project files.
pub const PROJECT_FILE: &str = "iecc.toml";

/// What a project file says. What it leaves out has its usual value.
#[derive(Debug, Clone, Default)]
pub struct Project {
    /// The folder that paths count from.
    folder: PathBuf,
    /// Files, folders and patterns; the whole folder if `None`.
    sources: Option<Vec<Spanned<String>>>,
    /// Files, folders and patterns that hold tests and what only these need.
    tests: Vec<Spanned<String>>,
    /// Choices about the program.
    pub options: FrontOptions,
    /// The time from one scan to the next.
    pub period_ns: Option<u64>,
    /// Choices about hardware.
    pub verilog: VerilogSettings,
}

/// What a project file says about hardware.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VerilogSettings {
    /// Frequency of the clock.
    pub clock_hz: Option<u64>,
    /// The tick from which times are counted.
    pub tick_ns: Option<u64>,
    /// The board.
    pub board: Option<String>,
    /// The file that says which port is on which pin.
    pub pins: Option<PathBuf>,
}

/// What the paths of a command line stand for.
#[derive(Debug, Clone)]
pub enum Found {
    /// A project, whose file says what its sources are.
    Project(Box<Project>),
    /// Files and folders.
    Paths(Vec<PathBuf>),
}

/// Decides what the paths of a command line stand for: a project file or its folder, or files and
/// folders. Without paths it is the project of the current folder or of one above it; where there is
/// none, the source files right here. `None` after mistakes.
pub fn find(
    map: &mut SourceMap,
    paths: &[PathBuf],
    diagnostics: &mut Diagnostics,
) -> Option<Found> {
    let file = match paths {
        [] => match above() {
            Some(file) => file,
            None => return here(diagnostics).map(Found::Paths),
        },
        [path] if is_project_file(path) => path.clone(),
        [path] if path.join(PROJECT_FILE).is_file() => path.join(PROJECT_FILE),
        paths => return Some(Found::Paths(paths.to_vec())),
    };
    let project = Project::read(map, &file, diagnostics)?;
    Some(Found::Project(Box::new(project)))
}

fn is_project_file(path: &Path) -> bool {
    let ending = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    ending && !path.is_dir()
}

/// The project file of the current folder, or of the nearest folder above that has one.
fn above() -> Option<PathBuf> {
    let depth = env::current_dir().ok()?.ancestors().count();
    let folders = (0..depth).map(|up| (0..up).map(|_| "..").collect::<PathBuf>());
    let mut files = folders.map(|folder| folder.join(PROJECT_FILE));
    files.find(|file| file.is_file())
}

/// The source files that stand right in the current folder.
fn here(diagnostics: &mut Diagnostics) -> Option<Vec<PathBuf>> {
    let paths = entries(Path::new(".")).unwrap_or_default();
    let files = paths
        .into_iter()
        .filter(|path| path.is_file() && is_source(path));
    let names: Vec<PathBuf> = files
        .filter_map(|path| path.file_name().map(PathBuf::from))
        .collect();
    if names.is_empty() {
        let message = format!(
            "no file is named, and there is neither a project file `{PROJECT_FILE}` here or above, nor a source file here"
        );
        diagnostics.push(nothing(message));
        return None;
    }
    Some(names)
}

impl Project {
    /// Reads a project file; `None` after mistakes.
    pub fn read(map: &mut SourceMap, path: &Path, diagnostics: &mut Diagnostics) -> Option<Self> {
        let file = load(map, path, diagnostics)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        read::project(file, map.file(file).text(), folder, diagnostics)
    }

    /// Reads the source files, those of tests only where the options want tests; `None` after
    /// mistakes.
    pub fn load(
        &self,
        map: &mut SourceMap,
        levels: &Levels,
        diagnostics: &mut Diagnostics,
    ) -> Option<Sources> {
        let paths = match &self.sources {
            Some(listed) => self.listed(listed, diagnostics),
            None => Some(vec![non_empty(&self.folder)]),
        };
        let tests = self.listed(&self.tests, diagnostics);
        let (mut paths, tests) = (paths?, tests?);
        match self.options.tests {
            Tests::LeftOut => Sources::load_without(map, &paths, &tests, levels, diagnostics),
            Tests::Checked | Tests::Run { .. } => {
                paths.extend(tests);
                Sources::load(map, &paths, levels, diagnostics)
            }
        }
    }

    /// The files and folders that the list of sources stands for.
    fn listed(
        &self,
        listed: &[Spanned<String>],
        diagnostics: &mut Diagnostics,
    ) -> Option<Vec<PathBuf>> {
        let mut all = Some(Vec::new());
        for source in listed {
            let found = match Pattern::parse(&source.node) {
                Some(pattern) => self.matching(&pattern),
                None => Ok(existing(self.folder.join(&source.node))),
            };
            match found {
                Ok(paths) if paths.is_empty() => {
                    diagnostics.push(no_source(source));
                    all = None;
                }
                Ok(paths) => {
                    if let Some(all) = &mut all {
                        all.extend(paths);
                    }
                }
                Err(diagnostic) => {
                    diagnostics.push(at(diagnostic, source.span));
                    all = None;
                }
            }
        }
        all
    }

    /// The source files that a pattern matches, by name.
    fn matching(&self, pattern: &Pattern) -> Result<Vec<PathBuf>, Diagnostic> {
        let base = self.folder.join(pattern.base());
        if !base.is_dir() {
            return Ok(Vec::new());
        }
        let folder = Folder::read(&non_empty(&base))?;
        let fits = |path: &PathBuf| {
            let below = path.strip_prefix(&base).unwrap_or(path);
            is_source(path) && pattern.matches(below)
        };
        Ok(folder.files.into_iter().filter(fits).collect())
    }
}

/// A folder that can be opened: the empty path stands for the current one.
fn non_empty(folder: &Path) -> PathBuf {
    if folder.as_os_str().is_empty() {
        PathBuf::from(".")
    } else {
        folder.to_owned()
    }
}

fn existing(path: PathBuf) -> Vec<PathBuf> {
    if path.exists() {
        vec![path]
    } else {
        Vec::new()
    }
}

fn no_source(source: &Spanned<String>) -> Diagnostic {
    let message = format!("there is no source `{}`", source.node);
    Diagnostic::new(Code::E6063, source.span, message).label("nothing is there")
}

fn at(diagnostic: Diagnostic, span: Span) -> Diagnostic {
    Diagnostic {
        primary: Diagnostic::new(diagnostic.code, span, "").primary,
        ..diagnostic
    }
}
