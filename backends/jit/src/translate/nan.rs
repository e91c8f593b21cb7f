//! NaN in memory: stores first, looks later.
//!
//! A float that is a result of arithmetic is stored as it is. At the end of the block, and before
//! anything that could see the bits, all such floats are looked at together, and only if one is NaN
//! a block apart makes the canonical one of every NaN that was stored. Arithmetic on NaN gives NaN, so
//! it is enough to look at the last results of each computation; infinities can make one of these NaN alone,
//! and the block apart then finds nothing to do.

use super::Translator;
use super::memory::Address;
use crate::nan::NanBits;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{self as clif, InstBuilder};
use iecc_ir::eval::canonical_nan;
use iecc_ir::{CompareOp, ConvertOp, Function, Inst, InstData, Place, Type, Value};
use std::collections::BTreeSet;

/// Most stores that wait: values to look at occupy registers.
const MAX_WAITING: usize = 24;

/// Stores whose floats nobody has looked at, and since when.
#[derive(Default)]
pub(super) struct Waiting {
    stores: Vec<Store>,
    /// Instructions of the block translated so far, and how many of them were when nothing waited
    /// last.
    pub(super) translated: Vec<Inst>,
}

/// A store of a float that may be any NaN.
struct Store {
    place: Place,
    address: Address,
    ty: Type,
    value: Value,
}

impl Translator<'_, '_> {
    /// The value with the bits that the step language says.
    pub(super) fn exact(&mut self, value: Value) -> clif::Value {
        let x = self.value(value);
        match self.nan[value] {
            NanBits::Canonical | NanBits::Fixed => x,
            NanBits::Free => self.canonical(self.func.value_type(value), x),
        }
    }

    /// The value for a place whose bits are of this class.
    pub(super) fn as_class(&mut self, class: NanBits, value: Value) -> clif::Value {
        match class {
            NanBits::Fixed => self.exact(value),
            NanBits::Canonical | NanBits::Free => self.value(value),
        }
    }

    fn canonical(&mut self, ty: Type, x: clif::Value) -> clif::Value {
        let nan = self.constant(ty, canonical_nan(ty));
        let is_nan = self.ins().fcmp(FloatCC::Unordered, x, x);
        self.ins().select(is_nan, nan, x)
    }

    /// What to store for a value; the store is noted if it must be looked at.
    pub(super) fn stored_value(
        &mut self,
        place: &Place,
        address: &Address,
        value: Value,
    ) -> clif::Value {
        let ty = self.func.value_type(value);
        if !ty.is_float() {
            return self.value(value);
        }
        if let Some(bits) = self.func.constant(value) {
            let integer = if ty == Type::F32 {
                Type::I32
            } else {
                Type::I64
            };
            return self.constant(integer, bits);
        }
        match self.nan[value] {
            NanBits::Canonical | NanBits::Fixed => {
                self.settle_for(place);
                self.value(value)
            }
            NanBits::Free if address.exists.is_some() || self.program.plan.has_addresses => {
                self.exact(value)
            }
            NanBits::Free => {
                self.waiting.stores.retain(|store| store.place != *place);
                self.waiting.stores.push(Store {
                    place: place.clone(),
                    address: address.clone(),
                    ty,
                    value,
                });
                self.value(value)
            }
        }
    }

    /// Looks at what waits if some of it may lie at a place.
    pub(super) fn settle_for(&mut self, place: &Place) {
        let overlaps = |store: &Store| match store.place.root == place.root {
            true => store.place.may_overlap(place),
            false => store.place.root.may_alias() && place.root.may_alias(),
        };
        if self.waiting.stores.iter().any(overlaps) {
            self.settle();
        }
    }

    /// Notes that an instruction has been translated.
    pub(super) fn translated(&mut self, inst: Inst) {
        self.waiting.translated.push(inst);
        if self.waiting.stores.len() >= MAX_WAITING {
            self.settle();
        }
    }

