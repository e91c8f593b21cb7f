//! Object files do what the interpreter does, called from C and from Python: same outputs, tags and
//! faults, scan for scan.
#![expect(
    clippy::disallowed_methods,
    reason = "tests write files and run programs"
)]

use iecc_driver::{Cpu, FrontOptions, build_object, write_artifacts};
use iecc_ir::{Layout, MemType, Module, Region, parse_module, verify};
use iecc_jit::{Object, ObjectOptions};
use iecc_target::{Artifact, Engine, Target, region_bytes};
use iecc_tests::differential::{Subject, interpreter};
use iecc_tests::examples::example;
use iecc_tests::random_ir::{Options, random_module};
use iecc_tests::rng::{Rng, seeds};
use iecc_tests::runs::compiled;
use iecc_tests::stimulus::{ScanInput, random_stimulus};
use iecc_tests::tools::printed;
use std::fs::{self, File};
use std::path::Path;
use std::process::Stdio;

/// C that is executed for every scan it reads: time and inputs in; fault, outputs and tags out.
const HARNESS: &str = r#"
#include "NAME.h"
#include <stdio.h>
static NAME_state state;
static NAME_inputs inputs;
static NAME_outputs outputs;
static void put(const void *bytes, size_t size) {
    if (size > 0) fwrite(bytes, size, 1, stdout);
}
int main(void) {
    uint64_t now_ns;
    size_t size = NAME_inputs_size();
    if (sizeof state != NAME_state_size()) return 3;
    NAME_init(&state);
    while (fread(&now_ns, sizeof now_ns, 1, stdin) == 1) {
        if (size > 0 && fread(&inputs, size, 1, stdin) != 1) return 2;
        uint32_t fault = (uint32_t)NAME_scan(&state, &inputs, &outputs, now_ns);
        put(&fault, sizeof fault);
        put(&outputs, NAME_outputs_size());
        put((const char *)&state + offsetof(NAME_state, fault_origin) + 4, TAGS);
    }
    return 0;
}
"#;

const WARNINGS: [&str; 5] = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-O1"];

fn cc(folder: &Path, arguments: &[&str]) {
    let arguments = [&WARNINGS[..], arguments].concat();
    printed(folder, "cc", &arguments, Stdio::null());
}

fn objects(module: &Module) -> Vec<Artifact> {
    let verified = verify(module).unwrap_or_else(|errors| panic!("{}", errors[0]));
    let files = Object.compile(verified, &ObjectOptions::default());
    files.unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// The name all identifiers of the files begin with.
fn name_of(files: &[Artifact]) -> String {
    files[0]
        .name
        .strip_suffix(".o")
        .expect("an object")
        .to_owned()
}

fn state_len(module: &Module) -> usize {
    let layout = Layout::new(&module.types);
    layout.size(&module.types, MemType::Struct(module.state)) as usize
}

/// Runs the harness around the files of a module.
fn run_harness(module: &Module, files: &[Artifact], stimulus: &[ScanInput]) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let (name, folder) = (name_of(files), folder.path());
    write_artifacts(folder, files).expect("written");
    let harness = HARNESS
        .replace("NAME", &name)
        .replace("TAGS", &state_len(module).to_string());
    fs::write(folder.join("harness.c"), harness).expect("written");
    let object = format!("{name}.o");
    // Nothing but what starts a C program: the object needs no mathematics.
    cc(folder, &["-std=c11", "-o", "harness", "harness.c", &object]);
    let scans = stimulus.iter().map(|scan| {
        let mut bytes = scan.now_ns.to_le_bytes().to_vec();
        bytes.extend(&scan.inputs);
        bytes
    });
    fs::write(folder.join("scans"), scans.collect::<Vec<_>>().concat()).expect("written");
    let scans = File::open(folder.join("scans")).expect("just written");
    printed(folder, "./harness", &[], scans.into())
}

/// Compares with the interpreter on the module as given.
fn check(module: &Module, files: &[Artifact], stimulus: &[ScanInput], what: &str) {
    let found = run_harness(module, files, stimulus);
    let mut reference = interpreter(module);
    let mut outputs = region_bytes(module, Region::Output);
    let record = 4 + outputs.len() + state_len(module);
    assert_eq!(found.len(), record * stimulus.len(), "{what}");
    for (scan, (ScanInput { now_ns, inputs }, found)) in
        stimulus.iter().zip(found.chunks(record)).enumerate()
    {
        let result = reference.step(*now_ns, inputs, &mut outputs);
        let fault = result.map_or_else(|fault| u32::from(fault.code.number()), |()| 0);
        let expected = [&fault.to_le_bytes()[..], &outputs, reference.state_bytes()].concat();
        assert!(
            expected == found,
            "{what}, scan {scan}: expected {expected:02x?}, found {found:02x?}"
        );
    }
}

