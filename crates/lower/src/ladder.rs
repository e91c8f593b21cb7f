//! Routines in ladder.
//!
//! The condition is an SSA value. What changes memory under the condition with plain bits is written
//! as bit arithmetic, everything else in a block of its own that is left out when false.

use crate::types::{elementary, place, result_types, scalar};
use crate::values::{self, Extend};
use crate::{Lowering, MILLISECOND_NS};
use iecc_ir::{
    BinaryOp, FaultCode, FuncId, Function, FunctionBuilder, Place, Type, UnaryOp, Value,
};
use iecc_sema::hir::{
    self, Action, Arithmetic, CoilKind, CompareOp, Computation, Condition, Element, Elementary,
    Instruction, Op, Operand, Pou, Rung, TimerKind, Unary,
};

/// The function of a routine. Its parameters are the values that a call passes; its results, if it
/// gives any, are whether a RET gave them, and the values.
pub(crate) fn unit(lowering: &mut Lowering<'_>, pou: &Pou, rungs: &[Rung]) -> Function {
    let params: Vec<Type> = pou
        .parameters
        .iter()
        .map(|parameter| scalar(elementary(lowering.program.type_of(parameter))))
        .collect();
    let mut unit = Unit {
        builder: FunctionBuilder::new(pou.name.clone(), &params, &result_types(pou)),
        lowering,
        pou,
        label: String::new(),
    };
    unit.take_parameters();
    rungs.iter().for_each(|rung| unit.rung(rung));
    unit.leave(false, &[]);
    unit.builder.finish()
}

struct Unit<'l, 'p> {
    lowering: &'l mut Lowering<'p>,
    builder: FunctionBuilder,
    pou: &'l Pou,
    /// Of the rung being lowered.
    label: String,
}

impl Unit<'_, '_> {
    fn take_parameters(&mut self) {
        for (index, parameter) in self.pou.parameters.iter().enumerate() {
            let value = self.builder.param(index);
            self.builder.store(place(parameter), value);
        }
    }

    fn rung(&mut self, rung: &hir::Rung) {
        self.label = format!("{} rung {}", self.pou.name, rung.number);
        let origin = self.lowering.origin(&self.label, Some(rung.span));
        self.builder.set_origin(Some(origin));
        let condition = self.bit(true);
        self.series(condition, &rung.elements);
    }

    /// Lowers a series and gives the condition behind it. Depth is bounded by the reader.
    fn series(&mut self, mut condition: Value, elements: &[Element]) -> Value {
        for element in elements {
            condition = match element {
                Element::Instruction(instruction) => self.instruction(condition, instruction),
                Element::Branch(legs) => self.branch(condition, legs),
            };
        }
        condition
    }

    fn branch(&mut self, condition: Value, legs: &[Vec<Element>]) -> Value {
        let mut result: Option<Value> = None;
        for leg in legs {
            let behind = self.series(condition, leg);
            result = Some(match result {
                Some(others) => self.builder.binary(BinaryOp::Or, others, behind),
                None => behind,
            });
        }
        result.unwrap_or(condition)
    }

    fn instruction(&mut self, condition: Value, instruction: &Instruction) -> Value {
        let label = std::mem::take(&mut self.label);
        let origin = self.lowering.origin(&label, Some(instruction.span));
        self.label = label;
        self.builder.set_origin(Some(origin));
        match &instruction.op {
            Op::Condition(made) => self.condition(condition, made),
            Op::Action(action) => {
                self.action(condition, action);
                condition
            }
        }
    }

    fn condition(&mut self, condition: Value, made: &Condition) -> Value {
        let holds = match made {
            Condition::Contact {
                bit,
                normally_closed,
            } => self.contact(bit, *normally_closed),
            Condition::OneShot { storage } => return self.one_shot(condition, storage),
            Condition::Compare { op, ty, operands } => {
                let [left, right] = self.operands(operands, *ty, Extend::Sign);
                values::compare(&mut self.builder, *op, *ty, left, right)
            }
            Condition::Limit { ty, operands } => self.limit(*ty, operands),
            Condition::MaskedEqual { ty, operands } => self.masked_equal(*ty, operands),
            Condition::AlwaysFalse => return self.bit(false),
            Condition::Subroutine | Condition::Nothing => return condition,
        };
        self.and(condition, holds)
    }

