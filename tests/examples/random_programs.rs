//! Runs random programs of Structured Text on all engines for software, and tells what is wrong.
//!
//!     cargo run --release -p iecc-tests --example random_programs -- FROM TO [--all]
//!     cargo run --release -p iecc-tests --example random_programs -- --show SEED
//!
//! Ends at the first failure, with its program shrunk; `--all` goes on, and lists the first seed of each kind of
//! failure. `--show` prints a program as it is.
#![expect(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a program for people"
)]

use iecc_driver::{ParsedLibrary, parallel_map};
use iecc_tests::random_st::{Options, Outcome, check, check_seed, policy, random_program};
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::time::Instant;

/// Seeds between two reports.
const ROUND: u64 = 200;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let number = |text: &str| text.parse::<u64>().expect("a number");
    match words[..] {
        ["--show", seed] => {
            let program = random_program(number(seed), Options::default());
            print!("{}", program.text());
            ExitCode::SUCCESS
        }
        [from, to] => search(number(from), number(to)),
        [from, to, "--all"] => survey(number(from), number(to)),
        _ => {
            println!("random_programs FROM TO [--all] | --show SEED");
            ExitCode::from(2)
        }
    }
}

fn search(from: u64, to: u64) -> ExitCode {
    let (library, start) = (ParsedLibrary::parse(), Instant::now());
    for first in (from..to).step_by(ROUND as usize) {
        let seeds: Vec<u64> = (first..to.min(first + ROUND)).collect();
        let results = parallel_map(&seeds, |&seed| {
            let draft = random_program(seed, Options::default());
            check(&library, draft.text(), policy(seed), seed).map_err(|_| seed)
        });
        if let Some(seed) = results.iter().find_map(|result| result.err()) {
            let said =
                check_seed(&library, seed, Options::default()).expect_err("it failed before");
            println!("{said}");
            return ExitCode::FAILURE;
        }
        let outcomes = results.into_iter().flatten();
        let faults: usize = outcomes.map(|outcome: Outcome| outcome.faults).sum();
        println!("{first}: {faults} faults, {:?}", start.elapsed());
    }
    ExitCode::SUCCESS
}

fn survey(from: u64, to: u64) -> ExitCode {
    let library = ParsedLibrary::parse();
    let seeds: Vec<u64> = (from..to).collect();
    let results = parallel_map(&seeds, |&seed| {
        let draft = random_program(seed, Options::default());
        check(&library, draft.text(), policy(seed), seed)
    });
    let mut kinds = BTreeMap::new();
    let (mut faults, mut clean) = (0, 0);
    for (seed, result) in seeds.iter().zip(results) {
        match result {
            Ok(outcome) => {
                faults += outcome.faults;
                clean += usize::from(outcome.faults == 0);
            }
            Err(what) => {
                let kind = what.lines().next().unwrap_or_default().to_owned();
                kinds.entry(kind).or_insert((0, *seed, what)).0 += 1;
            }
        }
    }
    println!("{faults} scans with faults, {clean} programs without");
    for (count, seed, what) in kinds.values() {
        println!("{count} times, seed {seed}: {what}");
    }
    if kinds.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
