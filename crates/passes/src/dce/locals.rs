//! Locals that nothing reads are dropped, with the stores, copies and clears that only write to them.

use cranelift_entity::{EntitySet, PrimaryMap, SecondaryMap, packed_option::PackedOption};
use iecc_ir::{Function, InstData, Local, LocalData, Place, Root};

/// Drops the locals of a function that nothing reads. Says whether there were any.
pub(super) fn remove_unread(func: &mut Function) -> bool {
    if func.locals.is_empty() {
        return false;
    }
    let read = read_locals(func);
    if func.locals.keys().all(|local| read.contains(local)) {
        return false;
    }
    let is_unread = |place: &Place| match place.root {
        Root::Local(local) => !read.contains(local),
        Root::State | Root::Input | Root::Output | Root::Ref(_) | Root::Deref { .. } => false,
    };
    for block in func.layout.clone() {
        let mut insts = std::mem::take(&mut func.block_mut(block).insts);
        insts.retain(|&inst| match func.inst(inst) {
            InstData::Store { place, .. }
            | InstData::Copy { to: place, .. }
            | InstData::Clear { place } => !is_unread(place),
            _ => true,
        });
        func.block_mut(block).insts = insts;
    }
    renumber(func, &read);
    true
}

/// Locals that are loaded, copied from, passed on, or keep a time; also through other locals that
/// are read.
fn read_locals(func: &Function) -> EntitySet<Local> {
    let mut read = EntitySet::new();
    let mut copies: SecondaryMap<Local, Vec<Local>> = SecondaryMap::new();
    let mut pending = Vec::new();
    let local_of = |place: &Place| match place.root {
        Root::Local(local) => Some(local),
        Root::State | Root::Input | Root::Output | Root::Ref(_) | Root::Deref { .. } => None,
    };
    let blocks = func.layout.iter().map(|&block| func.block(block));
    for &inst in blocks.flat_map(|block| &block.insts) {
        match func.inst(inst) {
            InstData::Store { .. } | InstData::Clear { .. } => {}
            InstData::Copy { to, from } => match (local_of(to), local_of(from)) {
                (Some(to), Some(from)) => copies[to].push(from),
                (None, from) => pending.extend(from),
                (Some(_), None) => {}
            },
            data => pending.extend(data.places().into_iter().filter_map(local_of)),
        }
    }
    while let Some(local) = pending.pop() {
        if read.insert(local) {
            pending.extend(&copies[local]);
        }
    }
    read
}

fn renumber(func: &mut Function, kept: &EntitySet<Local>) {
    let mut new: SecondaryMap<Local, PackedOption<Local>> = SecondaryMap::new();
    let mut locals: PrimaryMap<Local, LocalData> = PrimaryMap::new();
    for (local, data) in std::mem::take(&mut func.locals) {
        if kept.contains(local) {
            new[local] = locals.push(data).into();
        }
    }
    func.locals = locals;
    for block in func.layout.clone() {
        for inst in func.block(block).insts.clone() {
            for place in func.inst_mut(inst).places_mut() {
                if let Root::Local(local) = place.root {
                    place.root =
                        Root::Local(new[local].expect("places are in locals that are kept"));
                }
            }
        }
    }
}
