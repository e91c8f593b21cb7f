//! What must hold for any input at all. Normal tests call these with fixed seeds, fuzz targets
//! with whatever they find.

use crate::differential::interpreter;
use crate::rng::{Rng, seeds};
use crate::stimulus::random_stimulus;
use iecc_ast::Names;
use iecc_ast::rung::Rung;
use iecc_ast::st::{File, UnitKind, dump, print_file};
use iecc_diag::{Code, Diagnostics};
use iecc_driver::{FrontOptions, ParsedLibrary};
use iecc_grammar::st::{Dialect, parse_file};
use iecc_ir::{Layout, MemType, Module, Region};
use iecc_passes::{HARDWARE, SOFTWARE, Settings, run_pipeline};
use iecc_source::{FileId, MappedText};
use iecc_target::{Engine, region_bytes};
use std::fmt::Display;
use std::time::{Duration, Instant};

/// Far above what an input of these tests needs on any machine, far below what a hang needs.
const LONGEST: Duration = Duration::from_secs(10);

/// What some work on one input gives.
///
/// # Panics
/// If it takes too long; then `input` says which it was.
#[expect(clippy::disallowed_methods, reason = "the bound on time needs a clock")]
pub fn in_time<T>(input: impl Display, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let found = work();
    let elapsed = start.elapsed();
    assert!(elapsed < LONGEST, "{input} took {elapsed:?}");
    found
}

/// Runs a test with so many seeds, each in bounded time.
pub fn for_all_seeds(count: u64, test: impl Fn(&mut Rng)) {
    for seed in seeds(count) {
        in_time(format_args!("seed {seed}"), || test(&mut Rng::new(seed)));
    }
}

/// Regions larger than this are parsed but not run: bytes.
const MAX_REGION: usize = 1 << 16;

/// Parsing the text form gives a module or a message. What was parsed prints to text that parses to
/// the same; what also keeps the verifier's rules runs, passes or not, and ends. Says whether it
/// ran.
pub fn ir(text: &str) -> bool {
    let Ok(module) = iecc_ir::parse_module(text) else {
        return false;
    };
    let regions = [Region::State, Region::Input, Region::Output];
    let sizes = regions.map(|region| region_size(&module, region));
    if sizes.into_iter().any(|size| size > MAX_REGION as u64) {
        return false;
    }
    let printed = iecc_ir::print_module(&module);
    let again = iecc_ir::parse_module(&printed).unwrap_or_else(|e| panic!("{e}\n{printed}"));
    assert_eq!(iecc_ir::print_module(&again), printed);
    if iecc_ir::verify(&module).is_err() {
        return false;
    }
    scans(&module);
    for pipeline in [SOFTWARE, HARDWARE] {
        let mut after = module.clone();
        let settings = Settings::default();
        run_pipeline(&mut after, pipeline, &settings, &mut |_, _| {}).expect("passes exist");
        scans(&after);
    }
    true
}

fn region_size(module: &Module, region: Region) -> u64 {
    let layout = Layout::new(&module.types);
    layout.size(&module.types, MemType::Struct(module.region(region)))
}

/// A few scans, none longer than some thousand instructions.
fn scans(module: &Module) {
    let mut engine = interpreter(module).with_fuel(10_000);
    let mut outputs = region_bytes(module, Region::Output);
    for scan in random_stimulus(module, &mut Rng::new(0), 4) {
        // A fault is an answer like any other here.
        let _ = engine.step(scan.now_ns, &scan.inputs, &mut outputs);
    }
}

/// Reading an export gives a project or a message, and every place lies in the text.
pub fn l5x(text: &str) {
    let mut diagnostics = Diagnostics::new();
    let project = iecc_l5x::read(FileId::from_index(0), text, &mut diagnostics);
    assert!(project.is_some() || diagnostics.has_errors());
    for diagnostic in &diagnostics {
        let labels = diagnostic.primary.iter().chain(&diagnostic.secondary);
        labels.for_each(|label| assert!(text.get(label.span.range()).is_some(), "{diagnostic:?}"));
        let unique = [Code::E5001, Code::E5002].contains(&diagnostic.code);
        assert!(
            !unique || diagnostics.len() == 1,
            "one message for a file that is no L5X"
        );
    }
}

