//! Keywords that are spelled wrongly: words that are close to a keyword, and stand where no name can
//! stand but that keyword can.

use super::blocks::{Block, Context, closer};
use super::{Kind, Located, Repair};
use crate::st::token::Token;
use iecc_diag::{Code, Diagnostic, closest_within};

/// What begins a statement, or a section or member among them.
const OPENERS: [Kind; 20] = [
    Kind::If,
    Kind::Elsif,
    Kind::Else,
    Kind::Case,
    Kind::For,
    Kind::While,
    Kind::Repeat,
    Kind::Until,
    Kind::Var,
    Kind::VarInput,
    Kind::VarOutput,
    Kind::VarInOut,
    Kind::VarTemp,
    Kind::VarExternal,
    Kind::VarGlobal,
    Kind::Method,
    Kind::Property,
    Kind::Action,
    Kind::Extends,
    Kind::Implements,
];

const MODIFIERS: [Kind; 7] = [
    Kind::Public,
    Kind::Private,
    Kind::Protected,
    Kind::Internal,
    Kind::Abstract,
    Kind::Final,
    Kind::Override,
];

const OPERATORS: [Kind; 9] = [
    Kind::And,
    Kind::Or,
    Kind::Xor,
    Kind::Mod,
    Kind::To,
    Kind::By,
    Kind::Then,
    Kind::Do,
    Kind::Of,
];

const UNITS: [Kind; 7] = [
    Kind::Function,
    Kind::FunctionBlock,
    Kind::Program,
    Kind::Class,
    Kind::Interface,
    Kind::Type,
    Kind::Configuration,
];

/// The unit that a word which is close to its keyword opens.
pub(crate) fn misspelt_unit(word: &str) -> Option<Kind> {
    closest_keyword(word, UNITS.into_iter())
}

/// Whether a word is close to the one that closes a unit.
pub(crate) fn is_misspelt_closer(word: &str, opener: Kind) -> bool {
    let begins = word
        .get(..3)
        .is_some_and(|begin| begin.eq_ignore_ascii_case("END"));
    begins && closest_keyword(word, [closer(opener)].into_iter()).is_some()
}

/// Slips mostly spare the first letter.
fn closest_keyword(word: &str, kinds: impl Iterator<Item = Kind> + Clone) -> Option<Kind> {
    let spelling = |kind: Kind| kind.keyword().expect("only keywords are searched");
    let initial = |text: &str| text.as_bytes().first().map(u8::to_ascii_uppercase);
    let candidates = kinds.clone().map(spelling);
    let slips = match word.len() {
        0..6 => 1,
        6..10 => 2,
        _ => 3,
    };
    let found = closest_within(
        word,
        slips,
        candidates
            .filter(|name| initial(name) == initial(word) && !name.eq_ignore_ascii_case(word)),
    )?;
    kinds.into_iter().find(|&kind| spelling(kind) == found)
}

impl Repair<'_, '_> {
    /// The keyword that a word is meant as. Gives a message for each such place.
    pub(super) fn corrected(&mut self, at: usize) -> Option<Kind> {
        let token = self.feed.tokens[at];
        if token.1.kind != Kind::Word || !self.brackets.is_empty() {
            return None;
        }
        let apart = self.is_end_apart(at);
        let kind = match apart {
            Some(kind) => kind,
            None => self.misspelt(at)?,
        };
        let name = kind.keyword().expect("only keywords are searched");
        let end = match apart {
            Some(_) => {
                self.dropped = Some(at + 1);
                self.feed.tokens[at + 1].2
            }
            None => token.2,
        };
        let span = self.span(token.0, end);
        let text = &self.tokens.text[token.0 as usize..end as usize];
        let message = format!("found `{text}`, expected {name}");
        let diagnostic = Diagnostic::new(Code::E0037, span, message)
            .label(format!("expected {name}"))
            .fix(format!("write {name}"), span, name);
        self.report(diagnostic);
        Some(kind)
    }

    /// The word that opens a unit.
    pub(super) fn misspelt_opener_of_unit(&mut self, token: Located, opener: Kind) {
        let span = self.span_of(token);
        let name = opener.keyword().expect("units are opened by keywords");
        let message = format!("found `{}`, expected {name}", self.text(token));
        let diagnostic = Diagnostic::new(Code::E0037, span, message)
            .label(format!("expected {name}"))
            .fix(format!("write {name}"), span, name);
        self.report(diagnostic);
    }

    /// `END IF` and the like.
    fn is_end_apart(&self, at: usize) -> Option<Kind> {
        let text = self.text(self.feed.tokens[at]);
        let opener = self.next_kind(at).filter(|kind| kind.keyword().is_some())?;
        let open = self.blocks.iter().rev();
        let ends = text.eq_ignore_ascii_case("END") && !self.on_new_line(at + 1);
        let mut open = open.map(Block::kind);
        (ends && open.any(|kind| kind == opener)).then(|| closer(opener))
    }

