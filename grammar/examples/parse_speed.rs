//! Prints how many lines of Structured Text are lexed and parsed in a second, on one core:
//!
//!     cargo run --release -p iecc-grammar --example parse_speed FILE…
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a measurement reads files, the clock, and prints"
)]

use iecc_ast::Names;
use iecc_diag::Diagnostics;
use iecc_grammar::st::{Dialect, lex, parse_file, slice};
use iecc_source::FileId;
use std::time::{Duration, Instant};

/// The best of several runs: what else the machine does only ever makes a run slower.
const RUNS: usize = 10;

fn main() {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let lines = text.lines().count();
        let lexed = best(|| drop(lex(file(), &text, Dialect::Iec, &mut Names::new())));
        let mut names = Names::new();
        let tokens = lex(file(), &text, Dialect::Iec, &mut names);
        let sliced = best(|| drop(slice(&tokens)));
        let parsed = best(|| parse(&text));
        println!("{path}: {lines} lines, {} tokens", tokens.list.len());
        print("lex", lexed, lines);
        print("slice", sliced, lines);
        print("all", parsed, lines);
    }
}

fn file() -> FileId {
    FileId::from_index(0)
}

fn parse(text: &str) {
    let mut diagnostics = Diagnostics::new();
    let parsed = parse_file(
        file(),
        text,
        Dialect::Iec,
        &mut Names::new(),
        &mut diagnostics,
    );
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    drop(parsed);
}

fn best(mut run: impl FnMut()) -> Duration {
    let mut once = || {
        let start = Instant::now();
        run();
        start.elapsed()
    };
    (0..RUNS).map(|_| once()).min().expect("at least one run")
}

fn print(what: &str, time: Duration, lines: usize) {
    let ns = time.as_nanos() as f64 / lines as f64;
    println!(
        "  {what:6} {time:>12.3?} {ns:>7.0} ns/line {:>12.0} lines/s",
        1e9 / ns
    );
}
