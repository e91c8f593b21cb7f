//! Programs in Structured Text, from the text to machine code: the interpreter on what the lowering
//! gives and machine code after the passes have to agree in every scan, and with values worked out
//! by hand or by other compilers.
#![expect(
    clippy::disallowed_methods,
    reason = "tests read files outside the project"
)]

use iecc_diag::Diagnostics;
use iecc_driver::{FrontOptions, Sources, compile};
use iecc_interp::Interpreter;
use iecc_ir::{FaultCode, Layout, MemType, Module, Place, Region, Root, Scalar, verify};
use iecc_jit::Jit;
use iecc_source::SourceMap;
use iecc_target::{Engine, region_bytes};
use iecc_tests::runs::{machine_code, messages};
use iecc_tests::shared::shared_dir;

fn module(text: &str) -> Module {
    let mut map = SourceMap::new();
    let file = map.add("test.st", text);
    let sources = Sources::text(&mut map, vec![file]);
    let mut diagnostics = Diagnostics::new();
    let module = compile(&map, &sources, &FrontOptions::default(), &mut diagnostics);
    module.unwrap_or_else(|| panic!("{}", messages(&map, &diagnostics)))
}

/// Both engines side by side.
struct Run {
    module: Module,
    interpreter: Interpreter,
    machine_code: Jit,
}

impl Run {
    fn new(text: &str) -> Self {
        let module = module(text);
        let interpreter = Interpreter::new(verify(&module).expect("sound"));
        Self {
            interpreter,
            machine_code: machine_code(module.clone()),
            module,
        }
    }

    fn scan(&mut self, now_ms: u64) -> Option<FaultCode> {
        let now_ns = now_ms * 1_000_000;
        let inputs = region_bytes(&self.module, Region::Input);
        let [mut first, mut second] = [(); 2].map(|()| region_bytes(&self.module, Region::Output));
        let expected = self.interpreter.step(now_ns, &inputs, &mut first);
        let found = self.machine_code.step(now_ns, &inputs, &mut second);
        let [expected, found] = [expected, found].map(|ended| ended.err().map(|f| f.code));
        assert_eq!(expected, found, "fault at {now_ms} ms");
        assert_eq!(first, second, "outputs at {now_ms} ms");
        let states = (self.interpreter.state(), self.machine_code.state());
        assert_eq!(states.0, states.1, "state at {now_ms} ms");
        expected
    }

    /// A variable of the only program, as a signed number.
    fn number(&self, name: &str) -> i64 {
        number(&self.module, self.interpreter.state(), name)
    }
}

/// The number behind a name that the module knows, or the one member of the state with that name.
fn number(module: &Module, state: &[u8], name: &str) -> i64 {
    let layout = Layout::new(&module.types);
    let known = module
        .names
        .iter()
        .find(|(known, _)| known.eq_ignore_ascii_case(name));
    let place = known.map_or_else(|| by_name(module, name), |(_, place)| place.clone());
    let start = MemType::Struct(module.state);
    let (offset, ty, _) = layout.resolve(&module.types, start, &place.path);
    let MemType::Scalar(ty) = ty else {
        panic!("{name} is not one value")
    };
    Scalar::read(state, offset as usize, ty).signed()
}

fn by_name(module: &Module, name: &str) -> Place {
    let fields = &module.types.structs[module.state].fields;
    let suffix = format!(".{name}");
    let is = |field: &str| field.eq_ignore_ascii_case(name) || field.ends_with(&suffix);
    let mut found = fields
        .iter()
        .enumerate()
        .filter(|(_, field)| is(&field.name));
    if let Some((index, _)) = found.next() {
        return Place::root(Root::State).field(index as u32);
    }
    let inner = fields.iter().enumerate().find_map(|(index, field)| {
        let MemType::Struct(id) = field.ty else {
            return None;
        };
        let names = module.types.structs[id].fields.iter();
        let member = names
            .enumerate()
            .find(|(_, member)| member.name.eq_ignore_ascii_case(name));
        Some((index, member?.0))
    });
    let (index, member) = inner.unwrap_or_else(|| panic!("no variable {name}"));
    Place::root(Root::State)
        .field(index as u32)
        .field(member as u32)
}

fn program(variables: &str, body: &str) -> String {
    format!("PROGRAM Main\nVAR\n{variables}\nEND_VAR\n{body}\nEND_PROGRAM\n")
}

/// What variables hold after one scan.
fn check(variables: &str, body: &str, expected: &[(&str, i64)]) {
    let mut run = Run::new(&program(variables, body));
    assert_eq!(run.scan(0), None);
    for &(name, value) in expected {
        assert_eq!(run.number(name), value, "{name}");
    }
}

#[test]
fn loops_end_at_the_last_number_of_a_type() {
    check(
        "b : USINT; n : INT; i : LINT; m : INT; s : SINT; k : INT; top : SINT := 127;",
        "FOR b := 0 TO 255 DO n := n + 1; END_FOR;
         FOR i := 9223372036854775806 TO 9223372036854775807 DO m := m + 1; END_FOR;
         FOR s := 120 TO top BY 2 DO k := k + 1; END_FOR;",
        &[
            ("b", 0),
            ("n", 256),
            ("i", i64::MIN),
            ("m", 2),
            ("s", -128),
            ("k", 4),
        ],
    );
}

