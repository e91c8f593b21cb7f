//! Value types, memory types, and the table that owns structs and arrays.

use cranelift_entity::{PrimaryMap, entity_impl};
use rustc_hash::FxHashMap;
use std::fmt;

/// The type of an SSA value. Signedness is in the operation, not in the type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Type {
    /// One bit: BOOL.
    I1,
    /// 8 bits.
    I8,
    /// 16 bits.
    I16,
    /// 32 bits.
    I32,
    /// 64 bits.
    I64,
    /// IEEE 754 binary32.
    F32,
    /// IEEE 754 binary64.
    F64,
}

impl Type {
    /// All types, narrow to wide.
    pub const ALL: [Type; 7] = [
        Type::I1,
        Type::I8,
        Type::I16,
        Type::I32,
        Type::I64,
        Type::F32,
        Type::F64,
    ];

    /// Width of the value in bits.
    pub fn bits(self) -> u32 {
        match self {
            Self::I1 => 1,
            Self::I8 => 8,
            Self::I16 => 16,
            Self::I32 | Self::F32 => 32,
            Self::I64 | Self::F64 => 64,
        }
    }

    /// Bytes in memory; also the alignment. `i1` takes one byte holding 0 or 1.
    pub fn bytes(self) -> u32 {
        self.bits().div_ceil(8)
    }

    /// Whether this is one of the integer types, `i1` included.
    pub fn is_int(self) -> bool {
        match self {
            Self::I1 | Self::I8 | Self::I16 | Self::I32 | Self::I64 => true,
            Self::F32 | Self::F64 => false,
        }
    }

    /// Whether this is a floating-point type.
    pub fn is_float(self) -> bool {
        !self.is_int()
    }

    /// The bits a value of this type may have set.
    pub fn mask(self) -> u64 {
        u64::MAX >> (64 - self.bits())
    }

    /// The value's bits read as a two's complement number. `i1` reads as 0 or -1.
    pub fn signed(self, bits: u64) -> i64 {
        let shift = 64 - self.bits();
        ((bits << shift) as i64) >> shift
    }

    /// The name in the text form.
    pub fn name(self) -> &'static str {
        match self {
            Self::I1 => "i1",
            Self::I8 => "i8",
            Self::I16 => "i16",
            Self::I32 => "i32",
            Self::I64 => "i64",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// The type with this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|ty| ty.name() == name)
    }
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Names a struct of a [`TypeTable`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StructId(u32);
entity_impl!(StructId, "struct");

/// Names an array type of a [`TypeTable`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ArrayId(u32);
entity_impl!(ArrayId, "array");

/// The type of a place in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MemType {
    /// One value.
    Scalar(Type),
    /// Named fields.
    Struct(StructId),
    /// Elements of one type, counted from 0.
    Array(ArrayId),
}

/// A field of a struct.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldDef {
    /// Name, unique in its struct.
    pub name: String,
    /// Type.
    pub ty: MemType,
    /// How people see and write it.
    pub view: View,
    /// The number that people give the first element in each dimension, the outermost first; those
    /// left out are 0. Indices in places count from 0 nevertheless.
    pub lows: Vec<i64>,
}

impl FieldDef {
    /// A field whose numbers are seen as signed decimals.
    pub fn new(name: impl Into<String>, ty: MemType) -> Self {
        Self {
            name: name.into(),
            ty,
            view: View::default(),
            lows: Vec::new(),
        }
    }

    /// The same field, seen otherwise.
    #[must_use]
    pub fn with_view(mut self, view: View) -> Self {
        self.view = view;
        self
    }

    /// The same field, with other numbers of first elements. Zeros at the end are dropped.
    #[must_use]
    pub fn with_lows(mut self, mut lows: Vec<i64>) -> Self {
        while lows.last() == Some(&0) {
            lows.pop();
        }
        self.lows = lows;
        self
    }
}

