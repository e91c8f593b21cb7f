//! Structured Text from outside: the benchmark programs, and the examples of the codes.
#![expect(clippy::disallowed_methods, reason = "tests read files")]

use iecc_ast::Names;
use iecc_diag::{Code, Diagnostics};
use iecc_grammar::st::{Dialect, parse_file};
use iecc_source::FileId;
use iecc_tests::shared::shared_dir;
use iecc_tests::{check, st_text};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The files with an ending in a folder, by their names.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries =
        fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|found| found == ending));
    paths.sort();
    paths
}

#[test]
fn the_benchmark_programs_parse() {
    let Some(shared) = shared_dir() else {
        return;
    };
    let paths = files(&shared.join("bench"), "st");
    assert!(paths.len() >= 6, "{paths:?}");
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        assert!(check::st(&text), "{}", path.display());
    }
}

#[test]
fn the_sample_parses() {
    assert!(check::st(st_text::SAMPLE));
}

#[test]
fn each_example_of_a_text_code_gives_that_code_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("codes");
    let mut shown = BTreeSet::new();
    for path in files(&folder, "st") {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let Some(code) = Code::parse(name).filter(|_| name.starts_with("E00")) else {
            continue;
        };
        let text = fs::read_to_string(&path).unwrap();
        let mut diagnostics = Diagnostics::new();
        let file = FileId::from_index(0);
        parse_file(
            file,
            &text,
            Dialect::Iec,
            &mut Names::new(),
            &mut diagnostics,
        );
        let codes: Vec<Code> = diagnostics
            .iter()
            .map(|diagnostic| diagnostic.code)
            .collect();
        assert_eq!(codes, [code], "{}", path.display());
        shown.insert(code);
    }
    let all = Code::ALL
        .iter()
        .filter(|code| (Code::E0010..=Code::E0037).contains(code))
        // That depends on the dialect.
        .filter(|code| **code != Code::E0035);
    assert_eq!(shown, all.copied().collect(), "every code has an example");
}
