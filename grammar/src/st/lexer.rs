//! Structured Text as tokens. Total: what fits nothing becomes a token of kind `Unknown`, a
//! string, comment or pragma without end becomes a token that says so. Nothing is lost: the text
//! between two tokens is white space.
//!
//! Block comments nest. Where one that is nested in another does not end, the outer one ends where
//! it would without nesting, so that one slip does not take the rest of the file.

use super::token::{Keywords, Kind, Token};
use super::{Dialect, soft};
use iecc_ast::st::{TimeKind, TimeShape};
use iecc_ast::{Names, Symbol};
use iecc_source::FileId;
use logos::{Lexer, Logos};

/// The tokens of a text, with the text.
#[derive(Debug, Clone)]
pub struct Tokens<'t> {
    /// The file.
    pub file: FileId,
    /// The whole text.
    pub text: &'t str,
    /// Every token in its order, comments and pragmas included.
    pub list: Vec<Token>,
    /// The symbol that stands where a name is missing.
    pub no_name: Symbol,
    /// Whose words and forms these are.
    pub dialect: Dialect,
}

/// Makes tokens of a text, and enters its names.
pub fn lex<'t>(file: FileId, text: &'t str, dialect: Dialect, names: &mut Names) -> Tokens<'t> {
    let keywords = Keywords::new(dialect, names);
    let no_name = names.intern("?");
    let mut raw = Raw::lexer(text);
    raw.bump(byte_order_mark(text));
    let mut lexer = StLexer {
        raw,
        keywords,
        names,
        no_name,
        list: Vec::with_capacity(text.len() / 4),
        soft: Vec::new(),
        nested_without_end: 0,
    };
    lexer.run();
    let StLexer { mut list, soft, .. } = lexer;
    soft::decide(&mut list, &soft);
    if dialect == Dialect::Codesys {
        list = with_semicolons(&list);
    }
    Tokens {
        file,
        text,
        list,
        no_name,
        dialect,
    }
}

/// CODESYS needs no semicolon behind the end of a block.
fn with_semicolons(list: &[Token]) -> Vec<Token> {
    let mut made = Vec::with_capacity(list.len());
    for (index, &token) in list.iter().enumerate() {
        made.push(token);
        let mut behind = list[index + 1..].iter().map(|next| next.kind);
        if token.kind.ends_block() && behind.find(|kind| !kind.is_trivia()) != Some(Kind::Semicolon)
        {
            made.push(Token {
                kind: Kind::Semicolon,
                start: token.end,
                ..token
            });
        }
    }
    made
}

impl Tokens<'_> {
    /// The text of a token.
    pub fn slice(&self, token: Token) -> &str {
        &self.text[token.start as usize..token.end as usize]
    }
}

fn byte_order_mark(text: &str) -> usize {
    if text.starts_with('\u{feff}') { 3 } else { 0 }
}

/// How often a nested comment without end is searched to the end of the file. Each such search
/// is linear, so the number keeps the whole linear.
const NESTED_SEARCHES: u32 = 16;

/// What logos tells apart. What has an end of its own (comments, strings, pragmas) is found by its
/// beginning.
#[derive(Logos, Debug, Clone, Copy, PartialEq, Eq)]
#[logos(skip r"[ \t\r\n\x0b\x0c]+")]
enum Raw {
    #[regex(r"[A-Za-z_][A-Za-z0-9_]*")]
    Word,
    // Letters, and all that is not known to be something else.
    #[regex(
        r"[A-Za-z_\u{aa}\u{b5}\u{ba}\u{c0}-\u{d6}\u{d8}-\u{f6}\u{f8}-\u{1fff}\u{2070}-\u{218f}\u{2300}-\u{2fff}\u{3003}-\u{fefe}\u{ff00}-\u{10ffff}][A-Za-z0-9_\u{aa}\u{b5}\u{ba}\u{c0}-\u{d6}\u{d8}-\u{f6}\u{f8}-\u{1fff}\u{2070}-\u{218f}\u{2300}-\u{2fff}\u{3003}-\u{fefe}\u{ff00}-\u{10ffff}]*",
        priority = 1
    )]
    ForeignWord,
    // Spaces, quotation marks, dashes, signs of mathematics.
    #[regex(
        r"[\u{80}-\u{a9}\u{ab}-\u{b4}\u{b6}-\u{b9}\u{bb}-\u{bf}\u{d7}\u{f7}\u{2000}-\u{206f}\u{2190}-\u{22ff}\u{3000}-\u{3002}\u{feff}]"
    )]
    ForeignSign,
    #[regex(r"[0-9][0-9_]*")]
    Int,
    #[regex(r"[0-9][0-9_]*#[0-9A-Za-z_]*")]
    Based,
    #[regex(r"[0-9][0-9_]*\.[0-9][0-9_]*([eE][+-]?[0-9_]+)?")]
    #[regex(r"[0-9][0-9_]*[eE][+-]?[0-9_]+", priority = 20)]
    Real,
    #[regex(r"[0-9][0-9_]*[A-Za-z][A-Za-z0-9_]*", priority = 10)]
    BadNumber,
    #[regex(r"%[A-Za-z0-9]*(\.[0-9]+)*\*?")]
    Direct,
    #[token("'")]
    Quote,
    #[token("\"")]
    DoubleQuote,
    #[token("{")]
    Brace,
    #[token("(*")]
    RoundComment,
    #[token("/*")]
    SlashComment,
    #[regex(r"//[^\n]*", allow_greedy = true)]
    LineComment,
    #[token("*)")]
    #[token("*/")]
    StrayEnd,
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
    #[token(":")]
    Colon,
    #[token(":=")]
    Assign,
    #[token("?=")]
    AttemptAssign,
    #[token("=>")]
    Arrow,
    #[token(".")]
    Dot,
    #[token("..")]
    DotDot,
    #[token("^")]
    Caret,
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
    #[token("&")]
    Ampersand,
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
}

