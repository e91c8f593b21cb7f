//! Damages texts as bad copies, bad tools and bad luck do.

use crate::rng::Rng;

/// A small export with at least one of everything the reader knows.
pub const SAMPLE: &str = include_str!("../l5x/sample.L5X");

/// Pieces that readers treat specially.
const TOKENS: [&str; 24] = [
    "<",
    ">",
    "&",
    "&amp;",
    "&#x41;",
    "&#0;",
    "]]>",
    "<![CDATA[",
    "<!--",
    "-->",
    "\"",
    "'",
    "[",
    "]",
    "(",
    ")",
    ",",
    ";",
    "?",
    "%",
    "16#",
    "\u{feff}",
    "\0",
    "é",
];

/// A text with one to eight random changes. Bytes that end up as no UTF-8 become U+FFFD.
pub fn mutate(text: &str, rng: &mut Rng) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=rng.below(8) {
        change(&mut bytes, rng);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn change(bytes: &mut Vec<u8>, rng: &mut Rng) {
    if bytes.is_empty() {
        bytes.extend_from_slice(rng.pick(&TOKENS).as_bytes());
        return;
    }
    let at = rng.below(bytes.len());
    let end = (at + 1 + rng.below(40)).min(bytes.len());
    match rng.below(6) {
        0 => bytes[at] = rng.below(256) as u8,
        1 => drop(bytes.drain(at..end)),
        2 => insert(bytes, at, rng.pick(&TOKENS).as_bytes().to_vec()),
        3 => {
            let copy = bytes[at..end].to_vec();
            let target = rng.below(bytes.len());
            insert(bytes, target, copy);
        }
        4 => bytes.truncate(at),
        _ => {
            let other = rng.below(bytes.len());
            bytes.swap(at, other);
        }
    }
}

fn insert(bytes: &mut Vec<u8>, at: usize, piece: Vec<u8>) {
    bytes.splice(at..at, piece);
}

/// An export with one to eight values changed, attributes or CDATA, that stays well-formed XML, so
/// that the damage reaches what reads the values.
pub fn mutate_values(text: &str, rng: &mut Rng) -> String {
    let mut changed = text.to_owned();
    for _ in 0..=rng.below(8) {
        let values = values(&changed);
        if values.is_empty() {
            break;
        }
        let range = rng.pick(&values);
        let value = mutate(&changed[range.0..range.1], rng);
        let harmless = |c: &char| !matches!(c, '<' | '&' | '"' | '>');
        changed.replace_range(
            range.0..range.1,
            &value.chars().filter(harmless).collect::<String>(),
        );
    }
    changed
}

/// The byte ranges of attribute values and CDATA sections.
fn values(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (open, close) in [("=\"", "\""), ("<![CDATA[", "]]>")] {
        for (at, _) in text.match_indices(open) {
            let start = at + open.len();
            if let Some(length) = text[start..].find(close) {
                found.push((start, start + length));
            }
        }
    }
    found
}
