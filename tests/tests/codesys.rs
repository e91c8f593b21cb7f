//! The dialect of CODESYS and TwinCAT over several files: the project of the example runs as it was
//! worked out by hand, is refused without the dialect, and SIZEOF is the layout of the engines.

use iecc_diag::{Code, Diagnostics};
use iecc_driver::run::Schedule;
use iecc_driver::{EngineKind, Found, FrontOptions, Sources, compile, find};
use iecc_grammar::st::Dialect;
use iecc_ir::{Layout, MemType, Module, Region};
use iecc_source::SourceMap;
use iecc_tests::examples::{example, example_text};
use iecc_tests::runs::{messages, trace_of_changes};

const ENGINES: [EngineKind; 5] = [
    EngineKind::Interp,
    EngineKind::InterpSoftware,
    EngineKind::InterpHardware,
    EngineKind::JitPlain,
    EngineKind::Jit,
];

/// What the project of the example is compiled to.
fn compiled(dialect: Option<Dialect>) -> (Option<Module>, SourceMap, Diagnostics) {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let Some(Found::Project(project)) = find(&mut map, &[example("tank")], &mut diagnostics) else {
        panic!("{}", messages(&map, &diagnostics));
    };
    let mut options = project.options.clone();
    options.dialect = dialect.unwrap_or(options.dialect);
    let sources = project.load(&mut map, &options.levels, &mut diagnostics);
    let sources = sources.expect("the files are there");
    let module = compile(&map, &sources, &options, &mut diagnostics);
    (module, map, diagnostics)
}

fn trace(engine: EngineKind) -> String {
    let (module, map, diagnostics) = compiled(None);
    assert!(diagnostics.is_empty(), "{}", messages(&map, &diagnostics));
    let schedule = Schedule::for_duration(10_000_000, 2_300_000_000).expect("in range");
    let stimulus = example_text("tank/stimulus.csv");
    trace_of_changes(module.expect("no errors"), &stimulus, engine, schedule)
}

#[test]
fn the_tank_runs_as_it_was_worked_out() {
    for engine in ENGINES {
        assert_eq!(
            trace(engine),
            example_text("tank/expected.csv"),
            "{engine:?}"
        );
    }
}

#[test]
fn the_tank_is_refused_without_the_dialect() {
    let (module, map, diagnostics) = compiled(Some(Dialect::Iec));
    assert!(module.is_none());
    let named = diagnostics.iter().filter(|said| said.code == Code::E8001);
    let notes: Vec<_> = named.map(|said| said.notes.join(" ")).collect();
    assert!(notes.len() > 10, "{}", messages(&map, &diagnostics));
    assert!(notes.iter().all(|note| note.contains("--dialect codesys")));
}

fn module(text: &str) -> Module {
    let mut map = SourceMap::new();
    let file = map.add("sizes.st", text);
    let sources = Sources::text(&mut map, vec![file]);
    let mut diagnostics = Diagnostics::new();
    let options = FrontOptions {
        dialect: Dialect::Codesys,
        ..FrontOptions::default()
    };
    let module = compile(&map, &sources, &options, &mut diagnostics);
    module.unwrap_or_else(|| panic!("{}", messages(&map, &diagnostics)))
}

/// Every variable has the size of an array beside it, which SIZEOF of the variable made.
#[test]
fn sizes_are_those_of_the_layout() {
    let types = [
        "BOOL",
        "INT",
        "LREAL",
        "TIME",
        "STRING[5]",
        "WSTRING[3]",
        "Colour",
        "Mixed",
        "ARRAY [1..3] OF Mixed",
        "POINTER TO INT",
        "TON",
        "Derived",
        "Parts",
    ];
    let mut text = "TYPE Colour : (Red, Green); END_TYPE
        TYPE Mixed : STRUCT a : BOOL; b : STRING[2]; c : LREAL; d : INT; END_STRUCT END_TYPE
        TYPE Parts : UNION w : DWORD; b : BYTE; END_UNION END_TYPE
        FUNCTION_BLOCK Base VAR_INPUT a : BYTE; END_VAR VAR b : DINT; END_VAR END_FUNCTION_BLOCK
        FUNCTION_BLOCK Derived EXTENDS Base VAR c : BOOL; END_VAR
          METHOD Count VAR_INST n : LINT; END_VAR n := n + 1; END_METHOD
        END_FUNCTION_BLOCK
        PROGRAM Main VAR_OUTPUT ok : BOOL; END_VAR ok := TRUE; END_PROGRAM
        VAR_GLOBAL\n"
        .to_owned();
    for (index, ty) in types.iter().enumerate() {
        text += &format!("v{index} : {ty}; s{index} : ARRAY [1..SIZEOF(v{index})] OF BYTE;\n");
    }
    text += "END_VAR\n";
    let module = module(&text);
    let layout = Layout::new(&module.types);
    let state = &module.types.structs[module.region(Region::State)];
    let size = |name: String| -> u64 {
        let field = state.fields.iter().find(|field| field.name == name);
        let ty: MemType = field.unwrap_or_else(|| panic!("no {name}")).ty;
        layout.size(&module.types, ty)
    };
    for (index, ty) in types.iter().enumerate() {
        assert_eq!(size(format!("s{index}")), size(format!("v{index}")), "{ty}");
    }
}
