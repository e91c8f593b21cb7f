//! The types of a program as the language sees them, each once.
//!
//! A [`TypeId`] is equal to another exactly if the types are the same. What a type is stored as is
//! for `storage`.

use super::elementary::El;
use super::signature::PouId;
use iecc_ast::{Names, Symbol};
use iecc_source::Span;
use rustc_hash::FxHashMap;
use std::ops::RangeInclusive;

/// Names a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TypeId(u32);

/// What a type is.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum TypeKind {
    /// Something a message has been given for; it goes with everything.
    Error,
    /// The result of what has none.
    Nothing,
    /// A whole number without a type of its own.
    UntypedInt,
    /// A number with a fraction, without a type of its own.
    UntypedReal,
    /// `NULL`.
    Null,
    /// One value.
    Elementary(El),
    /// A string of at most so many characters.
    Text {
        /// WSTRING.
        wide: bool,
        /// The maximum.
        length: u32,
    },
    /// An enumeration, or named values.
    Enum(u32),
    /// Some of the values of an integer type.
    Subrange {
        /// The integer type.
        base: El,
        /// The smallest value.
        low: i128,
        /// The largest value.
        high: i128,
    },
    /// Elements, the last index fastest.
    Array {
        /// First and last index of each dimension.
        dimensions: Box<[(i64, i64)]>,
        /// The type of the elements.
        element: TypeId,
    },
    /// An array whose bounds are those of the argument.
    OpenArray {
        /// How many dimensions.
        dimensions: u32,
        /// The type of the elements.
        element: TypeId,
    },
    /// A structure.
    Struct(u32),
    /// An instance of a function block, class or program.
    Instance(PouId),
    /// A reference to something that implements an interface.
    Interface(PouId),
    /// REF_TO, and POINTER TO and REFERENCE TO of CODESYS.
    Reference(ReferenceKind, TypeId),
    /// Another name for a type, with a default of its own.
    Alias(u32),
}

/// How a reference is written and read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ReferenceKind {
    /// `REF_TO`.
    RefTo,
    /// `POINTER TO` (CODESYS).
    Pointer,
    /// `REFERENCE TO` (CODESYS): stands for its target without `^`.
    Implicit,
}

/// An enumeration.
#[derive(Debug, Clone)]
pub struct EnumDef {
    /// Its name; `None` where it stands in a declaration of variables.
    pub name: Option<Symbol>,
    /// The type of its values.
    pub base: El,
    /// Whether it has values of a type that was given, so that arithmetic is allowed.
    pub named_values: bool,
    /// Whether its values are named with it alone.
    pub qualified: bool,
    /// Its values.
    pub values: Vec<(Symbol, i128)>,
    /// The declaration.
    pub span: Span,
}

/// A structure.
#[derive(Debug, Clone)]
pub struct StructDef {
    /// Its name; `None` where it stands in a declaration of variables.
    pub name: Option<Symbol>,
    /// Its members.
    pub members: Vec<Member>,
    /// Their positions.
    pub by_name: FxHashMap<Symbol, u32>,
    /// Where the members lie, if they overlap.
    pub overlay: Option<Overlay>,
    /// Whether an attribute says how its members are packed.
    pub packed: bool,
    /// The declaration.
    pub span: Span,
}

/// Members that overlap: numbers in an array of bytes, the lowest byte first.
#[derive(Debug, Clone)]
pub struct Overlay {
    /// How many bytes there are.
    pub bytes: u32,
    /// The first bit of each member.
    pub first: Vec<u32>,
}

/// A member of a structure.
#[derive(Debug, Clone)]
pub struct Member {
    /// Its name.
    pub name: Symbol,
    /// Its type.
    pub ty: TypeId,
    /// The initial value its declaration gives, in the unit of the structure.
    pub initial: Option<super::signature::Initial>,
    /// Where it lives if VAR_CONFIG says at which address.
    pub partly: Option<iecc_ast::st::Area>,
    /// The declaration.
    pub span: Span,
}

/// Another name for a type.
#[derive(Debug, Clone)]
pub struct AliasDef {
    /// The name.
    pub name: Symbol,
    /// The type.
    pub base: TypeId,
    /// The default its declaration gives.
    pub initial: Option<super::signature::Initial>,
}

/// All types.
#[derive(Debug, Default)]
pub struct Types {
    kinds: Vec<TypeKind>,
    interned: FxHashMap<TypeKind, TypeId>,
    /// Enumerations.
    pub enums: Vec<EnumDef>,
    /// Structures.
    pub structs: Vec<StructDef>,
    /// Aliases.
    pub aliases: Vec<AliasDef>,
}

