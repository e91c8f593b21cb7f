//! Arithmetic on numbers and bits, and conversions between them.

use crate::random_st::Generator;
use crate::random_st::types::{Elementary, Kind, Type, Types};

impl Generator<'_> {
    pub(super) fn integer_operation(&mut self, ty: Elementary, depth: u32) {
        let full = Type::Elementary(ty);
        match self.rng.below(14) {
            0 if ty.kind() == Kind::Signed => {
                self.put("(-");
                self.operand(full, 0);
                self.put(")");
            }
            1 => self.standard_call("ABS", &[full], depth),
            2 | 3 => self.division("/", ty, depth),
            4 => self.division("MOD", ty, depth),
            5 if ty == Elementary::Int => {
                let text = Types::text(self.rng);
                if self.rng.one_in(2) {
                    self.standard_call("LEN", &[text], depth);
                } else {
                    self.standard_call("FIND", &[text, text], depth);
                }
            }
            6 => {
                let name = self.rng.pick(&["ADD", "SUB", "MUL"]);
                self.standard_call(name, &[full, full], depth);
            }
            7 => {
                let word = ty.word();
                let from = self.rng.pick(&[Elementary::Real, Elementary::Lreal]);
                let name = match self.rng.below(2) {
                    0 => format!("TRUNC_{word}"),
                    _ => format!("{}_TRUNC_{word}", from.word()),
                };
                self.standard_call(&name, &[Type::Elementary(from)], depth);
            }
            _ => {
                let op = self.rng.pick(&["+", "-", "*"]);
                self.binary(op, [full; 3], depth);
            }
        }
    }

    /// A quotient or remainder, whose divisor is 0 now and then.
    pub(super) fn division(&mut self, op: &str, ty: Elementary, depth: u32) {
        let full = Type::Elementary(ty);
        self.put("(");
        self.operand(full, depth);
        self.put(&format!(" {op} "));
        match self.rng.below(8) {
            0 | 1 => self.operand(full, depth),
            2 => {
                self.put("MAX(");
                self.operand(full, depth);
                self.put(&format!(", {}))", ty.plain()));
                return;
            }
            _ => {
                let literal = self.divisor_literal(ty);
                self.put(&literal);
            }
        }
        self.put(")");
    }

    pub(super) fn bit_operation(&mut self, ty: Elementary, depth: u32) {
        let full = Type::Elementary(ty);
        match self.rng.below(8) {
            0 => {
                self.put("(NOT ");
                self.operand(full, depth);
                self.put(")");
            }
            1 | 2 => {
                let name = self.rng.pick(&["SHL", "SHR", "ROL", "ROR"]);
                let count = self
                    .rng
                    .pick(&[Elementary::Int, Elementary::Usint, Elementary::Dint]);
                self.standard_call(name, &[full, Type::Elementary(count)], depth);
            }
            3 => {
                let name = self.rng.pick(&["TO_BIG_ENDIAN", "FROM_BIG_ENDIAN"]);
                self.standard_call(name, &[full], depth);
            }
            _ => {
                let op = self.rng.pick(&["AND", "OR", "XOR", "&"]);
                self.binary(op, [full; 3], depth);
            }
        }
    }

    pub(super) fn real_operation(&mut self, ty: Elementary, depth: u32) {
        let full = Type::Elementary(ty);
        match self.rng.below(16) {
            0 => {
                self.put("(-");
                self.operand(full, depth);
                self.put(")");
            }
            1 => self.standard_call("ABS", &[full], depth),
            2 => self.standard_call("SQRT", &[full], depth),
            3 if self.rng.one_in(6) => {
                let name = self
                    .rng
                    .pick(&["SIN", "COS", "EXP", "LN", "ATAN", "LOG", "TAN"]);
                self.standard_call(name, &[full], depth);
            }
            4 if self.rng.one_in(6) => {
                let power = self.rng.pick(&[Elementary::Int, Elementary::Sint, ty]);
                self.binary("**", [full, Type::Elementary(power), full], depth);
            }
            5 => self.division("/", ty, depth),
            _ => {
                let op = self.rng.pick(&["+", "-", "*", "/"]);
                self.binary(op, [full; 3], depth);
            }
        }
    }

    /// A value of another type, converted.
    pub(super) fn converted(&mut self, to: Elementary, depth: u32) {
        let from = self.source_of(to);
        let (from_word, to_word) = (from.word(), to.word());
        let name = if self.rng.one_in(2) {
            format!("TO_{to_word}")
        } else {
            format!("{from_word}_TO_{to_word}")
        };
        self.put(&name);
        self.put("(");
        let from = Type::Elementary(from);
        // Something is always there to begin with: every body has an INT.
        if depth > 0 || self.routes.iter().any(|route| route.ty == from) {
            self.operand(from, depth);
        } else {
            // A constant is converted at compile time, which refuses what does not fit.
            let plain = self.types.plain(from);
            self.put(&plain);
        }
        self.put(")");
    }

    /// A type that can be converted to another one, best one that there are variables of.
    pub(super) fn source_of(&mut self, to: Elementary) -> Elementary {
        let from = Elementary::ALL.iter().copied();
        let sources: Vec<Elementary> = from.filter(|from| converts(*from, to)).collect();
        let known = |ty: &&Elementary| {
            let ty = Type::Elementary(**ty);
            self.routes.iter().any(|route| route.ty == ty)
        };
        let best: Vec<Elementary> = sources.iter().filter(known).copied().collect();
        if best.is_empty() {
            self.rng.pick(&sources)
        } else {
            self.rng.pick(&best)
        }
    }
}

/// Whether there is a function that converts.
fn converts(from: Elementary, to: Elementary) -> bool {
    use Kind::{Bits, Bool, Character, Clock, Date, Duration, Moment, Real, Signed, Unsigned};
    if from == to {
        return false;
    }
    let numeric = |kind| matches!(kind, Signed | Unsigned);
    match (from.kind(), to.kind()) {
        (Signed | Unsigned | Bits | Bool, Bool | Bits) => true,
        (from_kind, Signed | Unsigned) => {
            numeric(from_kind) || matches!(from_kind, Real | Bits | Bool | Duration)
        }
        (Signed | Unsigned | Real | Duration, Real) => true,
        (Bits, Real) => from.bits() == to.bits(),
        (Real, Bits) => from.bits() == to.bits(),
        (Signed | Unsigned | Real, Duration) => true,
        (Duration, Duration) | (Clock, Clock) | (Moment, Moment | Date | Clock) | (Date, Date) => {
            from.is_long() || !to.is_long() || from.kind() == to.kind()
        }
        (Character, Character) => true,
        (Bits, Character) => from.bits() == to.bits(),
        (Character, Bits) => from.bits() <= to.bits(),
        (
            Bool | Signed | Unsigned | Bits | Real | Duration | Date | Clock | Moment | Character,
            Bool | Bits | Real | Duration | Date | Clock | Moment | Character,
        ) => false,
    }
}
