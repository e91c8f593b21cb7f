//! Test data outside the repository: the folder `shared` beside the project, or what the
//! environment variable `IECC_SHARED` names.

use std::env;
use std::path::{Path, PathBuf};

/// The folder, or `None` with a notice when it is missing. Where the variable `CI` is set, missing
/// data fails the test instead: a run that claims to test everything must do so.
pub fn shared_dir() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let folder = env::var_os("IECC_SHARED").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    let notice = format!(
        "test data folder {} is missing (set IECC_SHARED)",
        folder.display()
    );
    assert!(env::var_os("CI").is_none(), "{notice}");
    #[expect(
        clippy::print_stderr,
        reason = "whoever runs the test must see that it did not run"
    )]
    {
        eprintln!("NOT RUN: {notice}");
    }
    None
}
