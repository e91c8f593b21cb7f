//! Types, variables, units and configurations.

use crate::check::{outline, parse};
use iecc_ast::st::{Item, ScopeId};
use iecc_grammar::st::Dialect;

/// The outline of types, without the line around them.
fn types(text: &str) -> String {
    let outline = outline(&format!("TYPE {text} END_TYPE"));
    let lines = outline.lines().skip(1);
    lines
        .map(|line| format!("{}\n", line.trim_start()))
        .collect()
}

#[test]
fn derived_types() {
    for (text, tree) in [
        ("T : INT;", "type T : INT\n"),
        ("T : ns.U := 5;", "type T : (. ns U) is:5:Decimal\n"),
        (
            "T : INT (-5..5) := 1;",
            "type T : (subrange INT (Negate 5:Decimal) 5:Decimal) is:1:Decimal\n",
        ),
        ("T : (a, b, c) := b;", "type T : (enum [a] [b] [c]) is:b\n"),
        (
            "T : DWORD (a := 16#FF, b := a OR 1);",
            "type T : (enum base:DWORD [a is:255:Hexadecimal] [b is:(OR a 1:Decimal)])\n",
        ),
        ("T : INT (a);", "type T : (enum base:INT [a])\n"),
        (
            "T : STRING[20] := 'x';",
            "type T : (sized STRING 20:Decimal) is:(single \"x\")\n",
        ),
        ("T : REF_TO INT := NULL;", "type T : (REF_TO INT) is:NULL\n"),
        (
            "T : ARRAY [1..2, -1..n] OF ARRAY [0..1] OF BOOL := [3(0)];",
            "type T : (array 1:Decimal..2:Decimal (Negate 1:Decimal)..n of (array 0:Decimal..1:Decimal of BOOL)) is:(array (repeat 3:Decimal 0:Decimal))\n",
        ),
        (
            "T : STRUCT a, b : INT := 3; c AT %X1.0 : BOOL; END_STRUCT;",
            "type T : (struct [var a b : INT is:3:Decimal] [var c at:(direct None Some(Bit) Some([1, 0])) : BOOL])\n",
        ),
        (
            "T : STRUCT OVERLAP s : STRUCT x : INT; END_STRUCT; END_STRUCT := (s := (x := 1));",
            "type T : (struct overlap [var s : (struct [var x : INT])]) is:(struct s:=(struct x:=1:Decimal))\n",
        ),
    ] {
        assert_eq!(types(text), tree, "{text}");
    }
}

