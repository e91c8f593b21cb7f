//! Division by constants, without dividers: by shifts for powers of two, else by multiplying with a
//! reciprocal that is exact for every number in range.

use crate::net::{Gate, Net, Relation, Word};
use crate::scan::Lowering;
use iecc_ir::{BinaryOp, Value};

impl Lowering<'_> {
    /// The low `width` bits of the quotient or remainder of a value and a constant.
    pub(crate) fn divide(&mut self, op: BinaryOp, a: Value, divisor: i64, width: u32) -> Net {
        let signed = matches!(op, BinaryOp::Sdiv | BinaryOp::Srem);
        let remainder = matches!(op, BinaryOp::Srem | BinaryOp::Urem);
        let bits = self.func.value_type(a).bits();
        let negative = signed && divisor < 0;
        let magnitude = match () {
            () if signed => divisor.unsigned_abs(),
            () => divisor as u64 & (u64::MAX >> (64 - bits)),
        };
        if magnitude == 0 {
            // Total by definition: x / 0 = 0 and x rem 0 = x.
            return if remainder {
                self.bits(a, width)
            } else {
                self.net().constant(width, 0)
            };
        }
        let quotient = self.quotient(a, signed, magnitude);
        if !remainder {
            let q = self.fit(quotient, width);
            return if negative { self.negate(q) } else { q };
        }
        // The sign of the divisor does not matter to the remainder.
        self.remainder(a, signed, quotient, magnitude, width)
    }

    fn remainder(
        &mut self,
        a: Value,
        signed: bool,
        quotient: Word,
        divisor: u64,
        width: u32,
    ) -> Net {
        let never_negative = !(signed && self.range(a).is_signed());
        if never_negative && divisor.is_power_of_two() {
            let low = divisor.trailing_zeros();
            let net = self.unsigned(a);
            let low = low.min(self.net().width(net));
            if low == 0 {
                return self.net().constant(width, 0);
            }
            let net = self.net().slice(net, 0, low);
            return self.fit(Word { net, signed: false }, width);
        }
        let q = self.fit(quotient, width);
        let factor = self.net().constant(width, u128::from(divisor));
        let product = self.net().gate(Gate::Mul, q, factor);
        let dividend = self.bits(a, width);
        self.net().gate(Gate::Sub, dividend, product)
    }

    /// The quotient by a positive constant, rounded toward zero.
    fn quotient(&mut self, a: Value, signed: bool, divisor: u64) -> Word {
        let range = self.range(a);
        if !signed || !range.is_signed() {
            let net = self.unsigned(a);
            let most = if range.is_signed() {
                u64::MAX >> (64 - self.func.value_type(a).bits())
            } else {
                range.hi as u64
            };
            let net = self.unsigned_quotient(net, most, divisor);
            return Word { net, signed: false };
        }
        let net = self.number(a).net;
        let width = self.net().width(net);
        let sign = self.net().slice(net, width - 1, 1);
        if divisor.is_power_of_two() {
            return self.shifted_quotient(net, sign, divisor.trailing_zeros());
        }
        let minus = self.negate(net);
        let magnitude = self.net().mux(sign, minus, net);
        let most = range.lo.unsigned_abs().max(range.hi.unsigned_abs());
        let quotient = self.unsigned_quotient(magnitude, most, divisor);
        // One bit more, so that the quotient and its negative both fit.
        let bits = self.net().width(quotient) + 1;
        let plus = self.net().zero_extend(quotient, bits);
        let minus = self.negate(plus);
        let net = self.net().mux(sign, minus, plus);
        Word { net, signed: true }
    }

    /// An arithmetic shift rounds down; adding `2^by - 1` to negative numbers first makes it round
    /// toward zero.
    fn shifted_quotient(&mut self, a: Net, sign: Net, by: u32) -> Word {
        let width = self.net().width(a);
        if by == 0 {
            return Word {
                net: a,
                signed: true,
            };
        }
        if by >= width {
            let net = self.net().constant(1, 0);
            return Word { net, signed: false };
        }
        let bias = self.net().sign_extend(sign, by);
        let bias = self.net().zero_extend(bias, width);
        let biased = self.net().gate(Gate::Add, a, bias);
        let net = self.net().slice(biased, by, width - by);
        Word { net, signed: true }
    }

    /// The quotient of a net that is at most `most`.
    fn unsigned_quotient(&mut self, a: Net, most: u64, divisor: u64) -> Net {
        let width = self.net().width(a);
        let largest = most / divisor;
        if largest == 0 {
            return self.net().constant(1, 0);
        }
        if divisor.is_power_of_two() {
            let by = divisor.trailing_zeros();
            return self.net().slice(a, by, width - by);
        }
        if largest == 1 {
            let limit = self.net().constant(width, u128::from(divisor));
            return self.net().compare(Relation::Ge, false, a, limit);
        }
        let (factor, shift) = reciprocal(most, divisor);
        let quotient_bits = 64 - largest.leading_zeros();
        // The product is below (largest + 1) << shift.
        let product_bits = shift + 64 - (largest + 1).leading_zeros();
        let a = self.fit(
            Word {
                net: a,
                signed: false,
            },
            product_bits,
        );
        let factor = self.net().constant(product_bits, factor);
        let product = self.net().gate(Gate::Mul, a, factor);
        self.net().slice(product, shift, quotient_bits)
    }
}

/// The smallest `shift` and `factor` with `x * factor >> shift == x / divisor` for all `x <= most`.
///
/// With `factor = ceil(2^shift / divisor)` and `error = factor * divisor - 2^shift`, the product
/// exceeds the true quotient by `x * error / (divisor * 2^shift)`; the fraction of a quotient is at
/// most `(divisor - 1) / divisor`, so the result is exact iff `x * error < 2^shift` (the case of the
/// worst remainder). `divisor <= most / 2` keeps all numbers within 128 bits.
fn reciprocal(most: u64, divisor: u64) -> (u128, u32) {
    let divisor = u128::from(divisor);
    for shift in 0..128 {
        let power = 1u128 << shift;
        let factor = power.div_ceil(divisor);
        let error = factor * divisor - power;
        if u128::from(most) * error < power {
            return (factor, shift);
        }
    }
    panic!("2^shift > most * divisor is always enough")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reciprocals_are_exact_up_to_the_bound() {
        for most in [20, 100, 255, 4095] {
            for divisor in 1..=most / 2 {
                let (factor, shift) = reciprocal(most, divisor);
                for x in 0..=most {
                    let quotient = (u128::from(x) * factor) >> shift;
                    assert_eq!(quotient, u128::from(x / divisor), "{x} / {divisor}");
                }
            }
        }
    }

    #[test]
    fn reciprocals_of_wide_numbers_hold_at_the_edges() {
        for divisor in [3, 7, 10, 641, 1_000_000_007, u64::MAX / 2 - 1] {
            let (factor, shift) = reciprocal(u64::MAX, divisor);
            let last = u64::MAX / divisor * divisor;
            for x in [0, divisor - 1, divisor, last - 1, last, u64::MAX] {
                let wide = u128::from(x);
                // 64 x 65 bits, so the high half is computed by hand.
                let (low, high) = (
                    wide * (factor & u128::from(u64::MAX)),
                    wide * (factor >> 64),
                );
                let sum = (low >> 64) + high;
                let quotient = if shift >= 64 {
                    sum >> (shift - 64)
                } else {
                    (wide * factor) >> shift
                };
                assert_eq!(quotient, u128::from(x / divisor), "{x} / {divisor}");
            }
        }
    }
}
