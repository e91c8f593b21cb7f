//! Entities and character references of XML.

use std::ops::Range;

/// The character an entity (without `&` and `;`) stands for.
pub(crate) fn entity(name: &str) -> Option<char> {
    let code = match name {
        "lt" => return Some('<'),
        "gt" => return Some('>'),
        "amp" => return Some('&'),
        "apos" => return Some('\''),
        "quot" => return Some('"'),
        _ => name.strip_prefix('#')?,
    };
    let (digits, radix) = match code.strip_prefix(['x', 'X']) {
        Some(hexadecimal) => (hexadecimal, 16),
        None => (code, 10),
    };
    // `from_str_radix` would take a sign.
    if !digits.bytes().next()?.is_ascii_hexdigit() {
        return None;
    }
    char::from_u32(u32::from_str_radix(digits, radix).ok()?).filter(|&c| c != '\0')
}

/// Text with its entities replaced, or where the first bad one stands.
pub(crate) fn decode(raw: &str) -> Result<String, Range<usize>> {
    let mut decoded = String::with_capacity(raw.len());
    let mut at = 0;
    while let Some(ampersand) = raw[at..].find('&').map(|found| at + found) {
        decoded.push_str(&raw[at..ampersand]);
        let Some(length) = raw[ampersand..].find(';') else {
            return Err(ampersand..ampersand + 1);
        };
        let end = ampersand + length + 1;
        decoded.push(entity(&raw[ampersand + 1..end - 1]).ok_or(ampersand..end)?);
        at = end;
    }
    decoded.push_str(&raw[at..]);
    Ok(decoded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_entities_and_character_references_are_decoded() {
        assert_eq!(
            decode("a&lt;b&gt;&amp;&quot;&apos;"),
            Ok("a<b>&\"'".to_owned())
        );
        assert_eq!(decode("&#65;&#x42;&#Xe9;"), Ok("ABé".to_owned()));
        assert_eq!(decode("plain"), Ok("plain".to_owned()));
    }

    #[test]
    fn bad_entities_are_pointed_at() {
        assert_eq!(decode("ab&foo;c"), Err(2..7));
        assert_eq!(decode("ab&c"), Err(2..3));
        for bad in ["&#0;", "&#xD800;", "&#;", "&#+5;", "&#x110000;"] {
            assert_eq!(decode(bad), Err(0..bad.len()), "{bad}");
        }
    }
}
