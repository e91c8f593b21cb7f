//! Bodies of the textual languages: statements and typed expressions over storage.
//!
//! All that a language leaves to types and names is decided here: every expression has one
//! elementary type, every conversion, check, default and copy stands where it happens, calls have all their
//! arguments. Times, enumerations, subranges, bit strings and characters are numbers of their
//! width; strings are structures ([`StructKind::Text`](super::StructKind::Text)); references are
//! addresses.
//!
//! Evaluation is strictly from left to right, operands before operators. Nodes live in the tables
//! of a [`Code`] and are named by ids; children have smaller ids than their parents, so the tree of
//! a node is finite. Nesting is bounded by that of the source.

use super::{CompareOp, Elementary, Place, PouId, Step, StructId, TagId, Type};
use iecc_source::Span;

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);

        impl $name {
            /// Position in its table.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    /// Names an expression of a [`Code`].
    ExprId
    /// Names a place of a [`Code`].
    PathId
    /// Names a statement of a [`Code`].
    StmtId
    /// Names a variable of one activation of a [`Code`].
    LocalId
    /// Names a call of a [`Code`].
    CallId
    /// Names an initial value of [`Inits`].
    InitId
}

/// A body with its interface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Code {
    /// What is passed by reference: the instance of a block or method first, then in-outs.
    pub refs: Vec<RefParam>,
    /// How many of the locals, from the first, take the values of a call.
    pub params: u32,
    /// Locals whose values a call gives back, in order.
    pub results: Vec<LocalId>,
    /// Variables of one activation: 0 at its start, except for parameters.
    pub locals: Vec<Local>,
    /// Expressions.
    pub exprs: Vec<Expr>,
    /// Places.
    pub paths: Vec<Path>,
    /// Statements.
    pub stmts: Vec<Stmt>,
    /// Calls.
    pub calls: Vec<Call>,
    /// What is done.
    pub body: Block,
}

/// Statements in order.
pub type Block = Vec<StmtId>;

/// A reference parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefParam {
    /// Its name, unique among the references and locals.
    pub name: String,
    /// The type of what is passed.
    pub ty: Type,
}

/// A variable of one activation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Local {
    /// Its name, unique among the references and locals.
    pub name: String,
    /// Its type; parameters and results are elementary.
    pub ty: Type,
}

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// The type of its value. A reference is a `ULINT`.
    pub ty: Elementary,
    /// Where it is written.
    pub span: Span,
}

/// What an expression is. Operands have the type of the result unless it says otherwise.
#[derive(Debug, Clone, PartialEq)]
pub enum ExprKind {
    /// A constant, by its bits.
    Const(u64),
    /// The value at a place.
    Load(PathId),
    /// One operand.
    Unary(UnaryOp, ExprId),
    /// Two operands of the result's type; the count of a shift is a `UDINT`.
    Binary(BinaryOp, ExprId, ExprId),
    /// Two operands of one type, floats as IEEE 754 says; the result is a `BOOL`.
    Compare(CompareOp, ExprId, ExprId),
    /// An operand of any type.
    Convert(Conversion, ExprId),
    /// The second if the first, a `BOOL`, is TRUE, else the third. All are evaluated.
    Select(ExprId, ExprId, ExprId),
    /// As `Select`, but only the operand that counts is evaluated.
    Choose(ExprId, ExprId, ExprId),
    /// The value, which must lie between two numbers of its type; outside it is a fault, or the
    /// nearer limit where faults do not stop.
    Within {
        /// The value.
        value: ExprId,
        /// Bits of the least number.
        low: u64,
        /// Bits of the largest number.
        high: u64,
    },
    /// The first result of a call.
    Call(CallId),
    /// Runs statements, then gives the value.
    After(Block, ExprId),
    /// The address of a place of the state, 0 for none; a `ULINT`.
    Address(PathId),
    /// Whether there is anything at a place, a `BOOL`: a subscript outside and NULL on the way are
    /// faults, or where faults do not stop give FALSE.
    Exists(PathId),
    /// The time of the scan, in nanoseconds; a `LINT`.
    Now,
    /// Nanoseconds since the `LINT` at the place was renewed, and renews it; a `LINT`.
    Elapsed(PathId),
    /// How many units of time began since the `LINT` at the place was renewed, and renews it; a `DINT`.
    /// The unit is 1 ms, or what the user says that a timer of ladder counts.
    ElapsedUnits(PathId),
}

