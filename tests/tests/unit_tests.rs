//! `iecc test`: the files under tests/unit say beside each assertion what must be told of it, and every
//! engine tells just that. A file that is being typed or damaged gives messages, not panics.
#![expect(clippy::disallowed_methods, reason = "tests read files")]

use iecc_ast::Names;
use iecc_diag::{Code, Diagnostic, Diagnostics, Severity};
use iecc_driver::testing::{Failure, TestEngine, TestProgram};
use iecc_driver::{FrontOptions, OnFault, Sources, Tests, check, parallel_map};
use iecc_grammar::st::{Dialect, lex};
use iecc_source::SourceMap;
use iecc_tests::mutate::{mutate, mutate_values};
use iecc_tests::rng::{Rng, seeds};
use std::path::Path;

/// What begins an expectation, in a comment at the end of a line.
const MARK: &str = "//! ";

/// Instead of what was got and expected.
const FAULT: &str = "fault";

const ENGINES: [TestEngine; 2] = [TestEngine::Interp, TestEngine::Jit];

/// The names and texts of all files, in a fixed order.
fn files() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("unit");
    let entries = std::fs::read_dir(folder).expect("the folder of unit tests");
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("readable").path())
        .collect();
    paths.sort();
    let read = |path: &std::path::PathBuf| {
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        (
            name,
            std::fs::read_to_string(path).expect("a readable file"),
        )
    };
    paths.iter().map(read).collect()
}

fn load(name: &str, text: &str) -> (SourceMap, Sources) {
    let mut map = SourceMap::new();
    let file = map.add(name, text);
    let sources = Sources::text(&mut map, vec![file]);
    (map, sources)
}

fn compiled(map: &SourceMap, sources: &Sources, options: &FrontOptions) -> TestProgram {
    let mut diagnostics = Diagnostics::new();
    let program = TestProgram::compile(map, sources, options, &mut diagnostics);
    let messages: Vec<_> = diagnostics.iter().map(|d| &d.message).collect();
    program.unwrap_or_else(|| panic!("{messages:#?}"))
}

/// The failures of all tests.
fn failures(program: &TestProgram, engine: TestEngine) -> Vec<Failure> {
    let mut run = program.start(engine);
    let results = (0..program.tests().len()).map(|position| run.run(position));
    let results = results.map(|result| result.expect("engines run all tests"));
    results.filter_map(|result| result.failure).collect()
}

/// Where a failure is and what is told of it.
fn told(map: &SourceMap, failure: &Failure) -> (usize, String) {
    let label = failure.diagnostic.primary.as_ref().expect("a place");
    let file = map.file(label.span.file);
    let line = file.lines().line_of(label.span.start);
    let text = if failure.fault { FAULT } else { &label.text };
    (line, text.to_owned())
}

/// What a file says, by line.
fn expected(text: &str) -> Vec<(usize, String)> {
    let lines = text.lines().enumerate();
    let marked = lines.flat_map(|(line, text)| {
        let marks = text.split(MARK).skip(1);
        marks.map(move |mark| (line, mark.trim_end().to_owned()))
    });
    let mut all: Vec<_> = marked.collect();
    all.sort();
    all
}

#[test]
fn every_engine_tells_what_the_files_say() {
    let files = files();
    assert!(files.len() >= 7, "files are missing");
    for (name, text) in &files {
        let (map, sources) = load(name, text);
        let program = compiled(&map, &sources, &FrontOptions::default());
        assert!(!program.tests().is_empty(), "{name} has no tests");
        for engine in ENGINES {
            let failures = failures(&program, engine);
            let mut found: Vec<_> = failures.iter().map(|failure| told(&map, failure)).collect();
            found.sort();
            assert_eq!(found, expected(text), "{name} on {engine:?}, lines from 0");
        }
    }
}

#[test]
fn files_have_no_warnings_and_are_checked_like_that() {
    for (name, text) in files() {
        let (map, sources) = load(&name, &text);
        let options = FrontOptions {
            tests: Tests::Checked,
            ..FrontOptions::default()
        };
        let mut diagnostics = Diagnostics::new();
        check(&map, &sources, &options, &mut diagnostics);
        // Instances are copied to see what becomes of mocks.
        let meant = |d: &&Diagnostic| d.code == Code::E3057 && name == "mocks.st";
        let found = diagnostics.iter().filter(|d| !meant(d));
        let found: Vec<_> = found.map(|d| (d.code, &d.message)).collect();
        assert!(found.is_empty(), "{name}: {found:#?}");
    }
}

#[test]
fn all_files_together_are_one_program_of_the_same_tests() {
    let mut map = SourceMap::new();
    let mut chosen = files();
    // There is one configuration at most.
    chosen.retain(|(_, text)| !text.contains("CONFIGURATION"));
    let files = chosen.iter();
    let ids = files.map(|(name, text)| map.add(name.as_str(), text.as_str()));
    let ids = ids.collect();
    let sources = Sources::text(&mut map, ids);
    let program = compiled(&map, &sources, &FrontOptions::default());
    for engine in ENGINES {
        let wanted: usize = chosen.iter().map(|(_, text)| expected(text).len()).sum();
        assert_eq!(failures(&program, engine).len(), wanted, "{engine:?}");
    }
}

