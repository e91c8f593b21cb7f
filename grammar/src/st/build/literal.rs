//! Literals but numbers and times: truth values, strings, and the signs before values.

use super::Build;
use iecc_ast::st::{Expr, ExprKind, Id, Literal, StringLiteral};
use iecc_diag::{Code, Diagnostic};

impl Build<'_, '_> {
    pub(super) fn literal(&mut self, start: u32, literal: Literal, end: u32) -> Id<Expr> {
        let literal = self.arena.add(literal);
        self.expr(start, ExprKind::Literal(literal), end)
    }

    pub(crate) fn bool(&mut self, start: u32, value: bool, end: u32) -> Id<Expr> {
        self.literal(start, Literal::Bool(value), end)
    }

    /// A sign between a type prefix and a number.
    pub(crate) fn signed(&mut self, start: u32, minus: bool, value: Id<Expr>) -> Id<Expr> {
        let sign = self.range(start, start);
        let node = &mut self.arena[value];
        node.range = sign.to(node.range);
        let (range, kind) = (node.range, node.kind);
        let ExprKind::Literal(literal) = kind else {
            return value;
        };
        match &mut self.arena[literal] {
            Literal::Int(int) => int.negative = minus,
            Literal::Real { negative, .. } => *negative = minus,
            Literal::Bool(_) | Literal::String(_) | Literal::Time(_) => {
                let span = self.span_of(range);
                let message = "a sign stands before a value that is no number";
                self.report(Diagnostic::new(Code::E0019, span, message));
            }
        }
        value
    }

    /// A string, of which the closing quote may be missing: a message for that has been given.
    pub(crate) fn string(&mut self, start: u32, end: u32) -> Id<Expr> {
        let text = self.text(start, end);
        let double = text.starts_with('"');
        let quote = if double { '"' } else { '\'' };
        let content = &text[1..];
        let content = content.strip_suffix(quote).unwrap_or(content);
        let mut units = Vec::with_capacity(content.len());
        let mut rest = content;
        while let Some(c) = rest.chars().next() {
            let length = match c {
                '$' => self.escape(rest, double, start + 1 + offset(content, rest), &mut units),
                _ => self.character(c, double, start + 1 + offset(content, rest), &mut units),
            };
            rest = &rest[length..];
        }
        let units = units.into_boxed_slice();
        self.literal(start, Literal::String(StringLiteral { units, double }), end)
    }

    fn character(&mut self, c: char, double: bool, at: u32, units: &mut Vec<u16>) -> usize {
        if double || u32::from(c) < 256 {
            units.extend(c.encode_utf16(&mut [0; 2]).iter());
        } else {
            let span = self.span(at, at + c.len_utf8() as u32);
            let message = format!("`{c}` does not fit one byte");
            let diagnostic = Diagnostic::new(Code::E0023, span, message)
                .note("characters of a STRING are those of Latin-1; a string between double quotes holds all");
            self.report(diagnostic);
        }
        c.len_utf8()
    }

    /// The escape at the start of `rest`; gives its length.
    fn escape(&mut self, rest: &str, double: bool, at: u32, units: &mut Vec<u16>) -> usize {
        if let Some((unit, length)) = escape(rest, double) {
            units.push(unit);
            return length;
        }
        let shown: String = rest.chars().take(2).collect();
        let span = self.span(at, at + shown.len() as u32);
        let digits = if double { "four" } else { "two" };
        let message = format!("`{shown}` is not an escape");
        let diagnostic = Diagnostic::new(Code::E0023, span, message)
            .label(format!(
                "expected `$$`, `$'`, `$\"`, `$L`, `$N`, `$P`, `$R`, `$T`, or `$` and {digits} hexadecimal digits"
            ))
            .fix("write `$$` for a dollar sign", self.span(at, at + 1), "$$");
        self.report(diagnostic);
        1
    }
}

/// How far a tail of a text is from its start.
fn offset(text: &str, tail: &str) -> u32 {
    (text.len() - tail.len()) as u32
}

/// The unit that an escape means, and its length. `$N` is a line feed here.
fn escape(text: &str, double: bool) -> Option<(u16, usize)> {
    let bytes = text.as_bytes();
    let unit = match bytes.get(1)?.to_ascii_uppercase() {
        quote @ (b'$' | b'\'' | b'"') => u16::from(quote),
        b'L' | b'N' => 0x0a,
        b'P' => 0x0c,
        b'R' => 0x0d,
        b'T' => 0x09,
        _ => return hexadecimal(bytes, if double { 4 } else { 2 }),
    };
    Some((unit, 2))
}

fn hexadecimal(bytes: &[u8], digits: usize) -> Option<(u16, usize)> {
    let mut unit = 0;
    for &byte in bytes.get(1..=digits)? {
        unit = unit << 4 | char::from(byte).to_digit(16)? as u16;
    }
    Some((unit, digits + 1))
}