/// Operations with one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnaryOp {
    /// The number with the other sign, wrapping.
    Negate,
    /// Every bit inverted.
    Not,
    /// The magnitude, wrapping.
    Absolute,
    /// Square root of a float.
    SquareRoot,
}

/// Operations with two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BinaryOp {
    /// Sum, wrapping.
    Add,
    /// Difference, wrapping.
    Subtract,
    /// Product, wrapping.
    Multiply,
    /// Quotient; integers truncate, and 0 as the divisor is a fault, or gives 0 where faults do not
    /// stop.
    Divide,
    /// As `Divide`, where the divisor is known not to be 0 or 0 is meant to give 0.
    DivideUnchecked,
    /// Remainder with the sign of the dividend; 0 if the divisor is 0.
    Modulo,
    /// Bitwise.
    And,
    /// Bitwise.
    Or,
    /// Bitwise.
    Xor,
    /// To the left, filled with 0; 0 from the width on.
    ShiftLeft,
    /// To the right, filled with 0 whatever the type; 0 from the width on.
    ShiftRight,
}

/// How a value becomes one of another type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conversion {
    /// By value: integers wrap, floats round half to even and saturate, NaN becomes 0. To `BOOL`:
    /// whether it is not 0.
    Value,
    /// As `Value`, but a float is truncated toward 0.
    Truncate,
    /// By bits: right-aligned, filled with 0 or cut; a float of the width gets or gives its pattern.
    /// To `BOOL`: the lowest bit.
    Bits,
}

/// A place where something is stored.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Where it begins.
    pub root: Root,
    /// The way from there.
    pub steps: Vec<PathStep>,
    /// Where it is written.
    pub span: Span,
}

/// Where a place begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Root {
    /// A tag.
    Tag(TagId),
    /// A reference parameter, by its position.
    Ref(u32),
    /// A variable of the activation.
    Local(LocalId),
    /// What an address stands for; NULL is a fault, or where faults do not stop it reads as 0 and is
    /// not stored to.
    Deref {
        /// A `ULINT`.
        address: ExprId,
        /// The type of what lies there.
        ty: Type,
        /// Whether NULL is excluded already.
        checked: bool,
    },
}

/// A step into a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathStep {
    /// A member of a structure.
    Field(u32),
    /// An element, from 0, within bounds.
    Index(u32),
    /// An element by an integer expression. Outside `low..low+len` it is a fault, or where faults do
    /// not stop it reads as 0 and is not stored to.
    IndexBy {
        /// The subscript, of any integer type.
        value: ExprId,
        /// The subscript of the first element.
        low: i64,
        /// Whether being inside is known already.
        checked: bool,
    },
    /// As `IndexBy` in the text of a string: positions count from 1, and those above its length are
    /// a fault as well unless `checked`. The place is the string structure.
    Character {
        /// The position, of any integer type.
        value: ExprId,
        /// Whether the position need not be tested; outside of all that can be stored it reads as 0 and
        /// is not stored to.
        checked: bool,
    },
    /// Some bits of an integer or bit string, the lowest first; always last. One bit is a `BOOL`.
    Bits {
        /// The lowest.
        first: u32,
        /// How many: 1, 8, 16 or 32.
        count: u32,
    },
    /// A value in an array of bytes (`USINT`), little-endian; always last.
    Bytes {
        /// The first byte.
        offset: u32,
        /// What is there.
        ty: Elementary,
    },
}

