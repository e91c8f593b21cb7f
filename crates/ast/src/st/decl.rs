//! Declarations of types and variables.

use super::arena::{Id, List};
use super::config::{AccessDecl, InstanceConfig};
use super::expr::{Expr, Ident};
use iecc_source::TextRange;

/// `name : type := initial;` between TYPE and END_TYPE.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TypeDecl {
    /// Its name.
    pub name: Ident,
    /// `EXTENDS` of a structure (CODESYS).
    pub extends: Option<Id<Expr>>,
    /// What it is.
    pub ty: Id<TypeSpec>,
    /// The initial value of variables of the type.
    pub initial: Option<Id<Expr>>,
    /// All of it.
    pub range: TextRange,
}

/// A type where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TypeSpec {
    /// What it is.
    pub kind: TypeKind,
    /// Where.
    pub range: TextRange,
    /// How deep the tree of types is: 1 without inner types.
    pub depth: u16,
}

/// What a type is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TypeKind {
    /// A type by name, or by a path through namespaces.
    Named(Id<Expr>),
    /// `INT (low..high)`
    Subrange {
        /// An integer type.
        base: Id<Expr>,
        /// The smallest value.
        low: Id<Expr>,
        /// The largest value.
        high: Id<Expr>,
    },
    /// `STRING[20]`, or `STRING(20)` (CODESYS).
    Sized {
        /// STRING or WSTRING; any name is accepted before brackets.
        base: Id<Expr>,
        /// How many characters.
        length: Id<Expr>,
        /// Whether it is written with round parentheses.
        round: bool,
    },
    /// `ARRAY [dimensions] OF element`
    Array {
        /// At least one.
        dimensions: List<Dimension>,
        /// The type of the elements.
        element: Id<TypeSpec>,
    },
    /// `STRUCT … END_STRUCT`
    Struct {
        /// Whether members may overlap.
        overlap: bool,
        /// The members.
        members: List<VarDecl>,
    },
    /// `UNION … END_UNION` (CODESYS): members at the same place.
    Union {
        /// The members.
        members: List<VarDecl>,
    },
    /// `(A, B := 2)`, `DINT (A, B)`, and `(A, B) DINT` (CODESYS).
    Enum {
        /// The type of the values.
        base: Option<Id<Expr>>,
        /// At least one.
        values: List<EnumValue>,
    },
    /// `REF_TO target`
    RefTo(Id<TypeSpec>),
    /// `POINTER TO target` (CODESYS)
    PointerTo(Id<TypeSpec>),
    /// `REFERENCE TO target` (CODESYS)
    ReferenceTo(Id<TypeSpec>),
    /// Something a message has been given for.
    Error,
}

/// One dimension of an array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dimension {
    /// `low..high`
    Range {
        /// First index.
        low: Id<Expr>,
        /// Last index.
        high: Id<Expr>,
    },
    /// `*`: whatever the argument has.
    Open,
}

/// `name` or `name := value` of an enumeration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnumValue {
    /// Its name.
    pub name: Ident,
    /// Its value.
    pub value: Option<Id<Expr>>,
}

/// A word that qualifies a declaration, as written: doubled and contradicting ones are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Modifier {
    /// Which.
    pub kind: ModifierKind,
    /// Where.
    pub range: TextRange,
}

/// The words that qualify declarations.
#[expect(missing_docs, reason = "the words of the language")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModifierKind {
    Constant,
    Retain,
    NonRetain,
    /// CODESYS.
    Persistent,
    Public,
    Protected,
    Private,
    Internal,
    Final,
    Abstract,
    Override,
}

impl ModifierKind {
    /// The word.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Constant => "CONSTANT",
            Self::Retain => "RETAIN",
            Self::NonRetain => "NON_RETAIN",
            Self::Persistent => "PERSISTENT",
            Self::Public => "PUBLIC",
            Self::Protected => "PROTECTED",
            Self::Private => "PRIVATE",
            Self::Internal => "INTERNAL",
            Self::Final => "FINAL",
            Self::Abstract => "ABSTRACT",
            Self::Override => "OVERRIDE",
        }
    }
}

/// `VAR … END_VAR` of any kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VarSection {
    /// Which section.
    pub kind: SectionKind,
    /// CONSTANT, RETAIN, PRIVATE and the like.
    pub modifiers: List<Modifier>,
    /// What it declares.
    pub declarations: Declarations,
    /// All of it.
    pub range: TextRange,
}

/// What a section declares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Declarations {
    /// Variables: all sections but the two below.
    Variables(List<VarDecl>),
    /// VAR_ACCESS.
    Accesses(List<AccessDecl>),
    /// VAR_CONFIG.
    Instances(List<InstanceConfig>),
}

/// The word that opens a section.
#[expect(missing_docs, reason = "the words of the language")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SectionKind {
    Var,
    Input,
    Output,
    InOut,
    Temp,
    External,
    Global,
    Access,
    Config,
    /// CODESYS: one for all instances.
    Static,
    /// CODESYS: of a method, kept in the instance.
    Instance,
}

/// Which way values go through a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To the unit.
    In,
    /// From the unit.
    Out,
    /// Both ways, in the variable of the caller.
    InOut,
}

impl SectionKind {
    /// Which way values go through its variables at a call; `None` if they are no parameters.
    pub fn direction(self) -> Option<Direction> {
        match self {
            Self::Input => Some(Direction::In),
            Self::Output => Some(Direction::Out),
            Self::InOut => Some(Direction::InOut),
            Self::Var
            | Self::Temp
            | Self::External
            | Self::Global
            | Self::Access
            | Self::Config
            | Self::Static
            | Self::Instance => None,
        }
    }

    /// The word.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Var => "VAR",
            Self::Input => "VAR_INPUT",
            Self::Output => "VAR_OUTPUT",
            Self::InOut => "VAR_IN_OUT",
            Self::Temp => "VAR_TEMP",
            Self::External => "VAR_EXTERNAL",
            Self::Global => "VAR_GLOBAL",
            Self::Access => "VAR_ACCESS",
            Self::Config => "VAR_CONFIG",
            Self::Static => "VAR_STAT",
            Self::Instance => "VAR_INST",
        }
    }
}

/// `a, b AT %IW3 : type := initial;`, also for members of structures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VarDecl {
    /// The names; none in `AT %IX0.0 : BOOL;`.
    pub names: List<Ident>,
    /// The address behind AT.
    pub location: Option<Id<Expr>>,
    /// The type.
    pub ty: Id<TypeSpec>,
    /// R_EDGE or F_EDGE.
    pub edge: Option<Edge>,
    /// The initial value.
    pub initial: Option<Id<Expr>>,
    /// Whether it stands behind `REF=` (CODESYS): what a REFERENCE stands for at the start.
    pub bound: bool,
    /// All of it.
    pub range: TextRange,
}

/// Which edge of an input the body sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// R_EDGE.
    Rising,
    /// F_EDGE.
    Falling,
}
