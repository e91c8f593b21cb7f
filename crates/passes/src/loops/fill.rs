//! A loop that only makes every element of an array 0 is a `clear`.
//!
//! It is one block that stores 0 at `array[i]`, where i counts by 1 from 0 to the last element, and nobody
//! reads what it computed on the way.

use crate::fold::Regions;
use iecc_ir::analysis::{LocalRanges, Loop, Loops};
use iecc_ir::{
    Block, Function, Index, InstData, MemType, Place, PlaceType, Projection, Root, Target,
    Terminator, TypeTable, Value,
};
use std::collections::HashSet;

/// Replaces every such loop. Says whether there was one.
pub(super) fn fill(
    types: &TypeTable,
    regions: Regions,
    func: &mut Function,
    loops: &Loops,
    ranges: &LocalRanges,
) -> bool {
    let mut changed = false;
    for each in &loops.natural {
        if let Some((array, exit)) = filled(types, regions, func, each, ranges) {
            write(func, each.header, array, exit);
            changed = true;
        }
    }
    changed
}

fn write(func: &mut Function, block: Block, array: Place, exit: Target) {
    let origin = func.block(block).terminator_origin;
    let clear = func.make_inst(InstData::Clear { place: array }, &[], origin);
    let mut insts = std::mem::take(&mut func.block_mut(block).insts);
    // The constants stay: what is passed on may be one.
    insts.retain(|&inst| matches!(func.inst(inst), InstData::Const { .. }));
    insts.push(clear);
    func.block_mut(block).insts = insts;
    func.set_terminator(block, Terminator::Jump(exit), origin);
}

/// The array that a loop clears, and where it goes then.
fn filled(
    types: &TypeTable,
    regions: Regions,
    func: &Function,
    each: &Loop,
    ranges: &LocalRanges,
) -> Option<(Place, Target)> {
    let block = each.header;
    let trips = ranges.trips(block).filter(|trips| trips.is_exact)?;
    let (array, index) = only_store(func, block)?;
    let counted = ranges
        .counted(block)
        .filter(|counted| counted.param == index)?;
    let start = regions.root_type(func, array.root);
    let Some(PlaceType::Mem(MemType::Array(id))) = Place::walk(types, start, &array.path) else {
        return None;
    };
    let is_whole = u64::from(types.array_type(id).len) == trips.most + 1;
    let by_one = counted.grows && func.constant(counted.step) == Some(1);
    let from_zero = ranges.at(func, index, block).lo == 0;
    let exit = exit(func, each).filter(|_| is_whole && by_one && from_zero)?;
    is_closed(func, block, &exit).then_some((array, exit))
}

/// The array and the index of a block that stores 0 and otherwise only computes.
fn only_store(func: &Function, block: Block) -> Option<(Place, Value)> {
    let insts = func.block(block).insts.iter().map(|&inst| func.inst(inst));
    let mut effects = insts.filter(|data| !data.is_pure());
    let (InstData::Store { place, value }, None) = (effects.next()?, effects.next()) else {
        return None;
    };
    let (Projection::Index(Index::Value(index)), rest) = place.path.split_last()? else {
        return None;
    };
    let array = Place {
        root: place.root,
        path: rest.to_vec(),
    };
    let is_known = match place.root {
        Root::State | Root::Ref(_) | Root::Local(_) => array.is_static(),
        Root::Input | Root::Output | Root::Deref { .. } => false,
    };
    (func.constant(*value) == Some(0) && is_known).then_some((array, *index))
}

/// Where a loop of one block goes in the end.
fn exit(func: &Function, each: &Loop) -> Option<Target> {
    let targets = func.terminator(each.header).targets();
    let mut outside = targets
        .into_iter()
        .filter(|target| target.block != each.header);
    let is_one_block = each.blocks.len() == 1;
    let (target, None) = (outside.next()?, outside.next()) else {
        return None;
    };
    is_one_block.then(|| target.clone())
}

/// Whether nobody else reads what a block computes, but for constants.
fn is_closed(func: &Function, block: Block, exit: &Target) -> bool {
    let data = func.block(block);
    let results = data.insts.iter().flat_map(|&inst| func.results_of(inst));
    let own = data.params.iter().chain(results).copied();
    let own: HashSet<Value> = own
        .filter(|&value| func.constant(value).is_none())
        .collect();
    let mut others = func.layout.iter().filter(|&&other| other != block);
    let reads = |&other: &Block| {
        let insts = func.block(other).insts.iter();
        let by_inst = insts.flat_map(|&inst| func.inst(inst).values());
        let mut read = by_inst.chain(func.terminator(other).values());
        read.any(|value| own.contains(&value))
    };
    !others.any(reads) && !exit.args.iter().any(|arg| own.contains(arg))
}
