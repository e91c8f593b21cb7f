//! The standard library: what timers, counters and the like do, as program text.
//!
//! Library code is ordinary code to every pass and back end. It is written in Structured Text, in the
//! dialect of the library: `ANY_…` names stand for one type per call, a STRING without a length takes
//! any length, a name may have several functions of which the first that takes the arguments counts,
//! and a function with the pragma `intrinsic` is an operation of the compiler. [`IEC`] is for programs
//! in Structured Text, [`ROCKWELL`] for those in ladder.

/// A file of the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct File {
    /// Its path below `stdlib`.
    pub path: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! files {
    ($($path:literal)*) => {
        &[$(File { path: $path, text: include_str!(concat!("../", $path)) },)*]
    };
}

/// The timers and counters of Rockwell ladder, and what of the rest of the library they use.
pub const ROCKWELL: &[File] = files! {
    "iec/selection.st"
    "rockwell/timers.st"
    "rockwell/counters.st"
};

/// The functions and function blocks of IEC 61131-3, by what they are about:
///
/// | files | functions |
/// |---|---|
/// | `bistable` `counter` `timer` | SR RS R_TRIG F_TRIG, CTU CTD CTUD, TP TON TOF RTC |
/// | `arithmetic` `bits` `selection` `comparison` | ADD … SQRT IS_VALID, SHL … NOT, SEL … MUX, GT … NE |
/// | `integer` `bits_and_reals` `trunc` `bcd` | `TO_…` between numbers, bit strings, characters; TRUNC, BCD |
/// | `string` `wstring` | LEN … FIND |
/// | `text_number` `text_real` `text_time` `text_wide` | TO_STRING, TO_WSTRING and back |
/// | `time` `calendar` | sums and types of times; CONCAT, SPLIT, DAY_OF_WEEK |
/// | `exponential` `power` `trigonometric` `inverse` | EXP LN LOG, EXPT, SIN COS TAN, ASIN ACOS ATAN ATAN2 |
/// | `memory` | order of bytes, bounds of arrays |
/// | `double` `big` | support: pairs of LREALs, large natural numbers |
pub const IEC: &[File] = files! {
    "iec/bistable.st"
    "iec/counter.st"
    "iec/timer.st"
    "iec/arithmetic.st"
    "iec/bits.st"
    "iec/selection.st"
    "iec/comparison.st"
    "iec/integer.st"
    "iec/bits_and_reals.st"
    "iec/trunc.st"
    "iec/bcd.st"
    "iec/string.st"
    "iec/wstring.st"
    "iec/text_number.st"
    "iec/text_real.st"
    "iec/text_time.st"
    "iec/text_wide.st"
    "iec/time.st"
    "iec/calendar.st"
    "iec/exponential.st"
    "iec/power.st"
    "iec/trigonometric.st"
    "iec/inverse.st"
    "iec/memory.st"
    "iec/double.st"
    "iec/big.st"
};
