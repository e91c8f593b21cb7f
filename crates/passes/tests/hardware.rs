//! The hardware passes on a timer in normal form: what they find is worked out by hand, and what
//! they leave does the same as before.

use iecc_interp::Interpreter;
use iecc_ir::analysis::Range;
use iecc_ir::{Module, Place, Root, Type, parse_module, print_module, verify};
use iecc_passes::{Settings, ranges, run};
use iecc_target::Engine;

/// A TON with PRE 2000 that runs in every scan while `In` is on; the lamp shows DN.
const TIMER: &str = "module timer
struct TIMER { EN: i1, TT: i1, DN: i1, PRE: i32, ACC: i32, last: i64 }
state { t: TIMER, copy: i1, unused: i32 }
input { In: i1 }
output { Done: i1, Timing: i1 }
init t.PRE = 2000
scan @scan
fn @scan[]() -> () {
b0:
  v0: i1 = load input.In
  v1: i1 = load state.t.EN
  v2: i1 = load state.t.DN
  v3: i32 = load state.t.ACC
  v4: i32 = load state.t.PRE
  v40: i32 = load state.unused
  v41: i32 = add v40, v40
  store state.unused, v41
  v5: i32 = elapsed state.t.last, 1ms
  v6: i1 = not v2
  v7: i1 = and v0, v1
  v8: i1 = and v7, v6
  v9: i32 = add v3, v5
  v10: i32 = const 0
  v11: i1 = slt v9, v3
  v12: i32 = const 2147483647
  v13: i32 = select v11, v12, v9
  v14: i32 = select v8, v13, v3
  v15: i1 = sge v14, v4
  v16: i1 = or v2, v15
  v17: i1 = and v0, v16
  v18: i32 = select v0, v14, v10
  v19: i1 = not v17
  v20: i1 = and v0, v19
  store state.t.EN, v0
  store state.t.DN, v17
  store state.t.TT, v20
  store state.t.ACC, v18
  store state.copy, v0
  store output.Done, v17
  store output.Timing, v20
  return
}
";

const SETTINGS: Settings = Settings {
    longest_period_ns: Some(1_000_000),
};

fn timer() -> Module {
    let module = parse_module(TIMER).unwrap();
    assert_eq!(verify(&module).err(), None);
    module
}

fn pass(module: &mut Module, name: &str) {
    run(name, module, &SETTINGS).unwrap();
    assert_eq!(
        verify(module).err(),
        None,
        "after {name}:\n{}",
        print_module(module)
    );
}

fn leaf(module: &Module, names: &[&str]) -> Place {
    Place::named(&module.types, Root::State, module.state, names).unwrap()
}

/// Outputs of 30,000 scans, one a millisecond, with the input on in stretches.
fn outputs(module: &Module) -> Vec<u8> {
    let mut engine = Interpreter::new(verify(module).unwrap());
    let mut all = Vec::new();
    for scan in 0..30_000u64 {
        let mut outputs = [0; 2];
        let on = (scan % 7001) % 2600 < 2300;
        engine
            .step(scan * 1_000_000, &[u8::from(on)], &mut outputs)
            .unwrap();
        all.extend(outputs);
    }
    assert!(all.contains(&1));
    all
}

#[test]
fn without_a_promise_about_scans_the_accumulator_is_bounded_by_its_saturation() {
    let mut module = timer();
    pass(&mut module, "step_time");
    // The counter behind `elapsed` is loaded and stored twice: not in normal form before promotion.
    assert!(ranges(&module, &|_| 1).state.is_empty());
}

/// The timer after what promotion makes of `step_time`: the step itself.
fn stepped() -> Module {
    let text = TIMER.replace("elapsed state.t.last, 1ms", "step 1ms");
    parse_module(&text).unwrap()
}

#[test]
fn the_accumulator_stays_within_the_preset_because_done_stops_it() {
    let module = stepped();
    let found = ranges(&module, &|_| 1);
    assert_eq!(
        found.leaf(&leaf(&module, &["t", "ACC"]), Type::I32),
        Range::new(0, 2000)
    );
    assert_eq!(
        found.leaf(&leaf(&module, &["t", "PRE"]), Type::I32),
        Range::constant(2000)
    );
    // Ten units a scan overshoot by up to nine.
    let coarse = ranges(&module, &|_| 10);
    assert_eq!(
        coarse.leaf(&leaf(&module, &["t", "ACC"]), Type::I32),
        Range::new(0, 2009)
    );
}

#[test]
fn reaching_the_preset_becomes_an_equality() {
    let mut module = stepped();
    pass(&mut module, "range_fold");
    let text = print_module(&module);
    assert!(text.contains("eq v"), "{text}");
    assert!(!text.contains("sge"), "{text}");
    assert_eq!(outputs(&module), outputs(&stepped()));
}

#[test]
fn constant_unused_and_equal_leaves_go() {
    let mut module = stepped();
    pass(&mut module, "range_fold");
    pass(&mut module, "state");
    let text = print_module(&module);
    assert!(!text.contains("store state.unused"), "{text}");
    assert!(!text.contains("load state.t.PRE"), "{text}");
    assert!(!text.contains("store state.copy"), "{text}");
    assert!(
        !text.contains("store state.t.TT"),
        "TT is never read: {text}"
    );
    assert_eq!(outputs(&module), outputs(&stepped()));
}

