//! Memory, calls, faults and time, with results worked out by hand from the rules of the IR.

use iecc_ir::{FaultCode, Origin, parse_module, verify};
use iecc_jit::Jit;
use iecc_target::{Engine, Fault, Refusal, TargetError};
use std::fmt::Write as _;

fn try_compile(text: &str) -> Result<Jit, Vec<TargetError>> {
    let module = parse_module(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Jit::new(verify(&module).unwrap_or_else(|errors| panic!("{errors:?}\n{text}")))
}

fn compile(text: &str) -> Jit {
    try_compile(text).unwrap()
}

/// A program with an `i32` input `x`, a second one `y`, and an `i32` output `r`.
fn program(state: &str, rest: &str) -> Jit {
    compile(&format!(
        "module m\nstate {{ {state} }}\ninput {{ x: i32, y: i32 }}\noutput {{ r: i32 }}\n{rest}"
    ))
}

fn scan(jit: &mut Jit, x: i32, y: i32) -> Result<i32, Fault> {
    scan_at(jit, 0, x, y)
}

fn scan_at(jit: &mut Jit, now_ns: u64, x: i32, y: i32) -> Result<i32, Fault> {
    let inputs = [x.to_le_bytes(), y.to_le_bytes()].concat();
    let mut outputs = (-1i32).to_le_bytes();
    jit.step(now_ns, &inputs, &mut outputs)?;
    Ok(i32::from_le_bytes(outputs))
}

#[test]
fn an_index_outside_the_array_loads_0_and_stores_nothing() {
    let mut jit = program(
        "before: i32, a: [3 x i32], after: i32",
        "scan @s
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load input.y
  v2: i32 = load state.a[v0]
  store output.r, v2
  store state.a[v0], v1
  return
}
",
    );
    for (index, value, found) in [
        (0, 5, 0),
        (2, 7, 0),
        (0, 6, 5),
        (3, 9, 0),
        (-1, 9, 0),
        (i32::MIN, 9, 0),
        (i32::MAX, 9, 0),
        (2, 8, 7),
    ] {
        assert_eq!(scan(&mut jit, index, value), Ok(found), "index {index}");
    }
    let expected = [0, 6, 0, 8, 0].map(i32::to_le_bytes).concat();
    assert_eq!(jit.state(), expected);
}

#[test]
fn bits_are_numbered_from_the_lowest_and_bounded() {
    let mut jit = program(
        "w: i16, next: i16",
        "init w = 0x8001
scan @s
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load input.y
  v2: i1 = trunc v1
  v3: i1 = load state.w.[v0]
  v4: i32 = zext v3
  store output.r, v4
  store state.w.[v0], v2
  v5: i1 = const 1
  v6: i1 = const 0
  store state.next.2, v5
  store state.next.3, v6
  store state.next.4, v2
  return
}
",
    );
    for (bit, value, found) in [
        (0, 0, 1),
        (15, 1, 1),
        (3, 1, 0),
        (16, 1, 0),
        (-1, 1, 0),
        (32, 1, 0),
    ] {
        assert_eq!(scan(&mut jit, bit, value), Ok(found), "bit {bit}");
    }
    // Bits 15 and 3; of the other word bits 2 and 4.
    assert_eq!(jit.state(), [0x08, 0x80, 0x14, 0x00]);
}

#[test]
fn a_reference_to_an_element_outside_its_array_is_nothing_through_all_calls() {
    let mut jit = program(
        "a: [2 x [2 x i32]]",
        "scan @s
fn @bump[n: i32](i32) -> (i32) {
b0(v0: i32):
  v1: i32 = load n
  v2: i32 = add v1, v0
  store n, v2
  v3: i32 = load n
  return v3
}
fn @row[r: [2 x i32]](i32) -> (i32) {
b0(v0: i32):
  v1: i32 = const 10
  v2: i32 = call @bump[r[v0]](v1)
  v3: i32 = call @bump[r[1]](v1)
  v4: i32 = add v2, v3
  return v4
}
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load input.y
  v2: i32 = call @row[state.a[v0]](v1)
  store output.r, v2
  return
}
",
    );
    assert_eq!(scan(&mut jit, 0, 0), Ok(20), "both exist");
    assert_eq!(
        scan(&mut jit, 0, 2),
        Ok(20),
        "0 for the missing, 10 + 10 for [1]"
    );
    assert_eq!(scan(&mut jit, 2, 0), Ok(0), "the row is missing");
    assert_eq!(scan(&mut jit, 1, -1), Ok(10));
    assert_eq!(jit.state(), [10, 20, 0, 10].map(i32::to_le_bytes).concat());
}

