//! What inputs hold until someone sets them: the initial values of the variables they go to.
//!
//! A program copies its inputs to variables before all else. So an input that begins as its
//! variable does changes nothing.

use iecc_ir::{Inst, InstData, Layout, MemType, Module, Place, Region, Root};
use iecc_target::region_bytes;

/// The inputs that a scan first copies to the state, and where to. To be asked before any pass.
pub(super) fn mirrored(module: &Module) -> Vec<(Place, Place)> {
    let func = &module.funcs[module.scan];
    let insts = &func.block(func.entry()).insts;
    let calls = |inst: &&Inst| !matches!(func.inst(**inst), InstData::Call { .. });
    let copies = insts.iter().take_while(calls);
    let pairs = copies.filter_map(|inst| {
        if let InstData::Copy { to, from } = func.inst(*inst) {
            return Some((from.clone(), to.clone()));
        }
        let InstData::Store { place, value } = func.inst(*inst) else {
            return None;
        };
        let Some(InstData::Load { place: from }) = func.def_inst(*value) else {
            return None;
        };
        Some((from.clone(), place.clone()))
    });
    pairs
        .filter(|(from, to)| from.root == Root::Input && to.root == Root::State)
        .collect()
}

/// The input region before anything is set.
pub fn initial_inputs(module: &Module) -> Vec<u8> {
    let mut bytes = region_bytes(module, Region::Input);
    let layout = Layout::new(&module.types);
    let at = |region: Region, place: &Place| {
        let start = MemType::Struct(module.region(region));
        layout.resolve(&module.types, start, &place.path)
    };
    for (input, state) in mirrored(module) {
        let (to, ty, to_bit) = at(Region::Input, &input);
        let (from, _, from_bit) = at(Region::State, &state);
        if to_bit.is_some() || from_bit.is_some() {
            continue;
        }
        let size = layout.size(&module.types, ty) as usize;
        let (to, from) = (to as usize, from as usize);
        let image = &module.image.bytes()[from..from + size];
        bytes[to..to + size].copy_from_slice(image);
    }
    bytes
}
