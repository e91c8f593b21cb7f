//! Semicolons, and the words THEN, DO and OF, where they are missing.

use super::blocks::{Block, Context, closes_statement, is_member};
use super::closers::{is_unit_closer, may_be_label};
use super::{Kind, Repair};
use iecc_diag::{Code, Diagnostic};

impl Repair<'_, '_> {
    /// Puts in what must stand before a token. `false` if the token itself is to be left out.
    pub(super) fn settle_separator(&mut self, at: usize, kind: Kind) -> bool {
        if self.in_header() {
            let keep = self.settle_header(at, kind);
            if self.in_header() {
                return keep;
            }
        }
        if self.context() == Context::Accessors && !self.settle_accessors(at, kind) {
            return false;
        }
        if let Some(word) = self.awaits() {
            return self.settle_awaited(at, kind, word);
        }
        self.leave_variables_before_statement(at, kind);
        self.enter_variables_before_declaration(at, kind);
        self.leave_structure_before_semicolon(at, kind);
        self.leave_to_case(at);
        if kind == Kind::EndRepeat {
            self.put_until(at);
        }
        if self.pending && kind != Kind::Semicolon && self.ends_before(at, kind) {
            self.end_statement(Some(at));
        }
        true
    }

    /// THEN, DO, OF or END_REPEAT must come before the next statement.
    fn settle_awaited(&mut self, at: usize, kind: Kind, word: Kind) -> bool {
        if kind == word || word == Kind::EndRepeat && kind == Kind::Semicolon {
            return true;
        }
        let replaces = word != Kind::EndRepeat
            && matches!(kind, Kind::Semicolon | Kind::Then | Kind::Do | Kind::Of);
        if replaces {
            return self.replace_by_awaited(at, word);
        }
        let label = word == Kind::Of && may_be_label(kind);
        let begins = is_jump(kind) || (begins_statement(kind) || label) && self.on_new_line(at);
        // No operand stands behind another.
        let begins = begins || kind == Kind::Word && self.looks_like_statement(at);
        let next_line = begins && self.last_kind().is_some_and(Kind::ends_operand);
        if !next_line && !self.is_structural(kind) {
            return true;
        }
        if word == Kind::EndRepeat {
            let inner = self.blocks.len() - 1;
            self.close_above(inner, self.feed.tokens[at]);
        } else {
            self.put_awaited(word);
        }
        true
    }

    /// Another word, or a semicolon, stands where THEN, DO or OF belongs.
    fn replace_by_awaited(&mut self, at: usize, word: Kind) -> bool {
        let token = self.feed.tokens[at];
        let found = self.text(token);
        let name = word.keyword().expect("THEN, DO and OF are keywords");
        let span = self.span_of(token);
        let message = format!("found `{found}`, expected {name}");
        if self.next_kind(at) == Some(word) {
            let diagnostic = Diagnostic::new(Code::E0031, span, message)
                .label(format!("{name} follows"))
                .fix(format!("take out the `{found}`"), span, "");
            self.report(diagnostic);
            return false;
        }
        let opener = self.blocks.last().map(|block| block.opener);
        let mut diagnostic = Diagnostic::new(Code::E0031, span, message)
            .label(format!("expected {name}"))
            .fix(format!("write {name}"), span, name);
        if let Some(opener) = opener {
            diagnostic = diagnostic.also(self.span_of(opener), format!("{name} of this"));
        }
        self.tell(diagnostic);
        self.take_awaited(word);
        false
    }

    fn put_awaited(&mut self, word: Kind) {
        let name = word.keyword().expect("THEN, DO and OF are keywords");
        let end = self.last_end();
        let place = self.span(end, end);
        let mut diagnostic = Diagnostic::new(Code::E0031, place, format!("{name} is missing"))
            .label(format!("expected {name}"))
            .fix(format!("put in {name}"), place, format!(" {name}"));
        if self.tokens.text[end as usize..]
            .trim_start()
            .starts_with('{')
        {
            diagnostic = diagnostic.note("`{` begins a pragma, not a block");
        }
        if let Some(block) = self.blocks.last() {
            let opener = block.opener;
            diagnostic = diagnostic.also(self.span_of(opener), format!("{name} of this"));
        }
        self.tell(diagnostic);
        self.take_awaited(word);
    }

    fn take_awaited(&mut self, word: Kind) {
        self.put(word);
        self.pending = false;
        if let Some(block) = self.blocks.last_mut() {
            block.awaits = None;
        }
    }