#[test]
fn results_and_arguments_of_any_number_are_passed() {
    let types: Vec<&str> = ["i1", "i8", "i16", "i32", "i64", "f32", "f64"].repeat(3);
    let mut text = "scan @s\nfn @f[](".to_owned();
    text += &types.join(", ");
    write!(text, ") -> ({}) {{\nb0(", types.join(", ")).unwrap();
    let params: Vec<String> = types
        .iter()
        .enumerate()
        .map(|(i, ty)| format!("v{i}: {ty}"))
        .collect();
    write!(text, "{}):\n  return ", params.join(", ")).unwrap();
    let names: Vec<String> = (0..types.len()).map(|i| format!("v{i}")).collect();
    writeln!(text, "{}\n}}\nfn @s[]() -> () {{\nb0:", names.join(", ")).unwrap();
    for (i, ty) in types.iter().enumerate() {
        let bits = match *ty {
            "f32" => (i as f32).to_bits().into(),
            "f64" => (i as f64).to_bits(),
            "i1" => 1,
            _ => i as u64,
        };
        writeln!(text, "  v{i}: {ty} = const {bits:#x}").unwrap();
    }
    let results = types.iter().enumerate();
    let results: Vec<String> = results
        .map(|(i, ty)| format!("v{}: {ty}", 100 + i))
        .collect();
    let (results, names) = (results.join(", "), names.join(", "));
    writeln!(text, "  {results} = call @f[]({names})").unwrap();
    // v117, v118, v119: the last i32, i64 and f32, which are 17, 18 and 19.
    text += "  v200: i32 = trunc v118\n  v201: i32 = float_to_sint v119\n  v202: i32 = add v117, v200\n  \
             v203: i32 = add v202, v201\n  store output.r, v203\n  return\n}\n";
    let mut jit = program("", &text);
    assert_eq!(scan(&mut jit, 0, 0), Ok(17 + 18 + 19));
}

const FAULTY: &str = "origin @0 = \"rung 1\"
origin @1 = \"rung 2\"
scan @s
fn @check[](i32) -> (i32) {
b0(v0: i32):
  switch v0, b1 [1: b2, 2: b3, 4294967295: b2]
b1:
  return v0
b2:
  fault divide @1
b3:
  fault range
}
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  store state.n, v0
  store output.r, v0
  v1: i32 = call @check[](v0) @0
  store state.m, v1
  return
}
";

#[test]
fn a_fault_in_a_callee_leaves_state_and_outputs_as_they_were() {
    let mut jit = program("n: i32, m: i32", FAULTY);
    assert_eq!(scan(&mut jit, 7, 0), Ok(7));
    let divide = Fault {
        code: FaultCode::Divide,
        origin: Some(Origin::from_u32(1)),
    };
    let range = Fault {
        code: FaultCode::Range,
        origin: None,
    };
    for (x, fault) in [(1, divide), (2, range), (-1, divide)] {
        let inputs = [x, 0i32].map(i32::to_le_bytes).concat();
        let mut outputs = 99i32.to_le_bytes();
        assert_eq!(jit.step(0, &inputs, &mut outputs), Err(fault));
        assert_eq!(outputs, 99i32.to_le_bytes());
        assert_eq!(jit.state(), [7, 7].map(i32::to_le_bytes).concat());
    }
    assert_eq!(scan(&mut jit, 8, 0), Ok(8), "the engine goes on");
}

