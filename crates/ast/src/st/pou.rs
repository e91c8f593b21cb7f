//! Functions, function blocks, programs, classes and interfaces.

use super::arena::{Id, List};
use super::decl::{Modifier, TypeSpec, VarSection};
use super::expr::{Expr, Ident};
use super::stmt::Block;
use iecc_source::TextRange;

/// A program organisation unit, a class or an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pou {
    /// Which.
    pub kind: PouKind,
    /// FINAL, ABSTRACT, INTERNAL and the like.
    pub modifiers: List<Modifier>,
    /// Its name.
    pub name: Ident,
    /// The result of a function.
    pub result: Option<Id<TypeSpec>>,
    /// EXTENDS: paths.
    pub extends: List<Id<Expr>>,
    /// IMPLEMENTS: paths.
    pub implements: List<Id<Expr>>,
    /// USING: paths of namespaces.
    pub usings: List<Id<Expr>>,
    /// Its variables.
    pub sections: List<VarSection>,
    /// Methods, properties and actions.
    pub members: List<Member>,
    /// Its statements.
    pub body: Block,
    /// The word that opens it.
    pub opener: TextRange,
    /// All of it.
    pub range: TextRange,
}

/// Which unit a [`Pou`] is.
#[expect(missing_docs, reason = "the words of the language")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PouKind {
    Function,
    FunctionBlock,
    Program,
    Class,
    Interface,
}

impl PouKind {
    /// The word that opens it; `END_` and the word closes it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Function => "FUNCTION",
            Self::FunctionBlock => "FUNCTION_BLOCK",
            Self::Program => "PROGRAM",
            Self::Class => "CLASS",
            Self::Interface => "INTERFACE",
        }
    }
}

/// A method, property or action of a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Member {
    /// `METHOD … END_METHOD`; in an interface a prototype.
    Method(Method),
    /// `PROPERTY … END_PROPERTY` (CODESYS).
    Property(Property),
    /// `ACTION … END_ACTION` (CODESYS): statements over the variables of the unit.
    Action(Action),
}

impl Member {
    /// Its name.
    pub fn name(&self) -> Ident {
        match self {
            Self::Method(method) => method.name,
            Self::Property(property) => property.name,
            Self::Action(action) => action.name,
        }
    }

    /// All of it.
    pub fn range(&self) -> TextRange {
        match self {
            Self::Method(method) => method.range,
            Self::Property(property) => property.range,
            Self::Action(action) => action.range,
        }
    }
}

/// A method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// Access, FINAL, ABSTRACT, OVERRIDE.
    pub modifiers: List<Modifier>,
    /// Its name.
    pub name: Ident,
    /// Its result.
    pub result: Option<Id<TypeSpec>>,
    /// Its variables.
    pub sections: List<VarSection>,
    /// Its statements.
    pub body: Block,
    /// All of it.
    pub range: TextRange,
}

/// A property: what looks like a variable and runs code.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Property {
    /// Access, FINAL, ABSTRACT.
    pub modifiers: List<Modifier>,
    /// Its name.
    pub name: Ident,
    /// Its type.
    pub ty: Id<TypeSpec>,
    /// `GET … END_GET`: reading.
    pub get: Option<Accessor>,
    /// `SET … END_SET`: writing.
    pub set: Option<Accessor>,
    /// All of it.
    pub range: TextRange,
}

/// Reading or writing of a property.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accessor {
    /// Access.
    pub modifiers: List<Modifier>,
    /// Its variables.
    pub sections: List<VarSection>,
    /// Its statements.
    pub body: Block,
    /// All of it.
    pub range: TextRange,
}

/// Statements with a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Action {
    /// Its name.
    pub name: Ident,
    /// Its statements.
    pub body: Block,
    /// All of it.
    pub range: TextRange,
}
