//! Numbers and strings as Logix writes them, in programs and in tag data.

use std::fmt;

/// A floating-point number as written, without sign.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RealText(
    /// The digits as written; may be `1.#QNAN…`, `1.#INF…`, `1.#IND…` or `1.$`.
    pub String,
);

impl RealText {
    /// The nearest REAL. Not `to_f64() as f32`, which would round twice.
    pub fn to_f32(&self) -> f32 {
        special(&self.0).map_or_else(
            || plain_digits(&self.0).parse().unwrap_or(0.0),
            |v| v as f32,
        )
    }

    /// The nearest LREAL.
    pub fn to_f64(&self) -> f64 {
        special(&self.0).unwrap_or_else(|| plain_digits(&self.0).parse().unwrap_or(0.0))
    }
}

/// Rust parses all other forms as written, once digit separators are gone.
fn plain_digits(text: &str) -> String {
    text.replace('_', "")
}

/// The vendor's spelling of what is no finite number. `1.$` is how an infinity is displayed.
fn special(text: &str) -> Option<f64> {
    let rest = text.strip_prefix("1.")?;
    let upper = rest.to_ascii_uppercase();
    if upper.starts_with("#INF") || upper.starts_with('$') {
        Some(f64::INFINITY)
    } else if upper.starts_with("#QNAN") || upper.starts_with("#SNAN") || upper.starts_with("#IND")
    {
        Some(f64::NAN)
    } else {
        None
    }
}

/// A string between single quotes, with its `$` escapes as written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StringLiteral {
    /// The text between the quotes.
    pub raw: String,
}

impl StringLiteral {
    /// The bytes meant: `$$ $' $Q $L $N $P $R $T` and `$hh` are replaced. `None` when an escape is
    /// unknown or a character has no one-byte code (Latin-1).
    pub fn bytes(&self) -> Option<Vec<u8>> {
        let mut bytes = Vec::with_capacity(self.raw.len());
        let mut rest = self.raw.chars();
        while let Some(c) = rest.next() {
            if c == '$' {
                escape(&mut rest, &mut bytes)?;
            } else {
                bytes.push(u8::try_from(u32::from(c)).ok()?);
            }
        }
        Some(bytes)
    }
}

fn escape(rest: &mut std::str::Chars<'_>, bytes: &mut Vec<u8>) -> Option<()> {
    let c = rest.next()?;
    // `$N` is the two-byte line end, `$L` a line feed alone.
    match c.to_ascii_uppercase() {
        '$' | '\'' => bytes.push(c as u8),
        'Q' => bytes.push(b'"'),
        'L' => bytes.push(0x0a),
        'N' => bytes.extend([0x0d, 0x0a]),
        'P' => bytes.push(0x0c),
        'R' => bytes.push(0x0d),
        'T' => bytes.push(0x09),
        high => {
            let low = rest.next()?;
            bytes.push((high.to_digit(16)? * 16 + low.to_digit(16)?) as u8);
        }
    }
    Some(())
}

impl fmt::Display for StringLiteral {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "'{}'", self.raw)
    }
}

/// A number from tag data.
#[derive(Debug, Clone, PartialEq)]
pub enum Number {
    /// An integer: decimal with sign, or `2#`, `8#`, `16#` bits, or characters.
    Int {
        /// The value as written; bits are not sign-extended.
        value: i128,
        /// Written as a bit pattern (`16#ffff` in an INT is -1) rather than as a signed number.
        bits: bool,
    },
    /// A floating-point number.
    Real {
        /// A minus sign stands before it.
        negative: bool,
        /// The number without sign.
        magnitude: RealText,
    },
}

/// Reads one value of tag data in any radix that is a number: `-5`, `2#1001_0010`,
/// `16#0000_7fff`, `8#017`, `1.5e-003`, `1.#QNAN`, `'A'` or `'$00$01'` (characters, first one
/// highest). Dates and times (`DT#`, `LDT#`, `T#`, …) are not numbers and give `None`.
pub fn parse_number(text: &str) -> Option<Number> {
    let text = text.trim();
    if let Some(inner) = text.strip_prefix('\'').and_then(|t| t.strip_suffix('\'')) {
        return characters(inner);
    }
    let (negative, magnitude) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let (digits, radix) = split_radix(magnitude);
    if let Some(value) = parse_digits(digits, radix) {
        let value = i128::from(value);
        return Some(Number::Int {
            value: if negative { -value } else { value },
            bits: radix != 10,
        });
    }
    let is_real = radix == 10 && (special(magnitude).is_some() || is_finite_real(magnitude));
    is_real.then(|| Number::Real {
        negative,
        magnitude: RealText(magnitude.to_owned()),
    })
}

