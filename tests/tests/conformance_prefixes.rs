//! A program that is being typed: every prefix of every conformance case is read without a panic and in
//! bounded time.
//!
//! Prefixes that end behind a token are checked with the standard library, all others are parsed.
#![expect(clippy::disallowed_methods, reason = "the bound on time needs a clock")]

use iecc_ast::Names;
use iecc_conformance::Case;
use iecc_diag::Diagnostics;
use iecc_driver::{FrontOptions, ParsedLibrary, parallel_map};
use iecc_grammar::st::{lex, parse_file};
use iecc_tests::cases::suite;
use std::time::{Duration, Instant};

/// Far above what a prefix needs on any machine, far below what a hang needs.
const LONGEST: Duration = Duration::from_secs(5);

#[test]
fn every_prefix_of_every_case_is_read() {
    let (library, cases) = (ParsedLibrary::parse(), suite());
    let slow = parallel_map(&cases, |case| slow_prefix(&library, case));
    let slow: Vec<_> = slow.into_iter().flatten().collect();
    assert!(slow.is_empty(), "prefixes that take too long: {slow:?}");
}

/// The case and the end of its first prefix that takes too long.
fn slow_prefix(library: &ParsedLibrary, case: &Case) -> Option<(String, usize)> {
    let program = program(case);
    let tokens = token_ends(library, case);
    let mut ends = program.char_indices().map(|(at, _)| at);
    let slow = ends.find(|&end| {
        let start = Instant::now();
        read(library, case, &program[..end], tokens.contains(&end));
        start.elapsed() > LONGEST
    });
    slow.map(|end| (case.name.clone(), end))
}

/// The program, without the comment that makes it a case.
fn program(case: &Case) -> &str {
    case.text
        .split_once("*)")
        .map_or("", |(_, program)| program)
}

fn token_ends(library: &ParsedLibrary, case: &Case) -> Vec<usize> {
    let tokens = lex(
        library.file(),
        program(case),
        case.dialect,
        &mut Names::new(),
    );
    let ends = tokens.list.iter().filter(|token| !token.kind.is_trivia());
    ends.map(|token| token.end as usize).collect()
}

fn read(library: &ParsedLibrary, case: &Case, text: &str, whole: bool) {
    let mut diagnostics = Diagnostics::new();
    if whole {
        let options = FrontOptions {
            dialect: case.dialect,
            ..FrontOptions::default()
        };
        library.check(text, &options, &mut diagnostics);
    } else {
        let mut names = Names::new();
        parse_file(
            library.file(),
            text,
            case.dialect,
            &mut names,
            &mut diagnostics,
        );
    }
}
