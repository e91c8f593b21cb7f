//! Writes what a back end made, so that no reader ever sees half of a file.
//!
//! Every file is written under a temporary name beside its place first, and renamed when all are
//! complete. So a disk that is full, or a folder that is closed, leaves what was there before.

use iecc_diag::{Code, Diagnostic};
use iecc_target::Artifact;
use std::fs;
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes files below a folder, which is created when it is missing, and says where they are.
///
/// # Errors
/// E6013 with the place that cannot be written.
pub fn write_artifacts(folder: &Path, artifacts: &[Artifact]) -> Result<Vec<PathBuf>, Diagnostic> {
    let mut written = Vec::with_capacity(artifacts.len());
    for artifact in artifacts {
        let path = folder.join(&artifact.name);
        assert!(stays_below(&artifact.name), "{}", artifact.name);
        let file = write(&path, &artifact.bytes).map_err(|error| cannot_write(&path, &error))?;
        written.push((file, path));
    }
    let mut paths = Vec::with_capacity(written.len());
    for (file, path) in written {
        file.persist(&path)
            .map_err(|error| cannot_write(&path, &error.error))?;
        paths.push(path);
    }
    Ok(paths)
}

/// Writes one file.
///
/// # Errors
/// E6013 if it cannot be written.
pub fn write_file(path: &Path, text: &str) -> Result<(), Diagnostic> {
    let failed = |error: io::Error| cannot_write(path, &error);
    if path.file_name().is_none() {
        return Err(failed(io::ErrorKind::IsADirectory.into()));
    }
    // A name alone has no folder that could be opened.
    let place = Path::new(".").join(path);
    let file = write(&place, text.as_bytes()).map_err(failed)?;
    file.persist(&place).map_err(|error| failed(error.error))?;
    Ok(())
}

fn stays_below(name: &str) -> bool {
    Path::new(name)
        .components()
        .all(|part| matches!(part, Component::Normal(_)))
}

fn write(path: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let folder = path.parent().expect("a file lies in a folder");
    fs::create_dir_all(folder)?;
    let mut file = temporary_in(folder)?;
    file.write_all(bytes)?;
    file.flush()?;
    Ok(file)
}

/// A new file in a folder, with the rights of any new file.
pub(crate) fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    let permissions = {
        use std::os::unix::fs::PermissionsExt as _;
        fs::Permissions::from_mode(0o666)
    };
    #[cfg(unix)]
    builder.permissions(permissions);
    builder.tempfile_in(folder)
}

pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Diagnostic {
    let message = format!("`{}` cannot be written: {error}", path.display());
    Diagnostic::without_place(Code::E6013, message)
}
