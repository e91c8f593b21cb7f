//! Runs a case on every engine and says what came of it.

use crate::case::Case;
use crate::cell::{Bits, read, same, show};
use crate::engines::Family;
use crate::messages::compare;
use crate::trace::{Row, Trace};
use iecc_diag::{Diagnostic, Diagnostics};
use iecc_driver::run::{Probe, Probes, initial_inputs};
use iecc_driver::{EngineKind, FrontOptions, OnFault, Sources, compile};
use iecc_ir::{FaultCode, Module, Region};
use iecc_source::SourceMap;
use iecc_target::{Fault, region_bytes};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What came of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseResult {
    /// Why the compiler itself is wrong about the case: its messages, or that it failed.
    pub front: Result<(), String>,
    /// What came of it on each engine; empty for cases that expect errors.
    pub engines: Vec<EngineResult>,
}

/// What came of a case on an engine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EngineResult {
    /// Which engine.
    pub engine: EngineKind,
    /// What came of it.
    pub outcome: Outcome,
}

/// What an engine made of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// Every value was as expected, every output as on the reference interpreter.
    Passed,
    /// The engine does not take the program, and said why.
    Refused(String),
    /// The engine cannot show it: hardware runs a scan every period and no other.
    NotApplicable,
    /// What is wrong.
    Failed(String),
}

impl CaseResult {
    /// Everything that is wrong.
    pub fn failures(&self) -> Vec<String> {
        let front = self.front.as_ref().err().cloned();
        let engines = self
            .engines
            .iter()
            .filter_map(|result| match &result.outcome {
                Outcome::Failed(what) => Some(format!("{}: {what}", result.engine.name())),
                Outcome::Passed | Outcome::Refused(_) | Outcome::NotApplicable => None,
            });
        front.into_iter().chain(engines).collect()
    }
}

/// Compiles a case and runs it. Whatever panics on the way is a failure of the case.
pub fn run_case(case: &Case) -> CaseResult {
    let caught = catch_unwind(AssertUnwindSafe(|| compile_and_run(case)));
    caught.unwrap_or_else(|panic| CaseResult {
        front: Err(format!("the compiler panics: {}", words(&*panic))),
        engines: Vec::new(),
    })
}

/// What a panic says.
fn words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("without words")
}

fn compile_and_run(case: &Case) -> CaseResult {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let file = map.add(format!("{}.st", case.name), case.text.as_str());
    let sources = Sources::text(&mut map, vec![file]);
    let module = compile(&map, &sources, &options(case), &mut diagnostics);
    let front = compare(&case.messages, &diagnostics, &map, file);
    match (front, module, &case.trace) {
        (Err(what), _, _) => CaseResult {
            front: Err(what),
            engines: Vec::new(),
        },
        (Ok(()), Some(module), Some(trace)) => run_module(case, module, trace),
        (Ok(()), None, Some(_)) => CaseResult {
            front: Err("there is no program to run".to_owned()),
            engines: Vec::new(),
        },
        (Ok(()), _, None) => CaseResult {
            front: Ok(()),
            engines: Vec::new(),
        },
    }
}

fn options(case: &Case) -> FrontOptions {
    FrontOptions {
        dialect: case.dialect,
        entry: case.entry.clone(),
        on_fault: if case.stops_at_faults {
            OnFault::Trap
        } else {
            OnFault::Continue
        },
        ..FrontOptions::default()
    }
}

/// Runs the module of a case on every engine.
pub fn run_module(case: &Case, mut module: Module, trace: &Trace) -> CaseResult {
    let opened = Probes::open(&mut module, &trace.inputs, &trace.outputs);
    let opened = opened.map_err(|errors| all(&errors));
    let plan = opened.and_then(|probes| Plan::new(case, probes, trace));
    let plan = match plan {
        Ok(plan) => plan,
        Err(what) => {
            return CaseResult {
                front: Err(what),
                engines: Vec::new(),
            };
        }
    };
    let mut reference = None;
    let mut engines = Vec::new();
    for engine in EngineKind::ALL {
        let run = || plan.run(engine, &module, reference.as_deref());
        let outcome = match catch_unwind(AssertUnwindSafe(run)) {
            Ok((outcome, scans)) => {
                reference = reference.or(Some(scans));
                outcome
            }
            Err(panic) => Outcome::Failed(format!("it panics: {}", words(&*panic))),
        };
        engines.push(EngineResult { engine, outcome });
    }
    CaseResult {
        front: Ok(()),
        engines,
    }
}

fn all(errors: &[Diagnostic]) -> String {
    let texts = errors
        .iter()
        .map(|error| format!("{}: {}", error.code, error.message));
    texts.collect::<Vec<_>>().join("; ")
}

/// A case made ready: places found, cells read.
struct Plan<'c> {
    case: &'c Case,
    trace: &'c Trace,
    probes: Probes,
    scans: Vec<Scan>,
}

