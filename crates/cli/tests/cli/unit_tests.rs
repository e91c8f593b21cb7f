//! `iecc test`: what it prints, its exit codes, and what it leaves on the disk.

use crate::support::{folder, iecc, stderr, stdout};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::fs;
use tempfile::TempDir;

const MOTOR: &str = "\
FUNCTION_BLOCK Motor
VAR_INPUT start, stop : BOOL; END_VAR
VAR_OUTPUT runs : BOOL; END_VAR
runs := (runs OR start) AND NOT stop;
END_FUNCTION_BLOCK

PROGRAM Main
VAR_INPUT start : BOOL; END_VAR
VAR_OUTPUT runs : BOOL; END_VAR
VAR m : Motor; END_VAR
m(start := start, runs => runs);
END_PROGRAM
";

const MOTOR_TEST: &str = "\
TEST 'it starts'
  VAR m : Motor; END_VAR
  m(start := TRUE);
  ASSERT_TRUE(m.runs);
END_TEST

TEST 'it <stops> & \"rests\"'
  VAR m : Motor; n : INT; END_VAR
  m(start := TRUE);
  m(start := FALSE);
  n := 7 / n;
  ASSERT_FALSE(m.runs, 'no & never');
END_TEST
";

const FAN_TEST: &str = "\
TEST 'it blows'
  VAR m : Motor; END_VAR
  m();
  ASSERT_TRUE(m.runs, 'a <fan>');
END_TEST
";

fn project() -> TempDir {
    folder(&[
        ("motor.st", MOTOR),
        ("tests/fan_test.st", FAN_TEST),
        ("tests/motor_test.st", MOTOR_TEST),
    ])
}

#[test]
fn results_are_listed_and_failures_explained() {
    let folder = project();
    for engine in ["jit", "interp"] {
        let output = iecc(
            folder.path(),
            &["test", "motor.st", "tests", "--engine", engine],
        );
        assert_eq!(output.status.code(), Some(1), "{engine}");
        assert_eq!(
            stdout(&output),
            "tests/fan_test.st
  FAILED  it blows
tests/motor_test.st
  ok      it starts
  FAILED  it <stops> & \"rests\"

3 tests: 1 passed, 2 failed
",
            "{engine}"
        );
        assert_eq!(
            stderr(&output),
            "error[E6090]: ASSERT_TRUE failed in `it blows`: a <fan>
  ┌─ tests/fan_test.st:4:3
  │
4 │   ASSERT_TRUE(m.runs, 'a <fan>');
  │   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ got FALSE, expected TRUE

error[E6091]: `it <stops> & \"rests\"` was abandoned: division by zero
   ┌─ tests/motor_test.st:11:8
   │
11 │   n := 7 / n;
   │        ^^^^^

",
            "{engine}"
        );
    }
}

#[test]
fn all_passed_is_exit_code_0() {
    let folder = project();
    let output = iecc(
        folder.path(),
        &["test", "motor.st", "tests", "--filter", "STARTS"],
    );
    assert_eq!(output.status.code(), Some(0));
    let listed = "tests/motor_test.st\n  ok      it starts\n\n1 test: 1 passed, 0 failed\n";
    assert_eq!(stdout(&output), listed);
    assert_eq!(stderr(&output), "");
}

#[test]
fn the_filter_looks_at_file_and_title() {
    let folder = project();
    for (filter, tests) in [
        ("fan", 1),
        ("motor_test", 2),
        ("it", 3),
        ("test.st: it <", 1),
    ] {
        let output = iecc(
            folder.path(),
            &["test", "motor.st", "tests", "--filter", filter],
        );
        let last = stdout(&output).lines().last().expect("a summary");
        let plural = if tests == 1 { "" } else { "s" };
        assert!(
            last.starts_with(&format!("{tests} test{plural}: ")),
            "{filter}: {last}"
        );
    }
}

