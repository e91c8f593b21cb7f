//! The elementary types of IEC 61131-3: what they are called, hold, and may become.

use crate::hir::{Elementary as Storage, View};

/// What family a type belongs to; conversions stay inside families unless they are named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Family {
    /// BOOL and bit strings.
    Bits,
    /// Signed integers.
    Signed,
    /// Unsigned integers.
    Unsigned,
    /// REAL, LREAL.
    Real,
    /// TIME, LTIME.
    Duration,
    /// DATE, LDATE.
    Date,
    /// TIME_OF_DAY, LTIME_OF_DAY.
    TimeOfDay,
    /// DATE_AND_TIME, LDATE_AND_TIME.
    DateTime,
    /// CHAR, WCHAR.
    Character,
}

macro_rules! elementary {
    ($($variant:ident $name:literal $short:literal $family:ident $storage:ident;)*) => {
        /// An elementary type other than strings.
        #[expect(missing_docs, reason = "the words of the language")]
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum El { $($variant,)* }

        impl El {
            /// All of them; in a family from narrow to wide.
            pub const ALL: &'static [El] = &[$(El::$variant),*];

            /// The name, the long one where there are two.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The short name; the same where there is one only.
            pub fn short_name(self) -> &'static str {
                match self { $(Self::$variant => $short,)* }
            }

            /// Its family.
            pub fn family(self) -> Family {
                match self { $(Self::$variant => Family::$family,)* }
            }

            /// What it is stored as.
            pub fn storage(self) -> Storage {
                match self { $(Self::$variant => Storage::$storage,)* }
            }
        }
    };
}

elementary! {
    Bool "BOOL" "BOOL" Bits Bool;
    Byte "BYTE" "BYTE" Bits Usint;
    Word "WORD" "WORD" Bits Uint;
    Dword "DWORD" "DWORD" Bits Udint;
    Lword "LWORD" "LWORD" Bits Ulint;
    Sint "SINT" "SINT" Signed Sint;
    Int "INT" "INT" Signed Int;
    Dint "DINT" "DINT" Signed Dint;
    Lint "LINT" "LINT" Signed Lint;
    Usint "USINT" "USINT" Unsigned Usint;
    Uint "UINT" "UINT" Unsigned Uint;
    Udint "UDINT" "UDINT" Unsigned Udint;
    Ulint "ULINT" "ULINT" Unsigned Ulint;
    Real "REAL" "REAL" Real Real;
    Lreal "LREAL" "LREAL" Real Lreal;
    Time "TIME" "TIME" Duration Lint;
    Ltime "LTIME" "LTIME" Duration Lint;
    Date "DATE" "DATE" Date Lint;
    Ldate "LDATE" "LDATE" Date Lint;
    Tod "TIME_OF_DAY" "TOD" TimeOfDay Lint;
    Ltod "LTIME_OF_DAY" "LTOD" TimeOfDay Lint;
    Dt "DATE_AND_TIME" "DT" DateTime Lint;
    Ldt "LDATE_AND_TIME" "LDT" DateTime Lint;
    Char "CHAR" "CHAR" Character Usint;
    Wchar "WCHAR" "WCHAR" Character Uint;
}

impl El {
    /// Width in bits.
    pub fn bits(self) -> u32 {
        self.storage().bits()
    }

    /// What its numbers stand for.
    pub fn view(self) -> View {
        match self.family() {
            Family::Bits if self != Self::Bool => View::Bits,
            Family::Bits | Family::Signed | Family::Unsigned | Family::Real => View::Number,
            Family::Duration => View::Time,
            Family::Date => View::Date,
            Family::TimeOfDay => View::TimeOfDay,
            Family::DateTime => View::DateTime,
            Family::Character => View::Character,
        }
    }

    /// Whether it is an integer (ANY_INT).
    pub fn is_int(self) -> bool {
        matches!(self.family(), Family::Signed | Family::Unsigned)
    }

    /// Whether it is REAL or LREAL.
    pub fn is_real(self) -> bool {
        self.family() == Family::Real
    }

    /// Whether it is a number (ANY_NUM).
    pub fn is_num(self) -> bool {
        self.is_int() || self.is_real()
    }

    /// Whether it is a bit string, BOOL included (ANY_BIT).
    pub fn is_bits(self) -> bool {
        self.family() == Family::Bits
    }

    /// Whether it is TIME or LTIME.
    pub fn is_duration(self) -> bool {
        self.family() == Family::Duration
    }

    /// Whether it is a point in time or a time of day (ANY_DATE).
    pub fn is_date(self) -> bool {
        matches!(
            self.family(),
            Family::Date | Family::TimeOfDay | Family::DateTime
        )
    }

    /// Whether it is one of the long types of times.
    pub fn is_long_time(self) -> bool {
        matches!(self, Self::Ltime | Self::Ldate | Self::Ltod | Self::Ldt)
    }

    /// The smallest and largest value of a type that holds whole numbers.
    pub fn range(self) -> (i128, i128) {
        let bits = self.bits();
        match self.family() {
            Family::Bits | Family::Unsigned | Family::Character => (0, (1 << bits) - 1),
            Family::Signed
            | Family::Duration
            | Family::Date
            | Family::TimeOfDay
            | Family::DateTime => (-(1 << (bits - 1)), (1 << (bits - 1)) - 1),
            Family::Real => panic!("reals have no whole range"),
        }
    }

    /// Whether a value of this type becomes one of `to` without being asked: value and accuracy are
    /// kept (edition 3, figures 11 and 12).
    pub fn widens_to(self, to: El) -> bool {
        if self == to {
            return true;
        }
        let wider = to.bits() > self.bits();
        match (self.family(), to.family()) {
            (Family::Signed, Family::Signed)
            | (Family::Unsigned, Family::Unsigned)
            | (Family::Bits, Family::Bits)
            | (Family::Unsigned, Family::Signed)
            | (Family::Real, Family::Real) => wider,
            // A LREAL holds every DINT, a REAL every INT.
            (Family::Signed | Family::Unsigned, Family::Real) => 2 * self.bits() <= to.bits(),
            (a, b) => a == b && !self.is_long_time() && to.is_long_time() && a != Family::Character,
        }
    }

    /// The type both operands of an operator become: the smallest that holds both.
    pub fn common(self, other: El) -> Option<El> {
        if self.widens_to(other) {
            return Some(other);
        }
        let candidates = El::ALL.iter().copied();
        candidates
            .filter(|ty| self.widens_to(*ty) && other.widens_to(*ty))
            .min_by_key(|ty| (ty.is_real(), ty.bits()))
    }
}
