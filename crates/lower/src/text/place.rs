//! Places: where a path leads, and how it is read and written.
//!
//! Indices are evaluated and tested once, from left to right, when a path is followed; what is found
//! may then be read and written any number of times.
//!
//! An offset into an array is computed in 32 bits where no subscript of its type can wrap into the
//! bounds, else in 64. The test is one unsigned comparison, which is exact as long as the
//! upper bound is a number of the width: a subscript below the lower bound wraps to a number above
//! every length. Only an ULINT can wrap upwards, if the lower bound is negative, and is tested for that.

use super::convert::{bits_type, float_bits, resize};
use super::{Storage, Unit};
use crate::types::{elementary, scalar};
use iecc_ir::{
    BinaryOp, CompareOp, ConvertOp, FaultCode, Index, Place, RefParam, Root as IrRoot, Type, Value,
    Variable,
};
use iecc_sema::hir::code::{ExprId, LocalId, PathId, PathStep, Root};
use iecc_sema::hir::{self, Elementary};
use iecc_source::Span;

/// Members of a string structure.
const LEN: u32 = 0;
const DATA: u32 = 1;

/// What a path leads to.
#[derive(Debug, Clone)]
pub(super) struct Located {
    base: Base,
    /// What lies there as a whole.
    pub(super) ty: hir::Type,
    part: Part,
}

#[derive(Debug, Clone)]
enum Base {
    Variable(Variable),
    Memory(Place),
}

/// How much of what lies there is meant.
#[derive(Debug, Clone, Copy)]
enum Part {
    Whole,
    Bits { first: u32, count: u32 },
    Bytes { offset: u32, ty: Elementary },
}

/// A subscript's way to an element.
#[derive(Debug, Clone, Copy)]
struct Subscript {
    value: ExprId,
    low: i64,
    checked: bool,
}

impl Unit<'_, '_> {
    /// A whole local.
    pub(super) fn local(&self, local: LocalId) -> Located {
        let base = match self.locals[local.index()] {
            Storage::Variable(variable) => Base::Variable(variable),
            Storage::Memory(memory) => Base::Memory(Place::root(IrRoot::Local(memory))),
        };
        Located {
            base,
            ty: self.code.locals[local.index()].ty,
            part: Part::Whole,
        }
    }

    /// Follows a path.
    pub(super) fn locate(&mut self, id: PathId) -> Located {
        self.locate_tested(id, |_| ())
    }

    /// Follows a path. It leads somewhere if all tests hold that `tested` gets.
    fn locate_tested(&mut self, id: PathId, mut tested: impl FnMut(Value)) -> Located {
        let path = self.code.path(id);
        let (mut at, test) = self.start(path.root, path.span);
        test.into_iter().for_each(&mut tested);
        for step in &path.steps {
            let test = self.step(&mut at, *step, path.span);
            test.into_iter().for_each(&mut tested);
        }
        at
    }

    /// Whether a path leads anywhere. Where it does not, a fault has ended the scan or set the status.
    pub(super) fn exists(&mut self, id: PathId) -> Value {
        let mut tests = Vec::new();
        self.locate_tested(id, |test| tests.push(test));
        if self.traps() {
            tests.clear();
        }
        let all = tests
            .into_iter()
            .reduce(|all, test| self.builder.binary(BinaryOp::And, all, test));
        all.unwrap_or_else(|| self.builder.constant(Type::I1, 1))
    }

    /// The place in memory that a path leads to.
    pub(super) fn memory(&mut self, id: PathId) -> Place {
        let at = self.locate(id);
        match (at.base, at.part) {
            (Base::Memory(place), Part::Whole) => place,
            (Base::Variable(_) | Base::Memory(_), _) => panic!("only memory is referred to"),
        }
    }

