//! After any change of a text, a workspace that knows the text before says what a new one says that
//! sees it for the first time; and it does not look again at what the change cannot have touched.

use iecc_diag::Diagnostics;
use iecc_driver::Constants;
use iecc_ide::{Dialect, Workspace};
use iecc_source::FileId;
use iecc_tests::cases::suite;
use iecc_tests::mutate::mutate;
use iecc_tests::rng::{Rng, seeds};

/// Each makes some twenty changes.
const SEEDS: u64 = 25;

/// Files with at least one of everything that lets one unit know of another: constants, globals,
/// types, inheritance, interfaces, namespaces, open arrays, ENO, a configuration, warnings.
const PROJECT: [&str; 3] = [
    include_str!("../st/recheck/types.st"),
    include_str!("../st/recheck/blocks.st"),
    include_str!("../st/recheck/main.st"),
];

/// What calls a unit with open arrays is always looked at: `Whole_of`.
const ALWAYS: usize = 1;

struct Project {
    workspace: Workspace<Constants>,
    files: Vec<FileId>,
    texts: Vec<String>,
}

impl Project {
    fn new(dialect: Dialect, texts: &[String]) -> Self {
        let mut workspace = Workspace::new(dialect, None, Constants);
        let names = (0..).zip(texts);
        let files = names.map(|(index, text)| workspace.add(&format!("file{index}.st"), text));
        Self {
            files: files.collect(),
            workspace,
            texts: texts.to_vec(),
        }
    }

    fn sample() -> Self {
        Self::new(Dialect::Iec, &PROJECT.map(str::to_owned))
    }

    fn change(&mut self, file: usize, text: String) -> Diagnostics {
        self.workspace.change(self.files[file], &text);
        self.texts[file] = text;
        self.workspace.check()
    }

    fn replace(&mut self, file: usize, from: &str, to: &str) -> Diagnostics {
        let text = &self.texts[file];
        assert_eq!(text.matches(from).count(), 1, "`{from}` stands once");
        self.change(file, text.replace(from, to))
    }

    /// What is said of the same texts by who knows nothing of them.
    fn afresh(&self, dialect: Dialect) -> Diagnostics {
        Self::new(dialect, &self.texts).workspace.check()
    }
}

/// Names have the spelling that was seen first, which may be gone by now.
fn plain(diagnostics: &Diagnostics) -> Vec<String> {
    let all = diagnostics.iter();
    all.map(|one| format!("{one:?}").to_lowercase()).collect()
}

#[track_caller]
fn agrees(project: &Project, found: &Diagnostics, dialect: Dialect, what: &str) {
    let expected = project.afresh(dialect);
    assert_eq!(
        plain(found),
        plain(&expected),
        "{what}:\n{:#?}",
        project.texts
    );
}

#[test]
fn the_unit_with_the_change_is_looked_at_and_no_other() {
    let mut project = Project::sample();
    let found = project.workspace.check();
    assert!(!found.has_errors(), "{found:#?}");
    let all = project.workspace.looked_at();
    assert!(all > 10, "{all}");
    project.workspace.check();
    assert_eq!(project.workspace.looked_at(), ALWAYS);

    let found = project.replace(1, "sum := sum + amount;", "sum := sum + amount + 1;");
    let adder = ["Adder", "Adder.Count", "Adder.Move"];
    assert_eq!(project.workspace.looked_at(), ALWAYS + adder.len());
    agrees(&project, &found, Dialect::Iec, "another body");
    let found = project.replace(1, "(* blocks *)", "(* blocks that move all else *)");
    assert!(project.workspace.looked_at() < all);
    agrees(&project, &found, Dialect::Iec, "a comment");
}

#[test]
fn a_changed_declaration_is_seen_everywhere() {
    let mut project = Project::sample();
    project.workspace.check();
    let all = project.workspace.looked_at();
    let found = project.replace(
        0,
        "LIMIT_OF_ALL : INT := 100",
        "LIMIT_OF_ALL : STRING := '100'",
    );
    assert_eq!(project.workspace.looked_at(), all);
    assert!(found.has_errors());
    agrees(&project, &found, Dialect::Iec, "another type of a constant");
    let found = project.replace(
        0,
        "LIMIT_OF_ALL : STRING := '100'",
        "LIMIT_OF_ALL : INT := 100",
    );
    assert!(!found.has_errors(), "{found:#?}");
    agrees(&project, &found, Dialect::Iec, "the first type again");
}

