//! Runs two engines side by side and reports the first byte in which they differ.

use crate::leaves::{leaves, value_text};
use crate::stimulus::ScanInput;
use iecc_interp::Interpreter;
use iecc_ir::{Module, Region, print_module};
use iecc_jit::Jit;
use iecc_passes::CHANGE_STATE;
use iecc_target::{Engine, Fault, region_bytes};
use std::fmt;

/// An engine whose state can be looked at.
pub trait Subject: Engine {
    /// The bytes of the state region.
    fn state_bytes(&self) -> &[u8];
}

impl Subject for Interpreter {
    fn state_bytes(&self) -> &[u8] {
        self.state()
    }
}

impl Subject for Jit {
    fn state_bytes(&self) -> &[u8] {
        self.state()
    }
}

/// What must agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Agreement {
    /// Outputs, faults and every byte of the state.
    All,
    /// Outputs and faults; the states are kept in different ways.
    Outputs,
}

impl Agreement {
    /// What a module and what these passes made of it have in common.
    pub fn after(passes: &[&str]) -> Self {
        if passes.iter().any(|name| CHANGE_STATE.contains(name)) {
            Self::Outputs
        } else {
            Self::All
        }
    }
}

/// The first difference.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// Number of the scan, from 0.
    pub scan: usize,
    /// Its time.
    pub now_ns: u64,
    /// What differs, and how.
    pub what: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "scan {} at {} ns: {}", self.scan, self.now_ns, self.what)
    }
}

/// Runs both engines from their present states over the stimulus. `module` names the fields of the
/// reference in messages.
///
/// # Errors
/// The first difference.
pub fn compare_engines(
    module: &Module,
    reference: &mut dyn Subject,
    other: &mut dyn Subject,
    agreement: Agreement,
    stimulus: &[ScanInput],
) -> Result<(), Difference> {
    let mut expected = region_bytes(module, Region::Output);
    let mut found = expected.clone();
    for (scan, ScanInput { now_ns, inputs }) in stimulus.iter().enumerate() {
        let faults = (
            reference.step(*now_ns, inputs, &mut expected),
            other.step(*now_ns, inputs, &mut found),
        );
        let states = (reference.state_bytes(), other.state_bytes());
        let what = fault_difference(faults.0, faults.1)
            .or_else(|| byte_difference(module, Region::Output, &expected, &found))
            .or_else(|| match agreement {
                Agreement::All => byte_difference(module, Region::State, states.0, states.1),
                Agreement::Outputs => None,
            });
        if let Some(what) = what {
            let now_ns = *now_ns;
            return Err(Difference { scan, now_ns, what });
        }
    }
    Ok(())
}

/// Origins are compared where both engines know one: inlining gives code an origin that had none.
fn fault_difference(expected: Result<(), Fault>, found: Result<(), Fault>) -> Option<String> {
    let same = match (expected, found) {
        (Ok(()), Ok(())) => true,
        (Err(a), Err(b)) => {
            let origins = a.origin.zip(b.origin);
            a.code == b.code && origins.is_none_or(|(a, b)| a == b)
        }
        (Ok(()), Err(_)) | (Err(_), Ok(())) => false,
    };
    (!same).then(|| format!("expected {}, found {}", outcome(expected), outcome(found)))
}

fn outcome(result: Result<(), Fault>) -> String {
    match result {
        Ok(()) => "no fault".to_owned(),
        Err(Fault { code, origin: None }) => format!("fault {code}"),
        Err(Fault {
            code,
            origin: Some(origin),
        }) => format!("fault {code} @{}", origin.as_u32()),
    }
}

fn byte_difference(
    module: &Module,
    region: Region,
    expected: &[u8],
    found: &[u8],
) -> Option<String> {
    if expected.len() != found.len() {
        let (expected, found) = (expected.len(), found.len());
        return Some(format!(
            "{region:?} has {expected} bytes in one and {found} in the other"
        ));
    }
    let offset = expected.iter().zip(found).position(|(a, b)| a != b)? as u64;
    let leaves = leaves(module, region);
    let leaf = leaves
        .iter()
        .find(|leaf| (leaf.offset..leaf.offset + u64::from(leaf.ty.bytes())).contains(&offset));
    let Some(leaf) = leaf else {
        return Some(format!(
            "{region:?} differs in the padding at byte {offset}"
        ));
    };
    let text = |bytes: &[u8]| {
        // Read as it stands: an i1 that is neither 0 nor 1 must not look like one.
        let start = leaf.offset as usize;
        let raw = &bytes[start..start + leaf.ty.bytes() as usize];
        format!("{} {raw:02x?}", value_text(leaf.ty, leaf.get(bytes).bits))
    };
    let (name, ty) = (&leaf.name, leaf.ty);
    let (expected, found) = (text(expected), text(found));
    Some(format!(
        "{region:?} {name}: {ty} expected {expected}, found {found}"
    ))
}

/// Runs a module and what was made of it on the interpreter and compares them.
///
/// # Errors
/// The first difference, with both modules as text.
pub fn compare_modules(
    before: &Module,
    after: &Module,
    agreement: Agreement,
    stimulus: &[ScanInput],
) -> Result<(), String> {
    let mut engines = [before, after].map(interpreter);
    let [reference, other] = &mut engines;
    compare_engines(before, reference, other, agreement, stimulus).map_err(|difference| {
        let (before, after) = (print_module(before), print_module(after));
        format!("{difference}\n--- before\n{before}\n--- after\n{after}")
    })
}

/// An interpreter for a module that should be well-formed.
///
/// # Panics
/// With the broken rules and the text, if it is not.
pub fn interpreter(module: &Module) -> Interpreter {
    match iecc_ir::verify(module) {
        Ok(verified) => Interpreter::new(verified),
        Err(errors) => {
            let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
            panic!("{}\n{}", errors.join("\n"), print_module(module))
        }
    }
}
