//! Instructions and terminators as data.

use crate::{
    BinaryOp, Block, CompareOp, ConvertOp, FaultCode, FuncId, Place, Type, UnaryOp, Value,
};
use smallvec::{SmallVec, smallvec};

/// An instruction. Values are defined once; results are kept by the function.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum InstData {
    /// `const bits`: a constant; for floats the bits of the number. Bits above the width are 0.
    Const {
        /// Type of the result.
        ty: Type,
        /// The value's bits.
        bits: u64,
    },
    /// A unary operation.
    Unary {
        /// Which.
        op: UnaryOp,
        /// Operand.
        arg: Value,
    },
    /// A binary operation.
    Binary {
        /// Which.
        op: BinaryOp,
        /// Left and right.
        args: [Value; 2],
    },
    /// A comparison; the result is `i1`.
    Compare {
        /// Which.
        op: CompareOp,
        /// Left and right.
        args: [Value; 2],
    },
    /// A conversion.
    Convert {
        /// Which.
        op: ConvertOp,
        /// Type of the result.
        to: Type,
        /// Operand.
        arg: Value,
    },
    /// `select c, a, b`: a if c is 1, else b. Both are already computed.
    Select {
        /// The `i1`.
        cond: Value,
        /// The value for 1 and the value for 0.
        args: [Value; 2],
    },
    /// The value at a place now.
    Load {
        /// From where.
        place: Place,
    },
    /// Changes the value at a place.
    Store {
        /// To where.
        place: Place,
        /// The new value.
        value: Value,
    },
    /// `copy to, from`: moves all that lies at one place to another of the same type, which may be a
    /// struct or an array, as if everything were read before anything is written. Where an index of
    /// `from` is out of bounds, zeros are moved; where one of `to` is, nothing happens.
    Copy {
        /// To where.
        to: Place,
        /// From where.
        from: Place,
    },
    /// `clear place`: makes all that lies at a place 0; nothing happens where an index is out of
    /// bounds.
    Clear {
        /// What becomes 0.
        place: Place,
    },
    /// `address place`: where a place of the state lies, an `i64`: one more than its byte offset in the
    /// region. It is 0 where an index is out of bounds, and for a reference that stands for nothing
    /// or for a local. Addresses mean the same in every scan, so the state and its image may hold
    /// them.
    Address {
        /// Of the state, a reference, or at an address.
        place: Place,
    },
    /// The time of this scan, `i64` nanoseconds.
    Now,
    /// `elapsed place, unit`: how many boundaries of `unit_ns` lie between the time kept in the
    /// `i64` at `place` and `now`; then keeps `now` there. With both times read as unsigned it is
    /// `now / unit - kept / unit`, at least 0 and at most the signed maximum of the result's type.
    Elapsed {
        /// Holds the time of the last execution, in nanoseconds.
        place: Place,
        /// Length of the unit in nanoseconds, at least 1.
        unit_ns: u64,
        /// `i32` or `i64`.
        ty: Type,
    },
    /// `step unit`: how many boundaries of `unit_ns` lie between the time of the scan before this
    /// one and `now`, computed and bounded like `elapsed`; 0 in the first scan. A scan that
    /// faulted does not count as a scan. Passes for hardware put it in place of `elapsed`; front
    /// ends do not use it.
    Step {
        /// Length of the unit in nanoseconds, at least 1.
        unit_ns: u64,
        /// `i32` or `i64`.
        ty: Type,
    },
    /// Calls a function; the results are those of its `return`.
    Call {
        /// The callee.
        func: FuncId,
        /// Places for the reference parameters. Their indices are read here, once; where one is
        /// out of bounds, every load through the reference gives 0 and every store does nothing.
        refs: Vec<Place>,
        /// Values for the parameters of the entry block.
        args: Vec<Value>,
    },
}

/// The values that something reads: seldom more than four.
pub type Values = SmallVec<[Value; 4]>;

impl InstData {
    /// The function that a call runs.
    pub fn callee(&self) -> Option<FuncId> {
        if let Self::Call { func, .. } = self {
            Some(*func)
        } else {
            None
        }
    }

