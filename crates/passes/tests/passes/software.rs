//! What is done for machine code alone: choices instead of branches, short lives of values.

use crate::check::{check, optimised};
use iecc_ir::{InstData, print_module};
use std::fmt::Write;

const HEADER: &str = "module m
struct T { n: i32, b: i1 }
state { t: T, u: T, n: i32, f: f32, m: i1, a: [4 x i32] }
input { p: i1, q: i1, x: i32, f: f32 }
output { x: i32, f: f32 }
scan @scan
";

/// `IF p THEN m := TRUE ELSIF q THEN m := FALSE`: one store, of what is set, cleared or kept.
#[test]
fn stores_in_arms_become_one_store_of_a_choice() {
    check(
        &["if_convert_small"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i1 = load input.q
  v2: i1 = const 1
  v3: i1 = const 0
  brif v0, b1, b2
b1:
  store state.m, v2
  jump b4
b2:
  brif v1, b3, b4
b3:
  store state.m, v3
  jump b4
b4:
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i1 = load input.q
  v2: i1 = const 1
  v3: i1 = const 0
  v4: i1 = load state.m
  v5: i1 = select v1, v3, v4
  v6: i1 = select v0, v2, v5
  store state.m, v6
  return
}
",
    );
}

/// A number picked by a flag stays behind a branch, which the processor foresees; one picked by a
/// comparison, or computed, becomes a choice, and so do bits.
#[test]
fn flags_that_only_pick_numbers_stay_branches() {
    let branches = |cond: &str, arm: &str| {
        let text = format!(
            "{HEADER}fn @scan[]() -> () {{
b0:
  v0: i1 = load input.p
  v1: i32 = load input.x
  v2: i32 = load state.n
  v3: i1 = load input.q
  v4: i1 = {cond}
  brif v4, b1, b2
b1:
  {arm}
  jump b2
b2:
  return
}}
"
        );
        let module = optimised(&["if_convert_small"], &text);
        module.funcs[module.scan].layout.len()
    };
    let flag = "and v0, v3";
    assert_eq!(branches(flag, "store state.n, v1"), 3);
    assert_eq!(branches("slt v1, v2", "store state.n, v1"), 1);
    let sum = "v5: i32 = add v1, v2\n  store state.n, v5";
    assert_eq!(branches(flag, sum), 1);
    let bit = "store state.n, v1\n  store state.m, v0";
    assert_eq!(branches(flag, bit), 1);
}

/// What only the entry stores is stored there, unless a fault may come, or a way back.
#[test]
fn what_only_the_entry_stores_is_stored_there() {
    let is_early = |last: &str| {
        let text = format!(
            "{HEADER}fn @scan[]() -> () {{
b0:
  v0: i1 = load input.p
  v1: i32 = load input.x
  v2: i32 = load state.t.n
  v3: i32 = add v1, v2
  store state.t.n, v3
  brif v0, b1, b2
b1:
  store state.n, v3
  {last}
b2:
  return
}}
"
        );
        let text = print_module(&optimised(&["promote_few"], &text));
        let branch = text.find("brif").unwrap();
        let [early, late] = ["t.n", "n"].map(|place| {
            let stores: Vec<_> = text
                .match_indices(&format!("store state.{place},"))
                .collect();
            assert!(stores.len() <= 1);
            stores.first().is_some_and(|(at, _)| *at < branch)
        });
        assert!(!late);
        early
    };
    assert!(is_early("jump b2"));
    assert!(!is_early("fault index"));
    assert!(!is_early("v4: i1 = load input.q\n  brif v4, b1, b2"));
}

/// Both arms store one place, and one of them another: all loads come before all stores.
#[test]
fn arms_may_store_different_places() {
    check(
        &["if_convert_small"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i32 = load input.x
  brif v0, b1, b2
b1:
  v2: i32 = load state.t.n
  store state.n, v2
  store state.t.n, v1
  jump b3
b2:
  store state.n, v1
  jump b3
b3:
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i32 = load input.x
  v2: i32 = load state.t.n
  v3: i32 = select v0, v2, v1
  v4: i32 = load state.t.n
  v5: i32 = select v0, v1, v4
  store state.n, v3
  store state.t.n, v5
  return
}
",
    );
}

/// Where a load would have to see a store of its arm, where references may be the same memory,
/// where the old value cannot be loaded, and of floats, which have no choice without a branch.
#[test]
fn other_stores_stay_in_their_arms() {
    for arm in [
        "store state.n, v1\n  v2: i32 = load state.n\n  store state.t.n, v2",
        "store output.x, v1",
        "store state.a[v1], v1",
        "store state.f, v9",
    ] {
        let text = format!(
            "fn @scan[]() -> () {{\nb0:\n  v0: i1 = load input.p\n  v1: i32 = load input.x\n  \
             v9: f32 = load input.f\n  brif v0, b1, b2\nb1:\n  {arm}\n  jump b2\nb2:\n  return\n}}\n"
        );
        check(&["if_convert_small"], HEADER, &text, &text);
    }
    let text = "fn @two[a: T, b: T](i1) -> () {
b0(v0: i1):
  v1: i32 = const 1
  v2: i32 = const 2
  brif v0, b1, b2
b1:
  store a.n, v1
  jump b3
b2:
  store b.n, v2
  jump b3
b3:
  return
}
fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  call @two[state.t, state.t](v0)
  call @two[state.t, state.u](v0)
  return
}
";
    check(&["if_convert_small"], HEADER, text, text);
}

