//! The operations of the op table. What machine instructions leave open or trap on (division by 0,
//! large shift counts, NaN, floats outside the integers) is made total here, as the table says.

use super::{Translator, clif_type};
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{self as clif, InstBuilder, MemFlagsData, types};
use iecc_ir::{BinaryOp, CompareOp, ConvertOp, Type, UnaryOp, Value};

/// Division instructions exist for 32 and 64 bits; narrower numbers are widened.
struct Division {
    signed: bool,
    remainder: bool,
}

/// Stands for a positive divisor d of 32 bits: with `2^(l - 1) < d < 2^l`, `shift = 31 + l` and
/// `factor = 2^shift / d` rounded up, `x * factor / 2^shift` rounded down is `x / d` rounded down if x is not negative,
/// and one less than the truncated quotient if it is (Granlund, Montgomery 1994, figure 5.2).
struct Multiplier {
    factor: u64,
    shift: u32,
}

impl Multiplier {
    /// Powers of two are shifts.
    fn serves(division: &Division, ty: Type, divisor: u64) -> bool {
        let is_positive = divisor < 1 << 31 && !divisor.is_power_of_two();
        division.signed && ty == Type::I32 && is_positive
    }

    fn of(divisor: u64) -> Self {
        let shift = 31 + (u64::BITS - divisor.leading_zeros());
        let factor = (1u64 << shift) / divisor + 1;
        Self { factor, shift }
    }
}

impl Translator<'_, '_> {
    pub(super) fn unary(&mut self, op: UnaryOp, arg: Value) -> clif::Value {
        let (ty, x) = (self.func.value_type(arg), self.value(arg));
        match op {
            UnaryOp::Not if ty == Type::I1 => self.ins().bxor_imm_u(x, 1),
            UnaryOp::Not => self.ins().bnot(x),
            UnaryOp::Neg => self.ins().ineg(x),
            UnaryOp::Fneg => self.ins().fneg(x),
            UnaryOp::Fabs => self.ins().fabs(x),
            UnaryOp::Fsqrt => self.ins().sqrt(x),
        }
    }

    pub(super) fn binary(&mut self, op: BinaryOp, args: [Value; 2]) -> clif::Value {
        let [x, y] = args.map(|v| self.value(v));
        let division = |signed, remainder| Division { signed, remainder };
        match op {
            BinaryOp::Add => self.ins().iadd(x, y),
            BinaryOp::Sub => self.ins().isub(x, y),
            BinaryOp::Mul => self.ins().imul(x, y),
            BinaryOp::Sdiv => self.divide(&division(true, false), args),
            BinaryOp::Udiv => self.divide(&division(false, false), args),
            BinaryOp::Srem => self.divide(&division(true, true), args),
            BinaryOp::Urem => self.divide(&division(false, true), args),
            BinaryOp::And => self.ins().band(x, y),
            BinaryOp::Or => self.ins().bor(x, y),
            BinaryOp::Xor => self.ins().bxor(x, y),
            BinaryOp::Shl | BinaryOp::Ushr | BinaryOp::Sshr => self.shift(op, args),
            BinaryOp::Fadd => self.ins().fadd(x, y),
            BinaryOp::Fsub => self.ins().fsub(x, y),
            BinaryOp::Fmul => self.ins().fmul(x, y),
            BinaryOp::Fdiv => self.ins().fdiv(x, y),
        }
    }

    fn divide(&mut self, division: &Division, args: [Value; 2]) -> clif::Value {
        let ty = self.func.value_type(args[0]);
        let wide = if ty == Type::I64 {
            Type::I64
        } else {
            Type::I32
        };
        let x = self.value(args[0]);
        let x = self.extend(x, ty, wide, division.signed);
        let quotient = match self.func.constant(args[1]) {
            Some(bits) => {
                let bits = if division.signed {
                    ty.signed(bits) as u64
                } else {
                    bits
                };
                self.divide_by_constant(division, wide, x, bits & wide.mask())
            }
            None => {
                let y = self.value(args[1]);
                let y = self.extend(y, ty, wide, division.signed);
                self.divide_by_value(division, wide, x, y)
            }
        };
        self.narrow(quotient, ty, wide)
    }

