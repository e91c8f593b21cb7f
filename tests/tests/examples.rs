//! Every example is a clean program, and what its files say of one another is true.
#![expect(
    clippy::disallowed_methods,
    reason = "tests read files and run programs"
)]

use std::path::{Path, PathBuf};
use std::process::Command;

use iecc_diag::Diagnostics;
use iecc_source::FileId;

fn example(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../examples")
        .join(path)
}

#[test]
fn the_ald_export_reads_without_a_message() {
    let text = std::fs::read_to_string(example("ald/ald.L5X")).expect("the example is there");
    let mut diagnostics = Diagnostics::new();
    let project = iecc_l5x::read(FileId::from_index(0), &text, &mut diagnostics);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    assert!(project.is_some());
}

/// The expected trace is what the model of the process gives, so nobody can mend one by hand and
/// leave the other.
#[test]
fn the_expected_trace_of_the_ald_comes_from_its_model() {
    let output = Command::new("python3")
        .arg(example("ald/expected.py"))
        .arg("--check")
        .output()
        .expect("python3 runs; scripts/test installs it");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
}