fn is_finite_real(text: &str) -> bool {
    // Rust would also read `inf` and `nan`, which Logix does not write.
    text.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && plain_digits(text).parse::<f64>().is_ok()
}

fn characters(inner: &str) -> Option<Number> {
    let bytes = StringLiteral {
        raw: inner.to_owned(),
    }
    .bytes()?;
    if bytes.is_empty() || bytes.len() > 8 {
        return None;
    }
    let value = bytes
        .iter()
        .fold(0, |value: i128, &byte| value << 8 | i128::from(byte));
    Some(Number::Int { value, bits: true })
}

fn split_radix(text: &str) -> (&str, u32) {
    for (prefix, radix) in [("2#", 2), ("8#", 8), ("16#", 16)] {
        if let Some(digits) = text.strip_prefix(prefix) {
            return (digits, radix);
        }
    }
    (text, 10)
}

fn parse_digits(digits: &str, radix: u32) -> Option<u64> {
    if !digits.starts_with(|c: char| c.is_digit(radix)) {
        return None;
    }
    u64::from_str_radix(&digits.replace('_', ""), radix).ok()
}

/// Whether underlines stand alone and between letters or digits. Digits must not be missing.
pub fn underlines_are_between_digits(text: &str) -> bool {
    let alphanumeric = |c: char| c.is_ascii_alphanumeric();
    text.split('_')
        .all(|piece| piece.starts_with(alphanumeric) && piece.ends_with(alphanumeric))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn int(value: i128, bits: bool) -> Option<Number> {
        Some(Number::Int { value, bits })
    }

    #[test]
    fn integers_in_every_radix() {
        assert_eq!(parse_number("-5"), int(-5, false));
        assert_eq!(parse_number("2#1001_0010"), int(146, true));
        assert_eq!(parse_number("8#017"), int(15, true));
        assert_eq!(parse_number("16#ffff"), int(65535, true));
        assert_eq!(parse_number("'A'"), int(0x41, true));
        assert_eq!(parse_number("'$01$02'"), int(0x0102, true));
        assert_eq!(parse_number("DT#1970-01-01-00:00:00.000_000Z"), None);
        assert_eq!(parse_number("inf"), None);
        assert_eq!(parse_number(""), None);
    }

    #[test]
    fn reals_in_every_spelling() {
        let value = |text: &str| match parse_number(text) {
            Some(Number::Real {
                negative,
                magnitude,
            }) => {
                if negative {
                    -magnitude.to_f64()
                } else {
                    magnitude.to_f64()
                }
            }
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(value("-1.5e-003"), -0.0015);
        assert_eq!(value(".6"), 0.6);
        assert_eq!(value("2."), 2.0);
        assert!(value("1.#QNAN000e+000").is_nan());
        assert_eq!(value("-1.#INF"), f64::NEG_INFINITY);
        assert_eq!(value("1.$"), f64::INFINITY);
    }

    #[test]
    fn a_real_is_rounded_once() {
        // The nearest f64 lies exactly between two f32, where ties go to even; the text is above.
        let text = RealText("1.00000005960464477540".to_owned());
        assert_eq!(text.to_f32().to_bits(), 0x3f80_0001);
        assert_eq!((text.to_f64() as f32).to_bits(), 0x3f80_0000);
    }

    #[test]
    fn string_escapes_become_bytes() {
        let bytes = |raw: &str| {
            StringLiteral {
                raw: raw.to_owned(),
            }
            .bytes()
        };
        assert_eq!(
            bytes("a$$b$'$N$L$00$fF"),
            Some(b"a$b'\r\n\n\x00\xff".to_vec())
        );
        assert_eq!(bytes("é"), Some(vec![0xe9]));
        assert_eq!(bytes("$"), None);
        assert_eq!(bytes("$0"), None);
        assert_eq!(bytes("€"), None, "no one-byte code");
    }
}
