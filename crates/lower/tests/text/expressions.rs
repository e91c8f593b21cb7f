//! Every expression, with operands that are no constants unless that is the point.

use crate::hand::{Run, Text, continuing, every_scan, program, tag, unit, value};
use iecc_ir::FaultCode;
use iecc_lower::Options;
use iecc_sema::hir::code::{BinaryOp, Conversion, ExprKind, UnaryOp};
use iecc_sema::hir::{CompareOp, Elementary, Elementary as E};

const TRAP: fn() -> Options = Options::default;

/// The bits of `r := build(operands)`.
fn evaluate(
    options: &Options,
    result: Elementary,
    operands: &[(Elementary, u64)],
    kind: impl FnOnce(&[iecc_sema::hir::code::ExprId]) -> ExprKind,
) -> Result<(u64, u64), FaultCode> {
    let mut hir = program();
    let mut text = Text::new();
    let args: Vec<_> = operands
        .iter()
        .enumerate()
        .map(|(index, &(ty, bits))| {
            let tag = value(&mut hir, &format!("x{index}"), ty, bits);
            text.get(ty, tag)
        })
        .collect();
    let to = tag(&mut hir, "r", crate::hand::one(result));
    let expr = text.expr(result, kind(&args));
    let set = text.set_tag(to, expr);
    let main = unit(&mut hir, "Main", text.body(&[set]));
    every_scan(&mut hir, main);
    let mut run = Run::new(&hir, options);
    run.scan(0)?;
    let status = if options.on_fault == iecc_lower::OnFault::Continue {
        run.bits("__status")
    } else {
        0
    };
    Ok((run.bits("r"), status))
}

fn binary(op: BinaryOp, ty: Elementary, a: i64, b: i64) -> i64 {
    let bits = evaluate(&TRAP(), ty, &[(ty, a as u64), (ty, b as u64)], |x| {
        ExprKind::Binary(op, x[0], x[1])
    });
    signed(ty, bits.unwrap().0)
}

fn signed(ty: Elementary, bits: u64) -> i64 {
    if !ty.is_signed() {
        return bits as i64;
    }
    let unused = 64 - ty.bits();
    ((bits << unused) as i64) >> unused
}

fn lreal(op: BinaryOp, a: f64, b: f64) -> f64 {
    let operands = [(E::Lreal, a.to_bits()), (E::Lreal, b.to_bits())];
    let bits = evaluate(&TRAP(), E::Lreal, &operands, |x| {
        ExprKind::Binary(op, x[0], x[1])
    });
    f64::from_bits(bits.unwrap().0)
}

#[test]
fn arithmetic_wraps_at_the_width() {
    assert_eq!(binary(BinaryOp::Add, E::Int, 32767, 1), -32768);
    assert_eq!(binary(BinaryOp::Add, E::Usint, 200, 100), 44);
    assert_eq!(binary(BinaryOp::Subtract, E::Uint, 0, 1), 65535);
    assert_eq!(binary(BinaryOp::Multiply, E::Sint, 64, 2), -128);
    assert_eq!(binary(BinaryOp::Add, E::Lint, i64::MAX, 1), i64::MIN);
    assert_eq!(lreal(BinaryOp::Add, 0.5, 0.25), 0.75);
    assert_eq!(lreal(BinaryOp::Subtract, 0.5, 0.25), 0.25);
    assert_eq!(lreal(BinaryOp::Multiply, 3.0, -0.5), -1.5);
    assert_eq!(lreal(BinaryOp::Divide, 1.0, 0.0), f64::INFINITY);
}

#[test]
fn division_truncates_and_the_remainder_has_the_sign_of_the_dividend() {
    for (a, b, quotient, rest) in [(7, 3, 2, 1), (-7, 3, -2, -1), (7, -3, -2, 1)] {
        assert_eq!(binary(BinaryOp::Divide, E::Dint, a, b), quotient);
        assert_eq!(binary(BinaryOp::Modulo, E::Dint, a, b), rest);
    }
    assert_eq!(binary(BinaryOp::Divide, E::Usint, 250, 7), 35);
    assert_eq!(binary(BinaryOp::Modulo, E::Usint, 250, 7), 5);
    assert_eq!(binary(BinaryOp::Divide, E::Sint, -128, -1), -128);
}