    fn action(&mut self, condition: Value, action: &Action) {
        match action {
            Action::Coil { bit, kind } => self.coil(condition, bit, *kind),
            Action::Edge {
                storage,
                output,
                falling,
            } => self.edge(condition, storage, output, *falling),
            Action::Timer { kind, timer } => self.timer(condition, *kind, timer),
            Action::Counter { kind, counter } => {
                self.stdlib_call(kind.function(), counter, condition);
            }
            Action::Reset { kind, structure } => {
                self.stdlib_call(kind.function(), structure, condition);
            }
            Action::Compute(computation) => self.when(condition, |unit| unit.compute(computation)),
            Action::Call {
                pou,
                inputs,
                returns,
            } => self.when(condition, |unit| unit.call(*pou, inputs, returns)),
            Action::Return(values) => self.return_when(condition, values),
        }
    }

    // ---- bits ----

    fn bit(&mut self, value: bool) -> Value {
        self.builder.constant(Type::I1, u64::from(value))
    }

    fn load_bit(&mut self, bit: &hir::Place) -> Value {
        self.builder.load(place(bit), Type::I1)
    }

    fn not(&mut self, value: Value) -> Value {
        self.builder.unary(UnaryOp::Not, value)
    }

    fn and(&mut self, left: Value, right: Value) -> Value {
        self.builder.binary(BinaryOp::And, left, right)
    }

    fn contact(&mut self, bit: &hir::Place, normally_closed: bool) -> Value {
        let value = self.load_bit(bit);
        if normally_closed {
            self.not(value)
        } else {
            value
        }
    }

    fn coil(&mut self, condition: Value, bit: &hir::Place, kind: CoilKind) {
        let value = match kind {
            CoilKind::Energize => condition,
            CoilKind::Latch => {
                let old = self.load_bit(bit);
                self.builder.binary(BinaryOp::Or, old, condition)
            }
            CoilKind::Unlatch => {
                let (old, released) = (self.load_bit(bit), self.not(condition));
                self.and(old, released)
            }
        };
        self.builder.store(place(bit), value);
    }

    fn one_shot(&mut self, condition: Value, storage: &hir::Place) -> Value {
        let old = self.load_bit(storage);
        self.builder.store(place(storage), condition);
        let fresh = self.not(old);
        self.and(condition, fresh)
    }

    fn edge(&mut self, condition: Value, storage: &hir::Place, output: &hir::Place, falling: bool) {
        let old = self.load_bit(storage);
        let edge = if falling {
            let released = self.not(condition);
            self.and(released, old)
        } else {
            let fresh = self.not(old);
            self.and(condition, fresh)
        };
        self.builder.store(place(storage), condition);
        self.builder.store(place(output), edge);
    }

    // ---- library ----

    fn stdlib_call(&mut self, name: &str, structure: &hir::Place, condition: Value) {
        let func = self.lowering.stdlib_function(name, MILLISECOND_NS);
        self.call_library(func, structure, condition);
    }

    fn call_library(&mut self, func: FuncId, structure: &hir::Place, condition: Value) {
        self.builder
            .call(func, vec![place(structure)], vec![condition], &[]);
    }

    fn timer(&mut self, condition: Value, kind: TimerKind, timer: &hir::Place) {
        let unit_ns = self.lowering.timer_unit_ns(timer);
        let func = self.lowering.stdlib_function(kind.function(), unit_ns);
        self.call_library(func, timer, condition);
    }

    // ---- numbers ----