#[test]
fn a_mistake_in_a_body_stays_until_it_is_mended_there() {
    let mut project = Project::sample();
    project.workspace.check();
    let found = project.replace(1, "sum := sum + amount;", "sum := nowhere;");
    assert!(found.has_errors());
    let found = project.replace(2, "first(amount := 1);", "first(amount := 2);");
    assert_eq!(project.workspace.looked_at(), ALWAYS + 1);
    assert!(found.has_errors(), "the other body still has its mistake");
    agrees(&project, &found, Dialect::Iec, "a mistake elsewhere");
    let found = project.replace(1, "sum := nowhere;", "sum := amount;");
    agrees(&project, &found, Dialect::Iec, "mended");
    assert!(!found.has_errors(), "{found:#?}");
}

#[test]
fn a_circle_of_calls_closes_and_opens_with_one_statement() {
    let mut project = Project::sample();
    project.workspace.check();
    let found = project.replace(0, "Twice := x + x;", "Twice := Thrice(x);");
    let circle = found.iter().filter(|one| one.code.as_str() == "E3040");
    assert_eq!(circle.count(), 1, "{found:#?}");
    agrees(&project, &found, Dialect::Iec, "a circle");
    let found = project.replace(0, "Twice := Thrice(x);", "Twice := x + x;");
    agrees(&project, &found, Dialect::Iec, "no circle");
    assert!(!found.has_errors(), "{found:#?}");
}

#[test]
fn any_change_gives_what_a_first_look_gives() {
    for seed in seeds(SEEDS) {
        let mut rng = Rng::new(seed);
        let mut project = Project::sample();
        project.workspace.check();
        walk(
            &mut project,
            &mut rng,
            Dialect::Iec,
            &format!("seed {seed}"),
        );
    }
}

#[test]
fn cases_of_the_suite_can_be_edited() {
    let cases = suite();
    for seed in seeds(SEEDS) {
        let mut rng = Rng::new(seed);
        let dialect = [Dialect::Iec, Dialect::Codesys][rng.below(2)];
        let text = cases[rng.below(cases.len())].text.clone();
        let mut project = Project::new(dialect, &[text]);
        project.workspace.check();
        walk(&mut project, &mut rng, dialect, &format!("seed {seed}"));
    }
}

/// Damages and mends texts, word by word and byte by byte.
fn walk(project: &mut Project, rng: &mut Rng, dialect: Dialect, what: &str) {
    let whole = project.texts.clone();
    for _ in 0..20 {
        let file = rng.below(project.texts.len());
        let text = &project.texts[file];
        let changed = match rng.below(8) {
            0..=2 => swap_words(text, rng),
            3 => mutate(text, rng),
            4 => without_a_line(text, rng),
            5 => add_a_line(text, rng),
            _ => whole[file].clone(),
        };
        let found = project.change(file, changed);
        agrees(project, &found, dialect, what);
    }
}

/// The places of the words of a text.
fn words(text: &str) -> Vec<(usize, usize)> {
    let mut words: Vec<(usize, usize)> = Vec::new();
    for (at, letter) in text.char_indices() {
        let part = letter.is_ascii_alphanumeric() || letter == '_';
        match words.last_mut() {
            Some(last) if part && last.1 == at => last.1 += 1,
            _ if part => words.push((at, at + 1)),
            _ => {}
        }
    }
    words
}

/// One word takes the place of another.
fn swap_words(text: &str, rng: &mut Rng) -> String {
    let words = words(text);
    if words.is_empty() {
        return text.to_owned();
    }
    let (from, to) = (words[rng.below(words.len())], words[rng.below(words.len())]);
    let word = text[from.0..from.1].to_owned();
    let mut changed = text.to_owned();
    changed.replace_range(to.0..to.1, &word);
    changed
}

fn without_a_line(text: &str, rng: &mut Rng) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    if !lines.is_empty() {
        lines.remove(rng.below(lines.len()));
    }
    lines.join("\n") + "\n"
}

/// Puts one line of the text somewhere else as well.
fn add_a_line(text: &str, rng: &mut Rng) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    if !lines.is_empty() {
        let line = lines[rng.below(lines.len())];
        lines.insert(rng.below(lines.len() + 1), line);
    }
    lines.join("\n") + "\n"
}