#[test]
fn switch_passes_arguments_to_its_targets() {
    let mut jit = program(
        "",
        "scan @s
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load input.y
  v2: i32 = const 100
  switch v0, b1(v0) [0: b1(v1), 1: b1(v2), 1000000: b2, -5: b1(v1)]
b1(v3: i32):
  store output.r, v3
  return
b2:
  jump b1(v2)
}
",
    );
    for (x, y, found) in [
        (0, 3, 3),
        (1, 3, 100),
        (1_000_000, 3, 100),
        (-5, 4, 4),
        (6, 3, 6),
    ] {
        assert_eq!(scan(&mut jit, x, y), Ok(found), "{x}");
    }
}

#[test]
fn step_is_0_in_the_first_scan_and_counts_from_the_last_scan_that_ended_well() {
    let mut jit = program(
        "",
        "scan @s
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = step 1ms
  v2: i1 = trunc v0
  store output.r, v1
  brif v2, b1, b2
b1:
  fault call
b2:
  return
}
",
    );
    const MS: u64 = 1_000_000;
    assert_eq!(scan_at(&mut jit, 5 * MS, 0, 0), Ok(0));
    assert_eq!(scan_at(&mut jit, 15 * MS, 0, 0), Ok(10));
    scan_at(&mut jit, 16 * MS, 1, 0).unwrap_err();
    assert_eq!(
        scan_at(&mut jit, 18 * MS - 1, 0, 0),
        Ok(2),
        "17 is the last boundary"
    );
}

/// Sums 1 to x in a loop, at most y times around.
const SUM: &str = "scan @s
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = const 0
  v2: i32 = const 1
  jump b1(v1, v1)
b1(v3: i32, v4: i32):
  v5: i1 = slt v3, v0
  brif v5, b2, b3
b2:
  v6: i32 = add v3, v2
  v7: i32 = add v4, v6
  jump b1(v6, v7)
b3:
  store output.r, v4
  return
}
";

#[test]
fn loops_run_and_their_work_is_bounded() {
    let mut jit = program("", SUM);
    assert_eq!(scan(&mut jit, 0, 0), Ok(0));
    assert_eq!(scan(&mut jit, 1000, 0), Ok(500_500));
    // 11 instructions and ends of blocks, then 5 each time around.
    let mut jit = program("", SUM).with_budget(11 + 5 * 100);
    assert_eq!(scan(&mut jit, 100, 0), Ok(5050));
    let bound = scan(&mut jit, 101, 0).unwrap_err();
    assert_eq!(bound.code, FaultCode::Bound);
}

#[test]
fn an_endless_loop_ends_with_the_fault_bound() {
    let natural = "scan @s\nfn @s[]() -> () {\nb0:\n  jump b1\nb1:\n  jump b1\n}\n";
    let irreducible = "scan @s\nfn @s[]() -> () {\nb0:\n  v0: i32 = load input.x\n  v1: i1 = trunc v0\n  \
                       brif v1, b1, b2\nb1:\n  jump b2\nb2:\n  jump b1\n}\n";
    for text in [natural, irreducible] {
        let mut jit = program("", text).with_budget(1 << 20);
        assert_eq!(
            scan(&mut jit, 1, 0).unwrap_err().code,
            FaultCode::Bound,
            "{text}"
        );
    }
}

/// `depth` functions of which each calls the next `times` times.
fn chain(depth: usize, times: usize) -> String {
    let mut text = "scan @f0\n".to_owned();
    for level in 0..depth {
        writeln!(text, "fn @f{level}[]() -> () {{\nb0:").unwrap();
        if level + 1 < depth {
            text += &format!("  call @f{}[]()\n", level + 1).repeat(times);
        } else {
            text += "  v0: i32 = load state.n\n  v1: i32 = const 1\n  v2: i32 = add v0, v1\n  store state.n, v2\n";
        }
        text += "  return\n}\n";
    }
    text
}

#[test]
fn calls_that_multiply_end_with_the_fault_bound() {
    let mut jit = program("n: i32", &chain(60, 2));
    let bound = scan(&mut jit, 0, 0).unwrap_err();
    assert_eq!(bound.code, FaultCode::Bound);
    assert_eq!(jit.state(), [0; 4]);
    let mut jit = program("n: i32", &chain(11, 2));
    scan(&mut jit, 0, 0).unwrap();
    assert_eq!(jit.state(), 1024i32.to_le_bytes());
}

