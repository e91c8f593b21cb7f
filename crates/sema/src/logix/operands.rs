//! Operands: from what is written to what an instruction of the table wants there.

use super::Analysis;
use super::reference::elementary;
use crate::hir::{Const, Elementary, Operand, Place, StructKind, Type};
use iecc_ast::RealText;
use iecc_ast::rung::{self, Expr, ExprKind, IntLiteral, IntSuffix, OperandKind, Radix, UnaryOp};
use iecc_diag::{Code, Diagnostic};
use iecc_source::Span;

/// An operand in its place: which instruction, which of its operands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slot<'a> {
    /// The program whose names are seen.
    pub(crate) program: Option<usize>,
    /// The mnemonic as spelled.
    pub(crate) instruction: &'a str,
    /// The operand's name in messages.
    pub(crate) name: &'a str,
    /// What is written.
    pub(crate) operand: &'a rung::Operand,
}

impl Slot<'_> {
    fn span(&self) -> Span {
        self.operand.span
    }

    fn wants(&self, wanted: &str, found: &str) -> Diagnostic {
        let message = format!(
            "the {} of {} is {found}, but {wanted} is expected",
            self.name, self.instruction
        );
        Diagnostic::new(Code::E2001, self.span(), message)
    }
}

impl Analysis<'_> {
    /// A BOOL or a bit.
    pub(crate) fn bit_operand(&mut self, slot: Slot<'_>) -> Option<Place> {
        let place = self.place_operand(slot, "a bit")?;
        let ty = self.type_of(&place);
        if ty == Type::Elementary(Elementary::Bool) {
            return Some(place);
        }
        let mut diagnostic = slot.wants("a bit", &self.describe(&place, ty));
        if elementary(ty).is_some_and(Elementary::is_integer) {
            diagnostic = diagnostic.note("name one of its bits, as in `.0`");
        }
        self.report(diagnostic);
        None
    }

    /// A BOOL or a bit that is written.
    pub(crate) fn bit_target(&mut self, slot: Slot<'_>) -> Option<Place> {
        let place = self.bit_operand(slot)?;
        self.check_write(&place, slot.span());
        Some(place)
    }

    /// A number.
    pub(crate) fn number_operand(&mut self, slot: Slot<'_>) -> Option<Operand> {
        if let Some(literal) = literal_of(slot.operand) {
            return self.literal(literal).map(Operand::Const);
        }
        let place = self.place_operand(slot, "a number")?;
        let ty = self.type_of(&place);
        match elementary(ty) {
            Some(ty) if ty.is_number() => Some(Operand::Place(place, ty)),
            Some(_) | None => {
                let found = self.describe(&place, ty);
                self.report(slot.wants("a number", &found));
                None
            }
        }
    }

    /// A whole number.
    pub(crate) fn integer_operand(&mut self, slot: Slot<'_>) -> Option<Operand> {
        let operand = self.number_operand(slot)?;
        if operand.ty().is_integer() {
            return Some(operand);
        }
        let found = match &operand {
            Operand::Const(_) => "a floating-point number".to_owned(),
            Operand::Place(place, ty) => self.describe(place, Type::Elementary(*ty)),
        };
        self.report(slot.wants("a whole number", &found));
        None
    }

    /// A number that is written.
    pub(crate) fn number_target(&mut self, slot: Slot<'_>) -> Option<(Place, Elementary)> {
        if literal_of(slot.operand).is_some() {
            self.report(slot.wants("a tag", "a value that cannot be changed"));
            return None;
        }
        match self.number_operand(slot)? {
            Operand::Place(place, ty) => {
                self.check_write(&place, slot.span());
                Some((place, ty))
            }
            Operand::Const(_) => unreachable!("literals were refused"),
        }
    }

    /// A whole number that is written.
    pub(crate) fn integer_target(&mut self, slot: Slot<'_>) -> Option<(Place, Elementary)> {
        let (place, ty) = self.number_target(slot)?;
        if ty.is_integer() {
            return Some((place, ty));
        }
        let found = self.describe(&place, Type::Elementary(ty));
        self.report(slot.wants("a whole number", &found));
        None
    }

    /// A structure of one of these kinds.
    pub(crate) fn structure(
        &mut self,
        slot: Slot<'_>,
        wanted: &str,
        kinds: &[StructKind],
    ) -> Option<(Place, StructKind)> {
        let place = self.place_operand(slot, wanted)?;
        let ty = self.type_of(&place);
        match self.types.table.struct_kind(ty) {
            Some(kind) if kinds.contains(&kind) => Some((place, kind)),
            Some(_) | None => {
                let found = self.describe(&place, ty);
                self.report(slot.wants(wanted, &found));
                None
            }
        }
    }

    /// A reference of any type.
    pub(crate) fn place_operand(&mut self, slot: Slot<'_>, wanted: &str) -> Option<Place> {
        let found = match &slot.operand.kind {
            OperandKind::Expr(Expr {
                kind: ExprKind::Reference(reference),
                ..
            }) => return self.place(slot.program, reference),
            OperandKind::Expr(expr) => match expr.kind {
                ExprKind::Int(_) | ExprKind::Real(_) => format!("the number `{expr}`"),
                ExprKind::String(_) => {
                    self.report(refused_operand(slot, "a string"));
                    return None;
                }
                ExprKind::Unary { .. } | ExprKind::Binary { .. } | ExprKind::Call { .. } => {
                    format!("the expression `{expr}`")
                }
                ExprKind::Reference(_) => unreachable!("taken above"),
            },
            OperandKind::Empty => "left out".to_owned(),
            OperandKind::InTag => "`?`".to_owned(),
            OperandKind::Words(words) => format!("`{words}`"),
        };
        self.report(slot.wants(wanted, &found));
        None
    }

    /// The value of a literal; reports when it does not fit.
    pub(crate) fn literal(&mut self, literal: Literal<'_>) -> Option<Const> {
        match literal.number {
            Number::Real(text) => {
                let sign = if literal.negative { -1.0 } else { 1.0 };
                Some(Const::Float {
                    single: sign * text.to_f32(),
                    double: f64::from(sign) * text.to_f64(),
                })
            }
            Number::Int(number) => {
                let constant = integer(literal.negative, number);
                if constant.is_none() {
                    let expr = literal.expr;
                    let message = format!("`{expr}` does not fit its type");
                    self.report(
                        Diagnostic::new(Code::E2005, expr.span, message)
                            .note("without a suffix, numbers have the 32 bits of a DINT"),
                    );
                }
                constant
            }
        }
    }
}

