//! Copies and clears become loads and stores of scalars, so that scalars can be promoted.
//!
//! All loads of a copy come before its stores. Where an index is outside, each load gives 0 and each
//! store does nothing, as the copy would. Which are taken is a question of size: those of few
//! scalars, and those that concern a local that could be promoted.

use crate::edit::BlockEditor;
use cranelift_entity::EntitySet;
use iecc_ir::{
    FuncId, Function, Inst, InstData, Layout, Local, MemType, Module, Place, PlaceType, Root, Type,
    TypeTable, Value,
};
use std::collections::BTreeMap;

/// How many scalars a copy or clear may have to be taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Any.
    of_any: u64,
    /// One that concerns a local which is only accessed by static places.
    of_local: u64,
    /// All that are taken in one function together.
    in_all: u64,
}

/// For targets that need every scalar in a value.
pub(super) const ALL: Limits = Limits {
    of_any: 1 << 12,
    of_local: 1 << 12,
    in_all: 1 << 18,
};

/// For machines that move memory well.
pub(super) const FEW: Limits = Limits {
    of_any: 4,
    of_local: 48,
    in_all: 1 << 14,
};

/// Takes copies and clears apart in every function.
pub(super) fn expand(module: &mut Module, limits: Limits) {
    let layout = Layout::new(&module.types);
    let has_addresses = module.has_addresses();
    let ids: Vec<FuncId> = module.funcs.keys().collect();
    for id in ids {
        let chosen = choose(module, &layout, has_addresses, &module.funcs[id], limits);
        if chosen.is_empty() {
            continue;
        }
        let func = &mut module.funcs[id];
        for block in func.layout.clone() {
            let (mut editor, insts) = BlockEditor::new(func, block);
            for inst in insts {
                match chosen.get(&inst) {
                    Some(&ty) => take_apart(&module.types, &layout, &mut editor, inst, ty),
                    None => editor.keep(inst),
                }
            }
            editor.finish();
        }
    }
}

/// The copies and clears to take apart, and what each moves.
fn choose(
    module: &Module,
    layout: &Layout,
    has_addresses: bool,
    func: &Function,
    limits: Limits,
) -> BTreeMap<Inst, MemType> {
    let mut left = limits.in_all;
    let mut fixed = None;
    let mut chosen = BTreeMap::new();
    let blocks = func.layout.iter().map(|&block| func.block(block));
    for &inst in blocks.flat_map(|block| &block.insts) {
        let data = func.inst(inst);
        let (InstData::Copy { to, .. } | InstData::Clear { place: to }) = data else {
            continue;
        };
        let fixed = fixed.get_or_insert_with(|| fixed_locals(func));
        let can_be_promoted = |place: &&Place| match place.root {
            Root::Local(local) => !fixed.contains(local),
            Root::State | Root::Input | Root::Output | Root::Ref(_) | Root::Deref { .. } => false,
        };
        let limit = if data.places().iter().any(can_be_promoted) {
            limits.of_local
        } else {
            limits.of_any
        };
        let ty = type_of(module, func, to);
        if has_addresses && !is_dense(module, layout, ty) {
            continue;
        }
        if let Some(leaves) = leaf_count(&module.types, ty, limit.min(left)) {
            left -= leaves;
            chosen.insert(inst, ty);
        }
    }
    chosen
}

/// Locals that stay in memory anyway: passed on, or accessed by index values.
fn fixed_locals(func: &Function) -> EntitySet<Local> {
    let mut fixed = EntitySet::new();
    let blocks = func.layout.iter().map(|&block| func.block(block));
    for &inst in blocks.flat_map(|block| &block.insts) {
        let data = func.inst(inst);
        let is_call = matches!(data, InstData::Call { .. });
        for place in data.places() {
            if let Root::Local(local) = place.root
                && (is_call || !place.is_static())
            {
                fixed.insert(local);
            }
        }
    }
    fixed
}

fn type_of(module: &Module, func: &Function, place: &Place) -> MemType {
    let start = module.root_type(func, place.root);
    let found = start.and_then(|start| Place::walk(&module.types, start, &place.path));
    let Some(PlaceType::Mem(ty)) = found else {
        panic!("verified copies and clears move memory")
    };
    ty
}

/// Whether scalars hold every bit of a type: otherwise, where addresses are followed, bytes that no
/// scalar shows may hold something, which a copy moves.
fn is_dense(module: &Module, layout: &Layout, ty: MemType) -> bool {
    match ty {
        MemType::Scalar(scalar) => scalar != Type::I1,
        MemType::Array(id) => is_dense(module, layout, module.types.array_type(id).element),
        MemType::Struct(id) => {
            let fields = &module.types.structs[id].fields;
            let sizes = fields.iter().map(|f| layout.size(&module.types, f.ty));
            sizes.sum::<u64>() == layout.size(&module.types, ty)
                && fields.iter().all(|f| is_dense(module, layout, f.ty))
        }
    }
}

/// How many scalars a type has, if at most `limit`.
fn leaf_count(types: &TypeTable, ty: MemType, limit: u64) -> Option<u64> {
    let count = match ty {
        MemType::Scalar(_) => 1,
        MemType::Struct(id) => {
            let mut count = 0;
            for field in &types.structs[id].fields {
                count += leaf_count(types, field.ty, limit - count)?;
            }
            count
        }
        MemType::Array(id) => {
            let array = types.array_type(id);
            leaf_count(types, array.element, limit)? * u64::from(array.len)
        }
    };
    (count <= limit).then_some(count)
}

fn take_apart(
    types: &TypeTable,
    layout: &Layout,
    editor: &mut BlockEditor<'_>,
    inst: Inst,
    ty: MemType,
) {
    editor.set_origin(editor.func.origin(inst));
    let mut leaves = Vec::new();
    layout.for_each_leaf(types, &Place::root(Root::State), ty, &mut |leaf, _, ty| {
        leaves.push((leaf.path.clone(), ty));
    });
    let data = editor.func.inst(inst).clone();
    let (to, from) = match data {
        InstData::Copy { to, from } => (to, Some(from)),
        InstData::Clear { place } => (place, None),
        other => panic!("only copies and clears are taken apart, not {other:?}"),
    };
    let values = leaves.iter().map(|(path, ty)| match &from {
        Some(from) => {
            let place = from.clone().join(path);
            editor.value(InstData::Load { place }, *ty)
        }
        None => editor.constant(*ty, 0),
    });
    let values: Vec<Value> = values.collect();
    for ((path, _), value) in leaves.iter().zip(values) {
        let place = to.clone().join(path);
        editor.effect(InstData::Store { place, value });
    }
}