    /// A divisor that is a constant lets Cranelift multiply instead.
    fn divide_by_constant(
        &mut self,
        division: &Division,
        ty: Type,
        x: clif::Value,
        divisor: u64,
    ) -> clif::Value {
        let minus_one = division.signed && divisor == ty.mask();
        match (divisor, division.remainder) {
            (0, true) => x,
            (0, false) => self.constant(ty, 0),
            (_, true) if minus_one => self.constant(ty, 0),
            (_, false) if minus_one => self.ins().ineg(x),
            (_, remainder) if Multiplier::serves(division, ty, divisor) => {
                self.divide_by_multiplying(x, divisor, remainder)
            }
            (_, _) => {
                let y = self.constant(ty, divisor);
                self.plain_division(division, x, y)
            }
        }
    }

    /// A product of 64 bits, which no instruction wants in registers of its own.
    fn divide_by_multiplying(
        &mut self,
        x: clif::Value,
        divisor: u64,
        remainder: bool,
    ) -> clif::Value {
        let multiplier = Multiplier::of(divisor);
        let wide = self.ins().sextend(types::I64, x);
        let factor = self.ins().iconst(types::I64, multiplier.factor as i64);
        let product = self.ins().imul(wide, factor);
        let floor = self.ins().sshr_imm_u(product, i64::from(multiplier.shift));
        let floor = self.ins().ireduce(types::I32, floor);
        // Rounded down; negative numbers want to be rounded up.
        let sign = self.ins().sshr_imm_u(x, 31);
        let quotient = self.ins().isub(floor, sign);
        if !remainder {
            return quotient;
        }
        let whole = self.ins().imul_imm_s(quotient, divisor as i64);
        self.ins().isub(x, whole)
    }

    /// The machine divides by 1 where it would trap, and the result is replaced.
    fn divide_by_value(
        &mut self,
        division: &Division,
        ty: Type,
        x: clif::Value,
        y: clif::Value,
    ) -> clif::Value {
        let (zero, one) = (self.constant(ty, 0), self.constant(ty, 1));
        let by_zero = self.ins().icmp(IntCC::Equal, y, zero);
        let mut traps = by_zero;
        let mut negated = None;
        if division.signed {
            let by_minus_one = self.ins().icmp_imm_s(IntCC::Equal, y, -1);
            traps = self.ins().bor(by_zero, by_minus_one);
            negated = Some((by_minus_one, self.ins().ineg(x)));
        }
        let safe = self.ins().select(traps, one, y);
        let result = self.plain_division(division, x, safe);
        if division.remainder {
            // x rem 1 is 0, which is also x rem -1.
            return self.ins().select(by_zero, x, result);
        }
        let result = match negated {
            Some((by_minus_one, negated)) => self.ins().select(by_minus_one, negated, result),
            None => result,
        };
        self.ins().select(by_zero, zero, result)
    }

    fn plain_division(
        &mut self,
        division: &Division,
        x: clif::Value,
        y: clif::Value,
    ) -> clif::Value {
        match (division.signed, division.remainder) {
            (true, false) => self.ins().sdiv(x, y),
            (true, true) => self.ins().srem(x, y),
            (false, false) => self.ins().udiv(x, y),
            (false, true) => self.ins().urem(x, y),
        }
    }

    /// Cranelift takes shift counts modulo the width.
    fn shift(&mut self, op: BinaryOp, args: [Value; 2]) -> clif::Value {
        let ty = self.func.value_type(args[0]);
        let [x, count] = args.map(|v| self.value(v));
        let last = self.constant(ty, u64::from(ty.bits() - 1));
        if op == BinaryOp::Sshr {
            let count = self.ins().umin(count, last);
            return self.ins().sshr(x, count);
        }
        let shifted = if op == BinaryOp::Shl {
            self.ins().ishl(x, count)
        } else {
            self.ins().ushr(x, count)
        };
        let inside = self.ins().icmp(IntCC::UnsignedLessThanOrEqual, count, last);
        let zero = self.constant(ty, 0);
        self.ins().select(inside, shifted, zero)
    }

