//! Calls: values in, references, results out.

use crate::hand::{
    Run, Text, array, continuing, every_scan, one, program, structure, trap, unit, value,
};
use iecc_ir::FaultCode;
use iecc_sema::hir::code::{ExprKind, PathStep, Root, StmtKind};
use iecc_sema::hir::{Elementary as E, PouId, Program, StructKind};

/// FUNCTION twice : INT (x : INT) with a second result `odd`.
fn twice(hir: &mut Program) -> PouId {
    let mut text = Text::new();
    let x = text.param("x", E::Int);
    let (result, odd) = (text.result("twice", E::Int), text.result("odd", E::Bool));
    let (a, b) = (text.get_var(E::Int, x), text.get_var(E::Int, x));
    let sum = text.add(a, b);
    let first = text.set_var(result, sum);
    let bit = text.path(Root::Local(x), &[PathStep::Bits { first: 0, count: 1 }]);
    let bit = text.load(E::Bool, bit);
    let second = text.set_var(odd, bit);
    unit(hir, "twice", text.body(&[first, second]))
}

#[test]
fn functions_take_values_and_give_results() {
    // r := twice(twice(n), odd => f)
    let mut hir = program();
    let callee = twice(&mut hir);
    let n = value(&mut hir, "n", E::Int, 7);
    let r = value(&mut hir, "r", E::Int, 0);
    let f = value(&mut hir, "f", E::Bool, 1);
    let mut text = Text::new();
    let arg = text.get(E::Int, n);
    let inner = text.call(callee, &[], &[arg], &[]);
    let inner = text.expr(E::Int, ExprKind::Call(inner));
    let flag = text.tag(f);
    let outer = text.call(callee, &[], &[inner], &[(1, flag)]);
    let outer = text.expr(E::Int, ExprKind::Call(outer));
    let set = text.set_tag(r, outer);
    let run = Run::once(&mut hir, text.body(&[set]), &trap());
    assert_eq!((run.number("r"), run.number("f")), (28, 0));
}

#[test]
fn results_that_are_not_wanted_go_nowhere() {
    let mut hir = program();
    let callee = twice(&mut hir);
    let mut text = Text::new();
    let arg = text.num(E::Int, 1);
    let call = text.call(callee, &[], &[arg], &[]);
    let eval = text.eval(call);
    Run::once(&mut hir, text.body(&[eval]), &trap());
}

/// FUNCTION_BLOCK COUNTER: n := n + by.
fn counter(hir: &mut Program) -> (PouId, iecc_sema::hir::Type) {
    let members = [("n", one(E::Int)), ("by", one(E::Int))];
    let ty = structure(hir, "COUNTER", StructKind::Plain, &members);
    let mut text = Text::new();
    let this = text.reference("this", ty);
    let n = text.path(this, &[PathStep::Field(0)]);
    let by = text.path(this, &[PathStep::Field(1)]);
    let (old, more) = (text.load(E::Int, n), text.load(E::Int, by));
    let sum = text.add(old, more);
    let set = text.set(n, sum);
    (unit(hir, "COUNTER", text.body(&[set])), ty)
}

