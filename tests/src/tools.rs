//! Other programs that tests start: compilers, linkers, simulators.

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Runs a program in a folder.
///
/// # Panics
/// If it is missing or fails: without it the test would say nothing.
#[expect(clippy::disallowed_methods, reason = "tests run programs")]
pub fn run(folder: &Path, program: &str, arguments: &[&str], input: Stdio) -> Output {
    let mut command = Command::new(program);
    let command = command.args(arguments).current_dir(folder).stdin(input);
    let output = command.output();
    let output = output.unwrap_or_else(|e| panic!("{program}: {e}; `scripts/test` installs it"));
    let failed = !output.status.success();
    assert!(!failed, "{program} {arguments:?}:\n{}", said(&output));
    output
}

/// What a program prints when it runs in a folder.
///
/// # Panics
/// As [`run`].
pub fn printed(folder: &Path, program: &str, arguments: &[&str], input: Stdio) -> Vec<u8> {
    run(folder, program, arguments, input).stdout
}

/// What a program printed, then its messages.
pub fn said(output: &Output) -> String {
    let printed = String::from_utf8_lossy(&output.stdout);
    printed.into_owned() + &String::from_utf8_lossy(&output.stderr)
}
