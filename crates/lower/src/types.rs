//! Types and places: the IR's are the program's, one to one, field by field.

use iecc_ir::{FieldDef, Index, MemType, Place, Projection, Root, StructId, Type, TypeTable};
use iecc_sema::hir::{self, Elementary, Step};
use std::collections::BTreeMap;

/// The IR's types, made as they are needed.
pub(crate) struct TypeMap<'p> {
    program: &'p hir::Program,
    table: TypeTable,
    structs: BTreeMap<hir::StructId, StructId>,
}

impl<'p> TypeMap<'p> {
    pub(crate) fn new(program: &'p hir::Program) -> Self {
        Self {
            program,
            table: TypeTable::default(),
            structs: BTreeMap::new(),
        }
    }

    pub(crate) fn table(&self) -> &TypeTable {
        &self.table
    }

    pub(crate) fn into_table(self) -> TypeTable {
        self.table
    }

    /// The state: one field per tag, in the order of tags.
    pub(crate) fn state_struct(&mut self) -> StructId {
        let program = self.program;
        let fields = program
            .tags
            .iter()
            .map(|tag| FieldDef::new(tag.name.clone(), self.mem_type(tag.ty)))
            .collect();
        self.table.add_struct("state", fields)
    }

    /// The inputs or outputs: one field per point.
    pub(crate) fn io_struct(&mut self, name: &str, points: &[hir::IoPoint]) -> StructId {
        let fields = points
            .iter()
            .map(|point| {
                let ty = self.mem_type(self.program.type_of(&point.place));
                FieldDef::new(point.name.clone(), ty)
            })
            .collect();
        self.table.add_struct(name, fields)
    }

    /// Recursion is bounded by the depth of types.
    pub(crate) fn mem_type(&mut self, ty: hir::Type) -> MemType {
        match ty {
            hir::Type::Elementary(elementary) => MemType::Scalar(scalar(elementary)),
            hir::Type::Array(id) => {
                let array = self.program.types.array_def(id);
                let element = self.mem_type(array.element);
                MemType::Array(self.table.array(element, array.len))
            }
            hir::Type::Struct(id) => MemType::Struct(self.struct_type(id)),
        }
    }

    fn struct_type(&mut self, id: hir::StructId) -> StructId {
        if let Some(&known) = self.structs.get(&id) {
            return known;
        }
        let def = self.program.types.struct_def(id);
        let fields = def
            .members
            .iter()
            .map(|member| FieldDef::new(member.name.clone(), self.mem_type(member.ty)))
            .collect();
        let made = self.table.add_struct(struct_name(&def.name), fields);
        self.structs.insert(id, made);
        made
    }

    /// The predefined structure with this name.
    pub(crate) fn predefined(&mut self, name: &str) -> StructId {
        let mut structs = self.program.types.structs();
        let found = structs.find(|(_, def)| def.name == name);
        let (id, _) = found.expect("library code uses predefined structures");
        self.struct_type(id)
    }
}

/// A structure's name that is neither a region nor a value type in the text form.
fn struct_name(name: &str) -> String {
    let reserved = ["state", "input", "output"].contains(&name) || Type::parse(name).is_some();
    if reserved {
        format!("{name}'")
    } else {
        name.to_owned()
    }
}

/// The IR's type of a value.
pub(crate) fn scalar(ty: Elementary) -> Type {
    match ty {
        Elementary::Bool => Type::I1,
        Elementary::Sint | Elementary::Usint => Type::I8,
        Elementary::Int | Elementary::Uint => Type::I16,
        Elementary::Dint | Elementary::Udint => Type::I32,
        Elementary::Lint | Elementary::Ulint => Type::I64,
        Elementary::Real => Type::F32,
        Elementary::Lreal => Type::F64,
    }
}

/// A place in the state.
pub(crate) fn place(place: &hir::Place) -> Place {
    let start = Place::root(Root::State).field(place.tag.index() as u32);
    let steps: Vec<Projection> = place
        .path
        .iter()
        .map(|step| match *step {
            Step::Field(index) => Projection::Field(index),
            Step::Index(index) => Projection::Index(Index::Const(index)),
            Step::Bit(bit) => Projection::Bit(Index::Const(bit)),
        })
        .collect();
    start.join(&steps)
}
