//! The initial contents of the state region, as the bytes of its layout.

use crate::{Layout, MemType, Place, Root, StructId, Type, TypeTable};

/// One value with its type, as bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Scalar {
    /// The type.
    pub ty: Type,
    /// The bits; those above the width are 0.
    pub bits: u64,
}

impl Scalar {
    /// A value; bits above the width are dropped.
    pub fn new(ty: Type, bits: u64) -> Self {
        Self {
            ty,
            bits: bits & ty.mask(),
        }
    }

    /// The bits as a two's complement number (0 or -1 for `i1`).
    pub fn signed(self) -> i64 {
        self.ty.signed(self.bits)
    }

    /// Reads a value from the bytes of a region.
    pub fn read(bytes: &[u8], offset: usize, ty: Type) -> Self {
        let width = ty.bytes() as usize;
        let mut buffer = [0; 8];
        buffer[..width].copy_from_slice(&bytes[offset..offset + width]);
        Self::new(ty, u64::from_le_bytes(buffer))
    }

    /// Writes the value into the bytes of a region.
    pub fn write(self, bytes: &mut [u8], offset: usize) {
        let width = self.ty.bytes() as usize;
        bytes[offset..offset + width].copy_from_slice(&self.bits.to_le_bytes()[..width]);
    }
}

/// Bytes of a region in the layout of its struct.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    bytes: Vec<u8>,
}

impl Image {
    /// All zero, sized for a region.
    pub fn zero(layout: &Layout, types: &TypeTable, region: StructId) -> Self {
        let size = layout.size(types, MemType::Struct(region));
        Self {
            bytes: vec![0; usize::try_from(size).expect("regions are bounded")],
        }
    }

    /// An image from bytes of the region's size.
    pub fn from_bytes(bytes: Vec<u8>) -> Self {
        Self { bytes }
    }

    /// The same scalars, with each `i1` 0 or 1 and nothing between them: a program that stores at
    /// addresses may leave other bytes there.
    #[must_use]
    pub fn tidied(&self, layout: &Layout, types: &TypeTable, region: StructId) -> Self {
        let mut tidy = Self::zero(layout, types, region);
        let (start, ty) = (Place::root(Root::State), MemType::Struct(region));
        layout.for_each_leaf(types, &start, ty, &mut |_, offset, ty| {
            tidy.set(offset, self.get(offset, ty));
        });
        tidy
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The bytes, for changes.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }

    /// The value of type `ty` at a byte offset.
    pub fn get(&self, offset: u64, ty: Type) -> Scalar {
        Scalar::read(&self.bytes, offset as usize, ty)
    }

    /// Sets the value at a byte offset.
    pub fn set(&mut self, offset: u64, value: Scalar) {
        value.write(&mut self.bytes, offset as usize);
    }

    /// Sets the value at a static place of the region; bits of integers included.
    pub fn set_place(
        &mut self,
        layout: &Layout,
        types: &TypeTable,
        region: StructId,
        place: &Place,
        bits: u64,
    ) {
        let (offset, ty, bit) = layout.resolve(types, MemType::Struct(region), &place.path);
        let MemType::Scalar(ty) = ty else {
            panic!("only scalars are set")
        };
        let bits = match bit {
            Some(bit) => (self.get(offset, ty).bits & !(1 << bit)) | ((bits & 1) << bit),
            None => bits,
        };
        self.set(offset, Scalar::new(ty, bits));
    }

    /// The value at a static place of the region; a bit reads as `i1`.
    pub fn get_place(
        &self,
        layout: &Layout,
        types: &TypeTable,
        region: StructId,
        place: &Place,
    ) -> Scalar {
        let (offset, ty, bit) = layout.resolve(types, MemType::Struct(region), &place.path);
        let MemType::Scalar(ty) = ty else {
            panic!("only scalars are read")
        };
        let value = self.get(offset, ty);
        bit.map_or(value, |bit| Scalar::new(Type::I1, value.bits >> bit))
    }
}