    pub(super) fn compare(&mut self, op: CompareOp, args: [Value; 2]) -> clif::Value {
        let [x, y] = args.map(|v| self.value(v));
        match op {
            CompareOp::Eq => self.ins().icmp(IntCC::Equal, x, y),
            CompareOp::Ne => self.ins().icmp(IntCC::NotEqual, x, y),
            CompareOp::Slt => self.ins().icmp(IntCC::SignedLessThan, x, y),
            CompareOp::Sle => self.ins().icmp(IntCC::SignedLessThanOrEqual, x, y),
            CompareOp::Sgt => self.ins().icmp(IntCC::SignedGreaterThan, x, y),
            CompareOp::Sge => self.ins().icmp(IntCC::SignedGreaterThanOrEqual, x, y),
            CompareOp::Ult => self.ins().icmp(IntCC::UnsignedLessThan, x, y),
            CompareOp::Ule => self.ins().icmp(IntCC::UnsignedLessThanOrEqual, x, y),
            CompareOp::Ugt => self.ins().icmp(IntCC::UnsignedGreaterThan, x, y),
            CompareOp::Uge => self.ins().icmp(IntCC::UnsignedGreaterThanOrEqual, x, y),
            CompareOp::Feq => self.ins().fcmp(FloatCC::Equal, x, y),
            CompareOp::Fne => self.ins().fcmp(FloatCC::NotEqual, x, y),
            CompareOp::Flt => self.ins().fcmp(FloatCC::LessThan, x, y),
            CompareOp::Fle => self.ins().fcmp(FloatCC::LessThanOrEqual, x, y),
            // Choices by these are instructions for minimum and maximum if written as `less`.
            CompareOp::Fgt => self.ins().fcmp(FloatCC::LessThan, y, x),
            CompareOp::Fge => self.ins().fcmp(FloatCC::LessThanOrEqual, y, x),
        }
    }

    pub(super) fn convert(&mut self, op: ConvertOp, to: Type, arg: Value) -> clif::Value {
        let (from, x) = (self.func.value_type(arg), self.value(arg));
        let target = clif_type(to);
        match op {
            ConvertOp::Trunc => self.narrow(x, to, from),
            ConvertOp::Zext => self.extend(x, from, to, false),
            ConvertOp::Sext => self.extend(x, from, to, true),
            ConvertOp::Promote => self.ins().fpromote(target, x),
            ConvertOp::Demote => self.ins().fdemote(target, x),
            ConvertOp::SintToFloat => {
                let wide = if from == Type::I64 { from } else { Type::I32 };
                let x = self.extend(x, from, wide, true);
                self.ins().fcvt_from_sint(target, x)
            }
            ConvertOp::UintToFloat if from == Type::I64 => self.ins().fcvt_from_uint(target, x),
            // In 64 bits they are not negative, and signed conversions are cheaper.
            ConvertOp::UintToFloat => {
                let x = self.extend(x, from, Type::I64, false);
                self.ins().fcvt_from_sint(target, x)
            }
            ConvertOp::FloatToSint => self.float_to_sint(x, to),
            ConvertOp::FloatToUint => self.float_to_uint(x, to),
            ConvertOp::FloatBits => {
                let x = self.exact(arg);
                self.ins().bitcast(target, MemFlagsData::new(), x)
            }
            ConvertOp::BitsFloat => self.ins().bitcast(target, MemFlagsData::new(), x),
        }
    }