struct StLexer<'t, 'n> {
    raw: Lexer<'t, Raw>,
    keywords: Keywords,
    names: &'n mut Names,
    no_name: Symbol,
    list: Vec<Token>,
    /// Indices of words that are keywords only among certain others, with what they then are.
    soft: Vec<(u32, Kind)>,
    nested_without_end: u32,
}

impl StLexer<'_, '_> {
    fn run(&mut self) {
        while let Some(raw) = self.raw.next() {
            let start = self.raw.span().start;
            let kind = self.kind(raw);
            let (kind, symbol) = match kind {
                Kind::Int if self.ends_with_point() => {
                    self.raw.bump(1);
                    (Kind::BadNumber, self.no_name)
                }
                Kind::Word => self.word(),
                Kind::ForeignWord => (kind, self.names.intern(self.raw.slice())),
                other => (other, self.no_name),
            };
            self.list.push(Token {
                kind,
                symbol,
                start: start as u32,
                end: self.raw.span().end as u32,
            });
        }
    }

    fn kind(&mut self, raw: Result<Raw, ()>) -> Kind {
        let Ok(raw) = raw else {
            return Kind::Unknown;
        };
        match raw {
            Raw::Word => Kind::Word,
            Raw::ForeignWord => Kind::ForeignWord,
            Raw::Int => Kind::Int,
            Raw::Based => Kind::Based,
            Raw::Real => Kind::Real,
            Raw::BadNumber => Kind::BadNumber,
            Raw::Direct => Kind::Direct,
            Raw::Quote => self.string(b'\''),
            Raw::DoubleQuote => self.string(b'"'),
            Raw::Brace => self.pragma(),
            Raw::RoundComment => self.comment(*b"(*", *b"*)"),
            Raw::SlashComment => self.comment(*b"/*", *b"*/"),
            Raw::LineComment => Kind::Comment,
            Raw::StrayEnd | Raw::ForeignSign => Kind::Unknown,
            Raw::OpenParen => Kind::OpenParen,
            Raw::CloseParen => Kind::CloseParen,
            Raw::OpenBracket => Kind::OpenBracket,
            Raw::CloseBracket => Kind::CloseBracket,
            Raw::Comma => Kind::Comma,
            Raw::Semicolon => Kind::Semicolon,
            Raw::Colon => Kind::Colon,
            Raw::Assign => Kind::Assign,
            Raw::AttemptAssign => Kind::AttemptAssign,
            Raw::Arrow => Kind::Arrow,
            Raw::Dot => Kind::Dot,
            Raw::DotDot => Kind::DotDot,
            Raw::Caret => Kind::Caret,
            Raw::Plus => Kind::Plus,
            Raw::Minus => Kind::Minus,
            Raw::Star => Kind::Star,
            Raw::Slash => Kind::Slash,
            Raw::StarStar => Kind::StarStar,
            Raw::Ampersand => Kind::Ampersand,
            Raw::Equal => Kind::Equal,
            Raw::NotEqual => Kind::NotEqual,
            Raw::Less => Kind::Less,
            Raw::LessEqual => Kind::LessEqual,
            Raw::Greater => Kind::Greater,
            Raw::GreaterEqual => Kind::GreaterEqual,
        }
    }

    /// Whether a number ends with its decimal point: `1.`, but neither `1..2` nor the part `w.1`.
    fn ends_with_point(&self) -> bool {
        let mut rest = self.raw.remainder().bytes();
        let point = rest.next() == Some(b'.');
        let behind = rest.next();
        let goes_on = |byte: u8| matches!(byte, b'.' | b'%' | b'_') || byte.is_ascii_alphanumeric();
        let part = self.list.last().is_some_and(|last| last.kind == Kind::Dot);
        point && !part && !behind.is_some_and(goes_on)
    }

