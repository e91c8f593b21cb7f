//! What project files give.
#![expect(clippy::disallowed_methods, reason = "tests write files")]

use super::*;
use crate::{Dialect, Edits, Init, Level, OnFault, TimerBase};
use iecc_diag::Severity;
use std::fs;

fn read(text: &str) -> (Option<Project>, Vec<(Code, String)>) {
    let (mut map, mut found) = (SourceMap::new(), Diagnostics::new());
    let file = map.add(PROJECT_FILE, text);
    let project = read::project(file, text, PathBuf::from("line"), &mut found);
    let shown = found.iter().map(|d| {
        let label = d.primary.as_ref().expect("every message has a place");
        (d.code, map.slice(label.span).to_owned())
    });
    (project, shown.collect())
}

#[test]
fn every_key_is_read() {
    let (project, found) = read(
        r#"
name = "press"
sources = ["src", "lib/*.st"]
entry = "Main"
dialect = "codesys"
on-fault = "continue"
init = "export"
edits = "test"
timer-base = ["10ms", "t1=1us"]
period = "2ms"

[warnings]
all = "error"
E6023 = "allow"

[names]
Start = "Local:1:I.Data.0"

[verilog]
clock-hz = 12_000_000
tick = "1us"
board = "hx8k"
pins = "pins.txt"
"#,
    );
    assert_eq!(found, []);
    let project = project.unwrap();
    let sources: Vec<_> = project
        .sources
        .iter()
        .flatten()
        .map(|s| s.node.as_str())
        .collect();
    assert_eq!(sources, ["src", "lib/*.st"]);
    let options = &project.options;
    assert_eq!(options.name.as_deref(), Some("press"));
    assert_eq!(options.entry.as_deref(), Some("Main"));
    assert_eq!(options.dialect, Dialect::Codesys);
    assert_eq!(options.on_fault, OnFault::Continue);
    assert_eq!(options.init, Init::Export);
    assert_eq!(options.edits, Edits::Test);
    let timer_base = TimerBase {
        unit_ns: 10_000_000,
        timers: vec![("t1".to_owned(), 1_000)],
    };
    assert_eq!(options.timer_base, timer_base);
    let mut levels = Levels::default();
    levels.set_others(Level::Error);
    levels.set(Code::E6023, Level::Allow).unwrap();
    assert_eq!(options.levels, levels);
    assert_eq!(options.renames[0].name.node, "Start");
    assert_eq!(options.renames[0].point.node, "Local:1:I.Data.0");
    assert_eq!(project.period_ns, Some(2_000_000));
    let verilog = VerilogSettings {
        clock_hz: Some(12_000_000),
        tick_ns: Some(1_000),
        board: Some("hx8k".to_owned()),
        pins: Some(PathBuf::from("line/pins.txt")),
    };
    assert_eq!(project.verilog, verilog);
}