#[test]
fn loops_nest_and_leave() {
    // Pairs (i, j) with j <= i and i*j < 10 but i < 6: i=1:1, 2:2, 3:3, 4:2 (4, 8), 5:1 (5).
    check(
        "i, j, n : DINT;",
        "FOR i := 1 TO 100 DO
           IF i = 6 THEN EXIT; END_IF;
           FOR j := 1 TO i DO
             IF i * j >= 10 THEN CONTINUE; END_IF;
             n := n + 1;
           END_FOR;
         END_FOR;",
        &[("n", 9), ("i", 6), ("j", 6)],
    );
}

#[test]
fn subscripts_are_tested() {
    let text = program(
        "a : ARRAY [-2..2] OF INT; i : LINT := -2; x : INT;",
        "a[i] := 5; x := a[-2]; i := i + 1;",
    );
    let mut run = Run::new(&text);
    for at in 0..5 {
        assert_eq!(run.scan(at), None);
    }
    assert_eq!((run.number("x"), run.number("i")), (5, 3));
    assert_eq!(run.scan(5), Some(FaultCode::Index));
    assert_eq!(run.number("i"), 3);
}

#[test]
fn functions_and_blocks_keep_what_they_should() {
    let text = "
        FUNCTION Sum : DINT
        VAR_INPUT n : DINT; END_VAR
        VAR i : DINT; part : ARRAY [1..10] OF DINT; END_VAR
          FOR i := 1 TO n DO part[i] := part[i] + i; Sum := Sum + part[i]; END_FOR;
        END_FUNCTION
        FUNCTION_BLOCK Total
        VAR_INPUT amount : DINT; END_VAR
        VAR_OUTPUT sum : DINT; END_VAR
        VAR_TEMP t : DINT; END_VAR
          t := t + amount; sum := sum + t;
        END_FUNCTION_BLOCK
        PROGRAM Main
        VAR one, two : Total; x, y : DINT; k : DINT; END_VAR
          x := 0;
          FOR k := 1 TO 3 DO x := x + Sum(n := 4); END_FOR;
          one(amount := 2); two(amount := 5, sum => y);
        END_PROGRAM";
    let mut run = Run::new(text);
    for at in 1..=3 {
        assert_eq!(run.scan(at as u64), None);
        assert_eq!((run.number("x"), run.number("y")), (30, 5 * at));
    }
}

#[test]
fn tasks_have_their_intervals() {
    let text = "
        PROGRAM Fast VAR quick : DINT; END_VAR quick := quick + 1; END_PROGRAM
        PROGRAM Slow VAR lazy : DINT; END_VAR lazy := lazy + 1; END_PROGRAM
        CONFIGURATION c
          RESOURCE r ON cpu
            TASK Second(INTERVAL := T#30ms, PRIORITY := 2);
            TASK First(INTERVAL := T#10ms, PRIORITY := 1);
            PROGRAM s WITH Second : Slow;
            PROGRAM f WITH First : Fast;
          END_RESOURCE
        END_CONFIGURATION";
    let mut run = Run::new(text);
    for (at, quick, lazy) in [(10, 1, 1), (20, 2, 1), (30, 3, 1), (40, 4, 2), (50, 5, 2)] {
        assert_eq!(run.scan(at), None);
        let found = (run.number("quick"), run.number("lazy"));
        assert_eq!(found, (quick, lazy), "at {at} ms");
    }
    // Releases at 60 and 70: one of the first task is missed, the second is in time.
    assert_eq!(run.scan(75), None);
    assert_eq!((run.number("quick"), run.number("lazy")), (6, 3));
    let overruns = ["First.overruns", "Second.overruns"].map(|name| run.number(name));
    assert_eq!(overruns, [1, 0]);
}

/// Checksums that other compilers and hand-written C gave for the benchmark programs, the first scan
/// at 10 ms.
#[test]
fn benchmark_programs_give_the_checksums_of_others() {
    let Some(shared) = shared_dir() else {
        return;
    };
    for (name, scans, checksum) in [
        ("bool_logic", 1000, 667_741),
        ("timers", 1000, 152_603),
        ("int_math", 1000, -185_856),
        ("real_math", 1000, 889_100),
        ("fb_calls", 1000, 456_069),
        ("large_10k", 50, -761_930),
    ] {
        let path = shared.join(format!("bench/{name}.st"));
        let text = std::fs::read_to_string(path).expect("the benchmark programs");
        let module = module(&text);
        let mut engine = machine_code(module.clone());
        let mut outputs = region_bytes(&module, Region::Output);
        for scan in 1..=scans {
            let ended = engine.step(scan * 10_000_000, &[], &mut outputs);
            assert!(ended.is_ok(), "{name}: {ended:?} in scan {scan}");
        }
        assert_eq!(number(&module, engine.state(), "chk"), checksum, "{name}");
    }
}
