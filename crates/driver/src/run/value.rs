//! Values as users write them in a stimulus and read them in a trace.

use iecc_ast::st::calendar::NS_PER_DAY;
use iecc_ast::st::time::{nanoseconds, time_text};
use iecc_ast::st::{TimeKind, TimeLiteral, TimeShape};
use iecc_diag::Code;
use iecc_ir::{Type, View};
use std::fmt::Write as _;

/// What is wrong with a value: a code and a reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ValueError {
    pub(super) code: Code,
    pub(super) reason: String,
}

fn malformed(reason: impl Into<String>) -> ValueError {
    ValueError {
        code: Code::E6007,
        reason: reason.into(),
    }
}

fn outside(reason: impl Into<String>) -> ValueError {
    ValueError {
        code: Code::E6008,
        reason: reason.into(),
    }
}

/// The bits of a value of type `ty`. Decimal integers are signed unless the view says otherwise;
/// integers with a base are patterns. A time is a literal, or its nanoseconds.
pub(super) fn parse_value(text: &str, ty: Type, view: View) -> Result<u64, ValueError> {
    if let Some(kind) = time_kind(view)
        && let Some((prefix, value)) = text.split_once('#')
        && let Some(written) = TimeKind::of_prefix(prefix)
    {
        return parse_time(kind, written, value);
    }
    match ty {
        Type::I1 => parse_bool(text),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => match view {
            View::Unsigned | View::Bits => parse_int(text, ty, false),
            View::Plain | View::Time | View::Date | View::TimeOfDay | View::DateTime => {
                parse_int(text, ty, true)
            }
        },
        Type::F32 => {
            parse_float(text, f64::from(f32::MAX)).map(|x| u64::from((x as f32).to_bits()))
        }
        Type::F64 => parse_float(text, f64::MAX).map(f64::to_bits),
    }
}

/// The literals in which a view shows times.
fn time_kind(view: View) -> Option<TimeKind> {
    match view {
        View::Plain | View::Unsigned | View::Bits => None,
        View::Time => Some(TimeKind::Time),
        View::Date => Some(TimeKind::Date),
        View::TimeOfDay => Some(TimeKind::TimeOfDay),
        View::DateTime => Some(TimeKind::DateTime),
    }
}

/// Dates are also read with a time of day, in which a value that is no midnight is shown.
fn parse_time(kind: TimeKind, written: TimeKind, text: &str) -> Result<u64, ValueError> {
    let (expected, found) = (kind.shape(), written.shape());
    if expected != found && (expected, found) != (TimeShape::Date, TimeShape::DateAndClock) {
        return Err(malformed(format!(
            "a literal that begins with {}# is expected",
            kind.prefix()
        )));
    }
    let ns = nanoseconds(found, text).map_err(malformed)?;
    Ok(ns as u64)
}

fn parse_bool(text: &str) -> Result<u64, ValueError> {
    match text.to_ascii_uppercase().as_str() {
        "0" | "FALSE" => Ok(0),
        "1" | "TRUE" => Ok(1),
        _ => Err(malformed("a BOOL is 0, 1, TRUE or FALSE")),
    }
}

fn parse_int(text: &str, ty: Type, signed: bool) -> Result<u64, ValueError> {
    let form = || malformed("an integer is decimal, or has its base in front: 16#FF, 8#17, 2#1010");
    if let Some((base, digits)) = text.split_once('#') {
        let base = match base {
            "2" => 2,
            "8" => 8,
            "16" => 16,
            _ => return Err(form()),
        };
        let bits = magnitude(digits, base).ok_or_else(form)?;
        let fits = bits.is_some_and(|bits| bits <= ty.mask());
        return if fits {
            Ok(bits.unwrap_or(0))
        } else {
            Err(outside(format!("the type holds {} bits", ty.bits())))
        };
    }
    let (negative, digits) = match text.as_bytes().first() {
        Some(b'-') => (true, &text[1..]),
        Some(b'+') => (false, &text[1..]),
        _ => (false, text),
    };
    let size = magnitude(digits, 10).ok_or_else(form)?;
    let largest = if signed { ty.mask() >> 1 } else { ty.mask() };
    match size {
        Some(size) if negative && signed && size <= largest + 1 => {
            Ok(size.wrapping_neg() & ty.mask())
        }
        Some(size) if !negative && size <= largest => Ok(size),
        Some(_) | None => {
            let smallest = if signed { ty.signed(largest + 1) } else { 0 };
            Err(outside(format!("the type holds {smallest} to {largest}")))
        }
    }
}