/// What values of a type are made of.
#[derive(Debug, Clone, Copy)]
pub enum Parts<'t> {
    /// Elements of one type.
    Elements {
        /// First and last index of each dimension.
        dimensions: &'t [(i64, i64)],
        /// Their type.
        element: TypeId,
    },
    /// Members of a structure.
    Members(&'t StructDef),
    /// The variables of a block, class or program.
    Variables(PouId),
    /// Nothing that has a type of its own, or nothing that is known before a call.
    None,
}

impl TypeId {
    /// The type of what a message has been given for.
    pub const ERROR: Self = Self(0);
    /// No value.
    pub const NOTHING: Self = Self(1);
    /// A whole number literal.
    pub const UNTYPED_INT: Self = Self(2);
    /// A literal with a fraction.
    pub const UNTYPED_REAL: Self = Self(3);
    /// `NULL`.
    pub const NULL: Self = Self(4);
    /// BOOL.
    pub const BOOL: Self = Self::of(El::Bool);

    const FIRST_ELEMENTARY: u32 = 5;

    /// An elementary type.
    pub const fn of(el: El) -> Self {
        Self(Self::FIRST_ELEMENTARY + el as u32)
    }

    /// Position in the order in which types came up.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl Types {
    /// The elementary types.
    pub fn new() -> Self {
        let mut types = Self::default();
        let fixed = [
            TypeKind::Error,
            TypeKind::Nothing,
            TypeKind::UntypedInt,
            TypeKind::UntypedReal,
            TypeKind::Null,
        ];
        let elementary = El::ALL.iter().map(|el| TypeKind::Elementary(*el));
        for kind in fixed.into_iter().chain(elementary) {
            types.intern(kind);
        }
        types
    }

    /// The type of a kind.
    pub fn intern(&mut self, kind: TypeKind) -> TypeId {
        if let Some(&id) = self.interned.get(&kind) {
            return id;
        }
        let id = TypeId(u32::try_from(self.kinds.len()).expect("fewer than 2^32 types"));
        self.kinds.push(kind.clone());
        self.interned.insert(kind, id);
        id
    }

    /// What a type is.
    pub fn kind(&self, id: TypeId) -> &TypeKind {
        &self.kinds[id.index()]
    }

    /// Adds an enumeration.
    pub fn add_enum(&mut self, def: EnumDef) -> TypeId {
        self.enums.push(def);
        self.intern(TypeKind::Enum(self.enums.len() as u32 - 1))
    }

    /// Adds a structure.
    pub fn add_struct(&mut self, def: StructDef) -> TypeId {
        self.structs.push(def);
        self.intern(TypeKind::Struct(self.structs.len() as u32 - 1))
    }

    /// Adds an alias.
    pub fn add_alias(&mut self, def: AliasDef) -> TypeId {
        self.aliases.push(def);
        self.intern(TypeKind::Alias(self.aliases.len() as u32 - 1))
    }

    /// Says what an alias stands for that was added before that was known.
    pub fn settle_alias(&mut self, alias: TypeId, base: TypeId) {
        if let TypeKind::Alias(index) = *self.kind(alias) {
            self.aliases[index as usize].base = base;
        }
    }

    /// The type behind aliases.
    pub fn strip(&self, mut id: TypeId) -> TypeId {
        while let TypeKind::Alias(alias) = self.kind(id) {
            id = self.aliases[*alias as usize].base;
        }
        id
    }

    /// What a type is, behind aliases.
    pub fn base(&self, id: TypeId) -> &TypeKind {
        self.kind(self.strip(id))
    }

