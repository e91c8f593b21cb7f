//! Byte layout of memory types: little-endian, natural alignment, declared order.
//!
//! One layout for the interpreter and every compiled engine, so that states can be compared byte
//! by byte. `i1` is one byte holding 0 or 1; padding is 0.

use crate::{
    Function, Index, InstData, Local, MemType, Module, Place, PlaceType, Projection, StructId,
    Type, TypeTable,
};
use cranelift_entity::PrimaryMap;

/// Largest region a program may have.
pub const MAX_REGION_BYTES: u64 = 1 << 30;

/// What the locals of all functions of a program may take together. As no function calls itself,
/// each is active at most once, so no engine needs more.
pub const MAX_LOCAL_BYTES: u64 = 1 << 27;

#[derive(Debug, Clone)]
struct StructLayout {
    size: u64,
    align: u32,
    offsets: Vec<u64>,
}

/// Sizes and offsets of all types of a table.
#[derive(Debug, Clone)]
pub struct Layout {
    structs: PrimaryMap<StructId, StructLayout>,
}

impl Layout {
    /// Computes the layout; types that would be larger than `u64` saturate and the verifier
    /// refuses them.
    pub fn new(types: &TypeTable) -> Self {
        let mut layout = Self {
            structs: PrimaryMap::new(),
        };
        for def in types.structs.values() {
            let fields: Vec<MemType> = def.fields.iter().map(|field| field.ty).collect();
            let laid_out = layout.struct_layout(types, &fields);
            layout.structs.push(laid_out);
        }
        layout
    }

    fn struct_layout(&self, types: &TypeTable, fields: &[MemType]) -> StructLayout {
        let (mut size, mut align, mut offsets) = (0u64, 1, Vec::with_capacity(fields.len()));
        for &field in fields {
            let field_align = self.align(types, field);
            let offset = round_up(size, field_align);
            offsets.push(offset);
            size = offset.saturating_add(self.size(types, field));
            align = align.max(field_align);
        }
        StructLayout {
            size: round_up(size, align),
            align,
            offsets,
        }
    }

    /// Bytes a type takes, padding at its end included.
    pub fn size(&self, types: &TypeTable, ty: MemType) -> u64 {
        match ty {
            MemType::Scalar(scalar) => u64::from(scalar.bytes()),
            MemType::Struct(id) => self.structs[id].size,
            MemType::Array(id) => {
                let array = types.array_type(id);
                self.size(types, array.element)
                    .saturating_mul(u64::from(array.len))
            }
        }
    }

    /// Alignment of a type.
    pub fn align(&self, types: &TypeTable, ty: MemType) -> u32 {
        match ty {
            MemType::Scalar(scalar) => scalar.bytes(),
            MemType::Struct(id) => self.structs[id].align,
            MemType::Array(id) => self.align(types, types.array_type(id).element),
        }
    }

    /// Byte offset of a field.
    pub fn field_offset(&self, id: StructId, field: u32) -> u64 {
        self.structs[id].offsets[field as usize]
    }

    /// Byte offset of every local in the memory of an activation, aligned for 8-byte values, and the
    /// size of that memory.
    pub fn locals(&self, types: &TypeTable, func: &Function) -> (PrimaryMap<Local, u64>, u64) {
        let (mut offsets, mut size) = (PrimaryMap::with_capacity(func.locals.len()), 0u64);
        for data in func.locals.values() {
            offsets.push(size);
            let bytes = round_up(self.size(types, data.ty), 8);
            size = size.saturating_add(bytes);
        }
        (offsets, size)
    }

    /// Bytes that a `copy` or `clear` of a verified module writes; 0 for other instructions, whose
    /// work does not depend on types.
    pub fn moved_bytes(&self, module: &Module, func: &Function, data: &InstData) -> u64 {
        let (InstData::Copy { to: place, .. } | InstData::Clear { place }) = data else {
            return 0;
        };
        let start = module.root_type(func, place.root);
        let found = start.and_then(|start| Place::walk(&module.types, start, &place.path));
        match found {
            Some(PlaceType::Mem(ty)) => self.size(&module.types, ty),
            Some(PlaceType::Bit) | None => panic!("verified places are memory"),
        }
    }

    /// Byte offset and type of a static path from `start`, and the bit number if it ends in one.
    /// The path must fit the type.
    pub fn resolve(
        &self,
        types: &TypeTable,
        start: MemType,
        path: &[Projection],
    ) -> (u64, MemType, Option<u32>) {
        let (mut offset, mut at) = (0, start);
        for step in path {
            match (at, step) {
                (MemType::Struct(id), Projection::Field(field)) => {
                    offset += self.field_offset(id, *field);
                    at = types.structs[id].fields[*field as usize].ty;
                }
                (MemType::Array(id), Projection::Index(Index::Const(index))) => {
                    at = types.array_type(id).element;
                    offset += u64::from(*index) * self.size(types, at);
                }
                (MemType::Scalar(_), Projection::Bit(Index::Const(bit))) => {
                    return (offset, at, Some(*bit));
                }
                (MemType::Struct(_) | MemType::Array(_) | MemType::Scalar(_), _) => {
                    panic!("path is static and fits the type")
                }
            }
        }
        (offset, at, None)
    }

    /// Calls `f` with the path, byte offset and type of every scalar inside `start`, in memory
    /// order. Bounded by the size of the type.
    pub fn for_each_leaf(
        &self,
        types: &TypeTable,
        start: &Place,
        ty: MemType,
        f: &mut dyn FnMut(&Place, u64, Type),
    ) {
        self.leaves(types, &mut start.clone(), 0, ty, f);
    }

    fn leaves(
        &self,
        types: &TypeTable,
        place: &mut Place,
        offset: u64,
        ty: MemType,
        f: &mut dyn FnMut(&Place, u64, Type),
    ) {
        match ty {
            MemType::Scalar(scalar) => f(place, offset, scalar),
            MemType::Struct(id) => {
                for (index, field) in types.structs[id].fields.iter().enumerate() {
                    place.path.push(Projection::Field(index as u32));
                    self.leaves(
                        types,
                        place,
                        offset + self.field_offset(id, index as u32),
                        field.ty,
                        f,
                    );
                    place.path.pop();
                }
            }
            MemType::Array(id) => {
                let array = types.array_type(id);
                let size = self.size(types, array.element);
                for index in 0..array.len {
                    place.path.push(Projection::Index(Index::Const(index)));
                    self.leaves(
                        types,
                        place,
                        offset + u64::from(index) * size,
                        array.element,
                        f,
                    );
                    place.path.pop();
                }
            }
        }
    }
}

fn round_up(size: u64, align: u32) -> u64 {
    size.checked_next_multiple_of(u64::from(align))
        .unwrap_or(u64::MAX)
}
