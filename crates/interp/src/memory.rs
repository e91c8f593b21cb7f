//! The three regions as bytes.

use iecc_ir::{Region, Scalar, Type};

/// Memory during a scan.
#[derive(Debug)]
pub(crate) struct Memory<'a> {
    pub(crate) state: &'a mut [u8],
    pub(crate) inputs: &'a [u8],
    pub(crate) outputs: &'a mut [u8],
}

/// A byte of a region.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Address {
    pub(crate) region: Region,
    pub(crate) offset: u64,
}

/// What a load or store reaches.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Cell {
    /// A scalar of this type.
    Scalar(Address, Type),
    /// One bit, below the width, of a scalar of this type.
    Bit(Address, Type, u32),
    /// An index left its bounds: loads give 0, stores do nothing.
    Nowhere,
}

impl Memory<'_> {
    pub(crate) fn load(&self, cell: Cell) -> u64 {
        match cell {
            Cell::Scalar(address, ty) => self.word(address, ty),
            Cell::Bit(address, ty, bit) => (self.word(address, ty) >> bit) & 1,
            Cell::Nowhere => 0,
        }
    }

    pub(crate) fn store(&mut self, cell: Cell, value: u64) {
        match cell {
            Cell::Scalar(address, ty) => self.set_word(address, ty, value),
            Cell::Bit(address, ty, bit) => {
                let others = self.word(address, ty) & !(1 << bit);
                self.set_word(address, ty, others | (value << bit));
            }
            Cell::Nowhere => {}
        }
    }

    fn word(&self, address: Address, ty: Type) -> u64 {
        let bytes = match address.region {
            Region::State => &*self.state,
            Region::Input => self.inputs,
            Region::Output => &*self.outputs,
        };
        Scalar::read(bytes, address.offset as usize, ty).bits
    }

    fn set_word(&mut self, address: Address, ty: Type, bits: u64) {
        let bytes = match address.region {
            Region::State => &mut *self.state,
            Region::Output => &mut *self.outputs,
            Region::Input => panic!("verified code does not store to inputs"),
        };
        Scalar::new(ty, bits).write(bytes, address.offset as usize);
    }
}
