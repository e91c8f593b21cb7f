//! Blocks that are not closed, and closers that close nothing.

use super::blocks::{Block, Context, closer, closes_statement, is_closer, is_pou, opens_statement};
use super::{Kind, Located, Repair, Trust};

impl Repair<'_, '_> {
    /// Closes the block a closer belongs to, and those in it that have no closer of their own.
    pub(super) fn close(&mut self, token: Located) {
        let Some(index) = self.block_of_closer(token) else {
            if !self.close_by_another(token) {
                self.close_wrongly(token);
            }
            return;
        };
        self.close_above(index + 1, token);
        self.blocks.pop();
        self.push(token);
        self.after_closer(token.1.kind);
    }

    /// `IF … END_FOR`: the end of another statement, in line with the one that is open.
    fn close_by_another(&mut self, token: Located) -> bool {
        let Some(block) = self.blocks.last().copied() else {
            return false;
        };
        let column = self.indentation(token);
        let aligned = column.is_some() && column == self.indentation(block.opener);
        let ready = opens_statement(block.kind()) && block.awaits.is_none();
        let other = closes_statement(token.1.kind) && block.kind() != Kind::Repeat;
        if !aligned || !ready || !other {
            return false;
        }
        self.wrong_closer(block, token);
        self.blocks.pop();
        let (start, mut mended, end) = token;
        mended.kind = closer(block.kind());
        self.push((start, mended, end));
        self.after_closer(mended.kind);
        true
    }

    fn after_closer(&mut self, kind: Kind) {
        let type_ends =
            matches!(kind, Kind::EndStruct | Kind::EndUnion) && self.context() != Context::Types;
        self.pending = closes_statement(kind) || type_ends;
    }

    /// The innermost open block that a closer can mean.
    fn block_of_closer(&self, token: Located) -> Option<usize> {
        let fits = |block: &Block| closer(block.kind()) == token.1.kind;
        let innermost = self.blocks.iter().rposition(fits)?;
        if self.trust == Trust::Counting || !closes_statement(token.1.kind) {
            return Some(innermost);
        }
        let column = self.indentation(token);
        let at_column = |block: &Block| fits(block) && self.indentation(block.opener) == column;
        let inner = self.indentation(self.blocks[innermost].opener);
        match (column, inner) {
            (Some(column), Some(inner)) if column < inner => {
                Some(self.in_same_body(at_column).unwrap_or(innermost))
            }
            _ => Some(innermost),
        }
    }

    /// The innermost block that fits, if no unit or method ends between.
    pub(super) fn in_same_body(&self, fits: impl Fn(&Block) -> bool) -> Option<usize> {
        let open = self.blocks.iter().enumerate().rev();
        open.take_while(|(_, block)| opens_statement(block.kind()))
            .find(|(_, block)| fits(block))
            .map(|(index, _)| index)
    }

    /// Puts in the closers of all blocks from an index on, because of a token.
    pub(super) fn close_above(&mut self, index: usize, cause: Located) {
        while self.blocks.len() > index {
            self.close_innermost(Some(cause));
        }
    }

    /// Puts in the closer of the innermost block, with a message.
    fn close_innermost(&mut self, cause: Option<Located>) {
        let Some(block) = self.blocks.last().copied() else {
            return;
        };
        self.finish_awaited(block);
        let cut_off = self.feed.cut && cause.is_none();
        if !block.told && !cut_off {
            self.not_closed(block, cause);
        }
        self.told.insert(self.last_end());
        self.blocks.pop();
        let closer = closer(block.kind());
        self.put(closer);
        if closes_statement(closer) {
            self.put(Kind::Semicolon);
        }
        self.after_closer(closer);
        if closes_statement(closer) {
            self.pending = false;
        }
    }

    /// What must stand before the closer so that the parser takes it.
    fn finish_awaited(&mut self, block: Block) {
        match block.awaits {
            Some(Kind::EndRepeat) => {}
            Some(word) => self.put(word),
            None => {}
        }
        if block.kind() == Kind::Repeat && block.awaits.is_none() {
            self.put(Kind::Until);
            self.put(Kind::Damaged);
        }
        if let Some(block) = self.blocks.last_mut() {
            block.awaits = None;
        }
    }

    /// A closer without block.
    fn close_wrongly(&mut self, token: Located) {
        let unit = self.blocks.first().copied();
        match unit {
            Some(unit) if has_own_closer(unit.kind()) && is_unit_closer(token.1.kind) => {
                self.close_above(1, token);
                self.wrong_closer(unit, token);
                self.blocks.clear();
                let (start, mut mended, end) = token;
                mended.kind = closer(unit.kind());
                self.push((start, mended, end));
                self.pending = false;
            }
            Some(_) | None => self.stray(token),
        }
    }

    /// Leaves out a word that belongs to nothing.
    pub(super) fn stray(&mut self, token: Located) {
        self.closes_nothing(token);
    }

