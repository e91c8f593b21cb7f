//! The one table of value operations.
//!
//! Printer, parser, verifier, interpreter and the generated documentation read it. Every operation
//! is total: it has a result for every operand. Operations that touch memory, time or other
//! functions are variants of [`InstData`](crate::InstData).

use crate::Type;
use std::fmt;

/// Which types an operation accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OperandClass {
    /// `i8 i16 i32 i64`: numbers.
    Int,
    /// `i1 i8 i16 i32 i64`: bit strings.
    Bits,
    /// `f32 f64`.
    Float,
}

impl OperandClass {
    /// Whether the class holds this type.
    pub fn accepts(self, ty: Type) -> bool {
        match self {
            Self::Int => ty.is_int() && ty != Type::I1,
            Self::Bits => ty.is_int(),
            Self::Float => ty.is_float(),
        }
    }
}

macro_rules! family {
    ($(#[$meta:meta])* $family:ident { $($variant:ident $name:literal $class:ident $meaning:literal;)* }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum $family {
            $(#[doc = $meaning] $variant,)*
        }

        impl $family {
            /// Every operation of the family, in the order of the table.
            pub const ALL: &'static [$family] = &[$(Self::$variant),*];

            /// The name in the text form.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The operand types it accepts.
            pub fn class(self) -> OperandClass {
                match self { $(Self::$variant => OperandClass::$class,)* }
            }

            /// What it computes, in one line.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }

            /// The operation with this name.
            pub fn parse(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|op| op.name() == name)
            }
        }

        impl fmt::Display for $family {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

family! {
    /// One operand; the result has its type.
    UnaryOp {
        Not "not" Bits "every bit inverted";
        Neg "neg" Int "0 - x, wrapping";
        Fneg "fneg" Float "sign inverted; NaN gives the canonical NaN";
        Fabs "fabs" Float "sign cleared; NaN gives the canonical NaN";
        Fsqrt "fsqrt" Float "square root, correctly rounded; negative gives the canonical NaN";
    }
}

family! {
    /// Two operands of one type; the result has that type.
    BinaryOp {
        Add "add" Int "wrapping sum";
        Sub "sub" Int "wrapping difference";
        Mul "mul" Int "wrapping product, low half";
        Sdiv "sdiv" Int "signed quotient, truncated; x / 0 = 0, MIN / -1 = MIN";
        Udiv "udiv" Int "unsigned quotient; x / 0 = 0";
        Srem "srem" Int "signed remainder with the sign of x; x rem 0 = x, MIN rem -1 = 0";
        Urem "urem" Int "unsigned remainder; x rem 0 = x";
        And "and" Bits "bitwise and";
        Or "or" Bits "bitwise or";
        Xor "xor" Bits "bitwise exclusive or";
        Shl "shl" Int "shift left; a count (unsigned) of the width or more gives 0";
        Ushr "ushr" Int "shift right filling with 0; a count of the width or more gives 0";
        Sshr "sshr" Int "shift right filling with the sign; a count of the width or more gives the sign";
        Fadd "fadd" Float "IEEE sum, ties to even; NaN results are canonical";
        Fsub "fsub" Float "IEEE difference, ties to even; NaN results are canonical";
        Fmul "fmul" Float "IEEE product, ties to even; NaN results are canonical";
        Fdiv "fdiv" Float "IEEE quotient, ties to even; NaN results are canonical";
    }
}

family! {
    /// Two operands of one type; the result is `i1`.
    CompareOp {
        Eq "eq" Bits "equal";
        Ne "ne" Bits "not equal";
        Slt "slt" Int "less, signed";
        Sle "sle" Int "less or equal, signed";
        Sgt "sgt" Int "greater, signed";
        Sge "sge" Int "greater or equal, signed";
        Ult "ult" Int "less, unsigned";
        Ule "ule" Int "less or equal, unsigned";
        Ugt "ugt" Int "greater, unsigned";
        Uge "uge" Int "greater or equal, unsigned";
        Feq "feq" Float "equal; false with NaN, -0 equals 0";
        Fne "fne" Float "not equal; true with NaN";
        Flt "flt" Float "less; false with NaN";
        Fle "fle" Float "less or equal; false with NaN";
        Fgt "fgt" Float "greater; false with NaN";
        Fge "fge" Float "greater or equal; false with NaN";
    }
}

family! {
    /// One operand of one type; the result has another type, written behind the name. The class is
    /// that of the operand; [`ConvertOp::result_class`] is that of the result.
    ConvertOp {
        Trunc "trunc" Int "low bits of a wider integer";
        Zext "zext" Bits "to a wider integer, filled with 0";
        Sext "sext" Bits "to a wider integer, filled with the sign bit";
        Promote "promote" Float "f32 to f64, exact; NaN gives the canonical NaN";
        Demote "demote" Float "f64 to f32, ties to even; NaN gives the canonical NaN";
        SintToFloat "sint_to_float" Bits "signed integer to float, ties to even";
        UintToFloat "uint_to_float" Bits "unsigned integer to float, ties to even";
        FloatToSint "float_to_sint" Float "to signed integer, ties to even, saturating; NaN gives 0";
        FloatToUint "float_to_uint" Float "to unsigned integer, ties to even, saturating; NaN gives 0";
        FloatBits "float_bits" Float "the bits of a float as an integer of its width";
        BitsFloat "bits_float" Int "an integer's bits as a float of its width; NaN stays as it is";
    }
}

impl ConvertOp {
    /// The result types it accepts.
    pub fn result_class(self) -> OperandClass {
        match self {
            Self::Trunc => OperandClass::Bits,
            Self::Zext | Self::Sext => OperandClass::Int,
            Self::Promote
            | Self::Demote
            | Self::SintToFloat
            | Self::UintToFloat
            | Self::BitsFloat => OperandClass::Float,
            Self::FloatToSint | Self::FloatToUint | Self::FloatBits => OperandClass::Int,
        }
    }

    /// Whether the operation converts `from` to `to`.
    pub fn accepts(self, from: Type, to: Type) -> bool {
        let widths = match self {
            Self::Trunc | Self::Demote => to.bits() < from.bits(),
            Self::Zext | Self::Sext | Self::Promote => to.bits() > from.bits(),
            Self::FloatBits | Self::BitsFloat => to.bits() == from.bits(),
            Self::SintToFloat | Self::UintToFloat | Self::FloatToSint | Self::FloatToUint => true,
        };
        widths && self.class().accepts(from) && self.result_class().accepts(to)
    }
}

impl CompareOp {
    /// The operation with the operands exchanged: `a < b` is `b > a`.
    pub fn swapped(self) -> Self {
        match self {
            Self::Eq | Self::Ne | Self::Feq | Self::Fne => self,
            Self::Slt => Self::Sgt,
            Self::Sle => Self::Sge,
            Self::Sgt => Self::Slt,
            Self::Sge => Self::Sle,
            Self::Ult => Self::Ugt,
            Self::Ule => Self::Uge,
            Self::Ugt => Self::Ult,
            Self::Uge => Self::Ule,
            Self::Flt => Self::Fgt,
            Self::Fle => Self::Fge,
            Self::Fgt => Self::Flt,
            Self::Fge => Self::Fle,
        }
    }

    /// The opposite for every operand, where one exists: ordered float compares have none.
    pub fn inverted(self) -> Option<Self> {
        match self {
            Self::Eq => Some(Self::Ne),
            Self::Ne => Some(Self::Eq),
            Self::Slt => Some(Self::Sge),
            Self::Sle => Some(Self::Sgt),
            Self::Sgt => Some(Self::Sle),
            Self::Sge => Some(Self::Slt),
            Self::Ult => Some(Self::Uge),
            Self::Ule => Some(Self::Ugt),
            Self::Ugt => Some(Self::Ule),
            Self::Uge => Some(Self::Ult),
            Self::Feq => Some(Self::Fne),
            Self::Fne => Some(Self::Feq),
            Self::Flt | Self::Fle | Self::Fgt | Self::Fge => None,
        }
    }
}

impl BinaryOp {
    /// Whether the operands may be exchanged.
    pub fn is_commutative(self) -> bool {
        match self {
            Self::Add | Self::Mul | Self::And | Self::Or | Self::Xor | Self::Fadd | Self::Fmul => {
                true
            }
            Self::Sub
            | Self::Sdiv
            | Self::Udiv
            | Self::Srem
            | Self::Urem
            | Self::Shl
            | Self::Ushr
            | Self::Sshr
            | Self::Fsub
            | Self::Fdiv => false,
        }
    }
}
