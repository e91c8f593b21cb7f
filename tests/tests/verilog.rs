//! The Verilog back end, judged by others: Icarus Verilog runs what the interpreter runs, Verilator
//! and Yosys read it without a warning.
#![expect(
    clippy::disallowed_methods,
    reason = "tests write files and run programs"
)]

use iecc_driver::sim::VerilogSim;
use iecc_interp::Interpreter;
use iecc_ir::{Module, Region, parse_module, print_module, verify};
use iecc_passes::{HARDWARE, Settings, run_pipeline};
use iecc_target::{Engine, Refusal, Target, region_bytes};
use iecc_tests::one_block::one_block_module;
use iecc_tests::random_ir::{self, random_module};
use iecc_tests::rng::{Rng, seeds};
use iecc_tests::stimulus::random_stimulus;
use iecc_tests::tools::{self, said};
use iecc_verilog::{Board, Clock, Options, Verilog, max_step};
use std::path::Path;
use std::process::Stdio;

const MS: u64 = 1_000_000;

/// Options for a period, with or without what range analysis finds.
fn options(module: &Module, clock: Clock, narrow: bool) -> Options {
    let mut options = Options::new(clock);
    if narrow {
        options.ranges = iecc_passes::ranges(module, &|unit_ns| max_step(clock, unit_ns));
    }
    options
}

/// Inputs of `scans` scans, and the outputs the interpreter gives for them.
fn expected(
    module: &Module,
    seed: u64,
    scans: usize,
    period_ns: u64,
) -> (Vec<Vec<u8>>, Vec<Vec<u8>>) {
    let mut rng = Rng::new(seed);
    let stimulus = random_stimulus(module, &mut rng, scans);
    let mut interpreter = Interpreter::new(verify(module).expect("a valid module"));
    let mut outputs = region_bytes(module, Region::Output);
    let mut rows = Vec::new();
    for (scan, row) in stimulus.iter().enumerate() {
        let now_ns = scan as u64 * period_ns;
        interpreter
            .step(now_ns, &row.inputs, &mut outputs)
            .expect("no fault");
        rows.push(outputs.clone());
    }
    (stimulus.into_iter().map(|row| row.inputs).collect(), rows)
}

/// Runs a module on the interpreter and what became of it in the simulator.
fn check_simulation(before: &Module, after: &Module, seed: u64, scans: usize, period_ns: u64) {
    let clock = Clock::period_ns(period_ns).unwrap();
    let (inputs, rows) = expected(before, seed, scans, period_ns);
    for narrow in [false, true] {
        let options = options(after, clock, narrow);
        let sim = VerilogSim::start(verify(after).unwrap(), &options, period_ns);
        let mut sim = sim.unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let found = sim.run(after, &inputs);
        for (scan, (expected, found)) in rows.iter().zip(&found).enumerate() {
            assert_eq!(
                expected,
                found,
                "seed {seed}, ranges {narrow}, scan {scan}\n{}",
                print_module(after)
            );
        }
    }
}

fn check_against_interpreter(module: &Module, seed: u64, scans: usize, period_ns: u64) {
    check_simulation(module, module, seed, scans, period_ns);
}

#[test]
fn whole_programs_run_in_hardware_as_on_the_interpreter() {
    let mut converted = 0;
    let seeds = seeds(24);
    let programs = seeds.end;
    for seed in seeds {
        let before = random_module(seed, &random_ir::Options::hardware());
        let period_ns = [1_000, 333_333, 10 * MS][seed as usize % 3];
        let settings = Settings {
            longest_period_ns: Some(period_ns),
        };
        let mut after = before.clone();
        run_pipeline(&mut after, HARDWARE, &settings, &mut |_, _| {}).unwrap();
        // Outputs that are stored on some ways only keep their branches: refused, not wrong.
        if after.funcs[after.scan].layout.len() > 1 {
            continue;
        }
        converted += 1;
        check_simulation(&before, &after, seed, 60, period_ns);
    }
    assert!(
        converted * 4 >= programs,
        "{converted} of {programs} programs became one block"
    );
}

