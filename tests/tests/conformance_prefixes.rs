//! A program that is being typed: every prefix of every conformance case is checked without a panic and
//! in bounded time.
//!
//! Prefixes end behind each token; in every tenth case behind each byte.
#![expect(clippy::disallowed_methods, reason = "the bound on time needs a clock")]

use iecc_ast::Names;
use iecc_conformance::Case;
use iecc_diag::Diagnostics;
use iecc_driver::{FrontOptions, Sources, check, parallel_map};
use iecc_grammar::st::lex;
use iecc_source::SourceMap;
use iecc_tests::cases::suite;
use std::time::{Duration, Instant};

/// Far above what a prefix needs on any machine, far below what a hang needs.
const LONGEST: Duration = Duration::from_secs(5);

#[test]
fn every_prefix_of_every_case_is_checked() {
    let cases: Vec<(usize, Case)> = suite().into_iter().enumerate().collect();
    let slow = parallel_map(&cases, |(number, case)| {
        let ends = ends(case, number % 10 == 0);
        let mut slow = ends.iter().filter(|end| duration(case, **end) > LONGEST);
        slow.next().map(|end| (case.name.clone(), *end))
    });
    let slow: Vec<_> = slow.into_iter().flatten().collect();
    assert!(slow.is_empty(), "prefixes that take too long: {slow:?}");
}

/// The program, without the comment that makes it a case.
fn program(case: &Case) -> &str {
    case.text
        .split_once("*)")
        .map_or("", |(_, program)| program)
}

fn ends(case: &Case, every_byte: bool) -> Vec<usize> {
    let text = program(case);
    if every_byte {
        return text.char_indices().map(|(at, _)| at).collect();
    }
    let (mut map, mut names) = (SourceMap::new(), Names::new());
    let file = map.add("case.st", text);
    let tokens = lex(file, text, case.dialect, &mut names);
    let ends = tokens.list.iter().filter(|token| !token.kind.is_trivia());
    ends.map(|token| token.end as usize).collect()
}

fn duration(case: &Case, end: usize) -> Duration {
    let start = Instant::now();
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let file = map.add("case.st", &program(case)[..end]);
    let options = FrontOptions {
        dialect: case.dialect,
        ..FrontOptions::default()
    };
    let sources = Sources::text(&mut map, vec![file]);
    check(&map, &sources, &options, &mut diagnostics);
    start.elapsed()
}
