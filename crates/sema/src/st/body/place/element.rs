//! Parts of a value: elements of arrays, characters of strings, bits of bit strings.

use crate::hir::code::{BinaryOp, Conversion, ExprKind, PathStep};
use crate::st::body::place::enter_bits;
use crate::st::body::{Body, Operand, OperandKind};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::types::{Parts, TypeId, TypeKind};
use iecc_ast::st::{self, AddressSize, Part};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// `base[i, j]`, of arrays and strings.
    pub(crate) fn index(
        &mut self,
        base: st::Id<st::Expr>,
        indices: st::List<st::Id<st::Expr>>,
        range: TextRange,
    ) -> Operand {
        let mut at = self.place_or_shared(base, None);
        if let TypeKind::Array {
            dimensions,
            element,
        } = self.an.types.base(at.ty)
            && (indices.len() < dimensions.len()
                || indices.len() > dimensions.len() && self.an.types.is_scalar(*element))
        {
            let (needed, given) = (dimensions.len(), indices.len());
            let message =
                format!("the array has {needed} dimensions but {given} subscripts are given");
            at = self.error(Message::E2004, range, message);
        }
        for &index in &self.arena()[indices] {
            if at.is_error() {
                // Mistakes in the other subscripts are still reported.
                self.expr(index, None);
                continue;
            }
            at = self.element(at, index, range);
        }
        Operand { range, ..at }
    }

    /// One element of an array, or one character of a string.
    fn element(&mut self, base: Operand, index: st::Id<st::Expr>, range: TextRange) -> Operand {
        let OperandKind::Place(place) = &base.kind else {
            let message = format!("{} has no elements", self.type_name(base.ty));
            return self.error(Message::E2031, base.range, message);
        };
        let shared = is_shared(&base.kind);
        let mut place = place.clone();
        let found = match self.an.types.base(base.ty).clone() {
            TypeKind::Array {
                dimensions,
                element,
            } => self.array_element(&dimensions, element, index),
            TypeKind::Text { wide, length } => self.character(wide, length, index),
            TypeKind::Reference(..) if self.an.options.codesys => {
                self.no_arithmetic("a subscript computes with a pointer", range);
                None
            }
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::Elementary(_)
            | TypeKind::Enum(_)
            | TypeKind::Subrange { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Struct(_)
            | TypeKind::Instance(_)
            | TypeKind::Interface(_)
            | TypeKind::Reference(..)
            | TypeKind::Alias(_) => {
                let message = format!("{} has no elements", self.type_name(base.ty));
                return self.error(Message::E2031, base.range, message);
            }
        };
        let Some((step, ty)) = found else {
            return Operand::error(range);
        };
        if !shared {
            place.steps.push(step);
        } else if !self.enter_shared(&mut place.steps, step, ty) {
            let range = self.arena()[index].range;
            let message = "a computed subscript of an array that shares its bytes with others is not compiled yet";
            return self.error(Message::E2010, range, message);
        }
        self.place_operand(place.root, place.steps, place.rights, ty, range)
    }

    /// The step to an element of the first dimension, and what lies there.
    fn array_element(
        &mut self,
        dimensions: &[(i64, i64)],
        element: TypeId,
        index: st::Id<st::Expr>,
    ) -> Option<(PathStep, TypeId)> {
        let (first, inner) = dimensions.split_first().expect("at least one dimension");
        let step = self.subscript(index, *first)?;
        if inner.is_empty() {
            return Some((step, element));
        }
        let ty = self.an.types.intern(TypeKind::Array {
            dimensions: inner.into(),
            element,
        });
        Some((step, ty))
    }

    /// The step to a character of a string, counted from 1.
    fn character(
        &mut self,
        wide: bool,
        length: u32,
        index: st::Id<st::Expr>,
    ) -> Option<(PathStep, TypeId)> {
        let range = self.arena()[index].range;
        let operand = self.expr(index, None);
        if operand.is_error() || !self.integer_index(&operand) {
            return None;
        }
        if let Some(Const::Int(value)) = operand.as_const()
            && !(1..=i128::from(length)).contains(value)
        {
            let message = format!("position {value} is not between 1 and {length}");
            self.error(Message::E2002, range, message);
            return None;
        }
        let checked = self.unchecked();
        let value = self.raw(&operand);
        let el = if wide { El::Wchar } else { El::Char };
        Some((PathStep::Character { value, checked }, TypeId::of(el)))
    }

    /// The smallest and largest value of a type of whole numbers.
    fn whole_values(&self, ty: TypeId) -> Option<(i128, i128)> {
        if let Some((_, values)) = self.an.types.subrange(ty) {
            return Some(values.into_inner());
        }
        let el = self.an.types.elementary(ty)?;
        self.counts(el).then(|| el.range())
    }

    /// Goes on to an element of an array that shares its bytes, unless the subscript is computed.
    fn enter_shared(&mut self, steps: &mut Vec<PathStep>, step: PathStep, ty: TypeId) -> bool {
        let (PathStep::Index(index), Some(PathStep::Bytes { offset, .. })) = (step, steps.pop())
        else {
            return false;
        };
        let storage = self.an.storage(ty);
        let first = u64::from(offset) * 8 + u64::from(index) * self.an.width(storage);
        // It is no array that is all of the bytes.
        steps.extend(self.an.shared_steps(first as u32, 0, ty));
        true
    }

    /// What can be used as a whole: not an array that shares its bytes.
    pub(crate) fn as_one(&mut self, operand: Operand) -> Operand {
        let array = matches!(self.an.types.parts(operand.ty), Parts::Elements { .. });
        if !array || !is_shared(&operand.kind) {
            return operand;
        }
        let message = "an array that shares its bytes with others is not compiled as a whole yet, only its elements";
        self.error(Message::E2010, operand.range, message)
    }

    /// The step to an element.
    fn subscript(&mut self, index: st::Id<st::Expr>, (low, high): (i64, i64)) -> Option<PathStep> {
        let operand = self.expr(index, None);
        if operand.is_error() || !self.integer_index(&operand) {
            return None;
        }
        if let Some(Const::Int(value)) = operand.as_const() {
            let value = *value;
            if !(i128::from(low)..=i128::from(high)).contains(&value) {
                let message = format!("subscript {value} is not between {low} and {high}");
                self.error(Message::E2002, operand.range, message);
                return None;
            }
            return Some(PathStep::Index((value - i128::from(low)) as u32));
        }
        let inside = self
            .whole_values(operand.ty)
            .is_some_and(|(first, last)| i128::from(low) <= first && last <= i128::from(high));
        let checked = inside || self.unchecked();
        let value = self.raw(&operand);
        Some(PathStep::IndexBy {
            value,
            low,
            checked,
        })
    }

    fn integer_index(&mut self, operand: &Operand) -> bool {
        let ty = operand.ty;
        if self.is_whole(operand) {
            return true;
        }
        let message = format!("a subscript is an integer, not {}", self.type_name(ty));
        self.error(Message::E2032, operand.range, message);
        false
    }

    /// Whether the unit is library code that says its subscripts are right.
    fn unchecked(&self) -> bool {
        self.an.is_library(self.unit)
            && self
                .an
                .unit(self.unit)
                .pragmas
                .iter()
                .any(|p| p.text.contains("unchecked"))
    }

    /// `base.%B1`, `base.3`.
    pub(crate) fn part(&mut self, base: st::Id<st::Expr>, part: Part, range: TextRange) -> Operand {
        let base = self.place(base, None);
        if base.is_error() {
            return base;
        }
        let Some(el) = self.an.types.elementary(base.ty).filter(|el| {
            (el.is_bits() && *el != El::Bool) || (self.an.options.codesys && el.is_int())
        }) else {
            let message = format!("{} has no bits that have a name", self.type_name(base.ty));
            return self.error(Message::E2033, range, message);
        };
        let (count, ty) = match part.size {
            AddressSize::Bit => (1, El::Bool),
            AddressSize::Byte => (8, El::Byte),
            AddressSize::Word => (16, El::Word),
            AddressSize::DoubleWord => (32, El::Dword),
            AddressSize::LongWord => (64, El::Lword),
        };
        let first = u64::from(part.index) * u64::from(count);
        if first + u64::from(count) > u64::from(el.bits()) || count == el.bits() {
            let message = format!("{} has no such part", el.name());
            return self.error(Message::E2003, range, message);
        }
        match &base.kind {
            OperandKind::Place(place) => {
                let (root, mut steps, rights) = (place.root, place.steps.clone(), place.rights);
                enter_bits(&mut steps, first as u32, count);
                self.place_operand(root, steps, rights, TypeId::of(ty), range)
            }
            OperandKind::Const(Const::Int(value)) => {
                let value = (value >> first) & ((1 << count) - 1);
                Operand::constant(Const::Int(value), TypeId::of(ty), range)
            }
            OperandKind::Value(value) => {
                let (value, storage) = (*value, el.storage());
                let by = self.add_const(first, crate::hir::Elementary::Udint, range);
                let kind = ExprKind::Binary(BinaryOp::ShiftRight, value, by);
                let value = self.add_expr(kind, storage, range);
                let kind = ExprKind::Convert(Conversion::Bits, value);
                let value = self.add_expr(kind, ty.storage(), range);
                Operand::value(value, TypeId::of(ty), range)
            }
            OperandKind::Const(_) | OperandKind::Error => Operand::error(range),
        }
    }
}

/// Whether an array is bytes that others share, see `shared_steps`.
fn is_shared(kind: &OperandKind) -> bool {
    matches!(kind, OperandKind::Place(place)
        if matches!(place.steps.last(), Some(PathStep::Bytes { .. })))
}
