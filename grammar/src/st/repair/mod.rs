//! Makes the blocks and brackets of a damaged unit balance before it is parsed again.
//!
//! What is plainly missing is put in as empty tokens (a closer, a bracket, a semicolon, THEN, a
//! name), what is plainly too much is left out, and each such mend gives exactly one message. So
//! the parser, which could only guess where a block should have ended, is left with damage inside
//! single statements and declarations, from which it recovers at the next semicolon.
//!
//! Which block is not closed is decided by counting. If that does not come out even, it is tried
//! again with the indentation of the program, and the way with fewer messages is taken: most
//! programs are indented as they are meant.

mod blocks;
mod bodies;
mod brackets;
mod closers;
mod headers;
mod names;
mod report;
mod separators;
mod spelling;

use super::build::SyntaxError;
use super::feed::{Feed, Located};
use super::lexer::Tokens;
use super::token::{Kind, Token};
use blocks::Block;
use iecc_ast::Symbol;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::Span;
use lalrpop_util::ParseError;
use std::collections::BTreeSet;

pub(crate) use spelling::{is_misspelt_closer, misspelt_unit};

/// The tokens of a mended unit.
pub(crate) struct Repaired {
    pub(crate) tokens: Vec<Located>,
    /// Whether a name is missing, or the section that names belong to.
    pub(crate) unsorted: bool,
    /// Where tokens were put in that a message tells of.
    told: BTreeSet<u32>,
    /// Where brackets are that a message tells of.
    pub(crate) brackets: BTreeSet<u32>,
}

impl Repaired {
    /// Whether a message has been given for what the parser finds wrong here.
    pub(crate) fn is_known(&self, error: &SyntaxError, feed: &Feed) -> bool {
        let ParseError::UnrecognizedToken {
            token: (start, token, end),
            ..
        } = error
        else {
            return false;
        };
        let put_in = start == end && self.told.contains(start);
        let told = put_in || token.kind == Kind::BadNumber;
        told || feed.holes.binary_search(start).is_ok() || self.has_bracket_message(*start)
    }

    /// Whether a message about a bracket has been given in the statement or declaration at a byte:
    /// what else is wrong there mostly follows from it.
    fn has_bracket_message(&self, at: u32) -> bool {
        let ends = |token: &&Located| token.1.kind == Kind::Semicolon;
        let (before, behind) = self
            .tokens
            .split_at(self.tokens.partition_point(|t| t.0 < at));
        let first = before.iter().rev().find(ends).map_or(0, |token| token.2);
        let last = behind.iter().find(ends).map_or(u32::MAX, |token| token.0);
        self.brackets.range(first..=last).next().is_some()
    }
}

/// Mends the tokens of a unit, and tells in `found` what was mended.
pub(crate) fn repair(
    tokens: &Tokens<'_>,
    opener: Kind,
    feed: &Feed,
    found: &mut Diagnostics,
) -> Repaired {
    let counted = Repair::run(tokens, opener, feed, Trust::Counting);
    let mended = if counted.block_messages() == 0 {
        counted
    } else {
        let indented = Repair::run(tokens, opener, feed, Trust::Indentation);
        if indented.block_messages() <= counted.block_messages() {
            indented
        } else {
            counted
        }
    };
    let brackets = mended.diagnostics.iter();
    let brackets = brackets
        .filter(|diagnostic| diagnostic.code == Code::E0025)
        .filter_map(|diagnostic| Some(diagnostic.primary.as_ref()?.span.start))
        .collect();
    found.append(mended.diagnostics);
    Repaired {
        tokens: mended.out,
        unsorted: mended.unsorted,
        told: mended.told,
        brackets,
    }
}

/// Words that go on behind a bracket, never in it.
fn never_in_brackets(kind: Kind) -> bool {
    matches!(kind, Kind::Then | Kind::Of | Kind::Do | Kind::To | Kind::By)
}

/// What tells which block a closer belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Trust {
    Counting,
    Indentation,
}

struct Repair<'r, 't> {
    tokens: &'r Tokens<'t>,
    feed: &'r Feed,
    trust: Trust,
    out: Vec<Located>,
    diagnostics: Diagnostics,
    told: BTreeSet<u32>,
    /// Open blocks, innermost last; the unit is the first.
    blocks: Vec<Block>,
    /// Open brackets of the statement or declaration.
    brackets: Vec<Located>,
    /// Whether a statement or declaration has begun and not ended.
    pending: bool,
    /// Where in `out` it has begun.
    begin: usize,
    /// Whether a name must come next.
    name_due: bool,
    /// Whether a value behind RETURN is being left out.
    skips_value: bool,
    /// Reserved words that a message calls wrong names.
    misnamed: BTreeSet<Symbol>,
    /// Whether the body is in another language, and left out.
    foreign: bool,
    /// Where the statement or declaration begins in `out` for which a bracket was reported.
    unbalanced: Option<usize>,
    /// A token that a message has been given for, which is left out.
    dropped: Option<usize>,
    /// Whether a name is missing, or the section that names belong to.
    unsorted: bool,
}

