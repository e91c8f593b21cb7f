//! Ladder bodies with resolved instructions.
//!
//! Condition flows from left to right. Every leg of a branch is executed in every scan; the branch
//! passes on the OR of its legs. Unless its documentation says otherwise, an operation acts when
//! the condition is true and passes the condition on as it is.

use crate::hir::{Access, Elementary, Place, PouId};
use iecc_source::Span;

/// A live rung.
#[derive(Debug, Clone, PartialEq)]
pub struct Rung {
    /// Its number in the routine.
    pub number: u32,
    /// What stands on it.
    pub elements: Vec<Element>,
    /// Its text.
    pub span: Span,
}

/// One thing on a wire.
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// An instruction.
    Instruction(Instruction),
    /// Parallel legs, each a series; an empty one is a plain wire.
    Branch(Vec<Vec<Element>>),
}

/// A resolved instruction.
#[derive(Debug, Clone, PartialEq)]
pub struct Instruction {
    /// What it does.
    pub op: Op,
    /// What it does before the first scan.
    pub prescan: Vec<(Place, Prescan)>,
    /// Where it is written.
    pub span: Span,
}

/// What happens to a place before the first scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prescan {
    /// The bit becomes 0.
    Clear,
    /// The bit becomes 1.
    Set,
    /// The timer is made ready for its instruction.
    Timer(TimerKind),
    /// The counter is made ready for its instruction.
    Counter(CounterKind),
}

/// A constant in an operand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Const {
    /// A whole number of an integer type, as its bits.
    Integer {
        /// The type the literal has by itself.
        ty: Elementary,
        /// Its bits.
        bits: u64,
    },
    /// A floating-point number, rounded once for each width.
    Float {
        /// The nearest REAL.
        single: f32,
        /// The nearest LREAL.
        double: f64,
    },
}

impl Const {
    /// The type the constant has by itself.
    pub fn ty(self) -> Elementary {
        match self {
            Self::Integer { ty, .. } => ty,
            Self::Float { .. } => Elementary::Real,
        }
    }
}

/// A value that an instruction reads.
#[derive(Debug, Clone, PartialEq)]
pub enum Operand {
    /// A literal.
    Const(Const),
    /// A tag of this type, or part of one.
    Place(Place, Elementary),
}

impl Operand {
    /// The type of the value.
    pub fn ty(&self) -> Elementary {
        match self {
            Self::Const(constant) => constant.ty(),
            Self::Place(_, ty) => *ty,
        }
    }
}

/// How a coil changes its bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CoilKind {
    /// OTE: the bit becomes the condition.
    Energize,
    /// OTL: set when true.
    Latch,
    /// OTU: cleared when true.
    Unlatch,
}

/// The timer instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimerKind {
    /// TON
    OnDelay,
    /// TOF
    OffDelay,
    /// RTO
    Retentive,
}

impl TimerKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::OnDelay, Self::OffDelay, Self::Retentive];

    /// The function of the library.
    pub fn function(self) -> &'static str {
        match self {
            Self::OnDelay => "TON",
            Self::OffDelay => "TOF",
            Self::Retentive => "RTO",
        }
    }

    /// What prescan does, in the library.
    pub fn prescan_function(self) -> &'static str {
        match self {
            Self::OnDelay => "TON_PRESCAN",
            Self::OffDelay => "TOF_PRESCAN",
            Self::Retentive => "RTO_PRESCAN",
        }
    }
}

/// The counter instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterKind {
    /// CTU
    Up,
    /// CTD
    Down,
}

impl CounterKind {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Up, Self::Down];

    /// The function of the library.
    pub fn function(self) -> &'static str {
        match self {
            Self::Up => "CTU",
            Self::Down => "CTD",
        }
    }

    /// What prescan does, in the library.
    pub fn prescan_function(self) -> &'static str {
        match self {
            Self::Up => "CTU_PRESCAN",
            Self::Down => "CTD_PRESCAN",
        }
    }
}

/// Comparisons of two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompareOp {
    /// EQU
    Equal,
    /// NEQ
    NotEqual,
    /// GRT
    Greater,
    /// GEQ
    GreaterEqual,
    /// LES
    Less,
    /// LEQ
    LessEqual,
}

