//! Turns the parser's errors into messages in the reader's terms.

use super::build::{Damage, SyntaxError};
use super::feed::Located;
use super::lexer::Tokens;
use super::token::Kind;
use iecc_diag::{Code, Diagnostic};
use iecc_source::Span;
use lalrpop_util::ParseError;

/// What a message needs to know of the unit.
pub(crate) struct Explain<'e, 't> {
    pub(crate) tokens: &'e Tokens<'t>,
    /// What the parser has seen.
    pub(crate) feed: &'e [Located],
}

impl Explain<'_, '_> {
    /// The message for an error, and the byte it is at.
    pub(crate) fn error(&self, error: &SyntaxError) -> Diagnostic {
        match error {
            ParseError::UnrecognizedToken { token, expected } => self.unexpected(*token, expected),
            ParseError::ExtraToken { token } => self.unexpected(*token, &[]),
            ParseError::UnrecognizedEof { location, expected } => {
                let expected = describe(expected);
                let span = Span::new(self.tokens.file, *location, *location);
                let message = format!("the unit ends here, expected {expected}");
                Diagnostic::new(Code::E0010, span, message).label(format!("expected {expected}"))
            }
            ParseError::InvalidToken { .. } => unreachable!("the lexer has no errors"),
            ParseError::User {
                error: Damage::Strict | Damage::WrongCloser,
            } => unreachable!("repaired units are closed by their own word and parsed to the end"),
        }
    }

    fn unexpected(&self, (start, _, end): Located, expected: &[String]) -> Diagnostic {
        let (start, end) = self.written(start, end);
        let span = Span::new(self.tokens.file, start, end);
        let found = &self.tokens.text[start as usize..end as usize];
        let found = if found.is_empty() {
            "the end of the unit".to_owned()
        } else {
            format!("`{found}`")
        };
        if expected.is_empty() {
            let message = format!("{found} stands behind the end of the unit");
            return Diagnostic::new(Code::E0010, span, message);
        }
        let described = describe(expected);
        let message = format!("found {found}, expected {described}");
        let diagnostic =
            Diagnostic::new(Code::E0010, span, message).label(format!("expected {described}"));
        self.hint(diagnostic, start, expected)
    }

    /// Tokens put in by the repair are empty: what the reader sees there is the next token.
    fn written(&self, start: u32, end: u32) -> (u32, u32) {
        if start < end {
            return (start, end);
        }
        let at = self.feed.partition_point(|token| token.0 < start);
        let next = self.feed[at..].iter().find(|token| token.0 < token.2);
        next.map_or((start, end), |token| (token.0, token.2))
    }

    /// A word more where a slip is common.
    fn hint(&self, diagnostic: Diagnostic, start: u32, expected: &[String]) -> Diagnostic {
        let at = self.feed.partition_point(|token| token.0 < start);
        let kind = |at: usize| self.feed.get(at).map(|token| token.1.kind);
        let before = at.checked_sub(1).and_then(kind);
        let has = |word: &str| expected.iter().any(|one| one.trim_matches('"') == word);
        let condition = has("THEN") || has("DO") || has("OF");
        match (before, kind(at)) {
            (Some(Kind::Word), Some(Kind::Equal)) => {
                diagnostic.note("a value is assigned with `:=`")
            }
            (Some(Kind::Colon), Some(Kind::Equal)) => {
                diagnostic.note("`:=` is one sign, without white space in it")
            }
            (Some(Kind::Equal), Some(Kind::Equal)) => {
                diagnostic.note("values are compared with `=`")
            }
            (_, Some(Kind::Assign)) if condition => {
                let span = Span::new(self.tokens.file, start, start + 2);
                let note = "`:=` assigns, which a condition cannot; values are compared with `=`";
                diagnostic.note(note).fix("compare with `=`", span, "=")
            }
            (_, Some(Kind::Assign)) if has(":") => {
                diagnostic.note("a declaration is written `name : type := value;`")
            }
            (Some(Kind::Int), Some(Kind::Comma)) if self.joined(at) => {
                let span = Span::new(self.tokens.file, start, start + 1);
                diagnostic.fix("write a decimal point", span, ".")
            }
            (_, Some(Kind::Dot)) if kind(at + 1) == Some(Kind::Int) && self.joined(at) => {
                let span = Span::new(self.tokens.file, start, start);
                let note = "a real number has digits on both sides of its decimal point";
                diagnostic.note(note).fix("put in a 0", span, "0")
            }
            (Some(Kind::And | Kind::Or | Kind::Xor | Kind::Ampersand), Some(kind))
                if kind.compares() =>
            {
                diagnostic.note("each comparison has two sides: `x > 0 AND x < 10`")
            }
            (Some(Kind::Int), Some(Kind::CloseBracket)) if has("..") => {
                diagnostic.note("an array has a first and a last subscript: `ARRAY[0..9]`")
            }
            (_, Some(Kind::Word)) if self.negated_operator(at).is_some() => {
                let (start, _, end) = self.feed[at];
                let span = Span::new(self.tokens.file, start, end);
                let instead = self.negated_operator(at).unwrap_or_default();
                diagnostic.fix(format!("write `{instead}`"), span, instead)
            }
            (Some(Kind::Word), Some(Kind::Word)) if has(":") => {
                diagnostic.note("the name comes before its type: `count : INT;`")
            }
            _ => diagnostic,
        }
    }

