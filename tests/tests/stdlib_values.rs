//! What the functions of the standard library compute, against values that were worked out
//! independently: see the comments at the head of the tables in `tests/stdlib`. On the reference
//! interpreter, before and after the passes, and in machine code; the result must be the same to the
//! last bit.

use iecc_tests::st_run::{Scan, run};
use std::fmt::Write;

/// Scans with these inputs.
fn scans(inputs: impl Iterator<Item = Vec<u64>>) -> Vec<Scan> {
    let scan = |(index, inputs)| Scan {
        now_ns: index * 1_000_000,
        inputs,
    };
    (0_u64..).zip(inputs).map(scan).collect()
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
    let inputs = |row: &Vec<&str>| {
        let kind = kinds.iter().position(|kind| *kind == (row[0], row[1]));
        let kind = kind.expect("taken from the table") as u64;
        vec![kind, pattern(row[2]), pattern(row[3])]
    };
    let scans = scans(table.iter().map(inputs));
    let text = functions_program(&kinds);
    run(
        &text,
        &["k", "x", "y"],
        &["r"],
        &scans,
        |engine, index, values| {
            let row = &table[index];
            let (given, expected) = (values[0][0], pattern(row[4]));
            assert_eq!(given, expected, "{engine} {row:?}: {given:X}");
        },
    );
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
    let mut seen: Vec<String> = TYPES.iter().map(|(ty, _)| format!("r_{ty}")).collect();
    seen.extend(["r_STRING".to_owned(), "ok".to_owned()]);
    let seen: Vec<&str> = seen.iter().map(String::as_str).collect();
    let scans = scans((0..table.len() as u64).map(|k| vec![k]));
    let text = calls_program(&table);
    run(&text, &["k"], &seen, &scans, |engine, index, values| {
        let row = &table[index];
        let column = seen.iter().position(|name| name[2..] == *row[2]);
        let expected = expected(row[2], row[3]);
        let given = &values[column.expect("a column for each type")][..expected.len()];
        assert_eq!(given, expected, "{engine} {row:?}");
        let ok = values[seen.len() - 1][0] == 1;
        assert_eq!(ok, row[4] == "TRUE", "ENO on {engine} {row:?}");
    });
}