    /// The elementary type that values of a type are: that of a subrange is its base; enumerations
    /// have none unless they are named values.
    pub fn elementary(&self, id: TypeId) -> Option<El> {
        match self.base(id) {
            TypeKind::Elementary(el) | TypeKind::Subrange { base: el, .. } => Some(*el),
            TypeKind::Enum(index) => {
                let def = &self.enums[*index as usize];
                def.named_values.then_some(def.base)
            }
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::Text { .. }
            | TypeKind::Array { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Struct(_)
            | TypeKind::Instance(_)
            | TypeKind::Interface(_)
            | TypeKind::Reference(..)
            | TypeKind::Alias(_) => None,
        }
    }

    /// What values of a type are made of.
    pub fn parts(&self, id: TypeId) -> Parts<'_> {
        match self.base(id) {
            TypeKind::Array {
                dimensions,
                element,
            } => Parts::Elements {
                dimensions,
                element: *element,
            },
            TypeKind::Struct(index) => Parts::Members(&self.structs[*index as usize]),
            TypeKind::Instance(of) => Parts::Variables(*of),
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::Elementary(_)
            | TypeKind::Text { .. }
            | TypeKind::Enum(_)
            | TypeKind::Subrange { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Interface(_)
            | TypeKind::Reference(..)
            | TypeKind::Alias(_) => Parts::None,
        }
    }

    /// The enumeration that a type is.
    pub fn enumeration(&self, id: TypeId) -> Option<&EnumDef> {
        if let TypeKind::Enum(index) = self.base(id) {
            Some(&self.enums[*index as usize])
        } else {
            None
        }
    }

    /// The structure that a type is.
    pub fn structure(&self, id: TypeId) -> Option<&StructDef> {
        if let TypeKind::Struct(index) = self.base(id) {
            Some(&self.structs[*index as usize])
        } else {
            None
        }
    }

    /// The integer type of a subrange, and its values.
    pub fn subrange(&self, id: TypeId) -> Option<(El, RangeInclusive<i128>)> {
        if let TypeKind::Subrange { base, low, high } = *self.base(id) {
            Some((base, low..=high))
        } else {
            None
        }
    }

    /// The block, class or program that a type is the instances of.
    pub fn instance(&self, id: TypeId) -> Option<PouId> {
        if let TypeKind::Instance(of) = *self.base(id) {
            Some(of)
        } else {
            None
        }
    }

    /// The unit whose methods and properties values of a type have.
    pub fn object(&self, id: TypeId) -> Option<PouId> {
        if let TypeKind::Instance(of) | TypeKind::Interface(of) = *self.base(id) {
            Some(of)
        } else {
            None
        }
    }

    /// What a reference refers to.
    pub fn target(&self, id: TypeId) -> Option<TypeId> {
        if let TypeKind::Reference(_, target) = *self.base(id) {
            Some(target)
        } else {
            None
        }
    }

    /// What a reference refers to that stands for it without `^`.
    pub fn implicit_target(&self, id: TypeId) -> Option<TypeId> {
        if let TypeKind::Reference(ReferenceKind::Implicit, target) = *self.base(id) {
            Some(target)
        } else {
            None
        }
    }

    /// Whether it is a string.
    pub fn is_text(&self, id: TypeId) -> bool {
        matches!(self.base(id), TypeKind::Text { .. })
    }

    /// Whether a value of the type is one number in storage.
    pub fn is_scalar(&self, id: TypeId) -> bool {
        match self.base(id) {
            TypeKind::Elementary(_)
            | TypeKind::Enum(_)
            | TypeKind::Subrange { .. }
            | TypeKind::Interface(_)
            | TypeKind::Reference(..)
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::Error => true,
            TypeKind::Nothing
            | TypeKind::Text { .. }
            | TypeKind::Array { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Struct(_)
            | TypeKind::Instance(_)
            | TypeKind::Alias(_) => false,
        }
    }

    /// The type as users write it.
    pub fn name(&self, id: TypeId, names: &Names, pou_name: &dyn Fn(PouId) -> Symbol) -> String {
        let again = |id| self.name(id, names, pou_name);
        let named = |name: Option<Symbol>, what: &str| {
            name.map_or_else(|| what.to_owned(), |name| names.text(name).to_owned())
        };
        match self.kind(id) {
            TypeKind::Error => "?".to_owned(),
            TypeKind::Nothing => "nothing".to_owned(),
            TypeKind::UntypedInt => "ANY_INT".to_owned(),
            TypeKind::UntypedReal => "ANY_REAL".to_owned(),
            TypeKind::Null => "NULL".to_owned(),
            TypeKind::Elementary(el) => el.name().to_owned(),
            TypeKind::Text { wide, length } => {
                format!("{}STRING[{length}]", if *wide { "W" } else { "" })
            }
            TypeKind::Enum(index) => named(self.enums[*index as usize].name, "enumeration"),
            TypeKind::Subrange { base, low, high } => format!("{} ({low}..{high})", base.name()),
            TypeKind::Array {
                dimensions,
                element,
            } => {
                let ranges: Vec<String> = dimensions
                    .iter()
                    .map(|(low, high)| format!("{low}..{high}"))
                    .collect();
                format!("ARRAY [{}] OF {}", ranges.join(", "), again(*element))
            }
            TypeKind::OpenArray {
                dimensions,
                element,
            } => {
                let stars = vec!["*"; *dimensions as usize].join(", ");
                format!("ARRAY [{stars}] OF {}", again(*element))
            }
            TypeKind::Struct(index) => named(self.structs[*index as usize].name, "structure"),
            TypeKind::Instance(pou) | TypeKind::Interface(pou) => {
                names.text(pou_name(*pou)).to_owned()
            }
            TypeKind::Reference(kind, target) => {
                let word = match kind {
                    ReferenceKind::RefTo => "REF_TO",
                    ReferenceKind::Pointer => "POINTER TO",
                    ReferenceKind::Implicit => "REFERENCE TO",
                };
                format!("{word} {}", again(*target))
            }
            TypeKind::Alias(index) => names.text(self.aliases[*index as usize].name).to_owned(),
        }
    }
}
