//! The real program `iecc`: exit codes, messages, and what it leaves on the disk.
#![expect(clippy::disallowed_methods, reason = "the program is run")]

use std::process::{Command, Output};

fn iecc(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_iecc"));
    command.args(arguments).output().expect("the program runs")
}

fn stdout(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).expect("UTF-8")
}

fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("UTF-8")
}

#[test]
fn wrong_usage_has_exit_code_2() {
    for arguments in [
        &[][..],
        &["sing"],
        &["explain", "E5999"],
        &["explain", "--loud"],
    ] {
        let output = iecc(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(stdout(&output), "", "{arguments:?}");
        assert!(!stderr(&output).is_empty(), "{arguments:?}");
    }
}

#[test]
fn help_tells_the_exit_codes() {
    let output = iecc(&["--help"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stdout(&output).contains("Exit codes: 0 done; 1 the program has errors"));
}

#[test]
fn explain_prints_the_page_of_a_code_in_any_case() {
    let output = iecc(&["explain", "e5003"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stdout(&output).starts_with("# E5003: rung text does not follow the rung grammar\n"));
    assert_eq!(stderr(&output), "");
}

#[test]
fn explain_alone_lists_every_code_on_a_line() {
    let output = iecc(&["explain"]);
    assert_eq!(output.status.code(), Some(0));
    let lines: Vec<_> = stdout(&output).lines().collect();
    assert_eq!(lines[0], "E0001  error    file cannot be read");
    assert_eq!(lines.len(), iecc_diag::Code::ALL.len());
}
