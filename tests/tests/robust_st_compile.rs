//! Damaged cases of the conformance suite through the whole compiler: no panic, an error where there
//! is no module, and an answer in bounded time. Every module that comes out keeps the rules of the IR.
//! The check is that of the fuzz target `st_program`.

use iecc_conformance::Case;
use iecc_driver::{FrontOptions, ParsedLibrary, parallel_map};
use iecc_tests::cases::suite;
use iecc_tests::check::{in_time, st_program};
use iecc_tests::damage::damage;
use iecc_tests::mutate::mutate;
use iecc_tests::rng::{Rng, seeds};

const SEEDS: u64 = 500;

/// Compiles a text made of two cases for every seed; says how many are accepted.
fn for_all_seeds(make: impl Fn(&Case, &Case, &mut Rng) -> String + Sync) -> usize {
    let (library, cases) = (ParsedLibrary::parse(), suite());
    let seeds: Vec<u64> = seeds(SEEDS).collect();
    let accepted = parallel_map(&seeds, |&seed| {
        let rng = &mut Rng::new(seed);
        let [one, other] = [(); 2].map(|()| &cases[rng.below(cases.len())]);
        let text = make(one, other, rng);
        let options = FrontOptions {
            dialect: one.dialect,
            ..FrontOptions::default()
        };
        let input = format_args!("seed {seed}:\n{text}\n");
        in_time(input, || st_program(&library, &text, &options))
    });
    accepted.into_iter().filter(|accepted| *accepted).count()
}

#[test]
fn damaged_words_give_messages_not_panics() {
    let accepted = for_all_seeds(|one, other, rng| damage(&one.text, &other.text, rng));
    assert!(accepted > 0, "some damage is harmless");
}

#[test]
fn damaged_bytes_give_messages_not_panics() {
    for_all_seeds(|one, _, rng| mutate(&one.text, rng));
}

/// Units of two cases in one program, some of them damaged: names meet that were not meant to.
#[test]
fn two_cases_in_one_give_messages_not_panics() {
    for_all_seeds(|one, other, rng| {
        let text = format!("{}\n{}", one.text, other.text);
        if rng.one_in(2) {
            text
        } else {
            damage(&text, &one.text, rng)
        }
    });
}
