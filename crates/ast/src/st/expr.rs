//! Expressions. Access paths (`a.b[i]^`) and the initial values of arrays and structures are
//! expressions too: where which of them may stand is for the semantic analysis to say.

use super::arena::{Id, List};
use super::literal::Literal;
use crate::names::Symbol;
use iecc_source::TextRange;

/// A name where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ident {
    /// Which name, whatever its case.
    pub name: Symbol,
    /// Where, with the spelling of the user.
    pub range: TextRange,
}

/// An expression where it stands, with the parentheses around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where.
    pub range: TextRange,
    /// How deep the tree is: 1 without children. At most [`super::MAX_EXPR_DEPTH`].
    pub depth: u16,
    /// Whether it stood in parentheses. They mean nothing, but tell what the user grouped.
    pub parenthesised: bool,
}

/// What an expression is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExprKind {
    /// A literal without its type prefix.
    Literal(Id<Literal>),
    /// A variable, enumerator, function, type or namespace.
    Name(Symbol),
    /// `INT#5`, `Color#Red`: a literal, or the name of an enumerator, of a named type.
    Typed {
        /// The type: a name, or a path through namespaces.
        ty: Id<Expr>,
        /// The literal or name.
        value: Id<Expr>,
    },
    /// `base.member`.
    Member {
        /// Structure, instance, or namespace.
        base: Id<Expr>,
        /// The name behind the dot.
        member: Ident,
    },
    /// `base.%B1`, `base.3`.
    Part {
        /// The bit string.
        base: Id<Expr>,
        /// Which part.
        part: Part,
    },
    /// `base[i, j]`.
    Index {
        /// The array or string.
        base: Id<Expr>,
        /// At least one.
        indices: List<Id<Expr>>,
    },
    /// `base^`.
    Deref(Id<Expr>),
    /// `%IX1.0`.
    Direct(Direct),
    /// `THIS`.
    This,
    /// `SUPER`.
    Super,
    /// `NULL`.
    Null,
    /// `REF(operand)`.
    Ref(Id<Expr>),
    /// `callee(arguments)`, of functions, blocks and methods, and `SUPER()`.
    Call {
        /// A path.
        callee: Id<Expr>,
        /// As written, named or not.
        arguments: List<Argument>,
    },
    /// An operator with one operand.
    Unary {
        /// The operator. The expression begins with it.
        op: UnaryOp,
        /// Its operand.
        operand: Id<Expr>,
    },
    /// An operator with two operands.
    Binary {
        /// The operator.
        op: BinaryOp,
        /// Its first byte, in the unit.
        op_start: u32,
        /// Left operand.
        left: Id<Expr>,
        /// Right operand.
        right: Id<Expr>,
    },
    /// `[a, 3(0)]`: the initial value of an array.
    ArrayValue(List<Id<Expr>>),
    /// `3(0, 1)` in the value of an array: the values so many times. Where the count is a named
    /// constant, it is a [`ExprKind::Call`].
    Repeat {
        /// How many times: a literal.
        count: Id<Expr>,
        /// What; empty for the default of the element type.
        values: List<Id<Expr>>,
    },
    /// `(a := 1, b := 2)`: the initial value of a structure or instance. All arguments are named
    /// inputs.
    StructValue(List<Argument>),
    /// Something a message has been given for.
    Error,
}

impl ExprKind {
    /// The name, where it is nothing else.
    pub fn name(self) -> Option<Symbol> {
        if let Self::Name(name) = self {
            Some(name)
        } else {
            None
        }
    }

    /// A name, or the last name of a path.
    pub fn last_name(self) -> Option<Symbol> {
        if let Self::Member { member, .. } = self {
            Some(member.name)
        } else {
            self.name()
        }
    }

    /// What a member, part or subscript is taken of.
    pub fn base(self) -> Option<Id<Expr>> {
        if let Self::Member { base, .. } | Self::Part { base, .. } | Self::Index { base, .. } = self
        {
            Some(base)
        } else {
            None
        }
    }
}

