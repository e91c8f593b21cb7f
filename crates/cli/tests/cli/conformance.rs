//! `iecc conformance`: what it says of a suite, and how it ends.

use crate::support::{program, stderr, stdout};
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

const SUM: &str = "(*! covers: ed3:71:11
    about: it adds
    trace:
      t    | a b | x
      0ms  | 2 3 | 5
      10ms | - 4 | 6
*)
PROGRAM Main
  VAR_INPUT
    a, b : INT;
  END_VAR
  VAR_OUTPUT
    x : INT;
  END_VAR
  x := a + b;
END_PROGRAM
";

/// A suite of cases of table 71.
fn suite(cases: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("t71")).unwrap();
    for (name, text) in cases {
        std::fs::write(folder.path().join(format!("t71/{name}.st")), text).unwrap();
    }
    folder
}

fn conformance(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = program();
    let command = command.arg("conformance").arg(folder).args(arguments);
    command.output().expect("the program runs")
}

#[test]
fn a_suite_that_passes_is_counted() {
    let folder = suite(&[("sum", SUM)]);
    let output = conformance(folder.path(), &[]);
    assert_eq!(stderr(&output), "");
    assert_eq!(output.status.code(), Some(0));
    let said = stdout(&output);
    assert!(said.starts_with("cases: 1 passed, 0 failed\n"), "{said}");
    let verilog = "simulated Verilog: 1 passed, 0 refused, 0 not applicable, 0 failed\n";
    assert!(said.ends_with(verilog), "{said}");
}

#[test]
fn a_failure_is_an_error_with_the_case_and_the_line() {
    let wrong = SUM.replace("| 6", "| 7");
    let folder = suite(&[("sum", SUM), ("wrong", &wrong)]);
    let output = conformance(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    let message =
        "error[E6081]: t71/wrong: interpreter: scan 1 (line 6): `x` is 6 (16#6), not 7 (16#7)";
    assert!(said.contains(message), "{said}");
    let output = conformance(folder.path(), &["--filter", "sum"]);
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn a_file_that_is_no_case_is_an_error_with_its_line() {
    let folder = suite(&[("sum", &SUM.replace("about:", "colour:"))]);
    let output = conformance(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("error[E6080]: "), "{said}");
    assert!(
        said.contains("sum.st:2: there is no key `colour`"),
        "{said}"
    );
    assert_eq!(stdout(&output), "");
}

#[test]
fn the_statement_claims_what_ran() {
    let folder = suite(&[("sum", SUM)]);
    let output = conformance(folder.path(), &["--statement"]);
    assert_eq!(output.status.code(), Some(0));
    let said = stdout(&output);
    assert!(said.starts_with("# Compliance statement\n"), "{said}");
    assert!(
        said.contains("| 11 | + | pass | pass | pass | 1 | 0 |\n"),
        "{said}"
    );
    assert!(
        said.contains("| 8 | \\* | none | none | none | 0 | 0 |\n"),
        "{said}"
    );
    assert!(
        said.contains("### Table 76: Coils\n\nNone of its 6 features.\n"),
        "{said}"
    );
}

#[test]
fn a_missing_folder_is_an_error() {
    let folder = suite(&[]);
    let output = conformance(&folder.path().join("nowhere"), &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("error[E0001]: "),
        "{}",
        stderr(&output)
    );
}
