//! Literals have the values that the standard gives them.

use crate::check::{expression, one};
use iecc_diag::Code;

#[test]
fn integers_have_a_base() {
    for (text, tree) in [
        ("0", "0:Decimal"),
        ("12_345", "12345:Decimal"),
        ("2#1010_0101", "165:Binary"),
        ("8#377", "255:Octal"),
        ("16#ff_FF", "65535:Hexadecimal"),
        ("18446744073709551615", "18446744073709551615:Decimal"),
    ] {
        assert_eq!(expression(text), tree, "{text}");
    }
}

#[test]
fn reals_keep_their_digits() {
    assert_eq!(expression("1.5"), "1.5");
    assert_eq!(expression("1_0.2_5E-1_0"), "10.25E-10");
    assert_eq!(expression("3.0e+10"), "3.0e+10");
}

#[test]
fn a_prefix_types_a_literal_or_an_enumerator() {
    for (text, tree) in [
        ("INT#-123", "(# INT -123:Decimal)"),
        ("INT#+123", "(# INT 123:Decimal)"),
        ("WORD#16#AFF", "(# WORD 2815:Hexadecimal)"),
        ("BOOL#1", "(# BOOL 1:Decimal)"),
        ("BOOL#TRUE", "(# BOOL true)"),
        ("REAL#-1.5", "(# REAL -1.5)"),
        ("Color#Red", "(# Color Red)"),
        ("ns.Color#Red", "(# (. ns Color) Red)"),
        ("WSTRING#'OK'", "(# WSTRING (single \"OK\"))"),
        ("CHAR#'X'", "(# CHAR (single \"X\"))"),
    ] {
        assert_eq!(expression(text), tree, "{text}");
    }
}

#[test]
fn escapes_are_replaced_in_strings() {
    for (text, tree) in [
        ("''", "(single \"\")"),
        ("'a$$b$'c\"'", "(single \"a$b'c\\\"\")"),
        ("\"a$\"b'\"", "(double \"a\\\"b'\")"),
        ("'$L$n$P$r$T'", "(single \"\\n\\n\\u{c}\\r\\t\")"),
        ("'$41$c4'", "(single \"AÄ\")"),
        ("\"$0041$20AC\"", "(double \"A€\")"),
        ("\"€\"", "(double \"€\")"),
        (
            "'(* no comment *) // {}'",
            "(single \"(* no comment *) // {}\")",
        ),
    ] {
        assert_eq!(expression(text), tree, "{text}");
    }
}

#[test]
fn characters_that_a_string_cannot_hold_are_told() {
    one("s := 'a$xb';", Code::E0023, "$x");
    one("s := \"$41\";", Code::E0023, "$4");
    one("s := 'a€b';", Code::E0023, "€");
}

#[test]
fn times_are_nanoseconds() {
    for (text, tree) in [
        ("T#1h_30m", "(Time 5400000000000)"),
        ("time#-1.5S", "(Time -1500000000)"),
        ("LT#1us500ns", "(LongTime 1500)"),
        ("LTIME#1d", "(LongTime 86400000000000)"),
        ("D#1970-01-02", "(Date 86400000000000)"),
        ("DATE#1969-12-31", "(Date -86400000000000)"),
        ("LD#1970-01-02", "(LongDate 86400000000000)"),
        ("TOD#00:00:01.5", "(TimeOfDay 1500000000)"),
        ("LTIME_OF_DAY#01:00:00", "(LongTimeOfDay 3600000000000)"),
        ("DT#1970-01-01-00:00:01", "(DateTime 1000000000)"),
        (
            "LDATE_AND_TIME#1970-01-02-00:00:00.000000001",
            "(LongDateTime 86400000000001)",
        ),
    ] {
        assert_eq!(expression(text), tree, "{text}");
    }
}

#[test]
fn malformed_numbers_are_told_once_each() {
    for number in ["1__0", "10_", "16#", "16#1G", "3#12", "2#12", "1E5", "1.5_"] {
        one(&format!("x := {number};"), Code::E0019, number);
    }
    one("x := 3abc;", Code::E0019, "3abc");
    one(
        "x := 18446744073709551616;",
        Code::E0020,
        "18446744073709551616",
    );
    one("x := T#1m75s;", Code::E0021, "T#1m75s");
    one(
        "x := DT#2024-02-30-12:00:00;",
        Code::E0022,
        "DT#2024-02-30-12:00:00",
    );
    one("x := %E3;", Code::E0026, "%E3");
    one("x := w.%K3;", Code::E0026, "%K3");
    one("x := BOOL#-TRUE;", Code::E0019, "-TRUE");
}
