//! The types a Logix project defines, resolved in dependency order.
//!
//! A type that cannot be stored (an Add-On Instruction, an axis, a type the file does not define)
//! is no error: the reason is kept and given where the tag or member is used. BIT members become
//! BOOL leaves of their own, so the hidden integer that holds them in the vendor's memory is not
//! stored; naming it is refused. Nesting and size are bounded.

use crate::hir::{Elementary, MemberDef, StructDef, StructId, StructKind, Type, Types, Unusable};
use iecc_ast::logix::{DataMember, DataType, Project};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use std::collections::BTreeMap;

/// How deep structures may nest.
const MAX_DEPTH: u32 = 32;

/// Largest size of one type in bytes; the vendor's controllers allow 2 MB for a tag.
const MAX_TYPE_BYTES: u64 = 4 << 20;

/// The type, or the rest of a sentence that says why there is none.
pub(crate) type Usable = Result<Type, String>;

/// Named types of a project.
#[derive(Debug, Default)]
pub(crate) struct NamedTypes {
    pub(crate) table: Types,
    named: BTreeMap<String, Usable>,
    storage: BTreeMap<StructId, Vec<Slot>>,
    measures: BTreeMap<Type, Measure>,
}

/// One value of a structure in the order of storage, as bracketed data lists them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Slot {
    /// The value of a member, by position.
    Member(u32),
    /// An integer whose bits are members: bit and position of each.
    Bits(Vec<(u32, u32)>),
    /// Of a member that is not stored.
    Skipped,
}

/// Bounds of a type.
#[derive(Debug, Clone, Copy)]
struct Measure {
    depth: u32,
    bytes: u64,
}

impl NamedTypes {
    /// Collects all types of a project; doubled names and types that contain themselves are errors.
    pub(crate) fn collect(project: &Project, diagnostics: &mut Diagnostics) -> Self {
        let mut types = Self::default();
        types.add_predefined();
        for instruction in &project.instructions {
            let name = &instruction.name.node;
            let reason = format!(
                "is an instance of the Add-On Instruction `{name}`, which is not compiled yet"
            );
            types.named.insert(fold(name), Err(reason));
        }
        let unique = unique_types(project, diagnostics);
        Collector {
            types: &mut types,
            definitions: &unique,
            state: vec![State::New; unique.len()],
            diagnostics,
        }
        .run();
        types
    }

    fn add_predefined(&mut self) {
        let control = [
            ("EN", Elementary::Bool),
            ("EU", Elementary::Bool),
            ("DN", Elementary::Bool),
            ("EM", Elementary::Bool),
            ("ER", Elementary::Bool),
            ("UL", Elementary::Bool),
            ("IN", Elementary::Bool),
            ("FD", Elementary::Bool),
            ("LEN", Elementary::Dint),
            ("POS", Elementary::Dint),
        ];
        self.add_plain_members("CONTROL", StructKind::Control, &control);
        let counter = [
            ("CU", Elementary::Bool),
            ("CD", Elementary::Bool),
            ("DN", Elementary::Bool),
            ("OV", Elementary::Bool),
            ("UN", Elementary::Bool),
            ("PRE", Elementary::Dint),
            ("ACC", Elementary::Dint),
        ];
        self.add_plain_members("COUNTER", StructKind::Counter, &counter);
        // The time of the last execution; the vendor keeps it in bits of the flag word.
        let timer = [
            ("EN", Elementary::Bool),
            ("TT", Elementary::Bool),
            ("DN", Elementary::Bool),
            ("PRE", Elementary::Dint),
            ("ACC", Elementary::Dint),
            ("last", Elementary::Lint),
        ];
        self.add_plain_members("TIMER", StructKind::Timer, &timer);
        let bytes = Type::Array(self.table.array(Type::Elementary(Elementary::Sint), 82));
        let string = [("LEN", Type::Elementary(Elementary::Dint)), ("DATA", bytes)];
        self.add_members("STRING", StructKind::Plain, &string);
    }

    fn add_plain_members(&mut self, name: &str, kind: StructKind, members: &[(&str, Elementary)]) {
        let members: Vec<(&str, Type)> = members
            .iter()
            .map(|&(name, ty)| (name, Type::Elementary(ty)))
            .collect();
        self.add_members(name, kind, &members);
    }

    fn add_members(&mut self, name: &str, kind: StructKind, members: &[(&str, Type)]) {
        let members = members
            .iter()
            .map(|&(member, ty)| MemberDef {
                view: crate::hir::View::Number,
                name: member.to_owned(),
                ty,
                hidden: kind == StructKind::Timer && member == "last",
            })
            .collect();
        let def = StructDef {
            name: name.to_owned(),
            kind,
            members,
            unusable: Vec::new(),
        };
        let ty = self.add_struct(def);
        self.named.insert(fold(name), ty);
    }

