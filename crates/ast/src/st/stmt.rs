//! Statements. Which of them may stand where, and of what types their parts are, is for others to
//! say.

use super::arena::{Id, List};
use super::expr::Expr;
use iecc_source::TextRange;

/// Statements in their order.
pub type Block = List<Id<Stmt>>;

/// A statement where it stands, with its semicolon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stmt {
    /// What it is.
    pub kind: StmtKind,
    /// Where.
    pub range: TextRange,
    /// How deep statements nest: 1 without inner ones. At most [`super::MAX_BLOCK_DEPTH`].
    pub depth: u16,
}

/// What a statement is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StmtKind {
    /// `target := value;`
    Assign {
        /// A path or a direct address.
        target: Id<Expr>,
        /// Which assignment.
        op: AssignOp,
        /// What is assigned.
        value: Id<Expr>,
    },
    /// `a := b := value;` (CODESYS)
    AssignAll {
        /// As in the text: the last one is assigned first, and gives its value to the one before. At
        /// least two.
        targets: List<Id<Expr>>,
        /// What is assigned.
        value: Id<Expr>,
    },
    /// A call whose result nobody takes. Any path is accepted here.
    Call(Id<Expr>),
    /// `IF … ELSIF … ELSE … END_IF`
    If {
        /// IF and every ELSIF: at least one.
        arms: List<IfArm>,
        /// ELSE.
        otherwise: Option<Block>,
    },
    /// `CASE … OF … ELSE … END_CASE`
    Case {
        /// What is compared.
        selector: Id<Expr>,
        /// The groups in their order.
        arms: List<CaseArm>,
        /// ELSE.
        otherwise: Option<Block>,
    },
    /// `FOR variable := from TO to BY by DO … END_FOR`
    For {
        /// The control variable; a path is accepted.
        variable: Id<Expr>,
        /// First value.
        from: Id<Expr>,
        /// Last value.
        to: Id<Expr>,
        /// Step; 1 if not given.
        by: Option<Id<Expr>>,
        /// What is repeated.
        body: Block,
    },
    /// `WHILE condition DO … END_WHILE`
    While {
        /// Tested before each pass.
        condition: Id<Expr>,
        /// What is repeated.
        body: Block,
    },
    /// `REPEAT … UNTIL until END_REPEAT`
    Repeat {
        /// What is repeated.
        body: Block,
        /// Tested after each pass; ends the loop.
        until: Id<Expr>,
    },
    /// `RETURN;`
    Return,
    /// `EXIT;`
    Exit,
    /// `CONTINUE;`
    Continue,
    /// `MOCK instance;` in a test: calls of the instance do nothing.
    Mock(Id<Expr>),
    /// `MOCK_FUNCTION function RETURNS value;` in a test: calls of the function give the value.
    MockFunction {
        /// A path.
        function: Id<Expr>,
        /// What calls give.
        value: Id<Expr>,
    },
    /// `;`
    Empty,
    /// Something a message has been given for.
    Error,
}

/// Which assignment a statement is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AssignOp {
    /// `:=`
    Set,
    /// `?=`: NULL if the value is of another type.
    Attempt,
    /// `S=` (CODESYS): TRUE if the value is, else unchanged.
    Latch,
    /// `R=` (CODESYS): FALSE if the value is TRUE, else unchanged.
    Unlatch,
    /// `REF=` (CODESYS): lets a REFERENCE stand for another variable.
    Bind,
}

impl AssignOp {
    /// The sign.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Set => ":=",
            Self::Attempt => "?=",
            Self::Latch => "S=",
            Self::Unlatch => "R=",
            Self::Bind => "REF=",
        }
    }
}

/// A condition and what it guards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IfArm {
    /// The condition.
    pub condition: Id<Expr>,
    /// The statements.
    pub body: Block,
    /// From IF or ELSIF to the end of the statements.
    pub range: TextRange,
}

/// Labels and their statements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseArm {
    /// At least one.
    pub labels: List<Label>,
    /// The statements.
    pub body: Block,
    /// All of it.
    pub range: TextRange,
}

/// One label of a CASE: a value or a range of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Label {
    /// The value, or the first one.
    pub low: Id<Expr>,
    /// The last value of a range.
    pub high: Option<Id<Expr>>,
}