    /// What ANDN and its like, which belong to instruction lists, are in Structured Text.
    fn negated_operator(&self, at: usize) -> Option<&'static str> {
        let (start, _, end) = *self.feed.get(at)?;
        let text = &self.tokens.text[start as usize..end as usize];
        let operators = [("ANDN", "AND NOT"), ("ORN", "OR NOT"), ("XORN", "XOR NOT")];
        let found = operators.into_iter();
        let mut found = found.filter(|(word, _)| text.eq_ignore_ascii_case(word));
        found.next().map(|(_, instead)| instead)
    }

    /// Whether a token touches the next one.
    fn joined(&self, at: usize) -> bool {
        let next = self.feed.get(at + 1);
        next.is_some_and(|next| next.0 == self.feed[at].2 && next.1.kind == Kind::Int)
    }
}

/// The tokens the parser would accept, in the reader's terms.
fn describe(expected: &[String]) -> String {
    let has = |token: &str| expected.iter().any(|e| e.trim_matches('"') == token);
    let mut list: Vec<String> = Vec::new();
    let mut add = |text: &str| list.push(text.to_owned());
    let value = has("int") && has("(");
    let statement = has("IF") && has("word");
    match () {
        () if value && has("IF") => add("a label, or a statement"),
        () if statement => add("a statement"),
        () if value => add("a value"),
        () if has("word") && has("STRUCT") => add("a type"),
        () if has("word") => add("a name"),
        () if has("direct") => add("a direct address"),
        () => {}
    }
    if has("VAR") && !has("word") {
        add("a section of variables");
    }
    if has("**") {
        add("an operator");
    }
    for sign in [
        ":=", "=>", ";", ":", "..", ",", ")", "]", "(", "[", ".", "=",
    ] {
        let part_of_value = value && (sign == "(" || sign == "[");
        let continues = has("**") && [".", "[", "(", "="].contains(&sign);
        // A further assignment is of CODESYS, and seldom what is missing.
        let again = sign == ":=" && has("**") && has(";") && !has("?=");
        if has(sign) && !part_of_value && !continues && !again {
            list.push(format!("`{sign}`"));
        }
    }
    let words = [
        "THEN",
        "DO",
        "OF",
        "TO",
        "BY",
        "UNTIL",
        "ON",
        "WITH",
        "ELSE",
        "END_IF",
        "END_CASE",
        "END_FOR",
        "END_WHILE",
        "END_REPEAT",
        "END_VAR",
        "END_STRUCT",
        "END_TYPE",
    ];
    for word in words {
        let unusual = statement && !list.is_empty() && !word.starts_with("END_");
        if has(word) && !unusual {
            list.push(word.to_owned());
        }
    }
    if list.is_empty() {
        let rest = expected
            .iter()
            .map(|token| format!("`{}`", token.trim_matches('"')));
        list.extend(rest.take(MOST_NAMED));
    }
    join(&list)
}

/// How many tokens are named where they have no common name.
const MOST_NAMED: usize = 6;

fn join(list: &[String]) -> String {
    match list {
        [] => "something else".to_owned(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} or {last}", rest.join(", ")),
    }
}
