//! Loops.
//!
//! FOR tests before the first pass and then behind each pass, so that a pass costs one test. What is
//! tested behind a pass is exact in the width of the variable, also where the loop ends at the last
//! number of its type: whether the next value is still inside where it cannot wrap, else how
//! much is left to the end. The variable is stored at the start of each pass, and once behind the
//! last; the loop counts apart from it.
//!
//! WHILE and REPEAT count their passes; one above the limit of the options is a fault, at which they
//! end where faults do not stop. A FOR that would take more passes does not begin: the variable has
//! its first value then.

use super::expr::number;
use super::place::Located;
use super::{Loop, Unit};
use crate::types::scalar;
use crate::values;
use iecc_ir::{
    BinaryOp, Block as IrBlock, CompareOp as IrCompare, FaultCode, Type, UnaryOp, Value, Variable,
};
use iecc_sema::hir::code::{Block, ExprId, PathId};
use iecc_sema::hir::{CompareOp, Elementary};
use iecc_source::Span;

/// A FOR whose operands are evaluated.
#[derive(Debug, Clone, Copy)]
struct Count {
    ty: Elementary,
    from: Value,
    to: Value,
    /// Added behind each pass, wrapping.
    by: Value,
    step: Step,
    /// The operands as far as they are constants.
    known: [Option<i128>; 2],
}

/// The direction of a FOR and the size of its step.
#[derive(Debug, Clone, Copy)]
enum Step {
    Up(u128),
    Down(u128),
    /// Whether upwards, and the size as an unsigned number.
    Dynamic(Value, Value),
}

