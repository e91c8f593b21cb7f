//! Random programs in Structured Text: the compiler accepts them all, and interpreter, optimised
//! interpreter and machine code agree in every output, fault and state byte of every scan.

use iecc_driver::{ParsedLibrary, parallel_map};
use iecc_tests::random_st::{Options, check_seed};
use iecc_tests::rng::seeds;

const SEEDS: u64 = 2_000;

#[test]
fn engines_agree_on_random_programs() {
    let seeds: Vec<u64> = seeds(SEEDS).collect();
    let library = ParsedLibrary::parse();
    let results = parallel_map(&seeds, |&seed| {
        check_seed(&library, seed, Options::default())
    });
    let count = results.len();
    let failures: Vec<&String> = results.iter().filter_map(|r| r.as_ref().err()).collect();
    assert!(
        failures.is_empty(),
        "{} of {count} fail, the first:\n{}",
        failures.len(),
        failures[0]
    );
}
