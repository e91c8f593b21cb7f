//! Bodies stand in place of calls; places begin at regions; nothing else changes.

use crate::check::{check, optimised};

const HEADER: &str = "module m
struct T { n: i32, b: i1 }
state { t: T, a: [4 x T], n: i32 }
input { x: i1, i: i32 }
output { y: i1 }
origin @0 = \"caller\"
origin @1 = \"callee\"
scan @scan
";

#[test]
fn references_become_places_and_results_values() {
    check(
        &["inline"],
        HEADER,
        "fn @bump[t: T](i32) -> (i32) {
b0(v0: i32):
  v1: i32 = load t.n @1
  v2: i32 = add v1, v0
  store t.n, v2
  return v2
}
fn @scan[]() -> () {
b0:
  v0: i32 = load input.i
  v1: i32 = call @bump[state.t](v0) @0
  v2: i32 = call @bump[state.a[v1]](v1)
  store state.n, v2
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.i
  v1: i32 = load state.t.n @1
  v2: i32 = add v1, v0 @0
  store state.t.n, v2 @0
  v3: i32 = load state.a[v2].n @1
  v4: i32 = add v3, v2
  store state.a[v2].n, v4
  store state.n, v4
  return
}
",
    );
}

#[test]
fn several_returns_join_in_a_parameter() {
    check(
        &["inline"],
        HEADER,
        "fn @pick[](i1) -> (i32) {
b0(v0: i1):
  brif v0, b1, b2
b1:
  v1: i32 = const 1
  return v1
b2:
  v2: i32 = const 2
  return v2
}
fn @scan[]() -> () {
b0:
  v0: i1 = load input.x
  v1: i32 = call @pick[](v0) @0
  store state.n, v1
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.x
  brif v0, b1, b2 @0
b1:
  v1: i32 = const 1 @0
  jump b3(v1) @0
b2:
  v2: i32 = const 2 @0
  jump b3(v2) @0
b3(v3: i32):
  store state.n, v3
  return
}
",
    );
}

#[test]
fn a_callee_that_only_faults_leaves_the_rest_unreachable() {
    check(
        &["inline"],
        HEADER,
        "fn @fail[]() -> (i32) {
b0:
  fault range
}
fn @scan[]() -> () {
b0:
  v0: i32 = call @fail[]()
  store state.n, v0
  return
}
",
        "fn @scan[]() -> () {
b0:
  fault range
b1(v0: i32):
  store state.n, v0
  return
}
",
    );
}

#[test]
fn loops_of_a_callee_stay_loops_and_the_caller_goes_on_behind() {
    check(
        &["inline"],
        HEADER,
        "fn @count[]() -> (i32) {
b0:
  v0: i32 = const 0
  jump b1(v0)
b1(v1: i32):
  v2: i32 = const 1
  v3: i32 = add v1, v2
  v4: i32 = const 10
  v5: i1 = slt v3, v4
  brif v5, b1(v3), b2
b2:
  return v3
}
fn @scan[]() -> () {
b0:
  v0: i32 = call @count[]()
  store state.n, v0
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = const 0
  jump b1(v0)
b1(v1: i32):
  v2: i32 = const 1
  v3: i32 = add v1, v2
  v4: i32 = const 10
  v5: i1 = slt v3, v4
  brif v5, b1(v3), b2
b2:
  store state.n, v3
  return
}
",
    );
}

#[test]
fn nested_calls_are_inlined_from_the_inside() {
    check(
        &["inline"],
        HEADER,
        "fn @inner[n: i32]() -> () {
b0:
  v0: i32 = load n
  store state.t.n, v0
  return
}
fn @outer[t: T]() -> () {
b0:
  call @inner[t.n]()
  call @inner[t.n]()
  return
}
fn @scan[]() -> () {
b0:
  call @outer[state.a[2]]()
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = load state.a[2].n
  store state.t.n, v0
  v1: i32 = load state.a[2].n
  store state.t.n, v1
  return
}
",
    );
}

/// Sixty functions that call the next one twice would be 2^60 bodies.
#[test]
fn calls_that_fan_out_stop_at_a_bound() {
    let mut text = format!(
        "{HEADER}fn @f0[]() -> () {{\nb0:\n  v0: i1 = load input.x\n  store state.t.b, v0\n  return\n}}\n"
    );
    for n in 1..60 {
        let callee = n - 1;
        text += &format!(
            "fn @f{n}[]() -> () {{\nb0:\n  call @f{callee}[]()\n  call @f{callee}[]()\n  return\n}}\n"
        );
    }
    text += "fn @scan[]() -> () {\nb0:\n  call @f59[]()\n  return\n}\n";
    let module = optimised(&["inline"], &text);
    let copied: usize = module
        .funcs
        .values()
        .map(iecc_ir::Function::inst_count)
        .sum();
    assert!(copied < 5_000_000, "{copied}");
}

#[test]
fn inline_small_leaves_large_functions_that_are_called_twice() {
    let body: String = (0..40)
        .map(|n| format!("  v{n}: i1 = load input.x\n"))
        .collect();
    let large = format!("fn @large[]() -> () {{\nb0:\n{body}  return\n}}\n");
    let twice = "fn @scan[]() -> () {\nb0:\n  call @large[]()\n  call @large[]()\n  return\n}\n";
    let text = format!("{large}{twice}");
    check(&["inline_small"], HEADER, &text, &text);
    let once = "fn @scan[]() -> () {\nb0:\n  call @large[]()\n  return\n}\n";
    let inlined = format!("fn @scan[]() -> () {{\nb0:\n{body}  return\n}}\n");
    check(
        &["inline_small"],
        HEADER,
        &format!("{large}{once}"),
        &inlined,
    );
}