#[test]
fn division_by_zero_is_a_fault_or_gives_zero() {
    let operands = [(E::Dint, 7), (E::Dint, 0)];
    let divide = |options: &Options, op| {
        evaluate(options, E::Dint, &operands, |x| {
            ExprKind::Binary(op, x[0], x[1])
        })
    };
    assert_eq!(divide(&TRAP(), BinaryOp::Divide), Err(FaultCode::Divide));
    // Bit 1 of the status is fault 2.
    assert_eq!(divide(&continuing(), BinaryOp::Divide), Ok((0, 2)));
    assert_eq!(divide(&TRAP(), BinaryOp::DivideUnchecked), Ok((0, 0)));
    assert_eq!(divide(&TRAP(), BinaryOp::Modulo), Ok((0, 0)));
    assert_eq!(divide(&continuing(), BinaryOp::Modulo), Ok((0, 0)));
}

#[test]
fn bitwise_operations() {
    assert_eq!(binary(BinaryOp::And, E::Usint, 0b1100, 0b1010), 0b1000);
    assert_eq!(binary(BinaryOp::Or, E::Usint, 0b1100, 0b1010), 0b1110);
    assert_eq!(binary(BinaryOp::Xor, E::Usint, 0b1100, 0b1010), 0b0110);
    assert_eq!(binary(BinaryOp::And, E::Bool, 1, 0), 0);
}

#[test]
fn shifts_fill_with_zero_and_give_zero_from_the_width_on() {
    let shift = |op, ty: Elementary, bits: u64, count: u64| {
        let operands = [(ty, bits), (E::Udint, count)];
        let result = evaluate(&TRAP(), ty, &operands, |x| ExprKind::Binary(op, x[0], x[1]));
        result.unwrap().0
    };
    let (left, right) = (BinaryOp::ShiftLeft, BinaryOp::ShiftRight);
    assert_eq!(shift(left, E::Usint, 0x81, 1), 0x02);
    assert_eq!(shift(left, E::Usint, 0x81, 8), 0);
    assert_eq!(shift(left, E::Usint, 0x81, 31), 0);
    assert_eq!(shift(left, E::Usint, 0x81, 32), 0);
    assert_eq!(shift(right, E::Usint, 0x81, 7), 1);
    assert_eq!(shift(right, E::Int, 0x8000, 15), 1);
    assert_eq!(shift(right, E::Udint, 0x8000_0000, 31), 1);
    assert_eq!(shift(right, E::Udint, 0x8000_0000, 32), 0);
    assert_eq!(shift(left, E::Ulint, 1, 63), 1 << 63);
    assert_eq!(shift(left, E::Ulint, 1, 64), 0);
    assert_eq!(shift(right, E::Ulint, u64::MAX, 0xFFFF_FFFF), 0);
    assert_eq!(shift(left, E::Bool, 1, 0), 1);
    assert_eq!(shift(left, E::Bool, 1, 1), 0);
}

#[test]
fn operations_with_one_operand() {
    let unary = |op, ty: Elementary, bits: u64| {
        evaluate(&TRAP(), ty, &[(ty, bits)], |x| ExprKind::Unary(op, x[0]))
            .unwrap()
            .0
    };
    assert_eq!(signed(E::Int, unary(UnaryOp::Negate, E::Int, 5)), -5);
    assert_eq!(signed(E::Sint, unary(UnaryOp::Negate, E::Sint, 0x80)), -128);
    assert_eq!(unary(UnaryOp::Not, E::Usint, 0x0F), 0xF0);
    assert_eq!(unary(UnaryOp::Not, E::Bool, 1), 0);
    assert_eq!(unary(UnaryOp::Absolute, E::Int, (-5_i64) as u64), 5);
    assert_eq!(unary(UnaryOp::Absolute, E::Uint, 0xFFFF), 0xFFFF);
    assert_eq!(
        unary(UnaryOp::SquareRoot, E::Lreal, 2.25_f64.to_bits()),
        1.5_f64.to_bits()
    );
}

#[test]
fn comparisons_heed_signs_and_truth_values_have_an_order() {
    let compare = |op, ty: Elementary, a: u64, b: u64| {
        let result = evaluate(&TRAP(), E::Bool, &[(ty, a), (ty, b)], |x| {
            ExprKind::Compare(op, x[0], x[1])
        });
        result.unwrap().0 == 1
    };
    assert!(compare(CompareOp::Less, E::Sint, 0xFF, 0));
    assert!(compare(CompareOp::Greater, E::Usint, 0xFF, 0));
    let nan = f64::NAN.to_bits();
    assert!(!compare(CompareOp::Equal, E::Lreal, nan, nan));
    assert!(compare(CompareOp::NotEqual, E::Lreal, nan, nan));
    // FALSE < TRUE.
    let all = [
        (CompareOp::Equal, [true, false, false, true]),
        (CompareOp::NotEqual, [false, true, true, false]),
        (CompareOp::Less, [false, true, false, false]),
        (CompareOp::LessEqual, [true, true, false, true]),
        (CompareOp::Greater, [false, false, true, false]),
        (CompareOp::GreaterEqual, [true, false, true, true]),
    ];
    for (op, expected) in all {
        for (index, expected) in (0..).zip(expected) {
            let found = compare(op, E::Bool, index >> 1, index & 1);
            assert_eq!(found, expected, "{op:?} {index:02b}");
        }
    }
}