impl<'p> Unit<'_, 'p> {
    pub(super) fn count(
        &mut self,
        variable: PathId,
        operands: [ExprId; 3],
        body: &'p Block,
        span: Span,
    ) {
        let [from, to, by] = operands.map(|operand| self.expr(operand));
        let variable = self.locate(variable);
        let ty = self.code.expr(operands[0]).ty;
        let count = Count {
            ty,
            from,
            to,
            by,
            step: self.step_of(operands[2], by),
            known: [self.integer(operands[0]), self.integer(operands[1])],
        };
        self.write(&variable, from);
        let behind = self.builder.create_block();
        self.guard(&count, behind, span);
        self.passes(&count, &variable, body, behind);
        self.go_on(behind);
    }

    fn step_of(&mut self, by: ExprId, value: Value) -> Step {
        let ty = self.code.expr(by).ty;
        match self.integer(by) {
            Some(number) if number > 0 => Step::Up(number.unsigned_abs()),
            Some(number) if number < 0 => Step::Down(number.unsigned_abs()),
            Some(_) | None => {
                let zero = self.builder.constant(scalar(ty), 0);
                let up = values::compare(&mut self.builder, CompareOp::Greater, ty, value, zero);
                let minus = self.builder.unary(UnaryOp::Neg, value);
                Step::Dynamic(up, self.builder.select(up, value, minus))
            }
        }
    }

    /// Goes on where there are passes, and to `behind` where there are none.
    fn guard(&mut self, count: &Count, behind: IrBlock, span: Span) {
        if let Step::Dynamic(_, size) = count.step {
            let zero = self.builder.constant(scalar(count.ty), 0);
            let moves = self.builder.compare(IrCompare::Ne, size, zero);
            self.leave_unless(moves, behind, FaultCode::Range, span);
        }
        let some = self.not_beyond(count, count.from);
        let enter = self.builder.create_block();
        self.builder.brif(some, enter, behind);
        self.go_on(enter);
        if let Some(few) = self.few(count) {
            self.leave_unless(few, behind, FaultCode::Bound, span);
        }
    }

    /// Whether a value is not beyond the last.
    fn not_beyond(&mut self, count: &Count, value: Value) -> Value {
        let mut compare = |op| values::compare(&mut self.builder, op, count.ty, value, count.to);
        match count.step {
            Step::Up(_) => compare(CompareOp::LessEqual),
            Step::Down(_) => compare(CompareOp::GreaterEqual),
            Step::Dynamic(up, _) => {
                let below = compare(CompareOp::LessEqual);
                let above = compare(CompareOp::GreaterEqual);
                self.builder.select(up, below, above)
            }
        }
    }

    /// How far it is from a value, which is inside, to the last; unsigned.
    fn distance(&mut self, count: &Count, value: Value) -> Value {
        let mut subtract = |a, b| self.builder.binary(BinaryOp::Sub, a, b);
        match count.step {
            Step::Up(_) => subtract(count.to, value),
            Step::Down(_) => subtract(value, count.to),
            Step::Dynamic(up, _) => {
                let (above, below) = (subtract(count.to, value), subtract(value, count.to));
                self.builder.select(up, above, below)
            }
        }
    }

    /// Whether the passes are not more than the limit, unless that is certain: passes less one are
    /// the distance by the step.
    fn few(&mut self, count: &Count) -> Option<Value> {
        let ty = scalar(count.ty);
        let limit = u128::from(self.lowering.options.loop_limit);
        let most = match count.known {
            [Some(from), Some(to)] => (to - from).unsigned_abs(),
            [_, _] => u128::from(ty.mask()),
        };
        let size = match count.step {
            Step::Up(size) | Step::Down(size) => size,
            Step::Dynamic(..) => 1,
        };
        let bound = limit.saturating_mul(size);
        if most < bound {
            return None;
        }
        let distance = self.distance(count, count.from);
        let distance = match count.step {
            Step::Up(_) | Step::Down(_) => distance,
            Step::Dynamic(_, size) => self.builder.binary(BinaryOp::Udiv, distance, size),
        };
        let bound = self.builder.constant(ty, bound as u64);
        Some(self.builder.compare(IrCompare::Ult, distance, bound))
    }

    fn passes(&mut self, count: &Count, variable: &Located, body: &'p Block, behind: IrBlock) {
        let counter = self.builder.declare(scalar(count.ty));
        self.builder.assign(counter, count.from);
        let pass = self.builder.create_block();
        self.builder.jump(pass);
        self.builder.switch_to(pass);
        let value = self.builder.read(counter);
        self.write(variable, value);
        let next = self.builder.create_block();
        self.body(body, Loop { behind, next });
        self.jump(next);
        self.go_on(next);
        let (again, following) = self.advance(count, value);
        self.builder.assign(counter, following);
        let done = self.builder.create_block();
        self.builder.brif(again, pass, done);
        self.builder.seal(pass);
        self.go_on(done);
        self.write(variable, following);
        self.builder.jump(behind);
    }

    /// Behind a pass: whether there is another one, and the next value.
    fn advance(&mut self, count: &Count, value: Value) -> (Value, Value) {
        let following = self.builder.binary(BinaryOp::Add, value, count.by);
        let size = match count.step {
            Step::Up(_) | Step::Down(_) if self.never_wraps(count) => {
                return (self.not_beyond(count, following), following);
            }
            Step::Up(1) | Step::Down(1) => {
                let again = self.builder.compare(IrCompare::Ne, value, count.to);
                return (again, following);
            }
            Step::Up(size) | Step::Down(size) => {
                self.builder.constant(scalar(count.ty), size as u64)
            }
            Step::Dynamic(_, size) => size,
        };
        let distance = self.distance(count, value);
        let again = self.builder.compare(IrCompare::Uge, distance, size);
        (again, following)
    }

    /// Whether the first value that is not passed is a number of the type.
    fn never_wraps(&self, count: &Count) -> bool {
        let ([_, Some(to)], mask) = (count.known, scalar(count.ty).mask()) else {
            return false;
        };
        let sign = u64::from(count.ty.is_signed()) << (count.ty.bits() - 1);
        let beyond = match count.step {
            Step::Up(size) => to + size as i128,
            Step::Down(size) => to - size as i128,
            Step::Dynamic(..) => return false,
        };
        (number(count.ty, sign)..=number(count.ty, mask ^ sign)).contains(&beyond)
    }

    fn body(&mut self, body: &'p Block, around: Loop) {
        self.loops.push(around);
        self.block(body);
        self.loops.pop();
    }

    pub(super) fn repeat_while(&mut self, condition: ExprId, body: &'p Block, span: Span) {
        let left = self.passes_left();
        let (next, behind) = (self.builder.create_block(), self.builder.create_block());
        self.builder.jump(next);
        self.builder.switch_to(next);
        let condition = self.expr(condition);
        let pass = self.builder.create_block();
        self.builder.brif(condition, pass, behind);
        self.go_on(pass);
        self.count_pass(left, behind, span);
        self.body(body, Loop { behind, next });
        self.jump(next);
        self.builder.seal(next);
        self.go_on(behind);
    }

    pub(super) fn repeat_until(&mut self, body: &'p Block, condition: ExprId, span: Span) {
        let left = self.passes_left();
        let (pass, behind) = (self.builder.create_block(), self.builder.create_block());
        self.builder.jump(pass);
        self.builder.switch_to(pass);
        self.count_pass(left, behind, span);
        let next = self.builder.create_block();
        self.body(body, Loop { behind, next });
        self.jump(next);
        self.go_on(next);
        let condition = self.expr(condition);
        self.builder.brif(condition, behind, pass);
        self.builder.seal(pass);
        self.go_on(behind);
    }

    /// How many passes a loop may still take.
    fn passes_left(&mut self) -> Variable {
        let limit = self.lowering.options.loop_limit;
        let ty = if u32::try_from(limit).is_ok() {
            Type::I32
        } else {
            Type::I64
        };
        let left = self.builder.declare(ty);
        let limit = self.builder.constant(ty, limit);
        self.builder.assign(left, limit);
        left
    }

    fn count_pass(&mut self, left: Variable, behind: IrBlock, span: Span) {
        let value = self.builder.read(left);
        let ty = self.builder.value_type(value);
        let zero = self.builder.constant(ty, 0);
        let some = self.builder.compare(IrCompare::Ne, value, zero);
        self.leave_unless(some, behind, FaultCode::Bound, span);
        let one = self.builder.constant(ty, 1);
        let less = self.builder.binary(BinaryOp::Sub, value, one);
        self.builder.assign(left, less);
    }

    /// Goes on where `sound` is 1. Elsewhere faults, or sets the status and leaves the loop.
    fn leave_unless(&mut self, sound: Value, behind: IrBlock, fault: FaultCode, span: Span) {
        let (failed, enter) = (self.builder.create_block(), self.builder.create_block());
        self.builder.brif(sound, enter, failed);
        self.go_on(failed);
        self.fail(fault, span);
        self.jump(behind);
        self.go_on(enter);
    }
}
