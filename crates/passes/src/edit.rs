//! Rewriting one block: instructions go out in order, new ones in between.

use iecc_ir::{
    BinaryOp, Block, CompareOp, Function, Inst, InstData, Origin, Root, Type, UnaryOp, Value,
};
use std::collections::HashMap;

/// Builds the new instruction list of a block.
pub(crate) struct BlockEditor<'f> {
    pub(crate) func: &'f mut Function,
    block: Block,
    out: Vec<Inst>,
    origin: Option<Origin>,
    constants: HashMap<(Type, u64), Value>,
}

impl<'f> BlockEditor<'f> {
    /// Empties the block; gives the editor and the old instructions.
    pub(crate) fn new(func: &'f mut Function, block: Block) -> (Self, Vec<Inst>) {
        let old = std::mem::take(&mut func.block_mut(block).insts);
        let editor = Self {
            func,
            block,
            out: Vec::with_capacity(old.len()),
            origin: None,
            constants: HashMap::new(),
        };
        (editor, old)
    }

    /// New instructions come from here.
    pub(crate) fn set_origin(&mut self, origin: Option<Origin>) {
        self.origin = origin;
    }

    /// Puts an instruction behind the others.
    pub(crate) fn keep(&mut self, inst: Inst) {
        self.out.push(inst);
    }

    /// A new instruction with one result.
    pub(crate) fn value(&mut self, data: InstData, ty: Type) -> Value {
        let inst = self.func.make_inst(data, &[ty], self.origin);
        self.out.push(inst);
        self.func.result(inst)
    }

    /// A new instruction without result.
    pub(crate) fn effect(&mut self, data: InstData) {
        let inst = self.func.make_inst(data, &[], self.origin);
        self.out.push(inst);
    }

    /// A constant, made once per block.
    pub(crate) fn constant(&mut self, ty: Type, bits: u64) -> Value {
        let bits = bits & ty.mask();
        if let Some(&value) = self.constants.get(&(ty, bits)) {
            return value;
        }
        let value = self.value(InstData::Const { ty, bits }, ty);
        self.constants.insert((ty, bits), value);
        value
    }

    /// `not` of an `i1`; constants and double negation are folded.
    pub(crate) fn not(&mut self, arg: Value) -> Value {
        match self.func.def_inst(arg) {
            Some(InstData::Const { bits, .. }) => {
                let bits = bits ^ 1;
                self.constant(Type::I1, bits)
            }
            Some(InstData::Unary {
                op: UnaryOp::Not,
                arg,
            }) => *arg,
            _ => self.value(
                InstData::Unary {
                    op: UnaryOp::Not,
                    arg,
                },
                Type::I1,
            ),
        }
    }

    /// `and` or `or` of two `i1`, folded where one is constant or both are the same.
    pub(crate) fn gate(&mut self, op: BinaryOp, a: Value, b: Value) -> Value {
        let neutral = u64::from(op == BinaryOp::And);
        match (self.func.constant(a), self.func.constant(b)) {
            (Some(bit), _) => {
                if bit == neutral {
                    b
                } else {
                    a
                }
            }
            (_, Some(bit)) => {
                if bit == neutral {
                    a
                } else {
                    b
                }
            }
            _ if a == b => a,
            _ => self.value(InstData::Binary { op, args: [a, b] }, Type::I1),
        }
    }

    /// `cond ? yes : no` for `i1`, as gates where an arm is constant.
    pub(crate) fn select_bit(&mut self, cond: Value, yes: Value, no: Value) -> Value {
        if yes == no {
            return yes;
        }
        match (
            self.func.constant(cond),
            self.func.constant(yes),
            self.func.constant(no),
        ) {
            (Some(1), ..) => yes,
            (Some(_), ..) => no,
            (_, Some(1), _) => self.gate(BinaryOp::Or, cond, no),
            (_, Some(_), _) => {
                let not = self.not(cond);
                self.gate(BinaryOp::And, not, no)
            }
            (_, _, Some(1)) => {
                let not = self.not(cond);
                self.gate(BinaryOp::Or, not, yes)
            }
            (_, _, Some(_)) => self.gate(BinaryOp::And, cond, yes),
            _ => self.value(
                InstData::Select {
                    cond,
                    args: [yes, no],
                },
                Type::I1,
            ),
        }
    }

    /// `x op k`.
    pub(crate) fn compare_constant(&mut self, op: CompareOp, x: Value, k: i64) -> Value {
        let k = self.constant(self.func.value_type(x), k as u64);
        self.value(InstData::Compare { op, args: [x, k] }, Type::I1)
    }

    /// `cond ? yes : no`; a known condition and equal arms are folded, an inverse is turned around.
    pub(crate) fn select(&mut self, cond: Value, yes: Value, no: Value) -> Value {
        if yes == no {
            return yes;
        }
        match self.func.def_inst(cond) {
            Some(InstData::Const { bits: 0, .. }) => no,
            Some(InstData::Const { .. }) => yes,
            Some(InstData::Unary {
                op: UnaryOp::Not,
                arg,
            }) => {
                let cond = *arg;
                self.select(cond, no, yes)
            }
            _ => {
                let ty = self.func.value_type(yes);
                let args = [yes, no];
                self.value(InstData::Select { cond, args }, ty)
            }
        }
    }

    /// Puts the instructions into the block; gives the function back.
    pub(crate) fn finish(self) -> &'f mut Function {
        self.func.block_mut(self.block).insts = self.out;
        self.func
    }
}

/// Moves the loads of state and inputs to the start of a block in normal form, where no store can
/// come before them.
pub(crate) fn hoist_loads(func: &mut Function, block: Block) {
    let insts = std::mem::take(&mut func.block_mut(block).insts);
    let is_load = |func: &Function, inst: Inst| matches!(func.inst(inst), InstData::Load { place } if matches!(place.root, Root::State | Root::Input));
    let (loads, rest): (Vec<Inst>, Vec<Inst>) =
        insts.into_iter().partition(|&inst| is_load(func, inst));
    func.block_mut(block).insts = loads.into_iter().chain(rest).collect();
}

/// Replaces values everywhere in a function, following chains of replacements.
pub(crate) fn replace_values(func: &mut Function, replacements: &HashMap<Value, Value>) {
    if replacements.is_empty() {
        return;
    }
    func.map_uses(|mut value| {
        while let Some(&next) = replacements.get(&value) {
            value = next;
        }
        value
    });
}