impl<'r, 't> Repair<'r, 't> {
    fn run(tokens: &'r Tokens<'t>, opener: Kind, feed: &'r Feed, trust: Trust) -> Self {
        let mut repair = Self {
            tokens,
            feed,
            trust,
            out: Vec::with_capacity(feed.tokens.len() + 8),
            diagnostics: Diagnostics::new(),
            told: BTreeSet::new(),
            blocks: Vec::new(),
            brackets: Vec::new(),
            pending: false,
            begin: 0,
            name_due: false,
            skips_value: false,
            misnamed: BTreeSet::new(),
            foreign: false,
            unbalanced: None,
            dropped: None,
            unsorted: false,
        };
        repair.open_unit(opener);
        let mut at = 1;
        while at < feed.tokens.len() {
            repair.take(at);
            at += 1;
        }
        repair.close_unit();
        repair
    }

    /// How many messages are about blocks.
    fn block_messages(&self) -> usize {
        let codes = self.diagnostics.iter().map(|diagnostic| diagnostic.code);
        codes
            .filter(|code| [Code::E0011, Code::E0012].contains(code))
            .count()
    }

    fn open_unit(&mut self, opener: Kind) {
        let mut first = self.feed.tokens[0];
        if first.1.kind == Kind::Word {
            self.misspelt_opener_of_unit(first, opener);
            first.1.kind = opener;
        }
        self.out.push(first);
        self.name_due = names::needs_name(opener);
        if opener != Kind::Using {
            self.blocks.push(Block::new(first));
        }
    }

    /// Takes the next token: first mends what is missing before it.
    fn take(&mut self, at: usize) {
        let (start, mut token, end) = self.feed.tokens[at];
        if self.dropped == Some(at) || self.is_foreign(at) {
            return;
        }
        if let Some(kind) = self.corrected(at) {
            token.kind = kind;
        }
        if self.is_misnamed(at) {
            token.kind = Kind::Word;
        }
        if self.skips_value(at, token.kind) {
            return;
        }
        self.settle_name(token);
        let ends = token.kind == Kind::Semicolon || self.is_structural(token.kind);
        if ends || never_in_brackets(token.kind) || self.begins_after_open_bracket(at, token.kind) {
            self.close_brackets();
        }
        if self.brackets.is_empty() && !self.settle_separator(at, token.kind) {
            return;
        }
        match token.kind {
            Kind::OpenParen | Kind::OpenBracket => self.brackets.push((start, token, end)),
            Kind::CloseParen | Kind::CloseBracket if !self.close_bracket((start, token, end)) => {
                return;
            }
            kind if ends => return self.structure((start, Token { kind, ..token }, end)),
            _ => {}
        }
        if !self.pending {
            self.begin = self.out.len();
        }
        self.push((start, token, end));
        self.pending = !self.is_label_end(token.kind);
    }

    /// Puts in an empty token before the statement that has begun.
    fn put_at_begin(&mut self, kind: Kind) -> Located {
        let at = self.out[self.begin].0;
        let token = Token {
            kind,
            symbol: self.tokens.no_name,
            start: at,
            end: at,
        };
        self.out.insert(self.begin, (at, token, at));
        (at, token, at)
    }

    fn push(&mut self, token: Located) {
        self.out.push(token);
    }

    /// Puts in an empty token behind the last one.
    fn put(&mut self, kind: Kind) {
        let at = self.last_end();
        let token = Token {
            kind,
            symbol: self.tokens.no_name,
            start: at,
            end: at,
        };
        self.out.push((at, token, at));
    }

    /// The byte behind the last token.
    fn last_end(&self) -> u32 {
        self.out.last().map_or(0, |token| token.2)
    }

    fn last_kind(&self) -> Option<Kind> {
        self.out.last().map(|token| token.1.kind)
    }

    fn next_kind(&self, at: usize) -> Option<Kind> {
        self.feed.tokens.get(at + 1).map(|token| token.1.kind)
    }

    /// Whether a token stands on a later line than the one before it.
    fn on_new_line(&self, at: usize) -> bool {
        let before = self.feed.tokens[at - 1].2 as usize;
        let start = self.feed.tokens[at].0 as usize;
        self.tokens.text[before..start].contains('\n')
    }

    /// The column of a token, if it is the first of its line. Tabs count as one.
    fn indentation(&self, (start, ..): Located) -> Option<usize> {
        let before = &self.tokens.text.as_bytes()[..start as usize];
        let blank = |byte: &&u8| matches!(byte, b' ' | b'\t');
        let column = before.iter().rev().take_while(blank).count();
        match before.len().checked_sub(column + 1) {
            Some(at) => (before[at] == b'\n').then_some(column),
            None => Some(column),
        }
    }

    fn span(&self, start: u32, end: u32) -> Span {
        Span::new(self.tokens.file, start, end)
    }

    fn span_of(&self, token: Located) -> Span {
        self.span(token.0, token.2)
    }

    fn text(&self, token: Located) -> &'t str {
        &self.tokens.text[token.0 as usize..token.2 as usize]
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Reports, and remembers that what is put in next has its message.
    fn tell(&mut self, diagnostic: Diagnostic) {
        self.told.insert(self.last_end());
        self.report(diagnostic);
    }
}
