//! Damaged projects through the whole front half: no panic, a message where there is no module, and an
//! answer in bounded time. Every module that comes out keeps the rules of the IR.
#![expect(clippy::disallowed_methods, reason = "tests read files")]

use iecc_driver::FrontOptions;
use iecc_ir::verify;
use iecc_tests::check::in_time;
use iecc_tests::ladder::compile_xml;
use iecc_tests::mutate::{mutate, mutate_values};
use iecc_tests::rng::{Rng, seeds};
use std::path::Path;

const SEEDS: u64 = 400;

/// The examples of codes and the ALD example: between them every construct the analysis knows.
fn projects() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = vec![root.join("../examples/ald/ald.L5X")];
    for entry in std::fs::read_dir(root.join("codes")).expect("the examples") {
        let path = entry.expect("readable").path();
        // The largest program that is refused for its size takes its time in any case.
        let large = path.ends_with("E2007.L5X");
        if path.extension().is_some_and(|end| end == "L5X") && !large {
            paths.push(path);
        }
    }
    paths.sort();
    let texts = paths.iter().map(std::fs::read);
    texts
        .filter_map(|text| String::from_utf8(text.expect("readable")).ok())
        .collect()
}

fn survives(xml: &str, seed: u64) {
    let compile = || compile_xml(xml, &FrontOptions::default());
    let (module, codes) = in_time(format_args!("seed {seed}"), compile);
    match module {
        Ok(module) => assert_eq!(verify(&module).err(), None, "seed {seed}"),
        Err(_) => assert!(!codes.is_empty(), "seed {seed} says nothing"),
    }
}

#[test]
fn damaged_projects_give_messages_not_panics() {
    let projects = projects();
    for seed in seeds(SEEDS) {
        let mut rng = Rng::new(seed);
        let text = &projects[rng.below(projects.len())];
        survives(&mutate(text, &mut rng), seed);
        survives(&mutate_values(text, &mut rng), seed);
    }
}

/// Swaps words of rung texts and attributes for others of the same project: still well-formed, mostly
/// meaningless.
#[test]
fn shuffled_words_give_messages_not_panics() {
    let projects = projects();
    for seed in seeds(SEEDS) {
        let mut rng = Rng::new(seed);
        let text = &projects[rng.below(projects.len())];
        survives(&shuffle_words(text, &mut rng), seed);
    }
}

fn shuffle_words(text: &str, rng: &mut Rng) -> String {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words: Vec<&str> = text
        .split(|c| !is_word(c))
        .filter(|w| !w.is_empty())
        .collect();
    let values: Vec<&str> = rung_words(text, &words);
    let mut shuffled = text.to_owned();
    for _ in 0..=rng.below(6) {
        let (from, to) = (rng.pick(&values), rng.pick(&values));
        if let Some(at) = shuffled.rfind(from) {
            shuffled.replace_range(at..at + from.len(), to);
        }
    }
    shuffled
}

/// Words that stand in rung texts or between quotes, so that the XML stays well-formed.
fn rung_words<'t>(text: &'t str, words: &[&'t str]) -> Vec<&'t str> {
    let inside = |word: &&&str| {
        ["(", ",", "\"", "[CDATA["]
            .iter()
            .any(|before| text.contains(&format!("{before}{word}")))
    };
    words.iter().filter(inside).copied().collect()
}
