//! Refuses units that nest so deep that parsing them would take more than linear time: recovery
//! looks at the whole stack of the parser for every token that it leaves out.

use super::feed::Located;
use super::token::Kind;
use iecc_diag::{Code, Diagnostic};
use iecc_source::{FileId, Span};

/// How many blocks, brackets, or signs before an operand or type may be open at once. The tree has
/// limits of its own, which are narrower for blocks.
pub(crate) const MAX_OPEN: u32 = 128;

/// A message, if a unit nests too deeply to be parsed.
pub(crate) fn nesting_error(file: FileId, tokens: &[Located]) -> Option<Diagnostic> {
    let mut open = Open::default();
    tokens.iter().find_map(|&(start, token, end)| {
        let what = open.take(token.kind)?;
        let message = format!("more than {MAX_OPEN} {what} are open here");
        let diagnostic = Diagnostic::new(Code::E0013, Span::new(file, start, end), message)
            .note("compute parts of it into variables of their own, or move them into a function");
        Some(diagnostic)
    })
}

#[derive(Default)]
struct Open {
    blocks: u32,
    brackets: u32,
    /// Signs before an operand.
    unary: u32,
    /// `ARRAY … OF`, `REF_TO` and the like before a type.
    types: u32,
    behind_operand: bool,
}

impl Open {
    /// Counts a token; says of what there is too much.
    fn take(&mut self, kind: Kind) -> Option<&'static str> {
        self.count(kind);
        self.behind_operand = kind.ends_operand();
        if self.blocks > MAX_OPEN {
            Some("blocks")
        } else if self.brackets > MAX_OPEN {
            Some("brackets")
        } else if self.unary > MAX_OPEN {
            Some("signs before one operand")
        } else if self.types > MAX_OPEN {
            Some("parts of one type")
        } else {
            None
        }
    }

    fn count(&mut self, kind: Kind) {
        match kind {
            Kind::If
            | Kind::Case
            | Kind::For
            | Kind::While
            | Kind::Repeat
            | Kind::Struct
            | Kind::Union => self.blocks += 1,
            Kind::EndIf
            | Kind::EndCase
            | Kind::EndFor
            | Kind::EndWhile
            | Kind::EndRepeat
            | Kind::EndStruct
            | Kind::EndUnion => self.blocks = self.blocks.saturating_sub(1),
            Kind::OpenParen | Kind::OpenBracket => self.brackets += 1,
            Kind::CloseParen | Kind::CloseBracket => {
                self.brackets = self.brackets.saturating_sub(1);
            }
            Kind::Semicolon => (self.brackets, self.types) = (0, 0),
            Kind::Of | Kind::RefTo | Kind::Pointer | Kind::Reference => self.types += 1,
            _ => {}
        }
        let sign = matches!(kind, Kind::Minus | Kind::Plus | Kind::Not) && !self.behind_operand;
        self.unary = if sign { self.unary + 1 } else { 0 };
    }
}
