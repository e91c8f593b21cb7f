//! Passes on random modules of shapes of their own: one block of algebra, and graphs without loops.

use iecc_ir::{Module, print_module, verify};
use iecc_passes::{HARDWARE, SOFTWARE, Settings, run_pipeline};
use iecc_tests::differential::{Agreement, compare_modules};
use iecc_tests::random_ir::{random_expressions, random_graph};
use iecc_tests::rng::{Rng, seeds};
use iecc_tests::stimulus::random_stimulus;

const SCANS: usize = 30;

/// Runs passes; after each one the rules of the verifier hold, and the module does the same as at first.
fn after(before: &Module, passes: &[&'static str], seed: u64) -> Module {
    let stimulus = random_stimulus(before, &mut Rng::new(seed), SCANS);
    let (mut module, mut done) = (before.clone(), 0);
    run_pipeline(
        &mut module,
        passes,
        &Settings::default(),
        &mut |name, now| {
            done += 1;
            let text = || print_module(now);
            assert_eq!(verify(now).err(), None, "seed {seed}, {name}\n{}", text());
            let same = compare_modules(before, now, Agreement::after(&passes[..done]), &stimulus);
            same.unwrap_or_else(|error| panic!("seed {seed}, {name}: {error}"));
        },
    )
    .expect("the passes exist");
    module
}

#[test]
fn folding_keeps_the_meaning_of_random_expressions() {
    for seed in seeds(4_000) {
        after(&random_expressions(seed), &["fold"], seed);
    }
}

#[test]
fn every_graph_without_loops_becomes_one_block_that_does_the_same() {
    for seed in seeds(600) {
        let before = random_graph(seed, 2 + seed as usize % 24);
        for passes in [
            &["promote", "if_convert"][..],
            &["if_convert_small"],
            HARDWARE,
            SOFTWARE,
        ] {
            let after = after(&before, passes, seed);
            if passes.contains(&"if_convert") {
                assert_eq!(after.funcs[after.scan].layout.len(), 1, "seed {seed}");
            }
        }
    }
}
