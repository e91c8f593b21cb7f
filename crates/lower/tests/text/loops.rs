//! FOR, WHILE and REPEAT: passes, the variable behind them, and their limits.

use crate::hand::{Run, Text, continuing, every_scan, one, program, trap, unit, value};
use iecc_ir::FaultCode;
use iecc_lower::{OnFault, Options};
use iecc_sema::hir::code::{Root, StmtKind};
use iecc_sema::hir::{CompareOp, Elementary as E};

fn status(run: &Run, options: &Options) -> u64 {
    match options.on_fault {
        OnFault::Trap => 0,
        OnFault::Continue => run.bits("__status"),
    }
}

/// Which operands of FOR are constants.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Known {
    All,
    Step,
    None,
}

/// `FOR i := from TO to BY by DO n := n + 1; sum := sum + i; END_FOR`: passes, sum, i behind it.
fn count(
    options: &Options,
    known: Known,
    ty: E,
    local: bool,
    operands: [i128; 3],
) -> Result<(i64, i64, i64, u64), FaultCode> {
    let mut hir = program();
    let n = value(&mut hir, "n", E::Dint, 0);
    let [i, sum] = ["i", "sum"].map(|name| value(&mut hir, name, ty, 0));
    let mut text = Text::new();
    let x = text.local("x", one(ty));
    let variable = if local { Root::Local(x) } else { Root::Tag(i) };
    let [from, to, by] = [0, 1, 2].map(|index| {
        let constant = match known {
            Known::All => true,
            Known::Step => index == 2,
            Known::None => false,
        };
        if constant {
            text.num(ty, operands[index])
        } else {
            let tag = value(&mut hir, &format!("o{index}"), ty, operands[index] as u64);
            text.get(ty, tag)
        }
    });
    let bump = text.bump(E::Dint, n, 1);
    let variable = text.path(variable, &[]);
    let (old, more) = (text.get(ty, sum), text.load(ty, variable));
    let new = text.add(old, more);
    let add = text.set_tag(sum, new);
    let repeat = text.stmt(StmtKind::For {
        variable,
        from,
        to,
        by,
        body: vec![bump, add],
    });
    let read = text.load(ty, variable);
    let last = text.set_tag(i, read);
    let main = unit(&mut hir, "Main", text.body(&[repeat, last]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, options);
    run.scan(0)?;
    let status = status(&run, options);
    Ok((run.number("n"), run.number("sum"), run.number("i"), status))
}

/// From, to, by; passes, the sum of the variable, the variable behind the loop.
type Row = (E, [i128; 3], (i64, i64, i64));

const ROWS: &[Row] = &[
    (E::Int, [1, 10, 1], (10, 55, 11)),
    (E::Int, [10, 1, -1], (10, 55, 0)),
    (E::Int, [0, 10, 3], (4, 18, 12)),
    (E::Int, [10, 0, -4], (3, 18, -2)),
    (E::Int, [5, 4, 1], (0, 0, 5)),
    (E::Int, [4, 5, -1], (0, 0, 4)),
    (E::Int, [5, 5, 7], (1, 5, 12)),
    (E::Int, [-3, 3, 2], (4, 0, 5)),
    // At the ends of the types.
    (E::Usint, [0, 255, 1], (256, -128, 0)),
    (E::Usint, [250, 255, 2], (3, -12, 0)),
    (E::Usint, [250, 255, 10], (1, -6, 4)),
    (E::Sint, [-128, 127, 1], (256, -128, -128)),
    (E::Sint, [127, -128, -1], (256, -128, 127)),
    (E::Sint, [-128, 127, 127], (3, -3, -3)),
    (E::Sint, [127, -128, -128], (2, 126, 127)),
    (E::Int, [32760, 32767, 1], (8, -36, -32768)),
    (
        E::Dint,
        [0x7FFF_FFFE, 0x7FFF_FFFF, 1],
        (2, -3, -0x8000_0000),
    ),
    (
        E::Lint,
        [i64::MAX as i128 - 1, i64::MAX as i128, 1],
        (2, -3, i64::MIN),
    ),
    (
        E::Lint,
        [i64::MIN as i128, i64::MAX as i128, i64::MAX as i128],
        (3, -3, -3),
    ),
    (
        E::Lint,
        [i64::MAX as i128, i64::MIN as i128, i64::MIN as i128],
        (2, i64::MAX - 1, i64::MAX),
    ),
    (
        E::Ulint,
        [u64::MAX as i128 - 2, u64::MAX as i128, 1],
        (3, -6, 0),
    ),
    (E::Ulint, [0, u64::MAX as i128, 1 << 63], (2, i64::MIN, 0)),
];

#[test]
fn passes_and_the_variable_behind_them() {
    for &(ty, operands, expected) in ROWS {
        for known in [Known::All, Known::Step, Known::None] {
            for local in [false, true] {
                let found = count(&trap(), known, ty, local, operands);
                let (n, sum, i) = expected;
                let context = format!("{ty:?} {operands:?} {known:?} {local}");
                assert_eq!(found, Ok((n, sum, i, 0)), "{context}");
            }
        }
    }
}

#[test]
fn a_step_of_zero_is_a_fault_or_no_pass() {
    let operands = [3, 9, 0];
    let trapped = count(&trap(), Known::None, E::Int, false, operands);
    assert_eq!(trapped, Err(FaultCode::Range));
    let found = count(&continuing(), Known::None, E::Int, true, operands);
    assert_eq!(found, Ok((0, 0, 3, 4)));
}

#[test]
fn a_for_with_more_passes_than_the_limit_does_not_begin() {
    let limited = |options: Options| Options {
        loop_limit: 300,
        ..options
    };
    for known in [Known::All, Known::Step, Known::None] {
        let exact = count(&limited(trap()), known, E::Int, false, [1, 300, 1]);
        assert_eq!(exact.map(|found| found.0), Ok(300));
        let exact = count(&limited(trap()), known, E::Int, false, [0, 899, 3]);
        assert_eq!(exact.map(|found| found.0), Ok(300));
        for operands in [[1, 301, 1], [301, 1, -1], [0, 900, 3]] {
            let trapped = count(&limited(trap()), known, E::Int, false, operands);
            assert_eq!(trapped, Err(FaultCode::Bound), "{operands:?}");
            let found = count(&limited(continuing()), known, E::Int, false, operands);
            // Bit 6 of the status is fault 7.
            let first = operands[0] as i64;
            assert_eq!(found, Ok((0, 0, first, 64)), "{operands:?}");
        }
    }
    let widest = [i64::MIN.into(), i64::MAX.into(), 1];
    for known in [Known::All, Known::None] {
        let trapped = count(&trap(), known, E::Lint, true, widest);
        assert_eq!(trapped, Err(FaultCode::Bound));
    }
}

/// A FOR from 1 to 10 that counts passes in n and, unless the variable is 4, in m as well.
fn leaving(kind: StmtKind) -> (i64, i64, i64) {
    let mut hir = program();
    let [n, m, i] = ["n", "m", "i"].map(|name| value(&mut hir, name, E::Int, 0));
    let mut text = Text::new();
    let [from, to, by] = [1, 10, 1].map(|number| text.num(E::Int, number));
    let first = text.bump(E::Int, n, 1);
    let (at, four) = (text.get(E::Int, i), text.num(E::Int, 4));
    let is = text.cmp(CompareOp::Equal, at, four);
    let leave = text.stmt(kind);
    let branch = text.when(is, vec![leave], vec![]);
    let last = text.bump(E::Int, m, 1);
    let variable = text.tag(i);
    let repeat = text.stmt(StmtKind::For {
        variable,
        from,
        to,
        by,
        body: vec![first, branch, last],
    });
    let run = Run::once(&mut hir, text.body(&[repeat]), &trap());
    (run.number("n"), run.number("m"), run.number("i"))
}

#[test]
fn exit_keeps_the_variable_and_continue_goes_on() {
    assert_eq!(leaving(StmtKind::Exit), (4, 3, 4));
    assert_eq!(leaving(StmtKind::Continue), (10, 9, 11));
    assert_eq!(leaving(StmtKind::Return), (4, 3, 4));
}

#[test]
fn the_operands_of_for_are_evaluated_once() {
    // FOR i := a TO b BY c DO a := 9; b := 0; c := 9; n := n + 1; END_FOR
    let mut hir = program();
    let [n, i] = ["n", "i"].map(|name| value(&mut hir, name, E::Int, 0));
    let tags =
        [("a", 1), ("b", 5), ("c", 2)].map(|(name, bits)| value(&mut hir, name, E::Int, bits));
    let mut text = Text::new();
    let [from, to, by] = tags.map(|tag| text.get(E::Int, tag));
    let mut body: Vec<_> = tags
        .iter()
        .zip([9, 0, 9])
        .map(|(&tag, number)| {
            let number = text.num(E::Int, number);
            text.set_tag(tag, number)
        })
        .collect();
    body.push(text.bump(E::Int, n, 1));
    let variable = text.tag(i);
    let repeat = text.stmt(StmtKind::For {
        variable,
        from,
        to,
        by,
        body,
    });
    let run = Run::once(&mut hir, text.body(&[repeat]), &trap());
    assert_eq!((run.number("n"), run.number("i")), (3, 7));
}

/// Counts i up to `to` in a WHILE or REPEAT, and says where it is behind it.
fn until(options: &Options, repeat: bool, from: u64, to: i128) -> Result<(i64, u64), FaultCode> {
    let mut hir = program();
    let i = value(&mut hir, "i", E::Dint, from);
    let mut text = Text::new();
    let bump = text.bump(E::Dint, i, 1);
    let (at, to) = (text.get(E::Dint, i), text.num(E::Dint, to));
    let kind = if repeat {
        StmtKind::Repeat(vec![bump], text.cmp(CompareOp::GreaterEqual, at, to))
    } else {
        StmtKind::While(text.cmp(CompareOp::Less, at, to), vec![bump])
    };
    let repeat = text.stmt(kind);
    let main = unit(&mut hir, "Main", text.body(&[repeat]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, options);
    run.scan(0)?;
    Ok((run.number("i"), status(&run, options)))
}

#[test]
fn while_tests_before_and_repeat_behind_each_pass() {
    assert_eq!(until(&trap(), false, 0, 5), Ok((5, 0)));
    assert_eq!(until(&trap(), true, 0, 5), Ok((5, 0)));
    assert_eq!(until(&trap(), false, 9, 5), Ok((9, 0)));
    assert_eq!(until(&trap(), true, 9, 5), Ok((10, 0)));
}

#[test]
fn loops_that_do_not_end_are_ended() {
    let limited = |options: Options| Options {
        loop_limit: 20,
        ..options
    };
    for repeat in [false, true] {
        assert_eq!(until(&limited(trap()), repeat, 0, 20), Ok((20, 0)));
        assert_eq!(
            until(&limited(trap()), repeat, 0, 21),
            Err(FaultCode::Bound)
        );
        assert_eq!(until(&limited(continuing()), repeat, 0, 21), Ok((20, 64)));
    }
}

#[test]
fn exit_and_continue_mean_the_innermost_loop() {
    // FOR i := 1 TO 3 DO
    //   j := 0;
    //   WHILE TRUE DO j := j + 1; IF j < 4 THEN CONTINUE; END_IF; EXIT; n := 100; END_WHILE;
    //   n := n + j;
    // END_FOR
    let mut hir = program();
    let [i, n] = ["i", "n"].map(|name| value(&mut hir, name, E::Int, 0));
    let mut text = Text::new();
    let j = text.local("j", one(E::Int));
    let [from, to, by, zero] = [1, 3, 1, 0].map(|number| text.num(E::Int, number));
    let start = text.set_var(j, zero);
    let (old, more) = (text.get_var(E::Int, j), text.num(E::Int, 1));
    let sum = text.add(old, more);
    let step = text.set_var(j, sum);
    let (at, four) = (text.get_var(E::Int, j), text.num(E::Int, 4));
    let small = text.cmp(CompareOp::Less, at, four);
    let again = text.stmt(StmtKind::Continue);
    let branch = text.when(small, vec![again], vec![]);
    let exit = text.stmt(StmtKind::Exit);
    let unreached = text.bump(E::Int, n, 100);
    let always = text.num(E::Bool, 1);
    let body = vec![step, branch, exit, unreached];
    let inner = text.stmt(StmtKind::While(always, body));
    let (old, more) = (text.get(E::Int, n), text.get_var(E::Int, j));
    let sum = text.add(old, more);
    let add = text.set_tag(n, sum);
    let variable = text.tag(i);
    let outer = text.stmt(StmtKind::For {
        variable,
        from,
        to,
        by,
        body: vec![start, inner, add],
    });
    let run = Run::once(&mut hir, text.body(&[outer]), &trap());
    assert_eq!((run.number("n"), run.number("i")), (12, 4));
}

#[test]
fn a_loop_whose_body_always_leaves_runs_once() {
    for exit in [StmtKind::Exit, StmtKind::Return] {
        for repeat in [false, true] {
            let mut hir = program();
            let n = value(&mut hir, "n", E::Int, 0);
            let mut text = Text::new();
            let bump = text.bump(E::Int, n, 1);
            let exit = text.stmt(exit.clone());
            let condition = text.num(E::Bool, u64::from(!repeat).into());
            let kind = if repeat {
                StmtKind::Repeat(vec![bump, exit], condition)
            } else {
                StmtKind::While(condition, vec![bump, exit])
            };
            let stmt = text.stmt(kind);
            let run = Run::once(&mut hir, text.body(&[stmt]), &trap());
            assert_eq!(run.number("n"), 1);
        }
    }
}
