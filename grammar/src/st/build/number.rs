//! Numbers with the value they have, of any size and base; digits that are none get a message.

use super::Build;
use crate::st::Dialect;
use iecc_ast::rung::Radix;
use iecc_ast::st::{Expr, ExprKind, Id, IntLiteral, Literal};
use iecc_ast::{RealText, underlines_are_between_digits};
use iecc_diag::{Code, Diagnostic};

impl Build<'_, '_> {
    pub(crate) fn int(&mut self, start: u32, end: u32) -> Id<Expr> {
        self.integer(start, Radix::Decimal, self.text(start, end), end)
    }

    /// `16#FF`.
    pub(crate) fn based(&mut self, start: u32, end: u32) -> Id<Expr> {
        let (base, digits) = self
            .text(start, end)
            .split_once('#')
            .expect("the token has a number sign");
        let radix = match base {
            "2" => Radix::Binary,
            "8" => Radix::Octal,
            "16" => Radix::Hexadecimal,
            _ => {
                let message = format!("there are no numbers of base {base}");
                self.bad_number(start, message, "the base is 2, 8 or 16", end);
                return self.expr(start, ExprKind::Error, end);
            }
        };
        self.integer(start, radix, digits, end)
    }

    fn integer(&mut self, start: u32, radix: Radix, digits: &str, end: u32) -> Id<Expr> {
        let base = base(radix);
        let value = match value(digits, base) {
            Ok(value) => value,
            Err(wrong) => {
                self.wrong_digits(wrong, base, start, end);
                return self.expr(start, ExprKind::Error, end);
            }
        };
        let int = IntLiteral {
            value,
            negative: false,
            radix,
        };
        self.literal(start, Literal::Int(int), end)
    }

    fn wrong_digits(&mut self, wrong: WrongDigits, base: u32, start: u32, end: u32) {
        let note = "digits may have single underlines between them";
        match wrong {
            WrongDigits::Underline => {
                let text = self.text(start, end);
                let message = match text.ends_with('#') {
                    true => format!("`{text}` has no digits"),
                    false => format!("`{text}` has an underline that is not between digits"),
                };
                self.bad_number(start, message, note, end);
            }
            WrongDigits::NoDigit(c) => {
                let message = format!("`{c}` is not a digit of base {base}");
                self.bad_number(start, message, note, end);
            }
            WrongDigits::TooLarge => {
                let message = format!("the number `{}` is too large", self.text(start, end));
                let diagnostic = Diagnostic::new(Code::E0020, self.span(start, end), message)
                    .note("the largest integer types have 64 bits");
                self.report(diagnostic);
            }
        }
    }

    /// `1.5`, `1.5E-3`; `1E5` gets a message, but in CODESYS.
    pub(crate) fn real(&mut self, start: u32, end: u32) -> Id<Expr> {
        let text = self.text(start, end);
        if !text.contains('.') && self.tokens.dialect != Dialect::Codesys {
            self.no_fraction(text, start, end);
        } else if !underlines_are_between_digits(text) {
            self.wrong_digits(WrongDigits::Underline, 10, start, end);
        }
        let literal = Literal::Real {
            negative: false,
            digits: RealText(text.replace('_', "")),
        };
        self.literal(start, literal, end)
    }

    fn no_fraction(&mut self, text: &str, start: u32, end: u32) {
        let at = text.find(['e', 'E']).unwrap_or(text.len());
        let mended = format!("{}.0{}", &text[..at], &text[at..]);
        let span = self.span(start, end);
        let diagnostic = Diagnostic::new(
            Code::E0019,
            span,
            format!("`{text}` has no decimal point"),
        )
        .label(format!("expected `{mended}`"))
        .note("a real number has digits on both sides of a decimal point, also before an exponent")
        .fix(format!("write `{mended}`"), span, mended);
        self.report(diagnostic);
    }

    fn bad_number(&mut self, start: u32, message: impl Into<String>, note: &str, end: u32) {
        let diagnostic = Diagnostic::new(Code::E0019, self.span(start, end), message).note(note);
        self.report(diagnostic);
    }
}

/// What is wrong with the digits of a number.
#[derive(Clone, Copy)]
enum WrongDigits {
    Underline,
    NoDigit(char),
    TooLarge,
}

fn value(digits: &str, base: u32) -> Result<u64, WrongDigits> {
    let mut value: u64 = 0;
    for c in digits.chars().filter(|&c| c != '_') {
        let digit = c.to_digit(base).ok_or(WrongDigits::NoDigit(c))?;
        value = value
            .checked_mul(u64::from(base))
            .and_then(|value| value.checked_add(u64::from(digit)))
            .ok_or(WrongDigits::TooLarge)?;
    }
    if underlines_are_between_digits(digits) {
        Ok(value)
    } else {
        Err(WrongDigits::Underline)
    }
}

fn base(radix: Radix) -> u32 {
    match radix {
        Radix::Binary => 2,
        Radix::Octal => 8,
        Radix::Decimal => 10,
        Radix::Hexadecimal => 16,
    }
}
