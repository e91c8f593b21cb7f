//! The files below a folder, by name. What begins with a dot is hidden and left out.
//!
//! Links are followed, each real folder is entered once, and depth and number are bounded: so no
//! folder keeps the compiler busy for ever.

use super::unreadable;
use iecc_diag::{Code, Diagnostic};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// How deep folders may nest.
const MAX_DEPTH: usize = 64;

/// How many files and folders are looked at.
const MAX_ENTRIES: usize = 100_000;

/// What lies below a folder.
#[derive(Debug, Default)]
pub(crate) struct Folder {
    /// All files, in order.
    pub(crate) files: Vec<PathBuf>,
    /// Folders that were entered, by their real paths.
    entered: BTreeSet<PathBuf>,
    entries: usize,
}

impl Folder {
    /// All files below `path`.
    ///
    /// # Errors
    /// E0001 if a folder cannot be read, E6054 if there is too much.
    pub(crate) fn read(path: &Path) -> Result<Self, Diagnostic> {
        let mut folder = Self::default();
        folder.enter(path, 0)?;
        Ok(folder)
    }

    fn enter(&mut self, path: &Path, depth: usize) -> Result<(), Diagnostic> {
        let real = fs::canonicalize(path).map_err(|error| unreadable(path, &error))?;
        if !self.entered.insert(real) {
            return Ok(());
        }
        if depth > MAX_DEPTH {
            let what = format!("nests more than {MAX_DEPTH} folders deep");
            return Err(too_much(path, &what));
        }
        for entry in entries(path).map_err(|error| unreadable(path, &error))? {
            self.entries += 1;
            if self.entries > MAX_ENTRIES {
                let what = format!("and its neighbours hold more than {MAX_ENTRIES} files");
                return Err(too_much(path, &what));
            }
            if entry.is_dir() {
                self.enter(&entry, depth + 1)?;
            } else {
                self.files.push(entry);
            }
        }
        Ok(())
    }
}

fn too_much(path: &Path, what: &str) -> Diagnostic {
    let message = format!("`{}` {what}", path.display());
    Diagnostic::without_place(Code::E6054, message)
}

/// What stands directly in a folder and is not hidden, by name.
pub(crate) fn entries(path: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(path)? {
        let entry = entry?;
        if !entry.file_name().to_string_lossy().starts_with('.') {
            paths.push(entry.path());
        }
        // One more than are looked at, so that the excess is noticed.
        if paths.len() > MAX_ENTRIES {
            break;
        }
    }
    paths.sort();
    Ok(paths)
}
