//! The corpus of exports: where its files are.

use std::path::{Path, PathBuf};

/// A file of the corpus.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CorpusFile {
    /// Where it is.
    pub path: PathBuf,
    /// Its path below the corpus, for tables.
    pub name: String,
    /// What was exported: `Controller`, `Routine`, ….
    pub target: String,
    /// How many rungs the corpus's own table counts.
    pub rungs: usize,
}

/// Every file in the table of the corpus.
#[expect(clippy::disallowed_methods, reason = "tests read files")]
pub fn corpus_files(shared: &Path) -> Vec<CorpusFile> {
    let corpus = shared.join("corpus/l5x");
    let table = std::fs::read_to_string(corpus.join("manifest.tsv"));
    let table = table.expect("the corpus has a table");
    let rows = table.lines().skip(1);
    rows.map(|row| file(&corpus, row)).collect()
}

fn file(corpus: &Path, row: &str) -> CorpusFile {
    let cells: Vec<&str> = row.split('\t').collect();
    let folder = cells[0].replace('/', "__");
    CorpusFile {
        path: corpus.join(&folder).join(cells[1]),
        name: format!("{folder}/{}", cells[1]),
        target: cells[5].to_owned(),
        rungs: cells[6].parse().unwrap_or(0),
    }
}
