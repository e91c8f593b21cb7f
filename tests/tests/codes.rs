//! The sets agree: every code has a page, and an example that gives it, alone of its kind.

use iecc_diag::{Code, Diagnostics, Severity};
use iecc_driver::{Found, FrontOptions, Sources, Tests, compile, find};
use iecc_source::SourceMap;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Codes that no source gives, and what gives them instead.
fn given_elsewhere(code: Code) -> bool {
    let name = code.as_str();
    // No file at all; 256 MiB of text; the command line; very many folders; the stimulus, whose
    // examples are tables that the tests of runs read; cases of the conformance suite; unit tests that
    // fail when they run; and targets, whose own tests hold what they refuse.
    [
        "E0001", "E0003", "E6030", "E6054", "E6080", "E6081", "E6090", "E6091",
    ]
    .contains(&name)
        || is_about_structured_text(code)
        || ("E6001".."E6020").contains(&name)
        || name.starts_with("E7")
}

/// The examples of these codes are `.st` files, which the tests of the reader read.
fn is_about_structured_text(code: Code) -> bool {
    (Code::E0010..=Code::E0034).contains(&code)
}

fn examples() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("codes")
}

/// The example of a code: a source file, or a folder.
fn example(code: Code) -> PathBuf {
    let endings = ["L5X", "st", "scl", "toml", ""];
    let mut paths = endings
        .map(|ending| examples().join(code.as_str()).with_extension(ending))
        .into_iter();
    let found = paths.find(|path| path.exists());
    found.unwrap_or_else(|| panic!("{code} has no example"))
}

fn codes_of(path: &std::path::Path) -> Vec<(Code, Severity)> {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let paths = [path.to_owned()];
    let (sources, options) = match find(&mut map, &paths, &mut diagnostics) {
        None => (None, FrontOptions::default()),
        Some(Found::Paths(paths)) => {
            let options = FrontOptions {
                tests: Tests::Checked,
                ..FrontOptions::default()
            };
            let sources = Sources::load(&mut map, &paths, &options.levels, &mut diagnostics);
            (sources, options)
        }
        Some(Found::Project(project)) => {
            let options = project.options.clone();
            (
                project.load(&mut map, &options.levels, &mut diagnostics),
                options,
            )
        }
    };
    if let Some(sources) = sources {
        compile(&map, &sources, &options, &mut diagnostics);
    }
    let found = diagnostics.iter();
    found
        .map(|diagnostic| (diagnostic.code, diagnostic.severity))
        .collect()
}

#[test]
fn every_example_gives_its_code_and_no_other_error() {
    for &code in Code::ALL.iter().filter(|code| !given_elsewhere(**code)) {
        let path = example(code);
        let found = codes_of(&path);
        assert!(
            found.contains(&(code, code.severity())),
            "{} gives {found:?}",
            path.display()
        );
        let others = found.iter().filter(|(other, _)| *other != code);
        // A file about something else than tasks need not have one.
        let errors: Vec<_> = others
            .filter(|(other, severity)| *severity == Severity::Error && *other != Code::E6020)
            .collect();
        assert!(errors.is_empty(), "{} gives {errors:?}", path.display());
    }
}

#[test]
fn every_example_belongs_to_a_code() {
    let known: BTreeSet<&str> = Code::ALL.iter().map(|code| code.as_str()).collect();
    for entry in std::fs::read_dir(examples()).expect("the folder of examples") {
        let path = entry.expect("readable").path();
        let stem = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        assert!(known.contains(stem.as_str()), "{}", path.display());
    }
}

#[test]
fn every_page_says_what_it_means_shows_an_example_and_how_to_mend_it() {
    for &code in Code::ALL {
        let page = code.explanation();
        let head = format!("# {code}: {}\n\n", code.title());
        assert!(page.starts_with(&head), "{code}: {page}");
        assert!(page.contains("\nExample"), "{code} has no example");
        assert!(page.contains("\nTo mend it, "), "{code} says no mend");
    }
}
