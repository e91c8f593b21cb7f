//! Whole runs of small programs, with traces worked out by hand.

use super::{
    CsvTrace, NoTrace, Request, RunError, Schedule, Session, Stimulus, Trace, TraceFile, VcdTrace,
};
use iecc_diag::{Code, Diagnostics};
use iecc_interp::Interpreter;
use iecc_ir::{Module, parse_module, verify};
use iecc_jit::Jit;
use iecc_passes::{SOFTWARE, Settings, run_pipeline};
use iecc_source::FileId;
use iecc_target::Engine;

/// A latch, a timer of 20 ms, and a counter of scans in which the lamp is on.
const LATCH: &str = "module latch
struct TIMER { DN: i1, PRE: i32, ACC: i32, last: i64 }
state { Start: i1, t: TIMER, lamps: i16, r: f32 }
input { Start: i1, Stop: i1 }
output { Lamp: i1 }
init t.PRE = 20
init r = 0.5
origin @0 = \"Main rung 2\"
scan @s
fn @s[]() -> () {
b0:
  v0: i1 = load input.Start
  store state.Start, v0
  v1: i32 = elapsed state.t.last, 1ms
  v2: i32 = load state.t.ACC
  v3: i32 = add v2, v1
  v4: i32 = const 0
  v5: i32 = select v0, v3, v4
  store state.t.ACC, v5
  v6: i32 = load state.t.PRE
  v7: i1 = sge v5, v6
  store state.t.DN, v7
  store output.Lamp, v7
  v8: i16 = zext v7
  v9: i16 = load state.lamps
  v10: i16 = add v9, v8
  store state.lamps, v10
  v11: i1 = load input.Stop
  brif v11, b1, b2
b1:
  fault index @0
b2:
  return
}
";

struct Prepared {
    module: Module,
    session: Session,
}

fn prepare(watches: &[&str], stimulus: &str) -> Prepared {
    prepare_module(LATCH, watches, stimulus)
}

fn prepare_module(module: &str, watches: &[&str], stimulus: &str) -> Prepared {
    let mut module = parse_module(module).unwrap();
    let mut diagnostics = Diagnostics::new();
    let stimulus = Stimulus::parse(FileId::from_index(0), stimulus, &mut diagnostics);
    let watches: Vec<String> = watches.iter().map(|&w| w.to_owned()).collect();
    let request = Request {
        watches: &watches,
        stimulus: stimulus.as_ref(),
    };
    let session = Session::prepare(&mut module, &request, &mut diagnostics);
    let session = session.unwrap_or_else(|| panic!("{diagnostics:?}"));
    Prepared { module, session }
}

/// The interpreter, machine code, and machine code after the passes.
fn engines(module: &Module) -> [Box<dyn Engine>; 3] {
    let verified = verify(module).unwrap();
    let mut passed = module.clone();
    run_pipeline(&mut passed, SOFTWARE, &Settings::default(), &mut |_, _| {}).unwrap();
    [
        Box::new(Interpreter::new(verified)),
        Box::new(Jit::new(verified).unwrap()),
        Box::new(Jit::new(verify(&passed).unwrap()).unwrap()),
    ]
}

fn csv(
    prepared: &Prepared,
    engine: &mut dyn Engine,
    schedule: Schedule,
    changes_only: bool,
) -> String {
    let mut text = Vec::new();
    let columns = prepared.session.columns();
    let mut trace = CsvTrace::new(&mut text, columns, schedule.unit(), changes_only).unwrap();
    prepared
        .session
        .run(engine, schedule, &mut trace, &mut |_| {})
        .unwrap();
    trace.finish().unwrap();
    String::from_utf8(text).unwrap()
}

fn ms(period_ms: u64, scans: u64) -> Schedule {
    Schedule::for_scans(period_ms * 1_000_000, scans).unwrap()
}

const STIMULUS: &str = "t_ms,Start,lamps\n0,1,\n25,,100\n31,0,\n";

#[test]
fn a_trace_holds_inputs_outputs_and_watches_after_each_scan() {
    let prepared = prepare(&["t", "lamps.0", "LAMPS", "r", "lamp", "t.acc"], STIMULUS);
    let expected = "\
t_ms,Start,Stop,Lamp,t.DN,t.PRE,t.ACC,lamps.0,lamps,r
0,1,0,0,0,20,0,0,0,0.5
10,1,0,0,0,20,10,0,0,0.5
20,1,0,1,1,20,20,1,1,0.5
30,1,0,1,1,20,30,1,101,0.5
40,0,0,0,0,20,0,1,101,0.5
50,0,0,0,0,20,0,1,101,0.5
";
    for mut engine in engines(&prepared.module) {
        assert_eq!(csv(&prepared, &mut *engine, ms(10, 6), false), expected);
    }
    let changes = expected.replace("50,0,0,0,0,20,0,1,101,0.5\n", "");
    for mut engine in engines(&prepared.module) {
        assert_eq!(csv(&prepared, &mut *engine, ms(10, 6), true), changes);
    }
}