    /// Closes sections of variables before a statement.
    pub(super) fn leave_declarations(&mut self, cause: Located) {
        while self.context() == Context::Variables && self.blocks.len() > 1 {
            self.close_innermost(Some(cause));
        }
    }

    /// Closes a section before another one, and a structure in it.
    pub(super) fn leave_sections(&mut self, cause: Located) {
        self.leave_declarations(cause);
    }

    /// Closes blocks until one fits; nothing if none does.
    pub(super) fn leave_to(&mut self, fits: impl Fn(&Block) -> bool, cause: Located) {
        if let Some(index) = self.blocks.iter().rposition(fits) {
            self.close_above(index + 1, cause);
        }
    }

    /// Makes the IF or CASE that an ELSE or ELSIF belongs to the innermost block. An ELSIF without
    /// IF becomes an IF.
    pub(super) fn leave_to_else(&mut self, token: &mut Located) -> bool {
        if let Some(index) = self.block_of_else(*token) {
            self.close_above(index + 1, *token);
            return true;
        }
        self.closes_nothing(*token);
        if token.1.kind == Kind::Elsif {
            token.1.kind = Kind::If;
            let mut block = Block::new(*token);
            block.told = true;
            self.blocks.push(block);
            token.1.kind = Kind::If;
            self.push(*token);
            self.pending = true;
        }
        false
    }

    fn block_of_else(&self, token: Located) -> Option<usize> {
        let is_elsif = token.1.kind == Kind::Elsif;
        let fits = |block: &Block| {
            let takes = block.kind() == Kind::If || block.kind() == Kind::Case && !is_elsif;
            takes && !block.has_else
        };
        let innermost = self.in_same_body(fits)?;
        let column = self.indentation(token);
        if self.trust == Trust::Counting || column.is_none() {
            return Some(innermost);
        }
        let inner = self.indentation(self.blocks[innermost].opener);
        let at_column = |block: &Block| fits(block) && self.indentation(block.opener) == column;
        if inner > column {
            Some(self.in_same_body(at_column).unwrap_or(innermost))
        } else {
            Some(innermost)
        }
    }

    /// Makes the REPEAT of an UNTIL the innermost block; one is put in where there is none.
    pub(super) fn leave_to_until(&mut self, token: Located) {
        let repeat = |block: &Block| block.kind() == Kind::Repeat && block.awaits.is_none();
        if let Some(index) = self.in_same_body(repeat) {
            return self.close_above(index + 1, token);
        }
        self.closes_nothing(token);
        self.told.insert(self.last_end());
        self.put(Kind::Repeat);
        if let Some(&opener) = self.out.last() {
            let mut block = Block::new(opener);
            block.told = true;
            self.blocks.push(block);
        }
    }

    /// Closes statements in an arm of a CASE when the label of the next arm begins.
    pub(super) fn leave_to_case(&mut self, at: usize) {
        let inner = self.blocks.last().is_some_and(|block| {
            opens_statement(block.kind()) && block.kind() != Kind::Case && block.awaits.is_none()
        });
        let case = |block: &Block| block.kind() == Kind::Case && !block.has_else;
        if self.pending || !inner || !self.begins_label(at) {
            return;
        }
        if let Some(index) = self.in_same_body(case) {
            self.close_above(index + 1, self.feed.tokens[at]);
        }
    }

    /// Whether values with a colon behind them begin here.
    fn begins_label(&self, at: usize) -> bool {
        const LONGEST: usize = 64;
        let ahead = self.feed.tokens[at..].iter().take(LONGEST);
        let mut kinds = ahead.map(|token| token.1.kind);
        let end = kinds.find(|&kind| !may_be_label(kind));
        end == Some(Kind::Colon)
    }

    /// Closes whatever is open at the end of the unit.
    pub(super) fn close_unit(&mut self) {
        self.close_brackets();
        let unfinished = self.pending && !self.blocks.is_empty() && !self.in_header();
        if unfinished && self.awaits().is_none() {
            self.end_statement(None);
        }
        while !self.blocks.is_empty() {
            self.close_innermost(None);
        }
    }
}

/// Whether a token can be part of labels of a CASE.
pub(super) fn may_be_label(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Word
            | Kind::Int
            | Kind::Based
            | Kind::TypePrefix
            | Kind::Minus
            | Kind::Dot
            | Kind::DotDot
            | Kind::Comma
            | Kind::Time
            | Kind::String
            | Kind::True
            | Kind::False
    )
}

/// Whether a unit begun by this word may have been closed by the word of another kind of unit.
fn has_own_closer(opener: Kind) -> bool {
    is_pou(opener) || opener.opens_test()
}

pub(super) fn is_unit_closer(kind: Kind) -> bool {
    let tests = matches!(kind, Kind::EndTest | Kind::EndSetup | Kind::EndTeardown);
    tests || is_closer(kind) && (Kind::Function..=Kind::EndInterface).contains(&kind)
}