    fn start(&mut self, root: Root, span: Span) -> (Located, Option<Value>) {
        let mut test = None;
        let (root, ty) = match root {
            Root::Tag(tag) => {
                let place = Place::root(IrRoot::State).field(tag.index() as u32);
                let ty = self.program.tag(tag).ty;
                return (Located::memory(place, ty), None);
            }
            Root::Ref(index) => (
                IrRoot::Ref(RefParam::from_u32(index)),
                self.code.refs[index as usize].ty,
            ),
            Root::Local(local) => return (self.local(local), None),
            Root::Deref {
                address,
                ty,
                checked,
            } => {
                let value = self.expr(address);
                if !checked {
                    test = Some(self.check_not_zero(value, FaultCode::Reference, span));
                }
                let mem = self.lowering.types.mem_type(ty);
                (IrRoot::Deref { value, ty: mem }, ty)
            }
        };
        (Located::memory(Place::root(root), ty), test)
    }

    /// Goes on along a path. Gives what was tested, if anything.
    fn step(&mut self, at: &mut Located, step: PathStep, span: Span) -> Option<Value> {
        let mut test = None;
        match step {
            PathStep::Field(field) => at.enter_field(self.program, field),
            PathStep::Index(index) => at.enter_element(self.program, Index::Const(index)),
            PathStep::IndexBy {
                value,
                low,
                checked,
            } => {
                let subscript = Subscript {
                    value,
                    low,
                    checked,
                };
                let index;
                (index, test) = self.index(subscript, at.elements(self.program), None, span);
                at.enter_element(self.program, index);
            }
            PathStep::Character { value, checked } => {
                let length =
                    (!checked).then(|| at.in_memory().expect("strings").clone().field(LEN));
                at.enter_field(self.program, DATA);
                let subscript = Subscript {
                    value,
                    low: 1,
                    checked,
                };
                let index;
                (index, test) = self.index(subscript, at.elements(self.program), length, span);
                at.enter_element(self.program, index);
            }
            // A bit of a BOOL is the BOOL, and so on.
            PathStep::Bits { first, count } if elementary(at.ty).bits() == count => {
                assert_eq!(first, 0, "the bits are inside");
            }
            PathStep::Bits { first, count } => at.part = Part::Bits { first, count },
            PathStep::Bytes { offset, ty } => at.part = Part::Bytes { offset, ty },
        }
        test
    }

    /// Evaluates a subscript of an array of `len` elements and tests it, against what lies at `length`
    /// instead where that is given. Where a subscript outside does not fault, the index is outside as well.
    /// Gives the test with the index, if there was one.
    fn index(
        &mut self,
        subscript: Subscript,
        len: u32,
        length: Option<Place>,
        span: Span,
    ) -> (Index, Option<Value>) {
        let inside = self.integer(subscript.value).map(|number| {
            let offset = number - i128::from(subscript.low);
            u32::try_from(offset).ok().filter(|offset| *offset < len)
        });
        // A known subscript of a string is still to be tested against the length.
        if let (Some(Some(offset)), true) = (inside, length.is_none()) {
            return (Index::Const(offset), None);
        }
        let ty = self.code.expr(subscript.value).ty;
        let value = self.expr(subscript.value);
        let wide = needs_64_bits(ty, subscript.low, len);
        let (offset, sound) = self.offset(value, ty, subscript.low, wide);
        if subscript.checked && !wide {
            return (Index::Value(offset), None);
        }
        // What could be cut to an index inside, or is one and yet not meant, must not be used.
        let total = subscript.checked || !self.traps();
        let guard = total && (wide || length.is_some());
        let length = length.map(|length| self.builder.load(length, Type::I32));
        let inside = self.inside(offset, length, len, sound);
        if !subscript.checked {
            self.check(inside, FaultCode::Index, span);
        }
        let test = (!subscript.checked).then_some(inside);
        (Index::Value(self.narrow(offset, inside, guard)), test)
    }

    /// A subscript less the lower bound, in 32 or 64 bits; and what must hold besides, if anything.
    fn offset(
        &mut self,
        value: Value,
        ty: Elementary,
        low: i64,
        wide: bool,
    ) -> (Value, Option<Value>) {
        let width = if wide { Type::I64 } else { Type::I32 };
        let value = if !ty.is_signed() || self.builder.value_type(value) == width {
            resize(&mut self.builder, value, width)
        } else {
            self.builder.convert(ConvertOp::Sext, width, value)
        };
        if low == 0 {
            return (value, None);
        }
        let sound = (ty == Elementary::Ulint && low < 0).then(|| {
            let zero = self.builder.constant(width, 0);
            self.builder.compare(CompareOp::Sge, value, zero)
        });
        let low = self.builder.constant(width, low as u64);
        (self.builder.binary(BinaryOp::Sub, value, low), sound)
    }

