//! What units show to others: names, variables, results. No bodies.

use super::constant::Const;
use super::types::TypeId;
use crate::hir;
use iecc_ast::Symbol;
use iecc_ast::st;
use iecc_ast::st::{Edge, PouKind, SectionKind};
use iecc_source::{Span, TextRange};
use rustc_hash::FxHashMap;

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub(crate) u32);

        impl $name {
            /// Position in its table.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    /// Names a unit of the source.
    UnitId
    /// Names something with a body, or an interface.
    PouId
    /// Names a namespace.
    NamespaceId
    /// Names a declaration of a type.
    TypeDeclId
    /// Names a global variable.
    GlobalId
}

impl NamespaceId {
    /// What is in no namespace.
    pub const GLOBAL: Self = Self(0);
    /// The standard library.
    pub const LIBRARY: Self = Self(1);
}

/// What a name stands for outside of units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Def {
    /// A type.
    Type(TypeDeclId),
    /// A function, block, program, class or interface.
    Pou(PouId),
    /// A variable.
    Global(GlobalId),
    /// A namespace.
    Namespace(NamespaceId),
}

/// An initial value where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Initial {
    /// The unit it stands in.
    pub unit: UnitId,
    /// The expression.
    pub expr: st::Id<st::Expr>,
}

/// Where a [`Pou`] is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The unit itself.
    Whole,
    /// A method, action or property, by its position among the members.
    Member(u32),
    /// Reading of the property.
    Getter(u32),
    /// Writing of the property.
    Setter(u32),
}

/// Something with a body, or an interface.
#[derive(Debug, Clone)]
pub struct Pou {
    /// Its name.
    pub name: Symbol,
    /// What it is; methods are functions.
    pub kind: PouKind,
    /// Where it is written.
    pub unit: UnitId,
    /// Which part of the unit.
    pub part: Part,
    /// What a method, action or property belongs to.
    pub owner: Option<PouId>,
    /// The namespace it is in.
    pub namespace: NamespaceId,
    /// Where its name stands.
    pub span: Span,
    /// Its result.
    pub result: Option<TypeId>,
    /// What its body calls the result: its name, or that of the property it reads.
    pub result_name: Symbol,
    /// Its variables in order, inherited ones not included.
    pub vars: Vec<Var>,
    /// Their positions.
    pub by_name: FxHashMap<Symbol, u32>,
    /// Its methods, actions and properties.
    pub members: Vec<(Symbol, PouId)>,
    /// What it extends: at most one, but for interfaces.
    pub extends: Vec<PouId>,
    /// The interfaces it implements.
    pub implements: Vec<PouId>,
    /// The class or block that the instance is of, for the body of a base made for it.
    pub receiver: Option<PouId>,
    /// Words in front of the name.
    pub modifiers: Vec<st::ModifierKind>,
    /// Generic types of a library unit have a value here in the instance made for a call.
    pub bindings: Bindings,
    /// The unit this one was made of for a call, if it was.
    pub template: Option<PouId>,
    /// Whether its signature is complete.
    pub state: State,
}

/// Concrete types for the generic names of a library unit.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Bindings {
    /// By generic name.
    pub generics: Vec<(Symbol, TypeId)>,
    /// By parameter: the types of open strings and arrays.
    pub open: Vec<(Symbol, TypeId)>,
}

/// How far a signature is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Its variables are not looked at.
    Declared,
    /// It is being looked at; meeting it again is a cycle.
    InProgress,
    /// Complete.
    Done,
}

/// A variable of a unit.
#[derive(Debug, Clone)]
pub struct Var {
    /// Its name.
    pub name: Symbol,
    /// Where the name stands, in the unit.
    pub range: TextRange,
    /// The section it is declared in.
    pub section: SectionKind,
    /// Its type.
    pub ty: TypeId,
    /// Its initial value, if the declaration has one.
    pub initial: Option<Initial>,
    /// Whether it cannot be changed.
    pub constant: bool,
    /// R_EDGE, F_EDGE.
    pub edge: Option<Edge>,
    /// Words in front of the section.
    pub access: Option<st::ModifierKind>,
    /// Where it lives.
    pub storage: Storage,
    /// Where it lives if VAR_CONFIG says at which address.
    pub partly: Option<st::Area>,
}

/// Where a variable lives.
#[derive(Debug, Clone, PartialEq)]
pub enum Storage {
    /// A member of the instance.
    Field(u32),
    /// In the activation; the position is among [`Pou::vars`].
    Local,
    /// Passed by reference; the position is among the reference parameters.
    Ref(u32),
    /// A global variable.
    Global(GlobalId),
    /// Nowhere: it is known.
    Const(Const),
    /// At an address.
    Located(super::address::Address),
}

/// A tag and the way into it.
#[derive(Debug, Clone, PartialEq)]
pub struct Spot {
    /// The tag.
    pub tag: hir::TagId,
    /// The way.
    pub steps: Vec<hir::code::PathStep>,
}

/// A global variable.
#[derive(Debug, Clone)]
pub struct Global {
    /// Its name.
    pub name: Symbol,
    /// What it is called from outside of the program, if not by its name.
    pub path: Option<String>,
    /// The list it is in, if that has a name.
    pub list: Option<Symbol>,
    /// Whether it is named with its list alone.
    pub qualified: bool,
    /// Its type.
    pub ty: TypeId,
    /// Whether it cannot be changed.
    pub constant: bool,
    /// Its initial value, if the declaration has one.
    pub initial: Option<Initial>,
    /// Where it is declared.
    pub span: Span,
    /// Its value, if it is a constant with one value.
    pub value: Option<Const>,
    /// Where it lives; `None` for a constant with one value.
    pub spot: Option<Spot>,
    /// The unit it is declared in.
    pub unit: UnitId,
    /// The declaration.
    pub decl: st::VarDecl,
    /// How far its type and value are.
    pub state: State,
}

impl Pou {
    /// The variable with this name, without those of what it extends.
    pub fn var(&self, name: Symbol) -> Option<&Var> {
        self.by_name
            .get(&name)
            .map(|index| &self.vars[*index as usize])
    }

    /// The variables of a section, in order.
    pub fn section(&self, section: SectionKind) -> impl Iterator<Item = &Var> + '_ {
        self.vars.iter().filter(move |var| var.section == section)
    }

    /// The position of a member among those that are written.
    pub fn part_index(&self) -> Option<u32> {
        match self.part {
            Part::Whole => None,
            Part::Member(index) | Part::Getter(index) | Part::Setter(index) => Some(index),
        }
    }

    /// Whether it has instances.
    pub fn has_instances(&self) -> bool {
        match self.kind {
            PouKind::FunctionBlock | PouKind::Program | PouKind::Class => self.part == Part::Whole,
            PouKind::Function | PouKind::Interface => false,
        }
    }
}
