//! What the integers of a function can be by its branches and loops, and how often loops go round, worked out
//! by hand.

use iecc_ir::analysis::{Cfg, Dominators, LocalRanges, Loops, Range, Trips};
use iecc_ir::{Block, Function, Value, parse_module, verify};

fn scan(body: &str) -> Function {
    let text = format!(
        "module m\nstate {{ a: [10 x i32] }}\ninput {{ x: i32, y: i32 }}\noutput {{ }}\nscan @s\n\
         fn @s[]() -> () {{\n{body}}}\n"
    );
    let module = parse_module(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(verify(&module).err(), None, "{text}");
    module.funcs[module.scan].clone()
}

fn solve(func: &Function) -> LocalRanges {
    let cfg = Cfg::new(func);
    let dominators = Dominators::new(&cfg);
    let loops = Loops::new(&cfg, &dominators);
    LocalRanges::new(func, &cfg, &dominators, &loops)
}

#[track_caller]
fn check(func: &Function, value: u32, block: u32, lo: i64, hi: i64) {
    let found = solve(func).at(func, Value::from_u32(value), Block::from_u32(block));
    assert_eq!(found, Range::new(lo, hi), "v{value} in b{block}");
}

#[track_caller]
fn check_trips(func: &Function, header: u32, expected: Option<(u64, bool)>) {
    let expected = expected.map(|(most, is_exact)| Trips { most, is_exact });
    assert_eq!(solve(func).trips(Block::from_u32(header)), expected);
}

/// Behind `x < 10` unsigned an index is from 0 to 9; on the other way nothing is known.
#[test]
fn a_branch_bounds_what_it_compares() {
    let func = scan(
        "b0:
  v0: i32 = load input.x
  v1: i32 = const 10
  v2: i1 = ult v0, v1
  brif v2, b1, b2
b1:
  v3: i32 = add v0, v1
  store state.a[v0], v3
  return
b2:
  fault index
",
    );
    check(&func, 0, 1, 0, 9);
    check(&func, 3, 1, 10, 19);
    check(&func, 0, 2, i32::MIN.into(), i32::MAX.into());
}

fn counting(first: i32, op: &str, last: i32, step: i32) -> Function {
    scan(&format!(
        "b0:
  v0: i32 = const {first}
  v1: i32 = const {last}
  v2: i32 = const {step}
  v3: i32 = const 1000
  jump b1(v0, v3)
b1(v4: i32, v5: i32):
  v6: i32 = sub v5, v2
  v7: i32 = add v4, v2
  v8: i1 = {op} v7, v1
  brif v8, b1(v7, v6), b2
b2:
  return
"
    ))
}

/// `FOR i := 0 TO 9`: nine times back, i from 0 to 9, and a number that shrinks with it from 1000 to 991.
#[test]
fn a_counting_loop_bounds_its_counter_and_what_counts_with_it() {
    let func = counting(0, "sle", 9, 1);
    check_trips(&func, 1, Some((9, true)));
    check(&func, 4, 1, 0, 9);
    check(&func, 7, 1, 1, 10);
    check(&func, 5, 1, 991, 1000);
}

/// 0, 3, 6, 9 are below 10; 12 is not. Downwards 5, 4, 3 are above 2.
#[test]
fn steps_other_than_1_and_loops_downwards_are_counted() {
    check_trips(&counting(0, "slt", 10, 3), 1, Some((3, true)));
    check_trips(&counting(5, "sgt", 2, -1), 1, Some((2, true)));
    check_trips(&counting(7, "sle", 5, 1), 1, Some((0, true)));
    check(&counting(0, "slt", 10, 3), 4, 1, 0, 9);
}

/// A counter that may wrap around, or goes the other way, does not end the loop.
#[test]
fn loops_that_may_go_on_for_ever_are_not_bounded() {
    check_trips(&counting(0, "sle", i32::MAX, 1), 1, None);
    check_trips(&counting(0, "sle", 9, -1), 1, None);
    check_trips(&counting(0, "sle", 9, 0), 1, None);
    check_trips(&counting(0, "ne", 9, 2), 1, None);
}

/// `WHILE j <= 100 DO j := j + i`, i from 2 to 10, j from 2 * i: at most (100 - 4) / 2 + 1 = 49 rounds. The limit
/// of rounds, from 1000 down, stays above 0.
#[test]
fn a_while_loop_is_bounded_by_its_smallest_step() {
    let func = scan(
        "b0:
  v0: i32 = const 2
  jump b1(v0)
b1(v1: i32):
  v2: i32 = add v1, v1
  v3: i32 = const 1000
  jump b2(v2, v3)
b2(v4: i32, v5: i32):
  v6: i32 = const 100
  v7: i1 = sle v4, v6
  brif v7, b3, b4
b3:
  v8: i32 = const -1
  v9: i32 = add v5, v8
  v10: i32 = add v4, v1
  jump b2(v10, v9)
b4:
  v11: i32 = const 1
  v12: i32 = add v1, v11
  v13: i32 = const 10
  v14: i1 = sle v12, v13
  brif v14, b1(v12), b5
b5:
  return
",
    );
    check_trips(&func, 1, Some((8, true)));
    check_trips(&func, 2, Some((49, false)));
    check(&func, 1, 3, 2, 10);
    check(&func, 4, 3, 4, 100);
    check(&func, 5, 2, 951, 1000);
}

/// EXIT makes the count an upper bound.
#[test]
fn a_second_way_out_makes_the_count_inexact() {
    let func = scan(
        "b0:
  v0: i32 = const 0
  v1: i32 = load input.x
  v2: i32 = const 1
  v3: i32 = const 9
  jump b1(v0)
b1(v4: i32):
  v5: i1 = eq v4, v1
  brif v5, b3, b2
b2:
  v6: i32 = add v4, v2
  v7: i1 = sle v6, v3
  brif v7, b1(v6), b3
b3:
  return
",
    );
    check_trips(&func, 1, Some((9, false)));
}

/// Two ways into the loop: nothing is claimed but what branches say.
#[test]
fn irreducible_loops_grow_to_the_ends_of_their_types() {
    let func = scan(
        "b0:
  v0: i32 = load input.x
  v1: i32 = const 3
  v2: i1 = slt v0, v1
  brif v2, b1(v1), b2(v1)
b1(v3: i32):
  v4: i32 = add v3, v1
  jump b2(v4)
b2(v5: i32):
  v6: i1 = sgt v5, v0
  brif v6, b1(v5), b3
b3:
  return
",
    );
    check(&func, 5, 2, i32::MIN.into(), i32::MAX.into());
    check(&func, 0, 1, i32::MIN.into(), i32::MAX.into());
}