fn converted(how: Conversion, from: Elementary, bits: u64, to: Elementary) -> u64 {
    evaluate(&TRAP(), to, &[(from, bits)], |x| {
        ExprKind::Convert(how, x[0])
    })
    .unwrap()
    .0
}

#[test]
fn conversions_by_value() {
    let value = |from, bits, to| converted(Conversion::Value, from, bits, to);
    assert_eq!(value(E::Sint, 0xFF, E::Dint), 0xFFFF_FFFF);
    assert_eq!(value(E::Usint, 0xFF, E::Dint), 0xFF);
    assert_eq!(value(E::Dint, 0x1_2345, E::Int), 0x2345);
    assert_eq!(value(E::Int, 256, E::Bool), 1);
    assert_eq!(value(E::Int, 0, E::Bool), 0);
    assert_eq!(value(E::Bool, 1, E::Sint), 1);
    assert_eq!(value(E::Bool, 1, E::Lreal), 1.0_f64.to_bits());
    assert_eq!(
        value(E::Ulint, u64::MAX, E::Lreal),
        2.0_f64.powi(64).to_bits()
    );
    assert_eq!(value(E::Lint, u64::MAX, E::Lreal), (-1.0_f64).to_bits());
    let real = |number: f64, to| value(E::Lreal, number.to_bits(), to);
    assert_eq!(real(1.5, E::Dint), 2);
    assert_eq!(real(2.5, E::Dint), 2);
    assert_eq!(real(-1.5, E::Dint), 0xFFFF_FFFE);
    assert_eq!(real(1e9, E::Int), 0x7FFF);
    assert_eq!(real(-1e9, E::Int), 0x8000);
    assert_eq!(real(300.0, E::Usint), 255);
    assert_eq!(real(-3.0, E::Usint), 0);
    assert_eq!(real(1e30, E::Ulint), u64::MAX);
    assert_eq!(real(f64::NAN, E::Dint), 0);
    assert_eq!(real(0.25, E::Bool), 1);
    assert_eq!(real(-0.0, E::Bool), 0);
    assert_eq!(real(f64::NAN, E::Bool), 0);
    assert_eq!(real(1e300, E::Real), u64::from(f32::INFINITY.to_bits()));
}

#[test]
fn truncation_is_toward_zero() {
    let truncated =
        |number: f64, to| converted(Conversion::Truncate, E::Lreal, number.to_bits(), to);
    assert_eq!(truncated(1.9, E::Int), 1);
    assert_eq!(truncated(-1.9, E::Int), 0xFFFF);
    assert_eq!(truncated(-0.9, E::Int), 0);
    assert_eq!(truncated(1e9, E::Int), 0x7FFF);
    assert_eq!(
        truncated(4_503_599_627_370_495.5, E::Lint),
        4_503_599_627_370_495
    );
    assert_eq!(truncated(f64::NAN, E::Lint), 0);
    assert_eq!(truncated(255.9, E::Usint), 255);
}

#[test]
fn conversions_by_bits() {
    let bits = |from, bits, to| converted(Conversion::Bits, from, bits, to);
    assert_eq!(bits(E::Sint, 0xFF, E::Uint), 0xFF);
    assert_eq!(bits(E::Uint, 0x1234, E::Usint), 0x34);
    assert_eq!(bits(E::Uint, 2, E::Bool), 0);
    assert_eq!(bits(E::Uint, 3, E::Bool), 1);
    let one = u64::from(1.0_f32.to_bits());
    assert_eq!(bits(E::Real, one, E::Udint), one);
    assert_eq!(bits(E::Udint, one, E::Real), one);
    assert_eq!(bits(E::Lreal, 7, E::Ulint), 7);
}

#[test]
fn select_takes_one_of_two_values() {
    for (cond, expected) in [(1, 10), (0, 20)] {
        for lazy in [false, true] {
            let operands = [(E::Bool, cond), (E::Int, 10), (E::Int, 20)];
            let found = evaluate(&TRAP(), E::Int, &operands, |x| {
                if lazy {
                    ExprKind::Choose(x[0], x[1], x[2])
                } else {
                    ExprKind::Select(x[0], x[1], x[2])
                }
            });
            assert_eq!(found, Ok((expected, 0)));
        }
    }
}

