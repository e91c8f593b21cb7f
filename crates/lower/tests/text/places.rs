//! Every way into a place, read and written, inside and outside of its bounds.

use crate::hand::{
    Run, Text, array, continuing, every_scan, init, one, program, string, structure, tag, trap,
    unit, value,
};
use iecc_ir::FaultCode;
use iecc_lower::Options;
use iecc_sema::hir::code::{Init, PathStep, Root};
use iecc_sema::hir::{Elementary as E, StructKind};

/// `r := a[s]; a[s] := 99` for `a: ARRAY[low..low+3] OF INT := [10, 20, 30, 40]`.
fn subscripted(options: &Options, ty: E, low: i64, subscript: u64) -> Result<Run, FaultCode> {
    let mut hir = program();
    let elements = [10, 20, 30, 40].map(|bits| init(&mut hir, Init::Bits(bits)));
    let runs = (0..).zip(elements).map(|(at, value)| (at, 1, value));
    let whole = init(&mut hir, Init::Array(runs.collect()));
    let ints = array(&mut hir, one(E::Int), 4);
    let a = tag(&mut hir, "a", ints);
    hir.tags[a.index()].init = Some(whole);
    let s = value(&mut hir, "s", ty, subscript);
    let r = value(&mut hir, "r", E::Int, 7);
    let mut text = Text::new();
    let at = text.get(ty, s);
    let step = PathStep::IndexBy {
        value: at,
        low,
        checked: false,
    };
    let element = text.path(Root::Tag(a), &[step]);
    let read = text.load(E::Int, element);
    let first = text.set_tag(r, read);
    let new = text.num(E::Int, 99);
    let second = text.set(element, new);
    let main = unit(&mut hir, "Main", text.body(&[first, second]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, options);
    run.scan(0)?;
    Ok(run)
}

fn elements(run: &Run) -> [i64; 4] {
    ["a/0", "a/1", "a/2", "a/3"].map(|path| run.number(path))
}

#[test]
fn subscripts_inside_of_the_bounds() {
    for ty in [E::Sint, E::Int, E::Dint, E::Lint] {
        for (low, subscript, at) in [(0, 0, 0), (0, 3, 3), (1, 1, 0), (-2, -2, 0), (-2, 1, 3)] {
            let run = subscripted(&trap(), ty, low, subscript as u64).unwrap();
            assert_eq!(run.number("r"), 10 * (at + 1), "{ty:?} {low} {subscript}");
            let mut expected = [10, 20, 30, 40];
            expected[at as usize] = 99;
            assert_eq!(elements(&run), expected, "{ty:?} {low} {subscript}");
        }
    }
    for ty in [E::Usint, E::Uint, E::Udint, E::Ulint] {
        for (low, subscript, at) in [(0, 3, 3), (1, 4, 3), (-2, 0, 2), (-2, 1, 3)] {
            let run = subscripted(&trap(), ty, low, subscript).unwrap();
            assert_eq!(run.number("r"), 10 * (at + 1), "{ty:?} {low} {subscript}");
        }
    }
}

#[test]
fn subscripts_outside_of_the_bounds_fault_or_do_nothing() {
    let outside: &[(E, i64, u64)] = &[
        (E::Sint, 0, 4),
        (E::Sint, 0, 0xFF),
        (E::Sint, -128, 0x7F),
        (E::Usint, 0, 255),
        (E::Usint, 250, 0),
        (E::Int, 1, 0),
        (E::Int, 1, 5),
        (E::Uint, -2, 2),
        (E::Dint, 0, 0x8000_0000),
        (E::Dint, -0x8000_0000, 0x7FFF_FFFF),
        // 2^31 - 4 is the lower bound; the least number must not wrap to it.
        (E::Dint, 0x7FFF_FFFC, 0x8000_0000),
        (E::Udint, -1, 0xFFFF_FFFF),
        (E::Udint, 1, 0),
        (E::Udint, 0, 0x1_0000_0000 - 1),
        // As numbers of 32 bits these would be inside.
        (E::Lint, 0, 0x1_0000_0000),
        (E::Lint, 0, 0xFFFF_FFFF_0000_0001),
        (E::Lint, 1, 0x8000_0000_0000_0000),
        (E::Lint, i64::MAX - 3, 0x8000_0000_0000_0000),
        (E::Lint, i64::MIN, 0x7FFF_FFFF_FFFF_FFFF),
        (E::Ulint, 0, 0x1_0000_0000),
        (E::Ulint, 0, u64::MAX),
        // Less the lower bound this wraps to 0.
        (E::Ulint, -1, u64::MAX),
        (E::Ulint, -3, u64::MAX - 1),
        (E::Ulint, i64::MIN, 1 << 63),
        (E::Ulint, 1, 0),
    ];
    for &(ty, low, subscript) in outside {
        let context = format!("{ty:?} {low} {subscript:#x}");
        let trapped = subscripted(&trap(), ty, low, subscript);
        assert_eq!(trapped.err(), Some(FaultCode::Index), "{context}");
        let run = subscripted(&continuing(), ty, low, subscript).unwrap();
        assert_eq!(run.number("r"), 0, "{context}");
        assert_eq!(elements(&run), [10, 20, 30, 40], "{context}");
        assert_eq!(run.bits("__status"), 1, "{context}");
    }
}

#[test]
fn bounds_at_the_ends_of_the_widest_types() {
    for (ty, low, subscript, at) in [
        (E::Lint, i64::MIN, i64::MIN as u64 + 2, 2),
        (E::Lint, i64::MAX - 3, i64::MAX as u64, 3),
        (E::Ulint, i64::MAX - 3, i64::MAX as u64 - 3, 0),
        (E::Dint, 0x7FFF_FFFC, 0x7FFF_FFFF, 3),
        (E::Udint, 0xFFFF_FFFC, 0xFFFF_FFFF, 3),
        (E::Ulint, -3, 0, 3),
    ] {
        let run = subscripted(&trap(), ty, low, subscript).unwrap();
        assert_eq!(
            run.number("r"),
            10 * (at + 1),
            "{ty:?} {low} {subscript:#x}"
        );
    }
}

#[test]
fn a_constant_subscript_needs_no_test() {
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 4);
    let a = tag(&mut hir, "a", ints);
    let mut text = Text::new();
    let two = text.num(E::Int, 2);
    let step = PathStep::IndexBy {
        value: two,
        low: 1,
        checked: false,
    };
    let element = text.path(Root::Tag(a), &[step]);
    let new = text.num(E::Int, 5);
    let set = text.set(element, new);
    let run = Run::once(&mut hir, text.body(&[set]), &trap());
    assert_eq!(run.number("a/1"), 5);
    assert!(!iecc_ir::print_module(run.module()).contains("fault"));
}

