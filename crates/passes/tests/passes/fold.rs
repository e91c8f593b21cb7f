//! Constants, algebra and control flow. `expression` folds a formula over the inputs and drops what
//! is left over.

use crate::check::check;

const HEADER: &str = "module m
state { n: i32, w: i16, a: [4 x i32] }
input { p: i1, q: i1, b: i8, x: i32, y: i32, l: i64, f: f32 }
output { p: i1, b: i8, x: i32, l: i64, f: f32 }
scan @scan
";

/// `before` computes v9 from the inputs v0 (p), v1 (q), v2 (b), v3 (x), v4 (y), v5 (l), v6 (f);
/// `after` likewise. The result goes to the output named.
#[track_caller]
fn expression(output: &str, before: &str, after: &str) {
    let loads = [
        "p: i1", "q: i1", "b: i8", "x: i32", "y: i32", "l: i64", "f: f32",
    ];
    let scan = |body: &str| {
        let mut text = "fn @scan[]() -> () {\nb0:\n".to_owned();
        for (index, input) in loads.iter().enumerate() {
            let (name, ty) = input.split_once(": ").unwrap();
            if body.contains(&format!("v{index},")) || body.contains(&format!("v{index}\n")) {
                text += &format!("  v{index}: {ty} = load input.{name}\n");
            }
        }
        text + &format!("{body}  store output.{output}, v9\n  return\n}}\n")
    };
    let lines = |text: &str| {
        let lines = text.split(';').map(|line| format!("  {}\n", line.trim()));
        lines.collect::<String>()
    };
    let (before, after) = (scan(&lines(before)), scan(&lines(after)));
    // An expression that is an input itself has no instruction.
    let after = after.replace("  v9: same v", "  v9 = v");
    let after = match after.split_once("  v9 = ") {
        Some((head, tail)) => {
            let (value, rest) = tail.split_once('\n').unwrap();
            format!("{head}{}", rest.replace("v9", value))
        }
        None => after,
    };
    check(&["fold", "dce"], HEADER, &before, &after);
}

#[test]
fn identities_vanish() {
    expression(
        "x",
        "v7: i32 = const 0; v9: i32 = add v7, v3",
        "v9: same v3",
    );
    expression(
        "x",
        "v7: i32 = const 1; v9: i32 = mul v3, v7",
        "v9: same v3",
    );
    expression(
        "x",
        "v7: i32 = const -1; v9: i32 = and v3, v7",
        "v9: same v3",
    );
    expression("p", "v9: i1 = and v0, v0", "v9: same v0");
    expression("p", "v7: i1 = not v0; v9: i1 = not v7", "v9: same v0");
    expression(
        "p",
        "v7: i1 = or v0, v1; v9: i1 = and v0, v7",
        "v9: same v0",
    );
    expression(
        "p",
        "v7: i1 = not v0; v8: i1 = or v7, v1; v9: i1 = and v8, v0",
        "v9: i1 = and v0, v1",
    );
    expression(
        "p",
        "v7: i1 = not v1; v8: i1 = and v0, v1; v16: i1 = and v7, v0; v9: i1 = or v8, v16",
        "v9: same v0",
    );
}

#[test]
fn complements_and_equal_operands_give_constants() {
    expression("x", "v9: i32 = sub v3, v3", "v9: i32 = const 0");
    expression(
        "p",
        "v7: i1 = not v0; v9: i1 = or v0, v7",
        "v9: i1 = const 1",
    );
    expression(
        "x",
        "v7: i32 = not v3; v9: i32 = xor v7, v3",
        "v9: i32 = const -1",
    );
    expression("p", "v9: i1 = sle v3, v3", "v9: i1 = const 1");
}

/// 0 / 0 is 0, so `x / x` is not 1.
#[test]
fn what_is_not_a_law_stays() {
    expression("x", "v9: i32 = sdiv v3, v3", "v9: i32 = sdiv v3, v3");
    expression(
        "f",
        "v7: f32 = const 0.0; v9: f32 = fadd v6, v7",
        "v7: f32 = const 0.0; v9: f32 = fadd v6, v7",
    );
    expression("p", "v9: i1 = feq v6, v6", "v9: i1 = feq v6, v6");
    expression(
        "f",
        "v7: f32 = fneg v6; v9: f32 = fneg v7",
        "v7: f32 = fneg v6; v9: f32 = fneg v7",
    );
    expression(
        "p",
        "v7: i1 = flt v6, v6; v9: i1 = not v7",
        "v7: i1 = flt v6, v6; v9: i1 = not v7",
    );
}