/// Arithmetic on two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arithmetic {
    /// ADD
    Add,
    /// SUB
    Subtract,
    /// MUL
    Multiply,
    /// DIV
    Divide,
    /// MOD
    Modulo,
}

/// Bitwise operations on two integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Logical {
    /// AND
    And,
    /// OR
    Or,
    /// XOR
    Xor,
}

/// Operations on one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unary {
    /// MOV
    Move,
    /// NEG
    Negate,
    /// ABS
    Absolute,
    /// NOT: every bit inverted, narrow operands filled with 0
    Not,
}

/// A resolved operation. `ty` is the type it computes in: the highest rank of its operands and at
/// least DINT.
#[derive(Debug, Clone, PartialEq)]
pub enum Op {
    /// Passes on a condition of its own, at most the one it got.
    Condition(Condition),
    /// Passes on the condition it got.
    Action(Action),
}

/// Operations that make a condition.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// XIC, XIO: true if the bit is 1 (`normally_closed`: 0).
    Contact {
        /// The bit.
        bit: Place,
        /// XIO.
        normally_closed: bool,
    },
    /// ONS: true on a rising edge of the condition; also acts when false.
    OneShot {
        /// The condition of the last execution.
        storage: Place,
    },
    /// EQU and its kin.
    Compare {
        /// Which.
        op: CompareOp,
        /// Computed in.
        ty: Elementary,
        /// Source A and source B.
        operands: [Operand; 2],
    },
    /// LIM: true if the test value is in the band.
    Limit {
        /// Computed in.
        ty: Elementary,
        /// Low limit, test, high limit.
        operands: [Operand; 3],
    },
    /// MEQ: true if source and compare agree where the mask is 1.
    MaskedEqual {
        /// Computed in.
        ty: Elementary,
        /// Source, mask, compare.
        operands: [Operand; 3],
    },
    /// SBR: stands at the start of a unit; the values were passed by the call.
    Subroutine,
    /// AFI: false.
    AlwaysFalse,
    /// NOP: the condition it got.
    Nothing,
}

/// Operations that do something.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// OTE, OTL, OTU; OTE also acts when false.
    Coil {
        /// The bit.
        bit: Place,
        /// How it changes.
        kind: CoilKind,
    },
    /// OSR (`falling`: OSF): `output` is 1 for one execution after an edge of the condition; also
    /// acts when false.
    Edge {
        /// The condition of the last execution.
        storage: Place,
        /// Shows the edge.
        output: Place,
        /// OSF.
        falling: bool,
    },
    /// TON, TOF, RTO; also act when false.
    Timer {
        /// Which.
        kind: TimerKind,
        /// The TIMER.
        timer: Place,
    },
    /// CTU, CTD; also act when false.
    Counter {
        /// Which.
        kind: CounterKind,
        /// The COUNTER.
        counter: Place,
    },
    /// RES.
    Reset {
        /// TIMER, COUNTER or CONTROL.
        kind: ResetKind,
        /// The structure.
        structure: Place,
    },
    /// Computes a value into a destination.
    Compute(Computation),
    /// JSR: calls a unit; what is not called stays as it is.
    Call {
        /// The unit.
        pou: PouId,
        /// Values for its parameters, as many as it has.
        inputs: Vec<Operand>,
        /// Where its first results go, with their types.
        returns: Vec<(Place, Elementary)>,
    },
    /// RET: leaves the unit, giving back values in the types of its results.
    Return(Vec<Operand>),
}

/// What RES resets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResetKind {
    /// A TIMER.
    Timer,
    /// A COUNTER.
    Counter,
    /// A CONTROL.
    Control,
}

impl ResetKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Timer, Self::Counter, Self::Control];

    /// The function of the library.
    pub fn function(self) -> &'static str {
        match self {
            Self::Timer => "RES_TIMER",
            Self::Counter => "RES_COUNTER",
            Self::Control => "RES_CONTROL",
        }
    }
}

