//! The blocks that are open, and the words that open, divide and close them.

use super::{Kind, Located, Repair};

/// An open block.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    /// The word that opened it.
    pub(super) opener: Located,
    /// THEN, DO, OF, or END_REPEAT, where that word must come next.
    pub(super) awaits: Option<Kind>,
    /// Whether what names the unit or member still goes on: there are no semicolons in it.
    pub(super) in_header: bool,
    /// Whether ELSE has been seen.
    pub(super) has_else: bool,
    /// Whether a message says what is wrong with its opener.
    pub(super) told: bool,
    /// Whether what stands in it is being left out.
    pub(super) skips: bool,
    /// Whether its header has a colon.
    pub(super) has_colon: bool,
    /// Whether its header has ON.
    pub(super) has_on: bool,
    /// Whether GET or SET has been seen in it.
    pub(super) has_accessor: bool,
}

/// What may stand in a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Context {
    Statements,
    Variables,
    Types,
    Configuration,
    Accessors,
}

impl Block {
    pub(super) fn new(opener: Located) -> Self {
        let kind = opener.1.kind;
        Self {
            opener,
            awaits: awaited(kind),
            in_header: has_header(kind),
            has_else: false,
            told: false,
            skips: false,
            has_colon: false,
            has_on: false,
            has_accessor: false,
        }
    }

    pub(super) fn kind(&self) -> Kind {
        self.opener.1.kind
    }

    pub(super) fn context(&self) -> Context {
        let kind = self.kind();
        if kind.opens_section() || matches!(kind, Kind::Struct | Kind::Union) {
            Context::Variables
        } else if kind == Kind::Type {
            Context::Types
        } else if matches!(kind, Kind::Configuration | Kind::Resource) {
            Context::Configuration
        } else if kind == Kind::Property {
            Context::Accessors
        } else {
            Context::Statements
        }
    }
}

/// The word that must follow before the statements of a block.
fn awaited(opener: Kind) -> Option<Kind> {
    if opener == Kind::If {
        Some(Kind::Then)
    } else if opener == Kind::Case {
        Some(Kind::Of)
    } else if matches!(opener, Kind::For | Kind::While) {
        Some(Kind::Do)
    } else {
        None
    }
}

fn has_header(opener: Kind) -> bool {
    is_pou(opener)
        || is_member(opener)
        || matches!(opener, Kind::Configuration | Kind::Resource | Kind::Test)
}

pub(super) fn is_pou(kind: Kind) -> bool {
    (Kind::Function..=Kind::EndInterface).contains(&kind) && !is_closer(kind)
}

/// Whether a word opens a method, property, action or accessor.
pub(super) fn is_member(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Method | Kind::Property | Kind::Action | Kind::Get | Kind::Set
    )
}

/// Whether a word opens a statement that has a closer.
pub(super) fn opens_statement(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::If | Kind::Case | Kind::For | Kind::While | Kind::Repeat
    )
}

/// The words between opener and closer of a statement.
pub(super) fn divides(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Then | Kind::Elsif | Kind::Else | Kind::Of | Kind::Do | Kind::Until
    )
}

/// Openers with their closers.
const PAIRS: [(Kind, Kind); 29] = [
    (Kind::If, Kind::EndIf),
    (Kind::Case, Kind::EndCase),
    (Kind::For, Kind::EndFor),
    (Kind::While, Kind::EndWhile),
    (Kind::Repeat, Kind::EndRepeat),
    (Kind::Function, Kind::EndFunction),
    (Kind::FunctionBlock, Kind::EndFunctionBlock),
    (Kind::Program, Kind::EndProgram),
    (Kind::Class, Kind::EndClass),
    (Kind::Interface, Kind::EndInterface),
    (Kind::Method, Kind::EndMethod),
    (Kind::Property, Kind::EndProperty),
    (Kind::Action, Kind::EndAction),
    (Kind::Get, Kind::EndGet),
    (Kind::Set, Kind::EndSet),
    (Kind::Type, Kind::EndType),
    (Kind::Struct, Kind::EndStruct),
    (Kind::Union, Kind::EndUnion),
    (Kind::Configuration, Kind::EndConfiguration),
    (Kind::Resource, Kind::EndResource),
    (Kind::Test, Kind::EndTest),
    (Kind::Setup, Kind::EndSetup),
    (Kind::Teardown, Kind::EndTeardown),
    (Kind::Var, Kind::EndVar),
    (Kind::VarInput, Kind::EndVar),
    (Kind::VarOutput, Kind::EndVar),
    (Kind::VarInOut, Kind::EndVar),
    (Kind::VarTemp, Kind::EndVar),
    (Kind::VarExternal, Kind::EndVar),
];

/// The word that closes a block.
pub(super) fn closer(opener: Kind) -> Kind {
    let pair = PAIRS.iter().find(|pair| pair.0 == opener);
    // All other blocks are sections of variables.
    pair.map_or(Kind::EndVar, |pair| pair.1)
}

pub(super) fn is_closer(kind: Kind) -> bool {
    PAIRS.iter().any(|pair| pair.1 == kind)
}

pub(super) fn closes_statement(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::EndIf | Kind::EndCase | Kind::EndFor | Kind::EndWhile | Kind::EndRepeat
    )
}

