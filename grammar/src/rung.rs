//! Parses one rung text, or says in the terms of the trade why it cannot.
//!
//! Accepted: `XIC(start)[XIO(stop) ,]OTE(motor);` Rejected: `XIC(start OTE(motor);` (E5003).
//! A text gives at most one syntax message: behind the first mistake the rest is guesswork.

use crate::generated::rung::RungParser;
use crate::rung_actions::Builder;
use crate::rung_lexer::{Located, Sign, Token, tokens};
use iecc_ast::rung::Rung;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::MappedText;
use lalrpop_util::ParseError;
use std::convert::Infallible;

/// How many brackets may be open at once in a rung.
pub const MAX_NESTING: usize = 64;

/// How many operators the operands of one instruction may have together. Expressions nest at most
/// this deep plus [`MAX_NESTING`].
pub const MAX_OPERATORS: usize = 256;

/// Parses a rung text up to its semicolon. `None` after an error, which is then in `diagnostics`.
pub fn parse_rung(text: &MappedText, diagnostics: &mut Diagnostics) -> Option<Rung> {
    let tokens = tokens(text.text());
    if let Some(diagnostic) = nesting_error(text, &tokens) {
        diagnostics.push(diagnostic);
        return None;
    }
    let mut build = Builder {
        text,
        diagnostics: Diagnostics::new(),
    };
    let input = tokens.iter().copied().map(Ok::<_, Infallible>);
    match RungParser::new().parse(&mut build, input) {
        Ok(rung) if build.diagnostics.is_empty() => Some(rung),
        Ok(_) => {
            diagnostics.append(build.diagnostics);
            None
        }
        Err(error) => {
            diagnostics.push(
                Explain {
                    text,
                    tokens: &tokens,
                }
                .error(error),
            );
            None
        }
    }
}

/// Refuses texts whose tree could overflow the stack of whoever walks it.
fn nesting_error(text: &MappedText, tokens: &[Located<'_>]) -> Option<Diagnostic> {
    let mut open = Open::default();
    tokens.iter().find_map(|&(start, token, end)| {
        let message = open.take(token)?;
        let diagnostic = Diagnostic::new(Code::E5004, text.span(start..end), message);
        Some(diagnostic.note("compute parts of the expression into tags of their own"))
    })
}

/// What is open at a token.
#[derive(Default)]
struct Open {
    brackets: usize,
    parens: usize,
    /// Operators since the parenthesis of the instruction was opened.
    operators: usize,
}

impl Open {
    /// Counts a token; says what there is too much of.
    fn take(&mut self, token: Token<'_>) -> Option<String> {
        if opens(token) {
            self.brackets += 1;
            self.parens += usize::from(token == Token::Sign(Sign::OpenParen));
        } else if closes(token) {
            self.brackets = self.brackets.saturating_sub(1);
            let paren = usize::from(token == Token::Sign(Sign::CloseParen));
            self.parens = self.parens.saturating_sub(paren);
        }
        self.operators += usize::from(is_operator(token));
        if self.parens == 0 {
            self.operators = 0;
        }
        if self.brackets > MAX_NESTING {
            return Some(format!("more than {MAX_NESTING} brackets are open here"));
        }
        (self.operators > MAX_OPERATORS)
            .then(|| format!("more than {MAX_OPERATORS} operators in one instruction"))
    }
}

fn opens(token: Token<'_>) -> bool {
    matches!(token, Token::Sign(Sign::OpenParen | Sign::OpenBracket))
}

fn closes(token: Token<'_>) -> bool {
    matches!(token, Token::Sign(Sign::CloseParen | Sign::CloseBracket))
}

fn is_operator(token: Token<'_>) -> bool {
    match token {
        Token::And(_) | Token::Or(_) | Token::Xor(_) | Token::Mod(_) | Token::Not(_) => true,
        Token::Sign(sign) => is_operator_sign(sign),
        Token::Word(_)
        | Token::Digits(_)
        | Token::Int(_)
        | Token::Real(_)
        | Token::String(_)
        | Token::Unknown(_) => false,
    }
}

fn is_operator_sign(sign: Sign) -> bool {
    use Sign::*;
    match sign {
        Plus | Minus | Star | Slash | StarStar | Equal | NotEqual | Less | LessEqual | Greater
        | GreaterEqual | Ampersand | LogicalAnd | LogicalOr | LogicalXor | LogicalNot => true,
        OpenParen | CloseParen | OpenBracket | CloseBracket | Comma | Semicolon | Question
        | Percent | Dot | Colon | Backslash | Word | Int | Real | String => false,
    }
}

/// Turns parser errors into messages.
struct Explain<'a> {
    text: &'a MappedText,
    tokens: &'a [Located<'a>],
}

