//! What of the corpus is compiled: a table of the files that lower completely, and for every other
//! the first reason why not. No file makes the compiler panic.
#![expect(
    clippy::print_stdout,
    reason = "the table is part of what the test shows"
)]

use iecc_diag::{Code, Diagnostic, Diagnostics, Severity};
use iecc_driver::{FrontOptions, Sources, compile, load};
use iecc_source::SourceMap;
use iecc_tests::corpus::{CorpusFile, corpus_files};
use iecc_tests::shared::shared_dir;
use std::collections::BTreeMap;

/// Whether a code says why rungs cannot be compiled. An export of a part has no task; what matters then
/// is what else stands against it, which is a warning in routines that never run.
fn is_reason(code: Code) -> bool {
    ![
        Code::E5028,
        Code::E5032,
        Code::E6020,
        Code::E6023,
        Code::E6028,
        Code::E6031,
    ]
    .contains(&code)
}

/// Whether a file lowers, and if not, why.
fn outcome(file: &CorpusFile) -> Result<usize, (Diagnostic, String)> {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let id = load(&mut map, &file.path, &mut diagnostics).expect("the corpus is readable");
    let options = FrontOptions::default();
    let sources = Sources::logix(&mut map, id);
    match compile(&map, &sources, &options, &mut diagnostics) {
        Some(module) => Ok(module.funcs.len()),
        None => {
            let errors = diagnostics.iter();
            let mut errors = errors.filter(|d| d.severity == Severity::Error);
            let no_task = errors.next().expect("no module without an error");
            let first = diagnostics.iter().find(|d| is_reason(d.code));
            let first = first.unwrap_or(no_task).clone();
            let place = first.primary.as_ref().map(|label| map.start(label.span));
            let place = place.map_or(String::new(), |at| format!("{}:{}", at.line, at.column));
            Err((first, place))
        }
    }
}

#[test]
fn every_file_lowers_or_says_why_not() {
    let Some(shared) = shared_dir() else { return };
    let (mut lowered, mut reasons, mut controllers) = (Vec::new(), BTreeMap::new(), 0);
    let files = corpus_files(&shared);
    for file in &files {
        let outcome = outcome(file);
        match &outcome {
            Ok(functions) => lowered.push((&file.name, file.rungs, *functions)),
            Err((reason, _)) => *reasons.entry(reason.code).or_insert(0) += 1,
        }
        controllers += usize::from(file.target == "Controller" && file.rungs > 0);
        if let Err((reason, place)) = &outcome {
            println!("{}:{place}: {} {}", file.name, reason.code, reason.message);
        }
    }
    println!(
        "\n{} files, {controllers} controllers with ladder",
        files.len()
    );
    for (name, rungs, functions) in &lowered {
        println!("lowers: {name} ({rungs} rungs, {functions} functions)");
    }
    for (code, count) in &reasons {
        println!("{code} {count:>4} {}", code.title());
    }
    let has = |end: &str| lowered.iter().any(|(name, ..)| name.ends_with(end));
    assert!(has("PLC/ALD_miami.L5X"), "the ALD program lowers");
}
