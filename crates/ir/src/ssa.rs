//! SSA construction: variables in, values and block parameters out.
//!
//! The algorithm of Braun et al., "Simple and Efficient Construction of Static Single Assignment
//! Form" (CC 2013), without recursion: looking up a variable walks chains of single predecessors
//! and queues the arguments of new parameters. Parameters that turn out to be redundant are left
//! for the folding pass.

use crate::{Block, Function, InstData, Type, Value};
use cranelift_entity::{EntitySet, PrimaryMap, SecondaryMap, entity_impl};
use rustc_hash::FxHashMap;

/// A variable that may be assigned many times.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Variable(u32);
entity_impl!(Variable, "var");

/// An argument position that still waits for its value.
#[derive(Debug, Clone, Copy)]
struct Pending {
    variable: Variable,
    block: Block,
    param: usize,
}

/// Keeps the definitions of variables per block while a function is built or rewritten.
#[derive(Debug, Default)]
pub struct SsaConstruction {
    types: PrimaryMap<Variable, Type>,
    definitions: FxHashMap<(Variable, Block), Value>,
    predecessors: SecondaryMap<Block, Vec<Block>>,
    sealed: EntitySet<Block>,
    incomplete: SecondaryMap<Block, Vec<(Variable, usize)>>,
}

impl SsaConstruction {
    /// No variables, no blocks.
    pub fn new() -> Self {
        Self::default()
    }

    /// A new variable.
    pub fn declare(&mut self, ty: Type) -> Variable {
        self.types.push(ty)
    }

    /// Says that `from` jumps to `to`; before `to` is sealed. All jumps of a block are said one after
    /// the other; saying one twice is harmless.
    pub fn add_edge(&mut self, from: Block, to: Block) {
        debug_assert!(
            !self.sealed.contains(to),
            "sealed blocks get no more predecessors"
        );
        if self.predecessors[to].last() != Some(&from) {
            self.predecessors[to].push(from);
        }
    }

    /// The value of the variable at the end of `block` is now `value`.
    pub fn define(&mut self, variable: Variable, block: Block, value: Value) {
        self.definitions.insert((variable, block), value);
    }

    /// The value of the variable at the current end of `block`. A variable read before any
    /// definition is 0.
    pub fn value(&mut self, func: &mut Function, variable: Variable, block: Block) -> Value {
        let mut pending = Vec::new();
        let value = self.lookup(func, variable, block, &mut pending);
        self.fill(func, pending);
        value
    }

    /// Says that all predecessors of the block are known.
    pub fn seal(&mut self, func: &mut Function, block: Block) {
        self.sealed.insert(block);
        let incomplete = std::mem::take(&mut self.incomplete[block]);
        let pending = incomplete.into_iter().map(|(variable, param)| {
            self.reserve_arguments(func, block, param);
            Pending {
                variable,
                block,
                param,
            }
        });
        let pending = pending.collect();
        self.fill(func, pending);
    }

    fn lookup(
        &mut self,
        func: &mut Function,
        variable: Variable,
        block: Block,
        pending: &mut Vec<Pending>,
    ) -> Value {
        let (mut passed, mut at) = (Vec::new(), block);
        let value = loop {
            if let Some(&value) = self.definitions.get(&(variable, at)) {
                break value;
            }
            // A cycle of single predecessors is unreachable code; any value will do there.
            let stuck = passed.len() > func.block_count();
            match self.predecessors[at].as_slice() {
                [single] if self.sealed.contains(at) && !stuck => {
                    passed.push(at);
                    at = *single;
                }
                [_, _, ..] if self.sealed.contains(at) => {
                    break self.join(func, variable, at, pending);
                }
                _ if !self.sealed.contains(at) => break self.open_parameter(func, variable, at),
                _ => break self.zero(func, variable, at),
            }
        };
        passed
            .into_iter()
            .chain([at])
            .for_each(|block| self.define(variable, block, value));
        value
    }

    fn join(
        &mut self,
        func: &mut Function,
        variable: Variable,
        block: Block,
        pending: &mut Vec<Pending>,
    ) -> Value {
        let value = func.add_param(block, self.types[variable]);
        let param = func.block(block).params.len() - 1;
        self.reserve_arguments(func, block, param);
        pending.push(Pending {
            variable,
            block,
            param,
        });
        value
    }

    fn open_parameter(&mut self, func: &mut Function, variable: Variable, block: Block) -> Value {
        let value = func.add_param(block, self.types[variable]);
        self.incomplete[block].push((variable, func.block(block).params.len() - 1));
        value
    }

    fn zero(&mut self, func: &mut Function, variable: Variable, block: Block) -> Value {
        let ty = self.types[variable];
        let inst = func.make_inst(InstData::Const { ty, bits: 0 }, &[ty], None);
        func.block_mut(block).insts.insert(0, inst);
        func.result(inst)
    }

    /// Gives every jump to `block` an argument for its newest parameter: the parameter itself,
    /// until `fill` knows better.
    fn reserve_arguments(&self, func: &mut Function, block: Block, param: usize) {
        let placeholder = func.block(block).params[param];
        for &from in &self.predecessors[block] {
            for target in targets_to(func, from, block) {
                debug_assert_eq!(target.args.len(), param);
                target.args.push(placeholder);
            }
        }
    }

    fn fill(&mut self, func: &mut Function, mut pending: Vec<Pending>) {
        while let Some(Pending {
            variable,
            block,
            param,
        }) = pending.pop()
        {
            for from in self.predecessors[block].clone() {
                let value = self.lookup(func, variable, from, &mut pending);
                for target in targets_to(func, from, block) {
                    target.args[param] = value;
                }
            }
        }
    }
}

fn targets_to(
    func: &mut Function,
    from: Block,
    to: Block,
) -> impl Iterator<Item = &mut crate::Target> {
    let terminator = func
        .block_mut(from)
        .terminator
        .as_mut()
        .expect("predecessors are finished");
    terminator
        .targets_mut()
        .into_iter()
        .filter(move |target| target.block == to)
}
