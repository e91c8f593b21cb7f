//! Tags that the program reads and that always hold one value: hardware has no register for them, so
//! the report tells their values.

use crate::pipeline::Pipeline;
use iecc_ir::{InstData, Module, Place, Root};
use iecc_passes::{Settings, ranges};
use iecc_verilog::{Clock, max_step, place_text};
use std::collections::BTreeSet;

/// Each such tag with its value. The module is as before the passes.
///
/// Asked for where the scan is one block for the first time: later passes use the constants up.
pub(crate) fn constants(
    module: &Module,
    clock: Clock,
    settings: &Settings,
) -> Vec<(String, String)> {
    let mut module = module.clone();
    let passes = Pipeline::Hardware.passes();
    let end = passes.iter().position(|pass| *pass == "range_fold");
    Pipeline::Hardware.run_part(&mut module, end.unwrap_or(passes.len()), settings);
    let known = ranges(&module, &|unit_ns| max_step(clock, unit_ns));
    let read = places_read(&module);
    let values = known.state.iter().filter(|(place, _)| read.contains(place));
    let constants = values.filter_map(|(place, range)| Some((place, range.as_constant()?)));
    constants
        .map(|(place, value)| (place_text(&module, place), value.to_string()))
        .collect()
}

/// The state that the scan function loads.
fn places_read(module: &Module) -> BTreeSet<&Place> {
    let func = &module.funcs[module.scan];
    let blocks = func.layout.iter();
    let insts = blocks.flat_map(|&block| &func.block(block).insts);
    let loaded = insts.filter_map(|&inst| match func.inst(inst) {
        InstData::Load { place } => Some(place),
        InstData::Const { .. }
        | InstData::Unary { .. }
        | InstData::Binary { .. }
        | InstData::Compare { .. }
        | InstData::Convert { .. }
        | InstData::Select { .. }
        | InstData::Store { .. }
        | InstData::Call { .. }
        | InstData::Now
        | InstData::Step { .. }
        | InstData::Elapsed { .. } => None,
    });
    loaded.filter(|place| place.root == Root::State).collect()
}
