//! The ALD example does on every engine what its description says: its outputs are those of
//! `expected.csv`, which a model of the process gives.
#![expect(clippy::disallowed_methods, reason = "tests read files")]

use iecc_driver::FrontOptions;
use iecc_driver::run::{Schedule, parse_duration};
use iecc_tests::runs::{compiled, engines, opened, rows};
use std::path::Path;

#[test]
fn the_outputs_are_those_of_the_model_of_the_process() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/ald");
    let read =
        |name: &str| std::fs::read_to_string(folder.join(name)).expect("the example is there");
    let (stimulus, expected) = (read("stimulus.csv"), read("expected.csv"));
    let mut lines = expected.lines();
    let outputs: Vec<&str> = lines.next().expect("a header").split(',').skip(1).collect();
    let expected: Vec<Vec<i64>> = lines
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        })
        .collect();
    let (module, session) = opened(
        compiled(&folder.join("ald.L5X"), &FrontOptions::default()),
        &stimulus,
        &[],
    );
    // As the README of the example runs it.
    let length_ns = parse_duration("2101ms").expect("a duration");
    let schedule = Schedule::for_duration(1_000_000, length_ns).expect("a legal schedule");
    for (name, mut engine) in engines(&module) {
        let found = rows(&session, &mut *engine, schedule)
            .select(&outputs)
            .changes();
        let found = found.rows.into_iter().map(|(now_ns, mut values)| {
            values.insert(0, (now_ns / 1_000_000) as i64);
            values
        });
        assert_eq!(found.collect::<Vec<_>>(), expected, "{name}");
    }
}
