//! Constructors of netlist nodes. Each returns the simplest node that computes the same bits, so
//! constants, untouched bits and repeated operations never reach the text.

use crate::net::{Gate, Net, Netlist, Op, Relation, Shift, Source, Word, mask};

/// Widest net whose value is computed here.
const FOLD_WIDTH: u32 = 128;

impl Netlist {
    /// A number; bits above the width are dropped.
    pub(crate) fn constant(&mut self, width: u32, bits: u128) -> Net {
        self.intern(Op::Const(bits & mask(width)), width)
    }

    /// A register, port or divider.
    pub(crate) fn source(&mut self, source: Source, width: u32) -> Net {
        self.intern(Op::Source(source), width)
    }

    /// Every bit inverted.
    pub(crate) fn not(&mut self, a: Net) -> Net {
        let width = self.width(a);
        match self.op(a) {
            Op::Const(bits) => self.constant(width, !bits),
            Op::Not(inner) => inner,
            Op::Compare(relation, signed, args) => {
                self.intern(Op::Compare(relation.inverted(), signed, args), 1)
            }
            Op::Source(_)
            | Op::Gate(..)
            | Op::Mux(..)
            | Op::Shift(..)
            | Op::Slice(..)
            | Op::ZeroExtend(_)
            | Op::SignExtend(_)
            | Op::Concat(_) => self.intern(Op::Not(a), width),
        }
    }

    /// A gate on operands of one width.
    pub(crate) fn gate(&mut self, gate: Gate, a: Net, b: Net) -> Net {
        let width = self.width(a);
        assert_eq!(width, self.width(b), "operands of a gate have one width");
        if let (Some(x), Some(y)) = (self.as_const(a), self.as_const(b))
            && width <= FOLD_WIDTH
        {
            return self.constant(width, eval_gate(gate, x, y));
        }
        if let Some(net) = self.gate_identity(gate, a, b) {
            return net;
        }
        if gate != Gate::Sub
            && let Some(net) = self.gate_identity(gate, b, a)
        {
            return net;
        }
        // Constants stand on the right, as people write them.
        let swap = gate != Gate::Sub && self.as_const(a).is_some();
        let args = if swap { [b, a] } else { [a, b] };
        self.intern(Op::Gate(gate, args), width)
    }

    /// The result if the right operand decides it.
    fn gate_identity(&mut self, gate: Gate, a: Net, b: Net) -> Option<Net> {
        let width = self.width(a);
        if a == b {
            return match gate {
                Gate::And | Gate::Or => Some(a),
                Gate::Xor | Gate::Sub => Some(self.constant(width, 0)),
                Gate::Add | Gate::Mul => None,
            };
        }
        let y = self.as_const(b)?;
        let ones = width <= FOLD_WIDTH && y == mask(width);
        match gate {
            Gate::And if ones => Some(a),
            Gate::And | Gate::Mul if y == 0 => Some(b),
            Gate::Or if ones => Some(b),
            Gate::Xor if ones => Some(self.not(a)),
            Gate::Or | Gate::Xor | Gate::Add | Gate::Sub if y == 0 => Some(a),
            Gate::Mul if y.is_power_of_two() => Some(self.shift_left_by(a, y.trailing_zeros())),
            Gate::And | Gate::Or | Gate::Xor | Gate::Add | Gate::Sub | Gate::Mul => None,
        }
    }

    /// A comparison of operands of one width.
    pub(crate) fn compare(&mut self, relation: Relation, signed: bool, a: Net, b: Net) -> Net {
        let width = self.width(a);
        assert_eq!(width, self.width(b), "compared operands have one width");
        if a == b {
            let holds = matches!(relation, Relation::Eq | Relation::Le | Relation::Ge);
            return self.constant(1, u128::from(holds));
        }
        if let (Some(x), Some(y)) = (self.as_const(a), self.as_const(b)) {
            let holds = eval_compare(relation, signed, width, x, y);
            return self.constant(1, u128::from(holds));
        }
        if self.as_const(a).is_some() {
            return self.compare(relation.swapped(), signed, b, a);
        }
        if width == 1 && !signed && matches!(relation, Relation::Eq | Relation::Ne) {
            let differ = self.gate(Gate::Xor, a, b);
            return if relation == Relation::Ne {
                differ
            } else {
                self.not(differ)
            };
        }
        // The sign means nothing to equality.
        let signed = signed && !matches!(relation, Relation::Eq | Relation::Ne);
        self.intern(Op::Compare(relation, signed, [a, b]), 1)
    }

