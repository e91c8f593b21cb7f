//! Tests for what a language calls an error, under the policy of the options.
//!
//! With `trap` the scan is abandoned, with the place of the expression as the origin. With
//! `continue` a bit of the status is set and the total value of the IR counts: a bad index reads as 0
//! and stores nothing, a quotient by 0 is 0, a value outside its subrange becomes the nearer limit.

use super::Unit;
use crate::{OnFault, values};
use iecc_ir::{FaultCode, Index, Place, Root, Type, Value};
use iecc_sema::hir::{CompareOp, Elementary};
use iecc_source::Span;

impl Unit<'_, '_> {
    pub(super) fn traps(&self) -> bool {
        self.lowering.options.on_fault == OnFault::Trap
    }

    /// Goes on where `sound` is 1. Elsewhere faults, or sets the status and goes on.
    pub(super) fn check(&mut self, sound: Value, fault: FaultCode, span: Span) {
        let (failed, behind) = (self.builder.create_block(), self.builder.create_block());
        self.builder.brif(sound, behind, failed);
        self.go_on(failed);
        self.fail(fault, span);
        self.jump(behind);
        self.go_on(behind);
    }

    /// Faults, or sets the status and goes on.
    pub(super) fn fail(&mut self, fault: FaultCode, span: Span) {
        let back = self.origin;
        self.at(span);
        if self.traps() {
            self.builder.fault(fault);
        } else {
            let field = self
                .lowering
                .status
                .expect("is there where faults do not stop");
            let bit = Index::Const(u32::from(fault.number()) - 1);
            let set = self.builder.constant(Type::I1, 1);
            let place = Place::root(Root::State).field(field).bit(bit);
            self.builder.store(place, set);
        }
        self.origin = back;
        self.builder.set_origin(back);
    }

    /// Faults where an integer is 0, or sets the status. Gives what was tested.
    pub(super) fn check_not_zero(&mut self, value: Value, fault: FaultCode, span: Span) -> Value {
        let zero = self.builder.constant(self.builder.value_type(value), 0);
        let sound = self.builder.compare(iecc_ir::CompareOp::Ne, value, zero);
        self.check(sound, fault, span);
        sound
    }

    /// The value if it lies between two numbers of its type, else a fault or the nearer limit.
    pub(super) fn within(
        &mut self,
        value: Value,
        ty: Elementary,
        (low, high): (u64, u64),
        span: Span,
    ) -> Value {
        let value = self.limit(value, ty, CompareOp::GreaterEqual, low, span);
        self.limit(value, ty, CompareOp::LessEqual, high, span)
    }

    /// One side of `within`; nothing is to be tested at the end of the type.
    fn limit(
        &mut self,
        value: Value,
        ty: Elementary,
        op: CompareOp,
        limit: u64,
        span: Span,
    ) -> Value {
        let ir = self.builder.value_type(value);
        let sign = u64::from(ty.is_signed()) << (ir.bits() - 1);
        let end = match op {
            CompareOp::GreaterEqual => sign,
            CompareOp::LessEqual => ir.mask() ^ sign,
            CompareOp::Equal | CompareOp::NotEqual | CompareOp::Greater | CompareOp::Less => {
                panic!("limits are inclusive")
            }
        };
        if limit & ir.mask() == end {
            return value;
        }
        let limit = self.builder.constant(ir, limit);
        let sound = values::compare(&mut self.builder, op, ty, value, limit);
        self.check(sound, FaultCode::Range, span);
        if self.traps() {
            value
        } else {
            self.builder.select(sound, value, limit)
        }
    }
}