#[test]
fn random_modules_run_as_on_the_interpreter() {
    for seed in seeds(60) {
        let module = one_block_module(seed, 60);
        let period_ns = [20, 1_000, 333_333, 10 * MS, 10_333_333][seed as usize % 5];
        check_against_interpreter(&module, seed, 150, period_ns);
    }
}

/// Writes what the target makes of a module into a folder.
fn build(module: &Module, options: &Options, folder: &Path) {
    let files = Verilog
        .compile(verify(module).unwrap(), options)
        .expect("a module hardware takes");
    for file in files {
        std::fs::write(folder.join(file.name), file.bytes).unwrap();
    }
}

/// Runs a program in a folder and gives everything it says. A missing program fails the test.
fn run(folder: &Path, program: &str, arguments: &[&str]) -> String {
    said(&tools::run(folder, program, arguments, Stdio::null()))
}

/// The design files of a module called `name`.
fn design_files(folder: &Path, name: &str) -> Vec<String> {
    let runtime = ["iecc_tick.v", "iecc_tick_fraction.v"];
    let runtime = runtime
        .into_iter()
        .filter(|file| folder.join(file).exists());
    std::iter::once(format!("{name}.v"))
        .chain(runtime.map(str::to_owned))
        .collect()
}

fn assert_lint_clean(folder: &Path, name: &str, context: &str) {
    let files = design_files(folder, name);
    let mut arguments = vec!["--lint-only", "-Wall"];
    arguments.extend(files.iter().map(String::as_str));
    let said = run(folder, "verilator", &arguments);
    assert!(said.is_empty(), "{context}: {said}");
}

fn assert_synthesis_clean(folder: &Path, name: &str) {
    let script = format!(
        "read_verilog {}; synth_ice40 -top {name}; check -assert",
        design_files(folder, name).join(" ")
    );
    let said = run(folder, "yosys", &["-p", &script]);
    let warnings: Vec<&str> = said.lines().filter(|l| l.starts_with("Warning")).collect();
    assert!(warnings.is_empty(), "{warnings:#?}");
    assert!(!said.contains("Latch inferred"), "latches");
}

#[test]
fn random_modules_are_accepted_without_a_warning() {
    let clocks = [
        Clock::hertz(50_000_000),
        Clock::new(100_000_000, 3),
        Clock::hertz(300),
        Clock::hertz(1_000),
    ];
    for seed in 100..116 {
        let module = one_block_module(seed, 40);
        let folder = tempfile::tempdir().unwrap();
        let clock = clocks[seed as usize % 4].unwrap();
        build(
            &module,
            &options(&module, clock, seed % 2 == 0),
            folder.path(),
        );
        assert_lint_clean(folder.path(), "random", &format!("seed {seed}"));
        if seed < 103 {
            assert_synthesis_clean(folder.path(), "random");
        }
    }
}

/// An on-delay timer of 30 ms, counted by the scan's own steps, and a count of its expirations.
const TIMER: &str = r#"module timer
struct TIMER { EN: i1, DN: i1, PRE: i32, ACC: i32 }
state { t: TIMER, n: i16, last: i1 }
input { Start: i1, Spare: i16 }
output { Done: i1, Count: i16, ACC: i32 }
init t.PRE = 30
origin @0 = "MainRoutine rung 0" 0:0..1
origin @1 = "MainRoutine rung 1" 0:0..1
scan @scan

