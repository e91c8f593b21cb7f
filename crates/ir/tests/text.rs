//! Printing is a fixed point of parsing, and mistakes are reported with their place.

use iecc_ir::{parse_module, print_module, verify};

const DEMO: &str = r#"module demo
struct TIMER { EN: i1, DN: i1, PRE: i32, last: i64 }
state { run: i1, t: TIMER, "Local:2:I": i16, a: [4 x i32], r: f32 }
input { Start: i1 }
output { Lamp: i1 }
init t.PRE = 2000
init a[1] = -1
init r = 1.5
name "Local:2:I.3" = state."Local:2:I".3
origin @0 = "Main rung 5" 0:120..140
scan @scan

fn @helper[t: TIMER](i1) -> (i32) {
b0(v0: i1):
  v1: i32 = elapsed t.last, 1ms
  brif v0, b1, b2(v1) @0
b1:
  return v1
b2(v2: i32):
  v3: i32 = const -7
  v4: i32 = add v2, v3
  switch v4, b1 [-7: b1, 3: b3]
b3:
  fault index
}

fn @scan[]() -> () {
b0:
  v0: i1 = load input.Start @0
  v1: i32 = call @helper[state.t](v0)
  store state.a[3], v1
  store state."Local:2:I".[v1], v0
  v2: i1 = load state."Local:2:I".3
  v3: f32 = const 0x7fc00000
  store state.r, v3
  store output.Lamp, v2
  return
}
"#;

#[test]
fn printing_is_a_fixed_point_of_parsing() {
    let module = parse_module(DEMO).unwrap();
    assert_eq!(verify(&module).err(), None);
    assert_eq!(print_module(&module), DEMO);
}

#[test]
fn a_mistake_is_reported_with_line_and_column() {
    let error =
        parse_module("module x\nscan @s\nfn @s[]() -> () {\nb0:\n  v0: i1 = lod input.a\n}\n");
    let error = error.unwrap_err();
    assert_eq!((error.line, error.column), (5, 12));
    assert_eq!(error.message, "found `lod`, expected an instruction");
}

#[test]
fn every_prefix_of_a_text_is_refused_without_panic() {
    for end in (0..DEMO.len() - 2).filter(|&end| DEMO.is_char_boundary(end)) {
        assert!(parse_module(&DEMO[..end]).is_err(), "prefix of {end} bytes");
    }
}

/// Initial values have places in the state.
#[test]
fn initial_values_outside_of_their_array_are_refused() {
    let text = |index: u32| {
        format!(
            "module m\nstate {{ a: [2 x i8] }}\ninput {{}}\noutput {{}}\ninit a[{index}] = 5\nscan @s\n\
             fn @s[]() -> () {{\nb0:\n  return\n}}\n"
        )
    };
    assert!(parse_module(&text(1)).is_ok());
    let Err(error) = parse_module(&text(2)) else {
        panic!("the array has two elements");
    };
    assert!(error.to_string().contains("below the lengths"), "{error}");
}

/// A scan function body around the given lines; the module has a state `n: i32`, `b: i1`, an array
/// `a: [2 x i8]`, an input `x: i1` and an output `y: i1`.
fn broken_rules(body: &str) -> Vec<u8> {
    let text = format!(
        "module m\nstate {{ n: i32, b: i1, a: [2 x i8], t: i64 }}\ninput {{ x: i1 }}\noutput {{ y: i1 }}\nscan @s\n\
         fn @f[r: i32](i1) -> (i1) {{\nb0(v0: i1):\n  return v0\n}}\nfn @s[]() -> () {{\n{body}\n}}\n"
    );
    let module = parse_module(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let errors = verify(&module).err().unwrap_or_default();
    errors.iter().map(|error| error.rule).collect()
}

#[test]
fn each_rule_of_the_verifier_is_enforced() {
    let cases: &[(&str, &[u8])] = &[
        ("b0:\n  return", &[]),
        ("b0:\n  call @s[]()\n  return", &[5]),
        ("b0:\n  jump b0", &[6]),
        (
            "b0:\n  v0: i32 = add v1, v1\n  v1: i32 = const 1\n  return",
            &[8, 8],
        ),
        (
            "b0:\n  v0: i1 = load state.b\n  brif v0, b1, b2\nb1:\n  v1: i32 = const 1\n  jump b2\nb2:\n  store state.n, v1\n  return",
            &[8],
        ),
        (
            "b0:\n  v0: i1 = load state.b\n  jump b1\nb1(v1: i1):\n  return",
            &[9],
        ),
        ("b0:\n  v0: i1 = load state.b\n  return v0", &[9]),
        (
            "b0:\n  v0: i1 = load state.b\n  v1: i1 = add v0, v0\n  return",
            &[10],
        ),
        (
            "b0:\n  v0: i32 = load state.n\n  v1: i32 = select v0, v0, v0\n  return",
            &[11],
        ),
        (
            "b0:\n  v0: i32 = load state.n\n  switch v0, b1 [1: b1, 1: b1]\nb1:\n  return",
            &[11],
        ),
        ("b0:\n  v0: i8 = load state.a[2]\n  return", &[12, 13]),
        (
            "b0:\n  v0: i1 = load state.b\n  v1: i8 = load state.a[v0]\n  return",
            &[12],
        ),
        ("b0:\n  v0: i1 = load state.n\n  return", &[13]),
        ("b0:\n  v0: i1 = load output.y\n  return", &[13]),
        (
            "b0:\n  v0: i1 = load state.b\n  store input.x, v0\n  return",
            &[13],
        ),
        (
            "b0:\n  v0: i1 = load state.b\n  v1: i1 = call @f[state.b](v0)\n  return",
            &[14],
        ),
        (
            "b0:\n  v0: i1 = load state.b\n  v1: i1 = call @f[state.n]()\n  return",
            &[14],
        ),
        ("b0:\n  v0: i32 = elapsed state.n, 1ms\n  return", &[15]),
        ("b0:\n  v0: i32 = step 0ns\n  return", &[15]),
    ];
    for (body, rules) in cases {
        assert_eq!(&broken_rules(body), rules, "{body}");
    }
}
