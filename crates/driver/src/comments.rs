//! The source text of rungs, to be printed above the logic they became: one line a rung.

use iecc_ir::{Module, Origin};
use iecc_source::{SourceMap, Span};
use std::collections::BTreeMap;

/// Longer text is cut: it is a pointer into the program, not a copy of it.
const MOST_LETTERS: usize = 160;

/// For every origin the text of the rung it lies in. Instructions have the label of their rung, whose
/// span holds theirs.
pub(crate) fn source_comments(module: &Module, map: &SourceMap) -> BTreeMap<Origin, String> {
    let mut rungs: BTreeMap<&str, Span> = BTreeMap::new();
    for origin in module.origins.values() {
        if let Some(span) = origin.span {
            let rung = rungs.entry(&origin.label).or_insert(span);
            if span.range().len() > rung.range().len() {
                *rung = span;
            }
        }
    }
    let text = |label: &str| rungs.get(label).map(|&span| one_line(map.slice(span)));
    let origins = module.origins.iter();
    origins
        .filter_map(|(origin, data)| Some((origin, text(&data.label)?)))
        .collect()
}

fn one_line(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(MOST_LETTERS) {
        None => line,
        Some((end, _)) => format!("{} ...", &line[..end]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_cut_between_letters_and_lines_are_joined() {
        assert_eq!(one_line("XIC(a)\r\n  OTE(b);"), "XIC(a) OTE(b);");
        let whole = "ä".repeat(MOST_LETTERS);
        assert_eq!(one_line(&whole), whole);
        assert_eq!(one_line(&format!("{whole}b")), format!("{whole} ..."));
    }
}
