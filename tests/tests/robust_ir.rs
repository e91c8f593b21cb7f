//! Damaged modules in the text form: messages, never a panic. The check is that of the fuzz target.

use iecc_ir::print_module;
use iecc_tests::check;
use iecc_tests::mutate::mutate;
use iecc_tests::random_ir::{Options, random_module};
use iecc_tests::rng::{Rng, seeds};

const SEEDS: u64 = 1000;

/// Small, so that damage hits something else each time.
const SMALL: Options = Options {
    statements: 4,
    functions: 1,
    ..Options::all()
};

#[test]
fn damaged_modules_are_refused_or_run() {
    let (mut ran, seeds) = (0, seeds(SEEDS));
    for seed in seeds.clone() {
        let text = print_module(&random_module(seed, &SMALL));
        ran += u64::from(check::ir(&mutate(&text, &mut Rng::new(seed))));
    }
    assert!((1..seeds.end).contains(&ran), "both outcomes occur: {ran}");
}
