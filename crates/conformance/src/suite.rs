//! A suite: files to cases, and the results of a run for people.

use crate::case::{Case, CaseError};
use crate::run::{CaseResult, Outcome};
use iecc_driver::EngineKind;
use iecc_source::{FileId, SourceMap};
use std::fmt::{self, Write};

/// A file that is no case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misread {
    /// Its name.
    pub file: String,
    /// What is wrong.
    pub error: CaseError,
}

impl fmt::Display for Misread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (file, CaseError { line, message }) = (&self.file, &self.error);
        write!(f, "{file}:{line}: {message}")
    }
}

/// Reads all cases; a case is named by its folder and file.
///
/// # Errors
/// Every file that is no case.
pub fn read_suite(map: &SourceMap, files: &[FileId]) -> Result<Vec<Case>, Vec<Misread>> {
    let (mut cases, mut misread) = (Vec::new(), Vec::new());
    for &id in files {
        let file = map.file(id);
        match Case::parse(&case_name(file.name()), file.text()) {
            Ok(case) => cases.push(case),
            Err(error) => misread.push(Misread {
                file: file.name().to_owned(),
                error,
            }),
        }
    }
    if misread.is_empty() {
        Ok(cases)
    } else {
        Err(misread)
    }
}

/// `t71/product` of `tests/conformance/t71/product.st`.
fn case_name(path: &str) -> String {
    let parts: Vec<&str> = path.split(['/', '\\']).collect();
    let name = parts[parts.len().saturating_sub(2)..].join("/");
    let stem = name.rsplit_once('.').map(|(stem, _)| stem.to_owned());
    stem.unwrap_or(name)
}

/// Every failure, with the name of its case.
pub fn failures(cases: &[Case], results: &[CaseResult]) -> Vec<String> {
    let mut failures = Vec::new();
    for (case, result) in cases.iter().zip(results) {
        let own = result.failures().into_iter();
        failures.extend(own.map(|failure| format!("{}: {failure}", case.name)));
    }
    failures
}

/// How many cases passed, and what engines refused, in a few lines.
pub fn summary(results: &[CaseResult]) -> String {
    let failed = results
        .iter()
        .filter(|result| !result.failures().is_empty());
    let failed = failed.count();
    let passed = results.len() - failed;
    let mut text = format!("cases: {passed} passed, {failed} failed\n");
    for engine in EngineKind::ALL {
        let [passed, refused, other, failed] = counts(engine, results);
        let name = engine.name();
        writeln!(
            text,
            "{name}: {passed} passed, {refused} refused, {other} not applicable, {failed} failed"
        )
        .expect("writing to a string");
    }
    text
}

/// How many cases an engine passed, refused, could not show, and failed.
pub(crate) fn counts(engine: EngineKind, results: &[CaseResult]) -> [usize; 4] {
    let outcomes = results.iter().flat_map(|result| &result.engines);
    let mut counts = [0; 4];
    for result in outcomes.filter(|result| result.engine == engine) {
        counts[match result.outcome {
            Outcome::Passed => 0,
            Outcome::Refused(_) => 1,
            Outcome::NotApplicable => 2,
            Outcome::Failed(_) => 3,
        }] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_are_named_by_folder_and_file() {
        for path in ["tests/conformance/t71/product.st", "t71\\product.st"] {
            assert_eq!(case_name(path), "t71/product", "{path}");
        }
        assert_eq!(case_name("product"), "product");
    }

    #[test]
    fn files_that_are_no_cases_are_named_with_the_line() {
        let mut map = SourceMap::new();
        let good = "(*! covers: ed3:71:8\nabout: x\ntrace:\nt | | x\n0ms | | 1\n*)";
        let files = [
            map.add("suite/t71/good.st", good),
            map.add("suite/t71/bad.st", "(*! covers: ed3:71:8\nhue: red *)"),
        ];
        let misread = read_suite(&map, &files).unwrap_err();
        let [misread] = &misread[..] else {
            panic!("{misread:?}")
        };
        assert_eq!(
            misread.to_string(),
            "suite/t71/bad.st:2: there is no key `hue`"
        );
        let cases = read_suite(&map, &files[..1]).unwrap();
        let result = CaseResult {
            front: Err("it is wrong".to_owned()),
            engines: Vec::new(),
        };
        assert_eq!(
            failures(&cases, std::slice::from_ref(&result)),
            ["t71/good: it is wrong"]
        );
        assert!(summary(&[result]).starts_with("cases: 0 passed, 1 failed\n"));
    }
}
