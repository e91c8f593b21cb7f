//! Random programs in Structured Text as hardware: where the Verilog back end takes a program, its simulation
//! gives the outputs of the interpreter in every scan. It refuses most: loops, divisions, REAL, strings.

use iecc_diag::Diagnostics;
use iecc_driver::{EngineKind, FrontOptions, OnFault, ParsedLibrary, parallel_map};
use iecc_ir::{Module, Region};
use iecc_target::region_bytes;
use iecc_tests::random_st::{Options, random_program};
use iecc_tests::rng::{Rng, seeds};
use iecc_tests::stimulus::random_stimulus;

const SEEDS: u64 = 1_000;
const SCANS: usize = 12;
/// The time from one scan to the next.
const PERIOD_NS: u64 = 1_000_000;

const SMALL: Options = Options {
    statements: 1,
    functions: 1,
    blocks: 1,
};

#[test]
fn hardware_agrees_on_random_programs() {
    let library = ParsedLibrary::parse();
    let seeds: Vec<u64> = seeds(SEEDS).collect();
    let results = parallel_map(&seeds, |&seed| run(&library, seed));
    let taken = results.into_iter().filter(|taken| *taken).count();
    assert!(taken > seeds.len() / 20, "hardware takes {taken} programs");
}

/// Runs the program of a seed; says whether hardware takes it.
fn run(library: &ParsedLibrary, seed: u64) -> bool {
    let draft = random_program(seed, SMALL);
    let options = FrontOptions {
        on_fault: OnFault::Continue,
        ..FrontOptions::default()
    };
    let module = library.compile(draft.text(), &options, &mut Diagnostics::new());
    let module = module.expect("the generator makes programs that are right");
    let different = differs(&module, seed);
    if let Some(Some(scan)) = different {
        panic!("seed {seed} differs in scan {scan}:\n{}", draft.text());
    }
    different.is_some()
}

/// The scan in which outputs differ, if any; `None` if hardware refuses the module.
fn differs(module: &Module, seed: u64) -> Option<Option<usize>> {
    let mut hardware = EngineKind::Verilog.start(module, PERIOD_NS).ok()?;
    let mut reference = EngineKind::Interp
        .start(module, PERIOD_NS)
        .expect("runs all");
    let [mut expected, mut found] = [(); 2].map(|()| region_bytes(module, Region::Output));
    let stimulus = random_stimulus(module, &mut Rng::new(seed), SCANS);
    let mut scans = stimulus.iter().enumerate();
    Some(scans.find_map(|(scan, input)| {
        let now_ns = scan as u64 * PERIOD_NS;
        let same = reference.step(now_ns, &input.inputs, &mut expected).is_ok()
            == hardware.step(now_ns, &input.inputs, &mut found).is_ok();
        (!same || expected != found).then_some(scan)
    }))
}
