//! What ARCHITECTURE.md says of the crates is true: their dependencies on one another, and what
//! their sources never mention.
#![expect(
    clippy::disallowed_methods,
    reason = "tests read files and run programs"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Crates by the short names of ARCHITECTURE.md, each with the members it depends on.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Crates at the edge: the only ones that may touch files, the environment, processes, the clock.
const EDGE: [&str; 3] = ["driver", "cli", "tests"];

/// What a core crate must not name: it would read the world behind its caller's back.
const WORLD: [&str; 8] = [
    "std::fs",
    "std::env",
    "std::process",
    "std::net",
    "Instant::now",
    "SystemTime",
    "std::thread",
    "std::io::stdin",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the tests crate lies in the workspace")
        .to_path_buf()
}

#[test]
fn the_crate_graph_is_the_one_in_architecture_md() {
    let documented = parse_block(&architecture());
    let actual = workspace_graph();
    assert_eq!(
        documented,
        actual,
        "put this into the block `crates` of ARCHITECTURE.md, if the change is meant:\n{}",
        print_block(&actual)
    );
}

#[test]
fn the_arrows_that_carry_the_design_hold() {
    let graph = workspace_graph();
    let only = |name: &str, allowed: &[&str]| {
        let extra: Vec<_> = graph[name]
            .iter()
            .filter(|dependency| !allowed.contains(&dependency.as_str()))
            .collect();
        assert!(extra.is_empty(), "{name} must not depend on {extra:?}");
    };
    only("source", &[]);
    only("diag", &["source"]);
    only("ast", &["source"]);
    only("ir", &["source"]);
    only("target", &["ir", "source"]);
    for ir_alone in ["passes", "interp", "jit", "verilog"] {
        only(ir_alone, &["ir", "target", "source"]);
    }
}

#[test]
fn no_crate_depends_on_itself_through_others() {
    let graph = workspace_graph();
    for name in graph.keys() {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&String> = graph[name].iter().collect();
        while let Some(next) = open.pop() {
            assert_ne!(next, name, "{name} depends on itself");
            if reached.insert(next) {
                open.extend(&graph[next]);
            }
        }
    }
}

#[test]
fn core_crates_do_not_touch_the_world() {
    let mut found = Vec::new();
    for (name, folder) in members() {
        if !EDGE.contains(&name.as_str()) {
            found.extend(mentions(&folder, &|line| {
                WORLD.iter().find(|word| line.contains(**word)).copied()
            }));
        }
    }
    assert!(
        found.is_empty(),
        "pass it in as an argument:\n{}",
        found.join("\n")
    );
}

#[test]
fn unsafe_lives_in_the_jit_alone() {
    let is_unsafe = |line: &str| has_word(line, "unsafe").then_some("unsafe");
    for (name, folder) in members() {
        let found = mentions(&folder, &is_unsafe);
        assert!(
            name == "jit" || found.is_empty(),
            "unsafe outside backends/jit:\n{}",
            found.join("\n")
        );
    }
}

#[test]
fn comments_and_names_that_contain_the_word_are_not_unsafe() {
    assert!(has_word("unsafe { call() }", "unsafe"));
    assert!(!has_word("#![deny(unsafe_code)]", "unsafe"));
    assert_eq!(without_comment("let a = 1; // unsafe"), "let a = 1; ");
}

#[test]
fn every_file_of_source_says_what_it_guarantees() {
    let silent: Vec<String> = members()
        .values()
        .flat_map(|folder| rust_files(&folder.join("src")))
        .filter(|path| !read(path).starts_with("//!"))
        .map(|path| path.display().to_string())
        .collect();
    assert!(
        silent.is_empty(),
        "begin these with a `//!` comment:\n{}",
        silent.join("\n")
    );
}

fn architecture() -> String {
    read(&root().join("ARCHITECTURE.md"))
}