    fn misspelt(&self, at: usize) -> Option<Kind> {
        let text = self.text(self.feed.tokens[at]);
        self.misspelt_closer(at, text)
            .or_else(|| self.misspelt_divider(text))
            .or_else(|| self.misspelt_in_header(at, text))
            .or_else(|| self.misspelt_opener(at, text))
            .or_else(|| self.misspelt_type(at, text))
            .or_else(|| self.misspelt_operator(at, text))
    }

    /// Words that begin with END where a block is open.
    fn misspelt_closer(&self, at: usize, text: &str) -> Option<Kind> {
        let begins = text.get(..3)?.eq_ignore_ascii_case("END") && text.len() > 3;
        let ends = !matches!(
            self.next_kind(at),
            Some(Kind::Assign | Kind::Dot | Kind::OpenBracket | Kind::Colon | Kind::Comma)
        );
        let placed = !self.pending || self.on_new_line(at);
        if !(begins && ends && placed) {
            return None;
        }
        let open = self.blocks.iter().rev().map(|block| closer(block.kind()));
        closest_keyword(text, open)
    }

    /// THEN, DO and OF where they are awaited.
    fn misspelt_divider(&self, text: &str) -> Option<Kind> {
        let word = self.awaits()?;
        let placed = word != Kind::EndRepeat && self.follows_operand();
        placed.then(|| closest_keyword(text, [word].into_iter()))?
    }

    fn misspelt_in_header(&self, at: usize, text: &str) -> Option<Kind> {
        if !self.in_header() || self.on_new_line(at) || self.next_kind(at) != Some(Kind::Word) {
            return None;
        }
        if self.last_kind() == Some(Kind::Word) {
            return closest_keyword(text, [Kind::Extends, Kind::Implements].into_iter());
        }
        closest_keyword(text, MODIFIERS.into_iter())
    }

    /// What begins a statement, a section or a member, with a name or a value behind it.
    fn misspelt_opener(&self, at: usize, text: &str) -> Option<Kind> {
        let begins = !self.pending || self.in_header() && self.on_new_line(at);
        if !begins || self.context() != Context::Statements {
            return None;
        }
        let next = self.feed.tokens.get(at + 1)?.1;
        let found = closest_keyword(text, OPENERS.into_iter())?;
        let section = found.opens_section() || found == Kind::Method;
        let value = begins_value(next) || section && next.kind.is_modifier();
        let lone = matches!(found, Kind::Else | Kind::Repeat);
        let fits = match next.kind {
            Kind::Word => lone || section || !self.on_new_line(at + 1),
            _ => value && !lone,
        };
        fits.then_some(found)
    }

    /// ARRAY, STRUCT and the like behind a colon.
    fn misspelt_type(&self, at: usize, text: &str) -> Option<Kind> {
        if !matches!(self.last_kind()?, Kind::Colon | Kind::Of) {
            return None;
        }
        let next = self.next_kind(at)?;
        let same_line = !self.on_new_line(at + 1);
        let candidates: &[Kind] = match next {
            Kind::OpenBracket => &[Kind::Array],
            Kind::Word if same_line => &[Kind::RefTo],
            Kind::Word if self.ends_structure(at) => &[Kind::Struct],
            _ => return None,
        };
        closest_keyword(text, candidates.iter().copied())
    }

    /// Whether END_STRUCT stands ahead that closes nothing yet.
    fn ends_structure(&self, at: usize) -> bool {
        let ahead = self.feed.tokens[at..].iter().map(|token| token.1.kind);
        let mut ahead = ahead.filter(|kind| matches!(kind, Kind::Struct | Kind::EndStruct));
        let inside = self
            .blocks
            .last()
            .is_some_and(|block| block.kind() == Kind::Struct);
        !inside && ahead.next() == Some(Kind::EndStruct)
    }

    /// Operators that are words, between two values.
    fn misspelt_operator(&self, at: usize, text: &str) -> Option<Kind> {
        let next = self.feed.tokens.get(at + 1)?.1;
        let between = self.pending
            && self.follows_operand()
            && !self.on_new_line(at)
            && begins_value(next)
            && self.context() != Context::Types;
        // Instructions of Instruction List, which negate as well.
        let instruction = ["ANDN", "ORN", "XORN"]
            .iter()
            .any(|name| name.eq_ignore_ascii_case(text));
        (between && !instruction).then(|| closest_keyword(text, OPERATORS.into_iter()))?
    }

    fn follows_operand(&self) -> bool {
        self.last_kind().is_some_and(Kind::ends_operand)
    }
}

fn begins_value(token: Token) -> bool {
    let kind = token.kind;
    let opens = kind.ends_operand() && !matches!(kind, Kind::CloseParen | Kind::CloseBracket);
    opens && kind != Kind::Caret || matches!(kind, Kind::Not | Kind::TypePrefix)
}
