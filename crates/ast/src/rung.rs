//! One ladder rung: a series of instructions and branches, and the expressions in operands.
//!
//! The shape follows the power flow: a [`Rung`] is a series; a [`Branch`] is an OR of legs, each
//! again a series, an empty leg being a plain wire. `Display` gives the canonical neutral text,
//! which parses back to the same tree.

use crate::{Name, RealText, StringLiteral};
use iecc_source::{Span, Spanned};

/// A series of elements; condition flows from left to right.
pub type Series = Vec<Element>;

/// A whole rung, from its first instruction to the semicolon.
#[derive(Debug, Clone, PartialEq)]
pub struct Rung {
    /// The top-level series; empty for the rung `;`.
    pub elements: Series,
    /// The rung text with its semicolon.
    pub span: Span,
}

/// One thing on a wire.
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// An instruction or Add-On Instruction call.
    Instruction(Instruction),
    /// Parallel legs.
    Branch(Branch),
}

/// Parallel legs, scanned top to bottom, every one of them in every scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// At least one leg.
    pub legs: Vec<Leg>,
    /// From `[` to `]`.
    pub span: Span,
}

/// One leg of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// The series on this leg; empty is a plain wire, that is true-through.
    pub elements: Series,
    /// The text of the leg; for an empty leg the point before the `,` or `]` that ends it.
    pub span: Span,
}

/// A mnemonic with its operands.
#[derive(Debug, Clone, PartialEq)]
pub struct Instruction {
    /// Built-in mnemonic or name of an Add-On Instruction, as spelled.
    pub mnemonic: Name,
    /// Operands in the order written.
    pub operands: Vec<Operand>,
    /// From the mnemonic to `)`.
    pub span: Span,
}

/// One operand.
#[derive(Debug, Clone, PartialEq)]
pub struct Operand {
    /// What is written.
    pub kind: OperandKind,
    /// Where.
    pub span: Span,
}

/// The forms of an operand.
#[derive(Debug, Clone, PartialEq)]
pub enum OperandKind {
    /// Nothing between two commas, as in `GSV(WallClockTime,,DateTime,now[0])`.
    Empty,
    /// `?`: the value lives in the backing tag (`TON(t,?,?)`).
    InTag,
    /// A value, a tag, a name or an expression. Which of these a lone name is (tag, routine,
    /// label, keyword such as `ALL`) depends on the instruction.
    Expr(Expr),
    /// Words that are no expression, such as `% of Maximum`, with single blanks between words.
    Words(String),
}

/// An expression; the span includes parentheses around it.
#[derive(Debug, Clone, PartialEq)]
pub struct Expr {
    /// What is written.
    pub kind: ExprKind,
    /// Where.
    pub span: Span,
}

/// The forms of an expression.
#[derive(Debug, Clone, PartialEq)]
pub enum ExprKind {
    /// An integer without sign.
    Int(IntLiteral),
    /// A floating-point number without sign.
    Real(RealText),
    /// A quoted string.
    String(StringLiteral),
    /// A tag, or part of one.
    Reference(Reference),
    /// An operator before its operand.
    Unary {
        /// The operator.
        op: Spanned<UnaryOp>,
        /// What it applies to.
        operand: Box<Expr>,
    },
    /// An operator between its operands.
    Binary {
        /// The operator.
        op: Spanned<BinaryOp>,
        /// Left operand.
        left: Box<Expr>,
        /// Right operand.
        right: Box<Expr>,
    },
    /// A function call such as `SQR(x)`.
    Call {
        /// The function, as spelled.
        function: Name,
        /// Its arguments.
        arguments: Vec<Expr>,
    },
}

/// An integer literal. Fits 64 bits; a sign is a [`UnaryOp::Negate`] around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IntLiteral {
    /// The magnitude.
    pub value: u64,
    /// How it is written; non-decimal literals are zero-filled, not sign-extended.
    pub radix: Radix,
    /// The type suffix, if any.
    pub suffix: Option<IntSuffix>,
}

/// The base an integer is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Radix {
    /// `2#`
    Binary,
    /// `8#`
    Octal,
    /// no prefix
    Decimal,
    /// `16#`
    Hexadecimal,
}

/// A type suffix of an integer literal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntSuffix {
    /// `U`: UDINT
    Unsigned,
    /// `L`: LINT
    Long,
    /// `UL`: ULINT
    UnsignedLong,
}

/// A tag with the path into it: `\Program.Local:2:I.Data[3].[n]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The program of a `\Program.` path.
    pub program: Option<Name>,
    /// The tag name; parts joined by colons (`Local:2:I`, `S:FS`) are one name, without blanks.
    pub base: Name,
    /// The path into the tag, outermost first.
    pub members: Vec<Member>,
    /// The whole reference.
    pub span: Span,
}