    fn inside(
        &mut self,
        offset: Value,
        length: Option<Value>,
        len: u32,
        sound: Option<Value>,
    ) -> Value {
        let width = self.builder.value_type(offset);
        let limit = match length {
            Some(length) => resize(&mut self.builder, length, width),
            None => self.builder.constant(width, u64::from(len)),
        };
        let inside = self.builder.compare(CompareOp::Ult, offset, limit);
        match sound {
            Some(sound) => self.builder.binary(BinaryOp::And, inside, sound),
            None => inside,
        }
    }

    /// An offset as an index; -1 in place of one outside, if that is to be guarded against.
    fn narrow(&mut self, offset: Value, inside: Value, guard: bool) -> Value {
        let index = resize(&mut self.builder, offset, Type::I32);
        if !guard {
            return index;
        }
        let outside = self.builder.constant(Type::I32, u64::MAX);
        self.builder.select(inside, index, outside)
    }

    // ---- values ----

    /// The type of the elementary value at a place.
    pub(super) fn stored_type(&self, at: &Located) -> Type {
        match at.part {
            Part::Whole => scalar(elementary(at.ty)),
            Part::Bits { count, .. } => bit_string(count),
            Part::Bytes { ty, .. } => scalar(ty),
        }
    }

    /// The elementary value at a place that is not used again.
    pub(super) fn take(&mut self, at: Located) -> Value {
        match (at.base, at.part) {
            (Base::Memory(place), Part::Whole) => {
                self.builder.load(place, scalar(elementary(at.ty)))
            }
            (base, part) => self.read(&Located { base, part, ..at }),
        }
    }

    /// Stores an elementary value at a place that is not used again.
    pub(super) fn put(&mut self, at: Located, value: Value) {
        match (at.base, at.part) {
            (Base::Memory(place), Part::Whole) => self.builder.store(place, value),
            (base, part) => self.write(&Located { base, part, ..at }, value),
        }
    }

    /// The elementary value at a place.
    pub(super) fn read(&mut self, at: &Located) -> Value {
        if let Some(bit) = at.bit() {
            return self.builder.load(bit, Type::I1);
        }
        match at.part {
            Part::Whole => self.read_whole(at),
            Part::Bits { first, count } => {
                let word = self.read_whole(at);
                let shifted = self.shift_by(BinaryOp::Ushr, word, first);
                resize(&mut self.builder, shifted, bit_string(count))
            }
            Part::Bytes { offset, ty } => self.read_bytes(at, offset, ty),
        }
    }

    fn read_whole(&mut self, at: &Located) -> Value {
        match &at.base {
            Base::Variable(variable) => self.builder.read(*variable),
            Base::Memory(place) => self.builder.load(place.clone(), scalar(elementary(at.ty))),
        }
    }

    /// Stores an elementary value at a place.
    pub(super) fn write(&mut self, at: &Located, value: Value) {
        if let Some(bit) = at.bit() {
            return self.builder.store(bit, value);
        }
        match at.part {
            Part::Whole => self.write_whole(at, value),
            Part::Bits { first, count } => self.write_bits(at, (first, count), value),
            Part::Bytes { offset, ty } => self.write_bytes(at, offset, ty, value),
        }
    }

    fn write_whole(&mut self, at: &Located, value: Value) {
        match &at.base {
            Base::Variable(variable) => self.builder.assign(*variable, value),
            Base::Memory(place) => self.builder.store(place.clone(), value),
        }
    }

    fn write_bits(&mut self, at: &Located, (first, count): (u32, u32), value: Value) {
        let word = self.read_whole(at);
        let ty = self.builder.value_type(word);
        let mask = (u64::MAX >> (64 - count)) << first;
        let others = self.builder.constant(ty, !mask);
        let kept = self.builder.binary(BinaryOp::And, word, others);
        let wide = resize(&mut self.builder, value, ty);
        let placed = self.shift_by(BinaryOp::Shl, wide, first);
        let new = self.builder.binary(BinaryOp::Or, kept, placed);
        self.write_whole(at, new);
    }

