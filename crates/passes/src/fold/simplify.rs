//! The walk that applies algebra to every instruction, and what the rules need to see and build.

use super::memory::{self, Access, Regions};
use super::{algebra, bits, choice, compare, constant, evaluate};
use crate::rewrite::Replacements;
use iecc_ir::analysis::Cfg;
use iecc_ir::{
    BinaryOp, Block, Function, Inst, InstData, Origin, Terminator, Type, TypeTable, UnaryOp, Value,
};

/// How often one instruction is rewritten in a row; every rule makes it simpler, so a few do.
const MAX_STEPS: usize = 16;

/// What a rule makes of an instruction.
pub(super) enum Step {
    /// No rule fits.
    Keep,
    /// The same result, computed otherwise.
    Data(InstData),
    /// The result is a value that exists.
    Same(Value),
}

/// Simplifies every instruction of a function. Says whether something changed.
pub(super) fn simplify(types: &TypeTable, regions: Regions, func: &mut Function) -> bool {
    let order = Cfg::new(func).reverse_postorder().to_vec();
    let mut rewriter = Rewriter {
        types,
        regions,
        func,
        replacements: Replacements::default(),
        out: Vec::new(),
        origin: None,
        changed: false,
    };
    for block in order {
        rewriter.block(block);
    }
    let Rewriter {
        replacements,
        changed,
        ..
    } = rewriter;
    replacements.apply(func) || changed
}

/// Sees the function with everything before the current instruction simplified.
pub(super) struct Rewriter<'f> {
    pub(super) types: &'f TypeTable,
    pub(super) regions: Regions,
    pub(super) func: &'f mut Function,
    replacements: Replacements,
    /// The instructions of the current block so far.
    out: Vec<Inst>,
    origin: Option<Origin>,
    changed: bool,
}

