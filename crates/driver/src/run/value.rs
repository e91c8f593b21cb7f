//! Values as users write them in a stimulus and read them in a trace.

use iecc_diag::Code;
use iecc_ir::Type;
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

/// The bits of a value of type `ty`. Decimal integers are signed; integers with a base are patterns.
pub(super) fn parse_value(text: &str, ty: Type) -> Result<u64, ValueError> {
    match ty {
        Type::I1 => parse_bool(text),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => parse_int(text, ty),
        Type::F32 => {
            parse_float(text, f64::from(f32::MAX)).map(|x| u64::from((x as f32).to_bits()))
        }
        Type::F64 => parse_float(text, f64::MAX).map(f64::to_bits),
    }
}

fn parse_bool(text: &str) -> Result<u64, ValueError> {
    match text.to_ascii_uppercase().as_str() {
        "0" | "FALSE" => Ok(0),
        "1" | "TRUE" => Ok(1),
        _ => Err(malformed("a BOOL is 0, 1, TRUE or FALSE")),
    }
}

fn parse_int(text: &str, ty: Type) -> Result<u64, ValueError> {
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
    let largest = ty.mask() >> 1;
    match size {
        Some(size) if negative && size <= largest + 1 => Ok(size.wrapping_neg() & ty.mask()),
        Some(size) if !negative && size <= largest => Ok(size),
        Some(_) | None => {
            let smallest = ty.signed(largest + 1);
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

/// Appends a value as a trace shows it: BOOL as 0 or 1, integers signed, reals with the fewest
/// digits that give them back.
pub(super) fn write_value(out: &mut String, ty: Type, bits: u64) {
    let written = match ty {
        Type::I1 => write!(out, "{bits}"),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => write!(out, "{}", ty.signed(bits)),
        Type::F32 => write!(out, "{:?}", f32::from_bits(bits as u32)),
        Type::F64 => write!(out, "{:?}", f64::from_bits(bits)),
    };
    written.expect("writing to a string");
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
            assert_eq!(parse_value(text, ty), Ok(bits), "{text} {ty}");
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
            assert_eq!(parse_value(text, ty).unwrap_err().code, code, "{text} {ty}");
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
            write_value(&mut text, ty, bits);
            assert_eq!(text, expected);
        }
    }
}
