//! A loop of one block that goes round a known number of times has its body several times, and one
//! comparison for all of them: the number is a multiple, so that the loop ends with a whole group.

use iecc_ir::analysis::{LocalRanges, Loop, Loops};
use iecc_ir::{Function, Inst, InstData, Terminator, Value};
use std::collections::HashMap;

/// How many bodies a loop gets, best first, and what they may have together.
const BODIES: [u64; 2] = [2, 3];
const MAX_INSTRUCTIONS: usize = 64;

/// Unrolls every loop that is short and counted. Says whether there was one.
pub(super) fn unroll(func: &mut Function, loops: &Loops, ranges: &LocalRanges) -> bool {
    let mut changed = false;
    for each in &loops.natural {
        if let Some(bodies) = bodies(func, each, ranges) {
            write(func, each, bodies);
            changed = true;
        }
    }
    changed
}

/// How many bodies fit into the rounds and into the code; `None` if not more than one.
fn bodies(func: &Function, each: &Loop, ranges: &LocalRanges) -> Option<u64> {
    let is_one_block = each.blocks.len() == 1 && each.latches.len() == 1;
    let trips = ranges.trips(each.header).filter(|trips| trips.is_exact)?;
    let insts = &func.block(each.header).insts;
    let has_call = insts
        .iter()
        .any(|&inst| matches!(func.inst(inst), InstData::Call { .. }));
    if !is_one_block || has_call || !matches!(func.terminator(each.header), Terminator::Brif { .. })
    {
        return None;
    }
    let (rounds, size) = (trips.most + 1, insts.len());
    let fits = |&n: &u64| rounds % n == 0 && rounds > n && n as usize * size <= MAX_INSTRUCTIONS;
    BODIES.into_iter().find(fits)
}

/// The block itself becomes the last body; copies of it come first.
fn write(func: &mut Function, each: &Loop, bodies: u64) {
    let block = each.header;
    let params = func.block(block).params.clone();
    let mut targets = func.terminator(block).targets().into_iter();
    let back = targets.find(|target| target.block == block);
    let next = back.expect("the loop is this block").args.clone();
    drop(targets);
    let body = func.block(block).insts.clone();
    // What the parameters are in the body that comes next.
    let mut now: HashMap<Value, Value> = HashMap::new();
    let mut copies = Vec::new();
    for _ in 1..bodies {
        let map = copy(func, &body, now.clone(), &mut copies);
        let read = |value: &Value| map.get(value).copied().unwrap_or(*value);
        now = params.iter().copied().zip(next.iter().map(read)).collect();
    }
    func.map_uses(|value| now.get(&value).copied().unwrap_or(value));
    func.block_mut(block).insts.splice(0..0, copies);
}

/// Copies a body, reading values as the map says; gives the map with the results of the copy.
fn copy(
    func: &mut Function,
    body: &[Inst],
    mut map: HashMap<Value, Value>,
    copies: &mut Vec<Inst>,
) -> HashMap<Value, Value> {
    for &inst in body {
        let mut data = func.inst(inst).clone();
        data.map_values(|value| map.get(&value).copied().unwrap_or(value));
        let results = func.results_of(inst).to_vec();
        let types: Vec<_> = results.iter().map(|&v| func.value_type(v)).collect();
        let origin = func.origin(inst);
        let copy = func.make_inst(data, &types, origin);
        map.extend(results.iter().copied().zip(func.results_of(copy).to_vec()));
        copies.push(copy);
    }
    map
}