    /// Adds a structure if it is within the bounds.
    pub(crate) fn add_struct(&mut self, def: StructDef) -> Usable {
        let measure = def
            .members
            .iter()
            .map(|member| self.measure(member.ty))
            .fold(Measure { depth: 0, bytes: 0 }, |a, b| Measure {
                depth: a.depth.max(b.depth),
                bytes: a.bytes.saturating_add(b.bytes),
            });
        let measure = Measure {
            depth: measure.depth + 1,
            ..measure
        };
        let name = def.name.clone();
        check_measure(&name, measure)?;
        if def.members.is_empty() {
            return Err(format!("has the type `{name}`, which has no usable member"));
        }
        let ty = Type::Struct(self.table.add_struct(def));
        self.measures.insert(ty, measure);
        Ok(ty)
    }

    fn measure(&self, ty: Type) -> Measure {
        match ty {
            Type::Elementary(elementary) => Measure {
                depth: 0,
                bytes: u64::from(elementary.bits().div_ceil(8)),
            },
            Type::Struct(_) => self.measures[&ty],
            Type::Array(id) => {
                let array = self.table.array_def(id);
                let element = self.measure(array.element);
                Measure {
                    depth: element.depth,
                    bytes: element.bytes.saturating_mul(u64::from(array.len)),
                }
            }
        }
    }

    /// How the bracketed data of a structure of the file is laid out.
    pub(crate) fn storage(&self, id: StructId) -> Option<&[Slot]> {
        self.storage.get(&id).map(Vec::as_slice)
    }

    /// Bytes that a value of the type takes, without padding.
    pub(crate) fn bytes(&self, ty: Type) -> u64 {
        self.measure(ty).bytes
    }

    /// The type with this name and these array lengths.
    pub(crate) fn resolve(&mut self, name: &str, dimensions: &[u32]) -> Usable {
        let base = self.lookup(name)?;
        self.array_of(base, dimensions)
    }

    fn lookup(&self, name: &str) -> Usable {
        if let Some(elementary) = Elementary::parse(name) {
            return Ok(Type::Elementary(elementary));
        }
        match self.named.get(&fold(name)) {
            Some(ty) => ty.clone(),
            None if is_vendor_type(name) => {
                Err(format!("has the type `{name}`, which is not compiled yet"))
            }
            None => Err(format!(
                "has the type `{name}`, which iecc does not know and the file does not define"
            )),
        }
    }

    /// An array of a type; no lengths, no array.
    pub(crate) fn array_of(&mut self, base: Type, dimensions: &[u32]) -> Usable {
        let mut ty = base;
        for &len in dimensions.iter().rev() {
            if len == 0 {
                return Err("has an array length of 0".to_owned());
            }
            ty = Type::Array(self.table.array(ty, len));
            check_measure(&self.table.name(ty), self.measure(ty))?;
        }
        Ok(ty)
    }

    /// A structure that a module brings, shared where name and members are the same.
    pub(crate) fn module_struct(&mut self, name: &str, members: Vec<MemberDef>) -> Usable {
        let same = |def: &StructDef| def.name.starts_with(name) && def.members == members;
        let found: Option<StructId> = self
            .table
            .structs()
            .find(|(_, def)| same(def))
            .map(|(id, _)| id);
        if let Some(id) = found {
            return Ok(Type::Struct(id));
        }
        let taken = |name: &str| self.table.structs().any(|(_, def)| def.name == name);
        let name = (1..)
            .map(|n| {
                if n == 1 {
                    name.to_owned()
                } else {
                    format!("{name}#{n}")
                }
            })
            .find(|name| !taken(name))
            .expect("some number is free");
        self.add_struct(StructDef {
            name,
            kind: StructKind::Plain,
            members,
            unusable: Vec::new(),
        })
    }
}

fn check_measure(name: &str, measure: Measure) -> Result<(), String> {
    if measure.depth > MAX_DEPTH {
        return Err(format!(
            "has the type `{name}`, whose structures nest deeper than {MAX_DEPTH}"
        ));
    }
    if measure.bytes > MAX_TYPE_BYTES {
        return Err(format!(
            "has the type `{name}`, which is larger than {MAX_TYPE_BYTES} bytes"
        ));
    }
    Ok(())
}

/// Types that the vendor's controllers know without a definition.
fn is_vendor_type(name: &str) -> bool {
    const STARTS: [&str; 14] = [
        "ALARM",
        "AXIS_",
        "CAM",
        "COORDINATE_SYSTEM",
        "DATALOG_",
        "EXT_ROUTINE_",
        "FBD_",
        "HMIBC",
        "MESSAGE",
        "MOTION_",
        "PHASE",
        "PID",
        "SERIAL_PORT_CONTROL",
        "SFC_",
    ];
    let name = name.to_ascii_uppercase();
    STARTS.iter().any(|start| name.starts_with(start))
}

/// Names are compared ignoring ASCII case everywhere.
pub(crate) fn fold(name: &str) -> String {
    name.to_ascii_lowercase()
}

fn unique_types<'p>(project: &'p Project, diagnostics: &mut Diagnostics) -> Vec<&'p DataType> {
    let mut seen: BTreeMap<String, &DataType> = BTreeMap::new();
    let mut unique = Vec::new();
    for definition in &project.data_types {
        match seen.get(&fold(&definition.name.node)) {
            Some(first) => diagnostics.push(duplicate("data type", &definition.name, &first.name)),
            None => {
                seen.insert(fold(&definition.name.node), definition);
                unique.push(definition);
            }
        }
    }
    unique
}

