//! Runs scans and compares what comes out with what the file expects.

use super::directives::{Column, ExpectedFault, RunTest};
use crate::differential::{Agreement, Subject, interpreter};
use crate::leaves::{Leaf, Spot, leaves, parse_value, value_text};
use iecc_interp::run_prescan;
use iecc_ir::{Module, Region, verify};
use iecc_jit::Jit;
use iecc_passes::{HARDWARE, SOFTWARE, Settings, run_pipeline};
use iecc_target::{Fault, region_bytes};

/// Runs the module as it stands and after the pipelines.
pub(super) fn check(module: &Module, test: &RunTest) -> Result<(), String> {
    let module = &prepared(module, test)?;
    check_once(module, test, Agreement::All)?;
    // What a module costs in fuel is no part of its meaning.
    let pipelines = if test.fuel.is_some() {
        [].as_slice()
    } else {
        &[("software", SOFTWARE), ("hardware", HARDWARE)]
    };
    for (name, passes) in pipelines {
        let mut after = module.clone();
        run_pipeline(&mut after, passes, &Settings::default(), &mut |_, _| {})
            .map_err(|error| error.to_string())?;
        check_once(&after, test, Agreement::after(passes))
            .map_err(|error| format!("after the passes for {name}: {error}"))?;
    }
    Ok(())
}

/// The module with its image as prescan leaves it, if the test wants that.
fn prepared(module: &Module, test: &RunTest) -> Result<Module, String> {
    let verified = verify(module).map_err(|errors| errors[0].to_string())?;
    let mut module = module.clone();
    if test.prescan {
        module.image = run_prescan(verified).map_err(|fault| format!("prescan: {fault}"))?;
    }
    Ok(module)
}

/// Runs the module as it stands on the interpreter and as machine code.
pub(super) fn check_once(
    module: &Module,
    test: &RunTest,
    agreement: Agreement,
) -> Result<(), String> {
    let mut engine = interpreter(module);
    // Fuel is the interpreter's own; machine code has another measure.
    match test.fuel {
        Some(fuel) => run_on(&mut engine.with_fuel(fuel), module, test, agreement),
        None => {
            run_on(&mut engine, module, test, agreement)?;
            let verified = verify(module).map_err(|errors| errors[0].to_string())?;
            let mut jit = Jit::new(verified).map_err(|errors| errors[0].message.clone())?;
            run_on(&mut jit, module, test, agreement)
                .map_err(|error| format!("as machine code: {error}"))
        }
    }
}

fn run_on(
    engine: &mut dyn Subject,
    module: &Module,
    test: &RunTest,
    agreement: Agreement,
) -> Result<(), String> {
    let columns = Columns::new(module, test, agreement)?;
    let mut regions = Regions {
        inputs: region_bytes(module, Region::Input),
        outputs: region_bytes(module, Region::Output),
    };
    for (scan, &now_ns) in test.times_ns.iter().enumerate() {
        columns
            .scan(scan, now_ns, engine, &mut regions)
            .map_err(|error| format!("scan {scan}: {error}"))?;
    }
    Ok(())
}

struct Regions {
    inputs: Vec<u8>,
    outputs: Vec<u8>,
}

/// A column found in the module, its values as bits.
struct Track {
    label: String,
    spot: Spot,
    values: Vec<u64>,
}

struct Columns {
    inputs: Vec<Track>,
    outputs: Vec<Track>,
    states: Vec<Track>,
    faults: Vec<Option<ExpectedFault>>,
}

impl Columns {
    fn new(module: &Module, test: &RunTest, agreement: Agreement) -> Result<Self, String> {
        let scans = test.times_ns.len();
        let tracks = |region, columns: &[Column]| -> Result<Vec<Track>, String> {
            let leaves = leaves(module, region);
            let tracks = columns
                .iter()
                .map(|column| track(region, &leaves, column, scans));
            tracks.collect()
        };
        let states = match agreement {
            Agreement::All => tracks(Region::State, &test.states)?,
            Agreement::Outputs => Vec::new(),
        };
        let faults = test.faults.clone().unwrap_or_else(|| vec![None; scans]);
        count("fault", faults.len(), scans)?;
        Ok(Self {
            inputs: tracks(Region::Input, &test.inputs)?,
            outputs: tracks(Region::Output, &test.outputs)?,
            states,
            faults,
        })
    }

    fn scan(
        &self,
        scan: usize,
        now_ns: u64,
        engine: &mut dyn Subject,
        regions: &mut Regions,
    ) -> Result<(), String> {
        for track in &self.inputs {
            track.spot.set(&mut regions.inputs, track.values[scan]);
        }
        let result = engine.step(now_ns, &regions.inputs, &mut regions.outputs);
        check_fault(self.faults[scan], result)?;
        for track in &self.outputs {
            track.check(scan, &regions.outputs)?;
        }
        for track in &self.states {
            track.check(scan, engine.state_bytes())?;
        }
        Ok(())
    }
}

impl Track {
    fn check(&self, scan: usize, bytes: &[u8]) -> Result<(), String> {
        let (found, expected) = (self.spot.get(bytes), self.values[scan]);
        if found == expected {
            return Ok(());
        }
        let text = |bits| value_text(self.spot.ty(), bits);
        let (label, found, expected) = (&self.label, text(found), text(expected));
        Err(format!("{label} is {found}, expected {expected}"))
    }
}

fn track(region: Region, leaves: &[Leaf], column: &Column, scans: usize) -> Result<Track, String> {
    let name = &column.name;
    let spot = Spot::find(leaves, name).ok_or_else(|| format!("there is no {region:?} {name}"))?;
    count(name, column.values.len(), scans)?;
    let value = |text: &String| {
        parse_value(spot.ty(), text).ok_or_else(|| format!("{name}: {text} is no {}", spot.ty()))
    };
    let values = column.values.iter().map(value).collect::<Result<_, _>>()?;
    let word = match region {
        Region::State => "state",
        Region::Input => "in",
        Region::Output => "out",
    };
    let label = format!("{word} {name}");
    Ok(Track {
        label,
        spot,
        values,
    })
}

fn count(what: &str, values: usize, scans: usize) -> Result<(), String> {
    match values == scans {
        true => Ok(()),
        false => Err(format!("{what}: {values} values for {scans} scans")),
    }
}

fn check_fault(expected: Option<ExpectedFault>, found: Result<(), Fault>) -> Result<(), String> {
    match (expected, found) {
        (None, Ok(())) => Ok(()),
        (None, Err(fault)) => Err(format!("fault {}, expected none", fault.code)),
        (Some(expected), Ok(())) => Err(format!("no fault, expected {}", expected.code)),
        (Some(expected), Err(fault)) => {
            let origin = fault.origin.map(iecc_ir::Origin::as_u32);
            let right_origin = expected.origin.is_none() || expected.origin == origin;
            match fault.code == expected.code && right_origin {
                true => Ok(()),
                false => Err(format!(
                    "fault {} @{origin:?}, expected {expected:?}",
                    fault.code
                )),
            }
        }
    }
}
