//! A text with places that may be left out or replaced by something simpler.
//!
//! The generator marks what it writes: statements and declarations, whose place can be empty, and
//! expressions, which a literal of their type can stand for. Shrinking knows no more than that.

use std::collections::BTreeSet;
use std::ops::Range;

/// A text being written, or written.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Draft {
    text: String,
    marks: Vec<Mark>,
}

/// Cuts that are made together, each with what takes its place.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Mark {
    cuts: Vec<(Range<usize>, String)>,
}

impl Mark {
    fn bytes(&self) -> usize {
        self.cuts.iter().map(|(range, _)| range.len()).sum()
    }
}

impl Draft {
    /// Writes on.
    pub fn put(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// How much is written.
    pub fn position(&self) -> usize {
        self.text.len()
    }

    /// What was written from a position on can be `instead`.
    pub fn mark(&mut self, start: usize, instead: &str) {
        self.mark_all(vec![(start..self.position(), instead)]);
    }

    /// Ranges that can all be something else.
    pub fn mark_all(&mut self, cuts: Vec<(Range<usize>, &str)>) {
        let cuts = cuts.into_iter();
        let cuts = cuts.map(|(range, instead)| (range, instead.to_owned()));
        self.marks.push(Mark {
            cuts: cuts.collect(),
        });
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text after the cuts of some marks; a cut within another counts for nothing.
    fn cut(&self, marks: &BTreeSet<usize>) -> String {
        let marks = marks.iter().map(|&mark| &self.marks[mark]);
        let mut cuts: Vec<&(Range<usize>, String)> = marks.flat_map(|mark| &mark.cuts).collect();
        cuts.sort_by_key(|(range, _)| (range.start, std::cmp::Reverse(range.end)));
        let (mut text, mut at) = (String::new(), 0);
        for (range, instead) in cuts {
            if range.start >= at {
                text.push_str(&self.text[at..range.start]);
                text.push_str(instead);
                at = range.end;
            }
        }
        text.push_str(&self.text[at..]);
        text
    }

    /// A text that still fails, and does so no more after any one further cut.
    pub fn shrink(&self, fails: impl Fn(&str) -> bool) -> String {
        let mut order: Vec<usize> = (0..self.marks.len()).collect();
        order.sort_by_key(|&mark| std::cmp::Reverse(self.marks[mark].bytes()));
        let (mut cut, mut best) = (BTreeSet::new(), self.text.clone());
        loop {
            let before = cut.len();
            for &mark in &order {
                if !cut.insert(mark) {
                    continue;
                }
                let text = self.cut(&cut);
                if text.len() < best.len() && fails(&text) {
                    best = text;
                } else {
                    cut.remove(&mark);
                }
            }
            if cut.len() == before {
                return without_empty_lines(&best);
            }
        }
    }
}

fn without_empty_lines(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    lines.map(|line| format!("{line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::Draft;

    #[test]
    fn shrinking_keeps_what_the_failure_needs() {
        let mut draft = Draft::default();
        let start = draft.position();
        draft.put("a := (1 + ");
        let inner = draft.position();
        draft.put("b * 77");
        draft.mark(inner, "0");
        draft.put(");\n");
        draft.mark(start, "");
        let head = draft.position();
        draft.put("IF c THEN\n");
        let body = draft.position();
        draft.put("d := 5;\n");
        let tail = draft.position();
        draft.mark(body, "");
        draft.put("END_IF;\n");
        let cuts = vec![(head..body, ""), (tail..draft.position(), "")];
        draft.mark_all(cuts);
        draft.mark(head, "");
        assert_eq!(draft.shrink(|text| text.contains("d :=")), "d := 5;\n");
        assert_eq!(
            draft.shrink(|text| text.contains("a :=")),
            "a := (1 + 0);\n"
        );
        assert_eq!(
            draft.shrink(|text| text.contains("77")),
            "a := (1 + b * 77);\n"
        );
    }
}
