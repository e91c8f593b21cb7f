//! Small ladder programs and what they do, scan by scan, in a few lines of text.
//!
//! A [`Source`] writes the export around tags and rungs; [`Bench`] compiles it with the pipeline
//! that users run and steps it on the reference interpreter and, after the passes, as machine code:
//! both have to do the same. A script has one line per scan:
//!
//! ```text
//! prescan        | t.ACC=0            before the first scan
//! a=1            | t.EN=1 t.ACC=0     set tags, scan, expect tags
//! +25ms          | t.ACC=25           time that passes before the scan, 10ms unless said
//! 3:             | t.DN=1             as many scans, expected after each
//! ```
//!
//! Values are whole numbers, or floats with a point. Only what the line names is compared.

use crate::runs::machine_code;
use iecc_diag::{Code, Diagnostics, Severity, render_text};
use iecc_driver::{FrontOptions, Sources, compile};
use iecc_interp::Interpreter;
use iecc_ir::{
    FaultCode, Index, Layout, MemType, Module, Place, Projection, Region, Root, StructId, Type,
    verify,
};
use iecc_jit::Jit;
use iecc_source::SourceMap;
use iecc_target::{Engine, region_bytes};
use std::fmt::Write;

/// The text of an export, piece by piece.
#[derive(Debug, Clone, Default)]
pub struct Source {
    types: String,
    modules: String,
    tags: String,
    program_tags: String,
    main: Vec<String>,
    routines: String,
    programs: String,
    test_edits: bool,
    extra_tasks: String,
    scheduled: Vec<String>,
    instructions: String,
}

impl Source {
    /// A program `Main` with an empty routine `Main`.
    pub fn new() -> Self {
        Self::default()
    }

    /// A main routine with these rungs.
    pub fn rungs(rungs: &[&str]) -> Self {
        rungs
            .iter()
            .fold(Self::new(), |source, rung| source.rung(rung))
    }

    /// Controller tags, `;` between them: `a BOOL; n INT = 5; t TIMER PRE=20; x DINT[4]`.
    #[must_use]
    pub fn tags(mut self, declarations: &str) -> Self {
        self.tags += &declared(declarations);
        self
    }

    /// Tags of the program `Main`, declared in the same way.
    #[must_use]
    pub fn program_tags(mut self, declarations: &str) -> Self {
        self.program_tags += &declared(declarations);
        self
    }

    /// An alias.
    #[must_use]
    pub fn alias(mut self, name: &str, target: &str) -> Self {
        let _ = writeln!(
            self.tags,
            "<Tag Name=\"{name}\" TagType=\"Alias\" AliasFor=\"{target}\"/>"
        );
        self
    }

    /// A `<Tag>` element as it is.
    #[must_use]
    pub fn tag_xml(mut self, xml: &str) -> Self {
        self.tags += xml;
        self
    }

    /// `<DataType>` elements as they are.
    #[must_use]
    pub fn types(mut self, xml: &str) -> Self {
        self.types += xml;
        self
    }

    /// `<AddOnInstructionDefinition>` elements as they are.
    #[must_use]
    pub fn instructions(mut self, xml: &str) -> Self {
        self.instructions += xml;
        self
    }

    /// `<Module>` elements as they are.
    #[must_use]
    pub fn modules(mut self, xml: &str) -> Self {
        self.modules += xml;
        self
    }

    /// One more rung in the main routine.
    #[must_use]
    pub fn rung(self, text: &str) -> Self {
        self.edit("N", text)
    }

    /// A rung with an edit state.
    #[must_use]
    pub fn edit(mut self, kind: &str, text: &str) -> Self {
        let rung = rung(self.main.len(), kind, text);
        self.main.push(rung);
        self
    }

    /// Test edits were active at export.
    #[must_use]
    pub fn test_edits(mut self) -> Self {
        self.test_edits = true;
        self
    }

    /// One more routine in the program `Main`.
    #[must_use]
    pub fn routine(mut self, name: &str, rungs: &[&str]) -> Self {
        self.routines += &routine(name, rungs);
        self
    }

    /// One more program, with a main routine `Main`; scheduled behind the others or not.
    #[must_use]
    pub fn program(mut self, name: &str, tags: &str, rungs: &[&str], scheduled: bool) -> Self {
        let _ = write!(
            self.programs,
            "<Program Name=\"{name}\" TestEdits=\"false\" MainRoutineName=\"Main\" Disabled=\"false\">\n\
             <Tags>\n{}</Tags>\n<Routines>\n{}</Routines>\n</Program>\n",
            declared(tags),
            routine("Main", rungs)
        );
        if scheduled {
            self.scheduled.push(name.to_owned());
        }
        self
    }

