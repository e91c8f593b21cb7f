//! Runs a random program on the engines for software and compares outputs, faults and the whole state
//! after every scan.

use super::{Options, random_program};
use crate::differential::{Agreement, Difference, Subject, compare_engines, interpreter};
use crate::rng::Rng;
use crate::stimulus::{ScanInput, random_stimulus};
use iecc_diag::{Diagnostics, Severity, render_text};
use iecc_driver::{FrontOptions, OnFault, ParsedLibrary};
use iecc_ir::{Module, Region, verify};
use iecc_jit::Jit;
use iecc_passes::{SOFTWARE, Settings, run_pipeline};
use iecc_target::{Engine, region_bytes};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Scans of a program.
const SCANS: usize = 12;

/// How a run went.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Scans that ended with a fault.
    pub faults: usize,
    /// All scans.
    pub scans: usize,
}

/// Generates the program of a seed and runs it under the policy for faults that the seed gives.
///
/// # Errors
/// What is wrong, with a program that was shrunk.
pub fn check_seed(library: &ParsedLibrary, seed: u64, options: Options) -> Result<Outcome, String> {
    let draft = random_program(seed, options);
    let policy = policy(seed);
    check(library, draft.text(), policy, seed).map_err(|what| {
        let kind = kind_of(&what);
        let fails = |text: &str| {
            let again = check(library, text, policy, seed);
            again.is_err_and(|what| kind_of(&what) == kind)
        };
        let least = draft.shrink(fails);
        let what = check(library, &least, policy, seed).expect_err("it failed while shrinking");
        format!("seed {seed}, {policy:?}: {what}\n{least}")
    })
}

/// Which policy a seed runs under.
pub fn policy(seed: u64) -> OnFault {
    if seed.is_multiple_of(2) {
        OnFault::Trap
    } else {
        OnFault::Continue
    }
}

/// The first word: one kind of failure does not become another while shrinking.
fn kind_of(what: &str) -> &str {
    what.split_whitespace().next().unwrap_or_default()
}

/// Runs a program.
///
/// # Errors
/// What is wrong: it was refused, the compiler panicked, or engines differ.
pub fn check(
    library: &ParsedLibrary,
    text: &str,
    policy: OnFault,
    seed: u64,
) -> Result<Outcome, String> {
    let checked = catch_unwind(AssertUnwindSafe(|| {
        let module = module(library, text, policy)?;
        let outcome = compare(&module, seed)?;
        if policy == OnFault::Trap && outcome.faults == 0 {
            same_without_faults(library, text, &module, seed)?;
        }
        Ok(outcome)
    }));
    checked.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("panicked: {}", text.unwrap_or_default()))
    })
}

fn module(library: &ParsedLibrary, text: &str, policy: OnFault) -> Result<Module, String> {
    let options = FrontOptions {
        on_fault: policy,
        ..FrontOptions::default()
    };
    let mut found = Diagnostics::new();
    library.compile(text, &options, &mut found).ok_or_else(|| {
        let map = library.map(text);
        let mut errors = found.iter().filter(|said| said.severity == Severity::Error);
        let first = errors.next().expect("it was refused for a reason");
        format!("{:?} {}", first.code, render_text(&map, first, false))
    })
}

/// The module as lowered, on the interpreter, against what the passes make of it, on the interpreter and in
/// machine code.
fn compare(module: &Module, seed: u64) -> Result<Outcome, String> {
    let mut optimised = module.clone();
    let settings = Settings::default();
    run_pipeline(&mut optimised, SOFTWARE, &settings, &mut |_, _| {}).expect("the passes exist");
    same(module, &mut interpreter(&optimised), Agreement::All, seed)
        .map_err(|difference| format!("passes change it: {difference}"))?;
    let verified = verify(&optimised).map_err(|errors| format!("unverified {}", errors[0]))?;
    let mut jit = Jit::new(verified).map_err(|errors| format!("untranslated {errors:?}"))?;
    same(module, &mut jit, Agreement::All, seed)
        .map_err(|difference| format!("jit differs: {difference}"))?;
    let mut reference = interpreter(module);
    let mut outputs = region_bytes(module, Region::Output);
    let stimulus = stimulus(module, seed);
    let scans = stimulus.iter();
    let ended = scans.map(|scan| reference.step(scan.now_ns, &scan.inputs, &mut outputs));
    Ok(Outcome {
        faults: ended.filter(Result::is_err).count(),
        scans: SCANS,
    })
}

fn stimulus(module: &Module, seed: u64) -> Vec<ScanInput> {
    random_stimulus(module, &mut Rng::new(seed), SCANS)
}

/// Another engine does what the interpreter does with the module.
fn same(
    module: &Module,
    other: &mut dyn Subject,
    agreement: Agreement,
    seed: u64,
) -> Result<(), Difference> {
    let reference = &mut interpreter(module);
    compare_engines(module, reference, other, agreement, &stimulus(module, seed))
}

/// What runs without a fault gives the same outputs where faults do not stop.
fn same_without_faults(
    library: &ParsedLibrary,
    text: &str,
    trapping: &Module,
    seed: u64,
) -> Result<(), String> {
    let going_on = module(library, text, OnFault::Continue)?;
    same(
        trapping,
        &mut interpreter(&going_on),
        Agreement::Outputs,
        seed,
    )
    .map_err(|difference| format!("policies differ: {difference}"))
}
