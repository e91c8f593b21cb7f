//! Types of a program, and the table that owns structures and arrays.

use std::collections::HashMap;

/// A type with one value.
///
/// The order is the rank by which mixed operands are promoted: the higher of two wins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Elementary {
    /// One bit.
    Bool,
    /// Signed, 8 bits.
    Sint,
    /// Unsigned, 8 bits.
    Usint,
    /// Signed, 16 bits.
    Int,
    /// Unsigned, 16 bits.
    Uint,
    /// Signed, 32 bits.
    Dint,
    /// Unsigned, 32 bits.
    Udint,
    /// Signed, 64 bits.
    Lint,
    /// Unsigned, 64 bits.
    Ulint,
    /// IEEE 754 binary32.
    Real,
    /// IEEE 754 binary64.
    Lreal,
}

impl Elementary {
    /// All of them, by rank.
    pub const ALL: [Self; 11] = [
        Self::Bool,
        Self::Sint,
        Self::Usint,
        Self::Int,
        Self::Uint,
        Self::Dint,
        Self::Udint,
        Self::Lint,
        Self::Ulint,
        Self::Real,
        Self::Lreal,
    ];

    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "BOOL",
            Self::Sint => "SINT",
            Self::Usint => "USINT",
            Self::Int => "INT",
            Self::Uint => "UINT",
            Self::Dint => "DINT",
            Self::Udint => "UDINT",
            Self::Lint => "LINT",
            Self::Ulint => "ULINT",
            Self::Real => "REAL",
            Self::Lreal => "LREAL",
        }
    }

    /// The type with this name, ignoring case.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|ty| ty.name().eq_ignore_ascii_case(name))
    }

    /// Width in bits.
    pub fn bits(self) -> u32 {
        match self {
            Self::Bool => 1,
            Self::Sint | Self::Usint => 8,
            Self::Int | Self::Uint => 16,
            Self::Dint | Self::Udint | Self::Real => 32,
            Self::Lint | Self::Ulint | Self::Lreal => 64,
        }
    }

    /// Whether it is a whole number.
    pub fn is_integer(self) -> bool {
        match self {
            Self::Sint
            | Self::Usint
            | Self::Int
            | Self::Uint
            | Self::Dint
            | Self::Udint
            | Self::Lint
            | Self::Ulint => true,
            Self::Bool | Self::Real | Self::Lreal => false,
        }
    }

    /// Whether it is a floating-point number.
    pub fn is_float(self) -> bool {
        matches!(self, Self::Real | Self::Lreal)
    }

    /// Whether it is a number at all.
    pub fn is_number(self) -> bool {
        self.is_integer() || self.is_float()
    }

    /// Whether it is a signed integer.
    pub fn is_signed(self) -> bool {
        matches!(self, Self::Sint | Self::Int | Self::Dint | Self::Lint)
    }
}

/// Names a structure of [`Types`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StructId(pub(crate) u32);

/// Names an array type of [`Types`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ArrayId(pub(crate) u32);

/// A type of something in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Type {
    /// One value.
    Elementary(Elementary),
    /// Named members.
    Struct(StructId),
    /// Elements; several dimensions are arrays of arrays.
    Array(ArrayId),
}

/// What instructions know about a structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StructKind {
    /// `TIMER`, the backing of timer instructions.
    Timer,
    /// `COUNTER`, the backing of counter instructions.
    Counter,
    /// `CONTROL`, the backing of array and file instructions.
    Control,
    /// A string of Structured Text: `LEN`, a `DINT` between 0 and the length of `DATA`, and `DATA`, an
    /// array of `USINT` or `UINT`. Elements from `LEN` on mean nothing, but are 0 at the start.
    Text,
    /// A type the user or a module defines, strings of Logix included.
    Plain,
}

/// What a number stands for, where people read or write it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum View {
    /// A number, with the sign of its type; a truth value; also structures and arrays of such.
    #[default]
    Number,
    /// A bit string.
    Bits,
    /// A character.
    Character,
    /// A duration in nanoseconds.
    Time,
    /// Nanoseconds since 1970-01-01, at midnight.
    Date,
    /// Nanoseconds since midnight.
    TimeOfDay,
    /// Nanoseconds since 1970-01-01.
    DateTime,
}