    fn operand(&mut self, operand: &Operand, ty: Elementary, extend: Extend) -> Value {
        match operand {
            Operand::Const(constant) => values::constant(&mut self.builder, *constant, ty),
            Operand::Place(from, own) => {
                let value = self.builder.load(place(from), scalar(*own));
                values::convert(&mut self.builder, value, *own, ty, extend)
            }
        }
    }

    fn operands<const N: usize>(
        &mut self,
        operands: &[Operand; N],
        ty: Elementary,
        extend: Extend,
    ) -> [Value; N] {
        std::array::from_fn(|index| self.operand(&operands[index], ty, extend))
    }

    /// Low <= High: inside the band; Low > High: outside it, limits included. A NaN is in neither.
    fn limit(&mut self, ty: Elementary, operands: &[Operand; 3]) -> Value {
        let [low, test, high] = self.operands(operands, ty, Extend::Sign);
        let builder = &mut self.builder;
        let ordered = values::compare(builder, CompareOp::LessEqual, ty, low, high);
        let reversed = values::compare(builder, CompareOp::Greater, ty, low, high);
        let above = values::compare(builder, CompareOp::GreaterEqual, ty, test, low);
        let below = values::compare(builder, CompareOp::LessEqual, ty, test, high);
        let both = builder.binary(BinaryOp::And, above, below);
        let either = builder.binary(BinaryOp::Or, above, below);
        let inside = builder.binary(BinaryOp::And, ordered, both);
        let outside = builder.binary(BinaryOp::And, reversed, either);
        builder.binary(BinaryOp::Or, inside, outside)
    }

    fn masked_equal(&mut self, ty: Elementary, operands: &[Operand; 3]) -> Value {
        let [source, mask, compare] = self.operands(operands, ty, Extend::Zero);
        let source = self.and(source, mask);
        let compare = self.and(compare, mask);
        values::compare(&mut self.builder, CompareOp::Equal, ty, source, compare)
    }

    fn compute(&mut self, computation: &Computation) {
        match computation {
            Computation::Unary {
                op,
                ty,
                source,
                destination,
            } => self.unary_to(*op, *ty, source, destination),
            Computation::Arithmetic {
                op,
                ty,
                operands,
                destination,
            } => self.arithmetic(*op, *ty, operands, destination),
            Computation::Logical {
                op,
                ty,
                operands,
                destination,
            } => {
                let [left, right] = self.operands(operands, *ty, Extend::Zero);
                let value = self.builder.binary(values::logical(*op), left, right);
                self.assign(value, *ty, destination);
            }
            Computation::Clear { destination } => {
                let zero = self.builder.constant(scalar(destination.1), 0);
                self.builder.store(place(&destination.0), zero);
            }
        }
    }

    fn unary_to(
        &mut self,
        op: Unary,
        ty: Elementary,
        source: &Operand,
        destination: &(hir::Place, Elementary),
    ) {
        // A move converts from type to type, without the detour over the computing type.
        let (ty, extend) = match op {
            Unary::Move => (source.ty(), Extend::Sign),
            Unary::Not => (ty, Extend::Zero),
            Unary::Negate | Unary::Absolute => (ty, Extend::Sign),
        };
        let value = self.operand(source, ty, extend);
        let value = self.unary(op, ty, value);
        self.assign(value, ty, destination);
    }

    fn unary(&mut self, op: Unary, ty: Elementary, value: Value) -> Value {
        match op {
            Unary::Move => value,
            Unary::Negate => values::negate(&mut self.builder, ty, value),
            Unary::Absolute => values::absolute(&mut self.builder, ty, value),
            Unary::Not => self.not(value),
        }
    }

    fn assign(&mut self, value: Value, ty: Elementary, destination: &(hir::Place, Elementary)) {
        let (to, to_ty) = destination;
        let value = values::convert(&mut self.builder, value, ty, *to_ty, Extend::Sign);
        self.builder.store(place(to), value);
    }

