//! The generic type names of the standard, and which types belong to them.

use crate::st::elementary::{El, Family};
use crate::st::types::TypeId;

/// The generic names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Generic {
    Any,
    Elementary,
    Magnitude,
    Num,
    Real,
    Int,
    Unsigned,
    Signed,
    Duration,
    Bit,
    Chars,
    String,
    Char,
    Date,
}

impl Generic {
    pub(crate) const ALL: [(&'static str, Self); 14] = [
        ("ANY", Self::Any),
        ("ANY_ELEMENTARY", Self::Elementary),
        ("ANY_MAGNITUDE", Self::Magnitude),
        ("ANY_NUM", Self::Num),
        ("ANY_REAL", Self::Real),
        ("ANY_INT", Self::Int),
        ("ANY_UNSIGNED", Self::Unsigned),
        ("ANY_SIGNED", Self::Signed),
        ("ANY_DURATION", Self::Duration),
        ("ANY_BIT", Self::Bit),
        ("ANY_CHARS", Self::Chars),
        ("ANY_STRING", Self::String),
        ("ANY_CHAR", Self::Char),
        ("ANY_DATE", Self::Date),
    ];

    /// Whether an elementary type belongs to it.
    pub(crate) fn takes(self, el: El) -> bool {
        let family = el.family();
        match self {
            Self::Any | Self::Elementary => true,
            Self::Magnitude => el.is_num() || el.is_duration(),
            Self::Num => el.is_num(),
            Self::Real => el.is_real(),
            Self::Int => el.is_int(),
            Self::Unsigned => family == Family::Unsigned,
            Self::Signed => family == Family::Signed,
            Self::Duration => el.is_duration(),
            Self::Bit => el.is_bits(),
            Self::Chars | Self::Char => family == Family::Character,
            Self::String => false,
            Self::Date => el.is_date(),
        }
    }

    pub(crate) fn takes_text(self) -> bool {
        matches!(
            self,
            Self::Any | Self::Elementary | Self::Chars | Self::String
        )
    }

    pub(crate) fn takes_enum(self) -> bool {
        matches!(self, Self::Any | Self::Elementary)
    }

    pub(crate) fn takes_literal(self, ty: TypeId) -> bool {
        match self {
            Self::Any | Self::Elementary | Self::Magnitude | Self::Num | Self::Real => true,
            Self::Int | Self::Unsigned | Self::Signed | Self::Bit => ty == TypeId::UNTYPED_INT,
            Self::Duration | Self::Chars | Self::String | Self::Char | Self::Date => false,
        }
    }
}