    /// `<Task>` elements behind the one that runs `Main`.
    #[must_use]
    pub fn tasks(mut self, xml: &str) -> Self {
        self.extra_tasks += xml;
        self
    }

    /// The export.
    pub fn xml(&self) -> String {
        let scheduled: String = std::iter::once("Main")
            .chain(self.scheduled.iter().map(String::as_str))
            .map(|name| format!("<ScheduledProgram Name=\"{name}\"/>\n"))
            .collect();
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n\
             <RSLogix5000Content SchemaRevision=\"1.0\" SoftwareRevision=\"34.00\" TargetName=\"Bench\" TargetType=\"Controller\" ContainsContext=\"false\">\n\
             <Controller Use=\"Target\" Name=\"Bench\">\n\
             <DataTypes>\n{}</DataTypes>\n<Modules>\n{}</Modules>\n\
             <AddOnInstructionDefinitions>\n{}</AddOnInstructionDefinitions>\n<Tags>\n{}</Tags>\n\
             <Programs>\n\
             <Program Name=\"Main\" TestEdits=\"{}\" MainRoutineName=\"Main\" Disabled=\"false\">\n\
             <Tags>\n{}</Tags>\n<Routines>\n\
             <Routine Name=\"Main\" Type=\"RLL\">\n<RLLContent>\n{}</RLLContent>\n</Routine>\n\
             {}</Routines>\n</Program>\n{}</Programs>\n<Tasks>\n\
             <Task Name=\"MainTask\" Type=\"CONTINUOUS\" Priority=\"10\" Watchdog=\"500\" DisableUpdateOutputs=\"false\" InhibitTask=\"false\">\n\
             <ScheduledPrograms>\n{scheduled}</ScheduledPrograms>\n</Task>\n{}</Tasks>\n</Controller>\n</RSLogix5000Content>\n",
            self.types,
            self.modules,
            self.instructions,
            self.tags,
            self.test_edits,
            self.program_tags,
            self.main.concat(),
            self.routines,
            self.programs,
            self.extra_tasks
        )
    }
}

fn rung(number: usize, kind: &str, text: &str) -> String {
    format!(
        "<Rung Number=\"{number}\" Type=\"{kind}\">\n<Text>\n<![CDATA[{text}]]>\n</Text>\n</Rung>\n"
    )
}

fn routine(name: &str, rungs: &[&str]) -> String {
    let rungs: String = rungs
        .iter()
        .enumerate()
        .map(|(number, text)| rung(number, "N", text))
        .collect();
    format!(
        "<Routine Name=\"{name}\" Type=\"RLL\">\n<RLLContent>\n{rungs}</RLLContent>\n</Routine>\n"
    )
}

fn declared(declarations: &str) -> String {
    let each = declarations.split(';').map(str::trim);
    each.filter(|text| !text.is_empty()).map(tag).collect()
}

/// `name TYPE`, `name TYPE[4]`, `name TYPE = value`, `name TYPE MEMBER=value …`.
fn tag(declaration: &str) -> String {
    let (head, value) = match declaration.split_once(" = ") {
        Some((head, value)) => (head, Some(value.trim())),
        None => (declaration, None),
    };
    let mut words = head.split_whitespace();
    let (name, ty) = (words.next().unwrap(), words.next().unwrap());
    let (ty, dimensions) = match ty.split_once('[') {
        Some((ty, rest)) => (ty, rest.trim_end_matches(']').replace(',', " ")),
        None => (ty, String::new()),
    };
    let members: Vec<(&str, &str)> = words.map(|word| word.split_once('=').unwrap()).collect();
    let data = match value {
        Some(value) => format!("<DataValue DataType=\"{ty}\" Value=\"{value}\"/>"),
        None if members.is_empty() => String::new(),
        None => structure(ty, &members),
    };
    let data = if data.is_empty() {
        data
    } else {
        format!("<Data Format=\"Decorated\">{data}</Data>")
    };
    let dimensions = if dimensions.is_empty() {
        dimensions
    } else {
        format!(" Dimensions=\"{dimensions}\"")
    };
    format!("<Tag Name=\"{name}\" TagType=\"Base\" DataType=\"{ty}\"{dimensions}>{data}</Tag>\n")
}

