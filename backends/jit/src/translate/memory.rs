//! Places become addresses.
//!
//! An index by value is compared with its bound and replaced by 0 when outside, so every address
//! lies in its region whatever the program computes; whether all indices were inside decides if
//! what is loaded counts and if a store happens. An index that loops and branches keep inside needs no
//! comparison. The same goes for a reference that stands for an
//! element outside its array: it is passed as a null pointer, and the state takes its place.

use super::{Translator, clif_type};
use crate::context::ScanContext;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{self as clif, InstBuilder, MemFlagsData, types};
use iecc_ir::{ArrayId, BinaryOp, Index, InstData, MemType, Place, Projection, Root, Type, Value};

/// Where a place lies.
#[derive(Clone)]
pub(super) struct Address {
    pub(super) base: clif::Value,
    pub(super) offset: i32,
    pub(super) flags: MemFlagsData,
    /// An `i8` that says whether the place exists; `None` if it always does.
    pub(super) exists: Option<clif::Value>,
    /// What lies there; for a bit, the integer that holds it.
    pub(super) ty: MemType,
    bit: Option<Index>,
}

impl Address {
    /// Whether it is a bit of what lies there.
    pub(super) fn is_bit(&self) -> bool {
        self.bit.is_some()
    }
}

impl Translator<'_, '_> {
    pub(super) fn address(&mut self, place: &Place) -> Address {
        let root = self.program.module.root_type(self.func, place.root);
        let mut address = self.root(place.root, root.expect("verified places have a root"));
        for step in &place.path {
            self.project(&mut address, *step);
        }
        if let Some(Index::Value(bit)) = address.bit {
            let MemType::Scalar(ty) = address.ty else {
                panic!("bits are in integers")
            };
            if !self.is_inside(bit, ty.bits()) {
                let inside = self.inside(bit, ty.bits());
                self.require(&mut address, inside);
            }
        }
        address
    }

    fn root(&mut self, root: Root, ty: MemType) -> Address {
        let pointer = self.pointer;
        let mut exists = None;
        let (base, region) = match root {
            Root::State => (self.state, self.regions.state),
            Root::Input => {
                let base = self.context_field(pointer, ScanContext::INPUTS);
                (base, self.regions.input)
            }
            Root::Output => {
                let base = self.context_field(pointer, ScanContext::OUTPUTS);
                (base, self.regions.output)
            }
            Root::Deref { value, .. } => {
                let (base, inside) = self.at_address(value, ty);
                exists = Some(inside);
                (base, self.regions.state)
            }
            Root::Local(local) => {
                let offset = self.local_offsets[local];
                (self.local_base(offset), self.regions.locals)
            }
            Root::Ref(param) => {
                let mut base = self.reference(param);
                if self.facts.absent_refs.contains(param) {
                    let present = self.ins().icmp_imm_s(IntCC::NotEqual, base, 0);
                    // The engine keeps as many bytes there as the reference may read.
                    let state = self.state;
                    base = self.ins().select(present, base, state);
                    exists = Some(present);
                }
                (base, self.regions.state)
            }
        };
        let mut flags = self.flags(region);
        if root == Root::Input {
            flags = flags.with_readonly().with_can_move();
        }
        Address {
            base,
            offset: 0,
            flags,
            exists,
            ty,
            bit: None,
        }
    }

    /// Where an address leads, and whether all that is taken to lie there is inside the state.
    fn at_address(&mut self, value: Value, ty: MemType) -> (clif::Value, clif::Value) {
        let (program, pointer) = (self.program, self.pointer);
        let bytes = program.layout.size(&program.module.types, ty);
        let address = self.value(value);
        let offset = self.ins().iadd_imm_s(address, -1);
        let zero = self.ins().iconst(types::I64, 0);
        let inside = match program.plan.state_len.checked_sub(bytes) {
            Some(last) => {
                let last = self.ins().iconst(types::I64, last as i64);
                self.ins()
                    .icmp(IntCC::UnsignedLessThanOrEqual, offset, last)
            }
            None => self.ins().iconst(types::I8, 0),
        };
        let offset = self.ins().select(inside, offset, zero);
        let offset = match pointer {
            types::I64 => offset,
            _ => self.ins().ireduce(pointer, offset),
        };
        let state = self.state;
        (self.ins().iadd(state, offset), inside)
    }