fn @scan[]() -> () {
b0:
  v0: i1 = load input.Start @0
  v1: i32 = step 1ms @0
  v2: i32 = load state.t.ACC @0
  v3: i1 = load state.t.EN @0
  v4: i32 = const 0
  v5: i32 = select v3, v1, v4 @0
  v6: i32 = add v2, v5 @0
  v7: i32 = load state.t.PRE @0
  v8: i1 = sge v6, v7 @0
  v9: i32 = select v8, v7, v6 @0
  v10: i32 = select v0, v9, v4 @0
  v11: i1 = and v0, v8 @0
  store state.t.ACC, v10 @0
  store state.t.EN, v0 @0
  store state.t.DN, v11 @0
  v12: i16 = load state.n @1
  v13: i1 = load state.last @1
  v14: i1 = not v13 @1
  v15: i1 = and v14, v11 @1
  v16: i16 = zext v15 @1
  v17: i16 = add v12, v16 @1
  store state.n, v17 @1
  store state.last, v11 @1
  store output.Done, v11 @1
  store output.Count, v17 @1
  store output.ACC, v10 @1
  return
}
"#;

fn timer() -> Module {
    parse_module(TIMER).expect("the text above")
}

/// The bytes of the timer's inputs.
fn start(on: bool) -> Vec<u8> {
    vec![u8::from(on), 0, 0, 0]
}

#[test]
fn a_timer_runs_as_worked_out_by_hand() {
    let module = timer();
    let clock = Clock::period_ns(10 * MS).unwrap();
    let verified = verify(&module).unwrap();
    let options = options(&module, clock, true);
    let mut sim = VerilogSim::start(verified, &options, 10 * MS).unwrap_or_else(|e| panic!("{e}"));
    // Scans at 0, 10, 20 … ms. The scan that sees Start first only enables the timer; each later one
    // adds 10 ms; it is done at 30 ms and stays there until Start goes.
    let trace = [
        (false, 0, 0, 0),
        (true, 0, 0, 0),
        (true, 0, 0, 10),
        (true, 0, 0, 20),
        (true, 1, 1, 30),
        (true, 1, 1, 30),
        (false, 0, 1, 0),
        (true, 0, 1, 0),
        (true, 0, 1, 10),
    ];
    let mut outputs = region_bytes(&module, Region::Output);
    for (scan, (on, done, count, acc)) in trace.into_iter().enumerate() {
        let now_ns = scan as u64 * 10 * MS;
        sim.step(now_ns, &start(on), &mut outputs).unwrap();
        assert_eq!(outputs, [done, 0, count, 0, acc, 0, 0, 0], "scan {scan}");
    }
}