fn structure(ty: &str, members: &[(&str, &str)]) -> String {
    let members: String = members
        .iter()
        .map(|(name, value)| {
            let wide = matches!(*name, "PRE" | "ACC" | "LEN" | "POS");
            let ty = if wide { "DINT" } else { "BOOL" };
            format!("<DataValueMember Name=\"{name}\" DataType=\"{ty}\" Value=\"{value}\"/>")
        })
        .collect();
    format!("<Structure DataType=\"{ty}\">{members}</Structure>")
}

/// What compiling an export gives: a module, or rendered messages; and the codes of all messages.
pub fn compile_xml(xml: &str, options: &FrontOptions) -> (Result<Module, String>, Vec<Code>) {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let file = map.add("bench.L5X", xml);
    let sources = Sources::logix(&mut map, file);
    let module = compile(&map, &sources, options, &mut diagnostics);
    let codes = diagnostics
        .iter()
        .map(|diagnostic| diagnostic.code)
        .collect();
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
    let text: String = errors.map(|d| render_text(&map, d, false)).collect();
    (module.ok_or(text), codes)
}

/// A compiled program on the reference interpreter.
pub struct Bench {
    module: Module,
    layout: Layout,
    engine: Interpreter,
    machine_code: Jit,
    inputs: Vec<u8>,
    outputs: Vec<u8>,
    next_ns: u64,
}

impl Bench {
    /// Compiles a source with default options.
    ///
    /// # Panics
    /// If it has errors.
    pub fn new(source: &Source) -> Self {
        Self::with(source, &FrontOptions::default())
    }

    /// Compiles a source.
    ///
    /// # Panics
    /// If it has errors.
    pub fn with(source: &Source, options: &FrontOptions) -> Self {
        let module = compile_xml(&source.xml(), options).0;
        Self::of(module.unwrap_or_else(|errors| panic!("{errors}")))
    }

    /// A compiled module.
    pub fn of(module: Module) -> Self {
        Self {
            layout: Layout::new(&module.types),
            engine: Interpreter::new(verify(&module).expect("the pipeline verifies")),
            machine_code: machine_code(module.clone()),
            inputs: region_bytes(&module, Region::Input),
            outputs: region_bytes(&module, Region::Output),
            next_ns: 0,
            module,
        }
    }

    /// The module.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// Runs a script; see the head of this file.
    ///
    /// # Panics
    /// Where the program does something else than the script says.
    pub fn run(&mut self, script: &str) {
        for line in script
            .lines()
            .map(str::trim)
            .filter(|line| !line.is_empty())
        {
            let (before, after) = line.split_once('|').expect("`set | expect`");
            self.line(line, before.trim(), after);
        }
    }

    fn line(&mut self, line: &str, before: &str, after: &str) {
        if before == "prescan" {
            return self.expect(line, after);
        }
        let mut scans = 1;
        for word in before.split_whitespace() {
            if let Some(count) = word.strip_suffix(':') {
                scans = count.parse().expect("a number of scans");
            } else if let Some(time) = word.strip_prefix('+') {
                let time = time.strip_suffix("ms").expect("`+25ms`");
                let passed: u64 = time.parse().expect("milliseconds");
                self.next_ns = self.next_ns.saturating_sub(10_000_000) + passed * 1_000_000;
            } else {
                let (path, value) = word.split_once('=').expect("`tag=value`");
                self.set(path, value);
            }
        }
        for _ in 0..scans {
            self.scan();
            self.expect(line, after);
        }
    }

    fn expect(&self, line: &str, after: &str) {
        for word in after.split_whitespace() {
            let (path, value) = word.split_once('=').expect("`tag=value`");
            let (ty, bits) = self.get(path);
            assert_eq!(
                show(ty, bits),
                show(ty, parse(ty, value)),
                "{path} in `{line}` at {} ms",
                self.next_ns / 1_000_000
            );
        }
    }

    fn scan(&mut self) {
        let fault = self.step();
        assert_eq!(fault, None, "at {} ms", self.next_ns / 1_000_000);
    }

    /// Tries one scan that is to end in a fault.
    pub fn scan_faults(&mut self) -> bool {
        self.step().is_some()
    }

    /// One scan on both engines, which have to agree.
    fn step(&mut self) -> Option<FaultCode> {
        let mut outputs = self.outputs.clone();
        let second = self
            .machine_code
            .step(self.next_ns, &self.inputs, &mut outputs);
        let first = self
            .engine
            .step(self.next_ns, &self.inputs, &mut self.outputs);
        let (first, second) = (first.err().map(|f| f.code), second.err().map(|f| f.code));
        assert_eq!(first, second, "fault of interpreter and machine code");
        assert_eq!(self.outputs, outputs, "outputs of both");
        assert_eq!(
            self.engine.state(),
            self.machine_code.state(),
            "state of both"
        );
        self.next_ns += 10_000_000;
        first
    }

