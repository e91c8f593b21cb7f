//! Literals in one spelling for each value.

use super::super::time::time_text;
use super::super::{Id, IntLiteral, Literal, StringLiteral};
use super::Printer;
use crate::rung::Radix;

impl Printer<'_> {
    pub(super) fn literal(&mut self, literal: Id<Literal>) {
        let text = literal_text(&self.arena[literal]);
        self.write(&text);
    }
}

fn literal_text(literal: &Literal) -> String {
    match literal {
        Literal::Bool(true) => "TRUE".to_owned(),
        Literal::Bool(false) => "FALSE".to_owned(),
        Literal::Int(int) => int_text(*int),
        Literal::Real { negative, digits } => format!("{}{}", sign(*negative), digits.0),
        Literal::String(string) => string_text(string),
        Literal::Time(time) => time_text(*time),
    }
}

fn sign(negative: bool) -> &'static str {
    if negative { "-" } else { "" }
}

fn int_text(int: IntLiteral) -> String {
    let sign = sign(int.negative);
    match int.radix {
        Radix::Binary => format!("{sign}2#{:b}", int.value),
        Radix::Octal => format!("{sign}8#{:o}", int.value),
        Radix::Decimal => format!("{sign}{}", int.value),
        Radix::Hexadecimal => format!("{sign}16#{:X}", int.value),
    }
}

/// A string as a literal, with its quotes.
pub fn string_text(string: &StringLiteral) -> String {
    let quote = if string.double { '"' } else { '\'' };
    let mut text = String::from(quote);
    for unit in char::decode_utf16(string.units.iter().copied()) {
        match unit {
            Ok(c) if c == '$' || c == quote => text.extend(['$', c]),
            Ok(c) if !c.is_control() => text.push(c),
            Ok(c) if string.double => text.push_str(&format!("${:04X}", u32::from(c))),
            Ok(c) => text.push_str(&format!("${:02X}", u32::from(c))),
            Err(lone) => text.push_str(&format!("${:04X}", lone.unpaired_surrogate())),
        }
    }
    text.push(quote);
    text
}
