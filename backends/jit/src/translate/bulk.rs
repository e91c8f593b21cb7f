//! Whole structs and arrays: copies, clears, and locals that are 0 at the entry.
//!
//! Few bytes are moved by loads and stores, all loads first; many by calls.

use super::Translator;
use super::memory::Address;
use crate::context::ScanContext;
use crate::plan::Locals;
use cranelift_codegen::ir::{self as clif, InstBuilder, StackSlotData, StackSlotKind, types};
use iecc_ir::Place;

/// Most bytes that are moved without a call.
const FEW_BYTES: u64 = 128;

/// Alignment of the memory of an activation, as a power of two.
const LOCAL_ALIGN: u8 = 3;

impl Translator<'_, '_> {
    pub(super) fn clear_locals(&mut self) {
        let bytes = match self.facts.locals {
            Locals::None => return,
            Locals::Stack(bytes) => {
                let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, bytes, LOCAL_ALIGN);
                self.local_slot = Some(self.builder.create_sized_stack_slot(slot));
                u64::from(bytes)
            }
            Locals::Engine { bytes, .. } => bytes,
        };
        let base = self.local_base(0);
        let flags = self.flags(self.regions.locals);
        self.zero(base, 0, flags, bytes);
    }

    /// What lies at an offset in the memory of the activation.
    pub(super) fn local_base(&mut self, offset: u64) -> clif::Value {
        let pointer = self.pointer;
        if let Some(slot) = self.local_slot {
            return self.ins().stack_addr(pointer, slot, offset as i32);
        }
        let Locals::Engine { offset: start, .. } = self.facts.locals else {
            panic!("a function with locals has memory for them")
        };
        let base = self.context_field(pointer, ScanContext::LOCALS);
        self.ins().iadd_imm_s(base, (start + offset) as i64)
    }

    fn bytes_of(&self, address: &Address) -> u64 {
        let program = self.program;
        program.layout.size(&program.module.types, address.ty)
    }

    pub(super) fn clear(&mut self, place: &Place) {
        let to = self.address(place);
        let bytes = self.bytes_of(&to);
        self.if_exists(&to, |this| this.zero(to.base, to.offset, to.flags, bytes));
    }

    fn zero(&mut self, base: clif::Value, offset: i32, flags: clif::MemFlagsData, bytes: u64) {
        if bytes > FEW_BYTES {
            let config = self.unit.target_config();
            let (zero, pointer) = (self.ins().iconst(types::I8, 0), self.pointer);
            let to = self.ins().iadd_imm_s(base, i64::from(offset));
            let len = self.ins().iconst(pointer, bytes as i64);
            return self.builder.call_memset(config, to, zero, len);
        }
        for (at, ty) in pieces(bytes) {
            let zero = self.ins().iconst(ty, 0);
            self.ins().store(flags, zero, base, offset + at);
        }
    }

    pub(super) fn copy(&mut self, to: &Place, from: &Place) {
        let (to, from) = (self.address(to), self.address(from));
        let bytes = self.bytes_of(&to);
        if bytes > FEW_BYTES {
            self.if_exists(&to, |this| this.move_many(&to, &from, bytes));
        } else {
            self.move_few(&to, &from, bytes);
        }
    }

    fn move_few(&mut self, to: &Address, from: &Address, bytes: u64) {
        let mut moved = Vec::new();
        for (at, ty) in pieces(bytes) {
            let (flags, offset) = (from.flags, from.offset + at);
            let mut value = self.ins().load(ty, flags, from.base, offset);
            if let Some(exists) = from.exists {
                let zero = self.ins().iconst(ty, 0);
                value = self.ins().select(exists, value, zero);
            }
            moved.push((at, value));
        }
        self.if_exists(to, |this| {
            for (at, value) in moved {
                this.ins().store(to.flags, value, to.base, to.offset + at);
            }
        });
    }

    fn move_many(&mut self, to: &Address, from: &Address, bytes: u64) {
        let Some(exists) = from.exists else {
            return self.call_move(to, from, bytes);
        };
        let [found, missing, next] = [(); 3].map(|()| self.new_block());
        self.ins().brif(exists, found, &[], missing, &[]);
        self.builder.switch_to_block(found);
        self.call_move(to, from, bytes);
        self.ins().jump(next, &[]);
        self.builder.switch_to_block(missing);
        self.zero(to.base, to.offset, to.flags, bytes);
        self.ins().jump(next, &[]);
        self.builder.switch_to_block(next);
    }

    fn call_move(&mut self, to: &Address, from: &Address, bytes: u64) {
        let config = self.unit.target_config();
        let pointer = self.pointer;
        let [to, from] = [to, from].map(|at| self.ins().iadd_imm_s(at.base, i64::from(at.offset)));
        let len = self.ins().iconst(pointer, bytes as i64);
        self.builder.call_memmove(config, to, from, len);
    }
}

/// Cuts bytes into pieces of machine words, largest first.
pub(super) fn pieces(bytes: u64) -> impl Iterator<Item = (i32, clif::Type)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let (size, ty) = match bytes - at {
            0 => return None,
            1 => (1, types::I8),
            2..=3 => (2, types::I16),
            4..=7 => (4, types::I32),
            _ => (8, types::I64),
        };
        at += size;
        Some(((at - size) as i32, ty))
    })
}
