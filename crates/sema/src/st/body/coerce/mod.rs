//! From what an operand is to what its use needs.

mod character;
mod convert;

use super::{Body, Operand, OperandKind, Place};
use crate::hir::code::Init;
use crate::hir::code::{Conversion, ExprId, ExprKind, PathId, StmtKind};
use crate::hir::{Elementary, InitId};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::types::{ReferenceKind, TypeId, TypeKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// Reports that an operand is of the wrong type, with the conversion that would help.
    pub(super) fn mismatch(&mut self, from: &Operand, to: TypeId) {
        if from.is_error() || to == TypeId::ERROR {
            return;
        }
        let message = format!(
            "this is {} but {} is needed",
            self.article(from.ty),
            self.article(to)
        );
        let span = self.span(from.range);
        let mut diagnostic = Diagnostic::new(Message::E2020, span, message);
        let types = &self.an.types;
        let pointer = |ty| matches!(types.base(ty), TypeKind::Reference(..));
        if self.an.options.codesys && pointer(from.ty) && pointer(to) {
            let note = "a pointer stands for a variable of its own type: what lies there is not looked at as another";
            diagnostic = diagnostic.note(note);
        }
        if let (TypeKind::Text { wide: a, .. }, TypeKind::Text { wide: b, .. }) =
            (types.base(from.ty), types.base(to))
            && a != b
        {
            diagnostic = diagnostic.note("`'text'` is a STRING, `\"text\"` a WSTRING");
        }
        if let (Some(a), Some(b)) = (types.elementary(from.ty), types.elementary(to)) {
            let function = format!("{}_TO_{}", a.short_name(), b.short_name());
            diagnostic = diagnostic.note(format!("{function} converts it, if that is meant"));
        }
        self.report(diagnostic);
    }

    fn article(&self, ty: TypeId) -> String {
        match ty {
            TypeId::UNTYPED_INT => "a whole number".to_owned(),
            TypeId::UNTYPED_REAL => "a real number".to_owned(),
            TypeId::NULL => "NULL".to_owned(),
            TypeId::NOTHING => "without a value".to_owned(),
            _ => {
                let name = self.type_name(ty);
                let vowel = name.starts_with(['A', 'E', 'I', 'O', 'a', 'e', 'i', 'o']);
                format!("{} {name}", if vowel { "an" } else { "a" })
            }
        }
    }

    /// The number that a use of a scalar type needs. After a mistake it is 0.
    pub(crate) fn as_scalar(&mut self, operand: &Operand, to: TypeId) -> ExprId {
        let storage = self.an.scalar(to);
        if operand.is_error() || to == TypeId::ERROR {
            return self.add_const(0, storage, operand.range);
        }
        match &operand.kind {
            OperandKind::Const(_) => {
                let value = self.constant_to(operand, to);
                self.const_expr(value.as_ref(), to, operand.range)
            }
            OperandKind::Value(_) | OperandKind::Place(_) => match self.convert(operand, to) {
                Some(expr) => expr,
                None => {
                    self.mismatch(operand, to);
                    self.add_const(0, storage, operand.range)
                }
            },
            OperandKind::Error => self.add_const(0, storage, operand.range),
        }
    }

    /// A constant of a type as code; 0 after a mistake.
    fn const_expr(&mut self, value: Option<&Const>, ty: TypeId, range: TextRange) -> ExprId {
        let bits = value.map_or(0, |value| self.const_bits(value, ty));
        let storage = self.an.scalar(ty);
        self.add_const(bits, storage, range)
    }

    pub(crate) fn const_bits(&mut self, value: &Const, ty: TypeId) -> u64 {
        value.bits(self.an.constant_type(ty).unwrap_or(El::Ulint))
    }

    /// A computed operand in another type, where that needs no asking.
    fn convert(&mut self, operand: &Operand, to: TypeId) -> Option<ExprId> {
        let (from_ty, to_ty) = (self.an.types.strip(operand.ty), self.an.types.strip(to));
        if from_ty == to_ty {
            return Some(self.raw(operand));
        }
        let types = &self.an.types;
        match (types.kind(from_ty).clone(), types.kind(to_ty).clone()) {
            (_, TypeKind::Subrange { base, low, high }) => {
                let from_el = types.elementary(from_ty)?;
                let known = types.subrange(from_ty);
                let inside =
                    known.is_some_and(|(_, given)| low <= *given.start() && *given.end() <= high);
                let value = self.widen(operand, from_el, base)?;
                if inside {
                    return Some(value);
                }
                let kind = ExprKind::Within {
                    value,
                    low: Const::Int(low).bits(base),
                    high: Const::Int(high).bits(base),
                };
                Some(self.add_expr(kind, base.storage(), operand.range))
            }
            (_, TypeKind::Interface(interface)) => self.interface_value(operand, interface),
            (_, TypeKind::Reference(ReferenceKind::Implicit, target)) => {
                self.passed_reference(operand, target)
            }
            (TypeKind::Reference(_, a), TypeKind::Reference(_, b)) if self.refers_alike(a, b) => {
                Some(self.raw(operand))
            }
            _ => {
                let (a, b) = (self.number_behind(from_ty)?, self.named_base(to_ty)?);
                self.widen(operand, a, b)
            }
        }
    }

    /// The elementary type that a value becomes without being asked: in CODESYS a value of an
    /// enumeration is a number where one is needed.
    pub(super) fn number_behind(&self, ty: TypeId) -> Option<El> {
        if self.an.options.codesys
            && let Some(enumeration) = self.an.types.enumeration(ty)
        {
            return Some(enumeration.base);
        }
        self.named_base(ty)
    }

    /// The elementary type behind a type, named values included.
    fn named_base(&self, ty: TypeId) -> Option<El> {
        self.an.types.elementary(ty)
    }

    fn widen(&mut self, operand: &Operand, from: El, to: El) -> Option<ExprId> {
        if !self.widens(from, to) {
            return None;
        }
        let value = self.raw(operand);
        if from.storage() == to.storage() {
            return Some(value);
        }
        let how = if from.is_bits() && !to.is_real() {
            Conversion::Bits
        } else {
            Conversion::Value
        };
        Some(self.add_expr(ExprKind::Convert(how, value), to.storage(), operand.range))
    }

    /// The number of a scalar operand in its own type; literals get the type they have by themselves.
    pub(crate) fn raw(&mut self, operand: &Operand) -> ExprId {
        match &operand.kind {
            OperandKind::Value(expr) => *expr,
            OperandKind::Const(_) => {
                let ty = self.settle(operand);
                let value = self.constant_to(operand, ty);
                self.const_expr(value.as_ref(), ty, operand.range)
            }
            OperandKind::Place(place) => {
                let (root, steps) = (place.root, place.steps.clone());
                let ty = self.an.scalar(operand.ty);
                let path = self.add_path(root, steps, operand.range);
                self.add_expr(ExprKind::Load(path), ty, operand.range)
            }
            OperandKind::Error => self.add_const(0, Elementary::Dint, operand.range),
        }
    }

    /// The type a literal has where nothing asks for one: the first of INT, DINT, LINT that holds
    /// it, REAL for fractions.
    pub(crate) fn settle(&self, operand: &Operand) -> TypeId {
        match (operand.ty, operand.as_const()) {
            (TypeId::UNTYPED_INT, Some(Const::Int(value))) => {
                let fits = |el: &&El| {
                    let (low, high) = el.range();
                    (low..=high).contains(value)
                };
                let candidates = [El::Int, El::Dint, El::Lint, El::Ulint];
                TypeId::of(*candidates.iter().find(fits).unwrap_or(&El::Lint))
            }
            (TypeId::UNTYPED_REAL, _) => TypeId::of(El::Real),
            (ty, _) => ty,
        }
    }

    /// Where a place is, for statements and calls.
    pub(crate) fn path_of(&mut self, place: &Place, range: TextRange) -> PathId {
        self.add_path(place.root, place.steps.clone(), range)
    }

    /// Stores an operand at a place of any type, with the conversions that need no asking.
    pub(crate) fn store(
        &mut self,
        target: &Place,
        ty: TypeId,
        operand: &Operand,
        range: TextRange,
    ) {
        if operand.is_error() || ty == TypeId::ERROR {
            return;
        }
        if self.an.types.is_scalar(ty) {
            let value = self.as_scalar(operand, ty);
            let path = self.path_of(target, range);
            self.before(StmtKind::Assign(path, value), range);
            return;
        }
        if let Some(text) = self.character_as_text(operand, ty) {
            return self.store(target, ty, &text, range);
        }
        match &operand.kind {
            OperandKind::Const(_) => {
                if let Some(value) = self.constant_to(operand, ty) {
                    let init = self.text_init(&value, ty);
                    let path = self.path_of(target, range);
                    self.before(StmtKind::Initialise(path, init), range);
                }
            }
            OperandKind::Place(from) => {
                let from = from.clone();
                self.copy(target, ty, &from, operand, range);
            }
            OperandKind::Value(_) | OperandKind::Error => self.mismatch(operand, ty),
        }
    }

    fn copy(
        &mut self,
        target: &Place,
        ty: TypeId,
        from: &Place,
        operand: &Operand,
        range: TextRange,
    ) {
        let same = self.an.types.strip(ty) == self.an.types.strip(operand.ty);
        if let (true, TypeKind::Instance(pou)) = (same, self.an.types.base(ty)) {
            let pou = *pou;
            self.copy_instance(pou, target, from, range);
            return;
        }
        if same {
            let to = self.path_of(target, range);
            let from = self.path_of(from, operand.range);
            self.before(StmtKind::Copy(to, from), range);
            return;
        }
        match (
            self.an.types.base(ty).clone(),
            self.an.types.base(operand.ty).clone(),
        ) {
            (TypeKind::Text { wide: a, .. }, TypeKind::Text { wide: b, .. }) if a == b => {
                self.copy_text(target, ty, from, operand, range);
            }
            _ => self.mismatch(operand, ty),
        }
    }

    /// The initial value of a string that holds these characters, as many as fit.
    pub(crate) fn text_init(&mut self, value: &Const, ty: TypeId) -> InitId {
        let Const::Text(units) = value else {
            return self.an.init(Init::Zero);
        };
        let TypeKind::Text { length, .. } = *self.an.types.base(ty) else {
            return self.an.init(Init::Zero);
        };
        let units = &units[..units.len().min(length as usize)];
        if units.is_empty() {
            return self.an.init(Init::Zero);
        }
        let len = self.an.init(Init::Bits(units.len() as u64));
        let mut runs = Vec::new();
        for (index, unit) in (0..).zip(units) {
            let value = self.an.init(Init::Bits(u64::from(*unit)));
            runs.push((index, 1, value));
        }
        let data = self.an.init(Init::Array(runs));
        self.an.init(Init::Struct(vec![(0, len), (1, data)]))
    }

    /// A condition.
    pub(super) fn condition(&mut self, operand: &Operand) -> ExprId {
        self.as_scalar(operand, TypeId::BOOL)
    }
}
