//! Machine code computes with any NaN, and shows the one that the step language says: results of
//! arithmetic are the canonical NaN wherever their bits are seen, what is moved keeps its bits.

use iecc_ir::{parse_module, verify};
use iecc_jit::Jit;
use iecc_target::Engine;

const CANONICAL: u32 = 0x7fc0_0000;
const CANONICAL_WIDE: u64 = 0x7ff8_0000_0000_0000;
/// A NaN with a payload and a sign.
const ODD: u32 = 0xffc1_2345;
const INFINITY: u32 = 0x7f80_0000;

/// A program with two `f32` inputs and outputs of words.
fn program(state: &str, outputs: &str, scan: &str) -> Jit {
    let text = format!(
        "module m\nstate {{ {state} }}\ninput {{ x: f32, y: f32 }}\noutput {{ {outputs} }}\nscan @s\n\
         {scan}"
    );
    let module = parse_module(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Jit::new(verify(&module).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"))).unwrap()
}

/// The outputs of a scan as words.
fn scan(jit: &mut Jit, x: u32, y: u32, words: usize) -> Vec<u32> {
    let mut outputs = vec![0; 4 * words];
    let inputs = [x.to_le_bytes(), y.to_le_bytes()].concat();
    jit.step(0, &inputs, &mut outputs).unwrap();
    self::words(&outputs)
}

fn words(bytes: &[u8]) -> Vec<u32> {
    let word = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
    bytes.chunks(4).map(word).collect()
}

#[test]
fn results_of_arithmetic_are_stored_as_the_canonical_nan() {
    let mut jit = program(
        "a: f32, b: f32, c: f32, d: f64",
        "x: f32, bits: i32",
        "fn @s[]() -> () {
b0:
  v0: f32 = load input.x
  v1: f32 = load input.y
  v2: f32 = fadd v0, v1
  store state.a, v2
  v3: f32 = fneg v0
  store state.b, v3
  v4: f32 = fmul v2, v3
  store state.c, v4
  v5: f64 = promote v0
  store state.d, v5
  store output.x, v4
  v6: i32 = float_bits v2
  store output.bits, v6
  return
}
",
    );
    let one = 1f32.to_bits();
    assert_eq!(scan(&mut jit, ODD, one, 2), [CANONICAL, CANONICAL]);
    let wide = CANONICAL_WIDE.to_le_bytes();
    let narrow = [CANONICAL, CANONICAL, CANONICAL, 0].map(u32::to_le_bytes);
    assert_eq!(jit.state(), [narrow.concat(), wide.to_vec()].concat());
    // 2 + 1 = 3, -2, 3 * -2 = -6: no NaN anywhere.
    let [two, three, six] = [2f32, 3.0, -6.0].map(f32::to_bits);
    assert_eq!(scan(&mut jit, two, one, 2), [six, three]);
    // inf + -inf is NaN, -inf is a number, NaN * -inf is NaN.
    let found = scan(&mut jit, INFINITY, INFINITY | 1 << 31, 2);
    assert_eq!(found, [CANONICAL, CANONICAL]);
    let expected = [CANONICAL, INFINITY | 1 << 31, CANONICAL];
    assert_eq!(words(jit.state())[..3], expected);
}

/// Only the last result is looked at: it is NaN with any of the others, and also without them.
#[test]
fn a_nan_of_infinities_at_the_end_leaves_the_numbers_before_it() {
    let mut jit = program(
        "a: f32",
        "x: f32",
        "fn @s[]() -> () {
b0:
  v0: f32 = load input.x
  v1: f32 = load input.y
  v2: f32 = fmul v0, v0
  store state.a, v2
  v3: f32 = fsub v2, v1
  store output.x, v3
  return
}
",
    );
    assert_eq!(scan(&mut jit, INFINITY, INFINITY, 1), [CANONICAL]);
    assert_eq!(words(jit.state()), [INFINITY]);
}

#[test]
fn what_is_moved_keeps_its_bits() {
    let mut jit = program(
        "a: f32, b: f32",
        "x: f32, bits: i32",
        "fn @s[]() -> () {
b0:
  v0: f32 = load input.x
  v1: f32 = load input.y
  v2: f32 = fadd v0, v1
  store state.a, v2
  store state.a, v0
  v3: i1 = fgt v1, v1
  v4: f32 = select v3, v2, v0
  store state.b, v4
  v5: f32 = load state.a
  store output.x, v5
  v6: i32 = float_bits v5
  store output.bits, v6
  return
}
",
    );
    assert_eq!(scan(&mut jit, ODD, 0, 2), [ODD, ODD]);
    assert_eq!(words(jit.state()), [ODD, ODD]);
}

