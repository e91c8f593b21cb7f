//! Values in the cells of a trace: literals of Structured Text, by the type of what they stand for.
//!
//! Cells are read here, by rules that are simpler than those of the compiler, so that a mistake in
//! the compiler's literals cannot hide itself.

use iecc_ast::st::time::{nanoseconds, time_text};
use iecc_ast::st::{TimeKind, TimeLiteral};
use iecc_driver::run::Shape;
use iecc_ir::{Type, View};

/// A value of a cell: the bits of a scalar, or length and characters of a string.
pub(crate) type Bits = Vec<u64>;

/// The value that a literal stands for in a place.
pub(crate) fn read(text: &str, shape: Shape) -> Result<Bits, String> {
    match shape {
        Shape::Scalar(ty) => scalar(text, ty).map(|bits| vec![bits]),
        Shape::Text {
            character,
            capacity,
        } => {
            let units = string(text, character)?;
            if units.len() > capacity {
                return Err(format!("`{text}` is longer than {capacity} characters"));
            }
            let length = std::iter::once(units.len() as u64);
            Ok(length.chain(units).collect())
        }
    }
}

/// Whether a value is the expected one: the same bits, any NaN for NaN, and for REAL values at most
/// `ulp` representable values away.
pub(crate) fn same(expected: &[u64], found: &[u64], shape: Shape, ulp: u64) -> bool {
    match shape {
        Shape::Scalar(ty) => same_scalar(expected[0], found[0], ty, ulp),
        Shape::Text { .. } => found.starts_with(expected),
    }
}

fn same_scalar(expected: u64, found: u64, ty: Type, ulp: u64) -> bool {
    if expected == found {
        return true;
    }
    if ty.is_int() {
        return false;
    }
    match (order(expected, ty), order(found, ty)) {
        (Some(expected), Some(found)) => expected.abs_diff(found) <= u128::from(ulp) && ulp > 0,
        (None, None) => true,
        (None, Some(_)) | (Some(_), None) => false,
    }
}

/// The position of a number among the floats of its type; `None` for NaN.
fn order(bits: u64, ty: Type) -> Option<i128> {
    let (number, magnitude) = match ty {
        Type::F32 => {
            let number = f32::from_bits(bits as u32);
            (f64::from(number), bits & 0x7fff_ffff)
        }
        Type::F64 => (f64::from_bits(bits), bits & (u64::MAX >> 1)),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => panic!("no float"),
    };
    let magnitude = i128::from(magnitude);
    (!number.is_nan()).then_some(if number.is_sign_negative() {
        -magnitude
    } else {
        magnitude
    })
}

/// A value for people.
pub(crate) fn show(bits: &[u64], shape: Shape, view: View) -> String {
    match shape {
        Shape::Scalar(Type::I1) => if bits[0] == 0 { "FALSE" } else { "TRUE" }.to_owned(),
        Shape::Scalar(ty @ (Type::I8 | Type::I16 | Type::I32 | Type::I64)) => {
            format!("{} (16#{:X})", show_integer(bits[0], ty, view), bits[0])
        }
        Shape::Scalar(Type::F32) => {
            let bits = bits[0] as u32;
            format!("{:?} (16#{bits:X})", f32::from_bits(bits))
        }
        Shape::Scalar(Type::F64) => format!("{:?} (16#{:X})", f64::from_bits(bits[0]), bits[0]),
        Shape::Text { .. } => show_string(bits),
    }
}

fn show_integer(bits: u64, ty: Type, view: View) -> String {
    let ns = ty.signed(bits);
    let time = |kind: TimeKind| time_text(TimeLiteral { kind, ns });
    match view {
        View::Plain => ns.to_string(),
        View::Unsigned | View::Bits => bits.to_string(),
        View::Time => time(TimeKind::Time),
        View::Date => time(TimeKind::Date),
        View::TimeOfDay => time(TimeKind::TimeOfDay),
        View::DateTime => time(TimeKind::DateTime),
    }
}

fn show_string(bits: &[u64]) -> String {
    let (length, units) = bits.split_first().expect("a string has a length");
    let units = units.iter().take(*length as usize);
    let units = units.map(|unit| match char::from_u32(*unit as u32) {
        Some(c) if !c.is_control() => c.to_string(),
        Some(_) | None => format!("${unit:02X}"),
    });
    format!("'{}' of length {length}", units.collect::<String>())
}

