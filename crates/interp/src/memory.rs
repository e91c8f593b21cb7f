//! The three regions and the locals of active functions as bytes.

use iecc_ir::{Scalar, Type};
use std::ops::Range;

/// Memory during a scan.
#[derive(Debug)]
pub(crate) struct Memory<'a> {
    pub(crate) state: &'a mut [u8],
    pub(crate) inputs: &'a [u8],
    pub(crate) outputs: &'a mut [u8],
    /// Those of a callee behind those of its caller.
    pub(crate) locals: Vec<u8>,
}

/// A piece of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Space {
    State,
    Input,
    Output,
    Locals,
}

/// A byte of memory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Address {
    pub(crate) space: Space,
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
        Scalar::read(self.space(address.space), address.offset as usize, ty).bits
    }

    fn space(&self, space: Space) -> &[u8] {
        match space {
            Space::State => self.state,
            Space::Input => self.inputs,
            Space::Output => self.outputs,
            Space::Locals => &self.locals,
        }
    }

    fn space_mut(&mut self, space: Space) -> &mut [u8] {
        match space {
            Space::State => self.state,
            Space::Output => self.outputs,
            Space::Locals => &mut self.locals,
            Space::Input => panic!("verified code does not store to inputs"),
        }
    }

    /// Makes the bytes from `to` what those from `from` are now, or 0.
    pub(crate) fn copy(&mut self, to: Option<Address>, from: Option<Address>, len: u64) {
        let Some(to) = to else { return };
        let target = range(to.offset, len);
        match from {
            None => self.space_mut(to.space)[target].fill(0),
            Some(from) if from.space == to.space => {
                let source = range(from.offset, len);
                self.space_mut(to.space).copy_within(source, target.start);
            }
            Some(from) => {
                let bytes = self.space(from.space)[range(from.offset, len)].to_vec();
                self.space_mut(to.space)[target].copy_from_slice(&bytes);
            }
        }
    }

    fn set_word(&mut self, address: Address, ty: Type, bits: u64) {
        let bytes = self.space_mut(address.space);
        Scalar::new(ty, bits).write(bytes, address.offset as usize);
    }
}

fn range(offset: u64, len: u64) -> Range<usize> {
    offset as usize..(offset + len) as usize
}
