//! The real program `iecc`: exit codes, messages, and what it leaves on the disk.

use crate::support::{program, stderr, stdout};
use std::process::Output;

fn iecc(arguments: &[&str]) -> Output {
    let mut command = program();
    command.args(arguments).output().expect("the program runs")
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

#[test]
fn explain_knows_instructions_under_both_names() {
    let old = iecc(&["explain", "lim"]);
    assert_eq!(old.status.code(), Some(0));
    assert!(
        stdout(&old).starts_with("LIM(low limit, test, high limit), from revision 36 on LIMIT\n")
    );
    assert!(stdout(&old).ends_with("\ncompiled\n"));
    assert_eq!(iecc(&["explain", "LIMIT"]).stdout, old.stdout);
}

#[test]
fn explain_says_what_prescan_does() {
    let output = iecc(&["explain", "TOF"]);
    let sentence = "In prescan: the timer gets EN, TT and DN 0, and ACC equal to PRE.\n";
    assert!(stdout(&output).contains(sentence), "{}", stdout(&output));
}

#[test]
fn explain_lists_instructions_with_what_is_refused() {
    let output = iecc(&["explain", "instructions"]);
    let lines: Vec<_> = stdout(&output).lines().collect();
    assert_eq!(lines[0], "XIC             compiled");
    assert!(lines.contains(&"EQU     EQ      compiled"));
    let refused = "JMP             refused: this version of iecc does not compile it yet";
    assert!(lines.contains(&refused));
}

fn example() -> String {
    format!("{}/../../examples/ald/ald.L5X", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn an_object_file_comes_with_its_header() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().to_str().expect("UTF-8");
    let output = iecc(&["build", "--target", "jit", "-o", to, &example()]);
    assert_eq!(stderr(&output), "");
    let expected = format!("{to}/ALD_Reactor.o\n{to}/ALD_Reactor.h\n");
    assert_eq!(
        stdout(&output),
        expected.replace('/', std::path::MAIN_SEPARATOR_STR)
    );
}

#[test]
fn an_option_of_another_target_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("out");
    let to = to.to_str().expect("UTF-8");
    for (target, option, value) in [
        ("jit", "--clock-hz", "1000"),
        ("jit", "--board", "hx8k"),
        ("verilog", "--cpu", "native"),
    ] {
        let output = iecc(&[
            "build",
            "--target",
            target,
            option,
            value,
            "-o",
            to,
            &example(),
        ]);
        assert_eq!(output.status.code(), Some(1));
        let message = format!("error[E7008]: the target {target} has no option {option}\n");
        assert!(stderr(&output).starts_with(&message), "{}", stderr(&output));
        assert!(!std::path::Path::new(to).exists());
    }
}
