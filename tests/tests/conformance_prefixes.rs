//! A program that is being typed: every prefix of every conformance case is checked without a panic and
//! in bounded time.
//!
//! Prefixes end behind each token, in every tenth case behind each byte. All are parsed; one in 64 is
//! checked together with the standard library, other ones in each case.
#![expect(clippy::disallowed_methods, reason = "the bound on time needs a clock")]

use iecc_ast::Names;
use iecc_conformance::Case;
use iecc_diag::Diagnostics;
use iecc_driver::{FrontOptions, Sources, check, parallel_map};
use iecc_grammar::st::{lex, parse_file};
use iecc_source::SourceMap;
use iecc_tests::cases::suite;
use std::time::{Duration, Instant};

/// Far above what a prefix needs on any machine, far below what a hang needs.
const LONGEST: Duration = Duration::from_secs(5);

/// One in so many prefixes is checked.
const CHECKED: usize = 64;

#[test]
fn every_prefix_of_every_case_is_checked() {
    let cases: Vec<(usize, Case)> = suite().into_iter().enumerate().collect();
    let slow = parallel_map(&cases, |(number, case)| {
        let ends = ends(case, number % 10 == 0);
        let mut slow = ends.iter().enumerate().filter(|(index, end)| {
            let whole = (index + number) % CHECKED == 0;
            duration(case, **end, whole) > LONGEST
        });
        slow.next().map(|(_, end)| (case.name.clone(), *end))
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

fn duration(case: &Case, end: usize, whole: bool) -> Duration {
    let start = Instant::now();
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let text = &program(case)[..end];
    let file = map.add("case.st", text);
    if whole {
        let options = FrontOptions {
            dialect: case.dialect,
            ..FrontOptions::default()
        };
        let sources = Sources::text(&mut map, vec![file]);
        check(&map, &sources, &options, &mut diagnostics);
    } else {
        let mut names = Names::new();
        parse_file(file, text, case.dialect, &mut names, &mut diagnostics);
    }
    start.elapsed()
}
