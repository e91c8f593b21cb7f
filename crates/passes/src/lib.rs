//! Makes verified modules simpler without changing what they do.
//!
//! A pass is a row of [`PASSES`]; a pipeline is a list of names. Every pass takes a module that
//! keeps the verifier's rules and leaves one, is deterministic, needs no recursion on what users
//! write, and takes time near-linear in the size of the module. Passes know no source language and
//! no target: what a target needs is which passes its pipeline lists.
//!
//! To add a pass: its file, which begins with what it guarantees; its row; its place in the
//! pipelines; tests.

#![allow(
    clippy::wildcard_enum_match_arm,
    reason = "rewriting picks a few shapes; every other one stays as it is"
)]

mod bounds;
mod cse;
mod dce;
mod early_compare;
mod edit;
mod fold;
mod functions;
mod if_convert;
mod inline;
mod late_clear;
mod loops;
mod promote;
mod range;
mod range_fold;
mod references;
mod rewrite;
mod saturate;
mod scan_form;
mod settings;
mod split;
mod state;
mod step_time;

pub use range::{ranges, ranges_given};
pub use settings::Settings;

use iecc_ir::Module;
use std::fmt;

/// A row of the table of passes.
#[derive(Debug, Clone, Copy)]
pub struct Pass {
    /// Name on the command line and in pipelines.
    pub name: &'static str,
    /// What it does, in one line.
    pub what: &'static str,
    /// Why it stands where it stands in the pipelines.
    pub why_here: &'static str,
    run: fn(&mut Module, &Settings),
}

/// Every pass.
pub const PASSES: &[Pass] = &[
    Pass {
        name: "inline",
        what: "puts the body of every function in place of its calls",
        why_here: "first: the other passes look at one function at a time",
        run: |module, _| inline::inline(module),
    },
    Pass {
        name: "inline_small",
        what: "puts small functions, and those called once, in place of their calls",
        why_here: "first, instead of inline where code size counts",
        run: |module, _| inline::inline_small(module),
    },
    Pass {
        name: "inline_straight",
        what: "puts functions that are one block in place of their calls",
        why_here: "after if_convert_small, which makes one block of functions, and before the last folding",
        run: |module, _| inline::inline_straight(module),
    },
    Pass {
        name: "fold",
        what: "computes constants, simplifies algebra, branches and jumps",
        why_here: "after every pass that uncovers constants: inlining, promotion, if-conversion",
        run: |module, _| fold::fold(module),
    },
    Pass {
        name: "cse",
        what: "computes equal things once, and loads once what is loaded twice",
        why_here: "after folding, which writes equal things equally",
        run: |module, _| cse::cse(module),
    },
    Pass {
        name: "cse_near",
        what: "the same, but loads again what was loaded long before",
        why_here: "instead of cse where values cost registers",
        run: |module, _| cse::cse_near(module),
    },
    Pass {
        name: "bounds",
        what: "decides comparisons by how loops count",
        why_here: "after cse, which knows where a branch has decided the same before; folding drops the branches",
        run: |module, _| bounds::bounds(module),
    },
    Pass {
        name: "loops",
        what: "turns WHILE loops around, and writes the body of short counted loops several times",
        why_here: "after bounds and folding, which leave one block of a body",
        run: |module, _| loops::loops(module),
    },
    Pass {
        name: "dce",
        what: "drops what nobody can see: instructions, parameters, blocks, functions",
        why_here: "last, and before passes whose work grows with what is there",
        run: |module, _| dce::dce(module),
    },
    Pass {
        name: "split",
        what: "makes bits of words whose bits are separate things",
        why_here: "after inlining and folding, when all accesses are seen and indices are constant",
        run: |module, _| split::split(module),
    },
    Pass {
        name: "step_time",
        what: "counts the steps of the scan instead of looking at the clock",
        why_here: "before promotion, which then turns its counters into values",
        run: |module, _| step_time::run(module),
    },
    Pass {
        name: "promote",
        what: "keeps scalars of memory in values from the entry to the return",
        why_here: "after inlining, when a scan sees all uses of its state",
        run: |module, _| promote::promote(module),
    },
    Pass {
        name: "promote_few",
        what: "the same in functions that touch few scalars",
        why_here: "instead of promote where values cost registers",
        run: |module, _| promote::promote_few(module),
    },
    Pass {
        name: "if_convert",
        what: "makes one block of a function without loops and faults, branches become choices",
        why_here: "after promotion, which leaves few stores that depend on a branch",
        run: |module, _| if_convert::if_convert(module),
    },
    Pass {
        name: "if_convert_small",
        what: "makes choices of branches around a handful of operations",
        why_here: "after promotion and folding, which make arms small",
        run: |module, _| if_convert::if_convert_small(module),
    },
    Pass {
        name: "range_fold",
        what: "decides and weakens comparisons by what values can be",
        why_here: "when the scan is one block, so that ranges are known",
        run: range_fold::run,
    },
    Pass {
        name: "state",
        what: "drops state that is constant, unused, or kept twice",
        why_here: "after range_fold and cse, which show what is constant and equal",
        run: state::run,
    },
    Pass {
        name: "saturate",
        what: "lets counters stop where nobody sees them go on",
        why_here: "after state, which leaves the comparisons that matter",
        run: saturate::run,
    },
    Pass {
        name: "late_clear",
        what: "clears counters a scan later, by the flag that keeps their rung",
        why_here: "after early_compare, whose bits are cleared with their counters",
        run: late_clear::run,
    },
    Pass {
        name: "early_compare",
        what: "keeps `counter == constant` as a bit of its own, ready before it is needed",
        why_here: "last of all: its bits are more state",
        run: early_compare::run,
    },
];

