//! The conformance suite: every case passes on every engine that takes it. Cases of what is not
//! compiled yet are named in `conformance_open.txt`, each with the reason; they must fail, so the list
//! can only shrink.

use iecc_conformance::{CaseResult, Outcome, run_case};
use iecc_driver::{EngineKind, parallel_map};
use iecc_tests::cases::suite;
use std::collections::{BTreeMap, BTreeSet};

/// Names of open cases, and why they are.
fn open() -> BTreeMap<&'static str, &'static str> {
    let lines = include_str!("../conformance_open.txt").lines();
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    let pair = |line: &'static str| line.split_once(": ").expect("a name and a reason");
    lines.map(pair).collect()
}

#[test]
fn every_case_passes_but_the_open_ones() {
    let (cases, open) = (suite(), open());
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    let results = parallel_map(&cases, run_case);
    let mut wrong = Vec::new();
    for (case, result) in cases.iter().zip(&results) {
        let failures = result.failures();
        match (failures.is_empty(), open.contains_key(case.name.as_str())) {
            (true, false) | (false, true) => {}
            (true, true) => wrong.push(format!("{}: passes, and is called open", case.name)),
            (false, false) => wrong.push(format!("{}: {}", case.name, failures.join("; "))),
        }
    }
    let gone = open.keys().filter(|name| !names.contains(*name));
    wrong.extend(gone.map(|name| format!("{name}: is called open, but is no case")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_hardware_takes_most(&results);
}

/// Hardware may refuse a case, which must not become a way to pass them all.
fn assert_hardware_takes_most(results: &[CaseResult]) {
    let hardware = results
        .iter()
        .flat_map(|result| &result.engines)
        .filter(|result| result.engine == EngineKind::Verilog);
    let (mut passed, mut others) = (0, 0);
    for result in hardware {
        match result.outcome {
            Outcome::Passed => passed += 1,
            Outcome::Refused(_) | Outcome::NotApplicable | Outcome::Failed(_) => others += 1,
        }
    }
    assert!(passed >= 2 * others, "{passed} cases pass, {others} do not");
}
