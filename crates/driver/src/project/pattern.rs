//! Patterns of file names: `*` and `?` within a name, `**` for any folders.

use std::path::{Path, PathBuf};

/// A path with wildcards.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Pattern {
    /// The folders before the first wildcard.
    base: PathBuf,
    /// The names from there on.
    parts: Vec<Vec<char>>,
}

impl Pattern {
    /// `None` if there is no wildcard in the path.
    pub(super) fn parse(path: &str) -> Option<Self> {
        let names: Vec<&str> = path.split(['/', '\\']).collect();
        let wild = names.iter().position(|name| name.contains(['*', '?']))?;
        let (base, parts) = names.split_at(wild);
        Some(Self {
            base: base.iter().collect(),
            parts: parts.iter().map(|part| part.chars().collect()).collect(),
        })
    }

    /// The folder below which it looks.
    pub(super) fn base(&self) -> &Path {
        &self.base
    }

    /// Whether it matches a path below its base.
    pub(super) fn matches(&self, path: &Path) -> bool {
        let names = path
            .components()
            .map(|name| name.as_os_str().to_string_lossy());
        let names: Vec<Vec<char>> = names.map(|name| name.chars().collect()).collect();
        let is_any = |part: &Vec<char>| part.as_slice() == ['*', '*'];
        matches(&self.parts, &names, &is_any, &|part, name| {
            matches(part, name, &|&c| c == '*', &|&p, &n| p == '?' || p == n)
        })
    }
}

/// Whether a pattern matches all of a text, where some signs of the pattern stand for any number of
/// signs of the text. Takes at most the product of their lengths.
fn matches<T>(
    pattern: &[T],
    text: &[T],
    is_any: &dyn Fn(&T) -> bool,
    same: &dyn Fn(&T, &T) -> bool,
) -> bool {
    let (mut at, mut from) = (0, 0);
    // Where to go on when the text does not fit: behind the last "any", one sign later.
    let mut retry: Option<(usize, usize)> = None;
    while from < text.len() {
        match pattern.get(at) {
            Some(sign) if is_any(sign) => {
                retry = Some((at + 1, from));
                at += 1;
            }
            Some(sign) if same(sign, &text[from]) => (at, from) = (at + 1, from + 1),
            Some(_) | None => match &mut retry {
                None => return false,
                Some((behind, start)) => {
                    *start += 1;
                    (at, from) = (*behind, *start);
                }
            },
        }
    }
    pattern[at..].iter().all(is_any)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wildcards_match_names_and_folders() {
        for (pattern, path, expected) in [
            ("src/*.st", "a.st", true),
            ("src/*.st", "b/a.st", false),
            ("src/*.st", "a.stx", false),
            ("src/**/*.st", "a.st", true),
            ("src/**/*.st", "b/c/a.st", true),
            ("src/**", "b/c/a.st", true),
            ("**/x/*", "a/x/b", true),
            ("**/x/*", "x/b", true),
            ("**/x/*", "a/b", false),
            ("?.st", "a.st", true),
            ("?.st", "ab.st", false),
            ("m*r*.st", "motor.st", true),
            ("m*r*.st", "moto.st", false),
            (
                "*a*a*a*b",
                "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa",
                false,
            ),
        ] {
            let parsed = Pattern::parse(pattern).unwrap();
            assert_eq!(
                parsed.matches(Path::new(path)),
                expected,
                "{pattern} {path}"
            );
        }
    }

    #[test]
    fn the_base_is_what_stands_before_the_first_wildcard() {
        assert_eq!(Pattern::parse("a/b/*.st").unwrap().base(), Path::new("a/b"));
        assert_eq!(Pattern::parse("*.st").unwrap().base(), Path::new(""));
        assert_eq!(Pattern::parse("a/b.st"), None);
    }
}
