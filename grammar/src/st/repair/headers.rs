//! What stands between the word that opens a unit or member and its first section or statement.
//! Damage here would take the parser to some semicolon far below, so it ends here: what does not
//! fit is left out up to the next line or section, with one message.

use super::blocks::Block;
use super::{Kind, Repair};
use iecc_diag::{Code, Diagnostic};

/// What may follow a token in a header.
fn continues(before: Kind, next: Kind) -> bool {
    let heritage = matches!(next, Kind::Extends | Kind::Implements | Kind::Using);
    match before {
        Kind::Word => {
            heritage
                || matches!(
                    next,
                    Kind::Colon
                        | Kind::Dot
                        | Kind::Comma
                        | Kind::On
                        | Kind::OpenParen
                        | Kind::OpenBracket
                        | Kind::Semicolon
                )
        }
        Kind::Colon | Kind::Of | Kind::RefTo | Kind::To => begins_type(next),
        Kind::Dot | Kind::Comma | Kind::Extends | Kind::Implements | Kind::Using | Kind::On => {
            next == Kind::Word
        }
        Kind::Array => next == Kind::OpenBracket,
        Kind::Pointer | Kind::Reference => next == Kind::To,
        Kind::CloseBracket => heritage || next == Kind::Of,
        Kind::CloseParen | Kind::Semicolon => heritage,
        Kind::Test => next == Kind::String,
        Kind::String => false,
        opener => next == Kind::Word || opener == Kind::Property && next == Kind::Colon,
    }
}

fn begins_type(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Word | Kind::Array | Kind::RefTo | Kind::Pointer | Kind::Reference | Kind::OpenParen
    )
}

impl Repair<'_, '_> {
    /// Takes a token while a header is open. `false` if it is to be left out.
    pub(super) fn settle_header(&mut self, at: usize, kind: Kind) -> bool {
        let Some((block, last)) = self.blocks.last().copied().zip(self.last_kind()) else {
            return true;
        };
        let accessor = matches!(block.kind(), Kind::Get | Kind::Set);
        let goes_on = if accessor {
            kind.is_modifier()
        } else {
            kind.is_modifier() && !last.ends_operand() || continues(last, kind)
        };
        if goes_on && !block.skips {
            self.note_header(kind);
            return true;
        }
        if self.lacks_colon(at, block, last) {
            return true;
        }
        let begins = self.on_new_line(at) || self.looks_like_statement(at);
        let ends = accessor
            || begins && last.ends_operand()
            || self.is_structural(kind)
            || self.action_ends(block, last)
            || block.kind() == Kind::Test && last == Kind::String;
        if !ends {
            return self.skip_in_header(at, block);
        }
        self.finish_header(at, block, last);
        true
    }

    /// Puts in the colon before the type of a result.
    fn lacks_colon(&mut self, at: usize, block: Block, last: Kind) -> bool {
        let may_have_type = matches!(block.kind(), Kind::Function | Kind::Method | Kind::Property);
        let token = self.feed.tokens[at];
        let lacks = may_have_type
            && !block.has_colon
            && !block.skips
            && last == Kind::Word
            && begins_type(token.1.kind)
            && !self.on_new_line(at)
            && !matches!(self.next_kind(at), None | Some(Kind::Assign | Kind::Colon));
        if lacks {
            self.wrong_in_header(at, "expected `:`");
            self.put_told(Kind::Colon);
            self.note_header(Kind::Colon);
        }
        lacks
    }

    fn note_header(&mut self, kind: Kind) {
        if let Some(block) = self.blocks.last_mut() {
            block.has_colon |= kind == Kind::Colon;
            block.has_on |= kind == Kind::On;
        }
    }

    /// `ACTION name:` is followed by statements.
    fn action_ends(&self, block: Block, last: Kind) -> bool {
        block.kind() == Kind::Action && last == Kind::Colon
    }

    fn skip_in_header(&mut self, at: usize, block: Block) -> bool {
        if !block.skips {
            self.wrong_in_header(
                at,
                "expected a section, a statement, or the end of the line",
            );
            if let Some(block) = self.blocks.last_mut() {
                block.skips = true;
            }
        }
        false
    }

    fn wrong_in_header(&mut self, at: usize, expected: &str) {
        let token = self.feed.tokens[at];
        let message = format!("found `{}`, {expected}", self.text(token));
        let diagnostic = Diagnostic::new(Code::E0010, self.span_of(token), message).label(expected);
        self.report(diagnostic);
    }

    /// Puts in what a header needs to be complete.
    fn finish_header(&mut self, at: usize, block: Block, last: Kind) {
        let action = self.action_ends(block, last);
        let needs_word = matches!(
            last,
            Kind::Colon
                | Kind::Of
                | Kind::RefTo
                | Kind::To
                | Kind::Dot
                | Kind::Comma
                | Kind::Extends
                | Kind::Implements
                | Kind::Using
                | Kind::On
        );
        if needs_word && !action {
            let what = if begins_type_after(last) {
                "expected a type"
            } else {
                "expected a name"
            };
            if !block.skips {
                self.wrong_in_header(at, what);
            }
            self.put_told(Kind::Word);
        }
        let missing = match block.kind() {
            Kind::Property if !block.has_colon => Some((Kind::Colon, "expected `:` and a type")),
            Kind::Resource if !block.has_on => Some((Kind::On, "expected ON and a processor")),
            _ => None,
        };
        if let Some((kind, expected)) = missing {
            if !block.skips {
                self.wrong_in_header(at, expected);
            }
            self.put_told(kind);
            self.put_told(Kind::Word);
        }
        self.end_header();
        self.pending = false;
    }

    fn put_told(&mut self, kind: Kind) {
        self.told.insert(self.last_end());
        self.put(kind);
    }
}

fn begins_type_after(last: Kind) -> bool {
    matches!(last, Kind::Colon | Kind::Of | Kind::RefTo | Kind::To)
}
