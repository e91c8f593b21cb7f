//! Damaged cases of the conformance suite through the whole check: no panic, a message where there
//! is no module, and an answer in bounded time. Every module that comes out keeps the rules of the IR.
#![expect(clippy::disallowed_methods, reason = "tests read files and take time")]

use iecc_diag::{Diagnostics, Severity};
use iecc_driver::{FrontOptions, Sources, compile};
use iecc_ir::verify;
use iecc_source::SourceMap;
use iecc_tests::mutate::{mutate, mutate_values};
use iecc_tests::random_ir::seeds;
use iecc_tests::rng::Rng;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const SEEDS: u64 = 500;

/// Far above what the inputs here need on any machine, far below what a hang needs.
const LONGEST: Duration = Duration::from_secs(10);

/// The texts of all cases, in a fixed order.
fn cases() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance");
    let mut paths: Vec<PathBuf> = folder(&root).iter().flat_map(|path| folder(path)).collect();
    paths.sort();
    let texts = paths.iter().map(std::fs::read_to_string);
    texts.map(|text| text.expect("a readable case")).collect()
}

fn folder(path: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(path).expect("the suite");
    entries
        .map(|entry| entry.expect("readable").path())
        .collect()
}

fn survives(text: &str, what: &str) {
    let start = Instant::now();
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let file = map.add("case.st", text);
    let sources = Sources::text(&mut map, vec![file]);
    match compile(&map, &sources, &FrontOptions::default(), &mut diagnostics) {
        Some(module) => assert_eq!(verify(&module).err(), None, "{what}:\n{text}"),
        None => {
            let error = diagnostics.iter().any(|d| d.severity == Severity::Error);
            let units = text.contains("PROGRAM") || text.contains("program");
            assert!(
                error || !units || !diagnostics.is_empty(),
                "{what} says nothing:\n{text}"
            );
        }
    }
    assert!(start.elapsed() < LONGEST, "{what} takes too long:\n{text}");
}

#[test]
fn damaged_cases_give_messages_not_panics() {
    let cases = cases();
    for seed in seeds(SEEDS) {
        let mut rng = Rng::new(seed);
        let text = &cases[rng.below(cases.len())];
        survives(&mutate(text, &mut rng), &format!("seed {seed}"));
        survives(
            &mutate_values(text, &mut rng),
            &format!("seed {seed}, values"),
        );
    }
}

/// Words of one case in the places of others: mostly well-formed, mostly meaningless.
#[test]
fn shuffled_words_give_messages_not_panics() {
    let cases = cases();
    for seed in seeds(SEEDS) {
        let mut rng = Rng::new(seed);
        let text = &cases[rng.below(cases.len())];
        survives(&shuffle_words(text, &mut rng), &format!("seed {seed}"));
    }
}

fn shuffle_words(text: &str, rng: &mut Rng) -> String {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '#' || c == '.';
    let start = text.find("*)").map_or(0, |end| end + 2);
    let words: Vec<&str> = text[start..]
        .split(|c| !is_word(c))
        .filter(|word| !word.is_empty())
        .collect();
    let mut shuffled = text.to_owned();
    for _ in 0..=rng.below(6) {
        let (from, to) = (rng.pick(&words), rng.pick(&words));
        if let Some(at) = shuffled.rfind(from) {
            shuffled.replace_range(at..at + from.len(), to);
        }
    }
    shuffled
}

/// Prefixes of cases, cut where words end: the last unit is never whole.
#[test]
fn prefixes_of_cases_give_messages_not_panics() {
    let cases = cases();
    for seed in seeds(SEEDS) {
        let mut rng = Rng::new(seed);
        let text = &cases[rng.below(cases.len())];
        let mut end = rng.below(text.len());
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        survives(&text[..end], &format!("seed {seed}"));
    }
}
