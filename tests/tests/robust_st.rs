//! Generated and damaged Structured Text: trees that print to themselves, or messages; no panic,
//! and an answer in bounded time. The checks are those of the fuzz target.
#![expect(clippy::disallowed_methods, reason = "the bound on time needs a clock")]

use iecc_tests::mutate::mutate;
use iecc_tests::random_ir::seeds;
use iecc_tests::rng::Rng;
use iecc_tests::{check, st_text};
use std::time::{Duration, Instant};

const SEEDS: u64 = 500;

/// Far above what the inputs here need on any machine, far below what a hang needs.
const LONGEST: Duration = Duration::from_secs(5);

fn for_all_seeds(test: impl Fn(&mut Rng)) {
    for seed in seeds(SEEDS) {
        let start = Instant::now();
        test(&mut Rng::new(seed));
        let elapsed = start.elapsed();
        assert!(elapsed < LONGEST, "seed {seed} took {elapsed:?}");
    }
}

#[test]
fn generated_texts_parse_and_print_to_themselves() {
    for_all_seeds(|rng| {
        let text = st_text::file(rng);
        assert!(check::st(&text), "{text}");
    });
}

#[test]
fn damaged_texts_give_messages_not_panics() {
    let accepted = std::cell::Cell::new(0);
    for_all_seeds(|rng| {
        let text = mutate(st_text::SAMPLE, rng);
        accepted.set(accepted.get() + u64::from(check::st(&text)));
    });
    let accepted = accepted.get();
    assert!(
        (1..seeds(SEEDS).end).contains(&accepted),
        "both outcomes occur: {accepted}"
    );
}

#[test]
fn damaged_generated_texts_give_messages_not_panics() {
    for_all_seeds(|rng| {
        let text = mutate(&st_text::file(rng), rng);
        check::st(&text);
    });
}

/// Tokens in a random order reach the repair and the recovery in ways that people do not.
#[test]
fn shuffled_words_give_messages_not_panics() {
    let words: Vec<&str> = st_text::SAMPLE.split_whitespace().collect();
    for_all_seeds(|rng| {
        let mut text = String::from("FUNCTION_BLOCK f ");
        for _ in 0..rng.below(80) {
            text.push_str(rng.pick(&words));
            text.push_str(rng.pick(&[" ", "\n"]));
        }
        check::st(&text);
    });
}

#[test]
fn every_prefix_of_the_sample_is_read() {
    let sample = st_text::SAMPLE;
    let start = Instant::now();
    for (end, _) in sample.char_indices() {
        check::st(&sample[..end]);
    }
    assert!(check::st(sample));
    assert!(start.elapsed() < 20 * LONGEST);
}