#[test]
fn the_ald_reactor_in_c_does_what_the_interpreter_does() {
    let module = compiled(&example("ald/ald.L5X"), &FrontOptions::default());
    let stimulus = random_stimulus(&module, &mut Rng::new(1), 3000);
    for cpu in [Cpu::Generic, Cpu::Native] {
        let files = build_object(module.clone(), cpu).expect("no refusal");
        check(&module, &files, &stimulus, &format!("{cpu:?}"));
    }
}

/// A C program that is built with the files of a module and says something.
fn c_program(files: &[Artifact], text: &str, compiler: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_artifacts(folder, files).expect("written");
    let (source, object) = ("program.c", files[0].name.as_str());
    fs::write(folder.join(source), text).expect("written");
    let output = ["-o", "program", source, "-xnone", object];
    let arguments = [&WARNINGS[..], &compiler[1..], &output].concat();
    printed(folder, compiler[0], &arguments, Stdio::null());
    String::from_utf8(printed(folder, "./program", &[], Stdio::null())).expect("UTF-8")
}

/// Counts, and divides the count by an input.
const DIVIDES: &str = r#"module Small
state { n: i32, wide: [40 x i64], q: i32 }
input { d: i32 }
output { q: i32 }
origin @0 = "Main/Main rung 0" 0:0..1
origin @1 = "Main/Main rung 1" 0:0..1
scan @s

fn @s[]() -> () {
b0:
  v0: i32 = load state.n @0
  v1: i32 = const 1 @0
  v2: i32 = add v0, v1 @0
  store state.n, v2 @0
  store output.q, v2 @0
  v3: i64 = sext v2
  v4: i32 = const 39
  store state.wide[v4], v3
  v5: i32 = load input.d @1
  v6: i32 = const 0 @1
  v7: i1 = eq v5, v6 @1
  brif v7, b1, b2
b1:
  fault divide @1
b2:
  v8: i32 = sdiv v2, v5 @1
  store state.q, v8 @1
  store output.q, v8 @1
  return
}
"#;

/// The second and third scan divide by 0: what came before in the scan is undone.
#[test]
fn a_fault_tells_what_and_where_and_changes_nothing() {
    let files = objects(&parse_module(DIVIDES).expect("the text above"));
    let name = name_of(&files);
    let text = r#"
#include "NAME.h"
#include <stdio.h>
static NAME_state state;
static NAME_outputs outputs;
static void scan(int32_t divisor, uint64_t now_ns) {
    NAME_inputs inputs = {divisor};
    int fault = NAME_scan(&state, &inputs, &outputs, now_ns);
    printf("%d %s [%s] n=%d wide=%d q=%d,%d last=%d\n", fault, NAME_fault_text(fault), NAME_fault_place(&state),
           state.tags.n, (int)state.tags.wide[39], state.tags.q, outputs.q, (int)state.last_ns);
}
int main(void) {
    NAME_init(&state);
    scan(1, 10);
    scan(0, 20);
    scan(0, 30);
    scan(-1, 40);
    printf("%s, %s\n", NAME_fault_text(-1), NAME_fault_text(99));
    return NAME_FAULT_DIVIDE - 2;
}
"#;
    let said = c_program(&files, &text.replace("NAME", &name), &["cc", "-std=c11"]);
    let lines: Vec<&str> = said.lines().collect();
    let fault = "2 division by zero [Main/Main rung 1] n=1 wide=1 q=1,1 last=10";
    let expected = [
        "0 no fault [] n=1 wide=1 q=1,1 last=10",
        fault,
        fault,
        "0 no fault [Main/Main rung 1] n=2 wide=2 q=-2,-2 last=40",
        "unknown fault, unknown fault",
    ];
    assert_eq!(lines, expected);
}

/// Names that are illegal, reserved, or equal once they are legal; structs and arrays in regions.
const NAMES: &str = r#"module "int*/ main"
struct POINT { x: f32, at: f64, "x!": i8 }
struct inputs { "a.b": i1, a_b: i1, padding: i64, "*/ #error": i8, grid: [2 x [3 x POINT]] }
struct EMPTY { }
state { "class": inputs, nothing: EMPTY, none: [3 x EMPTY], points: [2 x inputs], "@": i16, last: i1 }
input { "Local:2:I.Data.3": i1, new: i16 as unsigned, template: POINT, t: i64 as time }
output { "a.b": i8, a_b: i8, a_b_2: i8, wide: i64 }
scan @s

