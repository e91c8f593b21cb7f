//! Tags that the program reads and that always hold one value: hardware has no register for them, so
//! the report tells their values.

use crate::pipeline::Pipeline;
use iecc_ir::{InstData, Module, Place, Root};
use iecc_passes::{Settings, ranges};
use iecc_verilog::{Clock, max_step, place_text};
use std::collections::BTreeSet;

/// Each such tag with its value. The module is as before the passes.
///
/// Ranges are asked for where the scan is one block for the first time: later passes use the
/// constants up. What measures time is left out, since `step_time` gives it another meaning.
pub(crate) fn constants(
    module: &Module,
    clock: Clock,
    settings: &Settings,
) -> Vec<(String, String)> {
    let mut module = module.clone();
    let (timed, ranged) = (position("step_time"), position("range_fold"));
    Pipeline::Hardware.run_part(&mut module, 0..timed, settings);
    let clocks = places(&module, elapsed);
    Pipeline::Hardware.run_part(&mut module, timed..ranged, settings);
    let known = ranges(&module, &|unit_ns| max_step(clock, unit_ns));
    let read = places(&module, loaded);
    let values = known.state.iter();
    let values = values.filter(|(place, _)| read.contains(place) && !clocks.contains(place));
    values
        .filter_map(|(place, range)| Some((place, range.as_constant()?)))
        .map(|(place, value)| (place_text(&module, place), value.to_string()))
        .collect()
}

/// Where a pass stands first.
fn position(pass: &str) -> usize {
    let passes = Pipeline::Hardware.passes();
    let found = passes.iter().position(|name| *name == pass);
    found.expect("the pipeline for hardware has this pass")
}

/// The state that some instructions of the scan function name.
fn places(module: &Module, of: fn(&InstData) -> Option<&Place>) -> BTreeSet<Place> {
    let func = &module.funcs[module.scan];
    let blocks = func.layout.iter();
    let insts = blocks.flat_map(|&block| &func.block(block).insts);
    let named = insts.filter_map(|&inst| of(func.inst(inst)));
    named
        .filter(|place| place.root == Root::State)
        .cloned()
        .collect()
}

fn loaded(data: &InstData) -> Option<&Place> {
    data.place()
        .filter(|_| matches!(data, InstData::Load { .. }))
}

fn elapsed(data: &InstData) -> Option<&Place> {
    data.place()
        .filter(|_| matches!(data, InstData::Elapsed { .. }))
}