    /// `condition ? a : b`.
    pub(crate) fn mux(&mut self, condition: Net, a: Net, b: Net) -> Net {
        let width = self.width(a);
        assert_eq!(width, self.width(b), "arms of a choice have one width");
        match self.as_const(condition) {
            Some(0) => return b,
            Some(_) => return a,
            None if a == b => return a,
            None => {}
        }
        if let Op::Not(inner) = self.op(condition) {
            return self.mux(inner, b, a);
        }
        if width == 1 {
            match (self.as_const(a), self.as_const(b)) {
                (Some(1), None) => return self.gate(Gate::Or, condition, b),
                (None, Some(0)) => return self.gate(Gate::And, condition, a),
                (Some(0), None) => {
                    let other = self.not(condition);
                    return self.gate(Gate::And, other, b);
                }
                (None, Some(1)) => {
                    let other = self.not(condition);
                    return self.gate(Gate::Or, other, a);
                }
                (Some(1), Some(_)) => return condition,
                (Some(_), Some(_)) => return self.not(condition),
                (Some(_), None) | (None, _) => {}
            }
        }
        self.intern(Op::Mux(condition, [a, b]), width)
    }

    /// A shift by a net whose every value is below `2^width(count)`; counts of the operand's width
    /// or more give 0 or the sign.
    pub(crate) fn shift(&mut self, shift: Shift, a: Net, count: Net) -> Net {
        let width = self.width(a);
        if let Some(by) = self.as_const(count) {
            let by = u32::try_from(by).unwrap_or(u32::MAX);
            return match shift {
                Shift::Left => self.shift_left_by(a, by),
                Shift::Right => self.shift_right_by(a, by),
                Shift::RightSigned => self.shift_right_signed_by(a, by),
            };
        }
        if self.as_const(a) == Some(0) {
            return a;
        }
        self.intern(Op::Shift(shift, [a, count]), width)
    }

    /// Shifted left, as wide as before.
    pub(crate) fn shift_left_by(&mut self, a: Net, by: u32) -> Net {
        let width = self.width(a);
        if by >= width {
            return self.constant(width, 0);
        }
        let low = self.slice(a, 0, width - by);
        let zeros = self.zeros(by);
        zeros.map_or(a, |zeros| self.concat(low, zeros))
    }

    /// Shifted right filling with 0, as wide as before.
    pub(crate) fn shift_right_by(&mut self, a: Net, by: u32) -> Net {
        let width = self.width(a);
        if by >= width {
            return self.constant(width, 0);
        }
        let high = self.slice(a, by, width - by);
        self.zero_extend(high, width)
    }

    /// Shifted right filling with the sign, as wide as before.
    pub(crate) fn shift_right_signed_by(&mut self, a: Net, by: u32) -> Net {
        let width = self.width(a);
        let by = by.min(width - 1);
        let high = self.slice(a, by, width - by);
        self.sign_extend(high, width)
    }

    fn zeros(&mut self, width: u32) -> Option<Net> {
        (width > 0).then(|| self.constant(width, 0))
    }

    /// `width` bits of a net from bit `low` up.
    pub(crate) fn slice(&mut self, a: Net, low: u32, width: u32) -> Net {
        let from = self.width(a);
        assert!(width > 0 && low + width <= from, "slice inside its net");
        if width == from {
            return a;
        }
        match self.op(a) {
            Op::Const(bits) => self.constant(width, bits >> low),
            Op::Slice(inner, base) => self.slice(inner, base + low, width),
            Op::Concat([high, rest]) => self.slice_concat(high, rest, low, width),
            Op::ZeroExtend(inner) => self.slice_extended(inner, low, width, false),
            Op::SignExtend(inner) => self.slice_extended(inner, low, width, true),
            Op::Source(_)
            | Op::Not(_)
            | Op::Gate(..)
            | Op::Compare(..)
            | Op::Mux(..)
            | Op::Shift(..) => self.intern(Op::Slice(a, low), width),
        }
    }

    fn slice_concat(&mut self, high: Net, rest: Net, low: u32, width: u32) -> Net {
        let split = self.width(rest);
        if low >= split {
            return self.slice(high, low - split, width);
        }
        if low + width <= split {
            return self.slice(rest, low, width);
        }
        let upper = self.slice(high, 0, low + width - split);
        let lower = self.slice(rest, low, split - low);
        self.concat(upper, lower)
    }

    fn slice_extended(&mut self, inner: Net, low: u32, width: u32, signed: bool) -> Net {
        let split = self.width(inner);
        if low + width <= split {
            return self.slice(inner, low, width);
        }
        // At least the sign itself is kept to extend from.
        let low = if signed { low.min(split - 1) } else { low };
        if low >= split {
            return self.constant(width, 0);
        }
        let part = self.slice(inner, low, split - low);
        self.extend(part, width.max(split - low), signed)
    }

    /// The low `width` bits of a word.
    pub(crate) fn fit(&mut self, word: Word, width: u32) -> Net {
        if width <= self.width(word.net) {
            self.slice(word.net, 0, width)
        } else {
            self.extend(word.net, width, word.signed)
        }
    }

    /// The net filled up with copies of 0 or of its highest bit.
    pub(crate) fn extend(&mut self, a: Net, width: u32, signed: bool) -> Net {
        if signed {
            self.sign_extend(a, width)
        } else {
            self.zero_extend(a, width)
        }
    }

