//! Bodies in other languages of the standard. A chart or a list of instructions gives one message,
//! and is left out, so that nobody reads a page of them.

use super::blocks::{Context, closer, is_member, is_pou};
use super::{Kind, Repair};
use iecc_diag::{Code, Diagnostic};

/// The instructions that a list begins with.
const FIRST_INSTRUCTIONS: [&str; 6] = ["LD", "LDN", "CAL", "CALC", "CALCN", "JMP"];

impl Repair<'_, '_> {
    /// Whether a token belongs to a body in another language, which is left out.
    pub(super) fn is_foreign(&mut self, at: usize) -> bool {
        let kind = self.feed.tokens[at].1.kind;
        let Some(block) = self.blocks.last() else {
            return false;
        };
        if self.foreign {
            self.foreign = kind != closer(block.kind());
            return self.foreign;
        }
        let own = is_pou(block.kind()) || is_member(block.kind());
        if !own || self.context() != Context::Statements {
            return false;
        }
        if let Some(language) = self.foreign_language(at) {
            self.foreign = true;
            if self.in_header() {
                self.end_header();
                self.pending = false;
            }
            self.foreign_body(at, language);
        }
        self.foreign
    }

    /// The language of a body that begins at a token, if it is not Structured Text.
    fn foreign_language(&self, at: usize) -> Option<&'static str> {
        let next = self.next_kind(at);
        let begins = self.on_new_line(at) && (!self.pending || self.in_header());
        match self.feed.tokens[at].1.kind {
            Kind::InitialStep if next == Some(Kind::Word) => Some("Sequential Function Chart"),
            Kind::Step | Kind::Transition
                if begins && matches!(next, Some(Kind::Word | Kind::From)) =>
            {
                Some("Sequential Function Chart")
            }
            Kind::Word if begins && self.is_instruction(at) => Some("Instruction List"),
            _ => None,
        }
    }

    fn is_instruction(&self, at: usize) -> bool {
        let text = self.text(self.feed.tokens[at]);
        let operand = matches!(
            self.next_kind(at),
            Some(
                Kind::Word
                    | Kind::Int
                    | Kind::Direct
                    | Kind::Real
                    | Kind::Based
                    | Kind::Time
                    | Kind::String
                    | Kind::TypePrefix
                    | Kind::True
                    | Kind::False
            )
        );
        let names = FIRST_INSTRUCTIONS.iter();
        operand
            && !self.on_new_line(at + 1)
            && names
                .into_iter()
                .any(|name| name.eq_ignore_ascii_case(text))
    }

    fn foreign_body(&mut self, at: usize, language: &str) {
        let span = self.span_of(self.feed.tokens[at]);
        let message = format!("the body is written in {language}, which is not compiled yet");
        let diagnostic =
            Diagnostic::new(Code::E0036, span, message).label("expected Structured Text");
        self.report(diagnostic);
    }
}