impl Repair<'_, '_> {
    pub(super) fn context(&self) -> Context {
        let last = self.blocks.last();
        last.map_or(Context::Statements, Block::context)
    }

    pub(super) fn in_header(&self) -> bool {
        self.blocks.last().is_some_and(|block| block.in_header)
    }

    pub(super) fn awaits(&self) -> Option<Kind> {
        self.blocks.last().and_then(|block| block.awaits)
    }

    /// Whether a word opens, divides or closes a block here, so that no statement, declaration or
    /// bracket goes on across it.
    pub(super) fn is_structural(&self, kind: Kind) -> bool {
        let context = self.context();
        // `ARRAY […] OF` is no division of a statement.
        let divides = divides(kind)
            && context == Context::Statements
            && (kind != Kind::Of || self.awaits() == Some(Kind::Of) || self.is_selector());
        let configures = self
            .blocks
            .first()
            .is_some_and(|unit| unit.kind() == Kind::Configuration)
            && matches!(kind, Kind::Task | Kind::Program);
        opens_statement(kind)
            || divides
            || configures
            || is_closer(kind)
            || is_member(kind)
            || kind.opens_section()
            || matches!(kind, Kind::Struct | Kind::Union | Kind::Resource)
    }

    /// Whether what has begun could be the selector of a CASE, and no type.
    fn is_selector(&self) -> bool {
        let begun = self.out.get(self.begin..).unwrap_or_default();
        self.pending && !begun.iter().any(|token| token.1.kind == Kind::Colon)
    }

    /// Acts on a semicolon or a word that opens, divides or closes a block.
    pub(super) fn structure(&mut self, token: Located) {
        let kind = token.1.kind;
        self.unbalanced = None;
        if kind == Kind::Semicolon {
            self.push(token);
            self.pending = false;
        } else if is_closer(kind) {
            self.close(token);
        } else if divides(kind) {
            self.divide(token);
        } else if matches!(kind, Kind::Task | Kind::Program) {
            self.leave_declarations(token);
            self.end_header();
            self.begin = self.out.len();
            self.push(token);
            self.pending = true;
            self.name_due = true;
        } else {
            self.open(token);
        }
    }

    pub(super) fn end_header(&mut self) {
        if let Some(block) = self.blocks.last_mut() {
            block.in_header = false;
            block.skips = false;
        }
    }

    fn open(&mut self, token: Located) {
        let kind = token.1.kind;
        if opens_statement(kind) {
            self.leave_declarations(token);
        } else if kind.opens_section() {
            self.leave_sections(token);
        } else if matches!(kind, Kind::Method | Kind::Property | Kind::Action) {
            self.leave_to(|block| is_pou(block.kind()), token);
        } else if matches!(kind, Kind::Get | Kind::Set) {
            self.leave_to(|block| block.kind() == Kind::Property, token);
        } else if kind == Kind::Resource {
            self.leave_to(|block| block.kind() == Kind::Configuration, token);
        }
        if matches!(kind, Kind::Struct | Kind::Union) {
            self.complete_declaration(token);
        }
        if matches!(kind, Kind::Get | Kind::Set)
            && let Some(property) = self.blocks.last_mut()
        {
            property.has_accessor = true;
        }
        self.end_header();
        self.push(token);
        self.blocks.push(Block::new(token));
        self.pending = awaited(kind).is_some() || has_header(kind);
        self.name_due = super::names::needs_name(kind);
    }

    /// THEN, DO, OF, ELSE, ELSIF, UNTIL.
    fn divide(&mut self, mut token: Located) {
        match token.1.kind {
            Kind::Else | Kind::Elsif => {
                if !self.leave_to_else(&mut token) {
                    return;
                }
            }
            Kind::Until => self.leave_to_until(token),
            kind => {
                if self.awaits() != Some(kind) && !self.open_for_divider(token) {
                    return;
                }
            }
        }
        self.push(token);
        let kind = token.1.kind;
        if let Some(block) = self.blocks.last_mut() {
            block.has_else |= kind == Kind::Else;
            block.awaits = match kind {
                Kind::Elsif => Some(Kind::Then),
                Kind::Until => Some(Kind::EndRepeat),
                _ => None,
            };
        }
        self.pending = matches!(kind, Kind::Elsif | Kind::Until);
    }

    /// THEN, DO or OF behind something that no IF, FOR, WHILE or CASE began: that word is put in.
    fn open_for_divider(&mut self, token: Located) -> bool {
        self.closes_nothing(token);
        if !self.pending {
            return false;
        }
        let is_for = self.out[self.begin..]
            .iter()
            .any(|token| token.1.kind == Kind::To);
        let opener = match token.1.kind {
            Kind::Then => Kind::If,
            Kind::Of => Kind::Case,
            _ if is_for => Kind::For,
            _ => Kind::While,
        };
        let opener = self.put_at_begin(opener);
        let mut block = Block::new(opener);
        block.told = true;
        self.blocks.push(block);
        true
    }

    /// Whether a colon ends the labels of a CASE, behind which a statement may begin.
    pub(super) fn is_label_end(&self, kind: Kind) -> bool {
        kind == Kind::Colon
            && self.brackets.is_empty()
            && self.awaits().is_none()
            && self
                .blocks
                .last()
                .is_some_and(|block| block.kind() == Kind::Case)
    }
}
