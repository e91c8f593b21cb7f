//! Where the nodes of a unit live: in a few vectors, named by numbers.
//!
//! An [`Id`] is one node, a [`List`] a run of elements. Both are only good for the arena that gave
//! them out. Nodes are made bottom-up, so an id is larger than those of the children it had when
//! it was made; nothing here is ever a cycle. Dropping an arena never recurses.

use super::config::{AccessDecl, InstanceConfig, ProgramConfig, ProgramElement, Resource, Task};
use super::decl::{Dimension, EnumValue, Modifier, TypeDecl, TypeSpec, VarDecl, VarSection};
use super::expr::{Argument, Expr, Ident};
use super::literal::Literal;
use super::pou::Member;
use super::stmt::{CaseArm, IfArm, Label, Stmt};
use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

/// One node of an arena.
pub struct Id<T> {
    index: u32,
    of: PhantomData<fn() -> T>,
}

/// A run of elements of an arena.
pub struct List<T> {
    start: u32,
    len: u32,
    of: PhantomData<fn() -> T>,
}

impl<T> Id<T> {
    /// Position among the nodes of its kind, for tables beside the arena.
    pub fn index(self) -> usize {
        self.index as usize
    }
}

impl<T> List<T> {
    /// A list without elements.
    pub const EMPTY: Self = Self {
        start: 0,
        len: 0,
        of: PhantomData,
    };

    /// How many elements there are.
    pub fn len(self) -> usize {
        self.len as usize
    }

    /// Whether there are none.
    pub fn is_empty(self) -> bool {
        self.len == 0
    }
}

/// Derived impls would ask `T` to have the trait as well; ids are numbers whatever they name.
macro_rules! number_like {
    ($name:ident { $($field:ident),* }) => {
        impl<T> Clone for $name<T> {
            fn clone(&self) -> Self { *self }
        }
        impl<T> Copy for $name<T> {}
        impl<T> PartialEq for $name<T> {
            fn eq(&self, other: &Self) -> bool { $(self.$field == other.$field)&&* }
        }
        impl<T> Eq for $name<T> {}
        impl<T> Hash for $name<T> {
            fn hash<H: Hasher>(&self, state: &mut H) { $(self.$field.hash(state);)* }
        }
    };
}

number_like!(Id { index });
number_like!(List { start, len });

impl<T> fmt::Debug for Id<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.index)
    }
}

impl<T> fmt::Debug for List<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}..{}", self.start, self.start + self.len)
    }
}

impl<T> PartialOrd for Id<T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Id<T> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.index.cmp(&other.index)
    }
}

/// What an arena holds vectors of.
pub trait Stored: Sized {
    /// The vector.
    fn all(arena: &Arena) -> &Vec<Self>;
    /// The vector, to change it.
    fn all_mut(arena: &mut Arena) -> &mut Vec<Self>;
}

macro_rules! arena {
    ($($field:ident: $element:ty,)*) => {
        /// The nodes of one unit.
        #[derive(Debug, Clone, Default, PartialEq)]
        pub struct Arena {
            $($field: Vec<$element>,)*
        }

        $(impl Stored for $element {
            fn all(arena: &Arena) -> &Vec<Self> { &arena.$field }
            fn all_mut(arena: &mut Arena) -> &mut Vec<Self> { &mut arena.$field }
        })*
    };
}

arena! {
    exprs: Expr,
    literals: Literal,
    stmts: Stmt,
    types: TypeSpec,
    expr_lists: Id<Expr>,
    stmt_lists: Id<Stmt>,
    numbers: u32,
    idents: Ident,
    arguments: Argument,
    if_arms: IfArm,
    case_arms: CaseArm,
    labels: Label,
    dimensions: Dimension,
    enum_values: EnumValue,
    modifiers: Modifier,
    variables: VarDecl,
    sections: VarSection,
    type_decls: TypeDecl,
    members: Member,
    accesses: AccessDecl,
    instances: InstanceConfig,
    resources: Resource,
    tasks: Task,
    programs: ProgramConfig,
    program_elements: ProgramElement,
}

impl Arena {
    /// An arena without nodes.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a node.
    pub fn add<T: Stored>(&mut self, node: T) -> Id<T> {
        let all = T::all_mut(self);
        let index = u32::try_from(all.len()).expect("fewer than 2^32 nodes");
        all.push(node);
        Id {
            index,
            of: PhantomData,
        }
    }

    /// Adds a list, whose elements then stand together.
    pub fn list<T: Stored>(&mut self, elements: impl IntoIterator<Item = T>) -> List<T> {
        let all = T::all_mut(self);
        let start = all.len();
        all.extend(elements);
        List {
            start: u32::try_from(start).expect("fewer than 2^32 elements"),
            len: (all.len() - start) as u32,
            of: PhantomData,
        }
    }

    /// All nodes of a kind.
    pub fn all<T: Stored>(&self) -> &[T] {
        T::all(self)
    }

    /// How many nodes of a kind there are; ids are below.
    pub fn count<T: Stored>(&self) -> usize {
        T::all(self).len()
    }
}

impl<T: Stored> Index<Id<T>> for Arena {
    type Output = T;

    fn index(&self, id: Id<T>) -> &T {
        &T::all(self)[id.index()]
    }
}

impl<T: Stored> IndexMut<Id<T>> for Arena {
    fn index_mut(&mut self, id: Id<T>) -> &mut T {
        &mut T::all_mut(self)[id.index()]
    }
}

impl<T: Stored> Index<List<T>> for Arena {
    type Output = [T];

    fn index(&self, list: List<T>) -> &[T] {
        &T::all(self)[list.start as usize..][..list.len()]
    }
}