    /// Integer division by zero keeps the destination.
    fn arithmetic(
        &mut self,
        op: Arithmetic,
        ty: Elementary,
        operands: &[Operand; 2],
        destination: &(hir::Place, Elementary),
    ) {
        let [left, right] = self.operands(operands, ty, Extend::Sign);
        let divides = match op {
            Arithmetic::Divide | Arithmetic::Modulo => !ty.is_float(),
            Arithmetic::Add | Arithmetic::Subtract | Arithmetic::Multiply => false,
        };
        let value = values::arithmetic(&mut self.builder, op, ty, left, right);
        if divides {
            let zero = self.builder.constant(scalar(ty), 0);
            let sound = values::compare(&mut self.builder, CompareOp::NotEqual, ty, right, zero);
            self.when(sound, |unit| unit.assign(value, ty, destination));
        } else {
            self.assign(value, ty, destination);
        }
    }

    // ---- control ----

    /// Builds what happens only when the condition is true.
    fn when(&mut self, condition: Value, build: impl FnOnce(&mut Self)) {
        let (then, behind) = (self.builder.create_block(), self.builder.create_block());
        self.builder.brif(condition, then, behind);
        self.builder.seal(then);
        self.builder.switch_to(then);
        build(self);
        self.builder.jump(behind);
        self.builder.seal(behind);
        self.builder.switch_to(behind);
    }

    /// Inputs are read before the call and results written after it, both in their order. Results
    /// that are expected but were not given are a major fault of the controller.
    fn call(&mut self, pou: hir::PouId, inputs: &[Operand], returns: &[(hir::Place, Elementary)]) {
        let callee = self.lowering.program.pou(pou);
        let arguments: Vec<Value> = inputs
            .iter()
            .zip(&callee.parameters)
            .map(|(input, parameter)| self.argument(input, parameter))
            .collect();
        let func = FuncId::from_u32(pou.index() as u32);
        let values = self
            .builder
            .call(func, Vec::new(), arguments, &result_types(callee));
        let Some((&given, values)) = values.split_first().filter(|_| !returns.is_empty()) else {
            return;
        };
        self.fault_unless(given, FaultCode::Call);
        for ((value, ty), destination) in values.iter().zip(&callee.results).zip(returns) {
            self.assign(*value, *ty, destination);
        }
    }

    fn argument(&mut self, input: &Operand, parameter: &hir::Place) -> Value {
        let ty = elementary(self.lowering.program.type_of(parameter));
        self.operand(input, ty, Extend::Sign)
    }

    fn fault_unless(&mut self, condition: Value, fault: FaultCode) {
        let (sound, failed) = (self.builder.create_block(), self.builder.create_block());
        self.builder.brif(condition, sound, failed);
        self.builder.seal(failed);
        self.builder.switch_to(failed);
        self.builder.fault(fault);
        self.builder.seal(sound);
        self.builder.switch_to(sound);
    }

    fn return_when(&mut self, condition: Value, values: &[Operand]) {
        let (leave, stay) = (self.builder.create_block(), self.builder.create_block());
        self.builder.brif(condition, leave, stay);
        self.builder.seal(leave);
        self.builder.switch_to(leave);
        self.leave(!values.is_empty(), values);
        self.builder.seal(stay);
        self.builder.switch_to(stay);
    }

    /// Leaves the function; `given` says whether there are values.
    fn leave(&mut self, given: bool, values: &[Operand]) {
        let types = &self.pou.results;
        if types.is_empty() {
            return self.builder.ret(Vec::new());
        }
        let mut returned = vec![self.bit(given)];
        for (index, ty) in types.iter().enumerate() {
            returned.push(match values.get(index) {
                Some(value) => self.operand(value, *ty, Extend::Sign),
                None => self.builder.constant(scalar(*ty), 0),
            });
        }
        self.builder.ret(returned);
    }
}

/// Copies a place to another of the same type.
pub(crate) fn copy(builder: &mut FunctionBuilder, from: Place, to: Place, ty: Type) {
    let value = builder.load(from, ty);
    builder.store(to, value);
}