/// An element in the parentheses of a call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Argument {
    /// How it names its parameter.
    pub kind: ArgumentKind,
    /// The value or target. `None` where nothing stands behind `=>`.
    pub value: Option<Id<Expr>>,
    /// All of it.
    pub range: TextRange,
}

/// How an argument names its parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArgumentKind {
    /// By its position.
    Positional,
    /// `name := value`.
    Input(Ident),
    /// `name => target`.
    Output(Ident),
    /// `NOT name => target`.
    NegatedOutput(Ident),
}

/// Part of a bit string.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// How large.
    pub size: AddressSize,
    /// Which, counted from the right.
    pub index: u32,
    /// Whether it is written `.3` and not `.%X3`.
    pub short: bool,
}

/// A direct address. `%IX1.7` has the fields 1 and 7.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Direct {
    /// The resource in front, in the access paths of a configuration.
    pub resource: Option<Symbol>,
    /// I, Q or M; none for a place in the structure around it, as `%X3.0`.
    pub area: Option<Area>,
    /// The letter behind it; none means a bit.
    pub size: Option<AddressSize>,
    /// The numbers, most significant first. `None` is `*`: VAR_CONFIG says where.
    pub fields: Option<List<u32>>,
}

/// What a direct address points into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Area {
    /// I.
    Input,
    /// Q.
    Output,
    /// M.
    Memory,
}

/// The size letter of an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AddressSize {
    /// X.
    Bit,
    /// B, 8 bits.
    Byte,
    /// W, 16 bits.
    Word,
    /// D, 32 bits.
    DoubleWord,
    /// L, 64 bits.
    LongWord,
}

/// Operators with one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnaryOp {
    /// `-`
    Negate,
    /// `+`
    Plus,
    /// `NOT`
    Not,
}

/// Operators with two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BinaryOp {
    /// `**`
    Power,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `MOD`
    Modulo,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `=`
    Equal,
    /// `<>`
    NotEqual,
    /// `AND`, `&`
    And,
    /// `XOR`
    Xor,
    /// `OR`
    Or,
    /// `AND_THEN` (CODESYS): the right side only when it matters.
    AndThen,
    /// `OR_ELSE` (CODESYS): the right side only when it matters.
    OrElse,
}

impl BinaryOp {
    /// How tight the operator binds: larger is tighter. All of them group to the left. `=` and
    /// `<>` bind weaker than the other comparisons.
    pub fn binding(self) -> u8 {
        match self {
            Self::Power => 8,
            Self::Multiply | Self::Divide | Self::Modulo => 7,
            Self::Add | Self::Subtract => 6,
            Self::Less | Self::LessEqual | Self::Greater | Self::GreaterEqual => 5,
            Self::Equal | Self::NotEqual => 4,
            Self::And | Self::AndThen => 3,
            Self::Xor => 2,
            Self::Or | Self::OrElse => 1,
        }
    }

    /// The operator as the standard spells it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Power => "**",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Modulo => "MOD",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
            Self::Equal => "=",
            Self::NotEqual => "<>",
            Self::And => "AND",
            Self::Xor => "XOR",
            Self::Or => "OR",
            Self::AndThen => "AND_THEN",
            Self::OrElse => "OR_ELSE",
        }
    }
}

impl UnaryOp {
    /// The operator as the standard spells it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Negate => "-",
            Self::Plus => "+",
            Self::Not => "NOT",
        }
    }
}

impl AddressSize {
    /// The letter.
    pub fn letter(self) -> char {
        match self {
            Self::Bit => 'X',
            Self::Byte => 'B',
            Self::Word => 'W',
            Self::DoubleWord => 'D',
            Self::LongWord => 'L',
        }
    }
}

impl Area {
    /// The letter.
    pub fn letter(self) -> char {
        match self {
            Self::Input => 'I',
            Self::Output => 'Q',
            Self::Memory => 'M',
        }
    }
}
