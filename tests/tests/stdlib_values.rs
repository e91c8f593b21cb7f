//! What the functions of the standard library compute, against values that were worked out
//! independently: see the comments at the head of the tables in `tests/stdlib`. On the reference
//! interpreter, before and after the passes, and in machine code; the result must be the same to the
//! last bit.

use iecc_diag::Diagnostics;
use iecc_driver::run::Probes;
use iecc_driver::{EngineKind, FrontOptions, Sources, compile};
use iecc_ir::{Module, Region};
use iecc_source::SourceMap;
use iecc_target::region_bytes;
use std::collections::BTreeMap;
use std::fmt::Write;

const ENGINES: [EngineKind; 3] = [
    EngineKind::Interp,
    EngineKind::InterpSoftware,
    EngineKind::Jit,
];

const PERIOD_NS: u64 = 10_000_000;

fn module(text: &str) -> Module {
    let (mut map, mut found) = (SourceMap::new(), Diagnostics::new());
    let file = map.add("values.st".to_owned(), text);
    let sources = Sources::text(&mut map, vec![file]);
    let module = compile(&map, &sources, &FrontOptions::default(), &mut found);
    let messages: Vec<_> = found.iter().take(5).collect();
    module.unwrap_or_else(|| panic!("{messages:?}"))
}

/// What the places hold after each scan, for the inputs of each scan.
fn run(
    engine: EngineKind,
    module: &Module,
    probes: &Probes,
    scans: &[Vec<u64>],
) -> Vec<Vec<Vec<u64>>> {
    let mut running = engine
        .start(module, PERIOD_NS)
        .unwrap_or_else(|errors| panic!("{}: {errors:?}", engine.name()));
    let mut inputs = region_bytes(module, Region::Input);
    let mut outputs = region_bytes(module, Region::Output);
    let mut seen = Vec::with_capacity(scans.len());
    for (index, scan) in scans.iter().enumerate() {
        probes.start_scan(&mut inputs);
        for (probe, bits) in probes.set.iter().zip(scan) {
            probe.set(&mut inputs, &[*bits]);
        }
        let now_ns = index as u64 * PERIOD_NS;
        let result = running.step(now_ns, &inputs, &mut outputs);
        assert_eq!(result, Ok(()), "{}: row {index}", engine.name());
        let values = probes.seen.iter().map(|probe| probe.get(&inputs, &outputs));
        seen.push(values.collect());
    }
    seen
}

/// The rows of a table: its lines without comments, cut at a separator.
fn rows(table: &'static str, separator: char) -> Vec<Vec<&'static str>> {
    let lines = table.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(separator).collect()).collect()
}

fn pattern(hexadecimal: &str) -> u64 {
    if hexadecimal.is_empty() {
        return 0;
    }
    u64::from_str_radix(hexadecimal, 16).expect("bits as hexadecimal digits")
}

/// A program that computes the function with the number `k`.
fn functions_program(kinds: &[(&str, &str)]) -> String {
    let mut text = String::from(
        "PROGRAM Main\nVAR_INPUT k : INT; x, y : LWORD; END_VAR\nVAR_OUTPUT r : LWORD; END_VAR\n\
         CASE k OF\n",
    );
    for (index, (function, ty)) in kinds.iter().enumerate() {
        let argument = |name: &str| match *ty {
            "REAL" => format!("DWORD_TO_REAL(LWORD_TO_DWORD({name}))"),
            _ => format!("LWORD_TO_LREAL({name})"),
        };
        let second = match *function {
            "EXPT" | "ATAN2" => format!(", {}", argument("y")),
            _ => String::new(),
        };
        let call = format!("{function}({}{second})", argument("x"));
        let bits = match *ty {
            "REAL" => format!("DWORD_TO_LWORD(REAL_TO_DWORD({call}))"),
            _ => format!("LREAL_TO_LWORD({call})"),
        };
        writeln!(text, "{index}: r := {bits};").expect("text takes everything");
    }
    text + "END_CASE;\nEND_PROGRAM\n"
}