    /// Every value the instruction reads, in text order.
    pub fn values(&self) -> Values {
        match self {
            Self::Const { .. } | Self::Now | Self::Step { .. } => Values::new(),
            Self::Unary { arg, .. } | Self::Convert { arg, .. } => smallvec![*arg],
            Self::Binary { args, .. } | Self::Compare { args, .. } => Values::from_slice(args),
            Self::Select { cond, args } => smallvec![*cond, args[0], args[1]],
            Self::Load { place }
            | Self::Elapsed { place, .. }
            | Self::Clear { place }
            | Self::Address { place } => place.values().collect(),
            Self::Copy { to, from } => to.values().chain(from.values()).collect(),
            Self::Store { place, value } => place.values().chain([*value]).collect(),
            Self::Call { refs, args, .. } => refs
                .iter()
                .flat_map(Place::values)
                .chain(args.iter().copied())
                .collect(),
        }
    }

    /// Applies `f` to every value the instruction reads.
    pub fn map_values(&mut self, mut f: impl FnMut(Value) -> Value) {
        match self {
            Self::Const { .. } | Self::Now | Self::Step { .. } => {}
            Self::Unary { arg, .. } | Self::Convert { arg, .. } => *arg = f(*arg),
            Self::Binary { args, .. } | Self::Compare { args, .. } => *args = args.map(f),
            Self::Select { cond, args } => {
                *cond = f(*cond);
                *args = args.map(f);
            }
            Self::Load { place }
            | Self::Elapsed { place, .. }
            | Self::Clear { place }
            | Self::Address { place } => {
                place.values_mut().for_each(|v| *v = f(*v));
            }
            Self::Copy { to, from } => {
                let values = to.values_mut().chain(from.values_mut());
                values.for_each(|v| *v = f(*v));
            }
            Self::Store { place, value } => {
                place.values_mut().for_each(|v| *v = f(*v));
                *value = f(*value);
            }
            Self::Call { refs, args, .. } => {
                refs.iter_mut()
                    .flat_map(Place::values_mut)
                    .for_each(|v| *v = f(*v));
                args.iter_mut().for_each(|v| *v = f(*v));
            }
        }
    }

    /// Every place the instruction names, in text order.
    pub fn places(&self) -> SmallVec<[&Place; 2]> {
        match self {
            Self::Load { place }
            | Self::Store { place, .. }
            | Self::Clear { place }
            | Self::Address { place }
            | Self::Elapsed { place, .. } => smallvec![place],
            Self::Copy { to, from } => smallvec![to, from],
            Self::Call { refs, .. } => refs.iter().collect(),
            Self::Const { .. }
            | Self::Unary { .. }
            | Self::Binary { .. }
            | Self::Compare { .. }
            | Self::Convert { .. }
            | Self::Select { .. }
            | Self::Now
            | Self::Step { .. } => SmallVec::new(),
        }
    }

    /// Every place the instruction names, for changes, in text order.
    pub fn places_mut(&mut self) -> SmallVec<[&mut Place; 2]> {
        match self {
            Self::Load { place }
            | Self::Store { place, .. }
            | Self::Clear { place }
            | Self::Address { place }
            | Self::Elapsed { place, .. } => smallvec![place],
            Self::Copy { to, from } => smallvec![to, from],
            Self::Call { refs, .. } => refs.iter_mut().collect(),
            Self::Const { .. }
            | Self::Unary { .. }
            | Self::Binary { .. }
            | Self::Compare { .. }
            | Self::Convert { .. }
            | Self::Select { .. }
            | Self::Now
            | Self::Step { .. } => SmallVec::new(),
        }
    }