/// Adds the input to a list of times and dates, and counts down from 0.
const VIEWS: &str = "module views
struct S { at: [2 x i64] as date_time }
state { s: S, n: i8 as unsigned, w: i16 as bits }
input { pause: i64 as time, day: i64 as date }
output { both: i64 as time, clock: i64 as time_of_day }
init w = 0x00ff
scan @s
fn @s[]() -> () {
b0:
  v0: i64 = load input.pause
  v1: i64 = add v0, v0
  store output.both, v1
  store output.clock, v0
  v2: i64 = load input.day
  v3: i64 = add v2, v0
  store state.s.at[1], v3
  v4: i8 = load state.n
  v5: i8 = const 1
  v6: i8 = sub v4, v5
  store state.n, v6
  return
}
";

#[test]
fn values_are_shown_and_read_by_their_views() {
    let stimulus = "t_ms,pause,day,w\n10,T#1h0.5s,D#2024-02-29,\n20,7,DATE#1970-01-02,16#F0\n";
    let prepared = prepare_module(VIEWS, &["s", "n", "n.7", "w"], stimulus);
    let expected = "\
t_ms,pause,day,both,clock,s.at[0],s.at[1],n,n.7,w
0,T#0s,D#1970-01-01,T#0s,TOD#00:00:00,DT#1970-01-01-00:00:00,DT#1970-01-01-00:00:00,255,1,16#FF
10,T#1h500ms,D#2024-02-29,T#2h1s,TOD#01:00:00.5,DT#1970-01-01-00:00:00,DT#2024-02-29-01:00:00.5,254,1,16#FF
20,T#7ns,D#1970-01-02,T#14ns,TOD#00:00:00.000000007,DT#1970-01-01-00:00:00,DT#1970-01-02-00:00:00.000000007,253,1,16#F0
";
    for mut engine in engines(&prepared.module) {
        assert_eq!(csv(&prepared, &mut *engine, ms(10, 3), false), expected);
    }
}

#[test]
fn times_are_in_the_unit_of_the_period() {
    let prepared = prepare(&[], "t_us,Start\n2500,1\n");
    let schedule = Schedule::for_scans(1_250_000, 3).unwrap();
    let [mut interpreter, ..] = engines(&prepared.module);
    let text = csv(&prepared, &mut *interpreter, schedule, false);
    assert_eq!(
        text,
        "t_us,Start,Stop,Lamp\n0,0,0,0\n1250,0,0,0\n2500,1,0,0\n"
    );
}

#[test]
fn a_value_change_dump_has_scopes_widths_and_changes() {
    let prepared = prepare(&["t.ACC", "t.DN", "lamps", "r"], STIMULUS);
    let expected = "\
$timescale 1 ms $end
$scope module latch $end
$var wire 1 ! Start $end
$var wire 1 \" Stop $end
$var wire 1 # Lamp $end
$var wire 16 $ lamps $end
$var real 32 % r $end
$scope module t $end
$var wire 32 & ACC $end
$var wire 1 ' DN $end
$upscope $end
$upscope $end
$enddefinitions $end
#0
1!
0\"
0#
b00000000000000000000000000000000 &
0'
b0000000000000000 $
r0.5 %
#10
b00000000000000000000000000001010 &
#20
1#
b00000000000000000000000000010100 &
1'
b0000000000000001 $
#30
";
    for mut engine in engines(&prepared.module) {
        let (mut text, schedule) = (Vec::new(), ms(10, 3));
        let columns = prepared.session.columns();
        let mut trace = VcdTrace::new(&mut text, "latch", columns, schedule).unwrap();
        prepared
            .session
            .run(&mut *engine, schedule, &mut trace, &mut |_| {})
            .unwrap();
        trace.finish().unwrap();
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }
}

#[test]
fn a_fault_ends_the_run_and_names_its_place() {
    let prepared = prepare(&[], "t_ms,Stop\n15,1\n");
    for mut engine in engines(&prepared.module) {
        let error = prepared
            .session
            .run(&mut *engine, ms(10, 9), &mut NoTrace, &mut |_| {});
        let error = error.unwrap_err();
        assert!(matches!(
            error,
            RunError::Fault {
                scan: 2,
                now_ns: 20_000_000,
                ..
            }
        ));
        let diagnostic = error.to_diagnostic(&prepared.module);
        assert_eq!(diagnostic.code, Code::E6014);
        assert_eq!(
            diagnostic.message,
            "scan 2 at 20 ms was abandoned in Main rung 2: array index or bit number outside its bounds"
        );
    }
}

#[test]
fn progress_ends_with_the_number_of_scans() {
    let prepared = prepare(&[], "t_ms\n");
    let [.., mut jit] = engines(&prepared.module);
    let mut told = Vec::new();
    prepared
        .session
        .run(&mut *jit, ms(1, 600), &mut NoTrace, &mut |done| {
            told.push(done);
        })
        .unwrap();
    assert_eq!(told.first(), Some(&0));
    assert_eq!(told.last(), Some(&600));
    assert!(told.is_sorted());
}

