//! What users get for a broken program: a code, the line and column in their file, exit code 1,
//! and no file.

use crate::support::iecc;
use std::fs;
use tempfile::TempDir;

/// A controller with one task, one program, the tags given and the rungs given; the text of rung
/// `n` stands on line `10 + n`, from column 42.
fn export(tags: &str, rungs: &[&str]) -> String {
    let head = r#"<?xml version="1.0" encoding="UTF-8" standalone="yes"?>
<RSLogix5000Content SchemaRevision="1.0" SoftwareRevision="32.01" TargetName="C" TargetType="Controller" ContainsContext="false">
<Controller Use="Target" Name="C" ProcessorType="1769-L33ER" MajorRev="32" MinorRev="11">
<Modules/>
"#;
    let mut text = format!("{head}<Tags>{tags}</Tags>\n<Programs>\n");
    text.push_str(
        "<Program Name=\"P\" MainRoutineName=\"Main\" TestEdits=\"false\">\n<Routines>\n",
    );
    text.push_str("<Routine Name=\"Main\" Type=\"RLL\"><RLLContent>\n");
    for (number, rung) in rungs.iter().enumerate() {
        let number = format!("\"{number}\"");
        text.push_str(&format!(
            "<Rung Number={number:<4}Type=\"N\"><Text><![CDATA[{rung}]]></Text></Rung>\n"
        ));
    }
    text.push_str("</RLLContent></Routine></Routines></Program></Programs>\n");
    text.push_str(
        "<Tasks><Task Name=\"T\" Type=\"CONTINUOUS\" Priority=\"10\" Watchdog=\"500\"><ScheduledPrograms>\
         <ScheduledProgram Name=\"P\"/></ScheduledPrograms></Task></Tasks>\n",
    );
    text.push_str("</Controller>\n</RSLogix5000Content>\n");
    text
}

const TAGS: &str = r#"<Tag Name="run" TagType="Base" DataType="BOOL"/>"#;

/// Every command that makes something, with the place where it would.
const COMMANDS: [&[&str]; 4] = [
    &["check", "a.L5X"],
    &["run", "a.L5X", "--scans", "1", "--trace", "out.csv"],
    &["ir", "a.L5X"],
    &["build", "--target", "verilog", "a.L5X", "-o", "out"],
];

/// Each command gives exactly these messages, exit code 1, and leaves no file.
fn gives(text: &str, expected: &[(&str, usize, usize)]) {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("a.L5X"), text).expect("written");
    for command in COMMANDS {
        let arguments: Vec<&str> = ["--message-format", "json"]
            .iter()
            .chain(command)
            .copied()
            .collect();
        let output = iecc(folder.path(), &arguments);
        let messages = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(
            places(&messages),
            expected,
            "{command:?}\n{messages}\n{text}"
        );
        assert_eq!(output.status.code(), Some(1), "{command:?}");
        assert_eq!(output.stdout, b"", "{command:?}");
        let files = fs::read_dir(folder.path()).expect("readable").count();
        assert_eq!(files, 1, "{command:?} leaves a file");
    }
}

/// Code, line and column of every message.
fn places(messages: &str) -> Vec<(&str, usize, usize)> {
    messages
        .lines()
        .map(|line| {
            (
                string(line, "code"),
                number(line, "line"),
                number(line, "column"),
            )
        })
        .collect()
}

fn after<'m>(message: &'m str, key: &str) -> &'m str {
    let key = format!("\"{key}\":");
    let at = message
        .find(&key)
        .unwrap_or_else(|| panic!("{key} in {message}"));
    &message[at + key.len()..]
}

fn string<'m>(message: &'m str, key: &str) -> &'m str {
    let text = &after(message, key)[1..];
    &text[..text.find('"').expect("a closing quote")]
}

fn number(message: &str, key: &str) -> usize {
    let text = after(message, key);
    let end = text
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(text.len());
    text[..end].parse().unwrap_or(0)
}

#[test]
fn the_file_of_these_tests_is_right_without_the_mistakes() {
    let folder = TempDir::new().expect("a folder");
    let text = export(TAGS, &["XIC(run)OTE(run);"]);
    assert!(
        text.lines().nth(9).expect("a line")[41..].starts_with("XIC(run)"),
        "{text}"
    );
    fs::write(folder.path().join("a.L5X"), text).expect("written");
    for command in COMMANDS {
        let output = iecc(folder.path(), command);
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{command:?}");
        assert_eq!(output.status.code(), Some(0), "{command:?}");
    }
    assert!(folder.path().join("out.csv").is_file());
    assert!(folder.path().join("out/C.v").is_file());
}

#[test]
fn a_truncated_file() {
    let text = export(TAGS, &["XIC(run)OTE(run);"]);
    let cut = text.find("OTE").expect("there");
    gives(&text[..cut], &[("E5001", 10, 33)]);
}

#[test]
fn xml_that_is_no_export() {
    gives(
        "<?xml version=\"1.0\"?>\n<html><body/></html>\n",
        &[("E5002", 2, 1)],
    );
}

#[test]
fn no_xml_at_all() {
    gives("PROGRAM main\nEND_PROGRAM\n", &[("E5002", 1, 1)]);
}

#[test]
fn an_empty_file() {
    gives("", &[("E5002", 1, 1)]);
}

