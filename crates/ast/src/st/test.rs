//! Unit tests: TEST, SETUP, TEARDOWN, and what may stand in them alone.

use super::arena::{Id, List};
use super::decl::VarSection;
use super::expr::Expr;
use super::stmt::Block;
use iecc_source::TextRange;

/// A test, or what runs before or after the tests of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Test {
    /// Which.
    pub kind: TestKind,
    /// The title of a test: a literal.
    pub title: Option<Id<Expr>>,
    /// Its variables.
    pub sections: List<VarSection>,
    /// Its statements.
    pub body: Block,
    /// The words that open it: the title included.
    pub opener: TextRange,
    /// All of it.
    pub range: TextRange,
}

/// Which unit a [`Test`] is.
#[expect(missing_docs, reason = "the words of the language")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TestKind {
    Test,
    Setup,
    Teardown,
}

impl TestKind {
    /// The word that opens it; `END_` and the word closes it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Test => "TEST",
            Self::Setup => "SETUP",
            Self::Teardown => "TEARDOWN",
        }
    }
}