#[test]
#[allow(clippy::disallowed_methods, reason = "the test looks at the file")]
fn a_trace_file_appears_when_it_is_complete() {
    let folder = tempfile::tempdir().unwrap();
    let prepared = prepare(&[], "t_ms,Start\n0,1\n");
    for (name, begin) in [("a.csv", "t_ms,Start"), ("b.VCD", "$timescale 1 ms")] {
        let path = folder.path().join(name);
        let columns = prepared.session.columns();
        let mut trace = TraceFile::create(&path, "latch", columns, ms(10, 1), false).unwrap();
        trace.row(0, &[1, 0, 0]).unwrap();
        assert!(!path.exists());
        trace.finish().unwrap();
        assert!(std::fs::read_to_string(&path).unwrap().starts_with(begin));
    }
    let dropped = folder.path().join("c.csv");
    drop(TraceFile::create(&dropped, "latch", &[], ms(10, 1), false).unwrap());
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        2,
        "nothing half-written is left"
    );
}

#[test]
fn a_trace_without_a_place_or_format_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let create = |name: &str| {
        let path = folder.path().join(name);
        TraceFile::create(&path, "latch", &[], ms(10, 1), false)
            .err()
            .map(|d| d.code)
    };
    assert_eq!(create("missing/out.csv"), Some(Code::E6013));
    assert_eq!(create("out.txt"), Some(Code::E6015));
    assert_eq!(create("out"), Some(Code::E6015));
}

/// Each example of a mistake in a stimulus, named after the code it gives, against [`LATCH`].
#[test]
#[allow(clippy::disallowed_methods, reason = "the test reads the examples")]
fn every_example_of_a_bad_stimulus_gives_its_code() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/codes");
    let mut seen = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "csv") {
            continue;
        }
        let code = Code::parse(path.file_stem().unwrap().to_str().unwrap()).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let mut diagnostics = Diagnostics::new();
        if let Some(stimulus) = Stimulus::parse(FileId::from_index(0), &text, &mut diagnostics) {
            let mut module = parse_module(LATCH).unwrap();
            let request = Request {
                stimulus: Some(&stimulus),
                ..Request::default()
            };
            Session::prepare(&mut module, &request, &mut diagnostics);
        }
        let found: Vec<Code> = diagnostics.iter().map(|d| d.code).collect();
        assert_eq!(found, [code], "{}", path.display());
        seen.push(code);
    }
    seen.sort();
    let of_stimuli = |code: &&Code| (Code::E6003..=Code::E6012).contains(*code);
    let expected: Vec<Code> = Code::ALL.iter().filter(of_stimuli).copied().collect();
    assert_eq!(seen, expected);
}

/// `name` of the state is 'it$'s' and then 'i', with what was behind it still there.
const TEXTS: &str = "module texts
struct STRING5 { LEN: i16, DATA: [5 x i8] }
struct WSTRING2 { LEN: i16, DATA: [2 x i16] }
state { name: STRING5 }
input { n: i16 }
output { wide: WSTRING2 }
init name.DATA[0] = 105
init name.DATA[1] = 116
init name.DATA[2] = 39
init name.DATA[3] = 115
scan @s
fn @s[]() -> () {
b0:
  v0: i16 = load input.n
  v5: i16 = const 1
  v6: i16 = add v0, v5
  store state.name.LEN, v6
  v1: i16 = const 2
  store output.wide.LEN, v1
  v2: i16 = const 0x20AC
  store output.wide.DATA[0], v2
  v3: i16 = const 34
  store output.wide.DATA[1], v3
  v4: i8 = const 120
  store state.name.DATA[4], v4
  return
}
";

#[test]
fn strings_are_shown_as_literals() {
    let stimulus = "t_ms,n\n0,3\n20,0\n30,-2\n40,8\n";
    let prepared = prepare_module(TEXTS, &["name"], stimulus);
    let expected = "\
t_ms,n,wide,name
0,3,\"\"\"\u{20ac}$\"\"\"\"\",'it$'s'
20,0,\"\"\"\u{20ac}$\"\"\"\"\",'i'
30,-2,\"\"\"\u{20ac}$\"\"\"\"\",''
40,8,\"\"\"\u{20ac}$\"\"\"\"\",'it$'sx'
";
    for mut engine in engines(&prepared.module) {
        assert_eq!(csv(&prepared, &mut *engine, ms(10, 5), true), expected);
    }
}

/// A length that is watched without its characters is a number.
#[test]
fn parts_of_strings_are_numbers() {
    let prepared = prepare_module(TEXTS, &["name.LEN", "name.DATA[1]"], "t_ms,n\n0,2\n");
    for mut engine in engines(&prepared.module) {
        let text = csv(&prepared, &mut *engine, ms(10, 1), false);
        assert!(
            text.starts_with("t_ms,n,wide,name.LEN,name.DATA[1]\n"),
            "{text}"
        );
        assert!(text.ends_with(",3,116\n"), "{text}");
    }
}