#[test]
fn sections_of_variables() {
    let text = "FUNCTION_BLOCK f
        VAR_INPUT a, b : BOOL R_EDGE; c : BOOL F_EDGE; d : ARRAY [*, *] OF INT; END_VAR
        VAR_OUTPUT RETAIN o : INT := 1; END_VAR
        VAR_IN_OUT io : STRING; END_VAR
        VAR_TEMP t : TIME; END_VAR
        VAR_EXTERNAL CONSTANT e : INT; END_VAR
        VAR NON_RETAIN PRIVATE l AT %IX0.0 : BOOL; AT %QW3 : WORD := 5; u AT %I* : BYTE;
            tm : TON := (PT := T#1s); END_VAR
        VAR CONSTANT k : LREAL := 1.5; END_VAR
        END_FUNCTION_BLOCK";
    assert_eq!(
        outline(text),
        "FUNCTION_BLOCK f
  VAR_INPUT
    var a b : BOOL Rising
    var c : BOOL Falling
    var d : (array * * of INT)
  VAR_OUTPUT RETAIN
    var o : INT is:1:Decimal
  VAR_IN_OUT
    var io : STRING
  VAR_TEMP
    var t : TIME
  VAR_EXTERNAL CONSTANT
    var e : INT
  VAR NON_RETAIN PRIVATE
    var l at:(direct Some(Input) Some(Bit) Some([0, 0])) : BOOL
    var at:(direct Some(Output) Some(Word) Some([3])) : WORD is:5:Decimal
    var u at:(direct Some(Input) None None) : BYTE
    var tm : TON is:(struct PT:=(Time 1000000000))
  VAR CONSTANT
    var k : LREAL is:1.5
"
    );
}

#[test]
fn functions_have_results_and_programs_have_access_paths() {
    assert_eq!(
        outline(
            "FUNCTION f : INT VAR_INPUT a : INT; END_VAR f := a; END_FUNCTION FUNCTION g END_FUNCTION"
        ),
        "FUNCTION f\n  result INT\n  VAR_INPUT\n    var a : INT\n  := f a\nFUNCTION g\n"
    );
    assert_eq!(
        outline(
            "PROGRAM p VAR_ACCESS a : x.y : INT READ_WRITE; b : %IX0.0 : BOOL; END_VAR END_PROGRAM"
        ),
        "PROGRAM p\n  VAR_ACCESS\n    access a (. x y) : INT Some(ReadWrite)\n    \
         access b (direct Some(Input) Some(Bit) Some([0, 0])) : BOOL None\n"
    );
}

#[test]
fn classes_and_interfaces() {
    let text = "INTERFACE i EXTENDS a, ns.b METHOD m : INT VAR_INPUT x : INT; END_VAR END_METHOD END_INTERFACE
        CLASS ABSTRACT c EXTENDS d IMPLEMENTS i, j
          VAR PROTECTED v : INT; END_VAR
          METHOD PUBLIC FINAL OVERRIDE m : INT VAR t : INT; END_VAR m := THIS.v; END_METHOD
          METHOD PRIVATE ABSTRACT n END_METHOD
        END_CLASS
        FUNCTION_BLOCK FINAL f USING x.y, z; EXTENDS c VAR q : INT; END_VAR
          METHOD m2 q := 1; END_METHOD;
          m2();
        END_FUNCTION_BLOCK";
    assert_eq!(
        outline(text),
        "INTERFACE i
  extends a (. ns b)
  method m
    result INT
    VAR_INPUT
      var x : INT
CLASS ABSTRACT c
  extends d
  implements i j
  VAR PROTECTED
    var v : INT
  method PUBLIC FINAL OVERRIDE m
    result INT
    VAR
      var t : INT
    := m (. THIS v)
  method PRIVATE ABSTRACT n
FUNCTION_BLOCK FINAL f
  extends c
  using (. x y) z
  VAR
    var q : INT
  method m2
    := q 1:Decimal
  do (call m2)
"
    );
}

#[test]
fn configurations() {
    let text = "CONFIGURATION c
        VAR_GLOBAL RETAIN g : INT; END_VAR
        RESOURCE r ON plc
          VAR_GLOBAL CONSTANT h AT %MW3 : WORD := 1; END_VAR
          TASK t1(INTERVAL := T#10ms, PRIORITY := 1);
          TASK t2(SINGLE := trigger, PRIORITY := 0);
          PROGRAM RETAIN p1 WITH t1 : Main(x := %IX0.0, y => g, fb1 WITH t2);
          PROGRAM p2 : ns.Main;
        END_RESOURCE
        VAR_ACCESS a : r.p1.x : BOOL READ_ONLY; END_VAR
        VAR_CONFIG r.p1.fb.v AT %QB25 : BYTE := 1; r.p1.w : INT := 3; END_VAR
        END_CONFIGURATION
        CONFIGURATION small TASK t(PRIORITY := 1); PROGRAM p WITH t : Main; END_CONFIGURATION";
    assert_eq!(
        outline(text),
        "CONFIGURATION c
  VAR_GLOBAL RETAIN
    var g : INT
  VAR_ACCESS
    access a (. (. r p1) x) : BOOL Some(ReadOnly)
  VAR_CONFIG
    config (. (. (. r p1) fb) v) at:(direct Some(Output) Some(Byte) Some([25])) : BYTE is:1:Decimal
    config (. (. r p1) w) : INT is:3:Decimal
  resource r plc
    VAR_GLOBAL CONSTANT
      var h at:(direct Some(Memory) Some(Word) Some([3])) : WORD is:1:Decimal
    task t1 INTERVAL:=(Time 10000000) PRIORITY:=1:Decimal
    task t2 SINGLE:=trigger PRIORITY:=0:Decimal
    program RETAIN p1 : Main t1 x:=(direct Some(Input) Some(Bit) Some([0, 0])) y=>g (with fb1 t2)
    program p2 : (. ns Main) no task
CONFIGURATION small
  resource unnamed
    task t PRIORITY:=1:Decimal
    program p : Main t
"
    );
}

#[test]
fn namespaces_hold_units_and_namespaces() {
    let text = "USING a.b;
        NAMESPACE INTERNAL n.m
          USING c;
          FUNCTION f END_FUNCTION
          NAMESPACE inner TYPE T : INT; END_TYPE END_NAMESPACE
        END_NAMESPACE
        FUNCTION g END_FUNCTION";
    outline(text);
    let parsed = parse(text, Dialect::Iec);
    let name = |scope: usize| -> Vec<&str> {
        let parts = parsed.file.scopes[scope].name.iter();
        parts.map(|part| parsed.names.text(part.name)).collect()
    };
    assert_eq!(
        [name(0), name(1), name(2)],
        [vec![], vec!["n", "m"], vec!["inner"]]
    );
    assert!(parsed.file.scopes[1].internal && !parsed.file.scopes[2].internal);
    assert_eq!(parsed.file.scopes[2].parent, Some(ScopeId(1)));
    let scopes: Vec<u32> = parsed.file.units.iter().map(|unit| unit.scope.0).collect();
    assert_eq!(scopes, [0, 1, 1, 2, 0]);
    assert_eq!(
        parsed.file.scopes[0].items,
        [Item::Unit(0), Item::Scope(ScopeId(1)), Item::Unit(4)]
    );
    assert_eq!(
        parsed.file.scopes[1].items,
        [Item::Unit(1), Item::Unit(2), Item::Scope(ScopeId(2))]
    );
}

#[test]
fn pragmas_are_kept_in_order_with_their_unit() {
    let parsed = parse(
        "{a} FUNCTION f {b} END_FUNCTION {c} FUNCTION g x := {d} 1; END_FUNCTION {e}",
        Dialect::Iec,
    );
    assert!(parsed.diagnostics.is_empty());
    let pragmas: Vec<Vec<&str>> = parsed
        .file
        .units
        .iter()
        .map(|unit| unit.pragmas.iter().map(|pragma| &*pragma.text).collect())
        .collect();
    assert_eq!(pragmas, [vec!["a", "b"], vec!["c", "d"], vec!["e"]]);
    outline("{a} FUNCTION f {b} VAR {c} x : INT; END_VAR {d} x := {e} 1; {f} END_FUNCTION {g}");
}

#[test]
fn ranges_count_from_the_unit_and_spans_from_the_file() {
    let text = "FUNCTION f END_FUNCTION\n  FUNCTION gg : INT gg := 12; END_FUNCTION";
    let parsed = parse(text, Dialect::Iec);
    let unit = &parsed.file.units[1];
    let iecc_ast::st::UnitKind::Pou(pou) = &unit.kind else {
        panic!("a function")
    };
    assert_eq!(&text[unit.span(pou.name.range).range()], "gg");
    let stmt = &unit.arena[unit.arena[pou.body][0]];
    assert_eq!(&text[unit.span(stmt.range).range()], "gg := 12;");
    let alone = parse(&text[26..], Dialect::Iec);
    assert_eq!(alone.file.units[0].hash, unit.hash);
    assert_eq!(
        alone.outline(),
        "FUNCTION gg\n  result INT\n  := gg 12:Decimal\n"
    );
}