fn scalar(text: &str, ty: Type) -> Result<u64, String> {
    let no = || format!("`{text}` is no value of {} bits", ty.bits());
    if let Some((prefix, value)) = text.split_once('#')
        && let Some(kind) = TimeKind::of_prefix(prefix)
    {
        let ns = nanoseconds(kind.shape(), value)?;
        return (ty == Type::I64).then_some(ns as u64).ok_or_else(no);
    }
    if text.starts_with(['\'', '"']) {
        let units = string(text, ty)?;
        return match units[..] {
            [unit] => Ok(unit),
            _ => Err(format!("`{text}` is not one character")),
        };
    }
    let text = untyped(text);
    let value = match ty {
        Type::I1 => truth(text),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => integer(text, ty),
        Type::F32 => pattern(text, ty)
            .or_else(|| real(text, |digits| digits.parse().ok().map(f32::to_bits)).map(u64::from)),
        Type::F64 => {
            pattern(text, ty).or_else(|| real(text, |digits| digits.parse().ok().map(f64::to_bits)))
        }
    };
    value.ok_or_else(no)
}

/// A literal without the name of its type: `16#FF` of `WORD#16#FF`.
fn untyped(text: &str) -> &str {
    match text.split_once('#') {
        Some((name, value)) if name.starts_with(|c: char| c.is_ascii_alphabetic()) => value,
        Some(_) | None => text,
    }
}

fn truth(text: &str) -> Option<u64> {
    match text.to_ascii_uppercase().as_str() {
        "0" | "FALSE" | "2#0" | "16#0" => Some(0),
        "1" | "TRUE" | "2#1" | "16#1" => Some(1),
        _ => None,
    }
}

/// A decimal number of the type with or without sign, or a pattern.
fn integer(text: &str, ty: Type) -> Option<u64> {
    if let Some(bits) = pattern(text, ty) {
        return Some(bits);
    }
    let number: i128 = plain(text)?.parse().ok()?;
    let smallest = -(1i128 << (ty.bits() - 1));
    let fits = (smallest..=i128::from(ty.mask())).contains(&number);
    fits.then_some(number as u64 & ty.mask())
}

/// A number with its base: the bits themselves.
fn pattern(text: &str, ty: Type) -> Option<u64> {
    let (base, digits) = text.split_once('#')?;
    let base = match base {
        "2" => 2,
        "8" => 8,
        "16" => 16,
        _ => return None,
    };
    let bits = u64::from_str_radix(&plain(digits)?, base).ok()?;
    (bits <= ty.mask()).then_some(bits)
}

/// Digits without underlines; `None` if these are not between digits.
fn plain(text: &str) -> Option<String> {
    let lone = text.split('_').all(|part| !part.is_empty());
    lone.then(|| text.replace('_', ""))
}

fn real<T>(text: &str, parse: impl Fn(&str) -> Option<T>) -> Option<T> {
    match text {
        "NaN" | "Inf" | "+Inf" | "-Inf" => parse(text),
        _ => {
            let digits = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
            let text = plain(text)?;
            text.chars().all(digits).then(|| parse(&text)).flatten()
        }
    }
}

/// The characters between quotes, with `$` escapes replaced.
fn string(text: &str, character: Type) -> Result<Vec<u64>, String> {
    let text = untyped(text);
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'));
    let inner = quote.and_then(|quote| text[1..].strip_suffix(quote));
    let inner = inner.ok_or_else(|| format!("`{text}` is no string"))?;
    let mut units = Vec::new();
    let mut rest = inner;
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        if c == '$' {
            let (unit, behind) = escape(rest, quote == Some('"'))
                .ok_or_else(|| format!("`{text}` has an escape that is none"))?;
            units.push(unit);
            rest = behind;
        } else {
            let mut pair = [0; 2];
            units.extend(
                c.encode_utf16(&mut pair)
                    .iter()
                    .map(|unit| u64::from(*unit)),
            );
        }
    }
    if units.iter().any(|unit| *unit > character.mask()) {
        return Err(format!("`{text}` has characters that do not fit"));
    }
    Ok(units)
}

