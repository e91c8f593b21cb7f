//! Addresses of places, and what lies at them.

use crate::hand::{Run, Text, array, continuing, every_scan, one, program, tag, trap, unit, value};
use iecc_ir::FaultCode;
use iecc_lower::Options;
use iecc_sema::hir::code::{ExprId, ExprKind, PathId, PathStep, Root, StmtKind};
use iecc_sema::hir::{Elementary as E, Type};

fn address(text: &mut Text, of: PathId) -> ExprId {
    text.expr(E::Ulint, ExprKind::Address(of))
}

fn at(text: &mut Text, address: ExprId, ty: Type, checked: bool, steps: &[PathStep]) -> PathId {
    let root = Root::Deref {
        address,
        ty,
        checked,
    };
    text.path(root, steps)
}

#[test]
fn what_lies_at_an_address_is_read_and_written() {
    // p := REF(a[2]); r := p^; p^ := 8
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 4);
    let a = tag(&mut hir, "a", ints);
    let p = value(&mut hir, "p", E::Ulint, 0);
    let r = value(&mut hir, "r", E::Int, 0);
    let mut text = Text::new();
    let element = text.path(Root::Tag(a), &[PathStep::Index(2)]);
    let reference = address(&mut text, element);
    let first = text.set_tag(p, reference);
    let kept = text.get(E::Ulint, p);
    let place = at(&mut text, kept, one(E::Int), false, &[]);
    let read = text.load(E::Int, place);
    let second = text.set_tag(r, read);
    let eight = text.num(E::Int, 8);
    let third = text.set(place, eight);
    let main = unit(&mut hir, "Main", text.body(&[first, second, third]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, &trap());
    run.poke("a/2", 5);
    assert_eq!(run.scan(0), Ok(()));
    let found = ["a/1", "a/2", "a/3", "r"].map(|path| run.number(path));
    assert_eq!(found, [0, 8, 0, 5]);
}

/// `r := p^[i]; p^[i] := 8` for `p: REF_TO ARRAY[0..3] OF INT`, which is NULL.
fn null(options: &Options, checked: bool) -> Result<Run, FaultCode> {
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 4);
    let p = value(&mut hir, "p", E::Ulint, 0);
    let r = value(&mut hir, "r", E::Int, 7);
    let mut text = Text::new();
    let kept = text.get(E::Ulint, p);
    let place = at(&mut text, kept, ints, checked, &[PathStep::Index(1)]);
    let read = text.load(E::Int, place);
    let first = text.set_tag(r, read);
    let eight = text.num(E::Int, 8);
    let second = text.set(place, eight);
    let main = unit(&mut hir, "Main", text.body(&[first, second]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, options);
    run.scan(0)?;
    Ok(run)
}

#[test]
fn null_is_a_fault_or_reads_as_zero() {
    assert_eq!(null(&trap(), false).err(), Some(FaultCode::Reference));
    let run = null(&continuing(), false).unwrap();
    // Bit 4 of the status is fault 5.
    assert_eq!((run.number("r"), run.bits("__status")), (0, 16));
    let run = null(&trap(), true).unwrap();
    assert_eq!(run.number("r"), 0);
}

#[test]
fn references_have_the_address_of_what_they_stand_for() {
    // FUNCTION find : REF_TO INT (VAR_IN_OUT x : INT): find := REF(x)
    // p := find(b); q := REF(b); local: p := find(temporary)
    let mut hir = program();
    let mut text = Text::new();
    let result = text.result("find", E::Ulint);
    let x = text.reference("x", one(E::Int));
    let x = text.path(x, &[]);
    let found = address(&mut text, x);
    let set = text.set_var(result, found);
    let find = unit(&mut hir, "find", text.body(&[set]));
    value(&mut hir, "a", E::Int, 0);
    let b = value(&mut hir, "b", E::Int, 0);
    let [p, q, t] = ["p", "q", "t"].map(|name| value(&mut hir, name, E::Ulint, 9));
    let mut text = Text::new();
    let temporary = text.local("temporary", one(E::Int));
    let mut body = Vec::new();
    let (place, local) = (text.tag(b), text.var(temporary));
    for (to, place) in [(p, place), (t, local)] {
        let call = text.call(find, &[place], &[], &[]);
        let call = text.expr(E::Ulint, ExprKind::Call(call));
        body.push(text.set_tag(to, call));
    }
    let direct = address(&mut text, place);
    body.push(text.set_tag(q, direct));
    let run = Run::once(&mut hir, text.body(&body), &trap());
    assert_eq!(run.bits("p"), run.bits("q"));
    assert_ne!(run.bits("p"), 0);
    assert_eq!(run.bits("t"), 0);
}

#[test]
fn wholes_are_copied_from_an_address() {
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 2);
    let [a, b] = ["a", "b"].map(|name| tag(&mut hir, name, ints));
    let mut text = Text::new();
    let (source, to) = (text.tag(a), text.tag(b));
    let reference = address(&mut text, source);
    let from = at(&mut text, reference, ints, false, &[]);
    let copy = text.stmt(StmtKind::Copy(to, from));
    let main = unit(&mut hir, "Main", text.body(&[copy]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, &trap());
    run.poke("a/1", 6);
    assert_eq!(run.scan(0), Ok(()));
    assert_eq!((run.number("b/0"), run.number("b/1")), (0, 6));
}
