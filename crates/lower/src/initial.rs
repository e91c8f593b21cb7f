//! The image of the state: initial values of tags as bytes.

use crate::types::{self, TypeMap};
use iecc_ir::{Image, Layout, MemType, Scalar, StructId, TypeTable};
use iecc_sema::hir::code::{Init, InitId, Target};
use iecc_sema::hir::{self, Inits};

/// The state before the first scan: the whole values of tags, then the leaves that differ.
pub(crate) fn image(program: &hir::Program, types: &TypeMap<'_>, state: StructId) -> Image {
    let table = types.table();
    let layout = Layout::new(table);
    let mut image = Image::zero(&layout, table, state);
    let mut writer = Writer {
        inits: &program.inits,
        types,
        table,
        layout: &layout,
        state,
        around: Vec::new(),
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
    types: &'a TypeMap<'a>,
    table: &'a TypeTable,
    layout: &'a Layout,
    state: StructId,
    /// The structures that are being written, the innermost last, and where they lie.
    around: Vec<(StructId, u64)>,
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
            (Init::Address(target), MemType::Scalar(ty)) => {
                let address = self.address(target);
                Scalar::new(ty, address).write(self.bytes, offset as usize);
            }
            (Init::Struct(members), MemType::Struct(id)) => {
                self.around.push((id, offset));
                for &(member, value) in members {
                    let field = self.table.structs[id].fields[member as usize].ty;
                    let offset = offset + self.layout.field_offset(id, member);
                    self.write(offset, field, value);
                }
                self.around.pop();
            }
            (Init::Array(runs), MemType::Array(id)) => {
                let element = self.table.array_type(id).element;
                for &(first, count, value) in runs {
                    self.run(offset, element, (first, count), value);
                }
            }
            (Init::Bits(_) | Init::Address(_) | Init::Struct(_) | Init::Array(_), _) => {
                panic!("initial values fit their types")
            }
        }
    }

    /// One more than the offset in the state, as the instruction `address` gives it.
    fn address(&self, target: &Target) -> u64 {
        let (start, ty, path) = match target {
            Target::Tag(place) => {
                let place = types::place(place);
                (0, MemType::Struct(self.state), place.path)
            }
            Target::Around(id, steps) => {
                let id = self.types.known_struct(*id);
                let mut around = self.around.iter().rev();
                let found = around.find(|(other, _)| *other == id);
                let (_, start) = found.expect("the value lies in the structure it refers to");
                (*start, MemType::Struct(id), types::steps(steps))
            }
        };
        let (offset, _, _) = self.layout.resolve(self.table, ty, &path);
        start + offset + 1
    }

    /// The first element is written, the others are copies of its bytes, unless each holds addresses
    /// of its own.
    fn run(&mut self, array: u64, element: MemType, (first, count): (u32, u32), value: InitId) {
        if count == 0 || *self.inits.get(value) == Init::Zero {
            return;
        }
        let size = self.layout.size(self.table, element);
        let start = array + u64::from(first) * size;
        if self.has_own_addresses(value) {
            for index in 0..u64::from(count) {
                self.write(start + index * size, element, value);
            }
            return;
        }
        self.write(start, element, value);
        let (start, size) = (start as usize, size as usize);
        for copy in 1..count as usize {
            self.bytes
                .copy_within(start..start + size, start + copy * size);
        }
    }

    fn has_own_addresses(&self, init: InitId) -> bool {
        match self.inits.get(init) {
            Init::Zero | Init::Bits(_) | Init::Address(Target::Tag(_)) => false,
            Init::Address(Target::Around(..)) => true,
            Init::Struct(members) => members
                .iter()
                .any(|(_, init)| self.has_own_addresses(*init)),
            Init::Array(runs) => runs.iter().any(|(.., init)| self.has_own_addresses(*init)),
        }
    }
}
