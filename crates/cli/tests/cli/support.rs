//! Runs the program in a folder, and reads what it says.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// The program that was built with the tests.
pub(crate) fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_iecc"))
}

/// Runs it in a folder.
pub(crate) fn iecc(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = program();
    let command = command.args(arguments).current_dir(folder);
    command.output().expect("the program runs")
}

/// What it prints.
pub(crate) fn stdout(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).expect("UTF-8")
}

/// Its messages.
pub(crate) fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("UTF-8")
}

/// A folder with some files, also in folders of their own.
pub(crate) fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, text).expect("written");
    }
    folder
}
