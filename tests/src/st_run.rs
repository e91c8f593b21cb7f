//! Runs programs of Structured Text on the engines that take all of the language: the reference
//! interpreter, before and after the passes for software, and machine code.

use iecc_diag::Diagnostics;
use iecc_driver::run::Probes;
use iecc_driver::{EngineKind, FrontOptions, Sources, compile};
use iecc_ir::{Module, Region};
use iecc_source::SourceMap;
use iecc_target::region_bytes;

/// The engines.
pub const ENGINES: [EngineKind; 3] = [
    EngineKind::Interp,
    EngineKind::InterpSoftware,
    EngineKind::Jit,
];

/// A scan: its time, and the bits of each input.
#[derive(Debug, Clone)]
pub struct Scan {
    /// The time.
    pub now_ns: u64,
    /// One value per place that is set.
    pub inputs: Vec<u64>,
}

/// Compiles a program that is right.
///
/// # Panics
/// If it is not.
pub fn module(text: &str) -> Module {
    let (mut map, mut found) = (SourceMap::new(), Diagnostics::new());
    let file = map.add("test.st".to_owned(), text);
    let sources = Sources::text(&mut map, vec![file]);
    let module = compile(&map, &sources, &FrontOptions::default(), &mut found);
    let messages: Vec<_> = found.iter().take(5).collect();
    module.unwrap_or_else(|| panic!("{messages:?}"))
}

/// Runs a program on every engine, and shows what the places in `seen` hold after each scan: the bits
/// of a scalar, length and characters of a string.
///
/// # Panics
/// If it does not compile, a place does not exist, or a scan ends with a fault.
pub fn run(
    text: &str,
    set: &[&str],
    seen: &[&str],
    scans: &[Scan],
    mut check: impl FnMut(&str, usize, &[Vec<u64>]),
) {
    let owned = |names: &[&str]| -> Vec<String> { names.iter().map(|&n| n.to_owned()).collect() };
    let mut module = module(text);
    let probes = Probes::open(&mut module, &owned(set), &owned(seen)).expect("places that exist");
    for engine in ENGINES {
        let mut running = engine.start(&module, 1_000_000).expect("an engine for it");
        let mut inputs = region_bytes(&module, Region::Input);
        let mut outputs = region_bytes(&module, Region::Output);
        for (index, scan) in scans.iter().enumerate() {
            probes.start_scan(&mut inputs);
            for (probe, bits) in probes.set.iter().zip(&scan.inputs) {
                probe.set(&mut inputs, &[*bits]);
            }
            let result = running.step(scan.now_ns, &inputs, &mut outputs);
            assert_eq!(result, Ok(()), "{} scan {index}", engine.name());
            let values = probes.seen.iter().map(|probe| probe.get(&inputs, &outputs));
            check(engine.name(), index, &values.collect::<Vec<_>>());
        }
    }
}