/// How people see and write the scalars of a field, those beneath its arrays included. It changes
/// nothing in what is computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum View {
    /// What the type suggests: a bit, a signed number, a real number.
    #[default]
    Plain,
    /// A number without sign.
    Unsigned,
    /// A string of bits: `16#FF`.
    Bits,
    /// Nanoseconds, as a duration: `T#1s500ms`.
    Time,
    /// Nanoseconds since 1970-01-01, as a day: `D#2024-02-29`.
    Date,
    /// Nanoseconds since midnight: `TOD#12:30:00`.
    TimeOfDay,
    /// Nanoseconds since 1970-01-01: `DT#2024-02-29-12:30:00`.
    DateTime,
}

impl View {
    /// All views.
    pub const ALL: [Self; 7] = [
        Self::Plain,
        Self::Unsigned,
        Self::Bits,
        Self::Time,
        Self::Date,
        Self::TimeOfDay,
        Self::DateTime,
    ];

    /// The name in the text form.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Unsigned => "unsigned",
            Self::Bits => "bits",
            Self::Time => "time",
            Self::Date => "date",
            Self::TimeOfDay => "time_of_day",
            Self::DateTime => "date_time",
        }
    }

    /// The view with this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|view| view.name() == name)
    }

    /// Whether scalars of the type can be seen so.
    pub fn fits(self, ty: Type) -> bool {
        match self {
            Self::Plain => true,
            Self::Unsigned | Self::Bits => ty.is_int() && ty != Type::I1,
            Self::Time | Self::Date | Self::TimeOfDay | Self::DateTime => ty == Type::I64,
        }
    }
}

/// A struct type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StructDef {
    /// Name, unique in its table.
    pub name: String,
    /// Fields in memory order.
    pub fields: Vec<FieldDef>,
}

impl StructDef {
    /// Position of the field with exactly this name.
    pub fn field(&self, name: &str) -> Option<u32> {
        self.fields
            .iter()
            .position(|field| field.name == name)
            .map(|i| i as u32)
    }
}

/// An array type: `len` elements of `element`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ArrayType {
    /// Element type.
    pub element: MemType,
    /// Number of elements; at least 1.
    pub len: u32,
}

/// Owns the struct and array types of a module. Arrays are interned, so equal types are equal ids.
/// A type only refers to types that stand before it, so types cannot contain themselves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TypeTable {
    /// Structs, in order of definition. They are added by `add_struct` and keep their names.
    pub structs: PrimaryMap<StructId, StructDef>,
    arrays: PrimaryMap<ArrayId, ArrayType>,
    /// The ids of arrays, and of structs by name; of equal names the first.
    array_ids: FxHashMap<ArrayType, ArrayId>,
    struct_ids: FxHashMap<String, StructId>,
}

impl TypeTable {
    /// The id of the array type, made on first use.
    pub fn array(&mut self, element: MemType, len: u32) -> ArrayId {
        let wanted = ArrayType { element, len };
        let arrays = &mut self.arrays;
        let known = self.array_ids.entry(wanted);
        *known.or_insert_with(|| arrays.push(wanted))
    }

    /// The array type of an id.
    pub fn array_type(&self, id: ArrayId) -> ArrayType {
        self.arrays[id]
    }

    /// All array types, in order of first use.
    pub fn arrays(&self) -> impl Iterator<Item = ArrayType> + '_ {
        self.arrays.values().copied()
    }

    /// The struct with this name.
    pub fn struct_named(&self, name: &str) -> Option<StructId> {
        self.struct_ids.get(name).copied()
    }

    /// Adds a struct. The name must be new and field types must already be in the table.
    pub fn add_struct(&mut self, name: impl Into<String>, fields: Vec<FieldDef>) -> StructId {
        let name = name.into();
        let id = self.structs.push(StructDef {
            name: name.clone(),
            fields,
        });
        self.struct_ids.entry(name).or_insert(id);
        id
    }
}
