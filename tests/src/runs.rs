//! Whole runs as `iecc run` makes them, on every engine, into rows that a test can compare.

use iecc_diag::{Diagnostics, render_text};
use iecc_driver::run::{CsvTrace, Request, Schedule, Session, Stimulus, Trace};
use iecc_driver::{EngineKind, FrontOptions, Sources, compile};
use iecc_ir::{Module, verify};
use iecc_jit::Jit;
use iecc_passes::{SOFTWARE, Settings, run_pipeline};
use iecc_source::SourceMap;
use iecc_target::Engine;
use std::io;
use std::path::Path;

/// The columns of a run and what they held after each scan.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Rows {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Times in nanoseconds and values, as a trace shows them.
    pub rows: Vec<(u64, Vec<i64>)>,
}

impl Rows {
    /// These columns only, in this order, which must all exist.
    #[must_use]
    pub fn select(&self, names: &[&str]) -> Self {
        let position = |name: &&str| {
            let found = self
                .columns
                .iter()
                .position(|c| c.eq_ignore_ascii_case(name));
            found.unwrap_or_else(|| panic!("no column {name} among {:?}", self.columns))
        };
        let wanted: Vec<usize> = names.iter().map(position).collect();
        let select = |values: &Vec<i64>| wanted.iter().map(|&at| values[at]).collect();
        Self {
            columns: names.iter().map(|&name| name.to_owned()).collect(),
            rows: self
                .rows
                .iter()
                .map(|(now, values)| (*now, select(values)))
                .collect(),
        }
    }

    /// The first row and those that differ from the one before.
    #[must_use]
    pub fn changes(mut self) -> Self {
        self.rows.dedup_by(|row, before| row.1 == before.1);
        self
    }
}

struct Recorder<'s> {
    session: &'s Session,
    rows: Rows,
}

impl Trace for Recorder<'_> {
    fn row(&mut self, now_ns: u64, values: &[u64]) -> io::Result<()> {
        let columns = self.session.columns().iter();
        let values = columns.zip(values).map(|(column, &bits)| {
            let is_bool = column.ty == iecc_ir::Type::I1;
            // A BOOL is 0 or 1, not -1.
            if is_bool {
                bits as i64
            } else {
                column.ty.signed(bits)
            }
        });
        self.rows.rows.push((now_ns, values.collect()));
        Ok(())
    }
}

/// The module of a program that compiles.
///
/// # Panics
/// With the messages, if it does not.
pub fn compiled(path: &Path, options: &FrontOptions) -> Module {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let paths = [path.to_owned()];
    let sources = Sources::load(&mut map, &paths, &options.levels, &mut diagnostics);
    let module = sources.and_then(|sources| compile(&map, &sources, options, &mut diagnostics));
    module.unwrap_or_else(|| panic!("{}", messages(&map, &diagnostics)))
}

/// Messages as users see them.
pub fn messages(map: &SourceMap, diagnostics: &Diagnostics) -> String {
    let texts = diagnostics.iter().map(|d| render_text(map, d, false));
    texts.collect::<Vec<_>>().join("\n")
}

/// The module opened for a run with a stimulus (CSV) and watched paths.
///
/// # Panics
/// With the messages, if they do not fit.
pub fn opened(mut module: Module, stimulus: &str, watches: &[&str]) -> (Module, Session) {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let file = map.add("stimulus.csv", stimulus);
    let stimulus = Stimulus::parse(file, stimulus, &mut diagnostics);
    let watches: Vec<String> = watches.iter().map(|&w| w.to_owned()).collect();
    let request = Request {
        watches: &watches,
        stimulus: stimulus.as_ref(),
    };
    let session = Session::prepare(&mut module, &request, &mut diagnostics);
    match session.filter(|_| diagnostics.is_empty()) {
        Some(session) => (module, session),
        None => panic!("{}", messages(&map, &diagnostics)),
    }
}

/// Every engine with its name, for a scan every `period_ns`: those that users can choose, and machine
/// code of the module as it stands, before the passes.
///
/// # Panics
/// If an engine cannot run the module.
pub fn engines(module: &Module, period_ns: u64) -> Vec<(&'static str, Box<dyn Engine>)> {
    let start = |kind: EngineKind| {
        kind.start(module, period_ns)
            .unwrap_or_else(|found| panic!("{found:?}"))
    };
    let verified = verify(module).expect("the module keeps the rules");
    let unchanged = Jit::new(verified).unwrap_or_else(|errors| panic!("{errors:?}"));
    vec![
        ("interpreter", start(EngineKind::Interp)),
        ("machine code", start(EngineKind::Jit)),
        ("machine code without passes", Box::new(unchanged)),
        ("simulated Verilog", start(EngineKind::Verilog)),
    ]
}

/// Machine code of a module after the passes for software.
///
/// # Panics
/// If the passes break a rule, or the engine refuses the module.
pub fn machine_code(mut module: Module) -> Jit {
    let settings = Settings::default();
    run_pipeline(&mut module, SOFTWARE, &settings, &mut |_, _| ()).expect("the passes exist");
    let verified = verify(&module).expect("passes keep the rules");
    Jit::new(verified).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Runs a session to its end.
///
/// # Panics
/// If a scan is abandoned.
pub fn rows(session: &Session, engine: &mut dyn Engine, schedule: Schedule) -> Rows {
    let columns = session.columns().iter().map(|column| column.name.clone());
    let mut recorder = Recorder {
        session,
        rows: Rows {
            columns: columns.collect(),
            rows: Vec::new(),
        },
    };
    let result = session.run(engine, schedule, &mut recorder, &mut |_| {});
    result.unwrap_or_else(|error| panic!("{error:?}"));
    recorder.rows
}

/// The changes of a run with a stimulus (CSV), as `iecc run` writes them.
///
/// # Panics
/// If the stimulus does not fit, or a scan is abandoned.
pub fn trace_of_changes(
    module: Module,
    stimulus: &str,
    engine: EngineKind,
    schedule: Schedule,
) -> String {
    let (module, session) = opened(module, stimulus, &[]);
    let mut engine = engine
        .start(&module, schedule.period_ns())
        .unwrap_or_else(|found| panic!("{found:?}"));
    let mut bytes = Vec::new();
    let mut trace = CsvTrace::new(&mut bytes, session.columns(), schedule.unit(), true)
        .expect("writing to memory");
    session
        .run(engine.as_mut(), schedule, &mut trace, &mut |_| {})
        .unwrap_or_else(|error| panic!("{error:?}"));
    trace.finish().expect("writing to memory");
    String::from_utf8(bytes).expect("UTF-8")
}
