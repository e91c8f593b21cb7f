//! The compliance statement, as Markdown, from the results of a run.
//!
//! A feature has what cases proved: `pass` if every case that covers it ran and was right, `partial` if
//! an engine did not take some of them, `fail` if one was wrong, `none` without a case that ran.

use crate::case::Case;
use crate::engines::Family;
use crate::features::{Edition, Feature, FeatureId, features};
use crate::run::{CaseResult, Outcome};
use crate::suite::counts;
use crate::tables::{errors, extensions, parameters};
use iecc_driver::EngineKind;
use std::collections::BTreeMap;
use std::fmt::Write;

/// What the cases of a feature proved on a family of engines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Tally {
    passed: usize,
    /// Refused, or not to be shown on the engine.
    left: usize,
    failed: usize,
}

/// Everything the cases say about a feature.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Proof {
    /// One for each family.
    runs: [Tally; Family::ALL.len()],
    /// Cases that run.
    cases: usize,
    /// Cases that check messages alone.
    messages: usize,
}

/// Writes the statement. Results belong to cases by position; every case of the suite should be
/// there.
pub fn statement(cases: &[Case], results: &[CaseResult]) -> String {
    let mut text = String::new();
    write_all(&mut text, cases, results).expect("writing to a string");
    text
}

fn write_all(out: &mut String, cases: &[Case], results: &[CaseResult]) -> std::fmt::Result {
    assert_eq!(cases.len(), results.len(), "a result for each case");
    introduction(out, cases, results)?;
    for edition in [Edition::Three, Edition::Two] {
        let proofs = proofs(edition, cases, results);
        write_edition(out, edition, &proofs)?;
    }
    write_parameters(out)?;
    write_errors(out)?;
    write_extensions(out)
}

fn introduction(out: &mut String, cases: &[Case], results: &[CaseResult]) -> std::fmt::Result {
    let told = cases.iter().filter(|case| case.trace.is_none()).count();
    let failed = results
        .iter()
        .filter(|result| !result.failures().is_empty());
    writeln!(
        out,
        "# Compliance statement

iecc {} complies with the requirements of IEC 61131-3, edition 3 (2013), for the language features that
are marked `pass` below. The feature numbers of edition 2 (2003) follow as a cross-reference.

Every mark comes from the run of the conformance suite that wrote this statement: {} cases, of which
{} run scan by scan against expected values, and {} are programs whose messages are expected.
Failed: {}.

The columns at the right count the cases that run, and those that check messages alone.

* `pass`: every case of the feature ran and gave what is expected.
* `partial`: the engine ran some of the cases and refused the others with a message, or cannot show them.
* `fail`: a case gave something else.
* `none`: no case of the feature ran. Nothing is claimed.
",
        env!("CARGO_PKG_VERSION"),
        cases.len(),
        cases.len() - told,
        told,
        failed.count(),
    )?;
    write_engines(out, results)
}

fn write_engines(out: &mut String, results: &[CaseResult]) -> std::fmt::Result {
    writeln!(
        out,
        "| Engine | Passed | Refused | Not applicable | Failed |\n|---|--:|--:|--:|--:|"
    )?;
    for engine in EngineKind::ALL {
        let [passed, refused, other, failed] = counts(engine, results);
        let name = engine.name();
        writeln!(
            out,
            "| {name} | {passed} | {refused} | {other} | {failed} |"
        )?;
    }
    writeln!(
        out,
        "
On every engine the outputs of every scan are compared bit for bit with those of the interpreter.
A case is not applicable to hardware if its scans do not come one period after the other: hardware
runs one in every period."
    )
}

/// What is proved, by feature.
fn proofs(
    edition: Edition,
    cases: &[Case],
    results: &[CaseResult],
) -> BTreeMap<&'static FeatureId, Proof> {
    let own = features()
        .iter()
        .filter(|feature| feature.id.edition == edition);
    let own: Vec<&Feature> = own.collect();
    let mut proofs: BTreeMap<&FeatureId, Proof> = BTreeMap::new();
    for (case, result) in cases.iter().zip(results) {
        for feature in own.iter().filter(|feature| proves(case, feature)) {
            proofs.entry(&feature.id).or_default().add(case, result);
        }
    }
    proofs
}