fn @s[]() -> () {
b0:
  v0: i8 = const 7
  store output.a_b, v0
  v1: f32 = load input.template.x
  store state.points[1].grid[1][2].x, v1
  return
}
"#;

#[test]
fn unusual_names_stay_apart_in_c_and_in_cpp() {
    let module = parse_module(NAMES).expect("the text above");
    let files = objects(&module);
    assert_eq!(name_of(&files), "int_main");
    let header = String::from_utf8(files[1].bytes.clone()).expect("UTF-8");
    for line in [
        "    bool Local_2_I_Data_3; /* Local:2:I.Data.3 */\n",
        "    uint16_t new_; /* new */\n",
        "    int64_t t; /* nanoseconds */\n",
        "    int_main_POINT grid[2][3];\n",
    ] {
        assert!(header.contains(line), "{line} in\n{header}");
    }
    let text = r#"
#include "int_main.h"
#include "int_main.h"
#include <stdio.h>
static int_main_state s;
static int_main_inputs in;
static int_main_outputs out;
int main(void) {
    int_main_init(&s);
    in.Local_2_I_Data_3 = true;
    in.new_ = 1;
    in.template_.x = 2.5f;
    if (int_main_scan(&s, &in, &out, 0) != 0) return 1;
    s.tags.class_.a_b_2 = 3;
    s.tags.class_.padding = 4;
    printf("%d %d %d %g\n", out.a_b, out.a_b_2, out.a_b_2_2, (double)s.tags.points[1].grid[1][2].x);
    return 0;
}
"#;
    for compiler in [["cc", "-std=c11"], ["c++", "-std=c++11"]] {
        let language = if compiler[0] == "cc" { "-xc" } else { "-xc++" };
        let said = c_program(&files, text, &[compiler[0], compiler[1], language]);
        // `a.b` comes first and is `a_b`; `a_b` is `a_b_2`, and so on.
        assert_eq!(said, "0 7 0 2.5\n", "{compiler:?}");
    }
}

#[test]
fn a_program_of_nothing_is_an_object_too() {
    let text = "module empty\nstate { }\ninput { }\noutput { }\nscan @s\n\nfn @s[]() -> () {\nb0:\n  return\n}\n";
    let module = parse_module(text).expect("the text above");
    let stimulus = random_stimulus(&module, &mut Rng::new(1), 3);
    check(&module, &objects(&module), &stimulus, "empty");
}

/// No file depends on the computer, unless asked to, and none needs more than what moves memory.
#[test]
fn the_same_program_gives_the_same_object_which_needs_no_other() {
    let module = compiled(&example("ald/ald.L5X"), &FrontOptions::default());
    let build = || build_object(module.clone(), Cpu::Generic).expect("no refusal");
    assert_eq!(build(), build());
    for seed in seeds(20) {
        let files = objects(&random_module(seed, &Options::all()));
        let folder = tempfile::tempdir().expect("a folder");
        write_artifacts(folder.path(), &files).expect("written");
        let undefined = printed(folder.path(), "nm", &["-u", &files[0].name], Stdio::null());
        let undefined = String::from_utf8(undefined).expect("UTF-8");
        let names = undefined
            .lines()
            .map(|line| line.trim_start_matches([' ', 'U']));
        let others: Vec<&str> = names
            .filter(|n| !["memmove", "memset"].contains(n))
            .collect();
        assert!(others.is_empty(), "seed {seed}: {others:?}");
    }
}

