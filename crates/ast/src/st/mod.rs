//! Structured Text as it was written.
//!
//! A [`File`] is a list of [`Unit`]s, each in a [`Scope`] (the file itself, or a namespace). The
//! nodes of a unit live in its [`Arena`]; their ranges count from the start of the unit, so the
//! same text gives the same unit wherever it stands in a file, and a unit can be kept while text
//! around it changes. [`Unit::span`] gives the place in the file.
//!
//! The tree holds a superset of all editions and of CODESYS: what a dialect refuses is refused by
//! the semantic analysis, with a code. After a message, nodes of kind `Error` stand in for what
//! could not be read.
//!
//! Trees are bounded: expressions by [`MAX_EXPR_DEPTH`], statements by [`MAX_BLOCK_DEPTH`], types
//! by [`MAX_TYPE_DEPTH`], so whoever walks them may recurse. [`print_unit`] gives
//! canonical text, [`dump`] an outline for tests; [`Arena::each_operand`] and its like help to visit.

pub mod arena;
pub mod calendar;
pub mod config;
pub mod decl;
mod dump;
pub mod expr;
pub mod literal;
pub mod pou;
mod print;
pub mod stmt;
pub mod test;
pub mod time;
mod walk;

pub use arena::{Arena, Id, List, Stored};
pub use config::{
    AccessDecl, AccessDirection, Configuration, InstanceConfig, ProgramConfig, ProgramElement,
    Resource, Task,
};
pub use decl::{
    Declarations, Dimension, Direction, Edge, EnumValue, Modifier, ModifierKind, SectionKind,
    TypeDecl, TypeKind, TypeSpec, VarDecl, VarSection,
};
pub use dump::dump;
pub use expr::{
    AddressSize, Area, Argument, ArgumentKind, BinaryOp, Direct, Expr, ExprKind, Ident, Part,
    UnaryOp,
};
pub use literal::{IntLiteral, Literal, StringLiteral, TimeKind, TimeLiteral, TimeShape};
pub use pou::{Accessor, Action, Member, Method, Pou, PouKind, Property};
pub use print::{print_expr, print_file, print_unit, string_text};
pub use stmt::{AssignOp, Block, CaseArm, IfArm, Label, Stmt, StmtKind};
pub use test::{Test, TestKind};

use crate::names::Symbol;
use iecc_source::{ContentHash, FileId, Span, TextRange};

/// How deep expressions nest. A chain of operators nests once per operator.
pub const MAX_EXPR_DEPTH: u16 = 384;

/// How deep statements nest.
pub const MAX_BLOCK_DEPTH: u16 = 64;

/// How deep types nest, arrays of arrays and structures in structures.
pub const MAX_TYPE_DEPTH: u16 = 64;

/// How deep namespaces nest.
pub const MAX_SCOPE_DEPTH: usize = 64;

/// One source file.
#[derive(Debug, Clone, PartialEq)]
pub struct File {
    /// Which file.
    pub id: FileId,
    /// Its name without the ending, where lists of global variables have one (CODESYS).
    pub name: Option<Symbol>,
    /// The file itself (the first one), and every namespace as it is opened. Parents come before
    /// their children.
    pub scopes: Vec<Scope>,
    /// The units in their order.
    pub units: Vec<Unit>,
}

/// What a list of global variables in a file is called: the name of the file without folders and
/// ending, where that is a name.
pub fn list_name(path: &str) -> Option<&str> {
    let file = path.rsplit(['/', '\\']).next()?;
    let name = file.rsplit_once('.').map_or(file, |(name, _)| name);
    let mut letters = name.bytes();
    let first = letters.next()?;
    let begins = first.is_ascii_alphabetic() || first == b'_';
    let goes_on = letters.all(|letter| letter.is_ascii_alphanumeric() || letter == b'_');
    (begins && goes_on).then_some(name)
}

/// Names a scope of a [`File`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ScopeId(pub u32);

impl ScopeId {
    /// The file itself.
    pub const FILE: Self = Self(0);
}

/// A file, or a namespace from its opening word to its closing word.
#[derive(Debug, Clone, PartialEq)]
pub struct Scope {
    /// What it stands in; `None` for the file.
    pub parent: Option<ScopeId>,
    /// The name, which may have several parts. Ranges count from the start of the file.
    pub name: Vec<Ident>,
    /// Whether it is INTERNAL.
    pub internal: bool,
    /// What stands in it, in order.
    pub items: Vec<Item>,
    /// All of it.
    pub span: Span,
}

/// What stands in a scope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// An index into [`File::units`].
    Unit(u32),
    /// A namespace.
    Scope(ScopeId),
}

/// A unit that stands on its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// The file.
    pub file: FileId,
    /// Its first byte in the file; ranges count from here.
    pub start: u32,
    /// The hash of its text, comments included.
    pub hash: ContentHash,
    /// The hash of what it shows to others: of its text without comments and the statements of
    /// bodies, and of which bodies have statements.
    pub declared: ContentHash,
    /// What it is in.
    pub scope: ScopeId,
    /// What it is.
    pub kind: UnitKind,
    /// Its nodes.
    pub arena: Arena,
    /// Its pragmas, in order. One says something about what begins behind it.
    pub pragmas: Vec<Pragma>,
    /// Whether a message with an error was given for it.
    pub has_errors: bool,
    /// Whether names that it declares, or what they are to others, were lost in a mistake.
    pub lost_names: bool,
}

/// What a unit is.
#[derive(Debug, Clone, PartialEq)]
pub enum UnitKind {
    /// `TYPE … END_TYPE`
    Types {
        /// INTERNAL.
        modifiers: List<Modifier>,
        /// The types.
        types: List<TypeDecl>,
    },
    /// A function, function block, program, class or interface.
    Pou(Box<Pou>),
    /// `CONFIGURATION … END_CONFIGURATION`
    Configuration(Box<Configuration>),
    /// `TEST … END_TEST`, SETUP and TEARDOWN.
    Test(Box<Test>),
    /// `VAR_GLOBAL … END_VAR` outside of everything (CODESYS).
    Globals(VarSection),
    /// `USING a.b;`: paths of namespaces.
    Using(List<Id<Expr>>),
    /// Pragmas behind the last unit.
    Nothing,
    /// Nothing could be made of it; a message says so.
    Error,
}

/// `{…}`, with what stands between the braces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pragma {
    /// The text between the braces.
    pub text: Box<str>,
    /// With the braces.
    pub range: TextRange,
}

impl UnitKind {
    /// As [`Unit::bodies`].
    pub fn bodies(&self, arena: &Arena) -> Vec<Block> {
        let Self::Pou(pou) = self else {
            return Vec::new();
        };
        let mut bodies = vec![pou.body];
        for member in &arena[pou.members] {
            match member {
                Member::Method(method) => bodies.push(method.body),
                Member::Action(action) => bodies.push(action.body),
                Member::Property(property) => {
                    let accessors = [property.get, property.set];
                    bodies.extend(accessors.into_iter().flatten().map(|one| one.body));
                }
            }
        }
        bodies
    }
}

impl Unit {
    /// The bodies of the unit and of its members, empty ones too.
    pub fn bodies(&self) -> Vec<Block> {
        self.kind.bodies(&self.arena)
    }

    /// Where a range of this unit is in its file.
    pub fn span(&self, range: TextRange) -> Span {
        range.in_file(self.file, self.start)
    }
}
