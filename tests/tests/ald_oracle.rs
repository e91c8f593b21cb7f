//! The published ALD program does exactly what an independent simulation of its rungs did: every
//! change of 27 bits and counters over a whole batch, for both initialisations.

use iecc_diag::{Diagnostics, render_text};
use iecc_driver::{FrontOptions, compile, load};
use iecc_interp::Interpreter;
use iecc_ir::{Layout, Module, Place, Region, Root, Scalar, verify};
use iecc_sema::logix::Init;
use iecc_source::SourceMap;
use iecc_target::{Engine, region_bytes};
use iecc_tests::shared::shared_dir;
use std::fmt::Write;

const PERIOD_MS: u64 = 10;
/// Beyond the last change in either trace.
const SCANS: u64 = 30_000;

fn module(shared: &std::path::Path, init: Init) -> Module {
    let path = shared.join("corpus/l5x/ghanemja__senior-design/PLC/ALD_miami.L5X");
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let file = load(&mut map, &path, &mut diagnostics).expect("the program is readable");
    let options = FrontOptions {
        init,
        ..FrontOptions::default()
    };
    let module = compile(&map, file, &options, &mut diagnostics);
    let messages: Vec<String> = diagnostics
        .iter()
        .map(|diagnostic| render_text(&map, diagnostic, false))
        .collect();
    module.unwrap_or_else(|| panic!("{}", messages.join("\n")))
}

/// The stimulus that the oracle's description gives.
fn input(name: &str, t_ms: u64) -> bool {
    match name {
        "Stop" | "TP1" => true,
        "Local:2:I.Data.8" => true,
        "Atmosphere" => false,
        "Start" => (1000..=1490).contains(&t_ms),
        "Pressure_Switch" => t_ms >= 1000,
        "TR" => t_ms >= 2000,
        other => panic!("no stimulus for {other}"),
    }
}

struct Machine<'m> {
    module: &'m Module,
    layout: Layout,
    engine: Interpreter,
    inputs: Vec<u8>,
    outputs: Vec<u8>,
}

impl<'m> Machine<'m> {
    fn new(module: &'m Module) -> Self {
        Self {
            layout: Layout::new(&module.types),
            engine: Interpreter::new(verify(module).expect("verified")),
            inputs: region_bytes(module, Region::Input),
            outputs: region_bytes(module, Region::Output),
            module,
        }
    }

    fn scan(&mut self, t_ms: u64) {
        let fields = &self.module.types.structs[self.module.input].fields;
        for (index, field) in fields.iter().enumerate() {
            let offset = self.layout.field_offset(self.module.input, index as u32);
            self.inputs[offset as usize] = u8::from(input(&field.name, t_ms));
        }
        let result = self
            .engine
            .step(t_ms * 1_000_000, &self.inputs, &mut self.outputs);
        result.expect("no fault");
    }

    /// The value of a column, which names a tag or the address of an output bit.
    fn value(&self, column: &str) -> i64 {
        let mut names: Vec<&str> = column.split('.').collect();
        let bit = names.last().and_then(|last| last.parse::<u32>().ok());
        if bit.is_some() {
            names.pop();
        }
        let types = &self.module.types;
        let place = Place::named(types, Root::State, self.module.state, &names)
            .unwrap_or_else(|| panic!("no {column}"));
        let (offset, ty, _) = self.layout.resolve(
            types,
            iecc_ir::MemType::Struct(self.module.state),
            &place.path,
        );
        let iecc_ir::MemType::Scalar(ty) = ty else {
            panic!("{column} is no scalar")
        };
        let bytes = &self.engine.state()[offset as usize..][..ty.bytes() as usize];
        let bits = bytes
            .iter()
            .rev()
            .fold(0, |bits, byte| bits << 8 | u64::from(*byte));
        match (bit, ty) {
            (Some(bit), _) => (bits >> bit & 1) as i64,
            (None, iecc_ir::Type::I1) => bits as i64,
            (None, _) => Scalar::new(ty, bits).signed(),
        }
    }
}

/// One line per scan in which a column changed, in the oracle's form.
fn trace(module: &Module, header: &str) -> String {
    let columns: Vec<&str> = header.split(',').skip(1).collect();
    let mut machine = Machine::new(module);
    let mut last: Vec<Option<i64>> = vec![None; columns.len()];
    let mut text = format!("{header}\n");
    for scan in 0..SCANS {
        let t_ms = scan * PERIOD_MS;
        machine.scan(t_ms);
        let mut line = String::new();
        for (column, last) in columns.iter().zip(&mut last) {
            let value = machine.value(column);
            if last.replace(value) != Some(value) {
                let _ = write!(line, " {column}={value}");
            }
        }
        if !line.is_empty() {
            let _ = writeln!(text, "{t_ms}{line}");
        }
    }
    text
}

fn agrees_with(file: &str, init: Init) {
    let Some(shared) = shared_dir() else { return };
    #[expect(clippy::disallowed_methods, reason = "tests read files")]
    let expected =
        std::fs::read_to_string(shared.join("oracle/ald").join(file)).expect("the oracle's trace");
    let module = module(&shared, init);
    let header = expected.lines().next().expect("a header");
    let found = trace(&module, header);
    for (number, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        assert_eq!(found, expected, "line {}", number + 1);
    }
    assert_eq!(found.lines().count(), expected.lines().count());
}

#[test]
fn a_cold_start_runs_a_batch_of_nine_cycles() {
    agrees_with("trace-cold.txt", Init::Cold);
}

#[test]
fn exported_values_keep_the_machine_from_sealing_in() {
    agrees_with("trace-export.txt", Init::Export);
}