    /// The address of a place of the state; 0 if it does not exist or is a local of a caller.
    pub(super) fn address_of(&mut self, place: &Place) -> clif::Value {
        let at = self.address(place);
        let (pointer, state) = (self.pointer_to(&at), self.state);
        let mut offset = self.ins().isub(pointer, state);
        if self.pointer != types::I64 {
            offset = self.ins().uextend(types::I64, offset);
        }
        let state_len = self.program.plan.state_len as i64;
        let end = self.ins().iconst(types::I64, state_len);
        let inside = self.ins().icmp(IntCC::UnsignedLessThanOrEqual, offset, end);
        let inside = match at.exists {
            Some(exists) => self.ins().band(inside, exists),
            None => inside,
        };
        let address = self.ins().iadd_imm_s(offset, 1);
        let zero = self.ins().iconst(types::I64, 0);
        self.ins().select(inside, address, zero)
    }

    fn project(&mut self, address: &mut Address, step: Projection) {
        let (types, layout) = (&self.program.module.types, self.program.layout);
        match (address.ty, step) {
            (MemType::Struct(id), Projection::Field(field)) => {
                address.offset += layout.field_offset(id, field) as i32;
                address.ty = types.structs[id].fields[field as usize].ty;
            }
            (MemType::Array(id), Projection::Index(index)) => self.element(address, id, index),
            (MemType::Scalar(_), Projection::Bit(index)) => address.bit = Some(index),
            (MemType::Struct(_) | MemType::Array(_) | MemType::Scalar(_), _) => {
                panic!("verified places follow their types")
            }
        }
    }

    fn element(&mut self, address: &mut Address, id: ArrayId, index: Index) {
        let (types, layout) = (&self.program.module.types, self.program.layout);
        let array = types.array_type(id);
        let size = layout.size(types, array.element);
        address.ty = array.element;
        match index {
            Index::Const(index) => address.offset += (u64::from(index) * size) as i32,
            Index::Value(index) => {
                let (index, ahead) = self.index_and_constant(index, array.len);
                address.offset += (ahead * size) as i32;
                let mut number = self.value(index);
                if ahead == 0 && !self.is_inside(index, array.len) {
                    let inside = self.inside(index, array.len);
                    let zero = self.ins().iconst(types::I32, 0);
                    number = self.ins().select(inside, number, zero);
                    self.require(address, inside);
                }
                let pointer = self.pointer;
                let distance = match pointer {
                    types::I32 => number,
                    _ => self.ins().uextend(pointer, number),
                };
                let size = self.ins().iconst(pointer, size as i64);
                let distance = self.ins().imul(distance, size);
                address.base = self.ins().iadd(address.base, distance);
            }
        }
    }

    /// `i + 3`, if it is inside and i not negative, is i and 3 elements more: machine code adds constants for nothing.
    fn index_and_constant(&self, index: Value, len: u32) -> (Value, u64) {
        let sum = match self.func.def_inst(index) {
            Some(InstData::Binary {
                op: BinaryOp::Add,
                args: [x, y],
            }) => self.func.constant(*y).map(|constant| (*x, constant)),
            Some(_) | None => None,
        };
        let Some((x, constant)) = sum else {
            return (index, 0);
        };
        let fits = self.facts.ranges.as_ref().is_some_and(|ranges| {
            let range = ranges.at(self.func, x, self.at);
            let last = range.hi.checked_add_unsigned(constant);
            range.lo >= 0 && last.is_some_and(|last| last < i64::from(len))
        });
        if fits { (x, constant) } else { (index, 0) }
    }

    /// Whether loops and branches keep an index inside.
    fn is_inside(&self, index: Value, len: u32) -> bool {
        self.facts.ranges.as_ref().is_some_and(|ranges| {
            let range = ranges.at(self.func, index, self.at);
            range.lo >= 0 && range.hi < i64::from(len)
        })
    }

    /// Read as unsigned, negative indices are above every bound.
    fn inside(&mut self, index: Value, len: u32) -> clif::Value {
        let bound = i64::from(len.min(1 << 31));
        let index = self.value(index);
        self.ins().icmp_imm_u(IntCC::UnsignedLessThan, index, bound)
    }

    fn require(&mut self, address: &mut Address, condition: clif::Value) {
        address.exists = Some(match address.exists {
            Some(before) => self.ins().band(before, condition),
            None => condition,
        });
    }