/// One step of a path into a tag.
#[derive(Debug, Clone, PartialEq)]
pub enum Member {
    /// `.name`
    Field(Name),
    /// `.5`: a bit of an integer
    Bit(Spanned<u32>),
    /// `.[expression]`: a computed bit of an integer
    BitIndex(Box<Expr>),
    /// `[i]`, `[i,j]` or `[i,j,k]`
    Index(Vec<Expr>),
}

/// Operators before their operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnaryOp {
    /// `-`
    Negate,
    /// `NOT`: bitwise
    Not,
    /// `!`: logical
    LogicalNot,
}

/// Operators between their operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BinaryOp {
    /// `||`
    LogicalOr,
    /// `^^`
    LogicalXor,
    /// `&&`
    LogicalAnd,
    /// `OR`: bitwise
    Or,
    /// `XOR`: bitwise
    Xor,
    /// `AND` or `&`: bitwise
    And,
    /// `=`
    Equal,
    /// `<>`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `MOD`
    Modulo,
    /// `**`
    Power,
}

impl BinaryOp {
    /// How tightly the operator binds; a higher number binds tighter. All associate to the left.
    pub fn precedence(self) -> u8 {
        match self {
            Self::LogicalOr => 1,
            Self::LogicalXor => 2,
            Self::LogicalAnd => 3,
            Self::Or => 4,
            Self::Xor => 5,
            Self::And => 6,
            Self::Equal
            | Self::NotEqual
            | Self::Less
            | Self::LessEqual
            | Self::Greater
            | Self::GreaterEqual => 7,
            Self::Add | Self::Subtract => 8,
            Self::Multiply | Self::Divide | Self::Modulo => 9,
            Self::Power => 11,
        }
    }

    /// The operator in neutral text.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::LogicalOr => "||",
            Self::LogicalXor => "^^",
            Self::LogicalAnd => "&&",
            Self::Or => "OR",
            Self::Xor => "XOR",
            Self::And => "AND",
            Self::Equal => "=",
            Self::NotEqual => "<>",
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Modulo => "MOD",
            Self::Power => "**",
        }
    }
}

impl UnaryOp {
    /// Binds tighter than all binary operators except `**`.
    pub const PRECEDENCE: u8 = 10;

    /// The operator in neutral text.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Negate => "-",
            Self::Not => "NOT",
            Self::LogicalNot => "!",
        }
    }
}

impl Rung {
    /// All instructions, branches included, in the order they are scanned.
    pub fn instructions(&self) -> Vec<&Instruction> {
        let mut found = Vec::new();
        collect_instructions(&self.elements, &mut found);
        found
    }
}

fn collect_instructions<'r>(series: &'r [Element], found: &mut Vec<&'r Instruction>) {
    for element in series {
        match element {
            Element::Instruction(instruction) => found.push(instruction),
            Element::Branch(branch) => {
                branch
                    .legs
                    .iter()
                    .for_each(|leg| collect_instructions(&leg.elements, found));
            }
        }
    }
}

impl Expr {
    /// The reference, when the expression is nothing else.
    pub fn as_reference(&self) -> Option<&Reference> {
        match &self.kind {
            ExprKind::Reference(reference) => Some(reference),
            ExprKind::Int(_)
            | ExprKind::Real(_)
            | ExprKind::String(_)
            | ExprKind::Unary { .. }
            | ExprKind::Binary { .. }
            | ExprKind::Call { .. } => None,
        }
    }
}

impl Reference {
    /// The name, when the reference is one bare name (a tag, but also a routine, a label or a
    /// keyword, as the instruction has it).
    pub fn as_name(&self) -> Option<&Name> {
        (self.program.is_none() && self.members.is_empty()).then_some(&self.base)
    }
}

impl Operand {
    /// The bare name, when the operand is nothing else.
    pub fn as_name(&self) -> Option<&Name> {
        match &self.kind {
            OperandKind::Expr(expr) => expr.as_reference().and_then(Reference::as_name),
            OperandKind::Empty | OperandKind::InTag | OperandKind::Words(_) => None,
        }
    }
}

impl Member {
    /// Where the member stands.
    pub fn span(&self) -> Span {
        match self {
            Self::Field(name) => name.span,
            Self::Bit(bit) => bit.span,
            Self::BitIndex(index) => index.span,
            Self::Index(indexes) => {
                let first = indexes
                    .first()
                    .expect("an index has at least one expression");
                indexes
                    .iter()
                    .fold(first.span, |span, index| span.to(index.span))
            }
        }
    }
}
