//! The image of the state: initial values of tags as bytes.

use crate::types::{self, TypeMap};
use iecc_ir::{Image, Layout, MemType, Scalar, StructId, TypeTable};
use iecc_sema::hir::code::{Init, InitId};
use iecc_sema::hir::{self, Inits};

/// The state before the first scan: the whole values of tags, then the leaves that differ.
pub(crate) fn image(program: &hir::Program, types: &TypeMap<'_>, state: StructId) -> Image {
    let table = types.table();
    let layout = Layout::new(table);
    let mut image = Image::zero(&layout, table, state);
    let mut writer = Writer {
        inits: &program.inits,
        table,
        layout: &layout,
        bytes: image.bytes_mut(),
    };
    for (index, tag) in program.tags.iter().enumerate() {
        if let Some(init) = tag.init {
            let field = index as u32;
            let ty = table.structs[state].fields[index].ty;
            writer.write(layout.field_offset(state, field), ty, init);
        }
    }
    for (index, tag) in program.tags.iter().enumerate() {
        for (path, bits) in &tag.initial {
            let leaf = hir::Place {
                tag: hir::TagId::from_index(index),
                path: path.clone(),
            };
            image.set_place(&layout, table, state, &types::place(&leaf), *bits);
        }
    }
    image
}

struct Writer<'a> {
    inits: &'a Inits,
    table: &'a TypeTable,
    layout: &'a Layout,
    bytes: &'a mut [u8],
}

impl Writer<'_> {
    /// Writes into bytes that are 0. Recursion is bounded by the depth of types.
    fn write(&mut self, offset: u64, ty: MemType, init: InitId) {
        match (self.inits.get(init), ty) {
            (Init::Zero, _) => {}
            (Init::Bits(bits), MemType::Scalar(ty)) => {
                Scalar::new(ty, *bits).write(self.bytes, offset as usize);
            }
            (Init::Struct(members), MemType::Struct(id)) => {
                for &(member, value) in members {
                    let field = self.table.structs[id].fields[member as usize].ty;
                    let offset = offset + self.layout.field_offset(id, member);
                    self.write(offset, field, value);
                }
            }
            (Init::Array(runs), MemType::Array(id)) => {
                let element = self.table.array_type(id).element;
                for &(first, count, value) in runs {
                    self.run(offset, element, (first, count), value);
                }
            }
            (Init::Bits(_) | Init::Struct(_) | Init::Array(_), _) => {
                panic!("initial values fit their types")
            }
        }
    }

    /// The first element is written, the others are copies of its bytes.
    fn run(&mut self, array: u64, element: MemType, (first, count): (u32, u32), value: InitId) {
        if count == 0 || *self.inits.get(value) == Init::Zero {
            return;
        }
        let size = self.layout.size(self.table, element);
        let start = array + u64::from(first) * size;
        self.write(start, element, value);
        let (start, size) = (start as usize, size as usize);
        for copy in 1..count as usize {
            self.bytes
                .copy_within(start..start + size, start + copy * size);
        }
    }
}
