//! The text of the standard library: it parses, says what it is for, and its variants are alike.

use iecc_ast::Names;
use iecc_ast::st::{Unit, UnitKind};
use iecc_diag::Diagnostics;
use iecc_grammar::st::{Dialect, parse_file};
use iecc_source::FileId;
use iecc_stdlib::{File, IEC, ROCKWELL};

fn units(file: &File) -> Vec<Unit> {
    let mut found = Diagnostics::new();
    let mut names = Names::new();
    let tree = parse_file(
        FileId::from_index(0),
        file.text,
        Dialect::Iec,
        &mut names,
        &mut found,
    );
    let messages: Vec<_> = found.iter().collect();
    assert!(messages.is_empty(), "{}: {messages:?}", file.path);
    tree.units
}

#[test]
fn every_file_parses_without_a_message() {
    let count: usize = IEC.iter().map(|file| units(file).len()).sum();
    assert!(count > 500, "{count} units");
}

#[test]
fn every_file_and_every_function_says_what_it_is_for() {
    for file in IEC.iter().chain(ROCKWELL) {
        assert!(file.text.starts_with("(* "), "{}", file.path);
        assert!(file.text.ends_with("\n"), "{}", file.path);
        let lines = file.text.lines().count();
        assert!(lines < 800, "{} has {lines} lines", file.path);
        for unit in units(file) {
            let UnitKind::Pou(pou) = &unit.kind else {
                continue;
            };
            let header = unit.span(pou.name.range).start as usize;
            let above: Vec<&str> = file.text[..header].lines().rev().skip(1).collect();
            let last = above.iter().find(|line| !line.starts_with('{'));
            let place = above.len() + 1;
            let documented = last.is_some_and(|line| line.ends_with("*)"));
            assert!(documented, "{}:{place}", file.path);
        }
    }
}

fn text_of(path: &str) -> &'static str {
    let file = IEC.iter().find(|file| file.path == path);
    file.unwrap_or_else(|| panic!("no file {path}")).text
}

/// Without the comment a file begins with.
fn body(text: &str) -> &str {
    text.split_once("*)\n")
        .expect("files begin with a comment")
        .1
}

/// Whole words replaced.
fn with_words(text: &str, words: &[(&str, &str)]) -> String {
    let mut out = String::new();
    let mut rest = text;
    while !rest.is_empty() {
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let length = rest.find(|c| !is_name(c)).unwrap_or(rest.len()).max(1);
        let (word, behind) = rest.split_at(length);
        let other = words.iter().find(|(from, _)| *from == word);
        out.push_str(other.map_or(word, |(_, to)| to));
        rest = behind;
    }
    out
}

#[test]
fn functions_of_wide_strings_are_those_of_strings() {
    let wide = with_words(
        body(text_of("iec/string.st")),
        &[("STRING", "WSTRING"), ("CHAR", "WCHAR")],
    );
    assert_eq!(wide, body(text_of("iec/wstring.st")));
}

/// The text of a block, from its header to its end.
fn block<'t>(text: &'t str, name: &str) -> &'t str {
    let header = format!("FUNCTION_BLOCK {name}\n");
    let start = text.find(&header).unwrap_or_else(|| panic!("no {name}"));
    let length = text[start..].find("END_FUNCTION_BLOCK").expect("an end");
    &text[start..start + length]
}

#[test]
fn blocks_with_a_type_in_their_name_are_the_one_without() {
    let counters = text_of("iec/counter.st");
    let timers = text_of("iec/timer.st");
    let limits = [
        ("INT", "-32_768", "32_767"),
        ("DINT", "-2_147_483_648", "2_147_483_647"),
        (
            "LINT",
            "-9_223_372_036_854_775_808",
            "9_223_372_036_854_775_807",
        ),
        ("UDINT", "0", "4_294_967_295"),
        ("ULINT", "0", "18_446_744_073_709_551_615"),
    ];
    for name in ["CTU", "CTD", "CTUD"] {
        for (ty, least, largest) in limits {
            let typed = format!("{name}_{ty}");
            let expected = with_words(block(counters, name), &[(name, &typed), ("INT", ty)]);
            let expected = expected
                .replace("-32_768", least)
                .replace("32_767", largest);
            assert_eq!(block(counters, &typed), expected, "{typed}");
        }
    }
    for name in ["TP", "TON", "TOF"] {
        let typed = format!("{name}_TIME");
        let expected = with_words(block(timers, name), &[(name, &typed)]);
        assert_eq!(block(timers, &typed), expected);
        let typed = format!("{name}_LTIME");
        let expected = with_words(
            block(timers, name),
            &[(name, &typed), ("TIME", "LTIME"), ("T", "LT")],
        );
        let expected = expected.replace("LTIME_TO_TIME(__ELAPSED(SINCE))", "__ELAPSED(SINCE)");
        assert_eq!(block(timers, &typed), expected);
    }
}