/// `x > 9 ? 9 : (x < 1 ? 1 : x)`: the outer comparison looks at the inner choice.
#[test]
fn limits_of_a_float_are_a_minimum_of_a_maximum() {
    let text = |compared: &str, inner: &str, limits: [&str; 2]| {
        let [outer, lower] = limits;
        format!(
            "fn @scan[]() -> () {{
b0:
  v0: f32 = load input.f
  v1: f32 = const {outer}
  v2: f32 = const {lower}
  v3: i1 = {inner} v0, v2
  v4: f32 = select v3, v2, v0
  v5: i1 = {compared}
  v6: f32 = select v5, v1, v4
  store output.f, v6
  return
}}
"
        )
    };
    for (before, after, inner, limits) in [
        ("fgt v0, v1", "fgt v4, v1", "flt", ["9.0", "1.0"]),
        ("flt v1, v0", "fgt v4, v1", "flt", ["9.0", "9.0"]),
        ("flt v0, v1", "flt v4, v1", "fgt", ["-2.0", "5.0"]),
        // The limits cross, or the comparison is true with a limit itself.
        ("fgt v0, v1", "fgt v0, v1", "flt", ["1.0", "9.0"]),
        ("fge v0, v1", "fge v0, v1", "flt", ["9.0", "1.0"]),
        ("fgt v0, v1", "fgt v0, v1", "fgt", ["9.0", "1.0"]),
    ] {
        let [before, after] = [before, after].map(|text_| text(text_, inner, limits));
        check(&["fold", "dce"], HEADER, &before, &after);
    }
}

/// A store, many others, and a load of the same place.
fn load_after(stores: usize) -> String {
    let mut text =
        "fn @scan[]() -> () {\nb0:\n  v0: i32 = load input.x\n  store state.n, v0\n".to_owned();
    for index in 0..stores {
        writeln!(text, "  store state.a[{}], v0", index % 4).unwrap();
    }
    text + "  v1: i32 = load state.n\n  store output.x, v1\n  return\n}\n"
}

#[test]
fn what_was_stored_long_before_is_loaded_again() {
    for (pass, stores, loads) in [("cse_near", 10, 1), ("cse_near", 100, 2), ("cse", 100, 1)] {
        let module = optimised(&[pass], &format!("{HEADER}{}", load_after(stores)));
        let scan = &module.funcs[module.scan];
        let insts = &scan.block(scan.entry()).insts;
        let found = insts
            .iter()
            .filter(|&&inst| matches!(scan.inst(inst), InstData::Load { .. }));
        assert_eq!(found.count(), loads, "{pass} {stores}");
    }
}

/// A function that is one block is put in place of its calls; one with a branch is not.
#[test]
fn straight_functions_are_inlined_wherever_they_are_called() {
    let mut body = "b0:\n  v0: i32 = load t.n\n".to_owned();
    for value in 1..40 {
        writeln!(body, "  v{value}: i32 = add v{}, v0", value - 1).unwrap();
    }
    body += "  store t.n, v39\n";
    let scan =
        "fn @scan[]() -> () {\nb0:\n  call @f[state.t]()\n  call @f[state.u]()\n  return\n}\n";
    for (end, calls) in [
        ("  return\n", 0),
        (
            "  v40: i1 = load t.b\n  brif v40, b1, b2\nb1:\n  store t.n, v0\n  return\nb2:\n  return\n",
            2,
        ),
    ] {
        let text = format!("{HEADER}fn @f[t: T]() -> () {{\n{body}{end}}}\n{scan}");
        let module = optimised(&["inline_small", "inline_straight"], &text);
        let found = print_module(&module).matches("call @f").count();
        assert_eq!(found, calls);
    }
}

/// `FOR i := 0 TO 3 DO a[i] := i`: no index is outside, so no way leads to the fault.
#[test]
fn an_index_that_counts_within_its_array_is_not_checked() {
    let scan = |last: i32, body: &str, fault: &str| {
        format!(
            "fn @scan[]() -> () {{
b0:
  v0: i32 = const 0
  v1: i32 = const 4
  v2: i32 = const 1
  v3: i32 = const {last}
  jump b1(v0)
b1(v4: i32):
{body}  store state.a[v4], v4
  v6: i32 = add v4, v2
  v7: i1 = sle v6, v3
  brif v7, b1(v6), b3
b3:
  return
{fault}}}
"
        )
    };
    let check_index = "  v5: i1 = ult v4, v1\n  brif v5, b2, b4\nb2:\n";
    let fault = "b4:\n  fault index\n";
    let checked = |last| scan(last, check_index, fault);
    let unchecked = scan(3, "", "").replace("  v1: i32 = const 4\n", "");
    check(&["bounds", "fold", "dce"], HEADER, &checked(3), &unchecked);
    let module = optimised(
        &["bounds", "fold", "dce"],
        &format!("{HEADER}{}", checked(4)),
    );
    assert!(print_module(&module).contains("ult"), "4 is outside");
}

