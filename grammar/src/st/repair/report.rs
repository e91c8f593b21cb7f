//! The messages about blocks, one for each that is not balanced.

use super::blocks::{Block, closer};
use super::{Kind, Located, Repair};
use iecc_diag::{Code, Diagnostic};

impl Repair<'_, '_> {
    /// A block has no closer. `cause` shows that it should have been closed.
    pub(super) fn not_closed(&mut self, block: Block, cause: Option<Located>) {
        let opener = self.text(block.opener).to_ascii_uppercase();
        let closer = word(closer(block.kind()));
        let end = self.last_end();
        let mut diagnostic = Diagnostic::new(
            Code::E0011,
            self.span_of(block.opener),
            format!("{opener} is not closed"),
        )
        .label(format!("this has no {closer}"));
        diagnostic = match cause {
            Some(cause) => {
                let text = format!("expected {closer} before this");
                diagnostic.also(self.span_of(cause), text)
            }
            None => diagnostic.also(self.span(end, end), format!("expected {closer} here")),
        };
        if block.kind() == Kind::If && self.has_else_if(block.opener, cause) {
            diagnostic = diagnostic.note(
                "`ELSE IF` begins an IF in the ELSE, with an END_IF of its own; `ELSIF` does not",
            );
        }
        let semicolon = if super::blocks::opens_statement(block.kind()) {
            ";"
        } else {
            ""
        };
        let place = self.span(end, end);
        let text = format!("\n{closer}{semicolon}");
        let diagnostic = diagnostic.fix(format!("put in {closer}"), place, text);
        self.report(diagnostic);
    }

    /// Whether an IF stands right behind ELSE, or has such an IF in it.
    fn has_else_if(&self, opener: Located, cause: Option<Located>) -> bool {
        let list = &self.feed.tokens;
        let first = list.partition_point(|token| token.0 < opener.0);
        let last = cause.map_or(list.len(), |cause| {
            list.partition_point(|token| token.0 < cause.0)
        });
        let kinds: Vec<Kind> = list[first.saturating_sub(1)..last]
            .iter()
            .map(|token| token.1.kind)
            .collect();
        kinds.windows(2).any(|pair| pair == [Kind::Else, Kind::If])
    }

    /// A unit ends with the closer of another kind of unit.
    pub(super) fn wrong_closer(&mut self, unit: Block, token: Located) {
        let found = self.text(token);
        let opener = self.text(unit.opener).to_ascii_uppercase();
        let closer = word(closer(unit.kind()));
        let span = self.span_of(token);
        let diagnostic = Diagnostic::new(
            Code::E0012,
            span,
            format!("{opener} ends with `{found}`, expected {closer}"),
        )
        .label(format!("expected {closer}"))
        .also(self.span_of(unit.opener), "this is what it ends")
        .fix(format!("write {closer}"), span, closer);
        self.report(diagnostic);
    }

    /// A word that divides or closes a block stands where no such block is open.
    pub(super) fn closes_nothing(&mut self, token: Located) {
        let text = self.text(token);
        let belongs = match token.1.kind {
            Kind::Else => "there is no IF or CASE that it could belong to",
            Kind::Elsif | Kind::Then => "there is no IF that it could belong to",
            Kind::Do => "there is no FOR or WHILE that it could belong to",
            Kind::Until => "there is no REPEAT that it could belong to",
            _ => "nothing is open here that it could close",
        };
        let message = format!("`{text}` closes nothing");
        let message = if super::blocks::divides(token.1.kind) {
            format!("`{text}` belongs to nothing")
        } else {
            message
        };
        let diagnostic = Diagnostic::new(Code::E0012, self.span_of(token), message).label(belongs);
        self.report(diagnostic);
    }
}

/// The spelling of a closer.
fn word(closer: Kind) -> &'static str {
    closer.keyword().expect("closers are keywords")
}