#[test]
fn registers_are_as_narrow_as_what_they_hold() {
    let module = timer();
    let clock = Clock::hertz(50_000_000).unwrap();
    let folder = tempfile::tempdir().unwrap();
    build(&module, &options(&module, clock, true), folder.path());
    let report = std::fs::read_to_string(folder.path().join("timer.report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let registers = report["registers"].as_array().unwrap();
    let acc = registers
        .iter()
        .find(|register| register["tag"] == "t.ACC")
        .unwrap();
    assert_eq!((&acc["bits"], &acc["highest"]), (&5.into(), &30.into()));
    assert_eq!(report["clocks_per_scan"], 1);
    assert_eq!(report["edges_input_to_output"], 3);
    assert_eq!(report["constants"][0]["tag"], "t.PRE");
    // Start takes two synchroniser bits, the unread Spare none.
    assert_eq!(report["synchroniser_bits"], 2);
    // 50,000 clocks are 16 bits, and the tick itself.
    assert_eq!(report["divider_bits"], 17);
}

#[test]
fn generated_hardware_is_clean_on_every_clock() {
    let module = timer();
    let hundred_thirds = Clock::new(100_000_000, 3).unwrap();
    for clock in [
        Clock::hertz(50_000_000).unwrap(),
        hundred_thirds,
        Clock::hertz(300).unwrap(),
        Clock::hertz(1_000).unwrap(),
    ] {
        let folder = tempfile::tempdir().unwrap();
        build(&module, &options(&module, clock, true), folder.path());
        assert_lint_clean(folder.path(), "timer", &clock.to_string());
        assert_synthesis_clean(folder.path(), "timer");
    }
}

/// A module that counts milliseconds in `a` and microseconds in `b`.
const CLOCKWORK: &str = r#"module clockwork
state { a: i64, b: i64 }
input { }
output { a: i64, b: i64 }
scan @scan

fn @scan[]() -> () {
b0:
  v0: i64 = step 1ms
  v1: i64 = load state.a
  v2: i64 = add v0, v1
  store state.a, v2
  store output.a, v2
  v3: i64 = step 1us
  v4: i64 = load state.b
  v5: i64 = add v3, v4
  store state.b, v5
  store output.b, v5
  return
}
"#;

#[test]
fn time_is_exact_at_every_period() {
    let module = parse_module(CLOCKWORK).unwrap();
    // 20 ns: two chained counters; 83 ns: fractions; 333,333 ns: whole microseconds and a rest;
    // 10 ms: whole steps of both.
    for (period_ns, scans) in [
        (20, 60_000),
        (83, 30_000),
        (1_000, 3_000),
        (333_333, 3_000),
        (10 * MS, 1_000),
    ] {
        let mut sim = VerilogSim::start(
            verify(&module).unwrap(),
            &Options::new(Clock::hertz(1).unwrap()),
            period_ns,
        )
        .unwrap();
        let rows = sim.run(&module, &vec![Vec::new(); scans]);
        for (scan, row) in rows.iter().enumerate() {
            let now_ns = scan as u64 * period_ns;
            let number =
                |range: std::ops::Range<usize>| u64::from_le_bytes(row[range].try_into().unwrap());
            let expected = (now_ns / MS, now_ns / 1_000);
            assert_eq!(
                (number(0..8), number(8..16)),
                expected,
                "{period_ns} ns, scan {scan}"
            );
        }
    }
}

#[test]
fn the_testbench_gives_each_scan_its_row_and_inputs_take_three_edges() {
    let module = parse_module(
        "module wire\nstate { }\ninput { a: i1, in: i8 }\noutput { b: i1, row: i8 }\nscan @scan\n\n\
         fn @scan[]() -> () {\nb0:\n  v0: i1 = load input.a\n  store output.b, v0\n  \
         v1: i8 = load input.in\n  store output.row, v1\n  return\n}\n",
    )
    .unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut options = Options::new(Clock::hertz(50_000_000).unwrap());
    options.stimulus = vec![vec![0, 0], vec![1, 5], vec![0, 0xff]];
    build(&module, &options, folder.path());
    let replay = |latency: &str| {
        let parameter = format!("-Pwire__tb.LATENCY={latency}");
        let files = [
            "-g2005",
            &parameter,
            "-s",
            "wire__tb",
            "-o",
            "tb",
            "wire_.v",
            "wire__tb.v",
        ];
        run(folder.path(), "iverilog", &files);
        run(folder.path(), "vvp", &["-n", "tb"])
    };
    assert_eq!(
        replay("3"),
        "row,a,in,b,row\n0,0,0,0,0\n1,1,5,1,5\n2,0,-1,0,-1\n"
    );
    // With two edges the row before is still to be seen.
    assert_eq!(
        replay("2"),
        "row,a,in,b,row\n0,0,0,0,0\n1,1,5,0,0\n2,0,-1,1,5\n"
    );
}

#[test]
fn a_module_of_no_inputs_or_outputs_is_still_a_module() {
    let text = "module empty\nstate { }\ninput { i: i8 }\noutput { o: i1 }\nscan @s\n\n\
                fn @s[]() -> () {\nb0:\n  return\n}\n";
    let module = parse_module(text).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let options = Options::new(Clock::hertz(50_000_000).unwrap());
    build(&module, &options, folder.path());
    assert_lint_clean(folder.path(), "empty", "empty");
    assert_synthesis_clean(folder.path(), "empty");
}

fn on_board(board: &Board) -> Options {
    let mut options = Options::new(board.clock());
    options.board = Some(board.clone());
    options
}

/// The timer with a count of one bit, so that its ports fit a board.
fn small_timer() -> Module {
    let text = TIMER
        .replace("Count: i16, ACC: i32", "Odd: i1")
        .replace(", Spare: i16", ", Spare: i1")
        .replace(
            "store output.Count, v17",
            "v18: i1 = trunc v17\n  store output.Odd, v18",
        )
        .replace("  store output.ACC, v10 @1\n", "");
    parse_module(&text).expect("the text above")
}

#[test]
fn the_hx8k_board_goes_through_the_open_tools() {
    let board = Board::named("hx8k").unwrap();
    let folder = tempfile::tempdir().unwrap();
    build(&small_timer(), &on_board(&board), folder.path());
    let pins = std::fs::read_to_string(folder.path().join("timer.pcf")).unwrap();
    for line in [
        "set_io CLK12 J3",
        "set_io -pullup yes pin_B16 B16",
        "set_io pin_LED0 B5",
    ] {
        assert!(pins.lines().any(|found| found == line), "{line} in\n{pins}");
    }
    run(folder.path(), "sh", &["build.sh"]);
    assert!(folder.path().join("timer.bin").metadata().unwrap().len() > 100_000);
    let files = [
        "--lint-only",
        "-Wall",
        "--top-module",
        "top",
        "top.v",
        "timer.v",
        "iecc_tick.v",
    ];
    assert_eq!(run(folder.path(), "verilator", &files), "");
}

#[test]
fn the_de2_115_board_is_a_quartus_project() {
    let wishes = "port start KEY1 # a key\nport Done LEDG3\n";
    let board = Board::named("de2-115").unwrap().with_pins(wishes).unwrap();
    let folder = tempfile::tempdir().unwrap();
    build(&small_timer(), &on_board(&board), folder.path());
    let settings = std::fs::read_to_string(folder.path().join("timer.qsf")).unwrap();
    for line in [
        "set_global_assignment -name DEVICE EP4CE115F29C7",
        "set_location_assignment PIN_Y2 -to CLOCK_50",
        "set_location_assignment PIN_M23 -to KEY0",
        "set_location_assignment PIN_M21 -to pin_KEY1",
        "set_instance_assignment -name IO_STANDARD \"2.5 V\" -to pin_KEY1",
        "set_location_assignment PIN_E24 -to pin_LEDG3",
        // Not wished, so the first that are free.
        "set_location_assignment PIN_AB28 -to pin_SW0",
        "set_location_assignment PIN_G19 -to pin_LEDR0",
    ] {
        assert!(
            settings.lines().any(|found| found == line),
            "{line} in\n{settings}"
        );
    }
    let timing = std::fs::read_to_string(folder.path().join("timer.sdc")).unwrap();
    let clock = "create_clock -name CLOCK_50 -period 20.000 [get_ports {CLOCK_50}]\n";
    assert!(timing.starts_with(clock));
    let top = std::fs::read_to_string(folder.path().join("top.v")).unwrap();
    assert!(
        top.contains(".Start(~pin_KEY1)"),
        "keys are low when pressed:\n{top}"
    );
    let files = [
        "--lint-only",
        "-Wall",
        "--top-module",
        "top",
        "top.v",
        "timer.v",
        "iecc_tick.v",
    ];
    assert_eq!(run(folder.path(), "verilator", &files), "");
}

#[test]
fn a_board_that_does_not_fit_is_refused() {
    let compile = |module: &Module, options: &Options| {
        let errors = Verilog
            .compile(verify(module).unwrap(), options)
            .unwrap_err();
        assert!(errors.iter().all(|error| error.refusal == Refusal::Option));
        errors
            .into_iter()
            .map(|error| error.message)
            .collect::<Vec<_>>()
    };
    let board = Board::named("hx8k").unwrap();
    let messages = compile(&timer(), &on_board(&board));
    assert_eq!(messages.len(), 2, "{messages:?}");
    assert!(messages[0].starts_with("board hx8k has 16 free input pins, but 17 bits"));
    assert!(messages[1].starts_with("board hx8k has 8 free output pins, but 49 bits"));
    let mut options = on_board(&board);
    options.clock = Clock::hertz(50_000_000).unwrap();
    let messages = compile(&small_timer(), &options);
    assert!(
        messages[0].starts_with("the clock of the board is 12 MHz"),
        "{messages:?}"
    );
    let wishes = "port Strat B16\nport Start C16\nport Spare C16";
    let board = board.with_pins(wishes).unwrap();
    assert_eq!(
        compile(&small_timer(), &on_board(&board)),
        [
            "the pin file assigns `Strat`, which is no port of the program",
            "pin C16 of port `Spare` is already taken"
        ]
    );
}

/// Names that are illegal, reserved, or equal once they are legal.
const NAMES: &str = r#"module m
state { "a.b": i1, a_b: i1, clk: i1 }
input { "Local:2:I.Data.3": i1, reg: i1, rst: i1 }
output { "a.b": i1, a_b: i1, A_B: i1, clk: i1 }
scan @s

fn @s[]() -> () {
b0:
  v0: i1 = load input."Local:2:I.Data.3"
  v1: i1 = load input.reg
  v2: i1 = load input.rst
  v3: i1 = load state."a.b"
  v4: i1 = load state.a_b
  v5: i1 = load state.clk
  store state."a.b", v0
  store state.a_b, v1
  store state.clk, v2
  store output."a.b", v3
  store output.a_b, v4
  store output.A_B, v5
  store output.clk, v0
  return
}
"#;

#[test]
fn unusual_names_stay_apart_in_hardware() {
    let module = parse_module(NAMES).unwrap();
    check_against_interpreter(&module, 1, 50, MS);
    let folder = tempfile::tempdir().unwrap();
    let clock = Clock::hertz(1_000).unwrap();
    build(&module, &Options::new(clock), folder.path());
    assert_lint_clean(folder.path(), "m", "names");
}

#[test]
fn what_hardware_cannot_do_is_refused_with_every_reason() {
    let text = "module m\nstate { n: i32, a: [4 x i32], r: f32, t: i64 }\ninput { i: i32 }\noutput { o: i32 }\n\
        origin @0 = \"rung 0\" 0:0..1\norigin @1 = \"rung 1\" 0:0..1\norigin @2 = \"rung 2\" 0:0..1\n\
        origin @3 = \"rung 3\" 0:0..1\norigin @4 = \"rung 4\" 0:0..1\norigin @5 = \"rung 5\" 0:0..1\nscan @s\n\n\
        fn @s[]() -> () {\nb0:\n  v0: i32 = load input.i @0\n  v1: i32 = load state.n @0\n  \
        v2: i32 = sdiv v0, v1 @0\n  v3: i32 = load state.a[v0] @1\n  v4: f32 = load state.r @2\n  \
        v5: i64 = now @3\n  v6: i32 = elapsed state.t, 1ms @3\n  jump b1\nb1:\n  \
        v7: i1 = eq v0, v1 @4\n  brif v7, b1, b2\nb2:\n  fault index @5\n}\n";
    let module = parse_module(text).unwrap();
    let options = Options::new(Clock::hertz(50_000_000).unwrap());
    let errors = Verilog
        .compile(verify(&module).unwrap(), &options)
        .unwrap_err();
    let found: Vec<(Refusal, String)> = errors
        .iter()
        .map(|error| {
            let label = error
                .origin
                .map(|origin| module.origins[origin].label.to_string());
            (error.refusal, label.unwrap_or_default())
        })
        .collect();
    let expected = [
        (Refusal::Loop, "rung 4"),
        (Refusal::Fault, "rung 5"),
        (Refusal::Division, "rung 0"),
        (Refusal::DynamicPlace, "rung 1"),
        (Refusal::Float, "rung 2"),
        (Refusal::AbsoluteTime, "rung 3"),
        (Refusal::AbsoluteTime, "rung 3"),
    ];
    let expected: Vec<_> = expected
        .map(|(refusal, label)| (refusal, label.to_owned()))
        .into();
    assert_eq!(found, expected);
}