/// For engines that run instructions one after the other. Keeps the layout of all regions.
pub const SOFTWARE: &[&str] = &[
    "inline_small",
    "fold",
    "promote_few",
    "fold",
    "if_convert_small",
    "inline_straight",
    "fold",
    "cse_near",
    "bounds",
    "fold",
    "loops",
    "dce",
];

/// For hardware: ends in a scan of one block without calls, if nothing in the program loops or
/// faults. The layout of the state may change.
pub const HARDWARE: &[&str] = &[
    "inline",
    "fold",
    "split",
    "step_time",
    "promote",
    "fold",
    "cse",
    "if_convert",
    "fold",
    "cse",
    "fold",
    "dce",
    "range_fold",
    "state",
    "fold",
    "cse",
    "saturate",
    "range_fold",
    "state",
    "fold",
    "cse",
    "range_fold",
    "dce",
];

/// For hardware, behind [`HARDWARE`]: makes the scan faster by keeping more state. What the state can
/// hold is better found out before, because these bits hide why it holds.
pub const HARDWARE_SPEED: &[&str] = &[
    "early_compare",
    "fold",
    "cse",
    "late_clear",
    "fold",
    "cse",
    "state",
    "fold",
    "dce",
];

/// The passes after which the state at the end of a scan is no longer what the program says, in
/// layout or in value: for targets that publish outputs only. All others keep it bit for bit.
pub const CHANGE_STATE: &[&str] = &[
    "split",
    "step_time",
    "state",
    "saturate",
    "late_clear",
    "early_compare",
];

/// Passes that rely on every access being through a place of the right type. A module that takes or
/// follows addresses is left as it is by them: an address is a byte offset, which means something else
/// in another layout, and a store at an address may change any part of any field. Hardware refuses
/// such modules anyway.
const NEED_PLACES: &[&str] = &[
    "split",
    "step_time",
    "if_convert",
    "range_fold",
    "state",
    "saturate",
    "late_clear",
    "early_compare",
];

impl Pass {
    fn apply(&self, module: &mut Module, settings: &Settings) {
        if !(NEED_PLACES.contains(&self.name) && module.has_addresses()) {
            (self.run)(module, settings);
        }
    }
}

/// There is no pass of this name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownPass(pub String);

impl fmt::Display for UnknownPass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = PASSES.iter().map(|pass| pass.name).collect();
        write!(
            f,
            "there is no pass {:?}; there are {}",
            self.0,
            names.join(", ")
        )
    }
}

impl std::error::Error for UnknownPass {}

/// The pass of this name.
///
/// # Errors
/// There is none.
pub fn find(name: &str) -> Result<&'static Pass, UnknownPass> {
    PASSES
        .iter()
        .find(|pass| pass.name == name)
        .ok_or_else(|| UnknownPass(name.to_owned()))
}

/// Runs one pass over a module that keeps the verifier's rules.
///
/// # Errors
/// There is no such pass; the module is as before.
pub fn run(name: &str, module: &mut Module, settings: &Settings) -> Result<(), UnknownPass> {
    find(name)?.apply(module, settings);
    Ok(())
}

/// Runs passes in order and shows the module to `observer` after each, with the pass's name. Debug
/// builds verify there too.
///
/// # Errors
/// One of the names is no pass; the module is as before.
pub fn run_pipeline(
    module: &mut Module,
    names: &[&str],
    settings: &Settings,
    observer: &mut dyn FnMut(&str, &Module),
) -> Result<(), UnknownPass> {
    let passes = names
        .iter()
        .map(|name| find(name))
        .collect::<Result<Vec<_>, _>>()?;
    for pass in passes {
        pass.apply(module, settings);
        debug_assert_eq!(iecc_ir::verify(module).err(), None, "after {}", pass.name);
        observer(pass.name, module);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_pipelines_list_passes() {
        for (index, pass) in PASSES.iter().enumerate() {
            assert!(
                PASSES[..index].iter().all(|other| other.name != pass.name),
                "{}",
                pass.name
            );
        }
        for name in SOFTWARE
            .iter()
            .chain(HARDWARE)
            .chain(CHANGE_STATE)
            .chain(NEED_PLACES)
        {
            assert!(find(name).is_ok(), "{name}");
        }
        assert_eq!(find("inlin").unwrap_err(), UnknownPass("inlin".to_owned()));
    }
}