    /// The net filled up with 0.
    pub(crate) fn zero_extend(&mut self, a: Net, width: u32) -> Net {
        assert!(width >= self.width(a), "extension does not narrow");
        if width == self.width(a) {
            return a;
        }
        match self.op(a) {
            Op::Const(bits) => self.constant(width, bits),
            Op::ZeroExtend(inner) => self.zero_extend(inner, width),
            Op::Source(_)
            | Op::Not(_)
            | Op::Gate(..)
            | Op::Compare(..)
            | Op::Mux(..)
            | Op::Shift(..)
            | Op::Slice(..)
            | Op::SignExtend(_)
            | Op::Concat(_) => self.intern(Op::ZeroExtend(a), width),
        }
    }

    /// The net filled up with copies of its highest bit.
    pub(crate) fn sign_extend(&mut self, a: Net, width: u32) -> Net {
        let from = self.width(a);
        assert!(width >= from, "extension does not narrow");
        if width == from {
            return a;
        }
        match self.op(a) {
            Op::Const(bits) => {
                let negative = bits >> (from - 1) & 1 == 1;
                let fill = if negative { !mask(from) } else { 0 };
                self.constant(width, bits | fill)
            }
            Op::ZeroExtend(inner) => self.zero_extend(inner, width),
            Op::SignExtend(inner) => self.sign_extend(inner, width),
            Op::Source(_)
            | Op::Not(_)
            | Op::Gate(..)
            | Op::Compare(..)
            | Op::Mux(..)
            | Op::Shift(..)
            | Op::Slice(..)
            | Op::Concat(_) => self.intern(Op::SignExtend(a), width),
        }
    }

    /// High bits, then low bits.
    pub(crate) fn concat(&mut self, high: Net, low: Net) -> Net {
        let width = self.width(high) + self.width(low);
        match (self.as_const(high), self.as_const(low)) {
            (Some(0), _) => self.zero_extend(low, width),
            (Some(h), Some(l)) if width <= FOLD_WIDTH => {
                let shift = self.width(low);
                self.constant(width, h << shift | l)
            }
            (Some(_) | None, _) => self.intern(Op::Concat([high, low]), width),
        }
    }
}

fn eval_gate(gate: Gate, x: u128, y: u128) -> u128 {
    match gate {
        Gate::And => x & y,
        Gate::Or => x | y,
        Gate::Xor => x ^ y,
        Gate::Add => x.wrapping_add(y),
        Gate::Sub => x.wrapping_sub(y),
        Gate::Mul => x.wrapping_mul(y),
    }
}

fn eval_compare(relation: Relation, signed: bool, width: u32, x: u128, y: u128) -> bool {
    // Inverting the sign bit turns two's complement order into plain order.
    let flip = if signed { 1 << (width - 1) } else { 0 };
    let order = (x ^ flip).cmp(&(y ^ flip));
    match relation {
        Relation::Eq => order.is_eq(),
        Relation::Ne => order.is_ne(),
        Relation::Lt => order.is_lt(),
        Relation::Le => order.is_le(),
        Relation::Gt => order.is_gt(),
        Relation::Ge => order.is_ge(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(netlist: &mut Netlist, index: u32, width: u32) -> Net {
        netlist.source(Source::Input(index), width)
    }

    #[test]
    fn equal_operations_are_one_node() {
        let mut n = Netlist::default();
        let (a, b) = (input(&mut n, 0, 8), input(&mut n, 1, 8));
        assert_eq!(n.gate(Gate::Add, a, b), n.gate(Gate::Add, a, b));
        assert_ne!(n.gate(Gate::Sub, a, b), n.gate(Gate::Sub, b, a));
    }

    #[test]
    fn bits_of_an_extension_are_bits_of_the_operand_or_of_the_sign() {
        let mut n = Netlist::default();
        let a = input(&mut n, 0, 4);
        let wide = n.sign_extend(a, 16);
        let low = n.slice(a, 1, 2);
        assert_eq!(n.slice(wide, 1, 2), low);
        let sign = n.slice(a, 3, 1);
        let copies = n.sign_extend(sign, 6);
        assert_eq!(n.slice(wide, 9, 6), copies);
        let wide = n.zero_extend(a, 16);
        let zero = n.constant(6, 0);
        assert_eq!(n.slice(wide, 9, 6), zero);
    }

    #[test]
    fn choices_between_constants_are_logic() {
        let mut n = Netlist::default();
        let (c, x) = (input(&mut n, 0, 1), input(&mut n, 1, 1));
        let (one, zero) = (n.constant(1, 1), n.constant(1, 0));
        let not_c = n.not(c);
        assert_eq!(n.mux(c, one, zero), c);
        assert_eq!(n.mux(c, zero, one), not_c);
        let or = n.gate(Gate::Or, c, x);
        assert_eq!(n.mux(c, one, x), or);
        let and = n.gate(Gate::And, not_c, x);
        assert_eq!(n.mux(c, zero, x), and);
    }

    #[test]
    fn signed_constants_compare_by_their_sign() {
        let mut n = Netlist::default();
        let (minus, five) = (n.constant(4, 0xf), n.constant(4, 5));
        let signed = n.compare(Relation::Lt, true, minus, five);
        let plain = n.compare(Relation::Lt, false, minus, five);
        assert_eq!((n.as_const(signed), n.as_const(plain)), (Some(1), Some(0)));
    }
}
