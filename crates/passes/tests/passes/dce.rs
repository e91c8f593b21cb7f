//! What nobody can see goes; effects stay.

use crate::check::check;

const HEADER: &str = "module m
state { n: i32, last: i64 }
input { p: i1, x: i32 }
output { x: i32 }
scan @scan
";

#[test]
fn unused_results_go_and_effects_stay() {
    check(
        &["dce"],
        HEADER,
        "fn @unused[]() -> () {
b0:
  call @alsounused[]()
  return
}
fn @alsounused[]() -> () {
b0:
  return
}
fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = add v0, v0
  v2: i32 = elapsed state.last, 1ms
  store state.n, v0
  return
b1:
  v3: i32 = const 1
  jump b1
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v2: i32 = elapsed state.last, 1ms
  store state.n, v0
  return
}
",
    );
}

/// v3 and v6 feed each other around the loop and nothing else.
#[test]
fn values_that_only_feed_each_other_go() {
    check(
        &["dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  v1: i32 = const 1
  jump b1(v0, v1)
b1(v2: i32, v3: i32):
  v4: i32 = const 1
  v5: i32 = ushr v2, v4
  v6: i32 = add v3, v4
  v7: i1 = ne v5, v4
  brif v7, b2, b3
b2:
  v8: i32 = const 0
  v9: i1 = eq v5, v8
  brif v9, b3, b1(v5, v6)
b3:
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = load input.x
  jump b1(v0)
b1(v2: i32):
  v4: i32 = const 1
  v5: i32 = ushr v2, v4
  v7: i1 = ne v5, v4
  brif v7, b2, b3
b2:
  v8: i32 = const 0
  v9: i1 = eq v5, v8
  brif v9, b3, b1(v5)
b3:
  return
}
",
    );
}
