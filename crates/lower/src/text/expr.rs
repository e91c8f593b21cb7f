//! Expressions to values: operands strictly from left to right, each once.

use super::Unit;
use super::convert::{convert, resize};
use crate::MILLISECOND_NS;
use crate::types::{result_types, scalar};
use crate::values;
use iecc_ir::{
    BinaryOp as Ir, CompareOp as IrCompare, FaultCode, FuncId, Place, Root, Type,
    UnaryOp as IrUnary, Value,
};
use iecc_sema::hir::code::{BinaryOp, CallId, Expr, ExprId, ExprKind, UnaryOp};
use iecc_sema::hir::{Arithmetic, CompareOp, Elementary};

impl<'p> Unit<'_, 'p> {
    /// The value of an expression here.
    pub(super) fn expr(&mut self, id: ExprId) -> Value {
        let code = self.code;
        let expr = code.expr(id);
        let ty = scalar(expr.ty);
        match &expr.kind {
            ExprKind::Const(bits) => self.builder.constant(ty, *bits),
            ExprKind::Load(path) => {
                let at = self.locate(*path);
                self.take(at)
            }
            ExprKind::Unary(op, arg) => {
                let value = self.expr(*arg);
                self.unary(*op, expr.ty, value)
            }
            ExprKind::Binary(op, left, right) => self.binary(*op, expr, *left, *right),
            ExprKind::Compare(op, left, right) => self.compare(*op, *left, *right),
            ExprKind::Convert(conversion, arg) => {
                let value = self.expr(*arg);
                let from = code.expr(*arg).ty;
                convert(&mut self.builder, *conversion, value, from, expr.ty)
            }
            ExprKind::Select(cond, yes, no) => {
                let (cond, yes, no) = (self.expr(*cond), self.expr(*yes), self.expr(*no));
                self.builder.select(cond, yes, no)
            }
            ExprKind::Choose(cond, yes, no) => self.choose(ty, *cond, *yes, *no),
            ExprKind::Within { value, low, high } => {
                let value = self.expr(*value);
                self.within(value, expr.ty, (*low, *high), expr.span)
            }
            ExprKind::Call(call) => self.call(*call).expect("the callee gives a value"),
            ExprKind::After(block, value) => {
                self.block(block);
                self.revive();
                self.expr(*value)
            }
            ExprKind::Address(path) => {
                let place = self.memory(*path);
                self.address_of(place)
            }
            ExprKind::Exists(path) => self.exists(*path),
            ExprKind::Now => self.builder.now(),
            ExprKind::Elapsed(path) => {
                let place = self.memory(*path);
                self.builder.elapsed(place, 1, Type::I64)
            }
            ExprKind::ElapsedUnits(path) => {
                let place = self.memory(*path);
                self.builder.elapsed(place, MILLISECOND_NS, Type::I32)
            }
        }
    }

    /// Evaluates for the effects alone; what is called need not give a value.
    pub(super) fn effects(&mut self, id: ExprId) {
        let code = self.code;
        match &code.expr(id).kind {
            ExprKind::Call(call) => {
                self.call(*call);
            }
            ExprKind::After(block, value) => {
                self.block(block);
                if self.builder.is_open() {
                    self.effects(*value);
                }
            }
            ExprKind::Const(_)
            | ExprKind::Load(_)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Compare(..)
            | ExprKind::Convert(..)
            | ExprKind::Select(..)
            | ExprKind::Choose(..)
            | ExprKind::Within { .. }
            | ExprKind::Address(_)
            | ExprKind::Exists(_)
            | ExprKind::Now
            | ExprKind::Elapsed(_)
            | ExprKind::ElapsedUnits(_) => {
                self.expr(id);
            }
        }
    }

    /// The number of an expression that is a constant of an integer type.
    pub(super) fn integer(&self, id: ExprId) -> Option<i128> {
        let expr = self.code.expr(id);
        if let ExprKind::Const(bits) = expr.kind
            && !expr.ty.is_float()
        {
            Some(number(expr.ty, bits))
        } else {
            None
        }
    }

    /// Goes on behind statements that leave, in a block that is not reached.
    fn revive(&mut self) {
        if !self.builder.is_open() {
            let block = self.builder.create_block();
            self.go_on(block);
        }
    }

    fn unary(&mut self, op: UnaryOp, ty: Elementary, value: Value) -> Value {
        match op {
            UnaryOp::Negate => values::negate(&mut self.builder, ty, value),
            UnaryOp::Not => self.builder.unary(IrUnary::Not, value),
            UnaryOp::Absolute => values::absolute(&mut self.builder, ty, value),
            UnaryOp::SquareRoot => self.builder.unary(IrUnary::Fsqrt, value),
        }
    }

    fn binary(&mut self, op: BinaryOp, expr: &Expr, left: ExprId, right: ExprId) -> Value {
        let (a, b) = (self.expr(left), self.expr(right));
        let arithmetic =
            |unit: &mut Self, op| values::arithmetic(&mut unit.builder, op, expr.ty, a, b);
        match op {
            BinaryOp::Add => arithmetic(self, Arithmetic::Add),
            BinaryOp::Subtract => arithmetic(self, Arithmetic::Subtract),
            BinaryOp::Multiply => arithmetic(self, Arithmetic::Multiply),
            BinaryOp::Divide => {
                if !expr.ty.is_float() && self.may_be_zero(right) {
                    self.check_not_zero(b, FaultCode::Divide, expr.span);
                }
                arithmetic(self, Arithmetic::Divide)
            }
            BinaryOp::DivideUnchecked => arithmetic(self, Arithmetic::Divide),
            BinaryOp::Modulo => {
                let rest = arithmetic(self, Arithmetic::Modulo);
                if expr.ty.is_float() || !self.may_be_zero(right) {
                    return rest;
                }
                let zero = self.builder.constant(scalar(expr.ty), 0);
                let sound = self.builder.compare(IrCompare::Ne, b, zero);
                self.builder.select(sound, rest, zero)
            }
            BinaryOp::And => self.builder.binary(Ir::And, a, b),
            BinaryOp::Or => self.builder.binary(Ir::Or, a, b),
            BinaryOp::Xor => self.builder.binary(Ir::Xor, a, b),
            BinaryOp::ShiftLeft => self.shift(Ir::Shl, a, b),
            BinaryOp::ShiftRight => self.shift(Ir::Ushr, a, b),
        }
    }

    fn may_be_zero(&self, divisor: ExprId) -> bool {
        self.integer(divisor).is_none_or(|number| number == 0)
    }

    /// The count is a `UDINT`. Shifting in the wider of both types and cutting gives 0 from the width
    /// on, as the shifts of the IR do in their own.
    fn shift(&mut self, op: Ir, value: Value, count: Value) -> Value {
        let ty = self.builder.value_type(value);
        let wide = if ty == Type::I64 {
            Type::I64
        } else {
            Type::I32
        };
        let (value, count) = (
            resize(&mut self.builder, value, wide),
            resize(&mut self.builder, count, wide),
        );
        let shifted = self.builder.binary(op, value, count);
        resize(&mut self.builder, shifted, ty)
    }

    fn compare(&mut self, op: CompareOp, left: ExprId, right: ExprId) -> Value {
        let ty = self.code.expr(left).ty;
        let (a, b) = (self.expr(left), self.expr(right));
        if ty != Elementary::Bool {
            return values::compare(&mut self.builder, op, ty, a, b);
        }
        // Bits have no order in the IR.
        match op {
            CompareOp::Equal => self.builder.compare(IrCompare::Eq, a, b),
            CompareOp::NotEqual => self.builder.compare(IrCompare::Ne, a, b),
            CompareOp::Greater => self.and_not(a, b),
            CompareOp::Less => self.and_not(b, a),
            CompareOp::LessEqual => {
                let greater = self.and_not(a, b);
                self.builder.unary(IrUnary::Not, greater)
            }
            CompareOp::GreaterEqual => {
                let less = self.and_not(b, a);
                self.builder.unary(IrUnary::Not, less)
            }
        }
    }

    fn and_not(&mut self, a: Value, b: Value) -> Value {
        let inverted = self.builder.unary(IrUnary::Not, b);
        self.builder.binary(Ir::And, a, inverted)
    }

    fn choose(&mut self, ty: Type, cond: ExprId, yes: ExprId, no: ExprId) -> Value {
        let chosen = self.builder.declare(ty);
        let cond = self.expr(cond);
        let (then, otherwise) = (self.builder.create_block(), self.builder.create_block());
        let behind = self.builder.create_block();
        self.builder.brif(cond, then, otherwise);
        for (block, value) in [(then, yes), (otherwise, no)] {
            self.go_on(block);
            let value = self.expr(value);
            self.builder.assign(chosen, value);
            self.builder.jump(behind);
        }
        self.go_on(behind);
        self.builder.read(chosen)
    }

    /// Nothing outlives what is local, so that has no address.
    pub(super) fn address_of(&mut self, place: Place) -> Value {
        match place.root {
            Root::Local(_) => self.builder.constant(Type::I64, 0),
            Root::State | Root::Ref(_) | Root::Deref { .. } => self.builder.address(place),
            Root::Input | Root::Output => panic!("bodies do not reach public points"),
        }
    }

    /// Calls and stores the results that go somewhere; gives the first.
    pub(super) fn call(&mut self, id: CallId) -> Option<Value> {
        let code = self.code;
        let call = code.call(id);
        let refs = call.refs.iter().map(|path| self.memory(*path)).collect();
        let args = call.args.iter().map(|arg| self.expr(*arg)).collect();
        let types = result_types(self.program.pou(call.callee));
        let func = FuncId::from_u32(call.callee.index() as u32);
        let results = self.builder.call(func, refs, args, &types);
        for &(position, path) in &call.outputs {
            let at = self.locate(path);
            self.put(at, results[position as usize]);
        }
        results.first().copied()
    }
}

/// The number that bits stand for in an integer type.
pub(super) fn number(ty: Elementary, bits: u64) -> i128 {
    let ir = scalar(ty);
    if ty.is_signed() {
        i128::from(ir.signed(bits))
    } else {
        i128::from(bits & ir.mask())
    }
}
