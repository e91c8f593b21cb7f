//! Statements, each in its forms.

use crate::check::statements;

#[test]
fn assignments_and_calls() {
    assert_eq!(
        statements("a := b; r ?= s; inst(IN := a, Q => b); SUPER(); THIS.m(); o.m(1); ; a;"),
        ":= a b\n?= r s\ndo (call inst IN:=a Q=>b)\ndo (call SUPER)\ndo (call (. THIS m))\n\
         do (call (. o m) 1:Decimal)\nempty\ndo a\n"
    );
}

#[test]
fn if_has_arms_and_an_else() {
    assert_eq!(
        statements("IF a THEN x := 1; ELSIF b THEN ELSIF c THEN x := 2; y := 3; ELSE ; END_IF;"),
        "if a\n  := x 1:Decimal\nif b\nif c\n  := x 2:Decimal\n  := y 3:Decimal\nelse\n  empty\n"
    );
    assert_eq!(statements("IF a THEN ELSE END_IF;"), "if a\nelse\n");
    assert_eq!(statements("IF a THEN END_IF;"), "if a\n");
}

#[test]
fn case_groups_statements_behind_their_labels() {
    assert_eq!(
        statements(
            "CASE s OF 1: a := 1; b := 2; 2, 5..8, -1: idle, Mode#run: f(); ELSE c := 3; END_CASE;"
        ),
        "case s\nof 1:Decimal\n  := a 1:Decimal\n  := b 2:Decimal\n\
         of 2:Decimal 5:Decimal..8:Decimal (Negate 1:Decimal)\nof idle (# Mode run)\n  do (call f)\n\
         else\n  := c 3:Decimal\n"
    );
    assert_eq!(
        statements("CASE t OF T#1s..T#2s: TOD#12:00:00: x := TRUE; END_CASE;"),
        "case t\nof (Time 1000000000)..(Time 2000000000)\nof (TimeOfDay 43200000000000)\n  := x true\n"
    );
}

#[test]
fn loops() {
    assert_eq!(
        statements(
            "FOR i := 1 TO n - 1 DO EXIT; END_FOR; FOR a.i := 10 TO 0 BY -2 DO CONTINUE; END_FOR;"
        ),
        "for i from:1:Decimal to:(- n 1:Decimal)\n  exit\n\
         for (. a i) from:10:Decimal to:0:Decimal by:(Negate 2:Decimal)\n  continue\n"
    );
    assert_eq!(
        statements("WHILE a < b DO RETURN; END_WHILE; REPEAT x := 1; UNTIL x = 1 END_REPEAT;"),
        "while (< a b)\n  return\nrepeat until:(= x 1:Decimal)\n  := x 1:Decimal\n"
    );
    assert_eq!(
        statements("REPEAT UNTIL TRUE; END_REPEAT;"),
        "repeat until:true\n"
    );
}

#[test]
fn comments_stand_wherever_white_space_may() {
    assert_eq!(
        statements("(* a *) x (* (* nested *) ( * *) := // to the end ;\n 1 /* b /* c */ */ ;"),
        ":= x 1:Decimal\n"
    );
}

#[test]
fn keywords_and_names_ignore_case() {
    assert_eq!(
        statements("iF Abc then aBC := x mod 2; eNd_If;"),
        "if Abc\n  := aBC (MOD x 2:Decimal)\n"
    );
}