#[test]
fn members_and_elements() {
    let mut hir = program();
    let point = structure(
        &mut hir,
        "POINT",
        StructKind::Plain,
        &[("X", one(E::Int)), ("Y", one(E::Dint))],
    );
    let points = array(&mut hir, point, 2);
    let p = tag(&mut hir, "p", points);
    let mut text = Text::new();
    let y = text.path(Root::Tag(p), &[PathStep::Index(1), PathStep::Field(1)]);
    let new = text.num(E::Dint, -3);
    let set = text.set(y, new);
    let run = Run::once(&mut hir, text.body(&[set]), &trap());
    assert_eq!((run.number("p/1/Y"), run.number("p/0/Y")), (-3, 0));
}

/// `r := part of w; part of w := new`, `w` as a tag or as a local.
fn parts(first: u32, count: u32, ty: E, word: u64, new: u64, local: bool) -> (u64, u64) {
    let mut hir = program();
    let w = value(&mut hir, "w", E::Udint, word);
    let r = value(&mut hir, "r", ty, 0);
    let mut text = Text::new();
    let copy = text.local("copy", one(E::Udint));
    let step = [PathStep::Bits { first, count }];
    let load = text.get(E::Udint, w);
    let before = text.set_var(copy, load);
    let root = if local {
        Root::Local(copy)
    } else {
        Root::Tag(w)
    };
    let part = text.path(root, &step);
    let read = text.load(ty, part);
    let first = text.set_tag(r, read);
    let new = text.num(ty, i128::from(new));
    let second = text.set(part, new);
    let whole = text.path(root, &[]);
    let read = text.load(E::Udint, whole);
    let after = text.set_tag(w, read);
    let run = Run::once(
        &mut hir,
        text.body(&[before, first, second, after]),
        &trap(),
    );
    (run.bits("r"), run.bits("w"))
}