#[test]
fn blocks_work_on_their_instance() {
    // c[i].by := 3; c[i](); with i = 1
    let mut hir = program();
    let (callee, ty) = counter(&mut hir);
    let counters = array(&mut hir, ty, 2);
    let c = crate::hand::tag(&mut hir, "c", counters);
    let i = value(&mut hir, "i", E::Int, 1);
    let mut text = Text::new();
    let steps = |text: &mut Text, rest: &[PathStep]| {
        let at = text.get(E::Int, i);
        let by = PathStep::IndexBy {
            value: at,
            low: 0,
            checked: false,
        };
        text.path(Root::Tag(c), &[&[by], rest].concat())
    };
    let by = steps(&mut text, &[PathStep::Field(1)]);
    let three = text.num(E::Int, 3);
    let input = text.set(by, three);
    let instance = steps(&mut text, &[]);
    let call = text.call(callee, &[instance], &[], &[]);
    let eval = text.eval(call);
    let main = unit(&mut hir, "Main", text.body(&[input, eval]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, &trap());
    for total in [3, 6] {
        assert_eq!(run.scan(0), Ok(()));
        assert_eq!((run.number("c/0/n"), run.number("c/1/n")), (0, total));
    }
    run.poke("i", 2);
    assert_eq!(run.scan(0), Err(FaultCode::Index));
    let mut run = Run::new(&hir, &continuing());
    run.poke("i", 2);
    assert_eq!(run.scan(0), Ok(()));
    let found = ["c/0/n", "c/1/n", "__status"].map(|path| run.number(path));
    assert_eq!(found, [0, 0, 1]);
}

#[test]
fn locals_that_are_referred_to_are_changed_by_the_callee() {
    // x := 5; bump(x); r := x
    let mut hir = program();
    let mut text = Text::new();
    let x = text.reference("x", one(E::Int));
    let place = text.path(x, &[]);
    let (old, more) = (text.load(E::Int, place), text.num(E::Int, 1));
    let sum = text.add(old, more);
    let set = text.set(place, sum);
    let bump = unit(&mut hir, "bump", text.body(&[set]));
    let r = value(&mut hir, "r", E::Int, 0);
    let mut text = Text::new();
    let x = text.local("x", one(E::Int));
    let five = text.num(E::Int, 5);
    let first = text.set_var(x, five);
    let place = text.var(x);
    let call = text.call(bump, &[place], &[], &[]);
    let second = text.eval(call);
    let read = text.get_var(E::Int, x);
    let third = text.set_tag(r, read);
    let run = Run::once(&mut hir, text.body(&[first, second, third]), &trap());
    assert_eq!(run.number("r"), 6);
}

#[test]
fn locals_begin_at_zero_in_each_activation() {
    // FUNCTION f : INT: VAR a : ARRAY[0..3] OF INT; x : INT; END_VAR
    //   a[1] := a[1] + 1; x := x + 1; f := a[1] + x;
    let mut hir = program();
    let mut text = Text::new();
    let result = text.result("f", E::Int);
    let ints = array(&mut hir, one(E::Int), 4);
    let a = text.local("a", ints);
    let x = text.local("x", one(E::Int));
    let mut body = Vec::new();
    let mut read = Vec::new();
    for place in [
        text.path(Root::Local(a), &[PathStep::Index(1)]),
        text.path(Root::Local(x), &[]),
    ] {
        let (old, more) = (text.load(E::Int, place), text.num(E::Int, 1));
        let sum = text.add(old, more);
        body.push(text.set(place, sum));
        read.push(text.load(E::Int, place));
    }
    let sum = text.add(read[0], read[1]);
    body.push(text.set_var(result, sum));
    let f = unit(&mut hir, "f", text.body(&body));
    // FOR i := 1 TO 3 DO r := r + f(); END_FOR
    let [i, r] = ["i", "r"].map(|name| value(&mut hir, name, E::Int, 0));
    let mut text = Text::new();
    let call = text.call(f, &[], &[], &[]);
    let (old, more) = (text.get(E::Int, r), text.expr(E::Int, ExprKind::Call(call)));
    let sum = text.add(old, more);
    let add = text.set_tag(r, sum);
    let [from, to, by] = [1, 3, 1].map(|number| text.num(E::Int, number));
    let variable = text.tag(i);
    let repeat = text.stmt(StmtKind::For {
        variable,
        from,
        to,
        by,
        body: vec![add],
    });
    let run = Run::once(&mut hir, text.body(&[repeat]), &trap());
    assert_eq!(run.number("r"), 6);
}

#[test]
fn return_gives_the_results_so_far() {
    // FUNCTION f : INT (c : BOOL): f := 1; IF c THEN RETURN; END_IF; f := 2
    let mut hir = program();
    let mut text = Text::new();
    let c = text.param("c", E::Bool);
    let result = text.result("f", E::Int);
    let [first, last] = [1, 2].map(|number| {
        let number = text.num(E::Int, number);
        text.set_var(result, number)
    });
    let leave = text.stmt(StmtKind::Return);
    let condition = text.get_var(E::Bool, c);
    let branch = text.when(condition, vec![leave], vec![]);
    let f = unit(&mut hir, "f", text.body(&[first, branch, last]));
    let r = value(&mut hir, "r", E::Int, 0);
    let mut text = Text::new();
    let values = [1, 0].map(|bit| {
        let bit = text.num(E::Bool, bit);
        let call = text.call(f, &[], &[bit], &[]);
        text.expr(E::Int, ExprKind::Call(call))
    });
    let ten = text.num(E::Int, 10);
    let tens = text.bin(iecc_sema::hir::code::BinaryOp::Multiply, values[0], ten);
    let sum = text.add(tens, values[1]);
    let set = text.set_tag(r, sum);
    let run = Run::once(&mut hir, text.body(&[set]), &trap());
    assert_eq!(run.number("r"), 12);
}

#[test]
fn names_of_users_do_not_meet_those_of_the_program() {
    let mut hir = program();
    let mut text = Text::new();
    let state = text.reference("state", one(E::Int));
    let ints = array(&mut hir, one(E::Int), 2);
    let input = text.local("input", ints);
    let place = text.path(state, &[]);
    let element = text.path(Root::Local(input), &[PathStep::Index(0)]);
    let seven = text.num(E::Int, 7);
    let first = text.set(element, seven);
    let read = text.load(E::Int, element);
    let second = text.set(place, read);
    let scan = unit(&mut hir, "scan", text.body(&[first, second]));
    let r = value(&mut hir, "r", E::Int, 0);
    let mut text = Text::new();
    let place = text.tag(r);
    let call = text.call(scan, &[place], &[], &[]);
    let eval = text.eval(call);
    let run = Run::once(&mut hir, text.body(&[eval]), &trap());
    assert_eq!(run.number("r"), 7);
}
