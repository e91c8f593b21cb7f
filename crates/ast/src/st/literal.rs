//! Literals with their values.
//!
//! What a value means in a type, and whether it fits, is for the semantic analysis: here an
//! integer has 64 bits and a sign, and times are nanoseconds in 64 bits.

use crate::numbers::RealText;
use crate::rung::Radix;

/// A literal without its type prefix. Prefixes of times are part of the literal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Literal {
    /// TRUE, FALSE.
    Bool(bool),
    /// `12`, `16#FF`, and `-12` behind a type prefix.
    Int(IntLiteral),
    /// `1.5E-3`, and `-1.5` behind a type prefix.
    Real {
        /// Whether a minus sign stands before it.
        negative: bool,
        /// The digits, without underlines.
        digits: RealText,
    },
    /// `'abc'`, `"abc"`.
    String(StringLiteral),
    /// `T#1s500ms`, `D#2024-02-29`, and the other six.
    Time(TimeLiteral),
}

/// An integer as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IntLiteral {
    /// Its magnitude.
    pub value: u64,
    /// Whether a minus sign stands before it, which only a type prefix allows.
    pub negative: bool,
    /// The base it is written in.
    pub radix: Radix,
}

/// A string with its escapes replaced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StringLiteral {
    /// The characters: UTF-16 units. Between single quotes all are below 256, as one byte holds.
    pub units: Box<[u16]>,
    /// Whether it stands between double quotes.
    pub double: bool,
}

/// A duration, or a point in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeLiteral {
    /// Which type its prefix names.
    pub kind: TimeKind,
    /// Durations: nanoseconds. Times of day: since midnight. Others: since 1970-01-01.
    pub ns: i64,
}

/// The types of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeKind {
    /// TIME.
    Time,
    /// LTIME.
    LongTime,
    /// DATE.
    Date,
    /// LDATE.
    LongDate,
    /// TIME_OF_DAY.
    TimeOfDay,
    /// LTIME_OF_DAY.
    LongTimeOfDay,
    /// DATE_AND_TIME.
    DateTime,
    /// LDATE_AND_TIME.
    LongDateTime,
}

/// The fields a literal of a type has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeShape {
    /// `1h30m`
    Duration,
    /// `2024-02-29`
    Date,
    /// `12:30:00.5`
    Clock,
    /// `2024-02-29-12:30:00.5`
    DateAndClock,
}

/// Prefixes and what they mean; the first prefix of a kind is the one that is printed.
const TIME_PREFIXES: [(&str, TimeKind); 16] = [
    ("T", TimeKind::Time),
    ("TIME", TimeKind::Time),
    ("LT", TimeKind::LongTime),
    ("LTIME", TimeKind::LongTime),
    ("D", TimeKind::Date),
    ("DATE", TimeKind::Date),
    ("LD", TimeKind::LongDate),
    ("LDATE", TimeKind::LongDate),
    ("TOD", TimeKind::TimeOfDay),
    ("TIME_OF_DAY", TimeKind::TimeOfDay),
    ("LTOD", TimeKind::LongTimeOfDay),
    ("LTIME_OF_DAY", TimeKind::LongTimeOfDay),
    ("DT", TimeKind::DateTime),
    ("DATE_AND_TIME", TimeKind::DateTime),
    ("LDT", TimeKind::LongDateTime),
    ("LDATE_AND_TIME", TimeKind::LongDateTime),
];

impl TimeKind {
    /// The kind whose prefix (before `#`) this is, in any case.
    pub fn of_prefix(prefix: &str) -> Option<Self> {
        TIME_PREFIXES
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(prefix))
            .map(|&(_, kind)| kind)
    }

    /// The shortest prefix.
    pub fn prefix(self) -> &'static str {
        let row = TIME_PREFIXES.iter().find(|&&(_, kind)| kind == self);
        row.expect("every kind has a prefix").0
    }

    /// The fields of its literals.
    pub fn shape(self) -> TimeShape {
        match self {
            Self::Time | Self::LongTime => TimeShape::Duration,
            Self::Date | Self::LongDate => TimeShape::Date,
            Self::TimeOfDay | Self::LongTimeOfDay => TimeShape::Clock,
            Self::DateTime | Self::LongDateTime => TimeShape::DateAndClock,
        }
    }
}