/// As `chain`, each function called once and with twelve values to keep during the call.
fn heavy_chain(depth: usize) -> String {
    let mut text = "scan @f0\n".to_owned();
    for level in 0..depth {
        writeln!(text, "fn @f{level}[]() -> () {{\nb0:").unwrap();
        for i in 0..12 {
            writeln!(text, "  v{i}: i32 = load state.a[{i}]").unwrap();
        }
        if level + 1 < depth {
            writeln!(text, "  call @f{}[]()", level + 1).unwrap();
        }
        for i in 0..12 {
            writeln!(text, "  store state.a[{}], v{i}", 11 - i).unwrap();
        }
        text += "  return\n}\n";
    }
    text
}

#[test]
fn chains_of_calls_are_as_deep_as_the_stack_allows() {
    let mut jit = program("n: i32", &chain(5_000, 1));
    scan(&mut jit, 0, 0).unwrap();
    assert_eq!(jit.state(), 1i32.to_le_bytes());
    let text = format!(
        "module m\nstate {{ a: [12 x i32] }}\ninput {{ }}\noutput {{ }}\n{}",
        heavy_chain(10_000)
    );
    let refused = try_compile(&text).unwrap_err();
    assert_eq!(refused[0].refusal, Refusal::Size);
    let message = &refused[0].message;
    assert!(
        message.contains("KiB of stack, at most 1024 KiB"),
        "{message}"
    );
}

#[test]
fn unreachable_code_is_left_out() {
    let mut jit = program(
        "",
        "scan @s
fn @unused[]() -> () {
b0:
  fault index
}
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  jump b3
b1:
  v9: i32 = add v8, v0
  jump b2
b2:
  v8: i32 = const 1
  jump b1
b3:
  store output.r, v0
  return
}
",
    );
    assert_eq!(scan(&mut jit, 4, 0), Ok(4));
}

#[test]
fn a_program_of_nothing_runs() {
    let mut jit = compile(
        "module m\nstate { }\ninput { }\noutput { }\nscan @s\nfn @s[]() -> () {\nb0:\n  return\n}\n",
    );
    assert_eq!(jit.step(0, &[], &mut []), Ok(()));
}

/// `j := x; WHILE j <= 1000 DO n := n + 1; j := j + y`, y from 1 to 7: the rounds are paid for before the loop, and
/// at most twice.
#[test]
fn rounds_that_are_counted_ahead_are_within_the_budget() {
    let text = "scan @s
fn @s[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load input.y
  v2: i32 = const 7
  v3: i32 = and v1, v2
  v4: i32 = const 1
  v5: i32 = or v3, v4
  v6: i32 = const 1000
  v7: i32 = const 0
  v15: i1 = slt v0, v7
  v16: i32 = select v15, v7, v0
  jump b1(v16, v7)
b1(v8: i32, v9: i32):
  v10: i1 = sle v8, v6
  brif v10, b2, b3
b2:
  v11: i32 = add v9, v4
  v12: i32 = add v8, v5
  jump b1(v12, v11)
b3:
  store output.r, v9
  return
}
";
    // 0, 1, ... 1000 are 1001 rounds; 0, 7, ... 994 are 143; 1000 is one; 1001 none.
    for (x, y, rounds) in [
        (0, 1, 1001),
        (0, 7, 143),
        (1000, 1, 1),
        (1001, 1, 0),
        (i32::MAX, 1, 0),
    ] {
        let mut jit = program("", text);
        assert_eq!(scan(&mut jit, x, y), Ok(rounds), "x {x}, y {y}");
    }
    // A round is four instructions, and the two branches.
    for (budget, y, ends) in [
        (20_000, 1, true),
        (5_000, 1, false),
        (2_500, 7, true),
        (700, 7, false),
    ] {
        let mut jit = program("", text).with_budget(budget);
        assert_eq!(scan(&mut jit, 0, y).is_ok(), ends, "budget {budget}, y {y}");
    }
}