#[test]
fn undefined_tags_are_all_found_in_one_run() {
    let rungs = ["XIC(run)OTE(lamp);", "XIC(start)XIC(run)OTE(run);"];
    gives(
        &export(TAGS, &rungs),
        &[("E1001", 10, 54), ("E1001", 11, 46)],
    );
}

#[test]
fn wrong_number_of_operands() {
    gives(
        &export(TAGS, &["XIC(run,run)OTE(run);"]),
        &[("E5020", 10, 42)],
    );
}

#[test]
fn missing_add_on_instruction() {
    gives(
        &export(TAGS, &["Motor_Control(run);"]),
        &[("E1008", 10, 42)],
    );
}

#[test]
fn missing_target_of_a_jsr() {
    gives(&export(TAGS, &["JSR(Nowhere,0);"]), &[("E1007", 10, 46)]);
}

#[test]
fn rung_that_is_no_rung() {
    gives(&export(TAGS, &["XIC(run)OTE(run)"]), &[("E5003", 10, 58)]);
}

#[test]
fn a_file_that_is_not_there_and_one_that_is_no_text() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("a.L5X"), b"<a>\xff</a>").expect("written");
    for (file, code) in [("missing.L5X", "E0001"), ("a.L5X", "E0002")] {
        let output = iecc(folder.path(), &["check", file]);
        assert_eq!(output.status.code(), Some(1));
        let message = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(
            message.starts_with(&format!("error[{code}]: {file}: ")),
            "{message}"
        );
    }
}

#[test]
fn messages_show_the_line_for_people() {
    let folder = TempDir::new().expect("a folder");
    fs::write(
        folder.path().join("a.L5X"),
        export(TAGS, &["XIC(rum)OTE(run);"]),
    )
    .expect("written");
    let output = iecc(folder.path(), &["check", "a.L5X"]);
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(message.contains("┌─ a.L5X:10:46\n"), "{message}");
    assert!(
        message.contains(
            "10 │ <Rung Number=\"0\" Type=\"N\"><Text><![CDATA[XIC(rum)OTE(run);]]></Text></Rung>\n"
        ),
        "{message}"
    );
    assert!(message.contains("^^^"), "{message}");
    assert!(
        message.contains("run"),
        "the name that was perhaps meant: {message}"
    );
    assert!(message.ends_with("\n1 error\n"), "{message}");
}

#[test]
fn a_trace_that_cannot_be_written_leaves_nothing() {
    let folder = TempDir::new().expect("a folder");
    fs::write(
        folder.path().join("a.L5X"),
        export(TAGS, &["XIC(run)OTE(run);"]),
    )
    .expect("written");
    let run = ["run", "a.L5X", "--scans", "1", "--trace"];
    for (trace, code) in [("no/folder/out.csv", "E6013"), ("out.xls", "E6015")] {
        let output = iecc(folder.path(), &[&run[..], &[trace]].concat());
        assert_eq!(output.status.code(), Some(1));
        let message = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(
            message.starts_with(&format!("error[{code}]: ")),
            "{message}"
        );
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
    }
}

#[test]
fn build_refuses_a_stimulus_that_a_testbench_cannot_replay() {
    let folder = TempDir::new().expect("a folder");
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).expect("written");
    };
    write("a.L5X", &export(TAGS, &["XIC(run)OTE(run);"]));
    write("poke.csv", "t_ms,run\n0,1\n");
    write("none.csv", "t_ms\n0\n");
    let build = ["build", "--target", "verilog", "a.L5X", "-o", "out"];
    for (stimulus, scans, clock_hz, message) in [
        ("poke.csv", "5", "1000", "error[E6012]: `run` is no input"),
        (
            "none.csv",
            "100001",
            "1000",
            "error[E7008]: the testbench is to replay 100001 scans",
        ),
        (
            "none.csv",
            "5",
            "3",
            "error[E7008]: a clock of 3 Hz has no period",
        ),
    ] {
        let more = [
            "--stimulus",
            stimulus,
            "--scans",
            scans,
            "--clock-hz",
            clock_hz,
        ];
        let output = iecc(folder.path(), &[&build[..], &more].concat());
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(said.starts_with(message), "{said}");
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(!folder.path().join("out").exists());
    }
    for half in [["--stimulus", "none.csv"], ["--scans", "5"]] {
        let output = iecc(folder.path(), &[&build[..], &half].concat());
        assert_eq!(output.status.code(), Some(2));
    }
}

#[test]
fn build_says_which_files_it_wrote_and_an_unknown_board_writes_none() {
    let folder = TempDir::new().expect("a folder");
    fs::write(
        folder.path().join("a.L5X"),
        export(TAGS, &["XIC(run)OTE(run);"]),
    )
    .expect("written");
    let build = ["build", "--target", "verilog", "a.L5X", "-o", "out"];
    let output = iecc(
        folder.path(),
        &[&build[..], &["--board", "abacus"]].concat(),
    );
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    let first = "error[E7008]: there is no board `abacus`, but de2-115, hx8k\n";
    assert!(message.starts_with(first), "{message}");
    assert!(!folder.path().join("out").exists());

    let output = iecc(folder.path(), &build);
    assert_eq!(output.status.code(), Some(0));
    let listed = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(listed.lines().any(|line| line == "out/C.v"), "{listed}");
    for line in listed.lines() {
        assert!(folder.path().join(line).is_file(), "{line}");
    }
    let written = fs::read_dir(folder.path().join("out")).expect("readable");
    assert_eq!(written.count(), listed.lines().count());
}
