//! The values inside of what a path names, each with a path of its own.

use super::{NameError, field_at, low_of, member_at_end, type_of};
use iecc_ir::{Index, InstData, Layout, MemType, Module, Place, PlaceType, Projection, StructId};
use std::collections::BTreeSet;

/// The values at a place, each with its path below `name`. Times that `elapsed` keeps are left out:
/// they belong to the machinery, not to the program.
pub(crate) fn leaves(
    module: &Module,
    name: &str,
    place: &Place,
    most: u64,
) -> Result<Vec<(String, Place)>, NameError> {
    let ty = match type_of(module, place) {
        Some(PlaceType::Mem(ty)) => ty,
        Some(PlaceType::Bit) | None => return Ok(vec![(name.to_owned(), place.clone())]),
    };
    let count = leaf_count(module, ty);
    if count > most {
        return Err(NameError::misfit(format!(
            "`{name}` has {count} values, at most {most} can be shown at once"
        )));
    }
    let (kept, base) = (kept_times(module), place.path.len());
    let mut found = Vec::new();
    Layout::new(&module.types).for_each_leaf(&module.types, place, ty, &mut |leaf, _, _| {
        let hidden =
            leaf.path.len() > base && field_at(module, leaf).is_some_and(|m| kept.contains(&m));
        if !hidden {
            let name = format!("{name}{}", spell(module, leaf, base));
            found.push((name, leaf.clone()));
        }
    });
    Ok(found)
}

fn leaf_count(module: &Module, ty: MemType) -> u64 {
    match ty {
        MemType::Scalar(_) => 1,
        MemType::Struct(id) => {
            let fields = &module.types.structs[id].fields;
            fields.iter().fold(0, |sum, field| {
                sum.saturating_add(leaf_count(module, field.ty))
            })
        }
        MemType::Array(id) => {
            let array = module.types.array_type(id);
            leaf_count(module, array.element).saturating_mul(u64::from(array.len))
        }
    }
}

/// The way to a value, from a step on.
fn spell(module: &Module, leaf: &Place, from: usize) -> String {
    let mut text = String::new();
    let mut at = Place {
        root: leaf.root,
        path: leaf.path[..from].to_vec(),
    };
    for step in &leaf.path[from..] {
        if let Projection::Index(Index::Const(index)) = step {
            let index = low_of(module, &at) + i64::from(*index);
            text.push_str(&format!("[{index}]"));
        }
        at.path.push(*step);
        if let Projection::Field(_) = step {
            let (id, field) = field_at(module, &at).expect("leaves are static places");
            text.push('.');
            text.push_str(&module.types.structs[id].fields[field as usize].name);
        }
    }
    text
}

/// The members that `elapsed` uses, by struct and position.
fn kept_times(module: &Module) -> BTreeSet<(StructId, u32)> {
    let mut kept = BTreeSet::new();
    for func in module.funcs.values() {
        for &block in &func.layout {
            for &inst in &func.block(block).insts {
                if let InstData::Elapsed { place, .. } = func.inst(inst) {
                    let start = module.root_type(func, place.root);
                    kept.extend(start.and_then(|start| member_at_end(module, start, &place.path)));
                }
            }
        }
    }
    kept
}