/// Reads lines `name: dependency dependency` of the block fenced as `crates`.
fn parse_block(text: &str) -> Graph {
    let (_, rest) = text
        .split_once("\n```crates\n")
        .expect("a block ```crates in ARCHITECTURE.md");
    let (block, _) = rest.split_once("\n```").expect("the end of the block");
    block.lines().map(parse_line).collect()
}

fn parse_line(line: &str) -> (String, BTreeSet<String>) {
    let (name, dependencies) = line.split_once(':').expect("`name: dependencies`");
    let dependencies = dependencies.split_whitespace().map(str::to_owned).collect();
    (name.trim().to_owned(), dependencies)
}

fn print_block(graph: &Graph) -> String {
    let width = graph.keys().map(String::len).max().unwrap_or(0) + 1;
    let line = |(name, dependencies): (&String, &BTreeSet<String>)| {
        let names: Vec<_> = dependencies.iter().map(String::as_str).collect();
        format!("{:width$} {}", format!("{name}:"), names.join(" "))
            .trim_end()
            .to_owned()
    };
    graph.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_block_prints_as_it_is_parsed() {
    let graph = workspace_graph();
    let text = format!("\n```crates\n{}\n```\n", print_block(&graph));
    assert_eq!(parse_block(&text), graph);
}

fn metadata() -> Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version=1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON")
}

/// `iecc-ir` is `ir`; the package with the binary is named `iecc` and is `cli`.
fn short_name(package: &str) -> Option<&str> {
    match package {
        "iecc" => Some("cli"),
        _ => package.strip_prefix("iecc-"),
    }
}

/// Members with the folders they lie in.
fn members() -> BTreeMap<String, PathBuf> {
    let member = |package: &Value| {
        let name = short_name(text(&package["name"])).expect("members are named iecc-…");
        let manifest = Path::new(text(&package["manifest_path"]));
        let folder = manifest.parent().expect("a manifest lies in a folder");
        (name.to_owned(), folder.to_path_buf())
    };
    packages(&metadata()).iter().map(member).collect()
}

/// Normal dependencies among members. The tests depend on what they test and are left out.
fn workspace_graph() -> Graph {
    let metadata = metadata();
    let entry = |package: &Value| {
        let name = short_name(text(&package["name"])).expect("members are named iecc-…");
        (name.to_owned(), member_dependencies(package))
    };
    let mut graph: Graph = packages(&metadata).iter().map(entry).collect();
    graph.remove("tests");
    graph
}

fn member_dependencies(package: &Value) -> BTreeSet<String> {
    let dependencies = package["dependencies"].as_array().expect("a list");
    dependencies
        .iter()
        .filter(|dependency| dependency["kind"].is_null())
        .filter_map(|dependency| short_name(text(&dependency["name"])))
        .map(str::to_owned)
        .collect()
}

fn packages(metadata: &Value) -> &Vec<Value> {
    metadata["packages"].as_array().expect("a list of packages")
}

fn text(value: &Value) -> &str {
    value.as_str().expect("a string")
}

/// Lines of a crate's sources in which `search` finds something, comments left aside.
fn mentions(folder: &Path, search: &dyn Fn(&str) -> Option<&'static str>) -> Vec<String> {
    let mut found = Vec::new();
    for path in rust_files(&folder.join("src")) {
        for (index, line) in read(&path).lines().enumerate() {
            if let Some(word) = search(without_comment(line)) {
                found.push(format!("{}:{}: {word}", path.display(), index + 1));
            }
        }
    }
    found
}

fn without_comment(line: &str) -> &str {
    line.split_once("//").map_or(line, |(code, _)| code)
}

fn has_word(line: &str, word: &str) -> bool {
    line.split(|c: char| !c.is_alphanumeric() && c != '_')
        .any(|part| part == word)
}

/// The `.rs` files below a folder, in the order of their names.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(folder) = open.pop() {
        let entries = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        for path in entries.map(|entry| entry.expect("readable").path()) {
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}
