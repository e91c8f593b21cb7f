//! Machine code and interpreter agree on random modules in every output, state byte and fault.

use iecc_ir::{Module, print_module, verify};
use iecc_jit::Jit;
use iecc_passes::{SOFTWARE, Settings, run_pipeline};
use iecc_tests::differential::{Agreement, compare_engines, interpreter};
use iecc_tests::random_ir::{Options, random_module};
use iecc_tests::rng::{Rng, seeds};
use iecc_tests::stimulus::random_stimulus;

const SEEDS: u64 = 300;
const SCANS: usize = 20;

/// The module as it stands and as `iecc run` compiles it, against the module as it stands.
#[test]
fn machine_code_does_what_the_interpreter_does() {
    for seed in seeds(SEEDS) {
        let module = random_module(seed, &Options::all());
        check(&module, &module, seed);
        let mut optimised = module.clone();
        run_pipeline(
            &mut optimised,
            SOFTWARE,
            &Settings::default(),
            &mut |_, _| {},
        )
        .unwrap();
        check(&module, &optimised, seed);
    }
}

fn check(module: &Module, compiled: &Module, seed: u64) {
    let verified = verify(compiled).unwrap_or_else(|errors| panic!("seed {seed}: {}", errors[0]));
    let mut jit = Jit::new(verified).unwrap_or_else(|errors| panic!("seed {seed}: {errors:?}"));
    let stimulus = random_stimulus(module, &mut Rng::new(seed), SCANS);
    let mut reference = interpreter(module);
    compare_engines(module, &mut reference, &mut jit, Agreement::All, &stimulus).unwrap_or_else(
        |difference| panic!("seed {seed}: {difference}\n{}", print_module(compiled)),
    );
}
