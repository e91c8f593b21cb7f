//! Assignments, copies, branches and leaving.

use crate::hand::{Run, Text, array, one, program, structure, tag, trap, value};
use iecc_sema::hir::code::{BinaryOp, PathStep, Root, StmtKind};
use iecc_sema::hir::{CompareOp, Elementary as E, StructKind};

#[test]
fn structures_and_arrays_are_copied_by_value() {
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 3);
    let record = structure(
        &mut hir,
        "RECORD",
        StructKind::Plain,
        &[("A", ints), ("B", one(E::Bool))],
    );
    let [x, y] = ["x", "y"].map(|name| tag(&mut hir, name, record));
    let mut text = Text::new();
    let (to, from) = (text.tag(y), text.tag(x));
    let copy = text.stmt(StmtKind::Copy(to, from));
    let element = text.path(Root::Tag(x), &[PathStep::Field(0), PathStep::Index(1)]);
    let nine = text.num(E::Int, 9);
    let change = text.set(element, nine);
    let main = crate::hand::unit(&mut hir, "Main", text.body(&[copy, change]));
    crate::hand::every_scan(&mut hir, main);
    let mut run = Run::new(&hir, &trap());
    run.poke("x/A/1", 5);
    run.poke("x/B", 1);
    assert_eq!(run.scan(0), Ok(()));
    let found = ["x/A/1", "y/A/1", "y/B"].map(|path| run.number(path));
    assert_eq!(found, [9, 5, 1]);
}

#[test]
fn elements_are_copied_between_dynamic_places() {
    // rows[i] := rows[0], with i = 2
    let mut hir = program();
    let row = array(&mut hir, one(E::Int), 2);
    let rows = array(&mut hir, row, 3);
    let a = tag(&mut hir, "a", rows);
    let i = value(&mut hir, "i", E::Dint, 2);
    let mut text = Text::new();
    let at = text.get(E::Dint, i);
    let by = PathStep::IndexBy {
        value: at,
        low: 0,
        checked: false,
    };
    let (to, from) = (
        text.path(Root::Tag(a), &[by]),
        text.path(Root::Tag(a), &[PathStep::Index(0)]),
    );
    let copy = text.stmt(StmtKind::Copy(to, from));
    let main = crate::hand::unit(&mut hir, "Main", text.body(&[copy]));
    crate::hand::every_scan(&mut hir, main);
    let mut run = Run::new(&hir, &trap());
    run.poke("a/0/0", 3);
    run.poke("a/0/1", 4);
    assert_eq!(run.scan(0), Ok(()));
    let found = ["a/1/0", "a/2/0", "a/2/1"].map(|path| run.number(path));
    assert_eq!(found, [0, 3, 4]);
}

#[test]
fn the_first_condition_that_holds_decides() {
    // IF n > 10 THEN r := 1 ELSIF n > 5 THEN r := 2 ELSE r := 3
    for (n, expected) in [(11, 1), (10, 2), (5, 3)] {
        let mut hir = program();
        let n = value(&mut hir, "n", E::Int, n);
        let r = value(&mut hir, "r", E::Int, 0);
        let mut text = Text::new();
        let arms = [(10, 1), (5, 2)].map(|(limit, result)| {
            let (left, right) = (text.get(E::Int, n), text.num(E::Int, limit));
            let condition = text.cmp(CompareOp::Greater, left, right);
            let result = text.num(E::Int, result);
            (condition, vec![text.set_tag(r, result)])
        });
        let three = text.num(E::Int, 3);
        let otherwise = vec![text.set_tag(r, three)];
        let branch = text.stmt(StmtKind::If {
            arms: arms.to_vec(),
            otherwise,
        });
        let run = Run::once(&mut hir, text.body(&[branch]), &trap());
        assert_eq!(run.number("r"), expected);
    }
}

#[test]
fn locals_keep_their_values_over_branches() {
    // x := 1; IF c THEN x := 2; END_IF; r := x
    for (c, expected) in [(0, 1), (1, 2)] {
        let mut hir = program();
        let c = value(&mut hir, "c", E::Bool, c);
        let r = value(&mut hir, "r", E::Int, 0);
        let mut text = Text::new();
        let x = text.local("x", one(E::Int));
        let first = text.num(E::Int, 1);
        let first = text.set_var(x, first);
        let second = text.num(E::Int, 2);
        let second = text.set_var(x, second);
        let condition = text.get(E::Bool, c);
        let branch = text.when(condition, vec![second], vec![]);
        let read = text.get_var(E::Int, x);
        let last = text.set_tag(r, read);
        let run = Run::once(&mut hir, text.body(&[first, branch, last]), &trap());
        assert_eq!(run.number("r"), expected);
    }
}

