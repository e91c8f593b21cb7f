//! Rung text as tokens. Total: what fits nothing becomes [`Token::Unknown`].
//!
//! Two places need to know what stands before. In a path into a tag a dot is a separator and
//! digits are a bit number (`word.5`, `a[1].2`, `Local:2:I`), elsewhere `.5` is a number (`x*.5`).
//! And a name part after a dot, colon or backslash, or before a colon, is a name even if it is
//! spelled like a word operator (`Mod:I`, `status.not`).

use logos::{Lexer, Logos};

/// A token with the byte range it stands at.
pub(crate) type Located<'t> = (usize, Token<'t>, usize);

/// A token of rung text. Those that can be a name carry their text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Token<'t> {
    Word(&'t str),
    And(&'t str),
    Or(&'t str),
    Xor(&'t str),
    Mod(&'t str),
    Not(&'t str),
    /// A bit number or the numeric part of a colon name.
    Digits(&'t str),
    Int(&'t str),
    Real(&'t str),
    /// With its quotes.
    String(&'t str),
    /// Punctuation and operators made of signs.
    Sign(Sign),
    Unknown(&'t str),
}

/// Punctuation and operators made of signs.
#[derive(Logos, Debug, Clone, Copy, PartialEq, Eq)]
#[logos(skip r"[ \t\r\n\f]+")]
pub(crate) enum Sign {
    #[token("(")]
    OpenParen,
    #[token(")")]
    CloseParen,
    #[token("[")]
    OpenBracket,
    #[token("]")]
    CloseBracket,
    #[token(",")]
    Comma,
    #[token(";")]
    Semicolon,
    #[token("?")]
    Question,
    #[token("%")]
    Percent,
    #[token(".")]
    Dot,
    #[token(":")]
    Colon,
    #[token("\\")]
    Backslash,
    #[token("+")]
    Plus,
    #[token("-")]
    Minus,
    #[token("*")]
    Star,
    #[token("/")]
    Slash,
    #[token("**")]
    StarStar,
    #[token("=")]
    Equal,
    #[token("<>")]
    NotEqual,
    #[token("<")]
    Less,
    #[token("<=")]
    LessEqual,
    #[token(">")]
    Greater,
    #[token(">=")]
    GreaterEqual,
    #[token("&")]
    Ampersand,
    #[token("&&")]
    LogicalAnd,
    #[token("||")]
    LogicalOr,
    #[token("^^")]
    LogicalXor,
    #[token("!")]
    LogicalNot,

    // The classes below carry text; they become other variants of `Token`.
    #[regex(r"[A-Za-z_][A-Za-z0-9_]*")]
    Word,
    #[regex(r"[0-9][0-9_]*([uU][lL]?|[lL])?")]
    #[regex(r"(2|8|16)#[0-9A-Fa-f_]+([uU][lL]?|[lL])?")]
    Int,
    #[regex(r"[0-9][0-9_]*\.[0-9_]*([eE][+-]?[0-9]+)?")]
    #[regex(r"\.[0-9][0-9_]*([eE][+-]?[0-9]+)?")]
    #[regex(r"[0-9][0-9_]*[eE][+-]?[0-9]+")]
    #[regex(r"1\.#[A-Za-z]+[0-9]*([eE][+-]?[0-9]+)?")]
    #[token("1.$")]
    Real,
    #[regex(r"'([^'$\n]|\$[^\n])*'")]
    String,
}

/// All tokens of a rung text.
pub(crate) fn tokens(text: &str) -> Vec<Located<'_>> {
    let mut lexer = RungLexer {
        raw: Sign::lexer(text),
        before: Before::Other,
    };
    let mut tokens = Vec::new();
    while let Some(token) = lexer.next_token() {
        tokens.push(token);
    }
    tokens
}

/// What the last token says about the next one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Before {
    /// A path into a tag may go on: a dot is a separator.
    Path,
    /// A dot, colon or backslash of a path: digits are digits, words are names.
    Separator,
    Other,
}

struct RungLexer<'t> {
    raw: Lexer<'t, Sign>,
    before: Before,
}

impl<'t> RungLexer<'t> {
    fn next_token(&mut self) -> Option<Located<'t>> {
        let (start, token, end) = match self.part_of_path() {
            Some(token) => token,
            None => {
                let sign = self.raw.next()?;
                let span = self.raw.span();
                (span.start, self.classify(sign), span.end)
            }
        };
        self.before = before_next(token, self.before);
        Some((start, token, end))
    }

    /// The pieces of a path that would lex differently elsewhere.
    fn part_of_path(&mut self) -> Option<Located<'t>> {
        let rest = self.raw.remainder();
        let ignored = rest.len()
            - rest
                .trim_start_matches([' ', '\t', '\r', '\n', '\x0c'])
                .len();
        let rest = &rest[ignored..];
        let length = match self.before {
            Before::Path => usize::from(rest.starts_with('.')),
            Before::Separator => rest.bytes().take_while(u8::is_ascii_digit).count(),
            Before::Other => 0,
        };
        if length == 0 {
            return None;
        }
        self.raw.bump(ignored + length);
        let end = self.raw.span().end;
        let token = match self.before {
            Before::Separator => Token::Digits(&rest[..length]),
            Before::Path | Before::Other => Token::Sign(Sign::Dot),
        };
        Some((end - length, token, end))
    }

    fn classify(&self, sign: Result<Sign, ()>) -> Token<'t> {
        let text = self.raw.slice();
        match sign {
            Ok(Sign::Word) if self.is_name() => Token::Word(text),
            Ok(Sign::Word) => word(text),
            Ok(Sign::Int) => Token::Int(text),
            Ok(Sign::Real) => Token::Real(text),
            Ok(Sign::String) => Token::String(text),
            Ok(other) => Token::Sign(other),
            Err(()) => Token::Unknown(text),
        }
    }

    fn is_name(&self) -> bool {
        self.before == Before::Separator || self.raw.remainder().trim_start().starts_with(':')
    }
}

fn word(text: &str) -> Token<'_> {
    type Make = fn(&str) -> Token<'_>;
    const OPERATORS: [(&str, Make); 5] = [
        ("AND", |text| Token::And(text)),
        ("OR", |text| Token::Or(text)),
        ("XOR", |text| Token::Xor(text)),
        ("MOD", |text| Token::Mod(text)),
        ("NOT", |text| Token::Not(text)),
    ];
    let operator = OPERATORS
        .iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(text));
    operator.map_or(Token::Word(text), |(_, make)| make(text))
}

fn before_next(token: Token<'_>, before: Before) -> Before {
    match token {
        Token::Word(_) | Token::Digits(_) | Token::Sign(Sign::CloseBracket) => Before::Path,
        Token::Sign(Sign::Dot) if before == Before::Path => Before::Separator,
        Token::Sign(Sign::Colon | Sign::Backslash) => Before::Separator,
        Token::Sign(_)
        | Token::And(_)
        | Token::Or(_)
        | Token::Xor(_)
        | Token::Mod(_)
        | Token::Not(_)
        | Token::Int(_)
        | Token::Real(_)
        | Token::String(_)
        | Token::Unknown(_) => Before::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<&str> {
        tokens(text)
            .into_iter()
            .map(|(start, _, end)| &text[start..end])
            .collect()
    }

    #[test]
    fn a_dot_separates_in_a_path_and_begins_a_number_elsewhere() {
        assert_eq!(texts("a.5.b"), ["a", ".", "5", ".", "b"]);
        assert_eq!(texts("a*.5"), ["a", "*", ".5"]);
        assert_eq!(texts("a[1.5].2"), ["a", "[", "1.5", "]", ".", "2"]);
        assert_eq!(
            texts("Local:2:I.Data.0"),
            ["Local", ":", "2", ":", "I", ".", "Data", ".", "0"]
        );
        assert_eq!(texts("a AND .5"), ["a", "AND", ".5"]);
    }

    #[test]
    fn word_operators_are_names_inside_a_path() {
        assert_eq!(tokens("x.not")[2].1, Token::Word("not"));
        assert_eq!(tokens("Mod:I1")[0].1, Token::Word("Mod"));
        assert_eq!(tokens("a Mod b")[1].1, Token::Mod("Mod"));
    }

    #[test]
    fn numbers_in_every_spelling_are_one_token() {
        for text in [
            "16#ffff_0000",
            "2#1010",
            "12_000UL",
            "1e5",
            "2.",
            "3.5e-3",
            "1.#QNAN000e+000",
            "1.$",
        ] {
            assert_eq!(texts(text), [text]);
        }
    }

    #[test]
    fn bad_bytes_become_unknown_tokens() {
        assert_eq!(tokens("a#b")[1], (1, Token::Unknown("#"), 2));
        assert_eq!(tokens("é")[0].1, Token::Unknown("é"));
        assert_eq!(tokens("'open")[0].1, Token::Unknown("'open"));
    }
}
