//! Machine code and interpreter agree on the ALD program over 20,000 scans of random stimulus: in
//! every input, output and tag. The stimulus is biased so that batches run, stop and finish, and the
//! test shows (and insists) that every output takes both values and cycles are counted.

use iecc_driver::FrontOptions;
use iecc_driver::run::Schedule;
use iecc_ir::Module;
use iecc_sema::logix::Init;
use iecc_tests::rng::Rng;
use iecc_tests::runs::{Rows, compiled, engines, opened, rows};
use iecc_tests::shared::shared_dir;
use std::fmt::Write;
use std::path::Path;

const SCANS: u64 = 20_000;
/// One cycle of the published program takes half a minute.
const PERIOD_MS: u64 = 250;

/// An input: how many scans it stays 1 and 0 at most, each time at random.
struct Habit {
    name: &'static str,
    longest: [usize; 2],
}

const fn habit(name: &'static str, ones: usize, zeros: usize) -> Habit {
    Habit {
        name,
        longest: [zeros, ones],
    }
}

/// Stop is normally closed; temperatures are mostly right; the chamber vents after each batch.
const HABITS: [Habit; 7] = [
    habit("Start", 10, 80),
    habit("Stop", 4000, 4),
    habit("TP1", 2000, 20),
    habit("TR", 2000, 20),
    habit("Pressure_Switch", 1500, 20),
    habit("Atmosphere", 10, 600),
    habit("Local:2:I.Data.8", 3000, 20),
];

/// A row for each scan in which an input changes.
fn stimulus(seed: u64) -> String {
    let (mut rng, mut values, mut left) = (Rng::new(seed), [0usize; 7], [0usize; 7]);
    let names: Vec<&str> = HABITS.iter().map(|habit| habit.name).collect();
    let mut text = format!("t_ms,{}\n", names.join(","));
    for scan in 0..SCANS {
        let mut cells = String::new();
        for (index, habit) in HABITS.iter().enumerate() {
            cells.push(',');
            if left[index] == 0 {
                values[index] = 1 - values[index];
                left[index] = 1 + rng.below(habit.longest[values[index]]);
                let _ = write!(cells, "{}", values[index]);
            }
            left[index] -= 1;
        }
        if cells.len() > HABITS.len() {
            let _ = writeln!(text, "{}{cells}", scan * PERIOD_MS);
        }
    }
    text
}

/// How often each output changed to 1 and the largest count of cycles; all must have happened.
fn coverage(module: &Module, rows: &Rows) -> String {
    let outputs = &module.types.structs[module.output].fields;
    let outputs: Vec<&str> = outputs.iter().map(|field| field.name.as_str()).collect();
    let mut text = String::new();
    for output in outputs {
        let changes = rows.select(&[output]).changes();
        let rises = changes
            .rows
            .windows(2)
            .filter(|pair| pair[1].1 == [1])
            .count();
        let falls = changes
            .rows
            .windows(2)
            .filter(|pair| pair[1].1 == [0])
            .count();
        let _ = write!(text, "{output} {rises} up {falls} down, ");
        assert!(rises > 0 && falls > 0, "{output} never changed: {text}");
    }
    let cycles = rows.select(&["cycles.ACC"]);
    let most = cycles.rows.iter().map(|(_, values)| values[0]).max();
    assert!(most >= Some(2), "at most {most:?} cycles were counted");
    let _ = write!(text, "up to {} cycles", most.unwrap_or(0));
    text
}

fn all_tags(module: &Module) -> Vec<&str> {
    let tags = &module.types.structs[module.state].fields;
    tags.iter().map(|field| field.name.as_str()).collect()
}

#[test]
fn engines_agree_on_twenty_thousand_random_scans() {
    let Some(shared) = shared_dir() else { return };
    let path = Path::new("corpus/l5x/ghanemja__senior-design/PLC/ALD_miami.L5X");
    let options = FrontOptions {
        init: Init::Cold,
        ..FrontOptions::default()
    };
    let plain = compiled(&shared.join(path), &options);
    let (module, session) = opened(plain.clone(), &stimulus(1), &all_tags(&plain));
    let schedule = Schedule::for_scans(PERIOD_MS * 1_000_000, SCANS).expect("a legal schedule");
    let mut engines = engines(&module, schedule.period_ns()).into_iter();
    let (_, mut reference) = engines.next().expect("the interpreter");
    let expected = rows(&session, &mut *reference, schedule);
    #[expect(clippy::print_stdout, reason = "the coverage is to be seen")]
    {
        println!("{}", coverage(&plain, &expected));
    }
    for (name, mut engine) in engines {
        let found = rows(&session, &mut *engine, schedule);
        for (found, expected) in found.rows.iter().zip(&expected.rows) {
            assert_eq!(found, expected, "{name}; columns {:?}", session.columns());
        }
        assert_eq!(found.rows.len(), expected.rows.len());
    }
}
