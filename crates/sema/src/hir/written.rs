//! Paths as users write them outside of programs, on the command line and in stimuli:
//! `Local:1:I.Data.3`, `motor.timers[3, 1].PRE`.
//!
//! What a path leads to is for those to say who know the names. Here it is cut into steps, whatever
//! stands in it.

/// A step of a path behind the name it begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WrittenStep<'t> {
    /// The path up to here.
    pub before: &'t str,
    /// What follows.
    pub kind: StepKind<'t>,
}

/// What follows a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepKind<'t> {
    /// `.name`, also where it is the number of a bit.
    Member(&'t str),
    /// `[1, 2]`: what stands in the brackets.
    Indices(&'t str),
    /// A bracket that is not closed; nothing follows it.
    Unclosed,
    /// Something that cannot stand here; nothing follows it.
    Stray(&'t str),
}

/// The beginnings of a path that can be names, the longest first: names may contain dots.
pub fn heads(path: &str) -> impl Iterator<Item = &str> {
    let ends = path.match_indices(['.', '[']).map(|(end, _)| end);
    let ends: Vec<usize> = ends.chain([path.len()]).collect();
    ends.into_iter().rev().map(|end| &path[..end])
}

/// The steps of a path behind its head.
pub fn steps<'t>(path: &'t str, head: &str) -> impl Iterator<Item = WrittenStep<'t>> {
    let mut at = head.len();
    std::iter::from_fn(move || {
        let (before, rest) = path
            .split_at_checked(at)
            .filter(|(_, rest)| !rest.is_empty())?;
        let (kind, length) = step(rest);
        at += length;
        Some(WrittenStep { before, kind })
    })
}

/// The first step of a text, and how much of the text it takes.
fn step(text: &str) -> (StepKind<'_>, usize) {
    if let Some(rest) = text.strip_prefix('.') {
        let end = rest.find(['.', '[']).unwrap_or(rest.len());
        return (StepKind::Member(&rest[..end]), end + 1);
    }
    let Some(rest) = text.strip_prefix('[') else {
        return (StepKind::Stray(text), text.len());
    };
    match rest.find(']') {
        Some(end) => (StepKind::Indices(&rest[..end]), end + 2),
        None => (StepKind::Unclosed, text.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::StepKind::{Indices, Member, Stray, Unclosed};
    use super::{heads, steps};

    #[test]
    fn every_beginning_may_be_a_name() {
        let found: Vec<&str> = heads("Local:1:I.Data[2].3").collect();
        let expected = [
            "Local:1:I.Data[2].3",
            "Local:1:I.Data[2]",
            "Local:1:I.Data",
            "Local:1:I",
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn whatever_is_written_is_cut_into_steps() {
        for (path, expected) in [
            ("a", &[][..]),
            ("a.b.3", &[("a", Member("b")), ("a.b", Member("3"))]),
            (
                "a[1, -2].b",
                &[("a", Indices("1, -2")), ("a[1, -2]", Member("b"))],
            ),
            ("a[1][2]", &[("a", Indices("1")), ("a[1]", Indices("2"))]),
            ("a[1", &[("a", Unclosed)]),
            ("a[1]é.b", &[("a", Indices("1")), ("a[1]", Stray("é.b"))]),
            ("a..b", &[("a", Member("")), ("a.", Member("b"))]),
        ] {
            let found: Vec<_> = steps(path, "a")
                .map(|step| (step.before, step.kind))
                .collect();
            assert_eq!(found, expected, "{path}");
        }
    }
}
