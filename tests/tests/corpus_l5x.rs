//! Every export of the corpus is read: no errors, every rung parses, and the counts agree with
//! the corpus's own table, which another program made.
#![expect(clippy::disallowed_methods, reason = "tests read files")]
#![expect(
    clippy::print_stdout,
    reason = "the table is part of what the test shows"
)]

use iecc_ast::logix::{Project, Routine, RoutineBody, TagKind};
use iecc_ast::rung::OperandKind;
use iecc_diag::{Diagnostics, Severity, render_text};
use iecc_source::SourceMap;
use iecc_tests::check::prints_to_itself;
use iecc_tests::shared::shared_dir;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// One line of the corpus's table.
struct Row {
    path: PathBuf,
    target: String,
    counts: Counts,
    mnemonics: BTreeMap<String, usize>,
}

/// What both sides count.
#[derive(Debug, Default, PartialEq, Eq, Clone, Copy)]
struct Counts {
    rungs: usize,
    st_lines: usize,
    /// Encoded ones included.
    instructions: usize,
    fbd: usize,
    sfc: usize,
    encoded: usize,
}

fn manifest(corpus: &Path) -> Vec<Row> {
    let table =
        std::fs::read_to_string(corpus.join("manifest.tsv")).expect("the corpus has a table");
    table
        .lines()
        .skip(1)
        .map(|line| row(corpus, line))
        .collect()
}

fn row(corpus: &Path, line: &str) -> Row {
    let cells: Vec<&str> = line.split('\t').collect();
    let number = |index: usize| cells[index].parse().unwrap_or(0);
    Row {
        path: corpus.join(cells[0].replace('/', "__")).join(cells[1]),
        target: cells[5].to_owned(),
        counts: Counts {
            rungs: number(6),
            st_lines: number(7),
            instructions: number(8),
            fbd: number(9),
            sfc: number(10),
            encoded: number(11),
        },
        mnemonics: cells[12].split(' ').filter_map(mnemonic_count).collect(),
    }
}

fn mnemonic_count(cell: &str) -> Option<(String, usize)> {
    let (name, count) = cell.split_once(':')?;
    Some((name.to_owned(), count.parse().ok()?))
}

fn routines(project: &Project) -> impl Iterator<Item = &Routine> {
    let programs = project
        .programs
        .iter()
        .flat_map(|program| &program.routines);
    programs.chain(
        project
            .instructions
            .iter()
            .flat_map(|instruction| &instruction.routines),
    )
}

/// Counts as the table does, which takes lines of structured text inside charts for ST lines.
fn counts(map: &SourceMap, project: &Project) -> Counts {
    let encoded = project
        .instructions
        .iter()
        .filter(|instruction| instruction.encoded)
        .count();
    let instructions = project.instructions.len();
    let mut counts = Counts {
        instructions,
        encoded,
        ..Counts::default()
    };
    for routine in routines(project) {
        match &routine.body {
            RoutineBody::Ladder(rungs) => counts.rungs += rungs.len(),
            RoutineBody::StructuredText(text) => counts.st_lines += text.original.len(),
            RoutineBody::FunctionBlock(_) => counts.fbd += 1,
            RoutineBody::SequentialChart(span) => {
                counts.sfc += 1;
                counts.st_lines += map.slice(*span).matches("<Line ").count();
            }
            RoutineBody::Encoded(_) => counts.encoded += 1,
            RoutineBody::Unknown(_) => {}
        }
    }
    counts
}

/// Mnemonics of all rungs; those the table does not know by name are calls of Add-On Instructions.
fn mnemonics(project: &Project, known: &BTreeMap<String, usize>) -> BTreeMap<String, usize> {
    let mut found = BTreeMap::new();
    for rung in rungs(project) {
        for instruction in rung
            .body
            .as_ref()
            .expect("every rung parses")
            .instructions()
        {
            let upper = instruction.mnemonic.node.to_ascii_uppercase();
            let name = if known.contains_key(&upper) {
                upper
            } else {
                "(AOI)".to_owned()
            };
            *found.entry(name).or_default() += 1;
        }
    }
    found
}

fn rungs(project: &Project) -> impl Iterator<Item = &iecc_ast::logix::Rung> {
    routines(project).flat_map(|routine| match &routine.body {
        RoutineBody::Ladder(rungs) => &rungs[..],
        RoutineBody::StructuredText(_)
        | RoutineBody::FunctionBlock(_)
        | RoutineBody::SequentialChart(_)
        | RoutineBody::Encoded(_)
        | RoutineBody::Unknown(_) => &[],
    })
}

fn read(path: &Path) -> (SourceMap, Option<Project>, Diagnostics) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut map = SourceMap::new();
    let file = map.add(path.display().to_string(), text);
    let mut diagnostics = Diagnostics::new();
    let project = iecc_l5x::read(file, map.file(file).text(), &mut diagnostics);
    (map, project, diagnostics)
}

fn read_without_errors(path: &Path) -> (SourceMap, Project) {
    let (map, project, diagnostics) = read(path);
    let errors: Vec<_> = diagnostics
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .collect();
    let rendered: String = errors
        .iter()
        .map(|error| render_text(&map, error, false))
        .collect();
    assert!(errors.is_empty(), "{}", rendered);
    (map, project.expect("no errors, so there is a project"))
}

