//! Literals, with and without a type in front.

use super::{Body, Operand};
use crate::st::constant::{Const, round_to};
use crate::st::elementary::El;
use crate::st::types::{ReferenceKind, TypeId, TypeKind};
use iecc_ast::st::{self, ExprKind, Literal, TimeKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;
use std::rc::Rc;

impl Body<'_, '_> {
    /// A literal as it stands; numbers have no type yet.
    pub(super) fn literal(&mut self, literal: &Literal, range: TextRange) -> Operand {
        let (value, ty) = match literal {
            Literal::Bool(value) => (Const::Int(i128::from(*value)), TypeId::BOOL),
            Literal::Int(int) => {
                let value = i128::from(int.value);
                let value = if int.negative { -value } else { value };
                (Const::Int(value), TypeId::UNTYPED_INT)
            }
            Literal::Real { negative, digits } => {
                let (mut single, mut double) = (digits.to_f32(), digits.to_f64());
                if *negative {
                    (single, double) = (-single, -double);
                }
                (Const::Literal(single, double), TypeId::UNTYPED_REAL)
            }
            Literal::String(string) => {
                let units: Rc<[u16]> = string.units.iter().copied().collect();
                let ty = self.an.types.intern(TypeKind::Text {
                    wide: string.double,
                    length: units.len() as u32,
                });
                (Const::Text(units), ty)
            }
            Literal::Time(time) => {
                let el = match time.kind {
                    TimeKind::Time => El::Time,
                    TimeKind::LongTime => El::Ltime,
                    TimeKind::Date => El::Date,
                    TimeKind::LongDate => El::Ldate,
                    TimeKind::TimeOfDay => El::Tod,
                    TimeKind::LongTimeOfDay => El::Ltod,
                    TimeKind::DateTime => El::Dt,
                    TimeKind::LongDateTime => El::Ldt,
                };
                (Const::Int(i128::from(time.ns)), TypeId::of(el))
            }
        };
        Operand::constant(value, ty, range)
    }

    /// `TYPE#value`.
    pub(super) fn typed_literal(
        &mut self,
        ty: st::Id<st::Expr>,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) -> Operand {
        let scope = self.type_scope();
        let ty = self.an.type_by_path(scope, ty);
        if ty == TypeId::ERROR {
            return Operand::error(range);
        }
        let arena = self.arena();
        if let Some(name) = arena[value].kind.name() {
            return self.enumerator_of(ty, name, range);
        }
        let operand = if let ExprKind::Literal(id) = arena[value].kind {
            self.literal(&arena[id], range)
        } else {
            self.expr(value, Some(ty))
        };
        self.literal_as(operand, ty)
    }

    /// A literal in a type that is written in front of it.
    fn literal_as(&mut self, literal: Operand, ty: TypeId) -> Operand {
        if literal.is_error() {
            return literal;
        }
        let range = literal.range;
        match (self.an.types.base(ty).clone(), literal.as_const()) {
            (TypeKind::Text { wide, .. }, Some(Const::Text(units))) => {
                let length = units.len() as u32;
                let ty = self.an.types.intern(TypeKind::Text { wide, length });
                Operand::constant(Const::Text(units.clone()), ty, range)
            }
            _ => match self.constant_to(&literal, ty) {
                Some(value) => Operand::constant(value, ty, range),
                None => Operand::error(range),
            },
        }
    }

    /// A constant in another type, or a message why not.
    pub(crate) fn constant_to(&mut self, from: &Operand, to: TypeId) -> Option<Const> {
        if from.is_error() || to == TypeId::ERROR {
            return None;
        }
        let value = from.as_const()?.clone();
        let target = self.an.types.base(to).clone();
        let untyped = matches!(from.ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
        match (&target, &value) {
            (TypeKind::Subrange { base, low, high }, _) => {
                let (low, high) = (*low, *high);
                let value = self.constant_to(from, TypeId::of(*base))?;
                let number = value.as_int()?;
                if (low..=high).contains(&number) {
                    return Some(value);
                }
                let message = format!("{number} is not between {low} and {high}");
                self.error(Message::E2026, from.range, message);
                None
            }
            (TypeKind::Elementary(el), Const::Int(number)) if untyped => {
                self.int_literal(*number, *el, from.range)
            }
            (TypeKind::Elementary(El::Real), Const::Literal(single, _)) => {
                self.finite(f64::from(*single), El::Real, from.range)
            }
            (TypeKind::Elementary(El::Lreal), Const::Literal(_, double)) => {
                self.finite(*double, El::Lreal, from.range)
            }
            (TypeKind::Elementary(el), Const::Real(number)) if untyped && el.is_real() => {
                self.finite(round_to(*el, *number), *el, from.range)
            }
            (TypeKind::Elementary(el @ (El::Char | El::Wchar)), Const::Text(units)) => {
                match units.as_ref() {
                    [unit] if *el == El::Wchar || *unit < 256 => {
                        Some(Const::Int(i128::from(*unit)))
                    }
                    _ => {
                        let message = format!("{} holds exactly one character", el.name());
                        self.error(Message::E2005, from.range, message);
                        None
                    }
                }
            }
            (TypeKind::Text { wide, .. }, Const::Text(units)) => {
                let narrow = self.an.types.base(from.ty).clone();
                let from_wide = matches!(narrow, TypeKind::Text { wide: true, .. });
                if *wide == from_wide {
                    return Some(Const::Text(units.clone()));
                }
                self.mismatch(from, to);
                None
            }
            (TypeKind::Text { wide, .. }, Const::Int(unit))
                if self.character_width(from) == Some(*wide) =>
            {
                Some(Const::Text(Rc::from([*unit as u16])))
            }
            (TypeKind::Reference(..) | TypeKind::Interface(_), Const::Null) => Some(Const::Null),
            (
                TypeKind::Reference(ReferenceKind::Pointer | ReferenceKind::RefTo, _)
                | TypeKind::Interface(_),
                Const::Int(0),
            ) if untyped && self.an.options.codesys => Some(Const::Null),
            (TypeKind::Enum(index), Const::Int(number)) if untyped => {
                let def = &self.an.types.enums[*index as usize];
                if def.named_values {
                    let base = def.base;
                    return self.int_literal(*number, base, from.range);
                }
                self.mismatch(from, to);
                None
            }
            _ => self.typed_constant_to(from, &value, to),
        }
    }

    /// A constant that has a type already.
    fn typed_constant_to(&mut self, from: &Operand, value: &Const, to: TypeId) -> Option<Const> {
        let types = &self.an.types;
        if types.strip(from.ty) == types.strip(to) {
            return Some(value.clone());
        }
        match (self.number_behind(from.ty), types.elementary(to)) {
            (Some(a), Some(b)) if self.widens(a, b) => Some(match value {
                Const::Int(number) if b.is_real() => Const::Real(round_to(b, *number as f64)),
                Const::Int(_)
                | Const::Real(_)
                | Const::Literal(..)
                | Const::Text(_)
                | Const::Null => value.clone(),
            }),
            (Some(a), Some(b)) if self.an.options.codesys && self.counts(a) && self.counts(b) => {
                // A constant that fits loses nothing.
                self.fitting_constant(from, value, b, to)
            }
            _ => {
                self.mismatch(from, to);
                None
            }
        }
    }

    fn fitting_constant(
        &mut self,
        from: &Operand,
        value: &Const,
        el: El,
        to: TypeId,
    ) -> Option<Const> {
        let (low, high) = el.range();
        let fits = |number: i128| (low..=high).contains(&number);
        if value.as_int().is_some_and(fits) {
            return Some(value.clone());
        }
        self.mismatch(from, to);
        None
    }

    /// A whole number literal in an elementary type.
    fn int_literal(&mut self, number: i128, el: El, range: TextRange) -> Option<Const> {
        if el.is_real() {
            return Some(Const::Real(if el == El::Real {
                f64::from(number as f32)
            } else {
                number as f64
            }));
        }
        if !(el.is_int() || el.is_bits()) {
            let message = format!("a number is no {}", el.name());
            let mut diagnostic = Diagnostic::new(Message::E2020, self.span(range), message);
            if el.is_duration() {
                let note = format!("a duration has a unit: T#{number}ms, T#{number}s");
                diagnostic = diagnostic.note(note);
            }
            self.report(diagnostic);
            return None;
        }
        let (low, high) = el.range();
        if (low..=high).contains(&number) {
            return Some(Const::Int(number));
        }
        let message = format!("{number} does not fit {} ({low} to {high})", el.name());
        self.error(Message::E2005, range, message);
        None
    }

    fn finite(&mut self, number: f64, el: El, range: TextRange) -> Option<Const> {
        if number.is_finite() {
            return Some(Const::Real(number));
        }
        self.error(
            Message::E2005,
            range,
            format!("the number does not fit {}", el.name()),
        );
        None
    }
}
