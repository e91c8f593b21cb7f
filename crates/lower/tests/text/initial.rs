//! Initial values: of tags in the image, of places while a program runs.

use crate::hand::{Run, Text, array, every_scan, init, one, program, structure, tag, unit, value};
use iecc_lower::Options;
use iecc_sema::hir::code::{Init, InitId, Root, StmtKind};
use iecc_sema::hir::{Elementary as E, Program, Step, StructKind, Type};

/// ARRAY[0..19] OF STRUCT A : ARRAY[0..2] OF INT; B : BOOL; C : LREAL; END_STRUCT
/// := [3(), 12((A := [5, 2(6)], C := 0.5)), (B := TRUE)]
fn records(hir: &mut Program) -> (Type, InitId) {
    let ints = array(hir, one(E::Int), 3);
    let members = [("A", ints), ("B", one(E::Bool)), ("C", one(E::Lreal))];
    let record = structure(hir, "RECORD", StructKind::Plain, &members);
    let [five, six] = [5, 6].map(|bits| init(hir, Init::Bits(bits)));
    let half = init(hir, Init::Bits(0.5_f64.to_bits()));
    let on = init(hir, Init::Bits(1));
    let a = init(hir, Init::Array(vec![(0, 1, five), (1, 2, six)]));
    let filled = init(hir, Init::Struct(vec![(0, a), (2, half)]));
    let last = init(hir, Init::Struct(vec![(1, on)]));
    let zero = init(hir, Init::Zero);
    let runs = vec![(0, 3, zero), (3, 12, filled), (15, 1, last)];
    let whole = init(hir, Init::Array(runs));
    (array(hir, record, 20), whole)
}

fn check_records(run: &Run, name: &str) {
    for at in 0..20 {
        let filled = (3..15).contains(&at);
        let path = |member: &str| format!("{name}/{at}/{member}");
        let ints = ["A/0", "A/1", "A/2"].map(|member| run.number(&path(member)));
        assert_eq!(ints, if filled { [5, 6, 6] } else { [0; 3] }, "{name} {at}");
        assert_eq!(run.number(&path("B")), i64::from(at == 15));
        let half = if filled { 0.5_f64 } else { 0.0 };
        assert_eq!(run.bits(&path("C")), half.to_bits());
    }
}

#[test]
fn tags_begin_with_their_values() {
    let mut hir = program();
    let (ty, whole) = records(&mut hir);
    let t = tag(&mut hir, "t", ty);
    hir.tags[t.index()].init = Some(whole);
    value(&mut hir, "n", E::Sint, 0x80);
    let main = unit(&mut hir, "Main", Text::new());
    every_scan(&mut hir, main);
    let run = Run::new(&hir, &Options::default());
    check_records(&run, "t");
    assert_eq!(run.number("n"), -128);
}

#[test]
fn leaves_go_over_whole_values() {
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 3);
    let one_ = init(&mut hir, Init::Bits(1));
    let ones = init(&mut hir, Init::Array(vec![(0, 3, one_)]));
    let t = tag(&mut hir, "t", ints);
    hir.tags[t.index()].init = Some(ones);
    hir.tags[t.index()].initial = vec![(vec![Step::Index(1)], 9)];
    let main = unit(&mut hir, "Main", Text::new());
    every_scan(&mut hir, main);
    let run = Run::new(&hir, &Options::default());
    let found = ["t/0", "t/1", "t/2"].map(|path| run.number(path));
    assert_eq!(found, [1, 9, 1]);
}

#[test]
fn places_are_initialised_while_the_program_runs() {
    // A local gets its value and is copied to a tag that had other values.
    let mut hir = program();
    let (ty, whole) = records(&mut hir);
    let t = tag(&mut hir, "t", ty);
    let direct = tag(&mut hir, "direct", ty);
    let n = value(&mut hir, "n", E::Int, 3);
    let minus = init(&mut hir, Init::Bits(u64::MAX));
    let zero = init(&mut hir, Init::Zero);
    let mut text = Text::new();
    let local = text.local("local", ty);
    let x = text.local("x", one(E::Int));
    let (from, to, other) = (text.var(local), text.tag(t), text.tag(direct));
    let (scalar, result) = (text.var(x), text.tag(n));
    let read = text.load(E::Int, scalar);
    let mut body = vec![
        text.stmt(StmtKind::Initialise(from, whole)),
        text.stmt(StmtKind::Copy(to, from)),
        text.stmt(StmtKind::Initialise(other, whole)),
        text.stmt(StmtKind::Initialise(scalar, minus)),
        text.set(result, read),
    ];
    let main = unit(&mut hir, "Main", text.body(&body));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, &Options::default());
    for at in 0..20 {
        run.poke(&format!("t/{at}/A/1"), 77);
        run.poke(&format!("direct/{at}/B"), 1);
    }
    assert_eq!(run.scan(0), Ok(()));
    check_records(&run, "t");
    check_records(&run, "direct");
    assert_eq!(run.number("n"), -1);

    let mut text = Text::new();
    let (all, leaf) = (text.path(Root::Tag(t), &[]), text.tag(n));
    body = vec![
        text.stmt(StmtKind::Initialise(all, zero)),
        text.stmt(StmtKind::Initialise(leaf, zero)),
    ];
    let again = unit(&mut hir, "Again", text.body(&body));
    hir.tasks[0].calls.push(again);
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!(run.scan(0), Ok(()));
    assert_eq!((run.number("t/5/A/1"), run.number("n")), (0, 0));
}