    /// A word, keyword, type prefix, or literal that begins with a word.
    fn word(&mut self) -> (Kind, Symbol) {
        if self.raw.remainder().starts_with('#') {
            return self.prefixed();
        }
        let symbol = self.names.intern(self.raw.slice());
        // Right behind a dot stands the name of a member, whatever it is.
        let start = self.raw.span().start as u32;
        let last = self.list.last();
        if last.is_some_and(|last| last.kind == Kind::Dot && last.end == start) {
            return (Kind::Word, symbol);
        }
        let Some((keyword, soft)) = self.keywords.get(symbol) else {
            return (Kind::Word, symbol);
        };
        if soft || keyword == Kind::Ref {
            self.soft.push((self.list.len() as u32, keyword));
        }
        let kind = if soft { Kind::Word } else { keyword };
        (kind, symbol)
    }

    /// A word with `#` behind it.
    fn prefixed(&mut self) -> (Kind, Symbol) {
        let word = self.raw.slice();
        if let Some(time) = TimeKind::of_prefix(word) {
            return (self.time(time.shape()), self.no_name);
        }
        let symbol = self.names.intern(word);
        self.raw.bump(1);
        (Kind::TypePrefix, symbol)
    }

    /// The rest of a literal of a time. `:`, `-` and `.` belong to it before digits only:
    /// `TOD#12:00:` is a label, `T#1s..T#2s` a range.
    fn time(&mut self, shape: TimeShape) -> Kind {
        let rest = self.raw.remainder().as_bytes();
        let signs: &[u8] = match shape {
            TimeShape::Duration => b".",
            TimeShape::Date => b"-",
            TimeShape::Clock => b":.",
            TimeShape::DateAndClock => b"-:.",
        };
        let mut length = 1;
        if shape == TimeShape::Duration && matches!(rest.get(1), Some(b'+' | b'-')) {
            length += 1;
        }
        while let Some(byte) = rest.get(length) {
            let digit_follows = rest.get(length + 1).is_some_and(u8::is_ascii_digit);
            let belongs = byte.is_ascii_alphanumeric()
                || *byte == b'_'
                || signs.contains(byte) && digit_follows;
            if !belongs {
                break;
            }
            length += 1;
        }
        self.raw.bump(length);
        Kind::Time
    }

    fn string(&mut self, quote: u8) -> Kind {
        let rest = self.raw.remainder().as_bytes();
        let mut at = 0;
        while let Some(&byte) = rest.get(at) {
            match byte {
                b'\n' | b'\r' => break,
                b'$' if !matches!(rest.get(at + 1), None | Some(b'\n' | b'\r')) => at += 1,
                byte if byte == quote => {
                    self.raw.bump(at + 1);
                    return Kind::String;
                }
                _ => {}
            }
            at += 1;
        }
        let line = rest.iter().take_while(|b| !b"\r\n".contains(b)).count();
        self.raw.bump(open_string_length(&rest[..line]));
        Kind::OpenString
    }

    fn pragma(&mut self) -> Kind {
        let rest = self.raw.remainder();
        let close = if rest.starts_with('{') { "}}" } else { "}" };
        if let Some(at) = rest.find(close) {
            self.raw.bump(at + close.len());
            return Kind::Pragma;
        }
        self.raw.bump(rest.find('\n').unwrap_or(rest.len()));
        Kind::OpenPragma
    }

    /// The rest of a block comment.
    fn comment(&mut self, open: [u8; 2], close: [u8; 2]) -> Kind {
        let rest = self.raw.remainder().as_bytes();
        if self.nested_without_end < NESTED_SEARCHES {
            if let Some(end) = nested_end(rest, open, close) {
                self.raw.bump(end);
                return Kind::Comment;
            }
            self.nested_without_end += 1;
        }
        let flat = rest.windows(2).position(|two| two == close);
        self.raw.bump(flat.map_or(rest.len(), |at| at + 2));
        Kind::OpenComment
    }
}

/// Where a comment ends, behind its opener, if comments in it end as well.
fn nested_end(rest: &[u8], open: [u8; 2], close: [u8; 2]) -> Option<usize> {
    let mut depth = 1;
    let mut at = 0;
    while at + 1 < rest.len() {
        let two = [rest[at], rest[at + 1]];
        if two == close {
            depth -= 1;
            if depth == 0 {
                return Some(at + 2);
            }
        }
        depth += usize::from(two == open);
        at += if two == open || two == close { 2 } else { 1 };
    }
    None
}

/// A string without end probably ends before the signs that end the statement.
fn open_string_length(line: &[u8]) -> usize {
    let code = line.windows(2).position(|two| two == b"//" || two == b"(*");
    let line = &line[..code.unwrap_or(line.len())];
    line.iter()
        .rposition(|byte| !b" \t;)".contains(byte))
        .map_or(0, |last| last + 1)
}