    /// The address as a number, null if the place does not exist.
    pub(super) fn pointer_to(&mut self, address: &Address) -> clif::Value {
        let ty = self.pointer;
        let pointer = self
            .ins()
            .iadd_imm_s(address.base, i64::from(address.offset));
        let Some(exists) = address.exists else {
            return pointer;
        };
        let null = self.ins().iconst(ty, 0);
        self.ins().select(exists, pointer, null)
    }

    fn load_scalar(&mut self, address: &Address) -> (Type, clif::Value) {
        let MemType::Scalar(ty) = address.ty else {
            panic!("only scalars are moved")
        };
        let value = self
            .ins()
            .load(clif_type(ty), address.flags, address.base, address.offset);
        if ty == Type::I1 && self.program.plan.has_addresses {
            return (ty, self.ins().band_imm_u(value, 1));
        }
        (ty, value)
    }

    pub(super) fn load(&mut self, place: &Place) -> clif::Value {
        self.settle_for(place);
        self.store_constants_for(place);
        let address = self.address(place);
        self.load_from(&address)
    }

    fn load_from(&mut self, address: &Address) -> clif::Value {
        let (mut ty, mut value) = self.load_scalar(address);
        if let Some(bit) = address.bit {
            let count = self.bit_number(bit);
            let shifted = self.ins().ushr(value, count);
            value = self.low_bit(shifted, ty);
            ty = Type::I1;
        }
        match address.exists {
            Some(exists) => {
                let zero = self.constant(ty, 0);
                self.ins().select(exists, value, zero)
            }
            None => value,
        }
    }

    fn low_bit(&mut self, word: clif::Value, ty: Type) -> clif::Value {
        let low = match clif_type(ty) {
            types::I8 => word,
            _ => self.ins().ireduce(types::I8, word),
        };
        self.ins().band_imm_u(low, 1)
    }

    fn bit_number(&mut self, bit: Index) -> clif::Value {
        match bit {
            Index::Const(bit) => self.ins().iconst(types::I32, i64::from(bit)),
            Index::Value(value) => self.value(value),
        }
    }

    pub(super) fn store(&mut self, place: &Place, value: Value) {
        self.store_constants_for(place);
        let address = self.address(place);
        let constant = self.func.constant(value);
        if let Some(bits) = constant {
            self.settle_for(place);
            if self.store_later(place, &address, bits) {
                return;
            }
        }
        let value = self.stored_value(place, &address, value);
        self.if_exists(&address, |this| {
            let value = match address.bit {
                Some(bit) => this.with_bit(&address, bit, constant, value),
                None => value,
            };
            this.ins()
                .store(address.flags, value, address.base, address.offset);
        });
    }

    /// Does something only if the place exists, and goes on behind it.
    pub(super) fn if_exists(&mut self, address: &Address, then: impl FnOnce(&mut Self)) {
        let Some(exists) = address.exists else {
            return then(self);
        };
        let (inside, next) = (self.new_block(), self.new_block());
        self.ins().brif(exists, inside, &[], next, &[]);
        self.builder.switch_to_block(inside);
        then(self);
        self.ins().jump(next, &[]);
        self.builder.switch_to_block(next);
    }

    /// The integer at an address with one bit changed.
    fn with_bit(
        &mut self,
        address: &Address,
        bit: Index,
        constant: Option<u64>,
        value: clif::Value,
    ) -> clif::Value {
        let (ty, word) = self.load_scalar(address);
        let count = self.bit_number(bit);
        let one = self.constant(ty, 1);
        let mask = self.ins().ishl(one, count);
        match constant {
            Some(0) => self.ins().band_not(word, mask),
            Some(_) => self.ins().bor(word, mask),
            None => {
                let cleared = self.ins().band_not(word, mask);
                let wide = self.extend(value, Type::I1, ty, false);
                let placed = self.ins().ishl(wide, count);
                self.ins().bor(cleared, placed)
            }
        }
    }

    pub(super) fn elapsed(&mut self, place: &Place, unit_ns: u64, ty: Type) -> clif::Value {
        self.store_constants_for(place);
        let address = self.address(place);
        let kept = self.load_from(&address);
        let now = self.now();
        self.if_exists(&address, |this| {
            this.ins()
                .store(address.flags, now, address.base, address.offset);
        });
        self.units_between(kept, now, unit_ns, ty)
    }

    pub(super) fn step(&mut self, unit_ns: u64, ty: Type) -> clif::Value {
        let previous = self.context_field(types::I64, ScanContext::PREVIOUS_NS);
        let now = self.now();
        self.units_between(previous, now, unit_ns, ty)
    }
}