/// The hidden first member of an instance that extends another: the part that is the base. No name
/// of a source holds an apostrophe.
pub const BASE: &str = "base'";

/// A member of a structure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MemberDef {
    /// Its name as declared.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// What the numbers in it stand for.
    pub view: View,
    /// Cannot be named by programs.
    pub hidden: bool,
}

/// A member that exists but cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unusable {
    /// Its name as declared.
    pub name: String,
    /// Why, as the rest of a sentence that begins with the name.
    pub reason: String,
}

/// A structure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StructDef {
    /// Its name, unique in the table.
    pub name: String,
    /// What it is to instructions.
    pub kind: StructKind,
    /// Members in order.
    pub members: Vec<MemberDef>,
    /// Members that are declared but not stored.
    pub unusable: Vec<Unusable>,
}

impl StructDef {
    /// Position of the member with this name, ignoring case; hidden members have none.
    pub fn member(&self, name: &str) -> Option<u32> {
        self.members
            .iter()
            .position(|member| !member.hidden && member.name.eq_ignore_ascii_case(name))
            .map(|index| index as u32)
    }
}

/// An array type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ArrayDef {
    /// Type of the elements.
    pub element: Type,
    /// How many, at least 1.
    pub len: u32,
    /// The subscript that users give the first one.
    pub low: i64,
}

/// Structures and arrays. A type refers only to types that stand before it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Types {
    structs: Vec<StructDef>,
    arrays: Vec<ArrayDef>,
    interned: HashMap<ArrayDef, ArrayId>,
}

impl Types {
    /// Adds a structure, whose name must be new.
    pub fn add_struct(&mut self, def: StructDef) -> StructId {
        self.structs.push(def);
        StructId(self.structs.len() as u32 - 1)
    }

    /// The array type whose first element users call 0, made on first use.
    pub fn array(&mut self, element: Type, len: u32) -> ArrayId {
        self.array_from(element, len, 0)
    }

    /// The array type whose first element users call `low`, made on first use.
    pub fn array_from(&mut self, element: Type, len: u32, low: i64) -> ArrayId {
        let wanted = ArrayDef { element, len, low };
        *self.interned.entry(wanted).or_insert_with(|| {
            self.arrays.push(wanted);
            ArrayId(self.arrays.len() as u32 - 1)
        })
    }

    /// A structure.
    pub fn struct_def(&self, id: StructId) -> &StructDef {
        &self.structs[id.0 as usize]
    }

    /// All structures with their ids, in order of definition.
    pub fn structs(&self) -> impl Iterator<Item = (StructId, &StructDef)> + '_ {
        (0..).map(StructId).zip(&self.structs)
    }

    /// An array type.
    pub fn array_def(&self, id: ArrayId) -> ArrayDef {
        self.arrays[id.0 as usize]
    }

    /// The kind of structure a type is, if it is one.
    pub fn struct_kind(&self, ty: Type) -> Option<StructKind> {
        match ty {
            Type::Struct(id) => Some(self.struct_def(id).kind),
            Type::Elementary(_) | Type::Array(_) => None,
        }
    }

    /// The type as users write it: `DINT`, `TIMER[4]`, `REAL[2,3]`.
    pub fn name(&self, ty: Type) -> String {
        let (mut at, mut dimensions) = (ty, Vec::new());
        while let Type::Array(id) = at {
            let array = self.array_def(id);
            dimensions.push(array.len.to_string());
            at = array.element;
        }
        let base = match at {
            Type::Elementary(elementary) => elementary.name(),
            Type::Struct(id) => &self.struct_def(id).name,
            Type::Array(_) => unreachable!("peeled off above"),
        };
        if dimensions.is_empty() {
            base.to_owned()
        } else {
            format!("{base}[{}]", dimensions.join(","))
        }
    }
}
