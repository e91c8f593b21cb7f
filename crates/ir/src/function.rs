//! Functions: blocks, values and instructions in dense tables.

use crate::{FuncId, InstData, MemType, Origin, Terminator, Type};
use cranelift_entity::{PrimaryMap, SecondaryMap, entity_impl};

/// An SSA value: defined once, by an instruction or as a block parameter.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(u32);
entity_impl!(Value, "v");

/// A basic block.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Block(u32);
entity_impl!(Block, "b");

/// An instruction.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Inst(u32);
entity_impl!(Inst, "inst");

/// A reference parameter of a function.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RefParam(u32);
entity_impl!(RefParam, "ref");

/// Memory of one activation of a function.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Local(u32);
entity_impl!(Local, "local");

/// What defines a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueDef {
    /// The n-th parameter of a block.
    Param(Block, u32),
    /// The n-th result of an instruction.
    Result(Inst, u32),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ValueData {
    ty: Type,
    def: ValueDef,
}

/// A reference parameter: a name and the type of what it refers to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefParamData {
    /// Name, unique in its function.
    pub name: String,
    /// Type of the place passed.
    pub ty: MemType,
}

/// Memory of one activation: a name and what it holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LocalData {
    /// Name, unique among locals and references of its function.
    pub name: String,
    /// What it holds; all 0 whenever the function is entered.
    pub ty: MemType,
}

/// The contents of a block.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct BlockData {
    /// Parameters; those of the entry block are the value parameters of the function.
    pub params: Vec<Value>,
    /// Instructions in order.
    pub insts: Vec<Inst>,
    /// The end; `None` only while the block is being built.
    pub terminator: Option<Terminator>,
    /// Where the terminator comes from.
    pub terminator_origin: Option<Origin>,
}

/// A function. The first block of `layout` is the entry; nothing jumps there.
#[derive(Debug, Clone)]
pub struct Function {
    /// Name, unique in its module, without the `@`.
    pub name: String,
    /// Reference parameters.
    pub refs: PrimaryMap<RefParam, RefParamData>,
    /// Memory of one activation: all 0 when the function is entered, gone when it is left.
    pub locals: PrimaryMap<Local, LocalData>,
    /// Result types.
    pub results: Vec<Type>,
    /// The blocks that exist, in text order; the first is the entry. Blocks outside it are dead.
    pub layout: Vec<Block>,
    blocks: PrimaryMap<Block, BlockData>,
    insts: PrimaryMap<Inst, InstData>,
    inst_results: SecondaryMap<Inst, Vec<Value>>,
    origins: SecondaryMap<Inst, Option<Origin>>,
    values: PrimaryMap<Value, ValueData>,
}

impl Function {
    /// A function without blocks.
    pub fn new(name: impl Into<String>, results: Vec<Type>) -> Self {
        Self {
            name: name.into(),
            refs: PrimaryMap::new(),
            locals: PrimaryMap::new(),
            results,
            layout: Vec::new(),
            blocks: PrimaryMap::new(),
            insts: PrimaryMap::new(),
            inst_results: SecondaryMap::new(),
            origins: SecondaryMap::new(),
            values: PrimaryMap::new(),
        }
    }

    /// The first block.
    pub fn entry(&self) -> Block {
        self.layout[0]
    }

    /// Types of the value parameters.
    pub fn param_types(&self) -> Vec<Type> {
        self.block(self.entry())
            .params
            .iter()
            .map(|&v| self.value_type(v))
            .collect()
    }

    /// Adds an empty block at the end of the layout.
    pub fn add_block(&mut self) -> Block {
        let block = self.blocks.push(BlockData::default());
        self.layout.push(block);
        block
    }

    /// The contents of a block.
    pub fn block(&self, block: Block) -> &BlockData {
        &self.blocks[block]
    }

    /// The contents of a block, for changes. Parameters are changed with the methods below.
    pub fn block_mut(&mut self, block: Block) -> &mut BlockData {
        &mut self.blocks[block]
    }

    /// How many block ids exist, dead ones included; for dense side tables.
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// How many values exist, dead ones included; for dense side tables.
    pub fn value_count(&self) -> usize {
        self.values.len()
    }

    /// How many instructions exist, dead ones included.
    pub fn inst_count(&self) -> usize {
        self.insts.len()
    }

    /// The terminator of a finished block.
    pub fn terminator(&self, block: Block) -> &Terminator {
        self.blocks[block]
            .terminator
            .as_ref()
            .expect("finished block")
    }

    /// Ends a block, replacing its terminator.
    pub fn set_terminator(&mut self, block: Block, terminator: Terminator, origin: Option<Origin>) {
        let data = &mut self.blocks[block];
        data.terminator = Some(terminator);
        data.terminator_origin = origin;
    }

