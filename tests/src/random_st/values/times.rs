//! Arithmetic on durations.

use crate::random_st::Generator;
use crate::random_st::types::{Elementary, Type};

impl Generator<'_> {
    pub(super) fn duration(&mut self, ty: Elementary, depth: u32) {
        let full = Type::Elementary(ty);
        let long = ty.is_long();
        match self.rng.below(8) {
            0 => {
                self.put("(-");
                self.operand(full, depth);
                self.put(")");
            }
            1 | 2 => {
                let number = self.rng.pick(&[
                    Elementary::Int,
                    Elementary::Dint,
                    Elementary::Uint,
                    Elementary::Real,
                ]);
                self.binary("*", [full, Type::Elementary(number), full], depth);
            }
            3 => self.division_of_time(full),
            4 => {
                let of = [Elementary::Date, Elementary::Tod, Elementary::Dt];
                let of_long = [Elementary::Ldate, Elementary::Ltod, Elementary::Ldt];
                let of = self.rng.pick(if long { &of_long } else { &of });
                let of = Type::Elementary(of);
                self.binary("-", [of, of, full], depth);
            }
            _ => {
                let op = self.rng.pick(&["+", "-"]);
                self.binary(op, [full; 3], depth);
            }
        }
    }

    pub(super) fn division_of_time(&mut self, ty: Type) {
        let number = self.rng.pick(&[Elementary::Int, Elementary::Lreal]);
        self.put("(");
        self.operand(ty, 0);
        self.put(" / ");
        if self.rng.one_in(3) {
            self.operand(Type::Elementary(number), 0);
        } else {
            let literal = self.divisor_literal(number);
            self.put(&literal);
        }
        self.put(")");
    }

    pub(super) fn shifted_time(&mut self, ty: Elementary, depth: u32) {
        let full = Type::Elementary(ty);
        let by = if ty.is_long() {
            Elementary::Ltime
        } else {
            Elementary::Time
        };
        if self.rng.one_in(4) {
            return self.selection(full, depth);
        }
        let op = self.rng.pick(&["+", "-"]);
        self.binary(op, [full, Type::Elementary(by), full], depth);
    }
}
