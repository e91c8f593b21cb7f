//! Damaged exports and damaged or generated rungs: no panic, messages when there is no result,
//! and an answer in bounded time. The checks are those of the fuzz targets.

use iecc_tests::check::for_all_seeds;
use iecc_tests::mutate::{SAMPLE, mutate, mutate_values};
use iecc_tests::{check, rung_text};

const SEEDS: u64 = 200;

#[test]
fn damaged_exports_give_messages_not_panics() {
    for_all_seeds(SEEDS, |rng| check::l5x(&mutate(SAMPLE, rng)));
}

#[test]
fn damaged_values_give_messages_not_panics() {
    for_all_seeds(SEEDS, |rng| check::l5x(&mutate_values(SAMPLE, rng)));
}

#[test]
fn generated_rungs_parse_and_print_to_themselves() {
    for_all_seeds(SEEDS, |rng| {
        let text = rung_text::rung(rng);
        assert!(check::rung(&text), "{text}");
    });
}

#[test]
fn damaged_rungs_give_one_message_each() {
    let accepted = std::cell::Cell::new(0);
    for_all_seeds(SEEDS, |rng| {
        let text = mutate(&rung_text::rung(rng), rng);
        accepted.set(accepted.get() + u64::from(check::rung(&text)));
    });
    assert!(
        (1..SEEDS).contains(&accepted.get()),
        "both outcomes occur: {}",
        accepted.get()
    );
}