impl Explain<'_> {
    fn error(&self, error: ParseError<usize, Token<'_>, Infallible>) -> Diagnostic {
        match error {
            ParseError::UnrecognizedToken { token, expected } => self.unexpected(token, &expected),
            ParseError::UnrecognizedEof { expected, .. } => self.end_of_text(&expected),
            ParseError::ExtraToken { token } => self.after_semicolon(token),
            ParseError::InvalidToken { .. } => unreachable!("the lexer has no errors"),
            ParseError::User { error } => match error {},
        }
    }

    fn unexpected(&self, (start, token, end): Located<'_>, expected: &[String]) -> Diagnostic {
        let place = self.text.span(start..end);
        if let Token::Unknown(text) = token {
            return Diagnostic::new(Code::E5003, place, unknown_text(text));
        }
        if expected.is_empty() {
            return self.after_semicolon((start, token, end));
        }
        let expected = describe(expected);
        let found = &self.text.text()[start..end];
        let message = format!("found `{found}`, expected {expected}");
        let diagnostic =
            Diagnostic::new(Code::E5003, place, message).label(format!("expected {expected}"));
        self.point_at_opener(diagnostic, start)
    }

    fn end_of_text(&self, expected: &[String]) -> Diagnostic {
        let end = self
            .tokens
            .last()
            .map_or(self.text.text().len(), |token| token.2);
        let place = self.text.span(end..end);
        if expected.iter().any(|token| token == "\";\"") {
            return Diagnostic::new(Code::E5003, place, "the rung text does not end with `;`")
                .label("expected `;`")
                .fix("end the rung with `;`", place, ";");
        }
        let expected = describe(expected);
        let message = format!("the rung text ends here, expected {expected}");
        let diagnostic =
            Diagnostic::new(Code::E5003, place, message).label(format!("expected {expected}"));
        self.point_at_opener(diagnostic, end)
    }

    fn after_semicolon(&self, (start, _, end): Located<'_>) -> Diagnostic {
        Diagnostic::new(
            Code::E5003,
            self.text.span(start..end),
            "text behind the `;` that ends the rung",
        )
        .label("expected the end of the rung text")
        .note("each rung has a `<Rung>` element of its own")
    }

    /// Points at the innermost bracket that is open before the offset.
    fn point_at_opener(&self, diagnostic: Diagnostic, before: usize) -> Diagnostic {
        let mut open = Vec::new();
        for &(start, token, end) in self.tokens.iter().take_while(|token| token.0 < before) {
            if opens(token) {
                open.push(start..end);
            } else if closes(token) {
                open.pop();
            }
        }
        match open.pop() {
            Some(range) => {
                let text = format!("inside this `{}`", &self.text.text()[range.clone()]);
                diagnostic.also(self.text.span(range), text)
            }
            None => diagnostic,
        }
    }
}

fn unknown_text(text: &str) -> String {
    if text.starts_with('\'') {
        return "the string is not closed, expected `'`".to_owned();
    }
    format!("`{}` has no meaning in rung text", text.escape_debug())
}

/// The tokens the parser would accept, in the reader's terms.
fn describe(expected: &[String]) -> String {
    let has = |token: &str| expected.iter().any(|e| e.trim_matches('"') == token);
    let mut list: Vec<&str> = Vec::new();
    match () {
        () if has("?") => list.push("an operand"),
        () if has("int") && has("real") => list.push("a value"),
        () if has("digits") => list.extend(["a name", "a number"]),
        () if has("word") && has("and") => list.push("an instruction"),
        () if has("word") => list.push("a name"),
        () => {}
    }
    if has("*") {
        list.push("an operator");
    }
    let starts_value = has("int");
    for (token, shown) in [
        ("(", "`(`"),
        ("[", "`[`"),
        (".", "`.`"),
        (")", "`)`"),
        ("]", "`]`"),
        (",", "`,`"),
        (";", "`;`"),
    ] {
        if has(token) && !(starts_value && token == "(") {
            list.push(shown);
        }
    }
    join(&list)
}

fn join(list: &[&str]) -> String {
    match list {
        [] => "something else".to_owned(),
        [one] => (*one).to_owned(),
        [rest @ .., last] => format!("{} or {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests;
