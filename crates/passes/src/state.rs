//! State promotion: registers that are none disappear.
//!
//! * A leaf that can only hold one number is that number.
//! * A leaf whose value never reaches an output, or another leaf that does, is not kept.
//! * Leaves that start equal and are always given equal values are one.
//!
//! Works on scans in normal form. The fields stay in the state struct, so places keep their
//! meaning; only loads and stores go. Stores of unused leaves are gone, so what such a leaf holds
//! is no longer defined: for targets that publish outputs only.

use crate::Settings;
use crate::edit::replace_values;
use crate::range::ranges;
use crate::scan_form::{Leaf, ScanForm};
use iecc_ir::{Function, InstData, Module, Root, Value, Values};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Runs the pass.
pub(crate) fn run(module: &mut Module, settings: &Settings) {
    drop_constant_leaves(module, settings);
    merge_equal_leaves(module);
    drop_dead_leaves(module);
}

fn drop_constant_leaves(module: &mut Module, settings: &Settings) {
    let Some(form) = ScanForm::of(module) else {
        return;
    };
    let ranges = ranges(module, &|unit_ns| settings.max_step(unit_ns));
    let constant = |leaf: &&Leaf| {
        let range = leaf.ty.is_int().then(|| ranges.leaf(&leaf.place, leaf.ty));
        leaf.next.is_none() || range.is_some_and(|range| range.as_constant().is_some())
    };
    let constants: Vec<Leaf> = form.leaves.iter().filter(constant).cloned().collect();
    let scan = module.scan;
    let func = &mut module.funcs[scan];
    remove_stores(func, &form, &constants.iter().collect::<Vec<_>>());
    for leaf in &constants {
        if let Some(load) = leaf.load {
            set_definition(
                func,
                load,
                InstData::Const {
                    ty: leaf.ty,
                    bits: leaf.init,
                },
            );
        }
    }
}

fn set_definition(func: &mut Function, value: Value, data: InstData) {
    let iecc_ir::ValueDef::Result(inst, _) = func.value_def(value) else {
        panic!("loads define values")
    };
    *func.inst_mut(inst) = data;
}

fn remove_stores(func: &mut Function, form: &ScanForm, leaves: &[&Leaf]) {
    let places: BTreeSet<_> = leaves.iter().map(|leaf| &leaf.place).collect();
    let insts = std::mem::take(&mut func.block_mut(form.block).insts);
    let kept = insts.into_iter().filter(
        |&inst| !matches!(func.inst(inst), InstData::Store { place, .. } if places.contains(place)),
    );
    let kept = kept.collect();
    func.block_mut(form.block).insts = kept;
}

/// Leaves with the same start and the same next value; the first load stands for all. Merging may
/// make further next values equal; the pipeline runs common subexpressions and this pass again.
fn merge_equal_leaves(module: &mut Module) {
    let Some(form) = ScanForm::of(module) else {
        return;
    };
    let scan = module.scan;
    let func = &mut module.funcs[scan];
    crate::edit::hoist_loads(func, form.block);
    let mut first: BTreeMap<(iecc_ir::Type, u64, Value), &Leaf> = BTreeMap::new();
    let mut replacements = HashMap::new();
    let mut merged = Vec::new();
    for leaf in form.leaves.iter().filter(|leaf| leaf.load.is_some()) {
        let Some(next) = leaf.next else { continue };
        match first
            .get(&(leaf.ty, leaf.init, next))
            .and_then(|kept| kept.load)
        {
            Some(kept) => {
                replacements.extend(leaf.load.map(|load| (load, kept)));
                merged.push(leaf);
            }
            None => {
                first.insert((leaf.ty, leaf.init, next), leaf);
            }
        }
    }
    remove_stores(func, &form, &merged);
    replace_values(func, &replacements);
}

/// Keeps what outputs need, and what that needs, and so on.
fn drop_dead_leaves(module: &mut Module) {
    let Some(form) = ScanForm::of(module) else {
        return;
    };
    let scan = module.scan;
    let func = &mut module.funcs[scan];
    let by_load: HashMap<Value, usize> = form
        .leaves
        .iter()
        .enumerate()
        .filter_map(|(index, leaf)| Some((leaf.load?, index)))
        .collect();
    let mut queue: Vec<Value> = func
        .block(form.block)
        .insts
        .iter()
        .filter_map(|&inst| match func.inst(inst) {
            InstData::Store { place, value } if place.root == Root::Output => Some(*value),
            _ => None,
        })
        .collect();
    let mut seen: BTreeSet<Value> = queue.iter().copied().collect();
    let mut live = BTreeSet::new();
    while let Some(value) = queue.pop() {
        let mut needed = func.def_inst(value).map_or(Values::new(), InstData::values);
        if let Some(&leaf) = by_load.get(&value) {
            live.insert(leaf);
            needed.extend(form.leaves[leaf].next);
        }
        queue.extend(needed.into_iter().filter(|v| seen.insert(*v)));
    }
    let dead: Vec<&Leaf> = form
        .leaves
        .iter()
        .enumerate()
        .filter(|(index, _)| !live.contains(index))
        .map(|(_, leaf)| leaf)
        .collect();
    remove_stores(func, &form, &dead);
}
