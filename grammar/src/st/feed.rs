//! What the parser gets to see of a fragment: its tokens without comments and pragmas, and with
//! the damage of single tokens reported and mended.

use super::foreign::{self, Sign};
use super::lexer::Tokens;
use super::slice::Fragment;
use super::token::{Kind, Token};
use iecc_ast::Symbol;
use iecc_ast::st::Pragma;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{Span, TextRange};
use std::collections::BTreeSet;

/// A token between its first byte and the one behind its last, as the parser wants it.
pub(crate) type Located = (u32, Token, u32);

/// The tokens of a unit.
pub(crate) struct Feed {
    pub(crate) tokens: Vec<Located>,
    pub(crate) pragmas: Vec<Pragma>,
    /// Where tokens begin that stand behind something left out, in order.
    pub(crate) holes: Vec<u32>,
    /// Whether a comment without end has taken the end of the unit.
    pub(crate) cut: bool,
}

/// Makes the tokens of a fragment fit for the parser.
pub(crate) fn feed(
    tokens: &Tokens<'_>,
    fragment: &Fragment,
    diagnostics: &mut Diagnostics,
) -> Feed {
    let list = &tokens.list[fragment.tokens.clone()];
    let mut feeder = Feeder {
        tokens,
        base: fragment.start,
        diagnostics,
        hole: false,
        tries: false,
        catches: false,
        misspelt: BTreeSet::new(),
        spaces: BTreeSet::new(),
        skip_to: 0,
        feed: Feed {
            tokens: Vec::with_capacity(list.len()),
            pragmas: Vec::new(),
            holes: Vec::new(),
            cut: false,
        },
    };
    list.iter().for_each(|&token| feeder.take(token));
    feeder.feed
}

struct Feeder<'f, 't> {
    tokens: &'f Tokens<'t>,
    base: u32,
    diagnostics: &'f mut Diagnostics,
    /// Whether something was left out before the next token.
    hole: bool,
    /// Whether a message about exceptions has been given.
    tries: bool,
    /// Whether what follows belongs to `__CATCH`.
    catches: bool,
    /// Names that a message was given for.
    misspelt: BTreeSet<Symbol>,
    /// Characters that look like white space, and that a message was given for.
    spaces: BTreeSet<char>,
    /// Up to where tokens are left out.
    skip_to: u32,
    feed: Feed,
}

impl Feeder<'_, '_> {
    fn take(&mut self, mut token: Token) {
        if token.start < self.skip_to || self.is_of_exception(token) {
            return;
        }
        match token.kind {
            Kind::Comment | Kind::Merged => return,
            Kind::Pragma => return self.pragma(token),
            Kind::OpenComment => return self.open_comment(token),
            Kind::OpenPragma => return self.open_pragma(token),
            Kind::Unknown => return self.unknown(token),
            Kind::OpenString => {
                self.open_string(token);
                token.kind = Kind::String;
            }
            Kind::ForeignWord => {
                self.foreign_word(token);
                token.kind = Kind::Word;
            }
            Kind::BadNumber => self.bad_number(token),
            Kind::Word => self.word(token),
            _ => {}
        }
        self.push(token);
    }

    fn push(&mut self, token: Token) {
        if std::mem::take(&mut self.hole) {
            self.feed.holes.push(token.start);
        }
        self.feed.tokens.push((token.start, token, token.end));
    }

    fn report(&mut self, code: Code, token: Token, message: impl Into<String>) -> &mut Self {
        let diagnostic = Diagnostic::new(code, self.span(token.start, token.end), message);
        self.diagnostics.push(diagnostic);
        self
    }

    fn span(&self, start: u32, end: u32) -> Span {
        Span::new(self.tokens.file, start, end)
    }

    fn pragma(&mut self, token: Token) {
        let text = self.tokens.slice(token);
        self.feed.pragmas.push(Pragma {
            text: text[1..text.len() - 1].into(),
            range: TextRange::new(token.start - self.base, token.end - self.base),
        });
    }

    fn open_comment(&mut self, token: Token) {
        let text = self.tokens.slice(token);
        let (open, close) = if text.starts_with("(*") {
            ("(*", "*)")
        } else {
            ("/*", "*/")
        };
        let opener = self.span(token.start, token.start + 2);
        let diagnostic = Diagnostic::new(Code::E0016, opener, "the comment is not closed");
        let inner = text[2..].find(open).filter(|_| text.ends_with(close));
        let diagnostic = match inner {
            Some(at) => {
                let at = token.start + 2 + at as u32;
                diagnostic
                    .label(format!(
                        "each comment in a comment needs a `{close}` of its own"
                    ))
                    .also(
                        self.span(at, at + 2),
                        "this begins a comment in the comment",
                    )
            }
            None => {
                self.feed.cut = true;
                diagnostic.label(format!("expected `{close}` before the end of the file"))
            }
        };
        self.diagnostics.push(diagnostic);
    }

