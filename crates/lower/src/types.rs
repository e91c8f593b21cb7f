//! Types and places: the IR's are the program's, one to one, field by field.

use crate::fresh;
use iecc_ir::{FieldDef, Index, MemType, Place, Projection, Root, StructId, Type, TypeTable, View};
use iecc_sema::hir::{self, Body, Elementary, Pou, Step};
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

    /// One field of the state per tag, in the order of tags.
    pub(crate) fn tag_fields(&mut self) -> Vec<FieldDef> {
        let tags = self.program.tags.iter();
        tags.map(|tag| self.field(&tag.name, tag.ty, tag.view))
            .collect()
    }

    /// The state.
    pub(crate) fn state_struct(&mut self, fields: Vec<FieldDef>) -> StructId {
        self.table.add_struct("state", fields)
    }

    /// A structure of our own.
    pub(crate) fn hidden(&mut self, name: &str, fields: Vec<FieldDef>) -> StructId {
        let program = self.program;
        let taken = |name: &str| program.types.structs().any(|(_, def)| def.name == name);
        self.table.add_struct(fresh(name, taken), fields)
    }

    /// The inputs or outputs: one field per point.
    pub(crate) fn io_struct(&mut self, name: &str, points: &[hir::IoPoint]) -> StructId {
        let program = self.program;
        let fields = points
            .iter()
            .map(|point| {
                let ty = program.type_of(&point.place);
                self.field(&point.name, ty, seen(program, &point.place))
            })
            .collect();
        self.table.add_struct(name, fields)
    }

    fn field(&mut self, name: &str, ty: hir::Type, seen: hir::View) -> FieldDef {
        let view = view(&self.program.types, ty, seen);
        let lows = lows(&self.program.types, ty);
        let field = FieldDef::new(name, self.mem_type(ty));
        field.with_view(view).with_lows(lows)
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
            .map(|member| self.field(&member.name, member.ty, member.view))
            .collect();
        let made = self.table.add_struct(struct_name(&def.name), fields);
        self.structs.insert(id, made);
        made
    }

    /// A structure that storage is made of.
    pub(crate) fn known_struct(&self, id: hir::StructId) -> StructId {
        self.structs[&id]
    }

    /// The predefined structure with this name.
    pub(crate) fn predefined(&mut self, name: &str) -> StructId {
        let mut structs = self.program.types.structs();
        let found = structs.find(|(_, def)| def.name == name);
        let (id, _) = found.expect("library code uses predefined structures");
        self.struct_type(id)
    }
}

/// What the numbers at a place stand for: as the tag or the innermost member says.
fn seen(program: &hir::Program, place: &hir::Place) -> hir::View {
    let tag = program.tag(place.tag);
    let (mut at, mut view) = (tag.ty, tag.view);
    for step in &place.path {
        match (at, step) {
            (hir::Type::Struct(id), Step::Field(index)) => {
                let member = &program.types.struct_def(id).members[*index as usize];
                (at, view) = (member.ty, member.view);
            }
            (hir::Type::Array(id), Step::Index(_)) => at = program.types.array_def(id).element,
            (hir::Type::Elementary(_), Step::Bit(_)) => return hir::View::Number,
            (hir::Type::Struct(_) | hir::Type::Array(_) | hir::Type::Elementary(_), _) => {
                panic!("places are checked when they are made")
            }
        }
    }
    view
}

/// The subscripts of the first elements of a field, the outermost first.
fn lows(types: &hir::Types, mut ty: hir::Type) -> Vec<i64> {
    let mut lows = Vec::new();
    while let hir::Type::Array(id) = ty {
        let array = types.array_def(id);
        lows.push(array.low);
        ty = array.element;
    }
    lows
}

/// How the scalars of a field are seen; structures say so themselves.
fn view(types: &hir::Types, ty: hir::Type, seen: hir::View) -> View {
    let leaf = match ty {
        hir::Type::Array(id) => return view(types, types.array_def(id).element, seen),
        hir::Type::Struct(_) | hir::Type::Elementary(Elementary::Bool) => return View::Plain,
        hir::Type::Elementary(leaf) => leaf,
    };
    match seen {
        hir::View::Number if leaf.is_integer() && !leaf.is_signed() => View::Unsigned,
        hir::View::Number => View::Plain,
        hir::View::Bits => View::Bits,
        hir::View::Character => View::Unsigned,
        hir::View::Time => View::Time,
        hir::View::Date => View::Date,
        hir::View::TimeOfDay => View::TimeOfDay,
        hir::View::DateTime => View::DateTime,
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

/// The result types of a unit's function. Those of ladder come behind whether there are any.
pub(crate) fn result_types(pou: &Pou) -> Vec<Type> {
    match &pou.body {
        Body::Ladder(_) if pou.results.is_empty() => Vec::new(),
        Body::Ladder(_) => {
            let values = pou.results.iter().map(|ty| scalar(*ty));
            std::iter::once(Type::I1).chain(values).collect()
        }
        Body::Text(code) => {
            let results = code.results.iter();
            let types = results.map(|local| code.locals[local.index()].ty);
            types.map(|ty| scalar(elementary(ty))).collect()
        }
    }
}

/// The type of what has one value.
pub(crate) fn elementary(ty: hir::Type) -> Elementary {
    match ty {
        hir::Type::Elementary(ty) => ty,
        hir::Type::Struct(_) | hir::Type::Array(_) => panic!("values are elementary"),
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
    start.join(&steps(&place.path))
}

/// The way from a place.
pub(crate) fn steps(path: &[Step]) -> Vec<Projection> {
    path.iter()
        .map(|step| match *step {
            Step::Field(index) => Projection::Field(index),
            Step::Index(index) => Projection::Index(Index::Const(index)),
            Step::Bit(bit) => Projection::Bit(Index::Const(bit)),
        })
        .collect()
}
