//! Generated and damaged Structured Text: trees that print to themselves, or messages; no panic,
//! and an answer in bounded time. The checks are those of the fuzz target.

use iecc_tests::check::{for_all_seeds, in_time};
use iecc_tests::mutate::mutate;
use iecc_tests::rng::seeds;
use iecc_tests::{check, st_text};

const SEEDS: u64 = 500;

#[test]
fn generated_texts_parse_and_print_to_themselves() {
    for_all_seeds(SEEDS, |rng| {
        let text = st_text::file(rng);
        assert!(check::st(&text), "{text}");
    });
}

#[test]
fn damaged_texts_give_messages_not_panics() {
    let accepted = std::cell::Cell::new(0);
    for_all_seeds(SEEDS, |rng| {
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
    for_all_seeds(SEEDS, |rng| {
        let text = mutate(&st_text::file(rng), rng);
        check::st(&text);
    });
}

/// Tokens in a random order reach the repair and the recovery in ways that people do not.
#[test]
fn shuffled_words_give_messages_not_panics() {
    let words: Vec<&str> = st_text::SAMPLE.split_whitespace().collect();
    for_all_seeds(SEEDS, |rng| {
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
    for (end, _) in sample.char_indices() {
        in_time(format_args!("the prefix of {end} bytes"), || {
            check::st(&sample[..end])
        });
    }
    assert!(check::st(sample));
}
