//! C structs with the layout of the regions, padding written out.

use super::names::{Names, comment};
use iecc_ir::{FieldDef, Layout, MemType, Module, StructId, Type, View};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// A struct of the header.
#[derive(Debug, Clone)]
pub(super) struct CStruct {
    /// Its name.
    pub(super) name: String,
    /// Bytes it takes.
    pub(super) bytes: u64,
    /// Its members: identifier and offset.
    pub(super) members: Vec<(String, u64)>,
    /// The lines between its braces.
    lines: String,
}

impl CStruct {
    /// Its definition. C knows no struct without members.
    pub(super) fn definition(&self) -> String {
        let lines = if self.members.is_empty() {
            "    char none; /* nothing: its bytes are never used */\n"
        } else {
            &self.lines
        };
        format!("typedef struct {0} {{\n{lines}}} {0};\n", self.name)
    }
}

/// Makes the structs of a module.
pub(super) struct Structs<'m> {
    module: &'m Module,
    layout: Layout,
    names: Names,
    prefix: String,
    known: BTreeMap<StructId, String>,
    /// In the order C needs them.
    pub(super) nested: Vec<CStruct>,
}

impl<'m> Structs<'m> {
    /// Names of structs begin with `prefix_`, and none is in `names`.
    pub(super) fn new(module: &'m Module, prefix: &str, names: Names) -> Self {
        Self {
            module,
            layout: Layout::new(&module.types),
            names,
            prefix: prefix.to_owned(),
            known: BTreeMap::new(),
            nested: Vec::new(),
        }
    }

    /// The struct of a region under a name of its own; those it contains become nested ones.
    pub(super) fn region(&mut self, id: StructId, name: &str) -> CStruct {
        for inner in self.contained(id) {
            if !self.known.contains_key(&inner) {
                let def = &self.module.types.structs[inner];
                let name = self.names.claim(&format!("{}_{}", self.prefix, def.name));
                let made = self.make(inner, &name);
                self.known.insert(inner, name);
                self.nested.push(made);
            }
        }
        self.make(id, name)
    }

    /// The structs in a struct, in the order of the table: each after those it contains.
    fn contained(&self, id: StructId) -> BTreeSet<StructId> {
        let types = &self.module.types;
        let mut needed = BTreeSet::from([id]);
        // Structs contain only those before them, so one walk backwards sees all.
        for (outer, def) in types.structs.iter().rev() {
            if needed.contains(&outer) {
                needed.extend(def.fields.iter().filter_map(
                    |field| match self.element(field.ty).0 {
                        MemType::Struct(id) => Some(id),
                        MemType::Scalar(_) | MemType::Array(_) => None,
                    },
                ));
            }
        }
        needed.remove(&id);
        needed
    }

    /// What an array holds in the end, and its dimensions in the order of C.
    fn element(&self, mut ty: MemType) -> (MemType, String) {
        let mut dimensions = String::new();
        while let MemType::Array(id) = ty {
            let array = self.module.types.array_type(id);
            let _ = write!(dimensions, "[{}]", array.len);
            ty = array.element;
        }
        (ty, dimensions)
    }

    fn make(&self, id: StructId, name: &str) -> CStruct {
        let types = &self.module.types;
        let mut made = CStruct {
            name: name.to_owned(),
            bytes: self.layout.size(types, MemType::Struct(id)),
            members: Vec::new(),
            lines: String::new(),
        };
        let (mut names, mut at) = (Names::default(), 0);
        let fields = &types.structs[id].fields;
        // Before any padding is named, so that no name of the user gives way.
        let members: Vec<String> = fields
            .iter()
            .map(|field| names.claim(&field.name))
            .collect();
        for (index, (field, member)) in fields.iter().zip(members).enumerate() {
            let size = self.layout.size(types, field.ty);
            let offset = self.layout.field_offset(id, index as u32);
            if size == 0 {
                let _ = writeln!(made.lines, "    /* {}: nothing */", comment(&field.name));
                continue;
            }
            pad(&mut made, &mut names, offset - at);
            at = offset + size;
            self.member(&mut made, &member, field);
            made.members.push((member, offset));
        }
        let rest = made.bytes - at;
        pad(&mut made, &mut names, rest);
        made
    }

    fn member(&self, made: &mut CStruct, member: &str, field: &FieldDef) {
        let (element, dimensions) = self.element(field.ty);
        let type_name = match element {
            MemType::Scalar(scalar) => scalar_name(scalar, field.view),
            MemType::Struct(id) => &self.known[&id],
            MemType::Array(_) => panic!("elements are no arrays"),
        };
        let _ = write!(made.lines, "    {type_name} {member}{dimensions};");
        let name = (member != field.name).then(|| comment(&field.name));
        let notes: Vec<&str> = name
            .as_deref()
            .into_iter()
            .chain(unit(field.view))
            .collect();
        if !notes.is_empty() {
            let _ = write!(made.lines, " /* {} */", notes.join("; "));
        }
        made.lines.push('\n');
    }
}

fn pad(made: &mut CStruct, names: &mut Names, bytes: u64) {
    if bytes > 0 {
        let name = names.claim("padding");
        let _ = writeln!(made.lines, "    uint8_t {name}[{bytes}];");
    }
}

fn scalar_name(ty: Type, view: View) -> &'static str {
    let signed = match view {
        View::Unsigned | View::Bits => false,
        View::Plain | View::Time | View::Date | View::TimeOfDay | View::DateTime => true,
    };
    match (ty, signed) {
        (Type::I1, _) => "bool",
        (Type::I8, true) => "int8_t",
        (Type::I8, false) => "uint8_t",
        (Type::I16, true) => "int16_t",
        (Type::I16, false) => "uint16_t",
        (Type::I32, true) => "int32_t",
        (Type::I32, false) => "uint32_t",
        (Type::I64, true) => "int64_t",
        (Type::I64, false) => "uint64_t",
        (Type::F32, _) => "float",
        (Type::F64, _) => "double",
    }
}

/// What a number counts, where its type does not say.
fn unit(view: View) -> Option<&'static str> {
    match view {
        View::Plain | View::Unsigned | View::Bits => None,
        View::Time => Some("nanoseconds"),
        View::Date | View::DateTime => Some("nanoseconds since 1970-01-01"),
        View::TimeOfDay => Some("nanoseconds since midnight"),
    }
}