#[test]
fn every_mistake_is_told_at_its_place() {
    for (text, expected) in [
        ("sources = [", vec![(Code::E6060, "")]),
        (
            "source = []\nperiods = '1ms'",
            vec![(Code::E6061, "source"), (Code::E6061, "periods")],
        ),
        ("[warning]\n", vec![(Code::E6061, "warning")]),
        ("[verilog]\nclock = 1", vec![(Code::E6061, "clock")]),
        ("[warnings]\nE9 = 'error'", vec![(Code::E6061, "E9")]),
        ("[warnings]\nE6020 = 'allow'", vec![(Code::E6062, "E6020")]),
        ("[warnings]\nE6023 = 'loud'", vec![(Code::E6062, "'loud'")]),
        (
            "sources = ['a', 1, '']",
            vec![(Code::E6062, "1"), (Code::E6062, "''")],
        ),
        ("dialect = 'iec3'", vec![(Code::E6062, "'iec3'")]),
        ("period = 10", vec![(Code::E6062, "10")]),
        ("period = '0s'", vec![(Code::E6062, "'0s'")]),
        ("timer-base = 't='", vec![(Code::E6062, "'t='")]),
        ("name = 'my press'", vec![(Code::E6062, "'my press'")]),
        ("[names]\n'a b' = 'x'", vec![(Code::E6062, "'a b'")]),
        ("names = 'a'", vec![(Code::E6062, "'a'")]),
        ("[verilog]\nclock-hz = 0", vec![(Code::E6062, "0")]),
        ("[verilog]\nclock-hz = -5", vec![(Code::E6062, "-5")]),
        (
            "[verilog]\nclock-hz = 99999999999999999999",
            vec![(Code::E6062, "99999999999999999999")],
        ),
    ] {
        let (project, found) = read(text);
        assert!(project.is_none(), "{text}");
        let found: Vec<_> = found
            .iter()
            .map(|(code, at)| (*code, at.as_str()))
            .collect();
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn a_key_that_is_nearly_right_is_offered() {
    let (mut map, mut found) = (SourceMap::new(), Diagnostics::new());
    let text = "dialekt = 'iec'";
    let file = map.add(PROJECT_FILE, text);
    read::project(file, text, PathBuf::new(), &mut found);
    let fix = found.iter().next().unwrap().fix.as_ref().unwrap();
    assert_eq!(
        (fix.replacement.as_str(), map.slice(fix.span)),
        ("dialect", "dialekt")
    );
}

/// No text makes the reader panic: every prefix of a file, and the file with each byte replaced.
#[test]
fn damaged_files_are_refused_or_read() {
    let text = "name = \"press\"\nsources = [\"a\"]\n[names]\na.b = { c = 1 }\n[warnings]\nE6023 = \"allow\"\n";
    for end in 0..=text.len() {
        read(&text[..end]);
        for sign in ["[", "\"", "=", "\0", "ü", "\n"] {
            read(&format!("{}{sign}{}", &text[..end], &text[end..]));
        }
    }
}

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// The sources of a project below its folder, or the codes.
fn sources(folder: &Path) -> Result<Vec<String>, Vec<Code>> {
    let (mut map, mut found) = (SourceMap::new(), Diagnostics::new());
    let paths = [folder.to_owned()];
    let project = match find(&mut map, &paths, &mut found) {
        Some(Found::Project(project)) => Some(project),
        Some(Found::Paths(_)) => panic!("there is a project file"),
        None => None,
    };
    let levels = Levels::default();
    let sources = project.and_then(|project| project.load(&mut map, &levels, &mut found));
    let base = format!("{}/", folder.display());
    match sources {
        Some(sources) => {
            let names = sources.files().iter().map(|&file| map.file(file).name());
            Ok(names.map(|name| name.replace(&base, "")).collect())
        }
        None => {
            let errors = found.iter().filter(|d| d.severity == Severity::Error);
            Err(errors.map(|d| d.code).collect())
        }
    }
}

#[test]
fn sources_are_files_folders_and_patterns_or_all_there_is() {
    let files = [
        ("a.st", ""),
        ("lib/b.st", ""),
        ("lib/c.txt", ""),
        ("lib/x/d.st", ""),
    ];
    for (text, expected) in [
        ("", Ok(&["a.st", "lib/b.st", "lib/x/d.st"][..])),
        ("sources = 'lib'", Ok(&["lib/b.st", "lib/x/d.st"])),
        ("sources = ['lib/*', 'a.st']", Ok(&["lib/b.st", "a.st"])),
        (
            "sources = ['**/d.st', 'lib']",
            Ok(&["lib/x/d.st", "lib/b.st"]),
        ),
        (
            "sources = ['a.st', 'b.st', '*.L5X', 'no/*.st']",
            Err(&[Code::E6063, Code::E6063, Code::E6063][..]),
        ),
        ("sources = ['lib/c.txt']", Err(&[Code::E6050])),
    ] {
        let folder = folder(&[&files[..], &[(PROJECT_FILE, text)]].concat());
        let expected = expected.map(|names: &[&str]| names.iter().map(|&n| n.to_owned()).collect());
        let expected = expected.map_err(|codes: &[Code]| codes.to_vec());
        assert_eq!(sources(folder.path()), expected, "{text}");
    }
}

#[test]
fn the_manual_tells_of_every_key() {
    let manual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/projects.md");
    let manual = fs::read_to_string(manual).unwrap();
    for key in keys::KEYS
        .iter()
        .chain(keys::TABLES.iter().flat_map(|table| table.keys))
    {
        assert!(
            manual.contains(&format!("| `{}` |", key.name)),
            "{}",
            key.name
        );
    }
    for table in keys::TABLES {
        assert!(
            manual.contains(&format!("`[{}]`", table.name)),
            "{}",
            table.name
        );
    }
}
