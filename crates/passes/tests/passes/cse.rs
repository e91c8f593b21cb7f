//! Equal computations happen once; loads know what was stored.

use crate::check::check;

const HEADER: &str = "module m
struct T { n: i32, m: i32 }
state { n: i32, w: i16, a: [4 x i32], t: T, on: i1 }
input { p: i1, q: i1, x: i32, y: i32 }
output { p: i1, x: i32 }
scan @scan
";

#[test]
fn equal_instructions_share_even_with_operands_exchanged() {
    check(
        &["cse", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load input.y
  v2: i32 = add v0, v1
  v3: i32 = add v1, v0
  v4: i32 = mul v2, v3
  v5: i1 = slt v0, v1
  v6: i1 = sgt v1, v0
  v7: i1 = xor v5, v6
  store output.x, v4
  store output.p, v7
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = load input.y
  v2: i32 = add v0, v1
  v4: i32 = mul v2, v2
  v5: i1 = slt v0, v1
  v7: i1 = xor v5, v5
  store output.x, v4
  store output.p, v7
  return
}
",
    );
}

/// What one arm computes is not there in the other, nor behind both.
#[test]
fn only_dominating_computations_are_shared() {
    let text = "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i32 = load input.x
  brif v0, b1, b2
b1:
  v2: i32 = neg v1
  store state.n, v2
  jump b3
b2:
  v3: i32 = neg v1
  store state.t.n, v3
  jump b3
b3:
  v4: i32 = neg v1
  store output.x, v4
  return
}
";
    check(&["cse"], HEADER, text, text);
}

#[test]
fn loads_give_what_was_stored_unless_something_may_overlap() {
    check(
        &["cse", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i1 = load input.p
  store state.n, v0
  store state.w.3, v1
  store state.a[1], v0
  v2: i32 = load state.n
  v3: i1 = load state.w.3
  v4: i32 = load state.a[1]
  v5: i32 = add v2, v4
  store state.a[v0], v5
  v6: i32 = load state.a[1]
  v7: i32 = load state.n
  v8: i32 = add v6, v7
  store output.x, v8
  store output.p, v3
  return
}
",
        // The store with an index value forgets all of the state, not only its array.
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i1 = load input.p
  store state.n, v0
  store state.w.3, v1
  store state.a[1], v0
  v5: i32 = add v0, v0
  store state.a[v0], v5
  v6: i32 = load state.a[1]
  v7: i32 = load state.n
  v8: i32 = add v6, v7
  store output.x, v8
  store output.p, v1
  return
}
",
    );
}

#[test]
fn a_bit_changes_its_word_and_no_other_bit() {
    check(
        &["cse"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i16 = load state.w
  v2: i1 = load state.w.4
  store state.w.3, v0
  v3: i16 = load state.w
  v4: i1 = load state.w.4
  store state.w, v1
  v5: i1 = load state.w.3
  v6: i1 = or v4, v5
  store output.p, v6
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i16 = load state.w
  v2: i1 = load state.w.4
  store state.w.3, v0
  v3: i16 = load state.w
  store state.w, v1
  v5: i1 = load state.w.3
  v6: i1 = or v2, v5
  store output.p, v6
  return
}
",
    );
}

/// References may be the same instance, so a store to one forgets the other.
#[test]
fn references_may_alias() {
    let text = "fn @f[t: T, u: T]() -> (i32) {
b0:
  v0: i32 = load t.n
  store u.n, v0
  v1: i32 = load t.n
  v2: i32 = add v0, v1
  return v2
}
fn @scan[]() -> () {
b0:
  v0: i32 = call @f[state.t, state.t]()
  store output.x, v0
  return
}
";
    check(&["cse"], HEADER, text, text);
}

#[test]
fn behind_a_branch_its_condition_is_known() {
    check(
        &["cse"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i1 = load input.q
  v2: i1 = and v0, v1
  brif v2, b1, b2
b1:
  store output.p, v1
  return
b2:
  store output.p, v1
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i1 = load input.q
  v2: i1 = and v0, v1
  brif v2, b1, b2
b1:
  v3: i1 = const 1
  store output.p, v3
  return
b2:
  store output.p, v1
  return
}
",
    );
}