/// A call. Arguments are evaluated in the order references, values.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    /// What is called.
    pub callee: PouId,
    /// One place per reference parameter, of its type.
    pub refs: Vec<PathId>,
    /// One value per parameter.
    pub args: Vec<ExprId>,
    /// Where results other than the first go: their position and an elementary place.
    pub outputs: Vec<(u32, PathId)>,
}

/// A statement.
#[derive(Debug, Clone, PartialEq)]
pub struct Stmt {
    /// What it does.
    pub kind: StmtKind,
    /// Where it is written.
    pub span: Span,
}

/// What a statement does.
#[derive(Debug, Clone, PartialEq)]
pub enum StmtKind {
    /// Evaluates, then stores at an elementary place.
    Assign(PathId, ExprId),
    /// Copies a whole structure or array: to, from.
    Copy(PathId, PathId),
    /// Gives a place its initial value.
    Initialise(PathId, InitId),
    /// Evaluates for its effects.
    Eval(ExprId),
    /// The block of the first condition that is TRUE, else the last block.
    If {
        /// Conditions and their blocks.
        arms: Vec<(ExprId, Block)>,
        /// ELSE.
        otherwise: Block,
    },
    /// The block of the first arm with the selector in one of its ranges, else the last block.
    Case {
        /// An integer or bit string.
        selector: ExprId,
        /// Ranges by bits, both ends included; disjoint, in the order of the selector's type.
        arms: Vec<(Vec<(u64, u64)>, Block)>,
        /// ELSE.
        otherwise: Block,
    },
    /// Evaluates first and last value and step once. The number of passes follows from them; the
    /// variable ends with the first value that is not passed, wrapped, or where EXIT left it. A step of
    /// 0 is a fault, or no pass.
    For {
        /// An elementary place of an integer type.
        variable: PathId,
        /// First value.
        from: ExprId,
        /// Last value.
        to: ExprId,
        /// Step.
        by: ExprId,
        /// What is repeated.
        body: Block,
    },
    /// Repeats while a condition holds that is tested before each pass.
    While(ExprId, Block),
    /// Repeats until a condition holds that is tested after each pass.
    Repeat(Block, ExprId),
    /// Leaves the innermost loop.
    Exit,
    /// Goes on with the next pass of the innermost loop.
    Continue,
    /// Leaves the body.
    Return,
}

/// Initial values of places, shared where they are alike.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Inits {
    values: Vec<Init>,
}

/// The initial value of a place. What it leaves out is 0.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Init {
    /// All of it is 0.
    Zero,
    /// An elementary value, by its bits.
    Bits(u64),
    /// Members by position, in order.
    Struct(Vec<(u32, InitId)>),
    /// Runs of elements, in order: the first, how many, and the value of each.
    Array(Vec<(u32, u32, InitId)>),
    /// The address of something in the state.
    Address(Target),
}

/// What an address at the start stands for.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Target {
    /// A place of a tag.
    Tag(Place),
    /// The way into the structure of this type around the value, the innermost of several.
    Around(StructId, Vec<Step>),
}

impl Inits {
    /// Adds a value whose parts are there already.
    pub fn add(&mut self, init: Init) -> InitId {
        self.values.push(init);
        InitId(self.values.len() as u32 - 1)
    }

    /// The value of an id.
    pub fn get(&self, id: InitId) -> &Init {
        &self.values[id.index()]
    }
}

impl Code {
    /// An expression of an id.
    pub fn expr(&self, id: ExprId) -> &Expr {
        &self.exprs[id.index()]
    }

    /// A place of an id.
    pub fn path(&self, id: PathId) -> &Path {
        &self.paths[id.index()]
    }

    /// A statement of an id.
    pub fn stmt(&self, id: StmtId) -> &Stmt {
        &self.stmts[id.index()]
    }

    /// A call of an id.
    pub fn call(&self, id: CallId) -> &Call {
        &self.calls[id.index()]
    }
}
