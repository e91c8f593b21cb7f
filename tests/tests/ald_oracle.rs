//! The published ALD program does exactly what an independent simulation of its rungs did: every
//! change of 27 bits and counters over a whole batch, for both initialisations, on every engine.

use iecc_driver::FrontOptions;
use iecc_driver::run::Schedule;
use iecc_sema::logix::Init;
use iecc_tests::runs::{Rows, compiled, engines, opened, rows};
use iecc_tests::shared::shared_dir;
use std::fmt::Write;

const PERIOD_NS: u64 = 10_000_000;
/// Beyond the last change in either trace.
const SCANS: u64 = 30_000;

/// The stimulus that the oracle's description gives.
const STIMULUS: &str = "\
t_ms,Stop,TP1,Local:2:I.Data.8,Atmosphere,Start,Pressure_Switch,TR
0,1,1,1,0,0,0,0
1000,,,,,1,1,
1500,,,,,0,,
2000,,,,,,,1
";

/// One line for each scan in which a column changed, in the oracle's form.
fn in_oracle_form(header: &str, rows: &Rows) -> String {
    let mut text = format!("{header}\n");
    let mut before: Vec<Option<i64>> = vec![None; rows.columns.len()];
    for (now_ns, values) in &rows.rows {
        let mut line = String::new();
        for ((column, &value), before) in rows.columns.iter().zip(values).zip(&mut before) {
            if before.replace(value) != Some(value) {
                let _ = write!(line, " {column}={value}");
            }
        }
        if !line.is_empty() {
            let _ = writeln!(text, "{}{line}", now_ns / 1_000_000);
        }
    }
    text
}

fn agrees_with(file: &str, init: Init) {
    let Some(shared) = shared_dir() else { return };
    #[expect(clippy::disallowed_methods, reason = "tests read files")]
    let expected =
        std::fs::read_to_string(shared.join("oracle/ald").join(file)).expect("the oracle's trace");
    let header = expected.lines().next().expect("a header");
    let columns: Vec<&str> = header.split(',').skip(1).collect();
    let path = shared.join("corpus/l5x/ghanemja__senior-design/PLC/ALD_miami.L5X");
    let options = FrontOptions {
        init,
        ..FrontOptions::default()
    };
    let (module, session) = opened(compiled(&path, &options), STIMULUS, &columns);
    let schedule = Schedule::for_scans(PERIOD_NS, SCANS).expect("a legal schedule");
    for (name, mut engine) in engines(&module, PERIOD_NS) {
        let found = rows(&session, &mut *engine, schedule).select(&columns);
        let found = in_oracle_form(header, &found);
        for (number, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
            assert_eq!(found, expected, "{name}, line {}", number + 1);
        }
        assert_eq!(found.lines().count(), expected.lines().count(), "{name}");
    }
}

#[test]
fn a_cold_start_runs_a_batch_of_nine_cycles() {
    agrees_with("trace-cold.txt", Init::Cold);
}

#[test]
fn exported_values_keep_the_machine_from_sealing_in() {
    agrees_with("trace-export.txt", Init::Export);
}