    /// Where a path leads: a public input or output first, else a tag.
    fn resolve(&self, path: &str) -> (Root, u64, Type, Option<u32>) {
        let regions = [
            (Root::Input, self.module.input),
            (Root::Output, self.module.output),
            (Root::State, self.module.state),
        ];
        let found = regions
            .into_iter()
            .find_map(|(root, region)| Some((root, region, self.place(region, path)?)));
        let (root, region, place) = found.unwrap_or_else(|| panic!("no tag or point {path}"));
        let start = MemType::Struct(region);
        let (offset, ty, bit) = self.layout.resolve(&self.module.types, start, &place);
        let MemType::Scalar(ty) = ty else {
            panic!("{path} is not one value")
        };
        (root, offset, ty, bit)
    }

    /// The path into a region: the longest field name that fits, then members, indexes, a bit.
    fn place(&self, region: StructId, path: &str) -> Option<Vec<Projection>> {
        let fields = &self.module.types.structs[region].fields;
        let starts = |name: &str| {
            path.strip_prefix(name)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        let (index, field) = fields
            .iter()
            .enumerate()
            .filter(|(_, field)| starts(&field.name))
            .max_by_key(|(_, field)| field.name.len())?;
        let mut steps = vec![Projection::Field(index as u32)];
        let rest = path[field.name.len()..]
            .replace(']', "")
            .replace(['[', ','], ".");
        for word in rest.split('.').skip(1) {
            let so_far = Place::walk(&self.module.types, MemType::Struct(region), &steps)?;
            let iecc_ir::PlaceType::Mem(mem) = so_far else {
                return None;
            };
            steps.push(match mem {
                MemType::Struct(id) => {
                    Projection::Field(self.module.types.structs[id].field(word)?)
                }
                MemType::Array(_) => Projection::Index(Index::Const(word.parse().ok()?)),
                MemType::Scalar(_) => Projection::Bit(Index::Const(word.parse().ok()?)),
            });
        }
        Some(steps)
    }

    fn get(&self, path: &str) -> (Type, u64) {
        let (root, offset, ty, bit) = self.resolve(path);
        let bytes = match root {
            Root::Input => &self.inputs,
            Root::Output => &self.outputs,
            Root::State | Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => self.engine.state(),
        };
        let word = read(bytes, offset, ty);
        match bit {
            Some(bit) => (Type::I1, word >> bit & 1),
            None => (ty, word),
        }
    }

    fn set(&mut self, path: &str, value: &str) {
        let (root, offset, ty, bit) = self.resolve(path);
        let mut state = self.engine.state().to_vec();
        let bytes = match root {
            Root::Input => &mut self.inputs,
            Root::Output => panic!("{path} is an output"),
            Root::State | Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => &mut state,
        };
        let bits = match bit {
            Some(bit) => {
                let word = read(bytes, offset, ty) & !(1 << bit);
                word | parse(Type::I1, value) << bit
            }
            None => parse(ty, value),
        };
        let width = ty.bytes() as usize;
        bytes[offset as usize..][..width].copy_from_slice(&bits.to_le_bytes()[..width]);
        self.engine.set_state(&state);
        self.machine_code.set_state(&state);
    }
}

fn read(bytes: &[u8], offset: u64, ty: Type) -> u64 {
    let bytes = &bytes[offset as usize..][..ty.bytes() as usize];
    bytes
        .iter()
        .rev()
        .fold(0, |bits, byte| bits << 8 | u64::from(*byte))
}

fn parse(ty: Type, text: &str) -> u64 {
    match ty {
        Type::F32 => u64::from(text.parse::<f32>().expect("a float").to_bits()),
        Type::F64 => text.parse::<f64>().expect("a float").to_bits(),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => {
            text.parse::<i128>().expect("a whole number") as u64 & ty.mask()
        }
    }
}

fn show(ty: Type, bits: u64) -> String {
    match ty {
        Type::F32 => f32::from_bits(bits as u32).to_string(),
        Type::F64 => f64::from_bits(bits).to_string(),
        Type::I1 => bits.to_string(),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => ty.signed(bits).to_string(),
    }
}

/// Compiles rungs with controller tags and runs a script over them.
///
/// # Panics
/// Where the program does something else than the script says.
pub fn check(tags: &str, rungs: &[&str], script: &str) {
    Bench::new(&Source::rungs(rungs).tags(tags)).run(script);
}
