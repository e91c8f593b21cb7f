//! C identifiers from the names users gave: as written where that is legal in C and C++, readable
//! where it is not, and never two things under one name.
//!
//! Accepted: `Start`. Changed: `Local:2:I` becomes `Local_2_I`, `int` becomes `int_`, `1st` becomes
//! `v_1st`. `a.b` and `a_b` in one struct become `a_b` and `a_b_2`.

use std::collections::{BTreeMap, BTreeSet};

/// Longest identifier made, so that lines stay readable.
const MAX_LENGTH: usize = 200;

/// The identifiers of one struct, or of the whole header.
#[derive(Debug, Default)]
pub(super) struct Names {
    taken: BTreeSet<String>,
    /// The number to try next for a name that is taken.
    next: BTreeMap<String, u32>,
}

impl Names {
    /// An identifier for a name, as close to it as possible.
    pub(super) fn claim(&mut self, name: &str) -> String {
        let base = identifier(name);
        if self.taken.insert(base.clone()) {
            return base;
        }
        let number = self.next.entry(base.clone()).or_insert(2);
        loop {
            let candidate = format!("{base}_{number}");
            *number += 1;
            if self.taken.insert(candidate.clone()) {
                return candidate;
            }
        }
    }
}

/// A legal identifier for a name, the same for the same name.
pub(super) fn identifier(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars().take(MAX_LENGTH) {
        match c {
            'a'..='z' | 'A'..='Z' | '0'..='9' => text.push(c),
            // Two underscores in a row are the compiler's.
            _ if text.ends_with('_') => {}
            _ => text.push('_'),
        }
    }
    let mut start = text.chars();
    match (start.next(), start.next()) {
        (Some('a'..='z' | 'A'..='Z'), _) | (Some('_'), Some('a'..='z')) => {}
        (Some('_'), _) => text.insert(0, 'v'),
        (Some(_) | None, _) => text.insert_str(0, "v_"),
    }
    if RESERVED.binary_search(&text.as_str()).is_ok() {
        text.push('_');
    }
    text
}

/// A name as it may stand in a C comment, without `@`, which templates use.
pub(super) fn comment(name: &str) -> String {
    let harmless = |c: char| c.is_alphanumeric() || " _.:[](),;-+#$%&=<>!'\"".contains(c);
    name.chars()
        .map(|c| if harmless(c) { c } else { '?' })
        .collect()
}

/// Keywords of C23 and C++20, and what the included headers and old compilers define; sorted.
const RESERVED: &[&str] = &[
    "BOOL",
    "EOF",
    "FALSE",
    "NULL",
    "TRUE",
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "assert",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "complex",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "errno",
    "explicit",
    "export",
    "extern",
    "false",
    "far",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "imaginary",
    "inline",
    "int",
    "int16_t",
    "int32_t",
    "int64_t",
    "int8_t",
    "interface",
    "linux",
    "long",
    "main",
    "mutable",
    "namespace",
    "near",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "offsetof",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "short",
    "signed",
    "size_t",
    "sizeof",
    "small",
    "static",
    "static_assert",
    "static_cast",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "typeof_unqual",
    "uint16_t",
    "uint32_t",
    "uint64_t",
    "uint8_t",
    "union",
    "unix",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_legal_and_stay_apart() {
        let mut names = Names::default();
        for (name, expected) in [
            ("Start", "Start"),
            ("start", "start"),
            ("Local:2:I.Data", "Local_2_I_Data"),
            ("Local_2_I_Data", "Local_2_I_Data_2"),
            ("Local.2.I.Data", "Local_2_I_Data_3"),
            ("int", "int_"),
            ("int_", "int__2"),
            ("1st", "v_1st"),
            ("", "v_"),
            ("_x", "_x"),
            ("_X", "v_X"),
            ("__x", "_x_2"),
            ("größe", "gr_e"),
        ] {
            assert_eq!(names.claim(name), expected, "{name}");
        }
    }

    #[test]
    fn no_name_ends_a_comment() {
        assert_eq!(comment("a*/b\\\n??/ Größe[3].x"), "a??b????? Größe[3].x");
    }

    #[test]
    fn reserved_words_can_be_searched() {
        assert!(RESERVED.is_sorted());
    }
}