/// Computations with a destination.
#[derive(Debug, Clone, PartialEq)]
pub enum Computation {
    /// MOV, NEG, ABS, NOT.
    Unary {
        /// Which.
        op: Unary,
        /// Computed in.
        ty: Elementary,
        /// Source.
        source: Operand,
        /// Destination and its type.
        destination: (Place, Elementary),
    },
    /// ADD, SUB, MUL, DIV, MOD.
    Arithmetic {
        /// Which.
        op: Arithmetic,
        /// Computed in.
        ty: Elementary,
        /// Source A and source B.
        operands: [Operand; 2],
        /// Destination and its type.
        destination: (Place, Elementary),
    },
    /// AND, OR, XOR.
    Logical {
        /// Which.
        op: Logical,
        /// Computed in.
        ty: Elementary,
        /// Source A and source B.
        operands: [Operand; 2],
        /// Destination and its type.
        destination: (Place, Elementary),
    },
    /// CLR.
    Clear {
        /// Destination and its type.
        destination: (Place, Elementary),
    },
}

type Visitor<'f> = &'f mut dyn FnMut(&Place, Access);

impl Op {
    /// Calls `f` with every place it names. Members that an instruction reaches inside a TIMER,
    /// COUNTER or CONTROL are not listed one by one.
    pub fn for_each_place(&self, f: Visitor<'_>) {
        match self {
            Self::Condition(condition) => condition.for_each_place(f),
            Self::Action(action) => action.for_each_place(f),
        }
    }
}

impl Condition {
    fn for_each_place(&self, f: Visitor<'_>) {
        match self {
            Self::Contact { bit, .. } => f(bit, Access::Read),
            Self::OneShot { storage } => f(storage, Access::ReadWrite),
            Self::Compare { operands, .. } => read_all(operands, f),
            Self::Limit { operands, .. } | Self::MaskedEqual { operands, .. } => {
                read_all(operands, f);
            }
            Self::Subroutine | Self::AlwaysFalse | Self::Nothing => {}
        }
    }
}

impl Action {
    fn for_each_place(&self, f: Visitor<'_>) {
        match self {
            Self::Coil { bit, .. } => f(bit, Access::Write),
            Self::Edge {
                storage, output, ..
            } => {
                f(storage, Access::ReadWrite);
                f(output, Access::Write);
            }
            Self::Timer { timer: place, .. }
            | Self::Counter { counter: place, .. }
            | Self::Reset {
                structure: place, ..
            } => f(place, Access::ReadWrite),
            Self::Compute(computation) => computation.for_each_place(f),
            Self::Call {
                inputs, returns, ..
            } => {
                read_all(inputs, f);
                returns
                    .iter()
                    .for_each(|(place, _)| f(place, Access::Write));
            }
            Self::Return(values) => read_all(values, f),
        }
    }
}

impl Computation {
    fn for_each_place(&self, f: Visitor<'_>) {
        let destination = match self {
            Self::Unary {
                source,
                destination,
                ..
            } => {
                read_all(std::slice::from_ref(source), f);
                destination
            }
            Self::Arithmetic {
                operands,
                destination,
                ..
            }
            | Self::Logical {
                operands,
                destination,
                ..
            } => {
                read_all(operands, f);
                destination
            }
            Self::Clear { destination } => destination,
        };
        f(&destination.0, Access::Write);
    }
}

fn read_all(operands: &[Operand], f: Visitor<'_>) {
    for operand in operands {
        match operand {
            Operand::Place(place, _) => f(place, Access::Read),
            Operand::Const(_) => {}
        }
    }
}

impl Rung {
    /// Calls `f` with every instruction in the order of execution.
    pub fn for_each_instruction<'r>(&'r self, f: &mut dyn FnMut(&'r Instruction)) {
        visit(&self.elements, f);
    }
}

/// Depth is bounded by the reader's bound on nesting.
fn visit<'r>(series: &'r [Element], f: &mut dyn FnMut(&'r Instruction)) {
    for element in series {
        match element {
            Element::Instruction(instruction) => f(instruction),
            Element::Branch(legs) => legs.iter().for_each(|leg| visit(leg, f)),
        }
    }
}
