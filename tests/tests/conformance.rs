//! The conformance suite: every case is readable, and the runner finds what is wrong.
#![expect(
    clippy::disallowed_methods,
    reason = "tests read files outside the project"
)]

use iecc_ast::Names;
use iecc_conformance::{
    Case, CaseResult, Outcome, errors, extensions, features, parameters, run_module,
};
use iecc_diag::{Diagnostics, Severity, render_text};
use iecc_driver::EngineKind;
use iecc_grammar::st::parse_file;
use iecc_ir::parse_module;
use iecc_source::SourceMap;
use iecc_tests::cases::suite;
use iecc_tests::shared::shared_dir;
use std::collections::BTreeSet;

#[test]
fn every_case_can_be_read() {
    assert!(!suite().is_empty());
}

/// The list of features is that of the tables in the test data, row by row.
#[test]
fn the_features_are_those_of_the_standard() {
    let Some(shared) = shared_dir() else {
        return;
    };
    let path = shared.join("spec/iec61131-3-tables.csv");
    let text = std::fs::read_to_string(&path).expect("the tables of the test data");
    let given = csv_rows(&text).into_iter().map(|row| {
        let [edition, table, title, feature, text, _] = <[String; 6]>::try_from(row).unwrap();
        (format!("{edition}:{table}:{feature}"), title, text)
    });
    let own = features().iter();
    let own = own.map(|row| (row.id.to_string(), row.title.clone(), row.text.clone()));
    assert_eq!(own.collect::<Vec<_>>(), given.collect::<Vec<_>>());
}

/// The rows behind the head; cells in quotes may hold commas and doubled quotes.
fn csv_rows(text: &str) -> Vec<Vec<String>> {
    let row = |line: &str| {
        let (mut cells, mut quoted) = (vec![String::new()], false);
        let mut characters = line.chars().peekable();
        while let Some(c) = characters.next() {
            let cell = cells.last_mut().expect("never empty");
            match c {
                '"' if quoted && characters.peek() == Some(&'"') => {
                    cell.extend(characters.next());
                }
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(String::new()),
                c => cell.push(c),
            }
        }
        cells
    };
    text.lines().skip(1).map(row).collect()
}

