//! The netlist: combinational logic as a graph in which equal nodes are one node.
//!
//! Every net is a plain vector of bits with a width; nothing in it is signed. Operands have exactly
//! the width the operation needs, so extension, truncation and the sign rules of Verilog never come
//! into play. The constructors in `build.rs` are the only way to add nodes.
//!
//! Nodes are created after their operands, so the order of [`Net`] is an order of evaluation.

use cranelift_entity::{PrimaryMap, entity_impl};
use iecc_ir::Origin;
use std::collections::BTreeMap;

/// A node of the netlist.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Net(u32);
entity_impl!(Net, "n");

/// A number in as many bits as it needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Word {
    pub(crate) net: Net,
    /// Whether the highest bit is a sign.
    pub(crate) signed: bool,
}

/// Where values come from at the start of a scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Source {
    /// A register of the state, by position in the list of state leaves.
    Register(u32),
    /// An input port, by position.
    Input(u32),
    /// A tick divider, by position.
    Step(u32),
}

/// Operations whose operands and result have one width.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Gate {
    And,
    Or,
    Xor,
    Add,
    Sub,
    Mul,
}

/// Comparisons of operands of one width.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Relation {
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
}

impl Relation {
    /// What holds exactly where it does not.
    pub(crate) fn inverted(self) -> Self {
        match self {
            Self::Eq => Self::Ne,
            Self::Ne => Self::Eq,
            Self::Lt => Self::Ge,
            Self::Le => Self::Gt,
            Self::Gt => Self::Le,
            Self::Ge => Self::Lt,
        }
    }

    /// The same of the operands in the other order.
    pub(crate) fn swapped(self) -> Self {
        match self {
            Self::Eq | Self::Ne => self,
            Self::Lt => Self::Gt,
            Self::Le => Self::Ge,
            Self::Gt => Self::Lt,
            Self::Ge => Self::Le,
        }
    }
}

/// Shifts by a net. The operand has at most `2^(width of the count)` bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Shift {
    Left,
    Right,
    RightSigned,
}

/// What a node computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Op {
    Const(u128),
    Source(Source),
    Not(Net),
    Gate(Gate, [Net; 2]),
    /// The flag says that the operands are two's complement numbers.
    Compare(Relation, bool, [Net; 2]),
    /// `condition ? first : second`.
    Mux(Net, [Net; 2]),
    Shift(Shift, [Net; 2]),
    /// The bits from this one up, as many as the node is wide.
    Slice(Net, u32),
    ZeroExtend(Net),
    SignExtend(Net),
    /// High bits, then low bits.
    Concat([Net; 2]),
}

impl Op {
    /// The operands, in order.
    pub(crate) fn operands(self) -> Vec<Net> {
        match self {
            Self::Const(_) | Self::Source(_) => Vec::new(),
            Self::Not(a) | Self::Slice(a, _) | Self::ZeroExtend(a) | Self::SignExtend(a) => vec![a],
            Self::Gate(_, args)
            | Self::Compare(_, _, args)
            | Self::Shift(_, args)
            | Self::Concat(args) => args.to_vec(),
            Self::Mux(condition, args) => vec![condition, args[0], args[1]],
        }
    }
}

/// A node with its width and the place in the program it was first needed for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) op: Op,
    pub(crate) width: u32,
    pub(crate) origin: Option<Origin>,
}

/// The graph.
#[derive(Debug, Default)]
pub(crate) struct Netlist {
    nodes: PrimaryMap<Net, Node>,
    known: BTreeMap<(Op, u32), Net>,
    /// Recorded with new nodes.
    pub(crate) origin: Option<Origin>,
}

impl Netlist {
    /// The node of a net.
    pub(crate) fn node(&self, net: Net) -> Node {
        self.nodes[net]
    }

    /// The operation of a net.
    pub(crate) fn op(&self, net: Net) -> Op {
        self.nodes[net].op
    }

    /// The number of bits of a net.
    pub(crate) fn width(&self, net: Net) -> u32 {
        self.nodes[net].width
    }

    /// All nets in order of evaluation.
    pub(crate) fn nets(&self) -> impl DoubleEndedIterator<Item = Net> + use<> {
        self.nodes.keys()
    }

    /// The number, if the net is constant.
    pub(crate) fn as_const(&self, net: Net) -> Option<u128> {
        if let Op::Const(bits) = self.op(net) {
            Some(bits)
        } else {
            None
        }
    }

    /// The register, port or divider, if the net is one.
    pub(crate) fn as_source(&self, net: Net) -> Option<Source> {
        if let Op::Source(source) = self.op(net) {
            Some(source)
        } else {
            None
        }
    }

    /// The node for an operation, made unless an equal one exists.
    pub(crate) fn intern(&mut self, op: Op, width: u32) -> Net {
        if let Some(&net) = self.known.get(&(op, width)) {
            return net;
        }
        let origin = self.origin;
        let net = self.nodes.push(Node { op, width, origin });
        self.known.insert((op, width), net);
        net
    }
}

/// All ones in the low `width` bits, as far as numbers here go: constants of wider nets are below
/// 2^128.
pub(crate) fn mask(width: u32) -> u128 {
    match width {
        0 => 0,
        1..=128 => u128::MAX >> (128 - width),
        _ => u128::MAX,
    }
}