    fn shift_by(&mut self, op: BinaryOp, value: Value, count: u32) -> Value {
        if count == 0 {
            return value;
        }
        let ty = self.builder.value_type(value);
        let count = self.builder.constant(ty, u64::from(count));
        self.builder.binary(op, value, count)
    }

    fn read_bytes(&mut self, at: &Located, offset: u32, ty: Elementary) -> Value {
        let (ir, place) = (scalar(ty), at.in_memory().expect("arrays lie in memory"));
        let bits = bits_type(ir);
        let mut whole = None;
        for byte in 0..ir.bytes() {
            let from = place.clone().index(Index::Const(offset + byte));
            let part = self.builder.load(from, Type::I8);
            let wide = resize(&mut self.builder, part, bits);
            let placed = self.shift_by(BinaryOp::Shl, wide, 8 * byte);
            whole = Some(match whole {
                Some(lower) => self.builder.binary(BinaryOp::Or, lower, placed),
                None => placed,
            });
        }
        let whole = whole.expect("a value has bytes");
        if ir.is_float() {
            self.builder.convert(ConvertOp::BitsFloat, ir, whole)
        } else {
            whole
        }
    }

    fn write_bytes(&mut self, at: &Located, offset: u32, ty: Elementary, value: Value) {
        let place = at.in_memory().expect("arrays lie in memory");
        let bits = float_bits(&mut self.builder, value);
        for byte in 0..scalar(ty).bytes() {
            let shifted = self.shift_by(BinaryOp::Ushr, bits, 8 * byte);
            let part = resize(&mut self.builder, shifted, Type::I8);
            let to = place.clone().index(Index::Const(offset + byte));
            self.builder.store(to, part);
        }
    }
}

impl Located {
    pub(super) fn memory(place: Place, ty: hir::Type) -> Self {
        Self {
            base: Base::Memory(place),
            ty,
            part: Part::Whole,
        }
    }

    /// The place, if it is one in memory.
    pub(super) fn in_memory(&self) -> Option<&Place> {
        match &self.base {
            Base::Memory(place) => Some(place),
            Base::Variable(_) => None,
        }
    }

    /// The place of a single bit in memory.
    fn bit(&self) -> Option<Place> {
        match (&self.base, self.part) {
            (Base::Memory(place), Part::Bits { first, count: 1 }) => {
                Some(place.clone().bit(Index::Const(first)))
            }
            (Base::Memory(_) | Base::Variable(_), _) => None,
        }
    }

    pub(super) fn enter_field(&mut self, program: &hir::Program, field: u32) {
        let (hir::Type::Struct(id), Base::Memory(place)) = (self.ty, &mut self.base) else {
            panic!("members are those of structures")
        };
        place.path.push(iecc_ir::Projection::Field(field));
        self.ty = program.types.struct_def(id).members[field as usize].ty;
    }

    pub(super) fn enter_element(&mut self, program: &hir::Program, index: Index) {
        let (hir::Type::Array(id), Base::Memory(place)) = (self.ty, &mut self.base) else {
            panic!("elements are those of arrays")
        };
        place.path.push(iecc_ir::Projection::Index(index));
        self.ty = program.types.array_def(id).element;
    }

    /// How many elements the array has.
    fn elements(&self, program: &hir::Program) -> u32 {
        match self.ty {
            hir::Type::Array(id) => program.types.array_def(id).len,
            hir::Type::Struct(_) | hir::Type::Elementary(_) => {
                panic!("elements are those of arrays")
            }
        }
    }
}

/// Whether offsets from `low` cannot be told apart in 32 bits.
fn needs_64_bits(ty: Elementary, low: i64, len: u32) -> bool {
    let top = low.saturating_add(i64::from(len) - 1);
    let fits = i32::try_from(low).is_ok() && i32::try_from(top).is_ok();
    ty.bits() > 32 || !fits || (ty == Elementary::Udint && low < 0)
}

fn bit_string(count: u32) -> Type {
    match count {
        1 => Type::I1,
        8 => Type::I8,
        16 => Type::I16,
        32 => Type::I32,
        _ => panic!("parts have 1, 8, 16 or 32 bits"),
    }
}