#[test]
fn division_follows_the_table_of_operations() {
    expression(
        "x",
        "v7: i32 = const 0; v9: i32 = udiv v3, v7",
        "v9: i32 = const 0",
    );
    expression(
        "x",
        "v7: i32 = const 0; v9: i32 = srem v3, v7",
        "v9: same v3",
    );
    expression(
        "x",
        "v7: i32 = const -1; v9: i32 = sdiv v3, v7",
        "v9: i32 = neg v3",
    );
    expression(
        "x",
        "v7: i32 = const 8; v9: i32 = udiv v3, v7",
        "v7: i32 = const 3; v9: i32 = ushr v3, v7",
    );
    expression(
        "x",
        "v7: i32 = const 8; v9: i32 = urem v3, v7",
        "v7: i32 = const 7; v9: i32 = and v3, v7",
    );
    // Signed division truncates, a shift rounds down.
    expression(
        "x",
        "v7: i32 = const 8; v9: i32 = sdiv v3, v7",
        "v7: i32 = const 8; v9: i32 = sdiv v3, v7",
    );
}

#[test]
fn constants_gather() {
    expression(
        "x",
        "v16: i32 = const 5; v7: i32 = add v3, v16; v8: i32 = const 7; v9: i32 = sub v7, v8",
        "v7: i32 = const -2; v9: i32 = add v3, v7",
    );
    expression(
        "p",
        "v16: i32 = const 5; v7: i32 = add v3, v16; v8: i32 = const 7; v9: i1 = eq v7, v8",
        "v7: i32 = const 2; v9: i1 = eq v3, v7",
    );
}

#[test]
fn shifts_combine_and_run_out() {
    expression(
        "x",
        "v16: i32 = const 5; v7: i32 = shl v3, v16; v8: i32 = const 7; v9: i32 = shl v7, v8",
        "v7: i32 = const 12; v9: i32 = shl v3, v7",
    );
    expression(
        "x",
        "v7: i32 = const 32; v9: i32 = shl v3, v7",
        "v9: i32 = const 0",
    );
    expression(
        "x",
        "v7: i32 = const -1; v9: i32 = sshr v3, v7",
        "v7: i32 = const 31; v9: i32 = sshr v3, v7",
    );
    expression(
        "x",
        "v7: i32 = const 28; v8: i32 = shl v3, v7; v9: i32 = ushr v8, v7",
        "v7: i32 = const 15; v9: i32 = and v3, v7",
    );
}

#[test]
fn comparisons_at_the_ends_of_a_type_are_decided_or_equalities() {
    expression(
        "p",
        "v7: i32 = const 0; v9: i1 = ult v3, v7",
        "v9: i1 = const 0",
    );
    expression(
        "p",
        "v7: i32 = const 0; v9: i1 = ugt v3, v7",
        "v7: i32 = const 0; v9: i1 = ne v3, v7",
    );
    expression(
        "p",
        "v7: i8 = const 127; v9: i1 = sle v2, v7",
        "v9: i1 = const 1",
    );
    expression(
        "p",
        "v7: i8 = const 126; v9: i1 = slt v2, v7",
        "v7: i8 = const 126; v9: i1 = slt v2, v7",
    );
    expression(
        "p",
        "v7: i8 = const 127; v9: i1 = sge v2, v7",
        "v7: i8 = const 127; v9: i1 = eq v2, v7",
    );
    expression(
        "p",
        "v7: i8 = const -1; v9: i1 = ult v2, v7",
        "v7: i8 = const -1; v9: i1 = ne v2, v7",
    );
    expression(
        "p",
        "v7: i1 = slt v3, v4; v9: i1 = not v7",
        "v9: i1 = sge v3, v4",
    );
    expression(
        "p",
        "v7: i32 = const 5; v9: i1 = slt v7, v3",
        "v7: i32 = const 5; v9: i1 = sgt v3, v7",
    );
}

#[test]
fn extended_values_are_compared_as_they_were() {
    expression(
        "p",
        "v7: i32 = zext v0; v8: i32 = const 1; v9: i1 = sge v7, v8",
        "v9: same v0",
    );
    expression(
        "p",
        "v7: i32 = zext v0; v8: i32 = const 2; v9: i1 = eq v7, v8",
        "v9: i1 = const 0",
    );
    expression(
        "p",
        "v7: i32 = sext v2; v8: i32 = const -3; v9: i1 = eq v7, v8",
        "v8: i8 = const -3; v9: i1 = eq v2, v8",
    );
    expression(
        "p",
        "v7: i32 = zext v2; v8: i32 = const 256; v9: i1 = slt v7, v8",
        "v9: i1 = const 1",
    );
}

#[test]
fn choices_between_bits_are_logic() {
    expression(
        "p",
        "v7: i1 = const 1; v8: i1 = const 0; v9: i1 = select v0, v8, v7",
        "v9: i1 = not v0",
    );
    expression(
        "p",
        "v7: i1 = const 1; v9: i1 = select v0, v7, v1",
        "v9: i1 = or v0, v1",
    );
    expression(
        "p",
        "v7: i1 = const 0; v9: i1 = select v0, v1, v7",
        "v9: i1 = and v0, v1",
    );
    expression("p", "v9: i1 = select v0, v1, v0", "v9: i1 = and v0, v1");
    expression(
        "x",
        "v7: i1 = not v0; v9: i32 = select v7, v3, v4",
        "v9: i32 = select v0, v4, v3",
    );
    expression(
        "x",
        "v7: i32 = select v1, v3, v4; v9: i32 = select v0, v7, v4",
        "v7: i1 = and v0, v1; v9: i32 = select v7, v3, v4",
    );
    expression(
        "x",
        "v7: i32 = select v0, v3, v4; v9: i32 = select v0, v4, v7",
        "v9: same v4",
    );
    expression(
        "p",
        "v7: i32 = const 3; v8: i32 = const 9; v16: i32 = select v0, v7, v8; v9: i1 = eq v16, v8",
        "v9: i1 = not v0",
    );
}

