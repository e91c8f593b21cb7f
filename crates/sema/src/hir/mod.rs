//! The typed program: every name is resolved, every operand has a type, every error is reported.
//!
//! All languages meet here. A [`Program`] owns types, tags with their initial values, I/O points,
//! program organisation units with their bodies, and the order in which a scan calls them. Nothing
//! is left to decide for the lowering; a program with errors is not lowered.

pub mod code;
mod find;
mod ladder;
mod place;
mod types;
pub mod written;

pub use code::{Code, InitId, Inits};
pub use ladder::{
    Action, Arithmetic, CoilKind, CompareOp, Computation, Condition, Const, CounterKind, Element,
    Instruction, Logical, Op, Operand, Prescan, ResetKind, Rung, TimerKind, Unary,
};
pub use place::{Access, Place, Step};
pub use types::{
    ArrayDef, ArrayId, BASE, Elementary, MemberDef, StructDef, StructId, StructKind, Type, Types,
    Unusable, View,
};

use iecc_source::Span;

/// Names a tag of a [`Program`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TagId(pub(crate) u32);

/// Names a program organisation unit of a [`Program`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PouId(pub(crate) u32);

impl PouId {
    /// The id of a position.
    pub fn from_index(index: usize) -> Self {
        Self(index as u32)
    }

    /// Position in [`Program::pous`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl TagId {
    /// Position in [`Program::tags`].
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The id of a position.
    pub fn from_index(index: usize) -> Self {
        Self(index as u32)
    }
}

/// Storage that is kept from scan to scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Tag {
    /// Its name, unique ignoring case: as declared, or `Program.name` where programs share it.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// What the numbers in it stand for.
    pub view: View,
    /// Its initial value as a whole, of [`Program::inits`].
    pub init: Option<InitId>,
    /// Leaves whose initial values are other than that: the path from the tag, and the bits.
    pub initial: Vec<(Vec<Step>, u64)>,
    /// The declaration.
    pub span: Option<Span>,
}

/// A value exchanged with the outside once a scan.
#[derive(Debug, Clone, PartialEq)]
pub struct IoPoint {
    /// Public name, unique ignoring case among inputs and outputs.
    pub name: String,
    /// The word or bit of a tag that mirrors it.
    pub place: Place,
}

/// A unit that can be called.
#[derive(Debug, Clone, PartialEq)]
pub struct Pou {
    /// `Program/Routine`.
    pub name: String,
    /// Tags that take the values of a call.
    pub parameters: Vec<Place>,
    /// Types of the values it gives back; empty when it gives none.
    pub results: Vec<Elementary>,
    /// What it does.
    pub body: Body,
    /// The declaration.
    pub span: Span,
}

/// The code of a unit, by language.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// Rungs, top to bottom.
    Ladder(Vec<Rung>),
    /// Statements. The unit's `parameters` and `results` are empty: the code has its own.
    Text(Box<Code>),
}

/// What runs together, and when. At a tick the tasks that are ready run one after the other, the one
/// with the smallest priority number first, then in the order of declaration.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Task {
    /// Its name.
    pub name: String,
    /// When it is ready.
    pub trigger: Trigger,
    /// 0 comes first.
    pub priority: u32,
    /// Units called in order; they have no parameters.
    pub calls: Vec<PouId>,
}

/// When a task is ready.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Trigger {
    /// In every scan.
    #[default]
    EveryScan,
    /// By time and event.
    Timed {
        /// Nanoseconds from one release to the next, the first at 0; 0 for no releases.
        interval_ns: u64,
        /// A `BOOL`: its rising edge is an event, and while it is TRUE there are no releases by time.
        single: Option<Place>,
    },
}

/// A whole typed program.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Its name.
    pub name: String,
    /// Structures and arrays.
    pub types: Types,
    /// All storage.
    pub tags: Vec<Tag>,
    /// Inputs by address.
    pub inputs: Vec<IoPoint>,
    /// Outputs by address.
    pub outputs: Vec<IoPoint>,
    /// Other names for places; unique ignoring case.
    pub names: Vec<(String, Place)>,
    /// Units that can run.
    pub pous: Vec<Pou>,
    /// The functions that instructions of ladder stand for, by name, and what these call. They work
    /// on structures that have the names and members of this program's.
    pub stdlib: Option<Box<Program>>,
    /// Initial values.
    pub inits: Inits,
    /// What runs, in order of declaration; at least one.
    pub tasks: Vec<Task>,
    /// The bit that is 1 in the first scan, where the program looks at it.
    pub first_scan: Option<Place>,
}

impl Program {
    /// A program without anything.
    pub fn empty() -> Self {
        Self {
            name: String::new(),
            types: Types::default(),
            tags: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            names: Vec::new(),
            pous: Vec::new(),
            stdlib: None,
            inits: Inits::default(),
            tasks: Vec::new(),
            first_scan: None,
        }
    }

    /// The unit of an id.
    pub fn pou(&self, id: PouId) -> &Pou {
        &self.pous[id.index()]
    }

    /// The tag of an id.
    pub fn tag(&self, id: TagId) -> &Tag {
        &self.tags[id.index()]
    }

    /// A place as users write it.
    pub fn display(&self, place: &Place) -> String {
        let tag = self.tag(place.tag);
        place.display(&self.types, &tag.name, tag.ty)
    }

    /// The type at a place; `BOOL` for a bit.
    pub fn type_of(&self, place: &Place) -> Type {
        place.type_from(&self.types, self.tag(place.tag).ty)
    }

    /// The place that a path names, ignoring case: a tag, an alias or an I/O name, and the way into
    /// it (`section.PRE`, `recipe[2].3`).
    pub fn find(&self, path: &str) -> Option<Place> {
        find::place(self, path)
    }
}
