//! Every example is a clean program, and what its files say of one another is true.
#![expect(
    clippy::disallowed_methods,
    reason = "tests read files and run programs"
)]

use iecc_diag::Diagnostics;
use iecc_driver::run::{Schedule, Stimulus};
use iecc_driver::{
    EngineKind, FrontOptions, Init, Replay, Sources, TimerBase, VerilogRequest, build_verilog,
    compile, load, write_artifacts,
};
use iecc_ir::Module;
use iecc_source::SourceMap;
use iecc_tests::examples::{example, example_text};
use iecc_tests::runs::trace_of_changes;
use iecc_tests::tools::printed;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

const ENGINES: [EngineKind; 3] = [EngineKind::Interp, EngineKind::Jit, EngineKind::Verilog];

/// The module of a program that gives no message at all.
fn module_of(path: &str, options: &FrontOptions) -> Module {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let paths = [example(path)];
    let sources = Sources::load(&mut map, &paths, &options.levels, &mut diagnostics);
    let sources = sources.expect("the example is there");
    let module = compile(&map, &sources, options, &mut diagnostics);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    module.expect("no errors")
}

/// The changes of a run with the stimulus of the ALD example, as a CSV.
fn ald_trace(engine: EngineKind, options: &FrontOptions, schedule: Schedule) -> String {
    let module = module_of("ald/ald.L5X", options);
    trace_of_changes(module, &example_text("ald/stimulus.csv"), engine, schedule)
}

fn until(period_ns: u64, length_ms: u64) -> Schedule {
    Schedule::for_duration(period_ns, length_ms * 1_000_000).expect("in range")
}

#[test]
fn the_ald_trace_is_the_expected_one_on_every_engine() {
    for init in [Init::Cold, Init::Export] {
        let options = FrontOptions {
            init,
            ..FrontOptions::default()
        };
        for engine in ENGINES {
            let trace = ald_trace(engine, &options, until(1_000_000, 2101));
            assert_eq!(
                trace,
                example_text("ald/expected.csv"),
                "{engine:?} {init:?}"
            );
        }
    }
}

/// The ALD example as hardware for a clock of 1 ms, with a testbench for its stimulus.
fn build_ald(folder: &Path) {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let mut load = |path| load(&mut map, &example(path), &mut diagnostics).expect("it is there");
    let (file, csv) = (load("ald/ald.L5X"), load("ald/stimulus.csv"));
    let sources = Sources::logix(&mut map, file);
    let options = FrontOptions::default();
    let module = compile(&map, &sources, &options, &mut diagnostics);
    let stimulus = Stimulus::parse(csv, map.file(csv).text(), &mut diagnostics);
    let request = VerilogRequest {
        clock_hz: Some(1_000),
        replay: Some(Replay {
            stimulus: stimulus.expect("no errors"),
            scans: 2101,
        }),
        ..VerilogRequest::default()
    };
    let files = build_verilog(module.expect("no errors"), &request, &map).expect("no refusal");
    write_artifacts(folder, &files).expect("written");
}

/// The testbench works through the synchronisers of the real inputs, and still scan for scan: its
/// rows number the scans, which are the milliseconds.
#[test]
fn the_testbench_of_the_ald_gives_the_expected_trace() {
    let folder = tempfile::tempdir().expect("a folder");
    build_ald(folder.path());
    let name = "ALD_Reactor";
    let [bench, design] = [format!("{name}_tb.v"), format!("{name}.v")];
    let files = ["-g2005", "-o", "tb", &bench, &design, "iecc_tick.v"];
    let needed = if folder.path().join("iecc_tick.v").exists() {
        &files[..]
    } else {
        &files[..5]
    };
    printed(folder.path(), "iverilog", needed, Stdio::null());
    let rows = printed(folder.path(), "vvp", &["-n", "tb"], Stdio::null());
    let rows = String::from_utf8(rows).expect("UTF-8");
    let mut changes = String::new();
    let mut before = "";
    for line in rows.lines() {
        let (scan, values) = line.split_once(',').expect("columns");
        if values != before {
            changes += &format!("{},{values}\n", scan.replace("row", "t_ms"));
        }
        before = values;
    }
    assert_eq!(rows.lines().count(), 2102);
    assert_eq!(changes, example_text("ald/expected.csv"));
}

/// The recipe's times are constants of the program, which it moves to the presets.
#[test]
fn the_report_of_the_ald_tells_its_constants_and_the_verilog_its_rungs() {
    let folder = tempfile::tempdir().expect("a folder");
    build_ald(folder.path());
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("written");
    let report = read("ALD_Reactor.report.txt");
    for constant in [
        "tpp1 = 20",
        "tvent1.PRE = 60",
        "tventw.PRE = 65",
        "twait1.PRE = 1",
    ] {
        let line = format!("  {constant}");
        assert!(
            report.lines().any(|found| found == line),
            "{constant}\n{report}"
        );
    }
    assert!(!report.contains(".last"), "{report}");
    let rung = "    // -- MainProgram/Supervise rung 1\n    //    XIC(StartPulse)RES(cycles);\n";
    assert!(read("ALD_Reactor.v").contains(rung));
}

/// The experiment of the paper: the two waits of 1 ms get a base of 1 us, and a cycle of deposition
/// is 2 ms shorter. Measured from one opening of the precursor valve to the next, in scans of 100 us.
///
/// The first cycle takes its 167 ms and the one scan in which step 1 waits for its rung. With the
/// fine waits the steps behind them begin a scan or two after a full millisecond; since timers of
/// 1 ms count full milliseconds, they end at full ones, and the waits vanish.
#[test]
fn waits_with_a_base_of_one_microsecond_make_the_cycle_two_milliseconds_shorter() {
    let timers = ["twait1", "twaitw"].map(|timer| (timer.to_owned(), 1000));
    let fine = FrontOptions {
        timer_base: TimerBase {
            timers: timers.to_vec(),
            ..TimerBase::default()
        },
        ..FrontOptions::default()
    };
    for engine in ENGINES {
        let cycle_us = |options: &FrontOptions| {
            let trace = ald_trace(engine, options, until(100_000, 700));
            let openings = openings_us(&trace, "SV1");
            openings[1] - openings[0]
        };
        assert_eq!(cycle_us(&FrontOptions::default()), 167_100, "{engine:?}");
        assert_eq!(cycle_us(&fine), 165_100, "{engine:?}");
    }
}

/// The times at which a signal of a trace becomes 1.
fn openings_us(trace: &str, signal: &str) -> Vec<u64> {
    let (head, rows) = trace.split_once('\n').expect("a header");
    let column = head.split(',').position(|name| name == signal);
    let column = column.expect("the signal is in the trace");
    let (mut openings, mut before) = (Vec::new(), "1");
    for row in rows.lines() {
        let now = row.split(',').nth(column).expect("a cell");
        if (before, now) == ("0", "1") {
            let time = row.split(',').next().expect("a time");
            openings.push(time.parse().expect("a number"));
        }
        before = now;
    }
    openings
}

/// The expected trace is what the model of the process gives, so nobody can mend one by hand and
/// leave the other.
#[test]
fn the_expected_trace_of_the_ald_comes_from_its_model() {
    let output = Command::new("python3")
        .arg(example("ald/expected.py"))
        .arg("--check")
        .output()
        .expect("python3 runs; scripts/test installs it");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
}
