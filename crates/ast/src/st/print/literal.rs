//! Literals.

use super::super::calendar::{Date, NS_PER_DAY};
use super::super::{Id, IntLiteral, Literal, StringLiteral, TimeLiteral, TimeShape};
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

fn string_text(string: &StringLiteral) -> String {
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

fn time_text(time: TimeLiteral) -> String {
    let value = match time.kind.shape() {
        TimeShape::Duration => duration_text(time.ns),
        TimeShape::Date => date_text(time.ns),
        TimeShape::Clock => clock_text(time.ns),
        TimeShape::DateAndClock => {
            let (date, clock) = (
                date_text(time.ns),
                clock_text(time.ns.rem_euclid(NS_PER_DAY)),
            );
            format!("{date}-{clock}")
        }
    };
    format!("{}#{value}", time.kind.prefix())
}

fn duration_text(ns: i64) -> String {
    const UNITS: [(&str, u64); 7] = [
        ("d", 86_400_000_000_000),
        ("h", 3_600_000_000_000),
        ("m", 60_000_000_000),
        ("s", 1_000_000_000),
        ("ms", 1_000_000),
        ("us", 1_000),
        ("ns", 1),
    ];
    let mut text = sign(ns < 0).to_owned();
    let mut rest = ns.unsigned_abs();
    for (unit, size) in UNITS {
        if rest >= size {
            text.push_str(&format!("{}{unit}", rest / size));
            rest %= size;
        }
    }
    if ns == 0 {
        text.push_str("0s");
    }
    text
}

fn date_text(ns: i64) -> String {
    let Date { year, month, day } = Date::from_days_since_1970(ns.div_euclid(NS_PER_DAY));
    format!("{year:04}-{month:02}-{day:02}")
}

fn clock_text(ns: i64) -> String {
    let seconds = ns / 1_000_000_000;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    let fraction = format!("{:09}", ns % 1_000_000_000);
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    format!(
        "{hours:02}:{minutes:02}:{:02}{point}{fraction}",
        seconds % 60
    )
}