    fn open_pragma(&mut self, token: Token) {
        let opener = self.span(token.start, token.start + 1);
        let diagnostic = Diagnostic::new(Code::E0016, opener, "the pragma is not closed")
            .label("expected `}`")
            .fix("close the pragma", self.span(token.end, token.end), "}");
        self.diagnostics.push(diagnostic);
    }

    /// What means nothing here. Bytes that stand together get one message.
    fn unknown(&mut self, token: Token) {
        let text = self.tokens.slice(token);
        match text.chars().next().map_or(Sign::Nothing, foreign::sign) {
            Sign::Space => return self.foreign_space(token),
            Sign::Quote => return self.foreign_quote(token),
            Sign::Operator(kind, instead) => return self.foreign_operator(token, kind, instead),
            Sign::Nothing => {}
        }
        if text == "#" && foreign::begins_line(self.tokens.text, token.start) {
            return self.foreign_comment(token);
        }
        self.hole = true;
        if let Some(last) = self.last_unknown()
            && last.end >= token.start
        {
            return;
        }
        let rest = &self.tokens.text[token.start as usize..];
        if let Some((length, note, instead)) = foreign::elsewhere(rest) {
            return self.sign_from_elsewhere(token, length, note, instead);
        }
        let shown = text.escape_debug().to_string();
        let message = match shown.as_str() {
            "*)" | "*/" => format!("`{shown}` ends a comment that was not begun"),
            _ => format!("`{shown}` has no meaning here"),
        };
        self.report(Code::E0014, token, message);
    }

    fn sign_from_elsewhere(
        &mut self,
        token: Token,
        length: usize,
        note: &str,
        instead: Option<&str>,
    ) {
        let end = token.start + length as u32;
        let span = self.span(token.start, end);
        let text = &self.tokens.text[token.start as usize..end as usize];
        let message = format!("`{text}` has no meaning here");
        let mut diagnostic = Diagnostic::new(Code::E0014, span, message).note(note);
        if let Some(instead) = instead {
            let name = instead.trim_end();
            diagnostic = diagnostic.label(format!("expected `{name}`")).fix(
                format!("write `{name}`"),
                span,
                instead,
            );
        }
        self.diagnostics.push(diagnostic);
    }

    /// Each such character gets one message, wherever else it stands.
    fn foreign_space(&mut self, token: Token) {
        let character = self.tokens.slice(token).chars().next().unwrap_or(' ');
        if !self.spaces.insert(character) {
            return;
        }
        let span = self.span(token.start, token.end);
        let code = u32::from(character);
        let message = format!("this looks like white space, but is the character U+{code:04X}");
        let diagnostic = Diagnostic::new(Code::E0014, span, message)
            .note("it comes with text from word processors and web pages, perhaps at more places")
            .fix("write a space", span, " ");
        self.diagnostics.push(diagnostic);
    }

    /// A string between quotation marks of a word processor, or such a mark.
    fn foreign_quote(&mut self, token: Token) {
        let text = self.tokens.slice(token);
        let rest = &self.tokens.text[token.end as usize..];
        let closes = |c: char| c == '\'' || c == '"' || foreign::sign(c) == Sign::Quote;
        let ends = |c: char| matches!(c, '\r' | '\n');
        let close = rest.char_indices().find(|(_, c)| closes(*c) || ends(*c));
        let close = close.filter(|(_, c)| closes(*c));
        let end = close.map_or(token.end, |(at, c)| token.end + (at + c.len_utf8()) as u32);
        let span = self.span(token.start, end);
        let message = format!("`{text}` is no quotation mark of a program");
        let mut diagnostic = Diagnostic::new(Code::E0014, span, message)
            .note("strings stand between `'` and `'`, wide strings between `\"` and `\"`");
        if let Some((at, _)) = close {
            let mended = format!("'{}'", &rest[..at]);
            diagnostic = diagnostic.fix(format!("write `{mended}`"), span, mended);
        }
        self.diagnostics.push(diagnostic);
        self.skip_to = end;
        self.push(Token {
            kind: Kind::BadNumber,
            end,
            ..token
        });
    }