#[test]
fn choose_evaluates_only_what_counts() {
    // r := b <> 0 AND_THEN 7 / b, with b = 0: no fault.
    let mut hir = program();
    let b = value(&mut hir, "b", E::Dint, 0);
    let r = value(&mut hir, "r", E::Dint, 9);
    let mut text = Text::new();
    let (b0, zero) = (text.get(E::Dint, b), text.num(E::Dint, 0));
    let some = text.cmp(CompareOp::NotEqual, b0, zero);
    let (seven, b1) = (text.num(E::Dint, 7), text.get(E::Dint, b));
    let quotient = text.bin(BinaryOp::Divide, seven, b1);
    let other = text.num(E::Dint, -1);
    let chosen = text.expr(E::Dint, ExprKind::Choose(some, quotient, other));
    let set = text.set_tag(r, chosen);
    let mut run = Run::once(&mut hir, text.body(&[set]), &TRAP());
    assert_eq!(run.number("r"), -1);
    run.poke("b", 2);
    assert_eq!(run.scan(1), Ok(()));
    assert_eq!(run.number("r"), 3);
}

#[test]
fn values_stay_within_their_subrange() {
    let within = |options: &Options, ty, bits: i64, low: i64, high: i64| {
        evaluate(options, ty, &[(ty, bits as u64)], |x| ExprKind::Within {
            value: x[0],
            low: low as u64,
            high: high as u64,
        })
    };
    assert_eq!(within(&TRAP(), E::Int, 5, -5, 5), Ok((5, 0)));
    assert_eq!(within(&TRAP(), E::Int, 6, -5, 5), Err(FaultCode::Range));
    assert_eq!(within(&TRAP(), E::Int, -6, -5, 5), Err(FaultCode::Range));
    assert_eq!(within(&TRAP(), E::Usint, 200, 0, 250), Ok((200, 0)));
    assert_eq!(within(&TRAP(), E::Sint, -128, -128, 127), Ok((0x80, 0)));
    // Bit 2 of the status is fault 3.
    assert_eq!(within(&continuing(), E::Int, 6, -5, 5), Ok((5, 4)));
    assert_eq!(within(&continuing(), E::Int, -6, -5, 5), Ok((0xFFFB, 4)));
    assert_eq!(within(&continuing(), E::Int, 1, -5, 5), Ok((1, 0)));
}

#[test]
fn statements_run_before_the_value_behind_them() {
    // r := (n := n + 1; n) + n
    let mut hir = program();
    let n = value(&mut hir, "n", E::Int, 4);
    let r = value(&mut hir, "r", E::Int, 0);
    let mut text = Text::new();
    let bump = text.bump(E::Int, n, 1);
    let read = text.get(E::Int, n);
    let after = text.expr(E::Int, ExprKind::After(vec![bump], read));
    let again = text.get(E::Int, n);
    let sum = text.add(after, again);
    let set = text.set_tag(r, sum);
    let run = Run::once(&mut hir, text.body(&[set]), &TRAP());
    assert_eq!((run.number("n"), run.number("r")), (5, 10));
}

#[test]
fn operands_are_evaluated_from_left_to_right() {
    // r := n + (n := n + 1; n): the left n is the old one.
    let mut hir = program();
    let n = value(&mut hir, "n", E::Int, 4);
    let r = value(&mut hir, "r", E::Int, 0);
    let mut text = Text::new();
    let left = text.get(E::Int, n);
    let bump = text.bump(E::Int, n, 1);
    let read = text.get(E::Int, n);
    let after = text.expr(E::Int, ExprKind::After(vec![bump], read));
    let sum = text.add(left, after);
    let set = text.set_tag(r, sum);
    let run = Run::once(&mut hir, text.body(&[set]), &TRAP());
    assert_eq!(run.number("r"), 9);
}

#[test]
fn time_is_that_of_the_scan() {
    let mut hir = program();
    let [now, since, last] = ["now", "since", "last"].map(|name| value(&mut hir, name, E::Lint, 0));
    let mut text = Text::new();
    let time = text.expr(E::Lint, ExprKind::Now);
    let first = text.set_tag(now, time);
    let path = text.tag(last);
    let elapsed = text.expr(E::Lint, ExprKind::Elapsed(path));
    let second = text.set_tag(since, elapsed);
    let mut run = Run::once(&mut hir, text.body(&[first, second]), &TRAP());
    for (at, passed) in [(5, 5), (5, 0), (12, 7)] {
        assert_eq!(run.scan(at), Ok(()));
        assert_eq!(run.number("now"), at as i64);
        assert_eq!(run.number("since"), passed);
        assert_eq!(run.number("last"), at as i64);
    }
}
