//! Many files: what `iecc` does with files, folders and warnings.

use crate::support::{folder, iecc, stderr};
use std::fs;
use std::path::Path;

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

const MAIN: &str = "PROGRAM Main
VAR_INPUT start : BOOL; END_VAR
VAR_OUTPUT n : INT; END_VAR
VAR a : ARRAY[1..3] OF INT := [10, 20, 30]; END_VAR
n := n + 1;
a[2] := a[2] + n;
END_PROGRAM
";
const OTHER: &str = "PROGRAM Other\nVAR x : INT; END_VAR\nx := x + 1;\nEND_PROGRAM\n";

/// The trace of a run on the interpreter, or what is said instead.
fn trace(folder: &Path, arguments: &[&str]) -> String {
    let run = ["run", "--engine", "interp", "--trace", "t.csv"];
    let output = iecc(folder, &[&run[..], arguments].concat());
    if output.status.success() {
        fs::read_to_string(folder.join("t.csv")).expect("a trace")
    } else {
        stderr(&output).to_owned()
    }
}

#[test]
fn names_and_subscripts_are_those_of_the_program() {
    let folder = folder(&[("main.st", MAIN)]);
    let expected = "t_ms,start,n,a[1],a[2],a[3]\n0,0,1,10,21,30\n10,0,2,10,23,30\n";
    let found = trace(folder.path(), &["main.st", "--scans", "2", "--watch", "a"]);
    assert_eq!(found, expected);
    let found = trace(
        folder.path(),
        &["main.st", "--scans", "1", "--watch", "a[0]"],
    );
    assert!(found.contains("which has elements 1 to 3"), "{found}");
}

/// A name belongs to whoever declares it, however others with the same letters are spelled.
#[test]
fn names_are_spelled_as_where_they_are_declared() {
    let text = "FUNCTION_BLOCK Valve
VAR ET : INT := 5; END_VAR
METHOD PUBLIC M : INT m := et; END_METHOD
END_FUNCTION_BLOCK
PROGRAM main
VAR_INPUT Speed : INT; END_VAR
VAR_OUTPUT m : INT; END_VAR
VAR v : VALVE; SPEEDS : ARRAY[0..1] OF limits; END_VAR
M := V.m() + speed + speeds[1].HIGH;
END_PROGRAM
TYPE Limits : STRUCT High : INT; END_STRUCT; END_TYPE
";
    let folder = folder(&[("main.st", text)]);
    let watch = ["main.st", "--scans", "1", "--watch", "V,speeds[1].HIGH"];
    let found = trace(folder.path(), &watch);
    assert_eq!(found, "t_ms,Speed,m,v.ET,SPEEDS[1].High\n0,0,5,5,0\n");
    let build = ["build", "main.st", "--target", "verilog", "-o", "out"];
    let output = iecc(folder.path(), &build);
    assert!(output.status.success(), "{}", stderr(&output));
    let module = fs::read_to_string(folder.path().join("out/main.v")).expect("a module");
    assert!(
        module.contains("[15:0] Speed,") && module.contains("[15:0] m "),
        "{module}"
    );
    let output = iecc(
        folder.path(),
        &["build", "main.st", "--target", "jit", "-o", "object"],
    );
    assert!(output.status.success(), "{}", stderr(&output));
    let header = fs::read_to_string(folder.path().join("object/main_.h")).expect("a header");
    assert!(
        header.contains("int16_t Speed;") && header.contains("int16_t m;"),
        "{header}"
    );
    assert!(
        header.contains("int16_t High;") && header.contains("int16_t ET;"),
        "{header}"
    );
}

#[test]
fn the_entry_says_which_program_runs() {
    let folder = folder(&[("main.st", MAIN), ("other.st", OTHER)]);
    let found = trace(folder.path(), &[".", "--scans", "1"]);
    assert!(found.starts_with("error[E6020]"), "{found}");
    let run = [".", "--scans", "1", "--watch", "x", "--entry"];
    let found = trace(folder.path(), &[&run[..], &["other"]].concat());
    assert_eq!(found, "t_ms,x\n0,1\n");
    let found = trace(folder.path(), &[&run[..], &["othr"]].concat());
    assert!(found.contains("did you mean `Other`?"), "{found}");
}

