//! Tokens: what belongs together, and that nothing is ever refused or lost.

use crate::check::file_id;
use iecc_ast::Names;
use iecc_grammar::st::{Dialect, Kind, lex};

fn texts(text: &str) -> Vec<&str> {
    let tokens = lex(file_id(), text, Dialect::Iec, &mut Names::new());
    let place = |token: &iecc_grammar::st::Token| token.start as usize..token.end as usize;
    tokens
        .list
        .iter()
        .map(|token| &text[place(token)])
        .collect()
}

fn kinds(text: &str) -> Vec<Kind> {
    let tokens = lex(file_id(), text, Dialect::Iec, &mut Names::new());
    tokens.list.iter().map(|token| token.kind).collect()
}

#[test]
fn ranges_are_not_reals() {
    assert_eq!(texts("1..5"), ["1", "..", "5"]);
    assert_eq!(texts("1.5..2.5"), ["1.5", "..", "2.5"]);
    assert_eq!(texts("a.5"), ["a", ".", "5"]);
    assert_eq!(texts("T#1s..T#2.5s"), ["T#1s", "..", "T#2.5s"]);
    assert_eq!(texts("%MW1..%MW3"), ["%MW1", "..", "%MW3"]);
}

#[test]
fn literals_of_times_end_before_signs_that_are_not_theirs() {
    assert_eq!(texts("TOD#12:00:00:x"), ["TOD#12:00:00", ":", "x"]);
    assert_eq!(texts("T#5s-T#-1s"), ["T#5s", "-", "T#-1s"]);
    assert_eq!(texts("D#2024-01-01-d"), ["D#2024-01-01", "-", "d"]);
    assert_eq!(
        texts("DT#2024-01-01-12:00:00.5)"),
        ["DT#2024-01-01-12:00:00.5", ")"]
    );
}

#[test]
fn prefixes_and_values_are_two_tokens() {
    assert_eq!(texts("INT#-5"), ["INT#", "-", "5"]);
    assert_eq!(texts("WORD#16#FF"), ["WORD#", "16#FF"]);
    assert_eq!(kinds("A#B"), [Kind::TypePrefix, Kind::Word]);
}

#[test]
fn comments_nest_and_do_not_mix() {
    assert_eq!(kinds("(* (* *) *)"), [Kind::Comment]);
    assert_eq!(kinds("/* /* */ */"), [Kind::Comment]);
    assert_eq!(kinds("(* // *)x"), [Kind::Comment, Kind::Word]);
    assert_eq!(kinds("(* /* *)x"), [Kind::Comment, Kind::Word]);
    assert_eq!(kinds("// (*\nx"), [Kind::Comment, Kind::Word]);
    assert_eq!(
        kinds("(**)x(***)"),
        [Kind::Comment, Kind::Word, Kind::Comment]
    );
    assert_eq!(kinds("{a}{{b}}"), [Kind::Pragma, Kind::Pragma]);
}

#[test]
fn what_has_no_end_ends_where_least_is_lost() {
    assert_eq!(kinds("(* a (* b *) c := 1;")[0], Kind::OpenComment);
    assert_eq!(texts("(* a (* b *) c")[1], "c");
    assert_eq!(texts("x := 'abc; // no"), ["x", ":=", "'abc", ";", "// no"]);
    assert_eq!(texts("f('abc);\ny"), ["f", "(", "'abc", ")", ";", "y"]);
    assert_eq!(texts("{a\nx"), ["{a", "x"]);
}

#[test]
fn many_comments_without_end_take_linear_time() {
    let text = "(* (* *) x ".repeat(50_000);
    assert!(kinds(&text).len() > 50_000);
}

#[test]
fn bad_bytes_become_unknown_tokens() {
    assert_eq!(kinds("a ! b"), [Kind::Word, Kind::Unknown, Kind::Word]);
    assert_eq!(kinds("\0\u{1}@"), [Kind::Unknown; 3]);
    assert_eq!(kinds("größe"), [Kind::ForeignWord]);
    assert_eq!(kinds("\u{feff}a"), [Kind::Word]);
    assert_eq!(kinds("3abc"), [Kind::BadNumber]);
}

#[test]
fn tokens_and_white_space_make_up_the_text() {
    let text = "(* c *) PROGRAM p\r\n\tx := 'é$'' + \"\" ** 2; {p} a S= b; // end\n€ END_PROGRAM";
    let tokens = lex(file_id(), text, Dialect::Iec, &mut Names::new());
    let mut end = 0;
    for token in &tokens.list {
        let gap = text.get(end..token.start as usize);
        let merged = token.kind == Kind::Merged;
        assert!(
            merged || gap.is_some_and(|gap| gap.trim().is_empty()),
            "{token:?}"
        );
        end = end.max(token.end as usize);
    }
    assert_eq!(end, text.len());
}
