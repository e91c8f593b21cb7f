//! Signs and words of other languages and of word processors. Whoever writes `==`, `!=`, `x++`, ELSEIF
//! or a quotation mark of a letter means something that there is a sign for here: the message names it,
//! and the rest of the unit is read as if it had been written.
//!
//! Characters that mean nothing are seen by the feed. What is made of signs that mean something for
//! themselves is looked for only where a unit does not parse, so nothing that is right is touched.

use super::feed::{Feed, Located};
use super::lexer::Tokens;
use super::token::{Kind, Token};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::Span;

/// What a character outside ASCII stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sign {
    /// White space, or nothing visible.
    Space,
    /// A quotation mark.
    Quote,
    /// An operator: what it is, how it is written here.
    Operator(Kind, &'static str),
    /// Nothing.
    Nothing,
}

/// What a character outside ASCII that is no letter stands for.
pub(crate) fn sign(character: char) -> Sign {
    match character {
        '\u{80}'..='\u{a0}'
        | '\u{ad}'
        | '\u{2000}'..='\u{200f}'
        | '\u{2028}'..='\u{202f}'
        | '\u{205f}'..='\u{206f}'
        | '\u{3000}'
        | '\u{feff}' => Sign::Space,
        '«' | '»' | '´' | '‘'..='‟' | '‹' | '›' => Sign::Quote,
        '‐'..='―' | '−' => Sign::Operator(Kind::Minus, "-"),
        '≤' => Sign::Operator(Kind::LessEqual, "<="),
        '≥' => Sign::Operator(Kind::GreaterEqual, ">="),
        '≠' => Sign::Operator(Kind::NotEqual, "<>"),
        '×' | '·' | '∙' => Sign::Operator(Kind::Star, "*"),
        '÷' | '∕' => Sign::Operator(Kind::Slash, "/"),
        _ => Sign::Nothing,
    }
}

/// What an ASCII character that means nothing here is elsewhere, and what is written instead.
pub(crate) fn elsewhere(text: &str) -> Option<(usize, &'static str, Option<&'static str>)> {
    let known = [
        ("!=", "`<>` asks whether values differ", Some("<>")),
        ("!", "NOT turns a condition around", Some("NOT ")),
        ("||", "OR asks for either of two conditions", Some("OR")),
        ("|", "OR joins bits", Some("OR")),
        ("~", "NOT turns bits around", Some("NOT ")),
        (
            "?",
            "SEL(condition, if_false, if_true) chooses between two values",
            None,
        ),
        (
            "\\",
            "in a string `$` begins a character that is written otherwise: `$N` ends a line",
            None,
        ),
    ];
    let known = known.iter().find(|(sign, ..)| text.starts_with(sign));
    known.map(|(sign, note, instead)| (sign.len(), *note, *instead))
}

/// How a number of another language is written here: `0xFF`, `0b11`, `5s`, `1.5f`.
pub(crate) fn number(text: &str) -> Option<String> {
    let digits_of = |radix: u32| {
        let digits = text.get(2..).filter(|digits| !digits.is_empty())?;
        let fits = digits.chars().all(|c| c == '_' || c.is_digit(radix));
        fits.then(|| format!("{radix}#{digits}"))
    };
    match text.get(..2) {
        Some("0x" | "0X") => return digits_of(16),
        Some("0b" | "0B") => return digits_of(2),
        Some("0o" | "0O") => return digits_of(8),
        Some(_) | None => {}
    }
    let unit = text.trim_start_matches(|c: char| c.is_ascii_digit() || c == '_');
    let units = ["d", "h", "m", "s", "ms", "us", "ns"];
    let known = units.into_iter().any(|one| unit.eq_ignore_ascii_case(one));
    known.then(|| format!("T#{text}"))
}

/// Reads the signs and words of other languages as those of this one.
pub(crate) fn translated(tokens: &Tokens<'_>, feed: &Feed, found: &mut Diagnostics) -> Feed {
    let mut translator = Translator {
        tokens,
        list: &feed.tokens,
        at: 0,
        out: Vec::with_capacity(feed.tokens.len()),
        found,
    };
    while translator.at < feed.tokens.len() {
        translator.step();
    }
    Feed {
        tokens: translator.out,
        pragmas: Vec::new(),
        holes: feed.holes.clone(),
        cut: feed.cut,
    }
}

struct Translator<'r, 't> {
    tokens: &'r Tokens<'t>,
    list: &'r [Located],
    at: usize,
    out: Vec<Located>,
    found: &'r mut Diagnostics,
}

impl Translator<'_, '_> {
    fn step(&mut self) {
        let token = self.list[self.at];
        let done = match token.1.kind {
            Kind::Equal => self.doubled(Kind::Equal, "values are compared with `=`", "="),
            Kind::Ampersand => self.doubled(
                Kind::Ampersand,
                "AND asks for both of two conditions",
                "AND",
            ),
            Kind::Plus | Kind::Minus => self.counting() || self.computing(),
            Kind::Star | Kind::Slash => self.computing(),
            Kind::Direct => self.remainder(),
            Kind::Word => self.word(),
            _ => false,
        };
        if !done {
            self.out.push(token);
            self.at += 1;
        }
    }

    /// The token some places ahead, and whether nothing stands between it and the one before it.
    fn ahead(&self, distance: usize) -> Option<Located> {
        self.list.get(self.at + distance).copied()
    }

    fn kind_ahead(&self, distance: usize) -> Option<Kind> {
        self.ahead(distance).map(|token| token.1.kind)
    }