/// The arm of `CASE s OF` with these ranges, from 1; 0 for ELSE.
fn case(ty: E, ranges: &[&[(i64, i64)]], selector: i64) -> i64 {
    let mut hir = program();
    let s = value(&mut hir, "s", ty, selector as u64);
    let r = value(&mut hir, "r", E::Int, 77);
    let mut text = Text::new();
    let arm = |text: &mut Text, number| {
        let number = text.num(E::Int, number);
        vec![text.set_tag(r, number)]
    };
    let mask = u64::MAX >> (64 - ty.bits());
    let arms = (1..)
        .zip(ranges)
        .map(|(number, ranges)| {
            let bits = ranges.iter();
            let bits = bits.map(|&(low, high)| (low as u64 & mask, high as u64 & mask));
            (bits.collect(), arm(&mut text, number))
        })
        .collect();
    let otherwise = arm(&mut text, 0);
    let selector = text.get(ty, s);
    let case = text.stmt(StmtKind::Case {
        selector,
        arms,
        otherwise,
    });
    let run = Run::once(&mut hir, text.body(&[case]), &trap());
    run.number("r")
}

#[test]
fn a_case_takes_the_arm_whose_range_holds_the_selector() {
    let ranges: &[&[(i64, i64)]] = &[&[(1, 1), (3, 3)], &[(-10, -5)], &[(100, 20_000)]];
    for (selector, expected) in [
        (1, 1),
        (2, 0),
        (3, 1),
        (-10, 2),
        (-5, 2),
        (-4, 0),
        (-11, 0),
        (99, 0),
        (100, 3),
        (20_000, 3),
        (20_001, 0),
    ] {
        for ty in [E::Int, E::Dint, E::Lint] {
            assert_eq!(case(ty, ranges, selector), expected, "{ty:?} {selector}");
        }
    }
}

#[test]
fn ranges_of_unsigned_selectors_are_unsigned() {
    let ranges: &[&[(i64, i64)]] = &[&[(0, 99)], &[(100, 255)]];
    for (selector, expected) in [(0, 1), (99, 1), (100, 2), (255, 2)] {
        assert_eq!(case(E::Usint, ranges, selector), expected);
    }
    let all: &[&[(i64, i64)]] = &[&[(i64::MIN, 0)], &[(1, i64::MAX)]];
    assert_eq!(case(E::Lint, all, i64::MIN), 1);
    assert_eq!(case(E::Lint, all, 1), 2);
}

#[test]
fn a_case_with_more_numbers_than_a_switch_takes() {
    // 20 ranges of 64 numbers with a gap of one between them: 1280 in all.
    let ranges: Vec<[(i64, i64); 1]> = (0..20).map(|n| [(65 * n, 65 * n + 63)]).collect();
    let ranges: Vec<&[(i64, i64)]> = ranges.iter().map(<[_; 1]>::as_slice).collect();
    for n in [0, 7, 15, 16, 19] {
        assert_eq!(case(E::Dint, &ranges, 65 * n), n + 1);
        assert_eq!(case(E::Dint, &ranges, 65 * n + 63), n + 1);
        assert_eq!(case(E::Dint, &ranges, 65 * n + 64), 0);
    }
}

#[test]
fn a_case_without_arms_does_what_else_says() {
    assert_eq!(case(E::Int, &[], 5), 0);
}

#[test]
fn return_leaves_the_body() {
    // r := 1; IF c THEN RETURN; END_IF; r := 2
    for (c, expected) in [(1, 1), (0, 2)] {
        let mut hir = program();
        let c = value(&mut hir, "c", E::Bool, c);
        let r = value(&mut hir, "r", E::Int, 0);
        let mut text = Text::new();
        let [first, second] = [1, 2].map(|number| {
            let number = text.num(E::Int, number);
            text.set_tag(r, number)
        });
        let leave = text.stmt(StmtKind::Return);
        let unreached = text.bump(E::Int, r, 50);
        let condition = text.get(E::Bool, c);
        let branch = text.when(condition, vec![leave, unreached], vec![]);
        let run = Run::once(&mut hir, text.body(&[first, branch, second]), &trap());
        assert_eq!(run.number("r"), expected);
    }
}

#[test]
fn every_way_may_leave() {
    let mut hir = program();
    let r = value(&mut hir, "r", E::Int, 0);
    let mut text = Text::new();
    let condition = text.num(E::Bool, 1);
    let bump = text.bump(E::Int, r, 1);
    let leave = text.stmt(StmtKind::Return);
    let branch = text.when(condition, vec![bump, leave], vec![leave]);
    let behind = text.bump(E::Int, r, 10);
    let run = Run::once(&mut hir, text.body(&[branch, behind]), &trap());
    assert_eq!(run.number("r"), 1);
}

#[test]
fn an_effect_may_be_all_that_is_wanted() {
    use iecc_sema::hir::code::ExprKind;
    // (r := r + 1; 5 / r) as a statement, r = -1: the fault counts.
    let mut hir = program();
    let r = value(&mut hir, "r", E::Int, u64::MAX);
    let mut text = Text::new();
    let bump = text.bump(E::Int, r, 1);
    let (five, read) = (text.num(E::Int, 5), text.get(E::Int, r));
    let quotient = text.bin(BinaryOp::Divide, five, read);
    let after = text.expr(E::Int, ExprKind::After(vec![bump], quotient));
    let eval = text.stmt(StmtKind::Eval(after));
    let main = crate::hand::unit(&mut hir, "Main", text.body(&[eval]));
    crate::hand::every_scan(&mut hir, main);
    let mut run = Run::new(&hir, &trap());
    assert_eq!(run.scan(0), Err(iecc_ir::FaultCode::Divide));
    assert_eq!(run.number("r"), -1);
}