/// `WHILE x < 100 DO n := x; x := x + y`, y at least 1: the condition is looked at before the loop, and behind the
/// body, which goes back to itself.
#[test]
fn a_while_loop_looks_at_its_condition_behind_the_body() {
    check(
        &["loops", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load state.t.n
  v2: i32 = const 1
  v3: i32 = or v1, v2
  v4: i32 = const 100
  jump b1(v0)
b1(v5: i32):
  v6: i32 = sub v4, v3
  v7: i1 = slt v5, v6
  brif v7, b2, b3(v5)
b2:
  store state.n, v6
  v8: i32 = add v5, v3
  jump b1(v8)
b3(v9: i32):
  store output.x, v9
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load state.t.n
  v2: i32 = const 1
  v3: i32 = or v1, v2
  v4: i32 = const 100
  v6: i32 = sub v4, v3
  v7: i1 = slt v0, v6
  brif v7, b2(v0, v6), b3(v0)
b2(v5: i32, v10: i32):
  store state.n, v10
  v8: i32 = add v5, v3
  v11: i32 = sub v4, v3
  v12: i1 = slt v8, v11
  brif v12, b2(v8, v11), b3(v8)
b3(v9: i32):
  store output.x, v9
  return
}
",
    );
}

/// `FOR i := 0 TO 3 DO a[i] := x; x := i`: two bodies, what is behind the loop sees the last.
#[test]
fn a_short_counted_loop_has_two_bodies() {
    check(
        &["loops", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i32 = const 0
  v1: i32 = load input.x
  v2: i32 = const 1
  v3: i32 = const 3
  jump b1(v0, v1)
b1(v4: i32, v5: i32):
  store state.a[v4], v5
  v6: i32 = add v4, v2
  v7: i1 = sle v6, v3
  brif v7, b1(v6, v4), b2
b2:
  store output.x, v5
  store state.n, v6
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = const 0
  v1: i32 = load input.x
  v2: i32 = const 1
  v3: i32 = const 3
  jump b1(v0, v1)
b1(v4: i32, v5: i32):
  store state.a[v4], v5
  v8: i32 = add v4, v2
  store state.a[v8], v4
  v9: i32 = const 2
  v6: i32 = add v4, v9
  v7: i1 = sle v6, v3
  brif v7, b1(v6, v8), b2
b2:
  store output.x, v4
  store state.n, v6
  return
}
",
    );
}

/// Five rounds are no multiple of two or three, calls are not written twice, and a loop with a second way out does
/// not end with a group.
#[test]
fn other_loops_have_one_body() {
    for (last, exit) in [(4, "v7: i1 = sle v6, v3"), (3, "v7: i1 = slt v6, v1")] {
        let text = format!(
            "fn @scan[]() -> () {{
b0:
  v0: i32 = const 0
  v1: i32 = load input.x
  v2: i32 = const 1
  v3: i32 = const {last}
  jump b1(v0)
b1(v4: i32):
  store state.a[v4], v1
  v6: i32 = add v4, v2
  {exit}
  brif v7, b1(v6), b2
b2:
  return
}}
"
        );
        check(&["loops"], HEADER, &text, &text);
    }
}

/// `FOR i := 0 TO 3 DO a[i] := 0`, and not if it begins late, ends early, stores another number, or i is read behind it.
#[test]
fn a_loop_that_makes_an_array_0_clears_it() {
    let scan = |first: i32, last: i32, number: &str, behind: &str| {
        format!(
            "fn @scan[]() -> () {{
b0:
  v0: i32 = const {first}
  v1: i32 = const 1
  v2: i32 = const 0
  v3: i32 = const {last}
  jump b1(v0)
b1(v4: i32):
  store state.a[v4], {number}
  v5: i32 = add v4, v1
  v6: i1 = sle v5, v3
  brif v6, b1(v5), b2
b2:
{behind}  return
}}
"
        )
    };
    let clears = |text: &str| {
        let module = optimised(&["loops", "dce"], &format!("{HEADER}{text}"));
        print_module(&module).contains("clear state.a")
    };
    assert!(clears(&scan(0, 3, "v2", "")));
    for (first, last, number, behind) in [
        (1, 3, "v2", ""),
        (0, 2, "v2", ""),
        (-1, 3, "v2", ""),
        (0, 4, "v2", ""),
        (0, 3, "v1", ""),
        (0, 3, "v4", ""),
        (0, 3, "v2", "  store output.x, v5\n"),
    ] {
        assert!(
            !clears(&scan(first, last, number, behind)),
            "{first} {last} {number} {behind}"
        );
    }
}
