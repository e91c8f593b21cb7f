//! Whole scans: time, faults, fuel, prescan. What single instructions do is tested by the files in
//! `tests/filetests/run`.

use iecc_interp::{Interpreter, run_prescan};
use iecc_ir::{FaultCode, Module, Region, parse_module, verify};
use iecc_target::{Engine, Fault, region_bytes};

fn parse(text: &str) -> Module {
    parse_module(text).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs one scan with inputs 0 and returns the outputs.
fn step(engine: &mut Interpreter, now_ns: u64, outputs: &mut [u8]) -> Result<(), Fault> {
    let inputs = region_bytes(engine.module(), Region::Input);
    engine.step(now_ns, &inputs, outputs)
}

/// Counts scans in `n`, then faults when `bad` is set, with origin 0.
const FAULTING: &str = r#"module m
state { n: i32, bad: i1 }
input { }
output { y: i32, z: i32 }
origin @0 = "rung 7"
scan @scan
fn @fail[]() -> () {
b0:
  v0: i1 = load state.bad
  brif v0, b1, b2
b1:
  fault divide @0
b2:
  return
}
fn @scan[]() -> () {
b0:
  v0: i32 = load state.n
  v1: i32 = const 1
  v2: i32 = add v0, v1
  store state.n, v2
  store output.y, v2
  call @fail[]()
  store output.z, v2
  return
}
"#;

#[test]
fn a_fault_leaves_state_and_outputs_as_before() {
    let module = parse(FAULTING);
    let mut engine = Interpreter::new(verify(&module).unwrap());
    let mut outputs = vec![0; 8];
    step(&mut engine, 0, &mut outputs).unwrap();
    assert_eq!(outputs, [1, 0, 0, 0, 1, 0, 0, 0]);

    engine.set_state(&[1, 0, 0, 0, 1, 0, 0, 0]);
    let fault = step(&mut engine, 10, &mut outputs).unwrap_err();
    assert_eq!(fault.code, FaultCode::Divide);
    assert_eq!(fault.origin, module.origins.keys().next());
    assert_eq!(engine.state(), [1, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!(outputs, [1, 0, 0, 0, 1, 0, 0, 0]);

    engine.set_state(&[1, 0, 0, 0, 0, 0, 0, 0]);
    step(&mut engine, 20, &mut outputs).unwrap();
    assert_eq!(outputs, [2, 0, 0, 0, 2, 0, 0, 0]);
}

#[test]
fn an_endless_loop_is_the_fault_bound() {
    let module = parse(
        "module m\nstate { n: i32 }\ninput { }\noutput { }\norigin @0 = \"loop\"\nscan @s\n\
         fn @s[]() -> () {\nb0:\n  v0: i32 = const 7\n  store state.n, v0\n  jump b1\n\
         b1:\n  jump b1 @0\n}\n",
    );
    let mut engine = Interpreter::new(verify(&module).unwrap()).with_fuel(1000);
    let fault = step(&mut engine, 0, &mut []).unwrap_err();
    assert_eq!(fault.code, FaultCode::Bound);
    assert_eq!(fault.origin, module.origins.keys().next());
    assert_eq!(engine.state(), [0; 4]);
}

/// Two blocks of 2 and 1 instructions: 3 + 2 units of fuel.
#[test]
fn fuel_counts_instructions_and_terminators() {
    let module = parse(
        "module m\nstate { n: i32 }\ninput { }\noutput { }\nscan @s\n\
         fn @s[]() -> () {\nb0:\n  v0: i32 = const 7\n  store state.n, v0\n  jump b1\n\
         b1:\n  store state.n, v0\n  return\n}\n",
    );
    let run = |fuel| {
        let mut engine = Interpreter::new(verify(&module).unwrap()).with_fuel(fuel);
        step(&mut engine, 0, &mut []).map_err(|fault| fault.code)
    };
    assert_eq!(run(4), Err(FaultCode::Bound));
    assert_eq!(run(5), Ok(()));
}

/// A chain of calls where each function calls the next twice has a cost that doubles with each.
#[test]
fn calls_that_multiply_run_out_of_fuel_too() {
    let mut text = "module m\nstate { n: i32 }\ninput { }\noutput { }\nscan @f0\n".to_owned();
    for level in 0..60 {
        let next = level + 1;
        text += &format!(
            "fn @f{level}[]() -> () {{\nb0:\n  call @f{next}[]()\n  call @f{next}[]()\n  return\n}}\n"
        );
    }
    text += "fn @f60[]() -> () {\nb0:\n  v0: i32 = const 1\n  store state.n, v0\n  return\n}\n";
    let module = parse(&text);
    let mut engine = Interpreter::new(verify(&module).unwrap()).with_fuel(10_000);
    let fault = step(&mut engine, 0, &mut []).unwrap_err();
    assert_eq!(fault.code, FaultCode::Bound);
    assert_eq!(engine.state(), [0; 4]);
}

/// `step` counts from the last scan that ended well: a fault does not eat time.
#[test]
fn step_counts_from_the_last_good_scan() {
    let module = parse(
        "module m\nstate { sum: i64 }\ninput { bad: i1 }\noutput { y: i64 }\nscan @s\n\
         fn @s[]() -> () {\nb0:\n  v0: i1 = load input.bad\n  brif v0, b1, b2\nb1:\n  fault range\n\
         b2:\n  v1: i64 = step 1ms\n  store output.y, v1\n  return\n}\n",
    );
    let mut engine = Interpreter::new(verify(&module).unwrap());
    let mut outputs = vec![0; 8];
    let steps = [
        (5_000_000, 0, 0),
        (9_999_999, 0, 4),
        (12_000_000, 1, 4),
        (13_500_000, 0, 4),
        (15_000_000, 0, 2),
    ];
    for (now_ns, bad, expected) in steps {
        let result = engine.step(now_ns, &[bad], &mut outputs);
        assert_eq!(result.is_err(), bad == 1);
        assert_eq!(outputs[0], expected, "at {now_ns} ns");
    }
}

#[test]
fn prescan_changes_the_image_only() {
    let text = "module m\nstate { n: i32, t: i64 }\ninput { x: i32 }\noutput { y: i32 }\ninit n = 5\ninit t = 9\n\
         prescan @p\nscan @s\nfn @s[]() -> () {\nb0:\n  return\n}\n\
         fn @p[]() -> () {\nb0:\n  v0: i32 = load state.n\n  v1: i32 = load input.x\n  v2: i32 = const 37\n\
         \x20 v3: i32 = add v0, v2\n  v4: i32 = add v3, v1\n  store state.n, v4\n  store output.y, v4\n\
         \x20 v5: i64 = now\n  store state.t, v5\n  return\n}\n";
    let module = parse(text);
    let image = run_prescan(verify(&module).unwrap()).unwrap();
    assert_eq!(
        image.bytes(),
        [42, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
    );
    assert_eq!(module.image.bytes()[0], 5);
}

#[test]
fn a_module_without_prescan_keeps_its_image() {
    let module = parse(FAULTING);
    let image = run_prescan(verify(&module).unwrap()).unwrap();
    assert_eq!(image, module.image);
}