#[test]
fn faults_that_do_not_stop_do_not_fail_a_test() {
    let text = "FUNCTION Share : INT VAR_INPUT sum, parts : INT; END_VAR Share := sum / parts; END_FUNCTION
        TEST 'by zero' ASSERT_EQ(Share(10, 0), 0); END_TEST
        TEST 'by zero, again' ASSERT_EQ(Share(10, 0), 1); END_TEST";
    let (map, sources) = load("t.st", text);
    let options = FrontOptions {
        on_fault: OnFault::Continue,
        ..FrontOptions::default()
    };
    let program = compiled(&map, &sources, &options);
    for engine in ENGINES {
        let failures = failures(&program, engine);
        let told: Vec<_> = failures
            .iter()
            .map(|failure| told(&map, failure).1)
            .collect();
        assert_eq!(told, ["got 0, expected 1"], "{engine:?}");
    }
}

#[test]
fn a_test_that_does_not_end_is_abandoned() {
    let text =
        "TEST 'endless' VAR x : BOOL; END_VAR WHILE NOT x DO x := FALSE; END_WHILE; END_TEST";
    let (map, sources) = load("t.st", text);
    let program = compiled(&map, &sources, &FrontOptions::default());
    for engine in ENGINES {
        let failures = failures(&program, engine);
        assert!(failures[0].fault, "{engine:?}");
    }
}

/// Statements of a test, and the only message they give: its code and the text it points at.
const MISTAKES: [(&str, &str, &str); 26] = [
    ("ASSERT_EQ();", "E3061", "ASSERT_EQ()"),
    ("ASSERT_EQ(n);", "E3061", "ASSERT_EQ(n)"),
    (
        "ASSERT_EQ(n, 1, 'a', 'b');",
        "E3061",
        "ASSERT_EQ(n, 1, 'a', 'b')",
    ),
    ("ASSERT_EQ(n, 1, n);", "E3061", "n"),
    (
        "ASSERT_EQ(actual := n, expected := 1);",
        "E3061",
        "actual := n",
    ),
    ("n := ASSERT_EQ(n, 1);", "E3061", "ASSERT_EQ"),
    ("ADVANCE_TIME(T#-1ms);", "E3061", "T#-1ms"),
    (
        "ADVANCE_TIME(T#1ms, 'message');",
        "E3061",
        "ADVANCE_TIME(T#1ms, 'message')",
    ),
    ("ADVANCE_TIME(1.5);", "E2020", "1.5"),
    ("ADVANCE_TIME('1s');", "E2020", "'1s'"),
    ("ASSERT_EQ(n, 'text');", "E2029", "ASSERT_EQ(n, 'text')"),
    ("ASSERT_EQ(n, nothing);", "E1012", "nothing"),
    ("ASSERT_EQ(f, f);", "E2027", "ASSERT_EQ(f, f)"),
    ("ASSERT_LT(r, r);", "E2027", "ASSERT_LT(r, r)"),
    ("ASSERT_TRUE(n);", "E2020", "n"),
    ("ASSERT_FALSE(n);", "E2020", "n"),
    ("ASSERT_NEAR('a', 'b', 1);", "E2027", "'a'"),
    (
        "ASSERT_NEAR(n, 1, T#1s);",
        "E2029",
        "ASSERT_NEAR(n, 1, T#1s)",
    ),
    ("ASSERT_TRU(n = 1);", "E1018", "ASSERT_TRU"),
    ("MOCK n;", "E3062", "n"),
    ("MOCK Pump;", "E3004", "Pump"),
    ("MOCK_FUNCTION ABS RETURNS 1;", "E3062", "ABS"),
    ("MOCK_FUNCTION Pump RETURNS 1;", "E3062", "Pump"),
    ("MOCK_FUNCTION g RETURNS 'text';", "E2020", "'text'"),
    ("MOCK_VERIFY_CALLED(n);", "E3062", "n"),
    ("MOCK_VERIFY_CALL_COUNT(f, 1.5);", "E2020", "1.5"),
];