    /// Looks at everything that waits.
    pub(super) fn settle(&mut self) {
        let Waiting { stores, translated } = std::mem::take(&mut self.waiting);
        if stores.is_empty() {
            return;
        }
        let (mend, next) = (self.new_block(), self.new_block());
        self.builder.set_cold_block(mend);
        let ends = ends(self.func, &stores, &translated);
        for ty in [Type::F32, Type::F64] {
            let is_of_type = |value: &Value| self.func.value_type(*value) == ty;
            let ends: Vec<Value> = ends.iter().copied().filter(is_of_type).collect();
            for pair in ends.chunks(2) {
                self.look_at(pair[0], pair[pair.len() - 1], mend);
            }
        }
        self.ins().jump(next, &[]);
        self.builder.switch_to_block(mend);
        for store in &stores {
            self.mend(store);
        }
        self.ins().jump(next, &[]);
        self.builder.switch_to_block(next);
    }

    /// Goes to `mend` if one of two floats is NaN.
    fn look_at(&mut self, x: Value, y: Value, mend: clif::Block) {
        let [x, y] = [x, y].map(|v| self.value(v));
        let next = self.new_block();
        let is_nan = self.ins().fcmp(FloatCC::Unordered, x, y);
        self.ins().brif(is_nan, mend, &[], next, &[]);
        self.builder.switch_to_block(next);
    }

    fn mend(&mut self, store: &Store) {
        let Address {
            base,
            offset,
            flags,
            ..
        } = store.address;
        let stored = self
            .ins()
            .load(super::clif_type(store.ty), flags, base, offset);
        let right = self.canonical(store.ty, stored);
        self.ins().store(flags, right, base, offset);
    }
}

/// The stored values that, if no other is NaN, say that none is.
fn ends(func: &Function, stores: &[Store], translated: &[Inst]) -> Vec<Value> {
    let mut stored: BTreeSet<Value> = stores.iter().map(|store| store.value).collect();
    let (mut ends, mut implied) = (Vec::new(), BTreeSet::new());
    for &inst in translated.iter().rev() {
        let &[value] = func.results_of(inst) else {
            continue;
        };
        if stored.remove(&value) && implied.insert(value) {
            ends.push(value);
        }
        if implied.contains(&value) {
            implied.extend(passed_on(func, func.inst(inst)));
        }
    }
    ends.extend(stored.difference(&implied));
    ends
}

/// The operands that make the result NaN if they are NaN.
fn passed_on(func: &Function, data: &InstData) -> Vec<Value> {
    match data {
        InstData::Unary { arg, .. }
        | InstData::Convert {
            op: ConvertOp::Promote | ConvertOp::Demote,
            arg,
            ..
        } => vec![*arg],
        InstData::Binary { args, .. } => args.to_vec(),
        InstData::Select { cond, args } => {
            let compared = ordered_operands(func, *cond).into_iter().flatten();
            let given_nan = |&x: &Value| when_nan(func, args[1], x) == x;
            compared.filter(given_nan).collect()
        }
        InstData::Const { .. }
        | InstData::Compare { .. }
        | InstData::Convert { .. }
        | InstData::Load { .. }
        | InstData::Store { .. }
        | InstData::Copy { .. }
        | InstData::Clear { .. }
        | InstData::Address { .. }
        | InstData::Now
        | InstData::Elapsed { .. }
        | InstData::Step { .. }
        | InstData::Call { .. } => Vec::new(),
    }
}

/// What a value is if `x` is NaN, as far as choices by comparisons with it go.
fn when_nan(func: &Function, mut value: Value, x: Value) -> Value {
    while let Some(InstData::Select { cond, args }) = func.def_inst(value) {
        match ordered_operands(func, *cond) {
            Some(compared) if compared.contains(&x) => value = args[1],
            Some(_) | None => break,
        }
    }
    value
}

/// The operands of a comparison of floats that is false with NaN.
fn ordered_operands(func: &Function, cond: Value) -> Option<[Value; 2]> {
    match func.def_inst(cond)? {
        InstData::Compare {
            op: CompareOp::Feq | CompareOp::Flt | CompareOp::Fle | CompareOp::Fgt | CompareOp::Fge,
            args,
        } => Some(*args),
        InstData::Compare { .. }
        | InstData::Const { .. }
        | InstData::Unary { .. }
        | InstData::Binary { .. }
        | InstData::Convert { .. }
        | InstData::Select { .. }
        | InstData::Load { .. }
        | InstData::Store { .. }
        | InstData::Copy { .. }
        | InstData::Clear { .. }
        | InstData::Address { .. }
        | InstData::Now
        | InstData::Elapsed { .. }
        | InstData::Step { .. }
        | InstData::Call { .. } => None,
    }
}