#[test]
fn parts_of_a_word() {
    for local in [false, true] {
        let word = 0x8765_4321;
        assert_eq!(parts(0, 1, E::Bool, word, 0, local), (1, 0x8765_4320));
        assert_eq!(parts(31, 1, E::Bool, word, 0, local), (1, 0x0765_4321));
        assert_eq!(parts(1, 1, E::Bool, word, 1, local), (0, 0x8765_4323));
        assert_eq!(
            parts(8, 8, E::Usint, word, 0xAB, local),
            (0x43, 0x8765_AB21)
        );
        assert_eq!(parts(24, 8, E::Usint, word, 0, local), (0x87, 0x0065_4321));
        assert_eq!(
            parts(16, 16, E::Uint, word, 0xFFFF, local),
            (0x8765, 0xFFFF_4321)
        );
        assert_eq!(parts(0, 32, E::Udint, word, 5, local), (word, 5));
    }
}

#[test]
fn values_in_bytes_are_little_endian() {
    let mut hir = program();
    let bytes = array(&mut hir, one(E::Usint), 16);
    let m = tag(&mut hir, "m", bytes);
    let cases = [
        (E::Usint, 0, 0x12),
        (E::Int, 2, 0x3456),
        (E::Real, 4, u64::from(1.5_f32.to_bits())),
        (E::Ulint, 8, 0x1122_3344_5566_7788),
    ];
    let mut text = Text::new();
    let mut body = Vec::new();
    for (index, (ty, offset, bits)) in cases.into_iter().enumerate() {
        let from = value(&mut hir, &format!("x{index}"), ty, bits);
        let to = value(&mut hir, &format!("r{index}"), ty, 0);
        let bytes = text.path(Root::Tag(m), &[PathStep::Bytes { offset, ty }]);
        let load = text.get(ty, from);
        body.push(text.set(bytes, load));
        let back = text.load(ty, bytes);
        body.push(text.set_tag(to, back));
    }
    let run = Run::once(&mut hir, text.body(&body), &trap());
    for (index, (_, _, bits)) in cases.into_iter().enumerate() {
        assert_eq!(run.bits(&format!("r{index}")), bits);
    }
    let found: Vec<u64> = (0..16).map(|at| run.bits(&format!("m/{at}"))).collect();
    let mut expected = vec![0x12, 0, 0x56, 0x34, 0x00, 0x00, 0xC0, 0x3F];
    expected.extend([0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11]);
    assert_eq!(found, expected);
}

