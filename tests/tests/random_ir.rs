//! Random modules: what the IR, its text form and the interpreter promise about all of them.

use iecc_interp::run_prescan;
use iecc_ir::{FaultCode, InstData, Module, Terminator, parse_module, print_module, verify};
use iecc_target::Engine;
use iecc_tests::differential::{Agreement, compare_engines, compare_modules, interpreter};
use iecc_tests::random_ir::{Options, random_module};
use iecc_tests::rng::{Rng, seeds};
use iecc_tests::stimulus::random_stimulus;
use std::collections::{BTreeMap, BTreeSet};

const SEEDS: u64 = 300;
const SCANS: usize = 20;

/// Printing is a fixed point of parsing, and what was parsed does the same, bit for bit.
#[test]
fn the_text_form_holds_everything() {
    for seed in seeds(SEEDS) {
        let module = random_module(seed, &Options::all());
        let text = print_module(&module);
        let parsed =
            parse_module(&text).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        assert_eq!(print_module(&parsed), text, "seed {seed}");
        let stimulus = random_stimulus(&module, &mut Rng::new(seed), SCANS);
        compare_modules(&module, &parsed, Agreement::All, &stimulus)
            .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
    }
}

/// Fuel plays no part, and prescan gives an image a scan can start from.
#[test]
fn random_modules_end_without_running_out_of_fuel() {
    for seed in seeds(SEEDS) {
        let mut module = random_module(
            seed,
            &Options {
                faults: false,
                ..Options::all()
            },
        );
        let verified =
            verify(&module).unwrap_or_else(|errors| panic!("seed {seed}: {}", errors[0]));
        module.image = run_prescan(verified).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
        let mut engine = interpreter(&module);
        let mut outputs = iecc_target::region_bytes(&module, iecc_ir::Region::Output);
        for scan in random_stimulus(&module, &mut Rng::new(seed), SCANS) {
            let result = engine.step(scan.now_ns, &scan.inputs, &mut outputs);
            assert_eq!(result, Ok(()), "seed {seed}");
        }
    }
}

/// Undoing a scan is compared as well: many scans end with a fault, most of them after they stored
/// something, and the state stays as it was.
#[test]
fn many_scans_fault_and_change_nothing() {
    let (mut scans, mut faults) = (0, 0);
    for seed in seeds(SEEDS) {
        let module = random_module(seed, &Options::all());
        let mut engine = interpreter(&module);
        let mut outputs = iecc_target::region_bytes(&module, iecc_ir::Region::Output);
        for scan in random_stimulus(&module, &mut Rng::new(seed), SCANS) {
            let before = (engine.state().to_vec(), outputs.clone());
            let result = engine.step(scan.now_ns, &scan.inputs, &mut outputs);
            scans += 1;
            if result.is_err() {
                faults += 1;
                assert!(
                    before == (engine.state().to_vec(), outputs.clone()),
                    "seed {seed}"
                );
            }
        }
    }
    assert!(
        (scans / 10..scans / 2).contains(&faults),
        "{faults} of {scans} scans fault"
    );
}

/// The generator reaches every operation, terminator and instruction; else the tests above say less
/// than they seem to.
#[test]
fn random_modules_hold_everything_there_is() {
    let mut found = BTreeSet::new();
    for seed in seeds(SEEDS) {
        count(&random_module(seed, &Options::all()), &mut found);
    }
    let families = [
        iecc_ir::UnaryOp::ALL
            .iter()
            .map(|op| op.name())
            .collect::<Vec<_>>(),
        iecc_ir::BinaryOp::ALL.iter().map(|op| op.name()).collect(),
        iecc_ir::CompareOp::ALL.iter().map(|op| op.name()).collect(),
        iecc_ir::ConvertOp::ALL.iter().map(|op| op.name()).collect(),
        FaultCode::ALL.iter().map(|code| code.name()).collect(),
        "const select load store copy clear address now elapsed step call jump brif switch return"
            .split(' ')
            .collect(),
    ];
    let missing: Vec<&str> = families
        .concat()
        .into_iter()
        .filter(|name| !found.contains(name))
        .collect();
    assert!(missing.is_empty(), "no seed has {missing:?}");
}

