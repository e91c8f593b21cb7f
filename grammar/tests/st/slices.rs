//! Files are cut at units, whatever the units look like inside.

use crate::check::file_id;
use iecc_ast::Names;
use iecc_grammar::st::{Dialect, FragmentKind, Kind, lex, slice};

fn slices(text: &str) -> Vec<(FragmentKind, &str)> {
    let tokens = lex(file_id(), text, Dialect::Iec, &mut Names::new());
    let fragments = slice(&tokens);
    let place = |start: u32, end: u32| &text[start as usize..end as usize];
    fragments
        .iter()
        .map(|fragment| (fragment.kind, place(fragment.start, fragment.end)))
        .collect()
}

#[test]
fn each_unit_is_a_fragment_with_the_comments_before_it() {
    assert_eq!(
        slices(
            "(* a *) FUNCTION f END_FUNCTION; // b\nTYPE t : INT; END_TYPE VAR_GLOBAL g : INT; END_VAR (* c *)"
        ),
        [
            (
                FragmentKind::Unit(Kind::Function),
                "(* a *) FUNCTION f END_FUNCTION;"
            ),
            (
                FragmentKind::Unit(Kind::Type),
                "// b\nTYPE t : INT; END_TYPE"
            ),
            (
                FragmentKind::Unit(Kind::VarGlobal),
                "VAR_GLOBAL g : INT; END_VAR"
            ),
            (FragmentKind::Trailing, "(* c *)"),
        ]
    );
}

#[test]
fn a_unit_without_end_ends_where_the_next_begins() {
    assert_eq!(
        slices("FUNCTION f x := 1; PROGRAM p END_PROGRAM"),
        [
            (FragmentKind::Unit(Kind::Function), "FUNCTION f x := 1;"),
            (FragmentKind::Unit(Kind::Program), "PROGRAM p END_PROGRAM"),
        ]
    );
    assert_eq!(
        slices("CONFIGURATION c PROGRAM p : m; PROGRAM m END_PROGRAM").len(),
        2
    );
}

#[test]
fn words_of_units_inside_units_cut_nothing() {
    for text in [
        "FUNCTION_BLOCK f VAR type : INT; program : INT; END_VAR END_FUNCTION_BLOCK",
        "CONFIGURATION c PROGRAM p WITH t : m; PROGRAM RETAIN q : m; VAR_GLOBAL g : INT; END_VAR END_CONFIGURATION",
        "FUNCTION_BLOCK f USING a; VAR_EXTERNAL e : INT; END_VAR END_FUNCTION_BLOCK",
    ] {
        assert_eq!(slices(text).len(), 1, "{text}");
    }
}

#[test]
fn namespaces_are_their_two_ends() {
    assert_eq!(
        slices("NAMESPACE INTERNAL a.b FUNCTION f END_FUNCTION END_NAMESPACE"),
        [
            (FragmentKind::NamespaceOpen, "NAMESPACE INTERNAL a.b"),
            (
                FragmentKind::Unit(Kind::Function),
                "FUNCTION f END_FUNCTION"
            ),
            (FragmentKind::NamespaceClose, "END_NAMESPACE"),
        ]
    );
}

#[test]
fn text_between_units_is_a_fragment_of_its_own() {
    assert_eq!(
        slices("END_IF; x := 1; FUNCTION f END_FUNCTION y"),
        [
            (FragmentKind::Stray, "END_IF; x := 1;"),
            (
                FragmentKind::Unit(Kind::Function),
                "FUNCTION f END_FUNCTION"
            ),
            (FragmentKind::Stray, "y"),
        ]
    );
}