/// Whether a case covers a row, or the newer row that means the same.
fn proves(case: &Case, feature: &Feature) -> bool {
    let newer = feature.newer.as_ref();
    case.covers.contains(&feature.id) || newer.is_some_and(|newer| case.covers.contains(newer))
}

impl Proof {
    fn add(&mut self, case: &Case, result: &CaseResult) {
        if case.trace.is_none() {
            self.messages += 1;
            let wrong = usize::from(result.front.is_err());
            self.runs.iter_mut().for_each(|tally| tally.failed += wrong);
            return;
        }
        self.cases += 1;
        for (family, tally) in Family::ALL.into_iter().zip(&mut self.runs) {
            tally.add(family, result);
        }
    }
}

impl Tally {
    /// A case counts once, by the worst of the engines of the family.
    fn add(&mut self, family: Family, result: &CaseResult) {
        let outcomes = result.engines.iter();
        let own = outcomes.filter(|result| Family::of(result.engine) == family);
        let own: Vec<&Outcome> = own.map(|result| &result.outcome).collect();
        let failed = |outcome: &&Outcome| matches!(outcome, Outcome::Failed(_));
        let passed = |outcome: &&Outcome| **outcome == Outcome::Passed;
        if own.is_empty() || own.iter().any(failed) {
            self.failed += 1;
        } else if own.iter().all(passed) {
            self.passed += 1;
        } else {
            self.left += 1;
        }
    }

    fn mark(self) -> String {
        match self {
            Self { failed: 1.., .. } => "fail".to_owned(),
            Self { passed: 0, .. } => "none".to_owned(),
            Self { left: 0, .. } => "pass".to_owned(),
            Self { passed, left, .. } => format!("partial, {passed} of {}", passed + left),
        }
    }
}

fn write_edition(
    out: &mut String,
    edition: Edition,
    proofs: &BTreeMap<&FeatureId, Proof>,
) -> std::fmt::Result {
    let title = match edition {
        Edition::Three => "Edition 3",
        Edition::Two => "Cross-reference: edition 2",
    };
    writeln!(out, "\n## {title}")?;
    for rows in tables(edition) {
        let first = rows[0];
        writeln!(out, "\n### Table {}: {}\n", first.id.table, first.title)?;
        if rows.iter().any(|row| proofs.contains_key(&row.id)) {
            write_table(out, &rows, proofs)?;
        } else {
            writeln!(out, "None of its {} features.", rows.len())?;
        }
    }
    Ok(())
}

/// The rows of each table of an edition.
fn tables(edition: Edition) -> Vec<Vec<&'static Feature>> {
    let mut tables: Vec<Vec<&Feature>> = Vec::new();
    for feature in features().iter().filter(|row| row.id.edition == edition) {
        match tables.last_mut() {
            Some(rows) if rows[0].id.table == feature.id.table => rows.push(feature),
            Some(_) | None => tables.push(vec![feature]),
        }
    }
    tables
}

fn write_table(
    out: &mut String,
    rows: &[&Feature],
    proofs: &BTreeMap<&FeatureId, Proof>,
) -> std::fmt::Result {
    writeln!(
        out,
        "| No. | Feature | Interpreter | Machine code | Verilog | Cases | Messages |
|---|---|---|---|---|--:|--:|"
    )?;
    for row in rows {
        let proof = proofs.get(&row.id).cloned().unwrap_or_default();
        let marks = proof.runs.map(Tally::mark).join(" | ");
        let (number, text) = (&row.id.feature, escape(&row.text));
        let Proof {
            cases, messages, ..
        } = proof;
        writeln!(
            out,
            "| {number} | {text} | {marks} | {cases} | {messages} |"
        )?;
    }
    Ok(())
}