/// Every float becomes every integer, signed and unsigned.
fn conversions() -> Module {
    let (mut fields, mut body, mut stores) = (Vec::new(), String::new(), String::new());
    for (source, from) in ["f32", "f64"].iter().enumerate() {
        for to in ["i8", "i16", "i32", "i64"] {
            for op in ["float_to_sint", "float_to_uint"] {
                let (name, value) = (format!("{from}_{to}_{op}"), 2 + fields.len());
                body += &format!("  v{value}: {to} = {op} v{source}\n");
                stores += &format!("  store output.{name}, v{value}\n");
                fields.push(format!("{name}: {to}"));
            }
        }
    }
    let fields = fields.join(", ");
    let text = format!(
        "module rounding\nstate {{ }}\ninput {{ f32: f32, f64: f64 }}\noutput {{ {fields} }}\nscan @s\n\n\
         fn @s[]() -> () {{\nb0:\n  v0: f32 = load input.f32\n  v1: f64 = load input.f64\n\
         {body}{stores}  return\n}}\n"
    );
    parse_module(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Processors without an instruction for it must not need a library either.
#[test]
fn floats_are_rounded_alike_on_every_processor() {
    let numbers = [
        0.0,
        -0.0,
        0.4999999999999999,
        0.5,
        1.5,
        2.5,
        -0.5,
        -1.5,
        -2.5,
        126.5,
        127.5,
        255.5,
        -128.5,
        32767.5,
        65534.5,
        8388607.5,
        8388608.0,
        8388609.0,
        2147483646.5,
        2147483647.5,
        -2147483648.5,
        4294967295.5,
        4503599627370495.5,
        4503599627370496.0,
        -4503599627370497.0,
        9.3e18,
        -9.3e18,
        1.9e19,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MIN_POSITIVE,
    ];
    let scan = |number: f64| ScanInput {
        now_ns: 0,
        inputs: [
            &(number as f32).to_le_bytes()[..],
            &[0; 4],
            &number.to_le_bytes(),
        ]
        .concat(),
    };
    let (module, stimulus) = (conversions(), numbers.map(scan));
    for cpu in [Cpu::Generic, Cpu::Native] {
        let options = ObjectOptions { cpu };
        let files = Object.compile(verify(&module).expect("the rules"), &options);
        check(
            &module,
            &files.expect("no refusal"),
            &stimulus,
            &format!("{cpu:?}"),
        );
    }
}

fn build_ald(folder: &Path) {
    let module = compiled(&example("ald/ald.L5X"), &FrontOptions::default());
    let files = build_object(module, Cpu::Generic).expect("no refusal");
    write_artifacts(folder, &files).expect("written");
}

#[test]
fn the_python_example_prints_the_expected_trace() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    build_ald(folder);
    cc(
        folder,
        &["-shared", "-o", "libALD_Reactor.so", "ALD_Reactor.o"],
    );
    let [script, stimulus] = ["ctypes/ald.py", "ald/stimulus.csv"].map(|path| {
        let path = fs::canonicalize(example(path)).expect("it is there");
        path.to_str().expect("UTF-8").to_owned()
    });
    let arguments = [&script, "./libALD_Reactor.so", &stimulus];
    let trace = printed(folder, "python3", &arguments, Stdio::null());
    let expected = fs::read(example("ald/expected.csv")).expect("it is there");
    assert_eq!(String::from_utf8(trace), String::from_utf8(expected));
}

/// A cycle takes 168 ms (see examples/ald/README.md), three make a batch.
#[test]
fn the_c_example_makes_one_batch() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    build_ald(folder);
    let source = fs::canonicalize(example("ctypes/ald.c")).expect("it is there");
    let source = source.to_str().expect("UTF-8");
    cc(
        folder,
        &["-std=c11", "-I.", "-o", "ald", source, "ALD_Reactor.o"],
    );
    let said = String::from_utf8(printed(folder, "./ald", &[], Stdio::null())).expect("UTF-8");
    assert!(said.ends_with("\nbatches: 1\n"), "{said}");
    let cells = said.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let openings = cells.filter(|cells| cells.get(1) == Some(&"1"));
    let times: Vec<u32> = openings
        .map(|cells| cells[0].parse().expect("a time"))
        .collect();
    assert_eq!(times.len(), 3, "{said}");
    assert!(
        times.windows(2).all(|pair| pair[1] - pair[0] == 168),
        "{said}"
    );
}

/// How many scans of a stimulus fault on the interpreter.
fn faults(module: &Module, stimulus: &[ScanInput]) -> usize {
    let mut reference = interpreter(module);
    let mut outputs = region_bytes(module, Region::Output);
    let mut step = |scan: &ScanInput| reference.step(scan.now_ns, &scan.inputs, &mut outputs);
    stimulus.iter().filter(|scan| step(scan).is_err()).count()
}

/// Some programs, and those of many that fault now and then.
#[test]
fn random_programs_in_c_do_what_the_interpreter_does_also_when_they_fault() {
    const FAULTY: usize = 8;
    let mut faulty = 0;
    for seed in 0..5000 {
        if faulty == FAULTY {
            break;
        }
        let module = random_module(seed, &Options::all());
        let stimulus = random_stimulus(&module, &mut Rng::new(seed), 60);
        let now_and_then = (1..stimulus.len()).contains(&faults(&module, &stimulus));
        faulty += usize::from(now_and_then);
        if now_and_then || seed < 10 {
            check(
                &module,
                &objects(&module),
                &stimulus,
                &format!("seed {seed}"),
            );
        }
    }
    assert_eq!(faulty, FAULTY);
}