/// The message for a second declaration of a name.
pub(crate) fn duplicate(what: &str, second: &iecc_ast::Name, first: &iecc_ast::Name) -> Diagnostic {
    let message = format!("the {what} `{}` is declared twice", second.node);
    Diagnostic::new(Code::E1003, second.span, message)
        .label("declared again here")
        .also(first.span, "first declared here")
        .note("names are compared ignoring upper and lower case")
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    Open,
    Done,
}

/// Builds types depth first on an explicit stack, because the user decides how deep they depend.
struct Collector<'t, 'p> {
    types: &'t mut NamedTypes,
    definitions: &'t [&'p DataType],
    state: Vec<State>,
    diagnostics: &'t mut Diagnostics,
}

impl Collector<'_, '_> {
    fn run(mut self) {
        let index: BTreeMap<String, usize> = self
            .definitions
            .iter()
            .enumerate()
            .map(|(index, definition)| (fold(&definition.name.node), index))
            .collect();
        for start in 0..self.definitions.len() {
            let mut stack = vec![start];
            while let Some(&top) = stack.last() {
                match self.state[top] {
                    State::New => {
                        self.state[top] = State::Open;
                        self.open(top, &index, &mut stack);
                    }
                    State::Open => {
                        self.build(top);
                        self.state[top] = State::Done;
                        stack.pop();
                    }
                    State::Done => {
                        stack.pop();
                    }
                }
            }
        }
    }

    fn open(&mut self, top: usize, index: &BTreeMap<String, usize>, stack: &mut Vec<usize>) {
        let definition = self.definitions[top];
        for member in &definition.members {
            let Some(&needed) = index.get(&fold(&member.data_type.node)) else {
                continue;
            };
            match self.state[needed] {
                State::New => stack.push(needed),
                State::Open => self.contains_itself(definition, member),
                State::Done => {}
            }
        }
    }

    fn contains_itself(&mut self, definition: &DataType, member: &DataMember) {
        let message = format!(
            "the data type `{}` contains itself through `{}`",
            definition.name.node, member.name.node
        );
        self.diagnostics.push(
            Diagnostic::new(Code::E2009, member.data_type.span, message)
                .also(definition.name.span, "the type is declared here"),
        );
    }

    fn build(&mut self, top: usize) {
        let definition = self.definitions[top];
        let mut def = StructDef {
            name: definition.name.node.clone(),
            kind: StructKind::Plain,
            members: Vec::new(),
            unusable: Vec::new(),
        };
        let mut seen: BTreeMap<String, &DataMember> = BTreeMap::new();
        for member in &definition.members {
            if let Some(first) = seen.insert(fold(&member.name.node), member) {
                self.diagnostics
                    .push(duplicate("member", &member.name, &first.name));
                continue;
            }
            match self.member_type(member) {
                Ok(ty) => def.members.push(MemberDef {
                    view: crate::hir::View::Number,
                    name: member.name.node.clone(),
                    ty,
                    hidden: false,
                }),
                Err(reason) => def.unusable.push(Unusable {
                    name: member.name.node.clone(),
                    reason,
                }),
            }
        }
        let storage = storage_of(definition, &def);
        let ty = self.types.add_struct(def);
        if let Ok(Type::Struct(id)) = ty {
            self.types.storage.insert(id, storage);
        }
        self.types.named.insert(fold(&definition.name.node), ty);
    }

    fn member_type(&mut self, member: &DataMember) -> Usable {
        if member.hidden {
            return Err("is the hidden storage of BIT members; use these instead".to_owned());
        }
        if member.data_type.node.eq_ignore_ascii_case("BIT") {
            return Ok(Type::Elementary(Elementary::Bool));
        }
        let dimensions: Vec<u32> = member.dimension.into_iter().collect();
        self.types.resolve(&member.data_type.node, &dimensions)
    }
}

/// BIT members are bits of a hidden member that stands before them.
fn storage_of(definition: &DataType, def: &StructDef) -> Vec<Slot> {
    let mut slots = Vec::new();
    let mut hosts: BTreeMap<String, usize> = BTreeMap::new();
    for member in &definition.members {
        let position = def.member(&member.name.node);
        match (&member.bit_of, position) {
            (Some((host, bit)), Some(position)) => {
                let host = hosts.get(&fold(&host.node)).map(|at| &mut slots[*at]);
                if let Some(Slot::Bits(bits)) = host {
                    bits.push((*bit, position));
                }
            }
            (Some(_), None) => {}
            (None, _) if member.hidden => {
                hosts.insert(fold(&member.name.node), slots.len());
                slots.push(Slot::Bits(Vec::new()));
            }
            (None, Some(position)) => slots.push(Slot::Member(position)),
            (None, None) => slots.push(Slot::Skipped),
        }
    }
    slots
}