    /// UNTIL before what stands last in a REPEAT, or before nothing.
    fn put_until(&mut self, at: usize) {
        let Some(block) = self.blocks.last().copied() else {
            return;
        };
        if block.kind() != Kind::Repeat || block.awaits.is_some() {
            return;
        }
        let closer = self.feed.tokens[at];
        let diagnostic = Diagnostic::new(Code::E0031, self.span_of(closer), "UNTIL is missing")
            .label("expected UNTIL and a condition before this")
            .also(self.span_of(block.opener), "UNTIL of this");
        self.report(diagnostic);
        if self.pending {
            let (at, ..) = self.put_at_begin(Kind::Until);
            self.told.insert(at);
        } else {
            self.told.insert(self.last_end());
            self.put(Kind::Until);
            self.put(Kind::Damaged);
        }
        if let Some(block) = self.blocks.last_mut() {
            block.awaits = Some(Kind::EndRepeat);
        }
        self.pending = false;
    }

    /// A statement in a section of variables: END_VAR is missing.
    fn leave_variables_before_statement(&mut self, at: usize, kind: Kind) {
        let assigns = matches!(
            self.next_kind(at),
            Some(Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket | Kind::Caret)
        );
        let section = self.blocks.len() > 1 && {
            let opener = self.blocks[self.blocks.len() - 1].kind();
            opener.opens_section() && !matches!(opener, Kind::VarConfig | Kind::VarAccess)
        };
        let begins = section && !self.pending && assigns && kind == Kind::Word;
        if begins && !self.section_goes_on(at) {
            self.leave_declarations(self.feed.tokens[at]);
        }
    }

    /// Whether the section is closed behind this, with declarations only before that: then this is a
    /// declaration with a slip in it.
    fn section_goes_on(&self, at: usize) -> bool {
        const LONGEST: usize = 1024;
        let behind = self.feed.tokens[at..].iter().take(LONGEST);
        let mut behind = behind.map(|token| token.1.kind);
        let end = behind.find(|kind| self.is_structural(*kind));
        end == Some(Kind::EndVar)
    }

    /// In a property stand GET and SET only. Anything else is left out, with one message; behind
    /// GET and SET it shows that END_PROPERTY is missing.
    fn settle_accessors(&mut self, at: usize, kind: Kind) -> bool {
        let unit_goes_on = is_member(kind) || is_unit_closer(kind);
        if unit_goes_on || matches!(kind, Kind::EndProperty | Kind::Semicolon) {
            return true;
        }
        let Some(block) = self.blocks.last().copied() else {
            return true;
        };
        let token = self.feed.tokens[at];
        if block.has_accessor && !block.skips {
            let inner = self.blocks.len() - 1;
            self.close_above(inner, token);
            return true;
        }
        if !block.skips {
            let message = format!("found `{}`, expected GET or SET", self.text(token));
            let diagnostic = Diagnostic::new(Code::E0010, self.span_of(token), message)
                .label("expected GET or SET");
            self.report(diagnostic);
        }
        if let Some(block) = self.blocks.last_mut() {
            block.skips = true;
        }
        false
    }

    /// A declaration among statements: VAR is missing.
    fn enter_variables_before_declaration(&mut self, at: usize, kind: Kind) {
        let statements = self.context() == Context::Statements && !self.pending;
        let first = if kind.is_modifier() { at + 1 } else { at };
        let named = kind == Kind::Word || kind.is_modifier();
        let in_case = || {
            self.in_same_body(|block| block.kind() == Kind::Case)
                .is_some()
        };
        if !statements || !named || !self.declares(first) || in_case() {
            return;
        }
        let token = self.feed.tokens[at];
        let message = format!("`{}` is declared outside of a section", self.text(token));
        let diagnostic = Diagnostic::new(Code::E0033, self.span_of(token), message)
            .label("expected VAR, VAR_INPUT or the like before this");
        self.tell(diagnostic);
        self.unsorted = true;
        self.put(Kind::Var);
        if let Some(&opener) = self.out.last() {
            let mut block = Block::new(opener);
            block.told = true;
            self.blocks.push(block);
        }
    }

    /// Whether `name :` or `name, name :` begins here, perhaps with AT.
    fn declares(&self, at: usize) -> bool {
        const LONGEST: usize = 256;
        let ahead = self.feed.tokens[at..].iter().take(LONGEST);
        let mut kinds = ahead.map(|token| token.1.kind);
        let end =
            kinds.find(|kind| !matches!(kind, Kind::Word | Kind::Comma | Kind::At | Kind::Direct));
        end == Some(Kind::Colon)
    }

    /// A lone semicolon in a structure mostly stood behind END_STRUCT.
    fn leave_structure_before_semicolon(&mut self, at: usize, kind: Kind) {
        let structure = self
            .blocks
            .last()
            .is_some_and(|block| matches!(block.kind(), Kind::Struct | Kind::Union));
        if structure && !self.pending && kind == Kind::Semicolon && self.on_new_line(at) {
            let inner = self.blocks.len() - 1;
            self.close_above(inner, self.feed.tokens[at]);
        }
    }

