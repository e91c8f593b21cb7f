//! The file tests of `tests/filetests`; `iecc_tests::filetest` explains their form.

use iecc_tests::filetest::run_folder;

#[test]
fn run() {
    run_folder("run");
}

#[test]
fn verify() {
    run_folder("verify");
}

#[test]
fn passes() {
    run_folder("passes");
}
