//! Literals, many of them at the edge of their type.

use super::Generator;
use super::types::{Elementary, Kind, Type};

const REALS: [&str; 10] = [
    "0.0", "-0.0", "1.0", "-1.0", "0.5", "2.5", "-2.5", "1.5E-3", "3.0E30", "1.0E-40",
];
const DURATIONS: [&str; 9] = [
    "0s",
    "1ms",
    "10ms",
    "-5ms",
    "1s500ms",
    "1d2h3m4s5ms",
    "100us",
    "1.5s",
    "7ns",
];
const DATES: [&str; 4] = ["1970-01-01", "2024-02-29", "1999-12-31", "2100-03-01"];
const CLOCKS: [&str; 4] = ["00:00:00", "23:59:59.999", "12:30:15", "00:00:00.001"];
const TEXTS: [&str; 8] = ["", "a", "AB", "abc", "-12", "3.5", "$41$$ ", "TRUE"];

impl Generator<'_> {
    /// A literal of a type of one value, that says its type.
    pub(super) fn literal(&mut self, ty: Type) -> String {
        match ty {
            Type::Elementary(ty) => self.elementary_literal(ty),
            Type::Text { wide, length } => self.text_literal(wide, length),
            Type::Enumeration(at) => {
                let count = self.types.enumerations[at].values.len();
                let value = self.rng.below(count);
                if self.rng.one_in(2) {
                    self.types.enumerations[at].values[value].clone()
                } else {
                    self.types.enumerator(at, value)
                }
            }
            Type::Subrange(at) => {
                let range = &self.types.subranges[at];
                let (base, width) = (range.base, (range.high - range.low + 1) as usize);
                let number = range.low + self.rng.below(width) as i64;
                format!("{}#{number}", base.word())
            }
            Type::Reference(_) => "NULL".to_owned(),
            Type::Array(_) | Type::Open(_) | Type::Structure(_) | Type::Instance(_) => {
                unreachable!("there are no such literals")
            }
        }
    }

    fn elementary_literal(&mut self, ty: Elementary) -> String {
        let word = ty.word();
        match ty.kind() {
            Kind::Bool => self.rng.pick(&["TRUE", "FALSE", "BOOL#1"]).to_owned(),
            Kind::Signed | Kind::Unsigned => {
                let number = self.integer(ty);
                format!("{word}#{number}")
            }
            Kind::Bits => {
                let bits = self.bit_pattern(ty.bits());
                format!("{word}#16#{bits:X}")
            }
            Kind::Real => format!("{word}#{}", self.rng.pick(&REALS)),
            Kind::Duration => format!("{word}#{}", self.rng.pick(&DURATIONS)),
            Kind::Date => format!("{word}#{}", self.rng.pick(&DATES)),
            Kind::Clock => format!("{word}#{}", self.rng.pick(&CLOCKS)),
            Kind::Moment => {
                let (date, clock) = (self.rng.pick(&DATES), self.rng.pick(&CLOCKS));
                format!("{word}#{date}-{clock}")
            }
            Kind::Character => {
                let quote = if ty == Elementary::Char { '\'' } else { '"' };
                let character = self.rng.pick(&["a", "Z", "0", " ", "$$"]);
                format!("{word}#{quote}{character}{quote}")
            }
        }
    }

    /// A literal without its type, where the context gives it.
    pub(super) fn bare_literal(&mut self, ty: Elementary) -> String {
        match ty.kind() {
            Kind::Signed | Kind::Unsigned => self.integer(ty).to_string(),
            Kind::Real => self.rng.pick(&REALS).to_owned(),
            Kind::Bits => format!("16#{:X}", self.bit_pattern(ty.bits())),
            Kind::Bool
            | Kind::Duration
            | Kind::Date
            | Kind::Clock
            | Kind::Moment
            | Kind::Character => self.elementary_literal(ty),
        }
    }

    /// A number that is not 0.
    pub(super) fn divisor_literal(&mut self, ty: Elementary) -> String {
        if ty.is_real() {
            return format!(
                "{}#{}",
                ty.word(),
                self.rng.pick(&["2.0", "-0.5", "3.0", "1.0E30"])
            );
        }
        let signed = ty.kind() == Kind::Signed;
        let number = if signed && self.rng.one_in(3) {
            self.rng.pick(&[-1, -2, -7])
        } else {
            self.rng.pick(&[1, 2, 3, 8, 10, 100])
        };
        format!("{}#{number}", ty.word())
    }

    fn integer(&mut self, ty: Elementary) -> i128 {
        let bits = ty.bits();
        let (low, high) = if ty.kind() == Kind::Unsigned {
            (0, (1_i128 << bits) - 1)
        } else {
            (-(1_i128 << (bits - 1)), (1_i128 << (bits - 1)) - 1)
        };
        let number = match self.rng.below(6) {
            0 => low,
            1 => high,
            2 => high - 1,
            3 => self.rng.below(100) as i128,
            _ => self.rng.below(14) as i128 - 4,
        };
        number.clamp(low, high)
    }

    fn bit_pattern(&mut self, bits: u32) -> u64 {
        let mask = u64::MAX >> (64 - bits);
        let any = self.rng.next_u64();
        mask & match self.rng.below(5) {
            0 => u64::MAX,
            1 => 1 << (any % 64),
            2 => any,
            _ => any % 16,
        }
    }

    /// A text that is not longer than its type.
    fn text_literal(&mut self, wide: bool, length: u32) -> String {
        let fitting = |text: &&&str| text.chars().filter(|&c| c != '$').count() <= length as usize;
        let fitting: Vec<&str> = TEXTS.iter().filter(fitting).copied().collect();
        let text = self.rng.pick(&fitting);
        if wide {
            // The code of a wide character has four digits.
            format!("\"{}\"", text.replace("$41", "$0041"))
        } else {
            format!("'{text}'")
        }
    }

    /// The initial value of a variable, or nothing where its type needs none.
    pub(super) fn initial_value(&mut self, ty: Type) -> Option<String> {
        match ty {
            Type::Reference(_) | Type::Instance(_) | Type::Open(_) => None,
            Type::Array(at) => {
                let array = &self.types.arrays[at];
                let element = array.element;
                let bounds = array.bounds.iter();
                let count: i64 = bounds.map(|(low, high)| high - low + 1).product();
                let value = self.initial_value(element)?;
                let count = 1 + self.rng.below(count as usize);
                Some(format!("[{count}({value})]"))
            }
            Type::Structure(at) => {
                let members = &self.types.structures[at].members;
                let member = self.rng.below(members.len());
                let (name, ty) = members[member].clone();
                let value = self.initial_value(ty)?;
                Some(format!("({name} := {value})"))
            }
            Type::Elementary(_) | Type::Text { .. } | Type::Enumeration(_) | Type::Subrange(_) => {
                Some(self.literal(ty))
            }
        }
    }
}