#[test]
fn nothing_to_run_is_wrong_usage() {
    let folder = project();
    for (arguments, message) in [
        (
            &["test", "motor.st"][..],
            "error: there are no tests here\n",
        ),
        (
            &["test", "motor.st", "tests", "--filter", "pump"],
            "error: no test matches `pump`\n",
        ),
        (
            &["test", "motor.st", "tests", "--entry", "Main"],
            "error: --entry means nothing for tests, which call what is to run\n",
        ),
    ] {
        let output = iecc(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(stdout(&output), "", "{arguments:?}");
        assert_eq!(stderr(&output), message, "{arguments:?}");
    }
}

#[test]
fn a_program_with_errors_runs_no_test() {
    let wrong = "TEST 'a' ASSERT_EQ(1, 'one'); END_TEST TEST 'b' END_TEST";
    let folder = folder(&[("wrong_test.st", wrong)]);
    for command in ["test", "check"] {
        let output = iecc(folder.path(), &[command, "wrong_test.st"]);
        assert_eq!(output.status.code(), Some(1), "{command}");
        assert_eq!(stdout(&output), "", "{command}");
        assert!(stderr(&output).starts_with("error[E2"), "{command}");
    }
}

#[test]
fn other_commands_leave_tests_out() {
    let text = format!("{MOTOR}TEST 'wrong' ASSERT_TRUE(nothing); END_TEST");
    let folder = folder(&[("main.st", &text)]);
    let run = iecc(folder.path(), &["run", "main.st", "--scans", "1"]);
    assert_eq!((run.status.code(), stderr(&run)), (Some(0), ""));
    let check = iecc(folder.path(), &["check", "main.st"]);
    assert_eq!(check.status.code(), Some(1));
}

#[test]
fn a_project_says_where_its_tests_are() {
    let folder = folder(&[
        ("iecc.toml", "tests = \"tests\"\n"),
        ("motor.st", MOTOR),
        // Only the tests may hold a second program and things that do not compile alone.
        ("tests/helper.st", "PROGRAM Other END_PROGRAM"),
        (
            "tests/motor_test.st",
            "TEST 'other' VAR o : Other; m : Main; END_VAR o(); m(start := TRUE); ASSERT_TRUE(m.runs); END_TEST",
        ),
    ]);
    let run = iecc(folder.path(), &["run", "--scans", "1"]);
    assert_eq!((run.status.code(), stderr(&run)), (Some(0), ""));
    let test = iecc(folder.path(), &["test"]);
    assert_eq!((test.status.code(), stderr(&test)), (Some(0), ""));
    assert_eq!(
        stdout(&test).lines().last(),
        Some("1 test: 1 passed, 0 failed")
    );
    let check = iecc(folder.path(), &["check", "--entry", "Main"]);
    assert_eq!((check.status.code(), stderr(&check)), (Some(0), ""));
}

#[test]
fn tests_of_a_project_that_are_not_there_are_reported() {
    let folder = folder(&[("iecc.toml", "tests = [\"test\"]\n"), ("motor.st", MOTOR)]);
    let output = iecc(folder.path(), &["test"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("error[E6063]: there is no source `test`"));
}

#[test]
fn failures_are_json_as_well() {
    let folder = project();
    let arguments = ["test", "motor.st", "tests", "--message-format", "json"];
    let output = iecc(folder.path(), &arguments);
    let lines: Vec<_> = stderr(&output).lines().collect();
    assert_eq!(lines.len(), 2);
    let first: serde_json::Value = serde_json::from_str(lines[0]).expect("JSON");
    assert_eq!(first["code"], "E6090");
    assert_eq!(first["line"], 4);
}

/// The elements of a document in order, each with its attributes, and the text in them.
fn elements(text: &str) -> Vec<(String, Vec<(String, String)>)> {
    let mut reader = Reader::from_str(text);
    let mut found = Vec::new();
    loop {
        match reader.read_event().expect("well-formed XML") {
            Event::Start(element) | Event::Empty(element) => found.push(attributes(&element)),
            Event::Eof => return found,
            Event::End(_)
            | Event::Text(_)
            | Event::CData(_)
            | Event::Comment(_)
            | Event::Decl(_)
            | Event::PI(_)
            | Event::DocType(_)
            | Event::GeneralRef(_) => {}
        }
    }
}

fn attributes(element: &BytesStart<'_>) -> (String, Vec<(String, String)>) {
    let pairs = element.attributes().map(|attribute| {
        let attribute = attribute.expect("a well-formed attribute");
        let value = quick_xml::escape::unescape(&attribute.value).expect("known entities");
        (attribute.key.as_ref().to_owned(), value.into_owned())
    });
    (element.name().as_ref().to_owned(), pairs.collect())
}

fn value<'e>(element: &'e (String, Vec<(String, String)>), name: &str) -> &'e str {
    let found = element.1.iter().find(|(known, _)| known == name);
    &found
        .unwrap_or_else(|| panic!("{element:?} has no {name}"))
        .1
}

#[test]
fn results_are_junit_xml() {
    let folder = project();
    let arguments = ["test", "motor.st", "tests", "--junit", "out/results.xml"];
    let output = iecc(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(1));
    let text = fs::read_to_string(folder.path().join("out/results.xml")).expect("written");
    assert!(text.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"));
    let found = elements(&text);
    let names: Vec<_> = found.iter().map(|(name, _)| name.as_str()).collect();
    let expected = [
        "testsuites",
        "testsuite",
        "testcase",
        "failure",
        "testsuite",
        "testcase",
        "testcase",
        "error",
    ];
    assert_eq!(names, expected);
    let counts = |element| ["tests", "failures", "errors"].map(|name| value(element, name));
    assert_eq!(counts(&found[0]), ["3", "1", "1"]);
    assert_eq!(counts(&found[1]), ["1", "1", "0"]);
    assert_eq!(counts(&found[4]), ["2", "0", "1"]);
    assert_eq!(value(&found[1], "name"), "tests/fan_test.st");
    assert_eq!(value(&found[2], "classname"), "tests/fan_test.st");
    assert_eq!(value(&found[6], "name"), "it <stops> & \"rests\"");
    assert_eq!(value(&found[3], "type"), "E6090");
    assert_eq!(
        value(&found[3], "message"),
        "ASSERT_TRUE failed in `it blows`: a <fan>: got FALSE, expected TRUE"
    );
    assert_eq!(
        value(&found[7], "message"),
        "`it <stops> & \"rests\"` was abandoned: division by zero"
    );
    let time: f64 = value(&found[0], "time").parse().expect("seconds");
    assert!((0.0..60.0).contains(&time));
}

#[test]
fn results_that_cannot_be_written_are_an_error() {
    let folder = project();
    let arguments = [
        "test", "motor.st", "tests", "--filter", "starts", "--junit", "tests",
    ];
    let output = iecc(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("error[E6013]: `tests` cannot be written"));
}