/// The cells of a row as bits.
struct Scan {
    set: Vec<Option<Bits>>,
    seen: Vec<Option<Bits>>,
}

/// What an engine gave in a scan: outputs as they are afterwards, or its fault.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Given {
    outputs: Vec<u8>,
    fault: Option<FaultCode>,
}

impl<'c> Plan<'c> {
    fn new(case: &'c Case, probes: Probes, trace: &'c Trace) -> Result<Self, String> {
        let scan = |row: &Row| {
            Ok(Scan {
                set: cells(row.line, &row.inputs, &probes.set)?,
                seen: cells(row.line, &row.outputs, &probes.seen)?,
            })
        };
        let scans: Result<Vec<Scan>, String> = trace.rows.iter().map(scan).collect();
        let scans = scans?;
        Ok(Self {
            case,
            trace,
            probes,
            scans,
        })
    }

    /// Runs an engine, and gives what it gave in each scan.
    fn run(
        &self,
        engine: EngineKind,
        module: &Module,
        reference: Option<&[Given]>,
    ) -> (Outcome, Vec<Given>) {
        let period_ns = match (engine, self.trace.period_ns()) {
            (EngineKind::Verilog, None) => return (Outcome::NotApplicable, Vec::new()),
            (_, Some(period_ns)) => period_ns,
            (_, None) => self.trace.longest_gap_ns(),
        };
        let mut running = match engine.start(module, period_ns) {
            Ok(running) => running,
            Err(errors) => return (self.refusal(engine, &errors), Vec::new()),
        };
        let mut inputs = initial_inputs(module);
        let mut outputs = region_bytes(module, Region::Output);
        let mut given = Vec::with_capacity(self.scans.len());
        for (index, row) in self.trace.rows.iter().enumerate() {
            self.set(index, &mut inputs);
            let result = running.step(row.now_ns, &inputs, &mut outputs);
            given.push(Given {
                outputs: outputs.clone(),
                fault: result.err().map(|fault: Fault| fault.code),
            });
            let wrong = self.wrong(index, &inputs, &given[index]);
            let wrong = wrong.or_else(|| {
                let same = reference.is_none_or(|reference| reference[index] == given[index]);
                (!same).then(|| "outputs differ from those of the interpreter".to_owned())
            });
            if let Some(wrong) = wrong {
                let line = row.line;
                let failed = Outcome::Failed(format!("scan {index} (line {line}): {wrong}"));
                return (failed, given);
            }
        }
        (Outcome::Passed, given)
    }

    fn refusal(&self, engine: EngineKind, errors: &[Diagnostic]) -> Outcome {
        if self.case.may_be_refused_by(Family::of(engine)) {
            Outcome::Refused(all(errors))
        } else {
            Outcome::Failed(format!("it refuses the program: {}", all(errors)))
        }
    }

    fn set(&self, scan: usize, inputs: &mut [u8]) {
        self.probes.start_scan(inputs);
        for (probe, bits) in self.probes.set.iter().zip(&self.scans[scan].set) {
            if let Some(bits) = bits {
                probe.set(inputs, bits);
            }
        }
    }

    /// What is wrong after a scan.
    fn wrong(&self, scan: usize, inputs: &[u8], given: &Given) -> Option<String> {
        let expected = self.case.fault.filter(|_| scan + 1 == self.scans.len());
        if given.fault != expected {
            let name = |fault: Option<FaultCode>| fault.map_or("no fault", FaultCode::name);
            let (expected, found) = (name(expected), name(given.fault));
            return Some(format!("expected {expected}, found {found}"));
        }
        let wrong = |(probe, expected): (&Probe, &Option<Bits>)| {
            let expected = expected.as_ref()?;
            let found = probe.get(inputs, &given.outputs);
            let right = same(expected, &found, probe.shape, self.case.ulp);
            let text = |bits: &[u64]| show(bits, probe.shape, probe.view);
            (!right).then(|| {
                let (expected, found) = (text(expected), text(&found));
                format!("`{}` is {found}, not {expected}", probe.path)
            })
        };
        let wrong = self
            .probes
            .seen
            .iter()
            .zip(&self.scans[scan].seen)
            .filter_map(wrong);
        let wrong: Vec<String> = wrong.collect();
        (!wrong.is_empty()).then(|| wrong.join("; "))
    }
}

fn cells(
    line: usize,
    cells: &[Option<String>],
    probes: &[Probe],
) -> Result<Vec<Option<Bits>>, String> {
    let cell = |(cell, probe): (&Option<String>, &Probe)| match cell {
        None => Ok(None),
        Some(text) => read(text, probe.shape)
            .map(Some)
            .map_err(|what| format!("line {line}: `{}`: {what}", probe.path)),
    };
    cells.iter().zip(probes).map(cell).collect()
}