#[test]
fn every_file_is_read_and_agrees_with_the_table() {
    let Some(shared) = shared_dir() else { return };
    let mut targets: BTreeMap<String, (usize, Counts)> = BTreeMap::new();
    let mut totals: BTreeMap<String, usize> = BTreeMap::new();
    let rows = manifest(&shared.join("corpus/l5x"));
    assert!(rows.len() >= 330, "the corpus has 330 files");
    for row in &rows {
        let (map, project) = read_without_errors(&row.path);
        let counts = counts(&map, &project);
        assert_eq!(counts, row.counts, "{}", row.path.display());
        let found = mnemonics(&project, &row.mnemonics);
        assert_eq!(found, row.mnemonics, "{}", row.path.display());
        let entry = targets.entry(row.target.clone()).or_default();
        *entry = (entry.0 + 1, add(entry.1, counts));
        found
            .into_iter()
            .for_each(|(name, count)| *totals.entry(name).or_default() += count);
    }
    print_table(&targets, &totals);
}

fn add(a: Counts, b: Counts) -> Counts {
    Counts {
        rungs: a.rungs + b.rungs,
        st_lines: a.st_lines + b.st_lines,
        instructions: a.instructions + b.instructions,
        fbd: a.fbd + b.fbd,
        sfc: a.sfc + b.sfc,
        encoded: a.encoded + b.encoded,
    }
}

fn print_table(targets: &BTreeMap<String, (usize, Counts)>, mnemonics: &BTreeMap<String, usize>) {
    println!(
        "{:<28}{:>6}{:>7}{:>9}{:>6}{:>5}{:>5}{:>8}",
        "target", "files", "rungs", "ST lines", "AOIs", "FBD", "SFC", "encoded"
    );
    for (target, (files, c)) in targets {
        println!(
            "{target:<28}{files:>6}{:>7}{:>9}{:>6}{:>5}{:>5}{:>8}",
            c.rungs, c.st_lines, c.instructions, c.fbd, c.sfc, c.encoded
        );
    }
    let mut by_count: Vec<_> = mnemonics
        .iter()
        .map(|(name, count)| (count, name))
        .collect();
    by_count.sort_by(|a, b| b.cmp(a));
    let line: Vec<_> = by_count
        .iter()
        .map(|(count, name)| format!("{name} {count}"))
        .collect();
    println!("instructions: {}", line.join(", "));
}

#[test]
fn every_rung_prints_as_text_that_parses_to_the_same_rung() {
    let Some(shared) = shared_dir() else { return };
    for row in manifest(&shared.join("corpus/l5x")) {
        let (_, project) = read_without_errors(&row.path);
        for rung in rungs(&project) {
            let body = rung.body.as_ref().expect("every rung parses");
            prints_to_itself(body);
        }
    }
}

#[test]
fn places_of_names_and_rungs_hold_their_text() {
    let Some(shared) = shared_dir() else { return };
    for row in manifest(&shared.join("corpus/l5x")) {
        let (map, project) = read_without_errors(&row.path);
        for tag in project
            .tags
            .iter()
            .chain(project.programs.iter().flat_map(|p| &p.tags))
        {
            assert_eq!(map.slice(tag.name.span), tag.name.node);
        }
        for rung in rungs(&project) {
            for instruction in rung
                .body
                .as_ref()
                .expect("every rung parses")
                .instructions()
            {
                assert_eq!(
                    map.slice(instruction.mnemonic.span),
                    instruction.mnemonic.node
                );
            }
        }
    }
}

/// In an export of a whole controller every address of an I/O point belongs to a module.
#[test]
fn addresses_name_module_tags() {
    let Some(shared) = shared_dir() else { return };
    let mut checked = 0;
    for row in manifest(&shared.join("corpus/l5x")) {
        let (_, project) = read_without_errors(&row.path);
        if row.target != "Controller" {
            continue;
        }
        let tags = project.modules.iter().flat_map(|module| &module.tags);
        let names: Vec<String> = tags.map(|tag| tag.name.node.to_ascii_lowercase()).collect();
        for address in addresses(&project) {
            assert!(
                names.contains(&address),
                "{}: {address}",
                row.path.display()
            );
            checked += 1;
        }
    }
    assert!(checked > 80, "{checked} addresses");
}

/// Folded module tag names in aliases and ladder operands.
fn addresses(project: &Project) -> Vec<String> {
    let tags = project
        .tags
        .iter()
        .chain(project.programs.iter().flat_map(|p| &p.tags));
    let aliases = tags.filter_map(|tag| match &tag.kind {
        TagKind::Alias(Some(target)) => Some(target.node.split('.').next()?.to_owned()),
        TagKind::Alias(None) | TagKind::Base | TagKind::Produced | TagKind::Consumed => None,
    });
    let instructions = rungs(project).flat_map(|rung| rung.body.as_ref().unwrap().instructions());
    let operands = instructions.flat_map(|instruction| &instruction.operands);
    let references = operands.filter_map(|operand| match &operand.kind {
        OperandKind::Expr(expr) => Some(expr.as_reference()?.base.node.clone()),
        OperandKind::Empty | OperandKind::InTag | OperandKind::Words(_) => None,
    });
    let all = aliases
        .chain(references)
        .map(|name| name.to_ascii_lowercase());
    all.filter(|name| name.contains(':') && !name.starts_with("s:"))
        .collect()
}