/// 16 and more bytes of neighbours, some of them of several types, and a rest of every width; what is
/// stored in another order or twice counts as the program says.
#[test]
fn neighbouring_constants_are_stored_as_written() {
    let mut jit = program(
        "a: i8, b: i1, c: i16, d: i32, e: i64, f: f32, g: f64, h: [5 x i8], i: i32",
        "scan @s
fn @s[]() -> () {
b0:
  v0: i8 = const 17
  v1: i1 = const 1
  v2: i16 = const 4660
  v3: i32 = const -2
  v4: i64 = const 81985529216486895
  v5: f32 = const 1.0
  v6: f64 = const -2.0
  v7: i32 = const 7
  v8: i32 = load input.x
  store state.i, v8
  store state.g, v6
  store state.h[4], v0
  store state.h[0], v0
  store state.h[2], v0
  store state.h[1], v0
  store state.h[v8], v0
  store state.d, v3
  store state.e, v4
  store state.c, v2
  store state.b, v1
  store state.a, v0
  store state.f, v5
  store state.i, v7
  v9: i32 = load state.d
  store state.d, v8
  v10: i32 = load state.d
  v11: i32 = mul v9, v10
  store output.r, v11
  store state.d, v7
  return
}
",
    );
    // d is -2, then x, which is 3: -6. At the end d and i are 7; h[3] is 17 because x is 3.
    assert_eq!(scan(&mut jit, 3, 0), Ok(-6));
    let mut expected = vec![17, 1];
    expected.extend(0x1234i16.to_ne_bytes());
    expected.extend(7i32.to_ne_bytes());
    expected.extend(0x0123_4567_89ab_cdefi64.to_ne_bytes());
    expected.extend(1f32.to_ne_bytes());
    expected.extend([0; 4]);
    expected.extend((-2f64).to_ne_bytes());
    expected.extend([17; 5]);
    expected.extend([0; 3]);
    expected.extend(7i32.to_ne_bytes());
    expected.extend([0; 4]);
    assert_eq!(jit.state(), expected);
}

/// Two references to the same place: each load sees the store before it.
#[test]
fn a_constant_is_seen_through_another_reference() {
    let mut jit = program(
        "s: [2 x i32]",
        "scan @s
fn @both[one: [2 x i32], two: [2 x i32]]() -> (i32) {
b0:
  v0: i32 = const 5
  v1: i32 = const 6
  v2: i32 = const 8
  store one[0], v0
  store one[1], v1
  v3: i32 = load two[1]
  store two[1], v2
  v4: i32 = load one[1]
  v5: i32 = mul v3, v4
  return v5
}
fn @s[]() -> () {
b0:
  v0: i32 = call @both[state.s, state.s]()
  store output.r, v0
  return
}
",
    );
    assert_eq!(scan(&mut jit, 0, 0), Ok(48));
    assert_eq!(jit.state(), [5i32, 8].map(i32::to_ne_bytes).concat());
}

/// `FOR i := x TO 2147483646` that is left in its fourth round is no work for 2,147,483,646 rounds, and neither
/// is one that a fault ends.
#[test]
fn a_loop_that_ends_early_is_paid_for_as_it_goes() {
    let rounds = |end: &str| {
        format!(
            "scan @s
fn @s[]() -> () {{
b0:
  v0: i32 = load input.x
  v1: i32 = const 2147483646
  v2: i32 = const 1
  v3: i32 = const 3
  v4: i32 = const 0
  jump b1(v0, v4)
b1(v5: i32, v6: i32):
  v7: i32 = add v6, v2
  v8: i1 = sgt v7, v3
  brif v8, b3, b2
b2:
  v9: i32 = add v5, v2
  v10: i1 = sle v9, v1
  brif v10, b1(v9, v7), b4
b3:
  {end}
b4:
  store output.r, v7
  return
}}
"
        )
    };
    let mut left = program("", &rounds("jump b4")).with_budget(1000);
    assert_eq!(scan(&mut left, 0, 0), Ok(4));
    let mut failed = program("", &rounds("fault divide")).with_budget(1000);
    let code = scan(&mut failed, 0, 0).unwrap_err().code;
    assert_eq!(code, FaultCode::Divide);
}