#[test]
fn mathematical_functions_give_the_nearest_number() {
    let table = rows(include_str!("../stdlib/functions.csv"), ',');
    let table = &table[1..];
    assert!(table.len() > 800, "{} rows", table.len());
    let mut kinds: Vec<(&str, &str)> = table.iter().map(|row| (row[0], row[1])).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut module = module(&functions_program(&kinds));
    let names = |list: &[&str]| {
        list.iter()
            .map(|name| (*name).to_owned())
            .collect::<Vec<_>>()
    };
    let probes = Probes::open(&mut module, &names(&["k", "x", "y"]), &names(&["r"]));
    let probes = probes.expect("the variables are there");
    let scan = |row: &Vec<&str>| {
        let kind = kinds.iter().position(|kind| *kind == (row[0], row[1]));
        let kind = kind.expect("taken from the table") as u64;
        vec![kind, pattern(row[2]), pattern(row[3])]
    };
    let scans: Vec<Vec<u64>> = table.iter().map(scan).collect();
    for engine in ENGINES {
        let seen = run(engine, &module, &probes, &scans);
        for (row, values) in table.iter().zip(&seen) {
            let (given, expected) = (values[0][0], pattern(row[4]));
            assert_eq!(
                given,
                expected,
                "{} {row:?}: {given:X} instead of {expected:X}",
                engine.name()
            );
        }
    }
}

/// The types of arguments and results, with their bits; strings apart.
const TYPES: [(&str, u32); 23] = [
    ("BOOL", 1),
    ("SINT", 8),
    ("INT", 16),
    ("DINT", 32),
    ("LINT", 64),
    ("USINT", 8),
    ("UINT", 16),
    ("UDINT", 32),
    ("ULINT", 64),
    ("BYTE", 8),
    ("WORD", 16),
    ("DWORD", 32),
    ("LWORD", 64),
    ("REAL", 32),
    ("LREAL", 64),
    ("TIME", 64),
    ("LTIME", 64),
    ("DATE", 64),
    ("LDATE", 64),
    ("TOD", 64),
    ("LTOD", 64),
    ("DT", 64),
    ("LDT", 64),
];

/// A program that makes the call with the number `k`.
fn calls_program(table: &[Vec<&str>]) -> String {
    let mut text =
        String::from("PROGRAM Main\nVAR_INPUT k : INT; END_VAR\nVAR_OUTPUT ok : BOOL;\n");
    let mut locals = String::from("VAR\na_STRING, b_STRING : STRING[200];\n");
    for (ty, _) in TYPES {
        writeln!(text, "r_{ty} : {ty};").expect("text takes everything");
        let names: Vec<String> = ('a'..='g').map(|name| format!("{name}_{ty}")).collect();
        writeln!(locals, "{} : {ty};", names.join(", ")).expect("text takes everything");
    }
    text += "r_STRING : STRING[200];\nEND_VAR\n";
    text += &locals;
    text += "END_VAR\nCASE k OF\n";
    for (index, row) in table.iter().enumerate() {
        let (before, call, ty) = (row[0], row[1], row[2]);
        writeln!(text, "{index}: {before} r_{ty} := {call};").expect("text takes everything");
    }
    text + "END_CASE;\nEND_PROGRAM\n"
}

/// The bits of a result as the table writes it: length and characters of a string.
fn expected(ty: &str, written: &str) -> Vec<u64> {
    if ty == "STRING" {
        let text = written.trim_matches('\'');
        let length = [text.len() as u64].into_iter();
        return length.chain(text.bytes().map(u64::from)).collect();
    }
    let bits = TYPES
        .iter()
        .find(|(name, _)| *name == ty)
        .expect("a type")
        .1;
    let value = match written.strip_prefix("16#") {
        Some(digits) => i128::from(pattern(digits)),
        None => written.parse().expect("a number"),
    };
    vec![value as u64 & (u64::MAX >> (64 - bits))]
}

#[test]
fn calls_give_the_results_of_the_table() {
    let table = rows(include_str!("../stdlib/calls.tsv"), '\t');
    assert!(table.len() > 1000, "{} rows", table.len());
    let mut module = module(&calls_program(&table));
    let mut seen_names: Vec<String> = TYPES.iter().map(|(ty, _)| format!("r_{ty}")).collect();
    seen_names.extend(["r_STRING".to_owned(), "ok".to_owned()]);
    let probes = Probes::open(&mut module, &["k".to_owned()], &seen_names);
    let probes = probes.expect("the variables are there");
    let columns: BTreeMap<&str, usize> = (0..)
        .zip(&seen_names)
        .map(|(index, name)| (name.as_str(), index))
        .collect();
    let scans: Vec<Vec<u64>> = (0..table.len() as u64).map(|k| vec![k]).collect();
    for engine in ENGINES {
        let seen = run(engine, &module, &probes, &scans);
        for (row, values) in table.iter().zip(&seen) {
            let expected = expected(row[2], row[3]);
            let column = columns[format!("r_{}", row[2]).as_str()];
            let given = &values[column][..expected.len()];
            assert_eq!(given, expected, "{} {row:?}", engine.name());
            let ok = values[columns["ok"]][0] == 1;
            assert_eq!(ok, row[4] == "TRUE", "ENO on {} {row:?}", engine.name());
        }
    }
}
