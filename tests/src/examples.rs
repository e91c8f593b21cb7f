//! The files of the examples.

use std::fs;
use std::path::{Path, PathBuf};

/// A file or folder of an example, by its path below `examples`.
pub fn example(path: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    root.join(path)
}

/// What stands in a file of an example.
///
/// # Panics
/// If it cannot be read.
#[expect(clippy::disallowed_methods, reason = "tests read files")]
pub fn example_text(path: &str) -> String {
    fs::read_to_string(example(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}
