//! Damages Structured Text as typing, merging and malice do: by words, so that much of it still means
//! something, by nesting without end, and by bytes.

use crate::mutate::mutate;
use crate::rng::Rng;

/// Openings that nest, and what closes them.
const NESTS: [(&str, &str); 14] = [
    ("(", ")"),
    ("x := -(", ");"),
    ("NOT ", ""),
    ("a[", "]"),
    ("r^", ""),
    ("f(x := ", ")"),
    ("IF b THEN ", " END_IF;"),
    ("FOR i := 1 TO 2 DO ", " END_FOR;"),
    ("CASE i OF 1: ", " END_CASE;"),
    ("REPEAT ", " UNTIL TRUE END_REPEAT;"),
    ("ARRAY [0..1] OF ", ""),
    ("REF_TO ", ""),
    ("STRUCT m : ", " END_STRUCT;"),
    ("NAMESPACE n ", " END_NAMESPACE "),
];

/// Deepest nesting that is tried.
const DEEPEST: usize = 3_000;

/// A text with one to six damages; what it has not comes from the other text.
pub fn damage(text: &str, other: &str, rng: &mut Rng) -> String {
    if rng.one_in(8) {
        return mutate(text, rng);
    }
    let (mut words, others) = (words(text), words(other));
    for _ in 0..=rng.below(6) {
        change(&mut words, &others, rng);
    }
    words.concat()
}

fn change(words: &mut Vec<String>, others: &[String], rng: &mut Rng) {
    let at = rng.below(words.len() + 1);
    let end = (at + 1 + rng.below(12)).min(words.len()).max(at);
    match rng.below(8) {
        0 => drop(words.drain(at..end)),
        1 => {
            let copy = words[at..end].to_vec();
            let target = rng.below(words.len() + 1);
            words.splice(target..target, copy);
        }
        2 if at < words.len() => {
            let target = rng.below(words.len());
            words.swap(at, target);
        }
        3 if at < words.len() => {
            let from = rng.below(words.len());
            words[at] = words[from].clone();
        }
        4 if at < words.len() && !others.is_empty() => {
            words[at] = others[rng.below(others.len())].clone();
        }
        5 if !others.is_empty() => {
            let first = rng.below(others.len());
            let last = (first + 1 + rng.below(40)).min(others.len());
            words.splice(at..at, others[first..last].to_vec());
        }
        6 if rng.one_in(4) => words.insert(at, nest(rng)),
        7 if rng.one_in(4) => words.truncate(at),
        _ => drop(words.drain(at..end.min(at + 1))),
    }
}

/// Something nested deep, which may lack its ends.
fn nest(rng: &mut Rng) -> String {
    let (open, close) = rng.pick(&NESTS);
    let deep = rng.pick(&[10, 100, 300, DEEPEST]);
    let closed = if rng.one_in(2) { deep } else { 0 };
    format!("{}b{}", open.repeat(deep), close.repeat(closed))
}

/// The words of a text, and what lies between them.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before = None;
    for character in text.chars() {
        let kind = match character {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '_' | '#' => 0,
            ' ' | '\n' => 1,
            _ => 2,
        };
        match words.last_mut() {
            Some(word) if before == Some(kind) && kind < 2 => word.push(character),
            Some(_) | None => words.push(character.to_string()),
        }
        before = Some(kind);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_what_lies_between_them_are_the_whole_text() {
        let text = "x := INT#5 + (y);\n";
        let expected = [
            "x", " ", ":", "=", " ", "INT#5", " ", "+", " ", "(", "y", ")", ";", "\n",
        ];
        assert_eq!(words(text), expected);
    }
}