    /// The place of one scalar or bit the instruction loads, stores or renews.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Load { place } | Self::Store { place, .. } | Self::Elapsed { place, .. } => {
                Some(place)
            }
            Self::Copy { .. } | Self::Clear { .. } | Self::Address { .. } => None,
            Self::Const { .. }
            | Self::Unary { .. }
            | Self::Binary { .. }
            | Self::Compare { .. }
            | Self::Convert { .. }
            | Self::Select { .. }
            | Self::Now
            | Self::Step { .. }
            | Self::Call { .. } => None,
        }
    }

    /// Whether the result depends on the operands alone, so that equal ones may be shared and
    /// unused ones dropped. Time is constant within a scan, so `now` and `step` are pure; so is where
    /// a place lies.
    pub fn is_pure(&self) -> bool {
        match self {
            Self::Const { .. }
            | Self::Unary { .. }
            | Self::Binary { .. }
            | Self::Compare { .. }
            | Self::Convert { .. }
            | Self::Select { .. }
            | Self::Address { .. }
            | Self::Now
            | Self::Step { .. } => true,
            Self::Load { .. }
            | Self::Store { .. }
            | Self::Copy { .. }
            | Self::Clear { .. }
            | Self::Elapsed { .. }
            | Self::Call { .. } => false,
        }
    }

    /// Whether leaving the instruction out is visible even when its results are unused.
    pub fn has_effect(&self) -> bool {
        !self.is_pure() && !matches!(self, Self::Load { .. })
    }
}

/// A jump target and the values for its parameters.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Target {
    /// Where to.
    pub block: Block,
    /// One value per parameter.
    pub args: Vec<Value>,
}

impl Target {
    /// A target without arguments.
    pub fn new(block: Block) -> Self {
        Self {
            block,
            args: Vec::new(),
        }
    }
}

/// How a block ends.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Terminator {
    /// Goes on elsewhere.
    Jump(Target),
    /// `brif c, then, else`.
    Brif {
        /// The `i1`.
        cond: Value,
        /// For 1.
        then: Target,
        /// For 0.
        otherwise: Target,
    },
    /// `switch v, default [k: target, …]`: the target whose number equals the integer's bits.
    Switch {
        /// An integer.
        value: Value,
        /// Numbers (bits, unique) and targets.
        cases: Vec<(u64, Target)>,
        /// For all other numbers.
        default: Target,
    },
    /// Leaves the function with its results.
    Return(Vec<Value>),
    /// Abandons the scan; state and outputs stay as they were before it.
    Fault(FaultCode),
}

impl Terminator {
    /// The targets, in text order.
    pub fn targets(&self) -> SmallVec<[&Target; 2]> {
        match self {
            Self::Jump(target) => smallvec![target],
            Self::Brif {
                then, otherwise, ..
            } => smallvec![then, otherwise],
            Self::Switch { cases, default, .. } => std::iter::once(default)
                .chain(cases.iter().map(|(_, target)| target))
                .collect(),
            Self::Return(_) | Self::Fault(_) => SmallVec::new(),
        }
    }

    /// The targets, for changes.
    pub fn targets_mut(&mut self) -> SmallVec<[&mut Target; 2]> {
        match self {
            Self::Jump(target) => smallvec![target],
            Self::Brif {
                then, otherwise, ..
            } => smallvec![then, otherwise],
            Self::Switch { cases, default, .. } => std::iter::once(default)
                .chain(cases.iter_mut().map(|(_, target)| target))
                .collect(),
            Self::Return(_) | Self::Fault(_) => SmallVec::new(),
        }
    }

    /// Every value read, target arguments included, in text order.
    pub fn values(&self) -> Values {
        let mut values = match self {
            Self::Brif { cond, .. } => smallvec![*cond],
            Self::Switch { value, .. } => smallvec![*value],
            Self::Return(values) => Values::from_slice(values),
            Self::Jump(_) | Self::Fault(_) => Values::new(),
        };
        for target in self.targets() {
            values.extend_from_slice(&target.args);
        }
        values
    }

    /// Applies `f` to every value read.
    pub fn map_values(&mut self, mut f: impl FnMut(Value) -> Value) {
        match self {
            Self::Brif { cond: value, .. } | Self::Switch { value, .. } => *value = f(*value),
            Self::Return(values) => values.iter_mut().for_each(|v| *v = f(*v)),
            Self::Jump(_) | Self::Fault(_) => {}
        }
        for target in self.targets_mut() {
            target.args.iter_mut().for_each(|v| *v = f(*v));
        }
    }
}