impl Rewriter<'_> {
    fn block(&mut self, block: Block) {
        for inst in std::mem::take(&mut self.func.block_mut(block).insts) {
            let replacements = &mut self.replacements;
            self.func
                .inst_mut(inst)
                .map_values(|v| replacements.find(v));
            self.origin = self.func.origin(inst);
            if self.func.inst(inst).is_pure() {
                self.pure(inst);
            } else {
                self.access(inst);
            }
        }
        self.func.block_mut(block).insts = std::mem::take(&mut self.out);
        self.terminator(block);
    }

    fn pure(&mut self, inst: Inst) {
        let (result, mut data) = (self.func.result(inst), self.func.inst(inst).clone());
        let mut rewritten = false;
        for _ in 0..MAX_STEPS {
            match self.step(&data) {
                Step::Keep => break,
                Step::Data(simpler) => (data, rewritten) = (simpler, true),
                Step::Same(value) => {
                    self.replacements.replace(result, value);
                    return;
                }
            }
        }
        if rewritten {
            *self.func.inst_mut(inst) = data;
            self.changed = true;
        }
        self.out.push(inst);
    }

    fn step(&mut self, data: &InstData) -> Step {
        if matches!(data, InstData::Const { .. }) {
            return Step::Keep;
        }
        if let Some(bits) = evaluate(self.func, data, |v| self.func.constant(v)) {
            return Step::Data(constant(self.result_type(data), bits));
        }
        match data {
            InstData::Unary { op, arg } => algebra::unary(self, *op, *arg),
            InstData::Binary { op, args } => algebra::binary(self, *op, *args),
            InstData::Compare { op, args } => compare::compare(self, *op, *args),
            InstData::Convert { op, to, arg } => bits::convert(self, *op, *to, *arg),
            InstData::Select { cond, args } => choice::select(self, *cond, *args),
            InstData::Const { .. }
            | InstData::Now
            | InstData::Step { .. }
            | InstData::Load { .. }
            | InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Address { .. }
            | InstData::Elapsed { .. }
            | InstData::Call { .. } => Step::Keep,
        }
    }

    fn result_type(&self, data: &InstData) -> Type {
        match data {
            InstData::Const { ty, .. }
            | InstData::Elapsed { ty, .. }
            | InstData::Step { ty, .. } => *ty,
            InstData::Convert { to, .. } => *to,
            InstData::Compare { .. } => Type::I1,
            InstData::Unary { arg, .. } => self.ty(*arg),
            InstData::Binary { args, .. } | InstData::Select { args, .. } => self.ty(args[0]),
            InstData::Now | InstData::Address { .. } => Type::I64,
            InstData::Load { .. }
            | InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Call { .. } => panic!("memory is not evaluated"),
        }
    }

    fn access(&mut self, inst: Inst) {
        match memory::fix_indices(self, inst) {
            Access::Unchanged => self.out.push(inst),
            Access::Fixed => {
                self.changed = true;
                self.out.push(inst);
            }
            Access::Outside => {
                self.changed = true;
                if let [loaded] = *self.func.results_of(inst) {
                    let zero = self.number(self.ty(loaded), 0);
                    self.replacements.replace(loaded, zero);
                }
            }
        }
    }

    fn terminator(&mut self, block: Block) {
        let origin = self.func.block(block).terminator_origin;
        let mut terminator = self.func.terminator(block).clone();
        terminator.map_values(|v| self.replacements.find(v));
        if let Terminator::Brif {
            cond,
            then,
            otherwise,
        } = &mut terminator
            && let Some(inverse) = self.not_of(*cond)
        {
            *cond = inverse;
            std::mem::swap(then, otherwise);
            self.changed = true;
        }
        self.func.set_terminator(block, terminator, origin);
    }

    /// Type of a value.
    pub(super) fn ty(&self, value: Value) -> Type {
        self.func.value_type(value)
    }

    /// Bits of a constant.
    pub(super) fn constant(&self, value: Value) -> Option<u64> {
        self.func.constant(value)
    }

    /// Whether the value is the constant with all bits set.
    pub(super) fn is_ones(&self, value: Value) -> bool {
        self.constant(value) == Some(self.ty(value).mask())
    }

    /// x, if the value is `not x`.
    pub(super) fn not_of(&self, value: Value) -> Option<Value> {
        match self.func.def_inst(value) {
            Some(InstData::Unary {
                op: UnaryOp::Not,
                arg,
            }) => Some(*arg),
            Some(_) | None => None,
        }
    }

    /// Whether one value is the inverse of the other.
    pub(super) fn are_inverse(&self, a: Value, b: Value) -> bool {
        self.not_of(a) == Some(b) || self.not_of(b) == Some(a)
    }

    /// The operands, if the value is this operation.
    pub(super) fn binary_of(&self, value: Value, wanted: BinaryOp) -> Option<[Value; 2]> {
        match self.func.def_inst(value) {
            Some(InstData::Binary { op, args }) if *op == wanted => Some(*args),
            Some(_) | None => None,
        }
    }

    /// The left operand and the right one's bits, if the value is this operation on a constant.
    pub(super) fn binary_const(&self, value: Value, wanted: BinaryOp) -> Option<(Value, u64)> {
        let [left, right] = self.binary_of(value, wanted)?;
        Some((left, self.constant(right)?))
    }

    /// The operands, if the value is a select.
    pub(super) fn select_of(&self, value: Value) -> Option<(Value, [Value; 2])> {
        match self.func.def_inst(value) {
            Some(InstData::Select { cond, args }) => Some((*cond, *args)),
            Some(_) | None => None,
        }
    }

    /// A new instruction in front of the current one.
    pub(super) fn emit(&mut self, data: InstData, ty: Type) -> Value {
        debug_assert!(data.is_pure());
        let inst = self.func.make_inst(data, &[ty], self.origin);
        self.out.push(inst);
        self.func.result(inst)
    }

    /// A new constant.
    pub(super) fn number(&mut self, ty: Type, bits: u64) -> Value {
        self.emit(constant(ty, bits), ty)
    }

    /// `op left, constant`.
    pub(super) fn with_number(&mut self, op: BinaryOp, left: Value, bits: u64) -> Step {
        let right = self.number(self.ty(left), bits);
        binary(op, left, right)
    }

    /// The inverse of a bit string, found or made.
    pub(super) fn inverse(&mut self, value: Value) -> Value {
        match self.not_of(value) {
            Some(inverse) => inverse,
            None => {
                let ty = self.ty(value);
                let data = InstData::Unary {
                    op: UnaryOp::Not,
                    arg: value,
                };
                self.emit(data, ty)
            }
        }
    }
}

/// `op left, right`.
pub(super) fn binary(op: BinaryOp, left: Value, right: Value) -> Step {
    Step::Data(InstData::Binary {
        op,
        args: [left, right],
    })
}

/// `not value`.
pub(super) fn not(value: Value) -> Step {
    Step::Data(InstData::Unary {
        op: UnaryOp::Not,
        arg: value,
    })
}