#[test]
fn the_comparison_with_the_preset_is_made_a_scan_early() {
    let mut module = stepped();
    for name in ["range_fold", "state", "early_compare"] {
        pass(&mut module, name);
    }
    let text = print_module(&module);
    assert!(text.contains("\"t.ACC_is_1999\": i1"), "{text}");
    // ACC == PRE is DN, and nothing behind the rung is compared: one equality, of the register.
    assert_eq!(text.matches(" eq ").count(), 1, "{text}");
    assert_eq!(text.matches(" sge ").count(), 0, "{text}");
    assert_eq!(outputs(&module), outputs(&stepped()));
}

/// A CTU with PRE 9; the lamp shows DN. `RESET` is put where a reset stands.
const COUNTER: &str = "module counter
struct COUNTER { CU: i1, DN: i1, OV: i1, ACC: i8 }
state { c: COUNTER }
input { Count: i1, Reset: i1 }
output { Done: i1 }
scan @scan
fn @scan[]() -> () {
b0:
  v0: i1 = load input.Count
  v1: i1 = load input.Reset
  v2: i1 = load state.c.CU
  v3: i1 = load state.c.OV
  v4: i8 = load state.c.ACC
  v5: i1 = not v2
  v6: i1 = and v0, v5
  v7: i8 = const 1
  v8: i8 = add v4, v7
  v9: i8 = select v6, v8, v4
  v10: i8 = const 127
  v11: i1 = eq v4, v10
  v12: i1 = and v6, v11
  v13: i1 = or v3, v12
  v14: i8 = const 9
  v15: i1 = sge v9, v14
  v16: i1 = or v15, v13
  v17: i1 = not v1
  v18: i1 = and v0, v17
  v19: i1 = and v13, v17
  v20: i8 = const 0
  v21: i8 = select v1, v20, v9
  store state.c.CU, v18
  store state.c.OV, v19
  store state.c.ACC, v21
  store output.Done, v16
  return
}
";

/// Outputs of counting to far beyond the wrap of an `i8`, with a reset now and then.
fn counted(module: &Module) -> Vec<u8> {
    let mut engine = Interpreter::new(verify(module).unwrap());
    let mut all = Vec::new();
    for scan in 0..5_000u64 {
        let mut outputs = [0];
        let reset = scan % 1201 == 1200 || scan % 1201 == 7;
        engine
            .step(
                scan * 1_000_000,
                &[u8::from(scan % 2 == 0), u8::from(reset)],
                &mut outputs,
            )
            .unwrap();
        all.extend(outputs);
    }
    assert!(all.contains(&0) && all.contains(&1));
    all
}

#[test]
fn a_counter_stops_where_nobody_sees_it_go_on() {
    let old = parse_module(COUNTER).unwrap();
    let mut module = old.clone();
    pass(&mut module, "saturate");
    pass(&mut module, "state");
    let found = ranges(&module, &|_| 1);
    assert_eq!(
        found.leaf(&leaf(&module, &["c", "ACC"]), Type::I8),
        Range::new(0, 9)
    );
    assert!(
        !print_module(&module).contains("store state.c.OV"),
        "{}",
        print_module(&module)
    );
    assert_eq!(counted(&module), counted(&old));
}

#[test]
fn a_counter_whose_wrap_can_be_seen_is_left_alone() {
    // In turn: the overflow flag is an output; DN forgets it; the count itself is an output; the
    // flag survives a reset; the flag is set by hand.
    let changes = [
        ("store output.Done, v16", "store output.Done, v13"),
        ("v16: i1 = or v15, v13", "v16: i1 = or v15, v15"),
        (
            "store output.Done, v16",
            "v99: i1 = sgt v4, v8\n  store output.Done, v99",
        ),
        ("v19: i1 = and v13, v17", "v19: i1 = or v13, v13"),
        (
            "v13: i1 = or v3, v12",
            "v22: i1 = or v3, v12\n  v13: i1 = or v22, v6",
        ),
    ];
    for (from, to) in changes {
        let text = COUNTER.replace(from, to);
        let mut module = parse_module(&text).unwrap();
        let before = print_module(&module);
        pass(&mut module, "saturate");
        // Loads move to the front in any case; no comparison may have come in.
        assert_eq!(
            print_module(&module).matches("sge").count(),
            before.matches("sge").count(),
            "{to}"
        );
    }
}

#[test]
fn the_accumulator_is_cleared_a_scan_later_by_the_flag_that_keeps_its_rung() {
    let mut module = stepped();
    for name in [
        "range_fold",
        "state",
        "early_compare",
        "fold",
        "cse",
        "late_clear",
        "fold",
        "cse",
        "dce",
    ] {
        pass(&mut module, name);
    }
    // The value stored is chosen by EN alone; the input is not among what it is made from.
    let text = print_module(&module);
    let after = |pattern: &str| {
        let start = text
            .find(pattern)
            .unwrap_or_else(|| panic!("{pattern}: {text}"))
            + pattern.len();
        text[start..].split([',', '\n']).next().unwrap().to_owned()
    };
    let stored = after("store state.t.ACC, ");
    let condition = after(&format!("{stored}: i32 = select "));
    assert!(
        text.contains(&format!("{condition}: i1 = load state.t.EN")),
        "{text}"
    );
    let input = text
        .find("load input.In")
        .map(|at| text[..at].rsplit("  ").next().unwrap());
    let input = input.unwrap().split(':').next().unwrap();
    let mut open = vec![stored.clone()];
    while let Some(value) = open.pop() {
        assert_ne!(value, input, "{text}");
        let line = text
            .lines()
            .find(|line| line.starts_with(&format!("  {value}: ")))
            .unwrap();
        let operands = line.split(" = ").nth(1).unwrap();
        let words = operands
            .split([' ', ','])
            .filter(|word| word.starts_with('v'));
        open.extend(words.map(str::to_owned));
    }
    assert_eq!(outputs(&module), outputs(&stepped()));
}