/// A text of the standard in a cell: bars and stars would be read as Markdown. Texts of our own are
/// Markdown.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        if matches!(c, '|' | '*' | '<' | '>' | '\\' | '`') {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

fn write_parameters(out: &mut String) -> std::fmt::Result {
    writeln!(
        out,
        "
## Implementer-specific parameters

| Item | iecc |
|---|---|"
    )?;
    for row in parameters() {
        writeln!(out, "| {} | {} |", row.item, row.choice)?;
    }
    Ok(())
}

fn write_errors(out: &mut String) -> std::fmt::Result {
    writeln!(
        out,
        "
## Error conditions

Classes: (1) not reported; (2) reported when the program is compiled; (3) reported when its parts are
put together; (4) reported at run time.

| Condition | Class | Treatment |
|---|---|---|"
    )?;
    for row in errors() {
        let classes: Vec<String> = row
            .classes
            .iter()
            .map(|class| format!("({class})"))
            .collect();
        let (condition, treatment) = (&row.condition, &row.treatment);
        writeln!(out, "| {condition} | {} | {treatment} |", classes.join(" "))?;
    }
    Ok(())
}

fn write_extensions(out: &mut String) -> std::fmt::Result {
    writeln!(
        out,
        "
## Extensions

| Extension | How it is switched |
|---|---|"
    )?;
    for row in extensions() {
        let (extension, switch) = (&row.extension, &row.switch);
        writeln!(out, "| {extension} | {switch} |")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::EngineResult;

    fn case(name: &str, covers: &str, wrong: bool) -> Case {
        let (mark, table) = if wrong {
            ("(*~ E0010 *)", "")
        } else {
            ("", "trace:\n t | | x\n 0ms | | 1\n")
        };
        let text = format!("(*! covers: {covers}\n about: x\n {table}*)\n{mark}");
        Case::parse(name, &text).unwrap()
    }

    fn result(verilog: &Outcome) -> CaseResult {
        let outcome = |engine| match engine {
            EngineKind::Verilog => verilog.clone(),
            EngineKind::Interp
            | EngineKind::InterpSoftware
            | EngineKind::InterpHardware
            | EngineKind::JitPlain
            | EngineKind::Jit => Outcome::Passed,
        };
        let engines = EngineKind::ALL.map(|engine| EngineResult {
            engine,
            outcome: outcome(engine),
        });
        CaseResult {
            front: Ok(()),
            engines: engines.to_vec(),
        }
    }

    #[test]
    fn only_what_ran_is_claimed() {
        let cases = [
            case("t71/a", "ed3:71:8", false),
            case("t71/b", "ed3:71:8", false),
            case("t71/c", "ed3:71:9", false),
            case("t71/d", "ed3:71:10", true),
            case("t71/e", "ed3:71:10", true),
            case("t71/f", "ed3:71:11", false),
        ];
        let wrong = CaseResult {
            front: Err("x".to_owned()),
            engines: Vec::new(),
        };
        let checked = CaseResult {
            front: Ok(()),
            engines: Vec::new(),
        };
        let results = [
            result(&Outcome::Passed),
            result(&Outcome::Refused("no".to_owned())),
            result(&Outcome::NotApplicable),
            checked.clone(),
            checked,
            wrong,
        ];
        let text = statement(&cases, &results);
        for line in [
            "| 8 | \\* | pass | pass | partial, 1 of 2 | 2 | 0 |",
            "| 9 | / | pass | pass | none | 1 | 0 |",
            "| 10 | MOD | none | none | none | 0 | 2 |",
            "| 11 | + | fail | fail | fail | 1 | 0 |",
            "| 12 | - | none | none | none | 0 | 0 |",
            // The rows of edition 2 that mean the same.
            "| 6 | \\* | pass | pass | partial, 1 of 2 | 2 | 0 |",
            "| simulated Verilog | 1 | 1 | 1 | 0 |",
        ] {
            assert!(text.lines().any(|found| found == line), "{line}\n{text}");
        }
        assert!(text.contains("Failed: 1."), "{text}");
    }
}