/// `r := s[p]; s[p] := 'z'` for a string of 3 of 5 characters.
fn character(options: &Options, ty: E, position: u64, checked: bool) -> Result<Run, FaultCode> {
    let mut hir = program();
    let text_type = string(&mut hir, 5);
    let s = tag(&mut hir, "s", text_type);
    let p = value(&mut hir, "p", ty, position);
    let r = value(&mut hir, "r", E::Usint, 1);
    let mut text = Text::new();
    let at = text.get(ty, p);
    let step = PathStep::Character { value: at, checked };
    let place = text.path(Root::Tag(s), &[step]);
    let read = text.load(E::Usint, place);
    let first = text.set_tag(r, read);
    let z = text.num(E::Usint, i128::from(b'z'));
    let second = text.set(place, z);
    let main = unit(&mut hir, "Main", text.body(&[first, second]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, options);
    run.poke("s/LEN", 3);
    for (at, byte) in (0..).zip(*b"abcde") {
        run.poke(&format!("s/DATA/{at}"), u64::from(byte));
    }
    run.scan(0)?;
    Ok(run)
}

#[test]
fn characters_count_from_one_to_the_length() {
    for ty in [E::Sint, E::Usint, E::Dint, E::Udint, E::Lint, E::Ulint] {
        let run = character(&trap(), ty, 3, false).unwrap();
        assert_eq!(run.bits("r"), u64::from(b'c'));
        assert_eq!(run.bits("s/DATA/2"), u64::from(b'z'));
        for position in [0, 4, 0xFF & scalar_mask(ty), scalar_mask(ty)] {
            let trapped = character(&trap(), ty, position, false);
            assert_eq!(trapped.err(), Some(FaultCode::Index), "{ty:?} {position}");
            let run = character(&continuing(), ty, position, false).unwrap();
            assert_eq!((run.bits("r"), run.bits("__status")), (0, 1));
        }
    }
}

fn scalar_mask(ty: E) -> u64 {
    u64::MAX >> (64 - ty.bits())
}

#[test]
fn positions_that_are_not_tested_reach_all_that_is_there() {
    for ty in [E::Sint, E::Udint, E::Lint, E::Ulint] {
        let run = character(&trap(), ty, 5, true).unwrap();
        assert_eq!(run.bits("r"), u64::from(b'e'));
        assert_eq!(run.bits("s/DATA/4"), u64::from(b'z'));
        for position in [0, 6, scalar_mask(ty)] {
            let run = character(&trap(), ty, position, true).unwrap();
            assert_eq!(run.bits("r"), 0, "{ty:?} {position}");
        }
    }
    let run = character(&trap(), E::Lint, 0x1_0000_0001, true).unwrap();
    assert_eq!(run.bits("r"), 0);
}

#[test]
fn the_value_comes_before_the_indices_of_its_target_and_these_once() {
    // a[i] := (i := i + 1; i): stores 1 at 1; then a[(i := i + 1; i)] := 7 at 2 only.
    use iecc_sema::hir::code::ExprKind;
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 4);
    let a = tag(&mut hir, "a", ints);
    let i = value(&mut hir, "i", E::Int, 0);
    let mut text = Text::new();
    let counted = |text: &mut Text| {
        let bump = text.bump(E::Int, i, 1);
        let read = text.get(E::Int, i);
        text.expr(E::Int, ExprKind::After(vec![bump], read))
    };
    let new = counted(&mut text);
    let by = |value| PathStep::IndexBy {
        value,
        low: 0,
        checked: false,
    };
    let at = text.get(E::Int, i);
    let first = text.path(Root::Tag(a), &[by(at)]);
    let first = text.set(first, new);
    let at = counted(&mut text);
    let second = text.path(Root::Tag(a), &[by(at)]);
    let seven = text.num(E::Int, 7);
    let second = text.set(second, seven);
    let run = Run::once(&mut hir, text.body(&[first, second]), &trap());
    let found = ["a/0", "a/1", "a/2", "a/3", "i"].map(|path| run.number(path));
    assert_eq!(found, [0, 1, 7, 0, 2]);
}

#[test]
fn faults_say_where() {
    let mut hir = program();
    let ints = array(&mut hir, one(E::Int), 4);
    let a = tag(&mut hir, "a", ints);
    let i = value(&mut hir, "i", E::Int, 4);
    let mut text = Text::new();
    let at = text.get(E::Int, i);
    let step = PathStep::IndexBy {
        value: at,
        low: 0,
        checked: false,
    };
    let place = text.path(Root::Tag(a), &[step]);
    let one = text.num(E::Int, 1);
    let set = text.set(place, one);
    let main = unit(&mut hir, "Main", text.body(&[set]));
    every_scan(&mut hir, main);
    assert_eq!(Run::new(&hir, &trap()).fault_label(), "Main");
}