/// Rows of the statement name cases that exist.
#[test]
fn what_the_statement_says_is_shown_by_cases() {
    let suite: BTreeSet<String> = suite().into_iter().map(|case| case.name).collect();
    let named = parameters().iter().map(|row| &row.cases);
    let named = named.chain(errors().iter().map(|row| &row.cases));
    let named = named.chain(extensions().iter().map(|row| &row.cases));
    let missing: Vec<_> = named
        .flatten()
        .filter(|name| !suite.contains(*name))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// What runs follows the grammar to the letter, whatever else is wrong with it.
#[test]
fn cases_that_run_are_parsed_without_an_error() {
    let mut found = Vec::new();
    for case in suite().iter().filter(|case| !case.has_errors()) {
        let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
        let file = map.add(format!("{}.st", case.name), case.text.as_str());
        let text = map.file(file).text();
        parse_file(
            file,
            text,
            case.dialect,
            &mut Names::new(),
            &mut diagnostics,
        );
        let errors = diagnostics.iter();
        let errors = errors.filter(|diagnostic| diagnostic.severity == Severity::Error);
        found.extend(errors.map(|diagnostic| render_text(&map, diagnostic, false)));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A program in the step language: sums, a fault, a string, a value of the state.
const MODULE: &str = "module m
struct TEXT { LEN: i32, DATA: [4 x i8] }
state { total: i16, seen: i1 }
input { a: i16, b: i16, s: TEXT }
output { x: i16, t: TEXT }
scan @scan

fn @scan[]() -> () {
b0:
  v0: i16 = load input.a
  v1: i16 = load input.b
  v2: i16 = add v0, v1
  v3: i16 = load state.total
  v4: i16 = add v3, v0
  store state.total, v4
  store output.x, v2
  v5: i32 = load input.s.LEN
  store output.t.LEN, v5
  v6: i8 = load input.s.DATA[0]
  store output.t.DATA[0], v6
  v7: i8 = load input.s.DATA[1]
  store output.t.DATA[1], v7
  return
}
";

fn run(table: &str) -> CaseResult {
    run_with("", MODULE, table)
}

fn run_with(keys: &str, module: &str, table: &str) -> CaseResult {
    let text = format!("(*! covers: ed3:71:11\nabout: x\n{keys}trace:\n{table}*)\n");
    let case = Case::parse("t71/sum", &text).unwrap();
    let module = parse_module(module).unwrap();
    let trace = case.trace.clone().unwrap();
    run_module(&case, module, &trace)
}

fn outcome(result: &CaseResult, engine: EngineKind) -> &Outcome {
    let found = result.engines.iter().find(|found| found.engine == engine);
    &found.expect("every engine runs").outcome
}

#[test]
fn what_is_expected_passes_on_every_engine() {
    let result = run("t | a b s | x t total
        0ms | 2 3 'ab' | 5 'ab' 2
        10ms | - -3 'c' | -1 'c' INT#4
        20ms | 16#7FFF 1 '' | -32768 '' 16#8003
    ");
    for engine in EngineKind::ALL {
        assert_eq!(*outcome(&result, engine), Outcome::Passed, "{engine:?}");
    }
}

#[test]
fn a_wrong_value_is_found_on_every_engine() {
    for (table, what) in [
        (
            "t | a | x\n0ms | 2 | 2\n1ms | 3 | 2\n",
            "scan 1 (line 6): `x` is 3 (16#3), not 2 (16#2)",
        ),
        (
            "t | s | t\n0ms | 'ab' | 'a'\n",
            "`t` is 'ab' of length 2, not 'a' of length 1",
        ),
    ] {
        let result = run(table);
        for engine in EngineKind::ALL {
            let Outcome::Failed(found) = outcome(&result, engine) else {
                panic!("{engine:?}: {result:?}")
            };
            assert!(found.contains(what), "{found}");
        }
    }
}

#[test]
fn what_a_table_cannot_mean_is_refused() {
    for (table, what) in [
        ("t | | y\n0ms | | 1\n", "no tag or point is named `y`"),
        (
            "t | x | x\n0ms | 1 | 1\n",
            "`x` is an output and cannot be set",
        ),
        ("t | | s.DATA\n0ms | | 1\n", "`s.DATA` is not one value"),
        (
            "t | | x\n0ms | | TRUE\n",
            "line 5: `x`: `TRUE` is no value of 16 bits",
        ),
        ("t | | t\n0ms | | 'abcde'\n", "longer than 4"),
    ] {
        let front = run(table).front.unwrap_err();
        assert!(front.contains(what), "{front}");
    }
}

#[test]
fn values_of_the_state_are_set_for_one_scan() {
    let result = run("t | total a | x total
        0ms | 100 1 | 1 101
        1ms | - - | 1 102
        2ms | 5 - | - 6
    ");
    assert_eq!(result.failures(), Vec::<String>::new());
}

/// Divides, and stops where it cannot.
const DIVIDES: &str = "module m
state { }
input { a: i16 }
output { x: i16 }
scan @scan

fn @scan[]() -> () {
b0:
  v0: i16 = load input.a
  v1: i16 = const 0
  v2: i1 = eq v0, v1
  brif v2, b1, b2
b1:
  fault divide
b2:
  v3: i16 = const 100
  v4: i16 = sdiv v3, v0
  store output.x, v4
  return
}
";

#[test]
fn a_fault_is_expected_in_the_last_scan_alone() {
    let table = "t | a | x\n0ms | 7 | 14\n1ms | 0 | -\n";
    let result = run_with("fault: divide\n", DIVIDES, table);
    assert_eq!(result.failures(), Vec::<String>::new());
    assert!(matches!(
        outcome(&result, EngineKind::Verilog),
        Outcome::Refused(_)
    ));
    for (keys, what) in [
        ("", "expected no fault, found divide"),
        ("fault: index\n", "expected index, found divide"),
    ] {
        let result = run_with(keys, DIVIDES, table);
        let Outcome::Failed(found) = outcome(&result, EngineKind::Jit) else {
            panic!("{result:?}")
        };
        assert!(found.contains(what), "{found}");
    }
    let result = run_with("fault: divide\n", DIVIDES, "t | a |\n0ms | 7 |\n");
    assert_eq!(result.failures().len(), 5, "all but hardware run it");
}

#[test]
fn engines_that_must_run_a_case_may_not_refuse_it() {
    let keys = "only: interp jit verilog\nbecause: hardware has no faults\nfault: divide\n";
    let result = run_with(keys, DIVIDES, "t | a |\n0ms | 0 |\n");
    let Outcome::Failed(found) = outcome(&result, EngineKind::Verilog) else {
        panic!("{result:?}")
    };
    assert!(found.contains("refuses the program: E7005"), "{found}");
}

#[test]
fn hardware_is_asked_only_for_scans_in_every_period() {
    let result = run("t | a | x\n0ms | 2 | 2\n10ms | - | 2\n25ms | - | 2\n");
    assert_eq!(result.failures(), Vec::<String>::new());
    let verilog = outcome(&result, EngineKind::Verilog);
    assert_eq!(*verilog, Outcome::NotApplicable);
}