    /// Whether a token of this kind stands right behind the present one.
    fn touches(&self, kind: Kind) -> bool {
        let end = self.list[self.at].2;
        let next = self.ahead(1);
        next.is_some_and(|(start, token, _)| start == end && token.kind == kind)
    }

    fn text(&self, start: u32, end: u32) -> &str {
        &self.tokens.text[start as usize..end as usize]
    }

    /// Reads some tokens as one, with a message.
    fn replace(&mut self, count: usize, kind: Kind, note: &str, instead: Option<&str>) {
        let (start, token, _) = self.list[self.at];
        let end = self.list[self.at + count - 1].2;
        let span = Span::new(self.tokens.file, start, end);
        let message = format!("`{}` has no meaning here", self.text(start, end));
        let mut diagnostic = Diagnostic::new(Code::E0010, span, message).note(note);
        if let Some(instead) = instead {
            diagnostic = diagnostic.label(format!("expected `{instead}`")).fix(
                format!("write `{instead}`"),
                span,
                instead,
            );
        }
        self.found.push(diagnostic);
        self.push(kind, token, start, end);
        self.at += count;
    }

    fn push(&mut self, kind: Kind, like: Token, start: u32, end: u32) {
        let token = Token {
            kind,
            start,
            end,
            ..like
        };
        self.out.push((start, token, end));
    }

    /// `==`, `&&`.
    fn doubled(&mut self, kind: Kind, note: &str, instead: &str) -> bool {
        let doubled = self.touches(kind);
        if doubled {
            self.replace(2, kind, note, Some(instead));
        }
        doubled
    }

    /// `x++;`
    fn counting(&mut self) -> bool {
        let (_, token, _) = self.list[self.at];
        if !self.touches(token.kind) || self.kind_ahead(2) != Some(Kind::Semicolon) {
            return false;
        }
        let sign = if token.kind == Kind::Plus { '+' } else { '-' };
        let note = match self.variable_before() {
            Some(name) => format!("write `{name} := {name} {sign} 1`"),
            None => format!("write `x := x {sign} 1`"),
        };
        let end = self.list[self.at + 1].2;
        self.replace(2, Kind::Assign, &note, None);
        self.push(Kind::BadNumber, token, end, end);
        true
    }

    /// `x += 1;`
    fn computing(&mut self) -> bool {
        if !self.touches(Kind::Equal) {
            return false;
        }
        let (start, _, end) = self.list[self.at];
        let sign = self.text(start, end).to_owned();
        let note = match self.variable_before() {
            Some(name) => format!("write `{name} := {name} {sign} …`"),
            None => format!("write `x := x {sign} …`"),
        };
        self.replace(2, Kind::Assign, &note, None);
        true
    }

    /// The plain name before the present token, if nothing else belongs to it.
    fn variable_before(&self) -> Option<String> {
        let (name, before) = (*self.out.last()?, self.out.len().checked_sub(2));
        let part = before.is_some_and(|at| self.out[at].1.kind == Kind::Dot);
        let plain = name.1.kind == Kind::Word && !part;
        plain.then(|| self.text(name.0, name.2).to_owned())
    }

    /// `y % 2`, `y %2`.
    fn remainder(&mut self) -> bool {
        let (start, token, end) = self.list[self.at];
        let behind_operand = self
            .out
            .last()
            .is_some_and(|last| last.1.kind.ends_operand());
        let digits = &self.text(start, end)[1..];
        if !behind_operand || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return false;
        }
        let (number, sign_end) = (!digits.is_empty(), start + 1);
        let span = Span::new(self.tokens.file, start, sign_end);
        let diagnostic = Diagnostic::new(Code::E0010, span, "`%` is no operator here")
            .label("expected MOD")
            .fix("write MOD", span, " MOD ");
        self.found.push(diagnostic);
        self.push(Kind::Mod, token, start, sign_end);
        if number {
            self.push(Kind::Int, token, sign_end, end);
        }
        self.at += 1;
        true
    }

    /// ELSIF as other languages spell it.
    fn word(&mut self) -> bool {
        let (start, token, end) = self.list[self.at];
        let text = self.text(start, end).to_owned();
        let spelled = ["ELSEIF", "ELSE_IF", "ELIF"];
        let known = spelled.iter().any(|word| word.eq_ignore_ascii_case(&text));
        if !known || !self.leads_to_then() {
            return false;
        }
        let span = Span::new(self.tokens.file, start, end);
        let message = format!("found `{text}`, expected ELSIF");
        let diagnostic = Diagnostic::new(Code::E0037, span, message)
            .label("expected ELSIF")
            .fix("write ELSIF", span, "ELSIF");
        self.found.push(diagnostic);
        self.push(Kind::Elsif, token, start, end);
        self.at += 1;
        true
    }

    /// Whether THEN stands before the next semicolon.
    fn leads_to_then(&self) -> bool {
        const LONGEST: usize = 256;
        let ahead = self.list[self.at..].iter().take(LONGEST);
        let mut kinds = ahead.map(|token| token.1.kind);
        let end = kinds.find(|kind| matches!(kind, Kind::Semicolon | Kind::Then | Kind::Assign));
        self.begins_line() && end == Some(Kind::Then)
    }

    fn begins_line(&self) -> bool {
        begins_line(self.tokens.text, self.list[self.at].0)
    }
}

/// Whether nothing but white space stands before a byte on its line.
pub(crate) fn begins_line(text: &str, at: u32) -> bool {
    let before = text[..at as usize].trim_end_matches([' ', '\t']);
    before.is_empty() || before.ends_with('\n')
}
