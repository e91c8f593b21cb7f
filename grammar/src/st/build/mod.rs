//! What the productions of `st.lalrpop` build, and the mistakes only visible while building.
//!
//! Nodes are bounded in depth here: a tree that would grow too deep becomes an `Error` node, with
//! one message per unit.

mod damage;
mod expr;
mod literal;
mod number;
mod stmt;
mod time;
mod types;
mod unit;

use super::Tokens;
use super::token::Token;
use iecc_ast::st::{Arena, Id, Label, Member, Stmt, VarSection};
use iecc_ast::st::{Expr, Ident, ProgramConfig, Resource, Task};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{Span, TextRange};
use lalrpop_util::{ErrorRecovery, ParseError};
use std::collections::BTreeSet;

/// Why a parse stops before the end of the unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Damage {
    /// Something is wrong, and nothing was mended beforehand; or too much is wrong.
    Strict,
    /// The unit is closed by the word of another kind of unit.
    WrongCloser,
}

/// How many mistakes the parser recovers from in one unit.
const MAX_ERRORS: usize = 1000;

/// A mistake the parser found.
pub(crate) type SyntaxError = ParseError<u32, Token, Damage>;

/// Makes AST nodes from byte offsets in the file.
pub(crate) struct Build<'b, 't> {
    pub(crate) tokens: &'b Tokens<'t>,
    /// Where the unit begins in the file; ranges count from here.
    pub(crate) base: u32,
    pub(crate) arena: Arena,
    /// Mistakes in what the grammar accepts.
    pub(crate) diagnostics: Diagnostics,
    /// Mistakes the parser has recovered from.
    pub(crate) errors: Vec<SyntaxError>,
    /// Whether to stop at the first mistake.
    strict: bool,
    too_deep: bool,
    /// Whether a declaration is damaged so that its names are not known.
    pub(crate) lost_names: bool,
    /// Where brackets are that a message was given for.
    pub(crate) unbalanced: BTreeSet<u32>,
}

/// What has been read of a unit or method.
#[derive(Default)]
pub(crate) struct Parts {
    extends: Vec<Id<Expr>>,
    implements: Vec<Id<Expr>>,
    usings: Vec<Id<Expr>>,
    sections: Vec<VarSection>,
    members: Vec<Member>,
    body: Vec<Id<Stmt>>,
    /// The first statement that is not empty.
    first_statement: Option<TextRange>,
    /// Whether a message says that a section stands behind it.
    disordered: bool,
}

/// What has been read of a configuration or resource.
#[derive(Default)]
pub(crate) struct ConfigParts {
    sections: Vec<VarSection>,
    resources: Vec<Resource>,
    tasks: Vec<Task>,
    programs: Vec<ProgramConfig>,
}

/// An element of a configuration or resource.
#[derive(Clone, Copy)]
pub(crate) enum ConfigItem {
    Section(VarSection),
    Task(Task),
    Program(ProgramConfig),
}

/// What stands in the parentheses of a type.
#[derive(Clone, Copy)]
pub(crate) enum SpecItem {
    Value(Id<Expr>),
    Range(Id<Expr>, Id<Expr>),
    Named(Ident, Id<Expr>),
}

/// What stands in a CASE: labels with their first byte, or a statement.
pub(crate) enum CaseItem {
    Labels(u32, Vec<Label>),
    Statement(Id<Stmt>),
}

impl<'b, 't> Build<'b, 't> {
    pub(crate) fn new(tokens: &'b Tokens<'t>, base: u32, strict: bool) -> Self {
        Self {
            tokens,
            base,
            arena: Arena::new(),
            diagnostics: Diagnostics::new(),
            errors: Vec::new(),
            strict,
            too_deep: false,
            lost_names: false,
            unbalanced: BTreeSet::new(),
        }
    }

    /// A range of the unit, from offsets in the file.
    pub(crate) fn range(&self, start: u32, end: u32) -> TextRange {
        TextRange::new(start - self.base, end.max(start) - self.base)
    }

    fn span(&self, start: u32, end: u32) -> Span {
        Span::new(self.tokens.file, start, end)
    }

    fn span_of(&self, range: TextRange) -> Span {
        range.in_file(self.tokens.file, self.base)
    }

    fn text(&self, start: u32, end: u32) -> &'t str {
        &self.tokens.text[start as usize..end as usize]
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Whether a bracket between two bytes was put in or left out: what stands there may not be what
    /// was meant.
    fn is_unbalanced(&self, start: u32, end: u32) -> bool {
        self.unbalanced.range(start..end).next().is_some()
    }

    /// Notes a mistake that the parser recovers from; stops a strict parse.
    pub(crate) fn damaged(
        &mut self,
        recovery: ErrorRecovery<u32, Token, Damage>,
    ) -> Result<(), SyntaxError> {
        if self.strict || self.has_too_many_errors() {
            return Err(ParseError::User {
                error: Damage::Strict,
            });
        }
        self.errors.push(recovery.error);
        Ok(())
    }

    /// Whether so much is wrong that more messages are of no use.
    pub(crate) fn has_too_many_errors(&self) -> bool {
        self.errors.len() >= MAX_ERRORS
    }

    /// Says once per unit that it nests too deeply.
    fn too_deep(&mut self, what: &str, limit: u16, range: TextRange) {
        if self.too_deep {
            return;
        }
        self.too_deep = true;
        let message = format!("{what} nest more than {limit} deep");
        let diagnostic = Diagnostic::new(Code::E0013, self.span_of(range), message)
            .note("compute parts of it into variables of their own, or move them into a function");
        self.report(diagnostic);
    }
}