/// The choice has either a result of arithmetic or what was loaded.
#[test]
fn choices_and_parameters_of_blocks_know_where_a_nan_comes_from() {
    let mut jit = program(
        "a: f32, b: f32",
        "x: f32",
        "fn @s[]() -> () {
b0:
  v0: f32 = load input.x
  v1: f32 = load input.y
  v2: f32 = fadd v0, v0
  v3: f32 = const 0.0
  v4: i1 = fgt v1, v3
  v5: f32 = select v4, v2, v0
  store state.a, v5
  brif v4, b1(v2), b1(v0)
b1(v6: f32):
  store state.b, v6
  v7: f32 = fmul v6, v1
  jump b2(v7)
b2(v8: f32):
  store output.x, v8
  return
}
",
    );
    assert_eq!(scan(&mut jit, ODD, 1f32.to_bits(), 1), [CANONICAL]);
    assert_eq!(words(jit.state()), [CANONICAL, CANONICAL]);
    assert_eq!(scan(&mut jit, ODD, (-1f32).to_bits(), 1), [CANONICAL]);
    assert_eq!(words(jit.state()), [ODD, ODD]);
}

/// Limits pass NaN on, so a look behind them is enough; the others replace it.
#[test]
fn choices_that_replace_a_nan_do_not_hide_it() {
    let mut jit = program(
        "sum: f32, limited: f32, replaced: f32",
        "x: f32",
        "fn @s[]() -> () {
b0:
  v0: f32 = load input.x
  v1: f32 = load input.y
  v2: f32 = fadd v0, v1
  store state.sum, v2
  v3: f32 = const 9.0
  v4: i1 = fgt v2, v3
  v5: f32 = select v4, v3, v2
  store state.limited, v5
  v6: i1 = fle v2, v3
  v7: f32 = select v6, v2, v3
  v8: f32 = fadd v7, v3
  store state.replaced, v8
  store output.x, v8
  return
}
",
    );
    let eighteen = 18f32.to_bits();
    assert_eq!(scan(&mut jit, ODD, 0, 1), [eighteen]);
    assert_eq!(words(jit.state()), [CANONICAL, CANONICAL, eighteen]);
}

/// The NaN of a number of arithmetic becomes 0 as an integer, which hides it from what follows.
#[test]
fn conversions_to_integers_hide_a_nan() {
    let mut jit = program(
        "sum: f32",
        "x: f32",
        "fn @s[]() -> () {
b0:
  v0: f32 = load input.x
  v1: f32 = fadd v0, v0
  store state.sum, v1
  v2: i32 = float_to_sint v1
  v3: f32 = sint_to_float v2
  v4: f32 = fadd v3, v3
  store output.x, v4
  return
}
",
    );
    assert_eq!(scan(&mut jit, ODD, 0, 1), [0]);
    assert_eq!(words(jit.state()), [CANONICAL]);
}

/// Bytes that are copied, passed and indexed are seen; so is what a loop goes on with.
#[test]
fn copies_calls_indices_and_loops_see_the_canonical_nan() {
    let mut jit = program(
        "a: [2 x f32], b: [2 x f32], c: f32, sum: f32",
        "x: f32",
        "fn @next[p: f32](f32) -> (f32) {
b0(v0: f32):
  v1: f32 = load p
  store state.c, v0
  v2: f32 = fsub v1, v0
  return v2
}
fn @s[]() -> () {
b0:
  v0: f32 = load input.x
  v1: f32 = fneg v0
  store state.a[1], v1
  copy state.b, state.a
  v2: i32 = const 1
  v3: f32 = load state.a[v2]
  store state.a[0], v3
  v4: f32 = fadd v1, v1
  store state.sum, v4
  v5: f32 = call @next[state.sum](v4)
  v6: f32 = const 0.0
  v7: i32 = const 0
  jump b1(v7, v6)
b1(v8: i32, v9: f32):
  v10: f32 = fadd v9, v5
  store state.sum, v10
  v11: i32 = add v8, v2
  v12: i32 = const 3
  v13: i1 = slt v11, v12
  brif v13, b1(v11, v10), b2
b2:
  store output.x, v10
  return
}
",
    );
    assert_eq!(scan(&mut jit, ODD, 0, 1), [CANONICAL]);
    let expected = [CANONICAL, CANONICAL, 0, CANONICAL, CANONICAL, CANONICAL];
    assert_eq!(words(jit.state()), expected);
}