#[test]
fn mistakes_in_tests_have_one_message_each() {
    let mut wrong = Vec::new();
    for (statement, code, place) in MISTAKES {
        let text = format!(
            "FUNCTION_BLOCK Pump VAR_INPUT x : INT; END_VAR END_FUNCTION_BLOCK
            FUNCTION g : INT g := 1; END_FUNCTION
            TEST 'a' VAR n : INT; f : Pump; r : REF_TO INT; END_VAR r := REF(n); f(x := n); {statement} END_TEST"
        );
        let (map, sources) = load("t.st", &text);
        let options = FrontOptions {
            tests: Tests::Checked,
            ..FrontOptions::default()
        };
        let mut diagnostics = Diagnostics::new();
        check(&map, &sources, &options, &mut diagnostics);
        let told = diagnostics.iter().map(|diagnostic| {
            let label = diagnostic.primary.as_ref().expect("a place");
            (diagnostic.code.as_str(), map.slice(label.span))
        });
        let told: Vec<_> = told.collect();
        if told != [(code, place)] {
            wrong.push(format!("{statement} gives {told:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The indented blocks of a page that hold a test.
fn examples(page: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(page);
    let text = std::fs::read_to_string(path).expect("the page");
    let lines: Vec<&str> = text.lines().collect();
    let inside = |line: &&str| line.is_empty() || line.starts_with("    ");
    let blocks = lines.split(|line| !inside(line));
    let blocks = blocks.map(|lines| lines.join("\n"));
    // Dots stand for what is left out.
    let whole = |block: &String| block.contains("END_TEST") && !block.contains('…');
    blocks.filter(whole).collect()
}

#[test]
fn examples_of_the_manual_pass() {
    for page in ["README.md", "docs/testing.md"] {
        let examples = examples(page);
        assert_eq!(examples.len(), 1, "{page}");
        for text in examples {
            let (map, sources) = load(page, &text);
            let program = compiled(&map, &sources, &FrontOptions::default());
            assert_eq!(program.tests().len(), 1, "{page}");
            for engine in ENGINES {
                assert_eq!(failures(&program, engine), [], "{page} on {engine:?}");
            }
        }
    }
}

#[test]
fn examples_of_the_codes_give_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("codes");
    for code in ["E6090", "E6091"] {
        let text = std::fs::read_to_string(folder.join(code).with_extension("st"));
        let (map, sources) = load("example.st", &text.expect("an example"));
        let program = compiled(&map, &sources, &FrontOptions::default());
        for engine in ENGINES {
            let failures = failures(&program, engine);
            assert_eq!(failures.len(), 1, "{code}");
            assert_eq!(failures[0].diagnostic.code.as_str(), code);
        }
    }
}

#[test]
fn tests_with_much_state_are_run_in_parts() {
    let mut text = "CONFIGURATION c VAR_GLOBAL g : INT := 7; END_VAR END_CONFIGURATION
        FUNCTION_BLOCK Big VAR a : ARRAY[0..249999] OF DINT; n : INT; END_VAR
        a[n] := n + 10; n := n + 1; END_FUNCTION_BLOCK
        SETUP VAR b : Big; END_VAR b(); END_SETUP\n"
        .to_owned();
    // A million bytes each, and eight million fit into a part.
    for number in 0..20 {
        let expected = if number == 13 { 12 } else { 11 };
        text += &format!(
            "TEST '{number}' b(); ASSERT_EQ(b.a[1], {expected}); g := g + 1; ASSERT_EQ(g, 8); END_TEST\n"
        );
    }
    let (map, sources) = load("t.st", &text);
    let program = compiled(&map, &sources, &FrontOptions::default());
    for engine in ENGINES {
        let failures = failures(&program, engine);
        let told: Vec<_> = failures.iter().map(|failure| told(&map, failure)).collect();
        assert_eq!(
            told,
            [(4 + 13, "got 11, expected 12".to_owned())],
            "{engine:?}"
        );
    }
}

/// What is checked and compiled, to the end or with a message.
fn survives(text: &str) {
    let (map, sources) = load("t.st", text);
    for tests in [Tests::Checked, Tests::RUN_ALL] {
        let mut diagnostics = Diagnostics::new();
        let options = FrontOptions {
            tests,
            ..FrontOptions::default()
        };
        let done = match tests {
            Tests::Run { .. } => {
                TestProgram::compile(&map, &sources, &options, &mut diagnostics).is_some()
            }
            Tests::Checked | Tests::LeftOut => {
                check(&map, &sources, &options, &mut diagnostics).is_some()
            }
        };
        let error = diagnostics.iter().any(|d| d.severity == Severity::Error);
        assert_ne!(done, error, "{text}");
    }
}

/// One prefix in so many is checked with the library.
const CHECKED: usize = 16;

#[test]
fn every_prefix_is_checked() {
    let prefixes: Vec<String> = files()
        .iter()
        .flat_map(|(name, text)| {
            let (mut map, mut names) = (SourceMap::new(), Names::new());
            let file = map.add(name.as_str(), text.as_str());
            let tokens = lex(file, text, Dialect::Iec, &mut names);
            let ends = tokens.list.iter().map(|token| token.end as usize);
            ends.map(|end| text[..end].to_owned()).collect::<Vec<_>>()
        })
        .collect();
    let chosen: Vec<_> = prefixes.iter().step_by(CHECKED).collect();
    parallel_map(&chosen, |text| survives(text));
}

#[test]
fn damaged_files_give_messages_not_panics() {
    let files = files();
    for seed in seeds(100) {
        let mut rng = Rng::new(seed);
        let (_, text) = &files[rng.below(files.len())];
        survives(&mutate(text, &mut rng));
        survives(&mutate_values(text, &mut rng));
    }
}
