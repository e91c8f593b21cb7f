//! What CODESYS adds is read in all dialects, and its words stay names where they can be names.

use crate::check::{outline, outline_in, parse, statements};
use iecc_grammar::st::Dialect;

#[test]
fn pointers_references_and_unions() {
    let text = "TYPE p : POINTER TO INT; r : REFERENCE TO ARRAY [0..1] OF POINTER TO BOOL;
        u : UNION a : INT; b : WORD; END_UNION
        s EXTENDS base : STRUCT c : BIT; END_STRUCT
        e : (x, y := 5) BYTE := x;
        z : STRING(20); END_TYPE";
    assert_eq!(
        outline(text),
        "types
  type p : (POINTER_TO INT)
  type r : (REFERENCE_TO (array 0:Decimal..1:Decimal of (POINTER_TO BOOL)))
  type u : (union [var a : INT] [var b : WORD])
  type s extends:base : (struct [var c : BIT])
  type e : (enum base:BYTE [x] [y is:5:Decimal]) is:x
  type z : (sized STRING 20:Decimal round)
"
    );
}

#[test]
fn assignments_and_operators_of_codesys() {
    assert_eq!(
        statements(
            "a S= b; a.c[1] R= d; q REF= v; a := b AND_THEN c OR_ELSE d; p := ADR(x); n := SIZEOF(INT);"
        ),
        "S= a b\nR= (index (. a c) 1:Decimal) d\nREF= q v\n:= a (OR_ELSE (AND_THEN b c) d)\n\
         := p (call ADR x)\n:= n (call SIZEOF INT)\n"
    );
}

#[test]
fn properties_and_actions() {
    let text = "FUNCTION_BLOCK f
        VAR v : INT; END_VAR
        PROPERTY PUBLIC Value : INT
        GET Value := v; END_GET
        SET PRIVATE VAR t : INT; END_VAR t := Value; v := t; END_SET
        END_PROPERTY
        ACTION go: v := 1; END_ACTION
        go();
        END_FUNCTION_BLOCK";
    assert_eq!(
        outline(text),
        "FUNCTION_BLOCK f
  VAR
    var v : INT
  property PUBLIC Value : INT
    get
      := Value v
    set PRIVATE
      VAR
        var t : INT
      := t Value
      := v t
  action go
    := v 1:Decimal
  do (call go)
"
    );
}

#[test]
fn lists_of_global_variables_and_more_sections() {
    assert_eq!(
        outline(
            "VAR_GLOBAL PERSISTENT RETAIN a : INT; END_VAR FUNCTION_BLOCK f VAR_STAT s : INT; END_VAR METHOD m VAR_INST i : INT; END_VAR END_METHOD END_FUNCTION_BLOCK"
        ),
        "VAR_GLOBAL PERSISTENT RETAIN\n  var a : INT\nFUNCTION_BLOCK f\n  VAR_STAT\n    var s : INT\n  method m\n    VAR_INST\n      var i : INT\n"
    );
}

#[test]
fn words_of_codesys_are_names_where_a_name_can_stand() {
    let text = "FUNCTION_BLOCK property
        VAR get, set, union, pointer, reference, and_then, persistent, var_stat, S, R : INT; END_VAR
        get := set; set := get + 1; union := pointer; property := reference;
        IF S=1 AND R=2 OR (S=3) THEN S:=R; END_IF;
        FOR pointer := reference TO reference DO persistent := -and_then; END_FOR;
        var_stat(S := R, R=>S);
        END_FUNCTION_BLOCK";
    let outline = outline(text);
    assert!(
        outline.contains("(OR (AND (= S 1:Decimal) (= R 2:Decimal)) (= S 3:Decimal))"),
        "{outline}"
    );
    assert!(outline.contains("for pointer from:reference to:reference"));
    assert!(outline.contains("do (call var_stat S:=R R=>S)"));
}

#[test]
fn words_of_edition_3_are_names_in_edition_2() {
    let text = "PROGRAM p VAR class, method, this, ref, null, continue, final : INT; END_VAR class := method + this - ref * null; continue := final; END_PROGRAM";
    outline_in(text, Dialect::IecEdition2);
    assert!(parse(text, Dialect::Iec).diagnostics.has_errors());
}

#[test]
fn words_of_charts_are_names_in_codesys() {
    let text = "PROGRAM p VAR step, transition : INT; END_VAR step := transition; END_PROGRAM";
    outline_in(text, Dialect::Codesys);
    assert_eq!(parse(text, Dialect::Iec).diagnostics.len(), 2);
}

#[test]
fn blocks_of_codesys_need_no_semicolon() {
    let text = "PROGRAM p VAR a : INT; END_VAR
        IF a = 1 THEN a := 2; END_IF (* here *)
        CASE a OF 1: a := 3; END_CASE
        FOR a := 1 TO 2 DO ; END_FOR;
        END_PROGRAM";
    outline_in(text, Dialect::Codesys);
    assert_eq!(parse(text, Dialect::Iec).diagnostics.len(), 2);
}

#[test]
fn on_is_a_name_in_codesys_but_in_a_resource() {
    let text = "TYPE t : (Off, On); END_TYPE PROGRAM p VAR On : t; END_VAR On := t.On; END_PROGRAM
        CONFIGURATION c RESOURCE r ON PLC TASK k(INTERVAL := T#1s, PRIORITY := 1); END_RESOURCE END_CONFIGURATION";
    outline_in(text, Dialect::Codesys);
    assert!(parse(text, Dialect::Iec).diagnostics.has_errors());
}