    fn foreign_operator(&mut self, token: Token, kind: Kind, instead: &str) {
        let text = self.tokens.slice(token);
        let span = self.span(token.start, token.end);
        let diagnostic =
            Diagnostic::new(Code::E0014, span, format!("`{text}` is no operator here"))
                .label(format!("expected `{instead}`"))
                .fix(format!("write `{instead}`"), span, instead);
        self.diagnostics.push(diagnostic);
        self.push(Token { kind, ..token });
    }

    /// `# text`: the line is left out.
    fn foreign_comment(&mut self, token: Token) {
        let rest = &self.tokens.text[token.start as usize..];
        let line = rest.find('\n').unwrap_or(rest.len());
        self.skip_to = token.start + line as u32;
        let span = self.span(token.start, token.end);
        let diagnostic = Diagnostic::new(Code::E0014, span, "`#` begins no comment here")
            .label("expected `//`")
            .note("comments begin with `//`, or stand between `(*` and `*)`")
            .fix("write `//`", span, "//");
        self.diagnostics.push(diagnostic);
    }

    fn last_unknown(&self) -> Option<Span> {
        let last = self.diagnostics.iter().last()?;
        let primary = last.primary.as_ref().filter(|_| last.code == Code::E0014)?;
        Some(primary.span)
    }

    fn open_string(&mut self, token: Token) {
        let quote = &self.tokens.slice(token)[..1];
        let end = self.span(token.end, token.end);
        let diagnostic = Diagnostic::new(
            Code::E0015,
            self.span(token.start, token.end),
            "the string is not closed",
        )
        .label(format!("expected `{quote}` on the same line"))
        .note("a line end in a string is written `$N`, a quote `$'` or `$\"`")
        .fix("close the string", end, quote);
        self.diagnostics.push(diagnostic);
    }

    /// One message for each name.
    fn foreign_word(&mut self, token: Token) {
        if !self.misspelt.insert(token.symbol) {
            return;
        }
        let text = self.tokens.slice(token);
        let message = format!("the name `{text}` has letters outside ASCII");
        self.report(Code::E0017, token, message);
    }

    /// `__TRY`, `__CATCH(…)`, `__FINALLY` and `__ENDTRY` of CODESYS are left out, with one message.
    fn is_of_exception(&mut self, token: Token) -> bool {
        if std::mem::take(&mut self.catches) {
            self.catches = token.kind != Kind::CloseParen;
            return matches!(token.kind, Kind::OpenParen | Kind::Word | Kind::CloseParen);
        }
        if token.kind != Kind::Word {
            return false;
        }
        let text = self.tokens.slice(token);
        let is = |word: &str| text.eq_ignore_ascii_case(word);
        let words = ["__TRY", "__CATCH", "__FINALLY", "__ENDTRY"];
        if !words.into_iter().any(is) {
            return false;
        }
        self.catches = is("__CATCH");
        if is("__TRY") || !self.tries {
            let message = "exceptions are not compiled: a fault ends the scan";
            self.report(Code::E8002, token, message);
        }
        self.tries = true;
        true
    }

    /// Names that begin with two underlines are those of the standard library.
    fn word(&mut self, token: Token) {
        let text = self.tokens.slice(token);
        let inner = text.trim_start_matches('_');
        let misplaced = text.ends_with('_') || inner.contains("__");
        if !misplaced || !self.misspelt.insert(token.symbol) {
            return;
        }
        let message = format!("the name `{text}` has an underline at its end or beside another");
        self.report(Code::E0034, token, message);
    }

    fn bad_number(&mut self, token: Token) {
        let text = self.tokens.slice(token);
        if text.ends_with('.') {
            let span = self.span(token.start, token.end);
            let mended = format!("{text}0");
            let message = format!("`{text}` has no digits behind its decimal point");
            let diagnostic = Diagnostic::new(Code::E0019, span, message)
                .label(format!("expected `{mended}`"))
                .note("a real number has digits on both sides of a decimal point")
                .fix(format!("write `{mended}`"), span, mended);
            self.diagnostics.push(diagnostic);
            return;
        }
        let span = self.span(token.start, token.end);
        let message = format!("`{text}` is neither a number nor a name");
        let diagnostic = Diagnostic::new(Code::E0019, span, message);
        self.diagnostics.push(match foreign::number(text) {
            Some(mended) => diagnostic
                .label(format!("expected `{mended}`"))
                .fix(format!("write `{mended}`"), span, mended),
            None => diagnostic.note("names begin with a letter or an underline; numbers of another base are written like `16#1F`"),
        });
    }
}
