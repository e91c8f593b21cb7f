//! Brackets of one statement or declaration.

use super::{Kind, Located, Repair};
use iecc_diag::{Code, Diagnostic};

/// How far ahead is searched for the bracket that closes a call, so that a unit with many open
/// brackets is still read in linear time.
const LOOK_AHEAD: usize = 256;

impl Repair<'_, '_> {
    /// Puts in all brackets that are open, one message for each.
    pub(super) fn close_brackets(&mut self) {
        while let Some(opener) = self.brackets.pop() {
            self.close_open_bracket(opener);
        }
    }

    fn close_open_bracket(&mut self, opener: Located) {
        let (kind, sign) = partner(opener.1.kind);
        let end = self.last_end();
        let message = format!("`{}` is not closed", self.text(opener));
        let diagnostic = Diagnostic::new(Code::E0025, self.span_of(opener), message)
            .label("this is not closed")
            .also(
                self.span(end, end),
                format!("expected `{sign}` before this"),
            )
            .fix(format!("put in `{sign}`"), self.span(end, end), sign);
        self.told.insert(end);
        self.unbalanced(diagnostic);
        self.put(kind);
    }

    /// Takes a closing bracket, and puts in those that must stand before it. Says whether it closes
    /// anything; if not, it is left out.
    pub(super) fn close_bracket(&mut self, token: Located) -> bool {
        let fits = |opener: &Located| partner(opener.1.kind).0 == token.1.kind;
        let Some(index) = self.brackets.iter().rposition(fits) else {
            self.closes_no_bracket(token);
            return false;
        };
        while self.brackets.len() > index + 1 {
            let opener = self.brackets.pop().expect("there are more");
            self.close_open_bracket(opener);
        }
        self.brackets.pop();
        true
    }

    fn closes_no_bracket(&mut self, token: Located) {
        let text = self.text(token);
        let span = self.span_of(token);
        let diagnostic = Diagnostic::new(Code::E0025, span, format!("`{text}` closes no bracket"))
            .label("nothing is open here that it could close")
            .fix(format!("take out the `{text}`"), span, "");
        self.unbalanced(diagnostic);
    }

    /// Reports the first bracket of a statement or declaration: others follow from it.
    fn unbalanced(&mut self, diagnostic: Diagnostic) {
        let first = self.unbalanced.replace(self.begin) != Some(self.begin);
        if first {
            self.report(diagnostic);
        }
    }

    /// Whether a new statement begins here although a bracket is open: on a new line, with `:=` or
    /// `(` behind its name, and with no bracket before the next semicolon that would close the open
    /// one.
    pub(super) fn begins_after_open_bracket(&self, at: usize, kind: Kind) -> bool {
        !self.brackets.is_empty()
            && kind == Kind::Word
            && self.last_kind().is_some_and(Kind::ends_operand)
            && self.on_new_line(at)
            && self.looks_like_statement(at)
            && self.stays_open(at)
    }

    pub(super) fn looks_like_statement(&self, at: usize) -> bool {
        let ahead = self.feed.tokens[at..].iter().map(|token| token.1.kind);
        let mut ahead = ahead.skip_while(|kind| matches!(kind, Kind::Word | Kind::Dot));
        matches!(ahead.next(), Some(Kind::Assign | Kind::OpenParen))
    }

    fn stays_open(&self, at: usize) -> bool {
        let mut depth = 0;
        for (_, token, _) in self.feed.tokens[at..].iter().take(LOOK_AHEAD) {
            match token.kind {
                Kind::OpenParen | Kind::OpenBracket => depth += 1,
                Kind::CloseParen | Kind::CloseBracket if depth == 0 => return false,
                Kind::CloseParen | Kind::CloseBracket => depth -= 1,
                kind if kind == Kind::Semicolon || self.is_structural(kind) => return true,
                _ => {}
            }
        }
        true
    }
}

fn partner(opener: Kind) -> (Kind, &'static str) {
    if opener == Kind::OpenBracket {
        (Kind::CloseBracket, "]")
    } else {
        (Kind::CloseParen, ")")
    }
}
