//! Times the check of a project after one body changed; `scripts/bench-edit` runs it.
//!
//!     cargo run --release -p iecc-tests --example recheck -- CHANGES FILE…
//!
//! Sums get a further term, one after the other all over the files; after each change the whole
//! project is checked. It prints the first check, and the best, median and worst of the others, in
//! processor time, which other programs of a shared machine do not lengthen as much as they do time.

#![expect(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a benchmark reads files and prints"
)]

use iecc_driver::Constants;
use iecc_ide::{Dialect, Workspace};
use iecc_source::FileId;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let changes: usize = arguments
        .next()
        .map_or(50, |n| n.parse().expect("a number"));
    let mut workspace = Workspace::new(Dialect::Iec, None, Constants);
    let files = arguments.map(|path| {
        let text = std::fs::read_to_string(&path).expect("a file that can be read");
        workspace.add(&path, &text)
    });
    let files: Vec<FileId> = files.collect();
    let begin = processor_ns();
    let found = workspace.check();
    let first = ms(processor_ns() - begin);
    assert!(!found.has_errors(), "the project is right");
    let sources = files.iter().map(|file| workspace.map().file(*file));
    let lines: usize = sources.map(|source| source.lines().line_count()).sum();
    println!(
        "  {lines} lines, {} warnings; first check {first:.1} ms",
        found.len()
    );
    let times = (0..changes).map(|round| change(&mut workspace, &files, round, changes));
    let mut times: Vec<u64> = times.collect();
    times.sort_unstable();
    let (best, median, worst) = (times[0], times[changes / 2], times[changes - 1]);
    println!(
        "  after a change: best {:.1} ms, median {:.1} ms, worst {:.1} ms",
        ms(best),
        ms(median),
        ms(worst)
    );
}

/// Adds a term to one of the sums `… + (…)`, each time another one, and checks.
fn change(
    workspace: &mut Workspace<Constants>,
    files: &[FileId],
    round: usize,
    rounds: usize,
) -> u64 {
    let file = files[round * files.len() / rounds];
    let mut text = workspace.map().file(file).text().to_owned();
    let sums: Vec<usize> = text.match_indices(" + (").map(|(at, _)| at).collect();
    assert!(!sums.is_empty(), "sums to change");
    text.insert_str(sums[round * sums.len() / rounds], " + 1");
    let begin = processor_ns();
    workspace.change(file, &text);
    workspace.check();
    processor_ns() - begin
}

/// How long this thread has run so far, as Linux counts it.
fn processor_ns() -> u64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux");
    let run = text.split_whitespace().next().expect("three numbers");
    run.parse().expect("nanoseconds")
}

fn ms(ns: u64) -> f64 {
    ns as f64 / 1e6
}
