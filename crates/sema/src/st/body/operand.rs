//! What an expression is before someone needs it: a constant, a value, or a place.

use crate::hir::code::{ExprId, PathStep, Root};
use crate::st::constant::Const;
use crate::st::types::TypeId;
use iecc_source::TextRange;

/// An expression that was looked at.
#[derive(Debug, Clone)]
pub(crate) struct Operand {
    /// What it is.
    pub kind: OperandKind,
    /// Its type.
    pub ty: TypeId,
    /// Where it is written, in the unit.
    pub range: TextRange,
}

/// What an operand is.
#[derive(Debug, Clone)]
pub(crate) enum OperandKind {
    /// A message has been given.
    Error,
    /// A known value.
    Const(Const),
    /// A number that is computed.
    Value(ExprId),
    /// Something in storage.
    Place(Place),
}

/// Something in storage.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    /// Where it begins.
    pub root: Root,
    /// The way from there.
    pub steps: Vec<PathStep>,
    /// What may be done with it.
    pub rights: Rights,
}

/// What may be done with a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rights {
    /// Everything.
    All,
    /// It is a constant.
    Constant,
    /// It is an input of the unit itself.
    OwnInput,
    /// It is an output of an instance, seen from outside.
    OtherOutput,
    /// It is an intermediate result.
    Temporary,
    /// It is the value of a property, a copy.
    Value,
}

impl Operand {
    /// What stands for a mistake.
    pub(crate) fn error(range: TextRange) -> Self {
        Self {
            kind: OperandKind::Error,
            ty: TypeId::ERROR,
            range,
        }
    }

    /// What a call without a result gives.
    pub(crate) fn nothing(range: TextRange) -> Self {
        Self {
            kind: OperandKind::Const(Const::Null),
            ty: TypeId::NOTHING,
            range,
        }
    }

    /// A known value.
    pub(crate) fn constant(value: Const, ty: TypeId, range: TextRange) -> Self {
        Self {
            kind: OperandKind::Const(value),
            ty,
            range,
        }
    }

    /// A computed number.
    pub(crate) fn value(expr: ExprId, ty: TypeId, range: TextRange) -> Self {
        Self {
            kind: OperandKind::Value(expr),
            ty,
            range,
        }
    }

    /// Whether a message has been given.
    pub(crate) fn is_error(&self) -> bool {
        self.ty == TypeId::ERROR || matches!(self.kind, OperandKind::Error)
    }

    /// The value, if it is known.
    pub(crate) fn as_const(&self) -> Option<&Const> {
        match &self.kind {
            OperandKind::Const(value) => Some(value),
            OperandKind::Error | OperandKind::Value(_) | OperandKind::Place(_) => None,
        }
    }
}
