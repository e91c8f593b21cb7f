//! Constants in memory: neighbours are stored together.
//!
//! A constant that is stored at a known place waits until something may look at the place, or until the
//! block ends. What waits then goes to memory in pieces as wide as the machine has.

use super::Translator;
use super::bulk::pieces;
use super::memory::Address;
use cranelift_codegen::ir::{self as clif, ConstantData, InstBuilder, types};
use iecc_ir::{MemType, Place, Type};

/// Most constants that wait.
const MAX_WAITING: usize = 16;

/// Bytes of a vector.
const VECTOR_BYTES: usize = 16;

/// A constant that is not stored yet. No two that wait overlap.
pub(super) struct Constant {
    place: Place,
    address: Address,
    bytes: Vec<u8>,
}

impl Constant {
    fn end(&self) -> i64 {
        i64::from(self.address.offset) + self.bytes.len() as i64
    }
}

impl Translator<'_, '_> {
    /// Notes a constant for a place; false if it must be stored now.
    pub(super) fn store_later(&mut self, place: &Place, address: &Address, bits: u64) -> bool {
        let MemType::Scalar(ty) = address.ty else {
            panic!("only scalars are moved")
        };
        if !place.is_static() || address.exists.is_some() || address.is_bit() {
            return false;
        }
        if self.constants.len() >= MAX_WAITING {
            self.store_constants();
        }
        self.constants.push(Constant {
            place: place.clone(),
            address: address.clone(),
            bytes: bytes_of(ty, bits),
        });
        true
    }

    /// Stores what waits if some of it may lie at a place.
    pub(super) fn store_constants_for(&mut self, place: &Place) {
        let mut constants = self.constants.iter();
        if constants.any(|constant| constant.place.may_overlap(place)) {
            self.store_constants();
        }
    }

    /// Stores everything that waits.
    pub(super) fn store_constants(&mut self) {
        let mut constants = std::mem::take(&mut self.constants);
        constants.sort_by_key(|constant| (constant.address.base, constant.address.offset));
        let together = |a: &Constant, b: &Constant| {
            a.address.base == b.address.base && a.end() == i64::from(b.address.offset)
        };
        for neighbours in constants.chunk_by(together) {
            let bytes: Vec<u8> = neighbours.iter().flat_map(|c| c.bytes.clone()).collect();
            self.store_bytes(&neighbours[0].address, &bytes);
        }
    }

    fn store_bytes(&mut self, address: &Address, bytes: &[u8]) {
        let vectors = match self.program.has_vectors {
            true => bytes.len() / VECTOR_BYTES * VECTOR_BYTES,
            false => 0,
        };
        for at in (0..vectors).step_by(VECTOR_BYTES) {
            let constant = ConstantData::from(&bytes[at..at + VECTOR_BYTES]);
            let constant = self.builder.func.dfg.constants.insert(constant);
            let value = self.ins().vconst(types::I8X16, constant);
            self.store_at(address, at, value);
        }
        let rest = &bytes[vectors..];
        for (at, ty) in pieces(rest.len() as u64) {
            let value = number(&rest[at as usize..][..ty.bytes() as usize]);
            let value = self.ins().iconst(ty, value as i64);
            self.store_at(address, vectors + at as usize, value);
        }
    }

    fn store_at(&mut self, address: &Address, at: usize, value: clif::Value) {
        let offset = address.offset + at as i32;
        self.ins().store(address.flags, value, address.base, offset);
    }
}

/// A constant as it lies in memory.
fn bytes_of(ty: Type, bits: u64) -> Vec<u8> {
    match ty {
        Type::I1 | Type::I8 => vec![bits as u8],
        Type::I16 => (bits as u16).to_ne_bytes().to_vec(),
        Type::I32 | Type::F32 => (bits as u32).to_ne_bytes().to_vec(),
        Type::I64 | Type::F64 => bits.to_ne_bytes().to_vec(),
    }
}

/// The number that lies in memory as these bytes: 1, 2, 4 or 8 of them.
fn number(bytes: &[u8]) -> u64 {
    let known = "a machine word";
    match bytes.len() {
        1 => u64::from(bytes[0]),
        2 => u64::from(u16::from_ne_bytes(bytes.try_into().expect(known))),
        4 => u64::from(u32::from_ne_bytes(bytes.try_into().expect(known))),
        _ => u64::from_ne_bytes(bytes.try_into().expect(known)),
    }
}