/// What follows a `$`: a character, and the text behind it.
fn escape(text: &str, double: bool) -> Option<(u64, &str)> {
    let digits = if double { 4 } else { 2 };
    if let Some(code) = text.get(..digits)
        && let Ok(unit) = u64::from_str_radix(code, 16)
    {
        return Some((unit, &text[digits..]));
    }
    let unit = match text.chars().next()?.to_ascii_uppercase() {
        c @ ('$' | '\'' | '"') => c as u64,
        'L' | 'N' => 0x0a,
        'P' => 0x0c,
        'R' => 0x0d,
        'T' => 0x09,
        _ => return None,
    };
    Some((unit, &text[1..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: Shape = Shape::Text {
        character: Type::I8,
        capacity: 5,
    };
    const WIDE: Shape = Shape::Text {
        character: Type::I16,
        capacity: 5,
    };

    #[test]
    fn scalars_are_read_by_type() {
        for (text, ty, bits) in [
            ("TRUE", Type::I1, 1),
            ("0", Type::I1, 0),
            ("BOOL#1", Type::I1, 1),
            ("-5", Type::I16, 0xfffb),
            ("65535", Type::I16, 0xffff),
            ("INT#-1", Type::I16, 0xffff),
            ("WORD#16#FF", Type::I16, 0xff),
            ("2#1010_0101", Type::I8, 0xa5),
            ("18446744073709551615", Type::I64, u64::MAX),
            ("-9_223_372_036_854_775_808", Type::I64, 1 << 63),
            ("T#1s500ms", Type::I64, 1_500_000_000),
            ("LTIME#-1ns", Type::I64, u64::MAX),
            ("D#1970-01-02", Type::I64, 86_400_000_000_000),
            ("TOD#00:00:01", Type::I64, 1_000_000_000),
            ("'A'", Type::I8, 0x41),
            ("$", Type::I8, u64::MAX),
            ("1.5", Type::F32, 0x3fc0_0000),
            ("REAL#-1", Type::F32, 0xbf80_0000),
            ("16#7F800000", Type::F32, 0x7f80_0000),
            ("-Inf", Type::F64, 0xfff0_0000_0000_0000),
            ("1E10", Type::F64, 0x4202_a05f_2000_0000),
        ] {
            let found = read(text, Shape::Scalar(ty));
            if bits == u64::MAX && text == "$" {
                assert!(found.is_err());
            } else {
                assert_eq!(found, Ok(vec![bits]), "{text}");
            }
        }
    }

    #[test]
    fn what_is_no_value_is_refused() {
        for (text, ty) in [
            ("2", Type::I1),
            ("65536", Type::I16),
            ("-32769", Type::I16),
            ("16#10000", Type::I16),
            ("1__0", Type::I16),
            ("1.5", Type::I16),
            ("T#1s", Type::I32),
            ("'AB'", Type::I8),
            ("inf", Type::F32),
            ("1.5x", Type::F32),
        ] {
            assert!(read(text, Shape::Scalar(ty)).is_err(), "{text}");
        }
        for text in ["'123456'", "abc", "'a", "'$Q'", "'\u{20ac}'"] {
            assert!(read(text, TEXT).is_err(), "{text}");
        }
    }

    #[test]
    fn strings_have_a_length_and_escapes() {
        assert_eq!(read("''", TEXT), Ok(vec![0]));
        let number = Ok(vec![5, 0x31, 0x36, 0x23, 0x31, 0x46]);
        assert_eq!(read("'16#1F'", TEXT), number);
        assert_eq!(read("'a$'$41'", TEXT), Ok(vec![3, 0x61, 0x27, 0x41]));
        assert_eq!(read("\"$0041\u{20ac}\"", WIDE), Ok(vec![2, 0x41, 0x20ac]));
        assert!(same(&[1, 0x61], &[1, 0x61, 7, 7, 7, 7], TEXT, 0));
        assert!(!same(&[1, 0x61], &[2, 0x61, 7, 7, 7, 7], TEXT, 0));
        assert_eq!(
            show(&[2, 0x61, 0x0a, 7, 7, 7], TEXT, View::Plain),
            "'a$0A' of length 2"
        );
    }

    #[test]
    fn reals_are_the_same_to_the_last_bit_unless_a_distance_is_allowed() {
        let one = u64::from(1f32.to_bits());
        let real = Shape::Scalar(Type::F32);
        assert!(same(&[one], &[one], real, 0));
        assert!(!same(&[one], &[one + 1], real, 0));
        assert!(same(&[one], &[one + 1], real, 1));
        assert!(!same(&[one], &[one + 2], real, 1));
        assert!(!same(&[0x8000_0000], &[0], real, 0));
        assert!(same(&[0x8000_0001], &[1], real, 2));
        assert!(same(&[0x7fc0_0000], &[0xffc0_0001], real, 0));
        assert!(!same(&[0x7fc0_0000], &[0], real, 9));
    }
}