/// Digits with single underscores between them. The outer `None` says that they are malformed, the
/// inner one that the number has more than 64 bits.
fn magnitude(digits: &str, base: u32) -> Option<Option<u64>> {
    let well_formed = digits
        .split('_')
        .all(|part| !part.is_empty() && part.chars().all(|c| c.is_digit(base)));
    well_formed.then(|| u64::from_str_radix(&digits.replace('_', ""), base).ok())
}

fn parse_float(text: &str, largest: f64) -> Result<f64, ValueError> {
    let form = || malformed("a real number is written like 1.5, -20 or 2e-3");
    // Rust would also take `inf` and `nan`.
    let plain = text
        .chars()
        .all(|c| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E' | '_'));
    if !plain {
        return Err(form());
    }
    let number: f64 = text.replace('_', "").parse().map_err(|_| form())?;
    if number.abs() > largest {
        return Err(outside(format!(
            "the type holds -{largest:e} to {largest:e}"
        )));
    }
    Ok(number)
}

/// Appends a value as a trace shows it: BOOL as 0 or 1, integers and times by their view, reals with
/// the fewest digits that give them back.
pub(crate) fn write_value(out: &mut String, ty: Type, view: View, bits: u64) {
    let written = match ty {
        Type::I1 => write!(out, "{bits}"),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => write_int(out, ty, view, bits),
        Type::F32 => write!(out, "{:?}", f32::from_bits(bits as u32)),
        Type::F64 => write!(out, "{:?}", f64::from_bits(bits)),
    };
    written.expect("writing to a string");
}

fn write_int(out: &mut String, ty: Type, view: View, bits: u64) -> std::fmt::Result {
    let number = ty.signed(bits);
    match view {
        View::Plain => write!(out, "{number}"),
        View::Unsigned => write!(out, "{bits}"),
        View::Bits => write!(out, "16#{bits:X}"),
        View::Time => write_time(out, TimeKind::Time, number),
        View::Date if number % NS_PER_DAY == 0 => write_time(out, TimeKind::Date, number),
        View::Date | View::DateTime => write_time(out, TimeKind::DateTime, number),
        View::TimeOfDay if (0..NS_PER_DAY).contains(&number) => {
            write_time(out, TimeKind::TimeOfDay, number)
        }
        // No day is so long.
        View::TimeOfDay => write!(out, "{number}"),
    }
}

fn write_time(out: &mut String, kind: TimeKind, ns: i64) -> std::fmt::Result {
    out.write_str(&time_text(TimeLiteral { kind, ns }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_by_type() {
        for (text, ty, bits) in [
            ("1", Type::I1, 1),
            ("false", Type::I1, 0),
            ("TRUE", Type::I1, 1),
            ("-128", Type::I8, 0x80),
            ("127", Type::I8, 0x7f),
            ("+5", Type::I8, 5),
            ("16#fF", Type::I8, 0xff),
            ("2#1010_0101", Type::I16, 0xa5),
            ("8#17", Type::I32, 15),
            ("1_000_000", Type::I32, 1_000_000),
            ("-9223372036854775808", Type::I64, 1 << 63),
            ("16#FFFFFFFFFFFFFFFF", Type::I64, u64::MAX),
            ("1.5", Type::F32, 0x3fc0_0000),
            ("-2", Type::F32, 0xc000_0000),
            ("2e-3", Type::F64, 0x3f60_624d_d2f1_a9fc),
        ] {
            assert_eq!(parse_value(text, ty, View::Plain), Ok(bits), "{text} {ty}");
        }
    }

    #[test]
    fn what_is_no_value_of_the_type_is_refused() {
        for (text, ty, code) in [
            ("2", Type::I1, Code::E6007),
            ("yes", Type::I1, Code::E6007),
            ("128", Type::I8, Code::E6008),
            ("-129", Type::I8, Code::E6008),
            ("16#100", Type::I8, Code::E6008),
            ("99999999999999999999", Type::I64, Code::E6008),
            ("9223372036854775808", Type::I64, Code::E6008),
            ("1.5", Type::I32, Code::E6007),
            ("1__0", Type::I32, Code::E6007),
            ("_1", Type::I32, Code::E6007),
            ("-", Type::I32, Code::E6007),
            ("--1", Type::I32, Code::E6007),
            ("16#", Type::I32, Code::E6007),
            ("16#-1", Type::I32, Code::E6007),
            ("3#1", Type::I32, Code::E6007),
            ("2#2", Type::I32, Code::E6007),
            ("nan", Type::F32, Code::E6007),
            ("inf", Type::F64, Code::E6007),
            ("1e", Type::F64, Code::E6007),
            ("1e39", Type::F32, Code::E6008),
            ("1e400", Type::F64, Code::E6008),
        ] {
            let error = parse_value(text, ty, View::Plain).unwrap_err();
            assert_eq!(error.code, code, "{text} {ty}");
        }
    }

    #[test]
    fn values_are_written_so_that_they_can_be_read_again() {
        for (ty, bits, expected) in [
            (Type::I1, 1, "1"),
            (Type::I8, 0xff, "-1"),
            (Type::I16, 0x8000, "-32768"),
            (Type::I32, 5, "5"),
            (Type::I64, u64::MAX, "-1"),
            (Type::F32, 0x3dcc_cccd, "0.1"),
            (Type::F32, 0x7149_f2ca, "1e30"),
            (Type::F64, 0x3ff0_0000_0000_0000, "1.0"),
            (Type::F64, 0x8000_0000_0000_0000, "-0.0"),
            (Type::F32, 0x7fc0_0000, "NaN"),
        ] {
            let mut text = String::new();
            write_value(&mut text, ty, View::Plain, bits);
            assert_eq!(text, expected);
        }
    }

    #[test]
    fn a_view_says_how_a_number_is_shown_and_read() {
        const DAY: i64 = NS_PER_DAY;
        for (ty, view, number, expected) in [
            (Type::I8, View::Unsigned, -1, "255"),
            (Type::I64, View::Unsigned, -1, "18446744073709551615"),
            (Type::I8, View::Bits, -1, "16#FF"),
            (Type::I16, View::Bits, 10, "16#A"),
            (Type::I64, View::Time, 0, "T#0s"),
            (Type::I64, View::Time, 1_500_000_000, "T#1s500ms"),
            (Type::I64, View::Time, -93_600_000_000_007, "T#-1d2h7ns"),
            (Type::I64, View::Date, 11_016 * DAY, "D#2000-02-29"),
            (Type::I64, View::Date, -DAY, "D#1969-12-31"),
            (Type::I64, View::Date, 1, "DT#1970-01-01-00:00:00.000000001"),
            (
                Type::I64,
                View::TimeOfDay,
                DAY - 1,
                "TOD#23:59:59.999999999",
            ),
            (Type::I64, View::TimeOfDay, 0, "TOD#00:00:00"),
            (Type::I64, View::TimeOfDay, DAY, "86400000000000"),
            (Type::I64, View::TimeOfDay, -1, "-1"),
            (
                Type::I64,
                View::DateTime,
                -1,
                "DT#1969-12-31-23:59:59.999999999",
            ),
            (
                Type::I64,
                View::DateTime,
                11_016 * DAY,
                "DT#2000-02-29-00:00:00",
            ),
        ] {
            let bits = number as u64 & ty.mask();
            let mut text = String::new();
            write_value(&mut text, ty, view, bits);
            assert_eq!(text, expected);
            assert_eq!(parse_value(&text, ty, view), Ok(bits), "{text}");
        }
    }

    #[test]
    fn times_are_also_read_as_nanoseconds_and_in_other_spellings() {
        for (text, view, number) in [
            ("1500", View::Time, 1_500),
            ("-3", View::Time, -3),
            ("16#10", View::Time, 16),
            ("time#1.5s", View::Time, 1_500_000_000),
            ("LT#2ms", View::Time, 2_000_000),
            ("DATE#1970-01-02", View::Date, NS_PER_DAY),
            ("LTIME_OF_DAY#00:00:01", View::TimeOfDay, 1_000_000_000),
            ("7", View::DateTime, 7),
        ] {
            assert_eq!(
                parse_value(text, Type::I64, view),
                Ok(number as u64),
                "{text}"
            );
        }
        for (text, ty, view, code) in [
            ("T#1x", Type::I64, View::Time, Code::E6007),
            ("D#2023-02-29", Type::I64, View::Date, Code::E6007),
            ("T#1s", Type::I64, View::Date, Code::E6007),
            ("D#2024-02-29", Type::I64, View::DateTime, Code::E6007),
            ("T#1s", Type::I64, View::Plain, Code::E6007),
            ("-1", Type::I8, View::Unsigned, Code::E6008),
            ("256", Type::I8, View::Bits, Code::E6008),
        ] {
            let error = parse_value(text, ty, view).unwrap_err();
            assert_eq!(error.code, code, "{text} {view:?}");
        }
    }
}
