//! File tests: a module in the text form with what is expected of it.
//!
//! Above the module stand directives, `; word: …`, and explanations, `;; …`. One of the first
//! three says what is done:
//!
//! ```text
//! ; run: scans=3 period=10ms            run scans; also with fuel=N, and prescan first if named
//! ; verify: ok                          or, once per broken rule, in order:
//! ; verify: error 8 v1 is used          the rule, and a part of the message
//! ; pass: fold dce                      run passes; the result stands at the end of the file
//! ```
//!
//! A run, or a pass whose result is to run the same, says what goes in and comes out, one value per
//! scan:
//!
//! ```text
//! ; at: 0ms 10ms 35ms                   the times of scans, in place of a period
//! ; in Start: 0 1 1
//! ; out Lamp: 0 1 0
//! ; state t.ACC: 0 10 20
//! ; fault: - divide -                   or divide@0, with its origin; without the line: none
//! ```
//!
//! The expected result of a pass stands in lines that begin `;> `: all functions, and the head of
//! the module if the pass changed it. `IECC_BLESS=1` rewrites them. Every run is made on the
//! interpreter and as machine code, and repeated after the pipeline for software, which must change
//! nothing, and after the one for hardware, which must not change outputs. A pass is also compared
//! with the module before it on random inputs.

mod directives;
mod pass;
mod run;
mod verify;

use directives::Command;
use std::fs;
use std::path::{Path, PathBuf};

/// Runs every `.ir` file in a folder of `tests/filetests`, folders within it included.
///
/// # Panics
/// With what went wrong in which file; also if there is no file.
pub fn run_folder(folder: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("filetests");
    let mut files = Vec::new();
    collect(&root.join(folder), &mut files);
    files.sort();
    assert!(!files.is_empty(), "no file test in {folder}");
    let failures: Vec<String> = files
        .iter()
        .filter_map(|path| run_file(path).err().map(|error| (path, error)))
        .map(|(path, error)| format!("{}: {error}", path.display()))
        .collect();
    assert!(failures.is_empty(), "\n{}", failures.join("\n\n"));
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let entries =
        fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let path = entry.expect("readable folder").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "ir") {
            files.push(path);
        }
    }
}

#[expect(clippy::disallowed_methods, reason = "file tests lie in files")]
fn run_file(path: &Path) -> Result<(), String> {
    let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
    let bless = std::env::var("IECC_BLESS").is_ok_and(|value| value == "1");
    match check(&text)? {
        Outcome::Passed => Ok(()),
        Outcome::Blessable(new) if bless => fs::write(path, new).map_err(|error| error.to_string()),
        Outcome::Blessable(new) => Err(format!(
            "the result differs (IECC_BLESS=1 rewrites it):\n{}",
            difference(&text, &new)
        )),
    }
}

/// How a file test ended, if nothing is wrong.
#[derive(Debug, PartialEq, Eq)]
enum Outcome {
    Passed,
    /// The text with the result that was found.
    Blessable(String),
}

fn check(text: &str) -> Result<Outcome, String> {
    let command = directives::parse(text)?;
    let module = iecc_ir::parse_module(text).map_err(|error| error.to_string())?;
    match &command {
        Command::Verify(expected) => verify::check(&module, expected).map(|()| Outcome::Passed),
        Command::Run(run) => run::check(&module, run).map(|()| Outcome::Passed),
        Command::Pass(names, run) => {
            let after = pass::check(&module, names, run.as_ref())?;
            let expected = pass::rewrite(text, &pass::result_text(&module, &after));
            Ok(if expected == text {
                Outcome::Passed
            } else {
                Outcome::Blessable(expected)
            })
        }
    }
}

/// Lines of both texts, those that differ marked `-` and `+`.
fn difference(old: &str, new: &str) -> String {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let same = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let (old, new) = (&old[same..], &new[same..]);
    let tail = old.iter().rev().zip(new.iter().rev());
    let tail = tail.take_while(|(a, b)| a == b).count();
    let removed = old[..old.len() - tail]
        .iter()
        .map(|line| format!("-{line}\n"));
    let added = new[..new.len() - tail]
        .iter()
        .map(|line| format!("+{line}\n"));
    format!(
        "from line {}:\n{}",
        same + 1,
        removed.chain(added).collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAMP: &str = "module m\nstate { n: i32 }\ninput { x: i1 }\noutput { y: i1 }\nscan @s\n\n\
        fn @s[]() -> () {\nb0:\n  v0: i1 = load input.x\n  v1: i1 = const 1\n  store output.y, v0\n  return\n}\n";

    fn check_lamp(head: &str) -> Result<Outcome, String> {
        check(&format!("{head}{LAMP}"))
    }

    #[test]
    fn a_run_with_the_right_outputs_passes() {
        let head =
            "; run: scans=2 period=1ms\n;; copies\n; in x: 0 1\n; out y: 0 1\n; state n: 0 0\n";
        assert_eq!(check_lamp(head), Ok(Outcome::Passed));
    }

    #[test]
    fn mistakes_in_a_test_and_wrong_results_fail() {
        let table = [
            ("", "neither run, verify nor pass"),
            ("; rum: scans=1 period=1ms\n", "unknown directive \"rum\""),
            (
                "; run: scans=2 period=1ms\n; in x: 0 1\n; out y: 0 0\n",
                "scan 1: out y is 1, expected 0",
            ),
            (
                "; run: scans=2 period=1ms\n; in x: 0\n; out y: 0 0\n",
                "1 values for 2 scans",
            ),
            (
                "; run: scans=1 period=1ms\n; out z: 0\n",
                "there is no Output z",
            ),
            ("; run: scans=1 period=1ms\n; out y: 7\n", "7 is no i1"),
            ("; run: scans=1 period=1ms\n; in x: 0\n", "expects nothing"),
            (
                "; run: scans=1 period=1ms\n; fault: divide\n",
                "scan 0: no fault, expected divide",
            ),
            (
                "; run: scans=1 period=1\n; out y: 0\n",
                "\"1\" is no duration",
            ),
            ("; verify: error 8\n", "expected error 8, found none"),
            (
                "; verify: ok\n; run: scans=1 period=1ms\n; out y: 0\n",
                "only one of run, verify and pass",
            ),
            ("; verify: ok\n; out y: 0\n", "verify takes no"),
            ("; pass: dcee\n", "dcee"),
        ];
        for (head, expected) in table {
            let found = check_lamp(head).expect_err(head);
            assert!(found.contains(expected), "{head}: {found}");
        }
    }

    #[test]
    fn the_result_of_a_pass_stands_in_the_file() {
        let head = "; pass: inline\n";
        let Ok(Outcome::Blessable(blessed)) = check_lamp(head) else {
            panic!("no result stood there yet")
        };
        assert_eq!(check(&blessed), Ok(Outcome::Passed));
        let wrong = blessed.replace(";>   return", ";>   fault range");
        assert_eq!(check(&wrong), Ok(Outcome::Blessable(blessed)));
    }

    #[test]
    fn a_difference_shows_the_lines_that_differ() {
        assert_eq!(
            difference("a\nb\nc\n", "a\nx\ny\nc\n"),
            "from line 2:\n-b\n+x\n+y\n"
        );
    }
}
