//! Initial values of places, given while a program runs.
//!
//! What is left out of an initial value is 0, so a whole is cleared before its parts are stored. Long
//! runs of elements become loops.

use super::Unit;
use super::place::Located;
use crate::types::{self, scalar};
use iecc_ir::{BinaryOp, CompareOp, Index, Type, Value};
use iecc_sema::hir;
use iecc_sema::hir::code::{Init, InitId, Target};

/// Elements that are stored one by one.
const UNROLLED: u32 = 8;

impl Unit<'_, '_> {
    pub(super) fn initialise(&mut self, at: &Located, init: InitId) {
        match (at.ty, self.program.inits.get(init)) {
            (hir::Type::Elementary(_), _) => self.initial_value(at, init),
            (hir::Type::Struct(_) | hir::Type::Array(_), _) => {
                let place = at.in_memory().expect("structures and arrays lie in memory");
                self.builder.clear(place.clone());
                self.initial_parts(at, init);
            }
        }
    }

    fn initial_value(&mut self, at: &Located, init: InitId) {
        let bits = match self.program.inits.get(init) {
            Init::Zero => 0,
            Init::Bits(bits) => *bits,
            Init::Address(target) => {
                let value = self.initial_address(target);
                return self.write(at, value);
            }
            Init::Struct(_) | Init::Array(_) => panic!("the value is elementary"),
        };
        let value = self.builder.constant(self.stored_type(at), bits);
        self.write(at, value);
    }

    fn initial_address(&mut self, target: &Target) -> Value {
        match target {
            Target::Tag(place) => self.address_of(types::place(place)),
            Target::Around(id, steps) => {
                let ty = hir::Type::Struct(*id);
                let around = self.around.iter().rev().find(|at| at.ty == ty);
                let around = around.and_then(Located::in_memory);
                let place = around.expect("the value lies in the structure it refers to");
                self.address_of(place.clone().join(&types::steps(steps)))
            }
        }
    }

    /// Stores what is not 0 in a place that is. Recursion is bounded by the depth of types.
    fn initial_parts(&mut self, at: &Located, init: InitId) {
        match self.program.inits.get(init) {
            Init::Zero => {}
            Init::Bits(bits) => {
                if let hir::Type::Elementary(ty) = at.ty
                    && bits & scalar(ty).mask() != 0
                {
                    self.initial_value(at, init);
                }
            }
            Init::Address(_) => self.initial_value(at, init),
            Init::Struct(members) => {
                self.around.push(at.clone());
                for &(member, value) in members {
                    let mut part = at.clone();
                    part.enter_field(self.program, member);
                    self.initial_parts(&part, value);
                }
                self.around.pop();
            }
            Init::Array(runs) => {
                for &(first, count, value) in runs {
                    self.initial_run(at, (first, count), value);
                }
            }
        }
    }

    fn initial_run(&mut self, at: &Located, (first, count): (u32, u32), value: InitId) {
        if *self.program.inits.get(value) == Init::Zero {
            return;
        }
        if count > UNROLLED {
            return self.initial_loop(at, (first, count), value);
        }
        for index in first..first + count {
            let mut element = at.clone();
            element.enter_element(self.program, Index::Const(index));
            self.initial_parts(&element, value);
        }
    }

    fn initial_loop(&mut self, at: &Located, (first, count): (u32, u32), value: InitId) {
        let counter = self.builder.declare(Type::I32);
        let start = self.builder.constant(Type::I32, u64::from(first));
        self.builder.assign(counter, start);
        let pass = self.builder.create_block();
        self.builder.jump(pass);
        self.builder.switch_to(pass);
        let index = self.builder.read(counter);
        let mut element = at.clone();
        element.enter_element(self.program, Index::Value(index));
        self.initial_parts(&element, value);
        let one = self.builder.constant(Type::I32, 1);
        let next = self.builder.binary(BinaryOp::Add, index, one);
        self.builder.assign(counter, next);
        let end = self.builder.constant(Type::I32, u64::from(first + count));
        let again = self.builder.compare(CompareOp::Ne, next, end);
        let behind = self.builder.create_block();
        self.builder.brif(again, pass, behind);
        self.builder.seal(pass);
        self.go_on(behind);
    }
}