    /// Whether a token is part of a value behind RETURN, which takes none; one message for each.
    pub(super) fn skips_value(&mut self, at: usize, kind: Kind) -> bool {
        let ends = kind == Kind::Semicolon || self.is_structural(kind);
        if ends || self.skips_value {
            self.skips_value &= !ends;
            return self.skips_value;
        }
        if self.last_kind() != Some(Kind::Return) || self.on_new_line(at) || !begins_value(kind) {
            return false;
        }
        let span = self.span_of(self.feed.tokens[at]);
        let diagnostic = Diagnostic::new(Code::E0010, span, "RETURN takes no value")
            .label("expected `;` before this")
            .note(
                "what a function gives is assigned to its name before: `Twice := 2 * a; RETURN;`",
            );
        self.report(diagnostic);
        self.skips_value = true;
        true
    }

    /// Whether a statement or declaration must have ended before this token.
    fn ends_before(&self, at: usize, kind: Kind) -> bool {
        // `name : STRUCT` goes on.
        if matches!(
            kind,
            Kind::Struct | Kind::Union | Kind::Then | Kind::Do | Kind::Of
        ) {
            return false;
        }
        if self.is_structural(kind) {
            return true;
        }
        let complete = self.is_complete();
        let new_line = || self.on_new_line(at);
        match self.context() {
            Context::Statements => {
                let words = is_jump(kind) || matches!(kind, Kind::Mock | Kind::MockFunction);
                let label = self
                    .blocks
                    .last()
                    .is_some_and(|block| block.kind() == Kind::Case)
                    && matches!(kind, Kind::Int | Kind::Based | Kind::TypePrefix);
                let after_block = self
                    .last_kind()
                    .is_some_and(|last| closes_statement(last) || is_jump(last));
                let begins = begins_statement(kind) || label;
                complete && (words || begins && (after_block || new_line()))
            }
            Context::Variables => {
                let declares = matches!(
                    self.next_kind(at),
                    Some(Kind::Colon | Kind::Comma | Kind::At)
                );
                complete && kind == Kind::Word && declares && new_line()
            }
            Context::Types => {
                let declares = matches!(self.next_kind(at), Some(Kind::Colon | Kind::Extends));
                complete && kind == Kind::Word && declares && new_line()
            }
            Context::Configuration | Context::Accessors => false,
        }
    }

    /// Whether what stands so far could be a whole statement or declaration.
    fn is_complete(&self) -> bool {
        self.last_kind().is_some_and(|last| {
            last.ends_operand()
                || closes_statement(last)
                || is_jump(last)
                || matches!(
                    last,
                    Kind::REdge | Kind::FEdge | Kind::EndStruct | Kind::EndUnion
                )
        })
    }

    /// Puts in the semicolon of a statement or declaration. Without a message where more than a
    /// semicolon is missing: the parser gives one.
    pub(super) fn end_statement(&mut self, before: Option<usize>) {
        if self.are_labels() {
            return self.end_labels();
        }
        if self.is_complete() {
            let end = self.last_end();
            let place = self.span(end, end);
            let mut diagnostic = Diagnostic::new(Code::E0024, place, "a semicolon is missing")
                .label("expected `;`")
                .fix("put in the semicolon", place, ";");
            if let Some(at) = before {
                let next = self.feed.tokens[at];
                let what = format!("before this `{}`", self.text(next));
                diagnostic = diagnostic.also(self.span_of(next), what);
            }
            // After a bracket was put in, its message says enough.
            if !self.told.contains(&end) {
                self.tell(diagnostic);
            }
        }
        self.put(Kind::Semicolon);
        self.pending = false;
    }
}

impl Repair<'_, '_> {
    /// Whether what has begun in a CASE can only be labels.
    fn are_labels(&self) -> bool {
        let case = |block: &Block| block.kind() == Kind::Case && block.awaits.is_none();
        let begun = &self.out[self.begin..];
        self.blocks.last().is_some_and(case)
            && self.is_complete()
            && begun.iter().all(|token| may_be_label(token.1.kind))
    }

    /// The colon behind labels is missing.
    fn end_labels(&mut self) {
        let end = self.last_end();
        let place = self.span(end, end);
        let diagnostic = Diagnostic::new(Code::E0010, place, "a label of CASE has no colon")
            .label("expected `:`")
            .fix("put in the colon", place, ":");
        self.tell(diagnostic);
        self.put(Kind::Colon);
        self.pending = false;
    }
}

fn begins_statement(kind: Kind) -> bool {
    matches!(kind, Kind::Word | Kind::This | Kind::Super | Kind::Direct)
}

fn begins_value(kind: Kind) -> bool {
    begins_statement(kind)
        || matches!(
            kind,
            Kind::Int
                | Kind::Real
                | Kind::Based
                | Kind::True
                | Kind::False
                | Kind::OpenParen
                | Kind::Minus
                | Kind::Not
                | Kind::String
                | Kind::Time
                | Kind::TypePrefix
        )
}

fn is_jump(kind: Kind) -> bool {
    matches!(kind, Kind::Return | Kind::Exit | Kind::Continue)
}