#[test]
fn conversions_cancel() {
    expression("b", "v7: i32 = sext v2; v9: i8 = trunc v7", "v9: same v2");
    expression(
        "x",
        "v7: i64 = zext v2; v9: i32 = trunc v7",
        "v9: i32 = zext v2",
    );
    expression(
        "x",
        "v7: i8 = trunc v3; v9: i32 = zext v7",
        "v7: i32 = const 255; v9: i32 = and v3, v7",
    );
    expression(
        "f",
        "v7: i32 = float_bits v6; v9: f32 = bits_float v7",
        "v9: same v6",
    );
}

/// A bit that was put into a word and is taken out again never sees the word; another bit of the
/// word is not delayed by it.
#[test]
fn bits_of_words_find_their_source() {
    let put = "v15: i32 = const -9; v16: i32 = and v3, v15; v7: i32 = zext v0; v8: i32 = const 3; \
               v10: i32 = shl v7, v8; v11: i32 = or v16, v10";
    expression(
        "p",
        &format!("{put}; v12: i32 = ushr v11, v8; v9: i1 = trunc v12"),
        "v9: same v0",
    );
    expression(
        "p",
        &format!("{put}; v13: i32 = const 4; v12: i32 = ushr v11, v13; v9: i1 = trunc v12"),
        "v7: i32 = const 4; v8: i32 = ushr v3, v7; v9: i1 = trunc v8",
    );
}

#[test]
fn a_constant_through_a_loop_is_found_by_assuming_the_best() {
    check(
        &["fold", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i32 = const 7
  v1: i32 = load input.x
  jump b1(v0, v1)
b1(v2: i32, v3: i32):
  v4: i32 = const 0
  v5: i1 = sgt v3, v4
  brif v5, b2, b3
b2:
  v6: i32 = const 7
  v7: i1 = eq v2, v6
  v8: i32 = const 1000000000
  v9: i32 = sub v3, v8
  brif v7, b1(v2, v9), b4
b3:
  store output.x, v2
  return
b4:
  fault range
}
",
        "fn @scan[]() -> () {
b0:
  v1: i32 = load input.x
  jump b1(v1)
b1(v2: i32):
  v3: i32 = const 7
  v4: i32 = const 0
  v5: i1 = sgt v2, v4
  brif v5, b2, b3
b2:
  v6: i32 = const -1000000000
  v7: i32 = add v2, v6
  jump b1(v7)
b3:
  store output.x, v3
  return
}
",
    );
}

#[test]
fn constant_indices_become_static_or_fall_outside() {
    check(
        &["fold", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i32 = const 2
  v1: i32 = const 4
  v2: i32 = load state.a[v0]
  v3: i32 = load state.a[v1]
  v4: i32 = add v2, v3
  store state.a[v0], v4
  store state.a[v1], v4
  v5: i32 = const -1
  v6: i1 = load state.w.[v5]
  store output.p, v6
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i32 = load state.a[2]
  store state.a[2], v0
  v1: i1 = const 0
  store output.p, v1
  return
}
",
    );
}

#[test]
fn empty_blocks_and_equal_arguments_vanish() {
    check(
        &["fold"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i32 = load input.x
  brif v0, b1, b2
b1:
  jump b3(v1)
b2:
  jump b3(v1)
b3(v2: i32):
  store output.x, v2
  return
}
",
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i32 = load input.x
  store output.x, v1
  return
}
",
    );
}

/// The first choice decides the second: no way passes it twice.
#[test]
fn jumps_with_known_conditions_skip_the_branch() {
    check(
        &["fold", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i1 = const 1
  v2: i1 = const 0
  brif v0, b1, b2
b1:
  store state.w, v7
  jump b3(v1)
b2:
  v3: i32 = load input.x
  store state.n, v3
  jump b3(v2)
b3(v4: i1):
  brif v4, b4, b5
b4:
  fault index
b5:
  return
}
"
        .replace("  store state.w, v7\n", "")
        .as_str(),
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  brif v0, b1, b2
b2:
  v3: i32 = load input.x
  store state.n, v3
  return
b1:
  fault index
}
",
    );
}

#[test]
fn a_branch_on_an_inverse_is_turned_around() {
    check(
        &["fold", "dce"],
        HEADER,
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  v1: i1 = not v0
  brif v1, b1, b2
b1:
  fault index
b2:
  fault range
}
",
        "fn @scan[]() -> () {
b0:
  v0: i1 = load input.p
  brif v0, b2, b1
b1:
  fault index
b2:
  fault range
}
",
    );
}