    /// Adds a parameter to a block. Jumps to it must be given an argument.
    pub fn add_param(&mut self, block: Block, ty: Type) -> Value {
        let index = self.blocks[block].params.len() as u32;
        let value = self.values.push(ValueData {
            ty,
            def: ValueDef::Param(block, index),
        });
        self.blocks[block].params.push(value);
        value
    }

    /// Keeps the parameters of a block for whose position `keep` holds, and the arguments for them.
    /// The others must be unused. `predecessors` are the blocks that jump here.
    pub fn retain_params(
        &mut self,
        block: Block,
        predecessors: &[Block],
        keep: impl Fn(usize) -> bool,
    ) {
        retain_positions(&mut self.blocks[block].params, &keep);
        for (position, &param) in self.blocks[block].params.iter().enumerate() {
            self.values[param].def = ValueDef::Param(block, position as u32);
        }
        for &from in predecessors {
            let terminator = self.blocks[from].terminator.as_mut();
            let targets = terminator.expect("finished block").targets_mut();
            for target in targets.into_iter().filter(|target| target.block == block) {
                retain_positions(&mut target.args, &keep);
            }
        }
    }

    /// An instruction.
    pub fn inst(&self, inst: Inst) -> &InstData {
        &self.insts[inst]
    }

    /// An instruction, for changes that keep the types of its results.
    pub fn inst_mut(&mut self, inst: Inst) -> &mut InstData {
        &mut self.insts[inst]
    }

    /// Makes an instruction with fresh results; the caller puts it into a block.
    pub fn make_inst(&mut self, data: InstData, results: &[Type], origin: Option<Origin>) -> Inst {
        let inst = self.insts.push(data);
        let values = results.iter().enumerate().map(|(index, &ty)| {
            self.values.push(ValueData {
                ty,
                def: ValueDef::Result(inst, index as u32),
            })
        });
        self.inst_results[inst] = values.collect();
        self.origins[inst] = origin;
        inst
    }

    /// Makes an instruction at the end of a block.
    pub fn append_inst(
        &mut self,
        block: Block,
        data: InstData,
        results: &[Type],
        origin: Option<Origin>,
    ) -> Inst {
        let inst = self.make_inst(data, results, origin);
        self.blocks[block].insts.push(inst);
        inst
    }

    /// The results of an instruction.
    pub fn results_of(&self, inst: Inst) -> &[Value] {
        &self.inst_results[inst]
    }

    /// The only result of an instruction.
    pub fn result(&self, inst: Inst) -> Value {
        let [value] = self.results_of(inst) else {
            panic!("instruction has not one result")
        };
        *value
    }

    /// Where an instruction comes from.
    pub fn origin(&self, inst: Inst) -> Option<Origin> {
        self.origins[inst]
    }

    /// Says where an instruction comes from.
    pub fn set_origin(&mut self, inst: Inst, origin: Option<Origin>) {
        self.origins[inst] = origin;
    }

    /// The type of a value.
    pub fn value_type(&self, value: Value) -> Type {
        self.values[value].ty
    }

    /// What defines a value.
    pub fn value_def(&self, value: Value) -> ValueDef {
        self.values[value].def
    }

    /// The callee of every call of a block, in order.
    pub fn calls_in(&self, block: Block) -> impl Iterator<Item = FuncId> {
        let insts = self.block(block).insts.iter();
        insts.filter_map(|&inst| self.inst(inst).callee())
    }

    /// The callee of every call, in layout order, as often as it is called.
    pub fn calls(&self) -> impl Iterator<Item = FuncId> {
        let blocks = self.layout.iter();
        blocks.flat_map(|&block| self.calls_in(block))
    }

    /// The instruction that defines a value, unless it is a block parameter.
    pub fn def_inst(&self, value: Value) -> Option<&InstData> {
        match self.value_def(value) {
            ValueDef::Result(inst, _) => Some(&self.insts[inst]),
            ValueDef::Param(..) => None,
        }
    }

    /// The bits of a value defined by `const`.
    pub fn constant(&self, value: Value) -> Option<u64> {
        match self.def_inst(value) {
            Some(InstData::Const { bits, .. }) => Some(*bits),
            _ => None,
        }
    }

    /// Applies `f` to every value read anywhere in live blocks.
    pub fn map_uses(&mut self, mut f: impl FnMut(Value) -> Value) {
        for &block in &self.layout {
            for index in 0..self.blocks[block].insts.len() {
                let inst = self.blocks[block].insts[index];
                self.insts[inst].map_values(&mut f);
            }
            if let Some(terminator) = &mut self.blocks[block].terminator {
                terminator.map_values(&mut f);
            }
        }
    }
}

fn retain_positions(values: &mut Vec<Value>, keep: impl Fn(usize) -> bool) {
    let mut position = 0;
    values.retain(|_| {
        position += 1;
        keep(position - 1)
    });
}
