//! Names that are missing, and reserved words in the place of names.

use super::blocks::{Context, divides, is_closer, is_pou, opens_statement};
use super::{Kind, Repair, Token};
use iecc_diag::{Code, Diagnostic};

/// Whether a name follows an opener.
pub(super) fn needs_name(opener: Kind) -> bool {
    is_pou(opener)
        || matches!(
            opener,
            Kind::Method | Kind::Property | Kind::Action | Kind::Configuration | Kind::Resource
        )
}

impl Repair<'_, '_> {
    /// Whether a keyword stands where only a name makes sense. Gives a message for each word.
    pub(super) fn is_misnamed(&mut self, at: usize) -> bool {
        let token = self.feed.tokens[at];
        let kind = token.1.kind;
        if self.is_known_misnomer(token.1) {
            return true;
        }
        let keyword = kind.keyword().is_some() && self.brackets.is_empty();
        let stands = is_of_chart(kind) || keyword && self.stands_for_name(at, kind);
        if !stands {
            return false;
        }
        if self.misnamed.insert(token.1.symbol) {
            let text = self.text(token);
            let message = format!("`{text}` is a reserved word and cannot be a name");
            let diagnostic =
                Diagnostic::new(Code::E0018, self.span_of(token), message).label("expected a name");
            self.report(diagnostic);
        }
        true
    }

    /// Whether a word that was declared as a name stands where an operand is due.
    fn is_known_misnomer(&self, token: Token) -> bool {
        let due = self.pending && self.last_kind().is_some_and(|last| !last.ends_operand());
        token.kind.keyword().is_some() && due && self.misnamed.contains(&token.symbol)
    }

    fn stands_for_name(&self, at: usize, kind: Kind) -> bool {
        let next = self.next_kind(at);
        if self.name_due {
            return !is_closer(kind)
                && !kind.opens_section()
                && !kind.is_modifier()
                && !opens_statement(kind)
                && !matches!(
                    kind,
                    Kind::Extends | Kind::Implements | Kind::Using | Kind::On | Kind::With
                );
        }
        let begins = !self.pending || self.last_kind() == Some(Kind::Comma);
        match self.context() {
            Context::Variables => {
                begins && matches!(next, Some(Kind::Colon | Kind::Comma | Kind::At))
            }
            Context::Types => begins && next == Some(Kind::Colon),
            Context::Statements => {
                let assigned = !self.pending && next == Some(Kind::Assign) && !is_structure(kind);
                !self.in_header() && (assigned || is_never_in_statement(kind))
            }
            Context::Configuration | Context::Accessors => false,
        }
    }

    /// Puts in what `STRUCT` needs before it: a name and a colon.
    pub(super) fn complete_declaration(&mut self, token: super::Located) {
        let nameless = self.pending && self.out[self.begin].1.kind == Kind::Colon;
        if nameless {
            let span = self.span_of(token);
            let diagnostic = Diagnostic::new(Code::E0032, span, "the structure has no name")
                .label("expected a name and `:` before this");
            self.report(diagnostic);
            let (at, ..) = self.put_at_begin(Kind::Word);
            self.told.insert(at);
        } else if self.last_kind() == Some(Kind::Word) {
            let span = self.span_of(token);
            let message = format!("found `{}`, expected `:`", self.text(token));
            let diagnostic =
                Diagnostic::new(Code::E0010, span, message).label("expected `:` before this");
            self.tell(diagnostic);
            self.put(Kind::Colon);
        }
    }

    /// Puts in the name of a unit or member that has none.
    pub(super) fn settle_name(&mut self, token: Token) {
        if !self.name_due || token.kind.is_modifier() {
            return;
        }
        self.name_due = false;
        if token.kind == Kind::Word {
            return;
        }
        let opener = self.out.iter().rev().find(|token| {
            token
                .1
                .kind
                .keyword()
                .is_some_and(|_| !token.1.kind.is_modifier())
        });
        let (word, span) = match opener {
            Some(&opener) => (self.text(opener), self.span_of(opener)),
            None => return,
        };
        let end = self.last_end();
        let diagnostic = Diagnostic::new(Code::E0032, span, format!("{word} has no name"))
            .label("expected a name behind this");
        self.told.insert(end);
        self.report(diagnostic);
        self.unsorted = true;
        self.put(Kind::Word);
    }
}

/// Whether a word divides or bounds statements.
fn is_structure(kind: Kind) -> bool {
    opens_statement(kind) || divides(kind) || is_closer(kind)
}

/// The words of Sequential Function Chart: where the body is none, they are meant as names.
fn is_of_chart(kind: Kind) -> bool {
    (Kind::Step..=Kind::From).contains(&kind)
}

/// Keywords that no statement has, and that open nothing among statements.
fn is_never_in_statement(kind: Kind) -> bool {
    let configuration = (Kind::Configuration..=Kind::ReadWrite).contains(&kind);
    let unit = is_pou(kind) || matches!(kind, Kind::Extends | Kind::Implements | Kind::Type);
    let declaration = matches!(kind, Kind::At | Kind::REdge | Kind::FEdge);
    let ty = matches!(kind, Kind::Array | Kind::RefTo | Kind::Overlap);
    (configuration || unit || declaration || ty) && !is_closer(kind)
}