#[test]
fn the_tick_is_that_of_the_tasks_unless_something_says_it() {
    let tasks = "CONFIGURATION C
TASK fast(INTERVAL := T#20ms, PRIORITY := 1);
TASK slow(INTERVAL := T#50ms, PRIORITY := 2);
PROGRAM p1 WITH fast : Main;
PROGRAM p2 WITH slow : Other;
END_CONFIGURATION
";
    let folder = folder(&[("main.st", MAIN), ("other.st", OTHER), ("tasks.st", tasks)]);
    let run = [".", "--scans", "6", "--watch", "p1.n,p2.x"];
    // p1 runs at 0, 20, 40 and p2 at 0, 50; the tick is 10 ms. Bare names are those of p1, the
    // instance of Main.
    let expected = "t_ms,start,n,p1.n,p2.x\n0,0,1,1,1\n10,0,1,1,1\n20,0,2,2,1\n30,0,2,2,1\n\
                    40,0,3,3,1\n50,0,3,3,2\n";
    assert_eq!(trace(folder.path(), &run), expected);
    let found = trace(folder.path(), &[&run[..], &["--period", "50ms"]].concat());
    assert!(
        found.starts_with("t_ms,start,n,p1.n,p2.x\n0,0,1,1,1\n50,0,2,2,2\n100,0,3,3,3\n"),
        "{found}"
    );
}

#[test]
fn faults_abandon_the_scan_or_are_remembered() {
    let text = "PROGRAM Main
VAR_INPUT i : INT; END_VAR
VAR_OUTPUT q : INT; END_VAR
q := 5 / i;
END_PROGRAM
";
    let folder = folder(&[("d.st", text)]);
    let found = trace(folder.path(), &["d.st", "--scans", "1"]);
    assert!(
        found.contains("error[E6014]") && found.contains("d.st:4:6"),
        "{found}"
    );
    let run = [
        "d.st",
        "--scans",
        "1",
        "--on-fault",
        "continue",
        "--watch",
        "__status",
    ];
    assert_eq!(
        trace(folder.path(), &run),
        "t_ms,i,q,__status\n0,0,0,16#2\n"
    );
}

#[test]
fn a_run_without_a_trace_shows_how_it_ended() {
    let text = "PROGRAM Main VAR t : TIME; END_VAR VAR_OUTPUT count : INT; r : BOOL; END_VAR count := count + 2; r := count > 5; t := t + T#1s; END_PROGRAM";
    let folder = folder(&[("a.st", text)]);
    let output = iecc(
        folder.path(),
        &["run", "--scans", "3", "--watch", "t", "a.st"],
    );
    assert_eq!(stderr(&output), "");
    let shown = std::str::from_utf8(&output.stdout).expect("UTF-8");
    assert_eq!(shown, "count = 6\nr     = 1\nt     = T#3s\n");
    let output = iecc(
        folder.path(),
        &["run", "--scans", "3", "--trace", "t.csv", "a.st"],
    );
    assert_eq!((output.stdout, output.stderr), (Vec::new(), Vec::new()));
}

/// Whoever begins, or comes from another language, is told what is written here.
#[test]
fn common_mistakes_are_told_with_what_to_write() {
    let text = "FUNCTION_BLOCK Motor
VAR_INPUT start : BOOL; END_VAR
END_FUNCTION_BLOCK
FUNCTION Report : VOID
END_FUNCTION
PROGRAM Main
VAR x : INT; s : STRING; t : TON; a : ARRAY[0..9] OF INT; b : BOOL; z : TONN; END_VAR
s := \"text\";
Motor(start := TRUE);
x := a(3);
s := s + 'more';
t(IN := b, PT := 500);
CASE x OF
  1: x := 2; BREAK;
END_CASE;
b := 0 < x < 10;
END_PROGRAM
";
    let folder = folder(&[("a.st", text)]);
    let output = iecc(folder.path(), &["check", "a.st"]);
    let messages = stderr(&output);
    for told in [
        "`'text'` is a STRING, `\"text\"` a WSTRING",
        "declare an instance `x : Motor;` and call that",
        "an element is written with square brackets: a[3]",
        "CONCAT joins strings: CONCAT(a, b)",
        "a duration has a unit: T#500ms, T#500s",
        "EXIT leaves a loop",
        "two comparisons are joined: `0 < x AND x < 10`",
        "what gives no value is declared without `:` and a type",
        "did you mean `TON`?",
    ] {
        assert!(messages.contains(told), "{told}\n{messages}");
    }
    assert!(messages.ends_with("\n9 errors\n"), "{messages}");
}

#[test]
fn files_in_another_encoding_are_told_what_to_do() {
    let folder = folder(&[]);
    for (bytes, told) in [
        (&b"\xff\xfeP\0"[..], "a.st is UTF-16 text"),
        (b"PROGRAM \xe4", "byte 8 begins no UTF-8 character"),
    ] {
        fs::write(folder.path().join("a.st"), bytes).expect("written");
        let output = iecc(folder.path(), &["check", "a.st"]);
        let messages = stderr(&output);
        assert!(messages.contains(told), "{messages}");
        assert!(messages.contains("UTF-8"), "{messages}");
    }
}
