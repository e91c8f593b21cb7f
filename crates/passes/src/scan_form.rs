//! The normal form of a scan that hardware passes work on.
//!
//! Inlining, promotion and if-conversion bring a loop-free program here: one block; every scalar
//! leaf of the state is loaded at most once, before its store, and stored at most once; all places
//! are static. In this form a leaf is a register: its load is the register's output, the stored
//! value its next value.

use iecc_ir::{Block, InstData, Layout, MemType, Module, Place, Root, Type, Value};
use std::collections::BTreeMap;

/// A scalar of the state that the scan loads or stores.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Leaf {
    pub(crate) place: Place,
    pub(crate) ty: Type,
    /// Initial bits.
    pub(crate) init: u64,
    /// The value at the start of the scan, if it is loaded.
    pub(crate) load: Option<Value>,
    /// The value at the end of the scan, if it is stored; otherwise the leaf keeps its value.
    pub(crate) next: Option<Value>,
}

/// A scan in normal form, seen as registers.
#[derive(Debug, Clone)]
pub(crate) struct ScanForm {
    pub(crate) block: Block,
    /// By place.
    pub(crate) leaves: Vec<Leaf>,
}

impl ScanForm {
    /// The registers of the scan; `None` if it is not in normal form.
    pub(crate) fn of(module: &Module) -> Option<Self> {
        let func = &module.funcs[module.scan];
        let &[block] = func.layout.as_slice() else {
            return None;
        };
        let layout = Layout::new(&module.types);
        let mut leaves = BTreeMap::new();
        for &inst in &func.block(block).insts {
            let (place, load, store) = match func.inst(inst) {
                InstData::Load { place } => (place, Some(func.result(inst)), None),
                InstData::Store { place, value } => (place, None, Some(*value)),
                InstData::Elapsed { .. }
                | InstData::Copy { .. }
                | InstData::Clear { .. }
                | InstData::Call { .. } => return None,
                _ => continue,
            };
            if !place.is_static() || matches!(place.root, Root::Ref(_) | Root::Local(_)) {
                return None;
            }
            if place.root == Root::State {
                let leaf = leaves
                    .entry(place.clone())
                    .or_insert_with(|| new_leaf(module, &layout, place));
                // A load behind the store, or a second access of a kind, is another form.
                if (load.is_some() && leaf.load.is_some()) || leaf.next.is_some() {
                    return None;
                }
                leaf.load = leaf.load.or(load);
                leaf.next = store;
            }
        }
        let leaves: Vec<Leaf> = leaves.into_values().collect();
        let overlap = leaves
            .windows(2)
            .any(|pair| pair[0].place.may_overlap(&pair[1].place));
        (!overlap).then_some(Self { block, leaves })
    }
}

fn new_leaf(module: &Module, layout: &Layout, place: &Place) -> Leaf {
    let value = module
        .image
        .get_place(layout, &module.types, module.state, place);
    Leaf {
        place: place.clone(),
        ty: value.ty,
        init: value.bits,
        load: None,
        next: None,
    }
}

/// Adds a scalar to the end of the state struct and gives its place; the name is made unique.
pub(crate) fn add_state_leaf(module: &mut Module, name: &str, ty: Type, init: u64) -> Place {
    let old_layout = Layout::new(&module.types);
    let old_size = old_layout.size(&module.types, MemType::Struct(module.state)) as usize;
    let fields = &mut module.types.structs[module.state].fields;
    let mut unique = name.to_owned();
    let mut suffix = 2;
    while fields
        .iter()
        .any(|field| field.name.eq_ignore_ascii_case(&unique))
    {
        unique = format!("{name}_{suffix}");
        suffix += 1;
    }
    let index = fields.len() as u32;
    fields.push(iecc_ir::FieldDef::new(unique, MemType::Scalar(ty)));
    // The new field is the last one, so all offsets before it stay.
    let layout = Layout::new(&module.types);
    let size = layout.size(&module.types, MemType::Struct(module.state)) as usize;
    let mut bytes = module.image.bytes()[..old_size].to_vec();
    bytes.resize(size, 0);
    module.image = iecc_ir::Image::from_bytes(bytes);
    let place = Place::root(Root::State).field(index);
    module
        .image
        .set_place(&layout, &module.types, module.state, &place, init);
    place
}

/// Whether the scan calls nothing.
pub(crate) fn is_scan_inlined(module: &Module) -> bool {
    let func = &module.funcs[module.scan];
    let mut insts = func
        .layout
        .iter()
        .flat_map(|&block| &func.block(block).insts);
    !insts.any(|&inst| matches!(func.inst(inst), InstData::Call { .. }))
}