/// A number as it is written in an operand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Literal<'e> {
    expr: &'e Expr,
    negative: bool,
    number: Number<'e>,
}

#[derive(Debug, Clone, Copy)]
enum Number<'e> {
    Int(IntLiteral),
    Real(&'e RealText),
}

/// A feature that is refused for now, in an operand.
fn refused_operand(slot: Slot<'_>, what: &str) -> Diagnostic {
    let message = format!(
        "the {} of {} is {what}, which is not compiled yet",
        slot.name, slot.instruction
    );
    Diagnostic::new(Code::E5033, slot.span(), message)
}

/// The number an operand is, with or without a minus sign.
pub(crate) fn literal_of(operand: &rung::Operand) -> Option<Literal<'_>> {
    let OperandKind::Expr(expr) = &operand.kind else {
        return None;
    };
    let (negative, magnitude) = match &expr.kind {
        ExprKind::Unary { op, operand } if op.node == UnaryOp::Negate => (true, operand.as_ref()),
        ExprKind::Int(_)
        | ExprKind::Real(_)
        | ExprKind::String(_)
        | ExprKind::Reference(_)
        | ExprKind::Unary { .. }
        | ExprKind::Binary { .. }
        | ExprKind::Call { .. } => (false, expr),
    };
    let number = match &magnitude.kind {
        ExprKind::Int(literal) => Number::Int(*literal),
        ExprKind::Real(text) => Number::Real(text),
        ExprKind::String(_)
        | ExprKind::Reference(_)
        | ExprKind::Unary { .. }
        | ExprKind::Binary { .. }
        | ExprKind::Call { .. } => return None,
    };
    Some(Literal {
        expr,
        negative,
        number,
    })
}

/// A decimal literal is a signed number; others are bit patterns filled with 0.
fn integer(negative: bool, literal: IntLiteral) -> Option<Const> {
    let ty = match literal.suffix {
        None => Elementary::Dint,
        Some(IntSuffix::Unsigned) => Elementary::Udint,
        Some(IntSuffix::Long) => Elementary::Lint,
        Some(IntSuffix::UnsignedLong) => Elementary::Ulint,
    };
    let mask = u64::MAX >> (64 - ty.bits());
    let pattern = literal.radix != Radix::Decimal || !ty.is_signed();
    let limit = match (pattern, negative) {
        (true, _) => mask,
        (false, false) => mask >> 1,
        (false, true) => (mask >> 1) + 1,
    };
    let value = if negative {
        literal.value.wrapping_neg()
    } else {
        literal.value
    };
    (literal.value <= limit).then_some(Const::Integer {
        ty,
        bits: value & mask,
    })
}
