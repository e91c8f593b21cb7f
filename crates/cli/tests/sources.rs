//! Many files: what `iecc` does with files, folders and warnings.
#![expect(clippy::disallowed_methods, reason = "the program is run on files")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn iecc(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_iecc"));
    let command = command.args(arguments).current_dir(folder);
    command.output().expect("the program runs")
}

fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("UTF-8")
}

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, text).expect("written");
    }
    folder
}

/// A Logix export that compiles with one warning, E6023.
const WARNS: &str = r#"<RSLogix5000Content SchemaRevision="1.0" SoftwareRevision="34.00" TargetName="C" TargetType="Controller" ContainsContext="false">
<Controller Use="Target" Name="C"><Tags/><Programs>
<Program Name="Main" MainRoutineName="Main"><Routines><Routine Name="Main" Type="RLL"><RLLContent><Rung Number="0" Type="N"><Text><![CDATA[NOP();]]></Text></Rung></RLLContent></Routine></Routines></Program>
<Program Name="Idle" MainRoutineName="Main"><Routines><Routine Name="Main" Type="RLL"><RLLContent><Rung Number="0" Type="N"><Text><![CDATA[NOP();]]></Text></Rung></RLLContent></Routine></Routines></Program>
</Programs><Tasks><Task Name="T" Type="CONTINUOUS"><ScheduledPrograms><ScheduledProgram Name="Main"/></ScheduledPrograms></Task></Tasks></Controller></RSLogix5000Content>"#;

#[test]
fn warnings_are_counted_allowed_or_made_errors() {
    let folder = folder(&[("a.L5X", WARNS)]);
    for (options, code, last) in [
        (&[][..], 0, Some("1 warning")),
        (&["-A", "E6023"], 0, None),
        (&["-W", "allow"], 0, None),
        (&["-W", "error"], 1, Some("1 error")),
        (&["-W", "error=e6023"], 1, Some("1 error")),
        (&["-W", "error", "-A", "E6023"], 0, None),
        (&["-W", "error", "-W", "warn=E6023"], 0, Some("1 warning")),
        (&["-W", "error=E6028"], 0, Some("1 warning")),
    ] {
        let output = iecc(folder.path(), &[&["check", "a.L5X"], options].concat());
        assert_eq!(output.status.code(), Some(code), "{options:?}");
        assert_eq!(stderr(&output).lines().last(), last, "{options:?}");
    }
}

#[test]
fn levels_of_what_is_no_warning_are_wrong_usage() {
    let folder = folder(&[("a.L5X", WARNS)]);
    for options in [["-A", "E6020"], ["-W", "loud"], ["-W", "error=E5999"]] {
        let output = iecc(folder.path(), &[&["check", "a.L5X"][..], &options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}");
    }
}

#[test]
fn every_mistake_of_every_file_is_told_in_one_run() {
    let folder = folder(&[
        (
            "line/motor.st",
            "FUNCTION_BLOCK Motor\nVAR x : INT END_VAR\nx := 1;\nEND_FUNCTION_BLOCK\n",
        ),
        (
            "line/main.st",
            "PROGRAM Main\nVAR y : INT; END_VAR\ny := 12__3;\nEND_PROGRAM\n",
        ),
    ]);
    let output = iecc(
        folder.path(),
        &["check", "line", "--message-format", "json"],
    );
    assert_eq!(output.status.code(), Some(1));
    let messages = stderr(&output);
    for (code, file) in [("E0024", "line/motor.st"), ("E0019", "line/main.st")] {
        let mut lines = messages.lines();
        let told = lines.any(|line| line.contains(code) && line.contains(file));
        assert!(told, "{code} {messages}");
    }
}

#[test]
fn a_project_is_found_from_any_folder_below_it() {
    let folder = folder(&[
        (
            "iecc.toml",
            "sources = \"line\"\nperiod = \"20ms\"\n[warnings]\nall = \"error\"\n",
        ),
        ("line/a.L5X", WARNS),
        ("line/deep/notes.txt", ""),
    ]);
    let below = folder.path().join("line/deep");
    let output = iecc(&below, &["check"]);
    assert_eq!(output.status.code(), Some(1));
    let message = stderr(&output);
    assert!(message.contains("error[E6023]"), "{message}");
    assert!(message.contains("../../line/a.L5X"), "{message}");
    // The command line goes before the project file.
    assert_eq!(
        iecc(&below, &["check", "-W", "warn"]).status.code(),
        Some(0)
    );
    // Elsewhere the project has to be named.
    assert_eq!(iecc(Path::new("/"), &["check"]).status.code(), Some(1));
    for path in [folder.path().to_owned(), folder.path().join("iecc.toml")] {
        let output = iecc(Path::new("/"), &["check", path.to_str().expect("UTF-8")]);
        assert_eq!(output.status.code(), Some(1));
        assert!(
            stderr(&output).contains("error[E6023]"),
            "{}",
            stderr(&output)
        );
    }
}

#[test]
fn the_period_of_the_project_is_that_of_a_run() {
    let folder = folder(&[("iecc.toml", "period = \"20ms\"\n"), ("a.L5X", WARNS)]);
    let run = [
        "run", "--scans", "2", "--trace", "t.csv", "--engine", "interp",
    ];
    assert_eq!(iecc(folder.path(), &run).status.code(), Some(0));
    let trace = fs::read_to_string(folder.path().join("t.csv")).expect("a trace");
    assert_eq!(trace, "t_ms\n0\n20\n");
    let run = [&run[..], &["--period", "5ms"]].concat();
    assert_eq!(iecc(folder.path(), &run).status.code(), Some(0));
    let trace = fs::read_to_string(folder.path().join("t.csv")).expect("a trace");
    assert_eq!(trace, "t_ms\n0\n5\n");
}

#[test]
fn without_a_project_the_sources_of_the_folder_are_meant() {
    let folder = folder(&[("a.L5X", WARNS), ("below/b.st", "")]);
    let output = iecc(folder.path(), &["check"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    fs::remove_file(folder.path().join("a.L5X")).expect("removed");
    let output = iecc(folder.path(), &["check"]);
    assert_eq!(output.status.code(), Some(1));
    let told = "no file is named, and there is neither a project file `iecc.toml` here or above, nor a source file here";
    assert!(stderr(&output).contains(told), "{}", stderr(&output));
}