fn count(module: &Module, found: &mut BTreeSet<&'static str>) {
    for func in module.funcs.values() {
        for &block in &func.layout {
            found.extend(
                func.block(block)
                    .insts
                    .iter()
                    .map(|&inst| inst_name(func.inst(inst))),
            );
            found.insert(match func.terminator(block) {
                Terminator::Jump(_) => "jump",
                Terminator::Brif { .. } => "brif",
                Terminator::Switch { .. } => "switch",
                Terminator::Return(_) => "return",
                Terminator::Fault(code) => code.name(),
            });
        }
    }
}

fn inst_name(inst: &InstData) -> &'static str {
    match inst {
        InstData::Const { .. } => "const",
        InstData::Unary { op, .. } => op.name(),
        InstData::Binary { op, .. } => op.name(),
        InstData::Compare { op, .. } => op.name(),
        InstData::Convert { op, .. } => op.name(),
        InstData::Select { .. } => "select",
        InstData::Load { .. } => "load",
        InstData::Store { .. } => "store",
        InstData::Copy { .. } => "copy",
        InstData::Clear { .. } => "clear",
        InstData::Address { .. } => "address",
        InstData::Now => "now",
        InstData::Elapsed { .. } => "elapsed",
        InstData::Step { .. } => "step",
        InstData::Call { .. } => "call",
    }
}

/// Each pass alone, and the pipelines, step by step.
#[test]
fn passes_change_nothing_that_can_be_seen() {
    let alone = iecc_passes::PASSES.iter().map(|pass| vec![pass.name]);
    let pipelines = [
        iecc_passes::SOFTWARE.to_vec(),
        iecc_passes::HARDWARE.to_vec(),
    ];
    let pipelines: Vec<Vec<&str>> = alone.chain(pipelines).collect();
    let mut failures = BTreeMap::new();
    for seed in seeds(SEEDS) {
        let options = if seed % 2 == 0 {
            Options::all()
        } else {
            Options::hardware()
        };
        let module = random_module(seed, &options);
        for names in &pipelines {
            if let Err(error) = run_passes(&module, names, seed) {
                failures
                    .entry(names.join(" "))
                    .or_insert(format!("seed {seed}: {error}"));
            }
        }
    }
    let failures: Vec<String> = failures.into_values().collect();
    assert!(failures.is_empty(), "{}", failures.join("\n=====\n"));
}

/// Compares the module after each pass with the module as it was at first.
fn run_passes(module: &Module, names: &[&str], seed: u64) -> Result<(), String> {
    let stimulus = random_stimulus(module, &mut Rng::new(seed), SCANS);
    let mut after = module.clone();
    for (index, name) in names.iter().enumerate() {
        let before = print_module(&after);
        iecc_passes::run(name, &mut after, &iecc_passes::Settings::default())
            .map_err(|error| error.to_string())?;
        if let Err(errors) = verify(&after) {
            return Err(format!(
                "{name}: {}\n{before}\n{}",
                errors[0],
                print_module(&after)
            ));
        }
        compare_modules(
            module,
            &after,
            Agreement::after(&names[..=index]),
            &stimulus,
        )
        .map_err(|error| format!("{name}: {error}"))?;
    }
    Ok(())
}

/// The comparison itself finds a difference in one bit of one output or of the state.
#[test]
fn a_difference_is_found_and_named() {
    let text = |bit: u32| {
        format!(
            "module m\nstate {{ w: i16 }}\ninput {{ x: i1 }}\noutput {{ \"a b\": i32 }}\nscan @s\n\n\
             fn @s[]() -> () {{\nb0:\n  v0: i1 = load input.x\n  store state.w.{bit}, v0\n\
             \x20 v1: i16 = load state.w\n  v2: i32 = zext v1\n  store output.\"a b\", v2\n  return\n}}\n"
        )
    };
    let [one, other] = [text(3), text(4)].map(|text| parse_module(&text).unwrap());
    let stimulus = random_stimulus(&one, &mut Rng::new(3), 8);
    let first_on = stimulus.iter().position(|scan| scan.inputs == [1]).unwrap();
    let [mut a, mut b] = [&one, &other].map(interpreter);
    let difference = compare_engines(&one, &mut a, &mut b, Agreement::All, &stimulus).unwrap_err();
    assert_eq!(difference.scan, first_on);
    assert_eq!(
        difference.what,
        "Output \"a b\": i32 expected 8 [08, 00, 00, 00], found 16 [10, 00, 00, 00]"
    );
}