/// Parsing a rung gives a tree that prints to a text of the same tree, or messages with a place
/// in the text. Says which.
pub fn rung(text: &str) -> bool {
    let mut diagnostics = Diagnostics::new();
    let Some(rung) = parse(text, &mut diagnostics) else {
        assert!(diagnostics.has_errors());
        for diagnostic in &diagnostics {
            let place = diagnostic.primary.as_ref().expect("a place").span;
            assert!(text.get(place.range()).is_some(), "{diagnostic:?}");
        }
        return false;
    };
    assert!(diagnostics.is_empty());
    prints_to_itself(&rung);
    true
}

/// The canonical text of a rung parses to the same tree and is its own canonical text.
pub fn prints_to_itself(rung: &Rung) {
    let printed = rung.to_string();
    let again = parse(&printed, &mut Diagnostics::new());
    let again = again.unwrap_or_else(|| panic!("printed text does not parse: {printed}"));
    assert_eq!(without_spans(&again), without_spans(rung), "{printed}");
    assert_eq!(again.to_string(), printed);
}

fn parse(text: &str, diagnostics: &mut Diagnostics) -> Option<Rung> {
    iecc_grammar::parse_rung(
        &MappedText::verbatim(FileId::from_index(0), 0, text),
        diagnostics,
    )
}

/// The tree as `{:?}` shows it, with its places left out.
fn without_spans(rung: &Rung) -> String {
    let text = format!("{rung:?}");
    let mut parts = text.split("Span {");
    let mut kept = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        kept.push_str(part.split_once('}').expect("a span ends").1);
    }
    kept
}

/// Parsing Structured Text gives a tree without `Error`, whose canonical text has the same tree, or
/// messages with places in the text. Says which.
pub fn st(text: &str) -> bool {
    let (file, names, diagnostics) = parse_st(text);
    if diagnostics.has_errors() {
        for diagnostic in &diagnostics {
            let labels = diagnostic.primary.iter().chain(&diagnostic.secondary);
            labels.for_each(|label| {
                assert!(text.get(label.span.range()).is_some(), "{diagnostic:?}");
            });
            let fix = diagnostic.fix.as_ref();
            assert!(
                fix.is_none_or(|fix| text.get(fix.span.range()).is_some()),
                "{diagnostic:?}"
            );
        }
        outline(&file, &names);
        return false;
    }
    assert!(
        file.units
            .iter()
            .all(|unit| unit.kind != UnitKind::Error && !unit.has_errors)
    );
    let printed = print_file(&file, &names);
    let (again, new_names, diagnostics) = parse_st(&printed);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}\n{printed}");
    assert_eq!(
        outline(&again, &new_names),
        outline(&file, &names),
        "{printed}"
    );
    assert_eq!(print_file(&again, &new_names), printed);
    true
}

fn parse_st(text: &str) -> (File, Names, Diagnostics) {
    let (mut names, mut diagnostics) = (Names::new(), Diagnostics::new());
    let file = FileId::from_index(0);
    let file = parse_file(file, text, Dialect::Iec, &mut names, &mut diagnostics);
    (file, names, diagnostics)
}

fn outline(file: &File, names: &Names) -> String {
    file.units.iter().map(|unit| dump(unit, names)).collect()
}

/// Structured Text as a program gives a module that keeps the rules of the IR, or an error; every place
/// lies in the text or in the library. Says which.
pub fn st_program(library: &ParsedLibrary, text: &str, options: &FrontOptions) -> bool {
    let mut diagnostics = Diagnostics::new();
    let module = library.compile(text, options, &mut diagnostics);
    let own = library.file();
    for diagnostic in &diagnostics {
        let labels = diagnostic.primary.iter().chain(&diagnostic.secondary);
        let own = labels.filter(|label| label.span.file == own);
        own.for_each(|label| assert!(text.get(label.span.range()).is_some(), "{diagnostic:?}"));
    }
    match module {
        Some(module) => assert_eq!(iecc_ir::verify(&module).err(), None),
        None => assert!(diagnostics.has_errors(), "it was refused for a reason"),
    }
    !diagnostics.has_errors()
}