    /// To a type at least as wide.
    pub(super) fn extend(
        &mut self,
        x: clif::Value,
        from: Type,
        to: Type,
        signed: bool,
    ) -> clif::Value {
        let (source, target) = (clif_type(from), clif_type(to));
        let zero_extended = from == Type::I1 || !signed;
        let wide = match (source == target, zero_extended) {
            (true, _) => x,
            (false, true) => self.ins().uextend(target, x),
            (false, false) => self.ins().sextend(target, x),
        };
        if from == Type::I1 && to != Type::I1 && signed {
            return self.ins().ineg(wide);
        }
        wide
    }

    /// To a type at most as wide.
    fn narrow(&mut self, x: clif::Value, to: Type, from: Type) -> clif::Value {
        let (source, target) = (clif_type(from), clif_type(to));
        let low = if source == target {
            x
        } else {
            self.ins().ireduce(target, x)
        };
        if to == Type::I1 && from != Type::I1 {
            return self.ins().band_imm_u(low, 1);
        }
        low
    }

    /// To the nearest integer, ties to even; the sign of a 0 may be lost, which no integer shows.
    /// Without an instruction for it, 2^23 or 2^52 is added and taken away again: numbers of that
    /// size have no room for a fraction, so the addition rounds. Larger ones have none to begin with.
    fn nearest(&mut self, x: clif::Value) -> clif::Value {
        if self.program.has_rounding {
            return self.ins().nearest(x);
        }
        let (ty, limit) = if self.builder.func.dfg.value_type(x) == types::F32 {
            (Type::F32, u64::from(8_388_608f32.to_bits()))
        } else {
            (Type::F64, 4_503_599_627_370_496f64.to_bits())
        };
        let limit = self.constant(ty, limit);
        let size = self.ins().fabs(x);
        let small = self.ins().fcmp(FloatCC::LessThan, size, limit);
        let shift = self.ins().fcopysign(limit, x);
        let moved = self.ins().fadd(x, shift);
        let rounded = self.ins().fsub(moved, shift);
        self.ins().select(small, rounded, x)
    }

    fn float_to_sint(&mut self, x: clif::Value, to: Type) -> clif::Value {
        let wide = if to == Type::I64 { to } else { Type::I32 };
        let rounded = self.nearest(x);
        let mut number = self.ins().fcvt_to_sint_sat(clif_type(wide), rounded);
        if to != wide {
            let largest = self.constant(wide, to.mask() >> 1);
            let smallest = self.constant(wide, !(to.mask() >> 1) & wide.mask());
            number = self.ins().smin(number, largest);
            number = self.ins().smax(number, smallest);
        }
        self.narrow(number, to, wide)
    }

    fn float_to_uint(&mut self, x: clif::Value, to: Type) -> clif::Value {
        let wide = if to == Type::I64 { to } else { Type::I32 };
        let rounded = self.nearest(x);
        let mut number = self.ins().fcvt_to_uint_sat(clif_type(wide), rounded);
        if to != wide {
            let largest = self.constant(wide, to.mask());
            number = self.ins().umin(number, largest);
        }
        self.narrow(number, to, wide)
    }

    /// Boundaries of the unit between two times, at least 0 and at most the signed maximum of `ty`.
    pub(super) fn units_between(
        &mut self,
        earlier: clif::Value,
        later: clif::Value,
        unit_ns: u64,
        ty: Type,
    ) -> clif::Value {
        let unit = self.constant(Type::I64, unit_ns);
        let [later, earlier] = match unit_ns {
            1 => [later, earlier],
            _ => [later, earlier].map(|time| self.ins().udiv(time, unit)),
        };
        let difference = self.ins().isub(later, earlier);
        let passed = self.ins().icmp(IntCC::UnsignedGreaterThan, later, earlier);
        let zero = self.constant(Type::I64, 0);
        let difference = self.ins().select(passed, difference, zero);
        let largest = self.constant(Type::I64, ty.mask() >> 1);
        let bounded = self.ins().umin(difference, largest);
        if ty == Type::I64 {
            bounded
        } else {
            self.ins().ireduce(types::I32, bounded)
        }
    }
}
