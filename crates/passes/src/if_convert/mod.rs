//! If-conversion: control becomes data.
//!
//! After `if_convert` a function without loops and faults is one block. Every operation is total,
//! so what an arm computes is computed always; a parameter of a join becomes a choice by the
//! conditions of the branches between the join and its immediate dominator; a store becomes a
//! store of the new value or the old one. A function is left as it is if it loops or faults, or
//! if a call, an `elapsed`, a `copy`, a `clear` or a store to an output (whose old value cannot be loaded) depends on a
//! branch.
//!
//! Size: parameters that choose between two values share one condition per partition of the ways
//! in, found by walking only blocks that are not inside an inner choice; others take a choice per
//! branch. No condition is written out per path, so nothing grows exponentially.

mod region;
mod small;

pub(crate) use small::if_convert_small;

use crate::edit::BlockEditor;
use crate::rewrite::{Replacements, join_returns, remove_unreachable};
use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::{Cfg, Dominators, Loops};
use iecc_ir::{
    BinaryOp, Block, CompareOp, Function, Inst, InstData, Module, Place, Root, Terminator, Type,
    Value,
};
use region::{Regions, Walk};
use std::collections::BTreeMap;

/// A walk with more steps is worth the question whether a block ran.
const MANY_STEPS: usize = 6;

/// Converts every function that can be converted.
pub(crate) fn if_convert(module: &mut Module) {
    for func in module.funcs.values_mut() {
        remove_unreachable(func);
        if func.layout.len() > 1 && can_end(func) {
            join_returns(func);
            let regions = Regions::of(func);
            if effects_allow(func, &regions) {
                Conversion::new(func, regions).run();
            }
        }
    }
}

/// Whether the function always returns.
fn can_end(func: &Function) -> bool {
    let faults = |&block: &Block| matches!(func.terminator(block), Terminator::Fault(_));
    let cfg = Cfg::new(func);
    !func.layout.iter().any(faults) && Loops::new(&cfg, &Dominators::new(&cfg)).is_empty()
}

/// Whether all effects that depend on a branch can be made choices.
fn effects_allow(func: &Function, regions: &Regions) -> bool {
    func.layout.iter().all(|&block| {
        let insts = &func.block(block).insts;
        regions.always_runs(block) || insts.iter().all(|&inst| can_be_chosen(func.inst(inst)))
    })
}

fn can_be_chosen(data: &InstData) -> bool {
    match data {
        InstData::Store { place, .. } => place.root != Root::Output,
        InstData::Elapsed { .. }
        | InstData::Copy { .. }
        | InstData::Clear { .. }
        | InstData::Call { .. } => false,
        _ => true,
    }
}

struct Conversion<'f> {
    editor: BlockEditor<'f>,
    regions: Regions,
    terminators: SecondaryMap<Block, Option<Terminator>>,
    replacements: Replacements,
    /// Whether each block runs, found when asked; `None` inside if not asked yet.
    runs: SecondaryMap<Block, Option<Value>>,
    /// The instructions of the entry, taken out by the editor.
    first: Vec<Inst>,
}

impl<'f> Conversion<'f> {
    fn new(func: &'f mut Function, regions: Regions) -> Self {
        let entry = func.entry();
        let mut terminators = SecondaryMap::new();
        for &block in &func.layout {
            terminators[block] = Some(func.terminator(block).clone());
        }
        let (editor, first) = BlockEditor::new(func, entry);
        Self {
            editor,
            regions,
            terminators,
            replacements: Replacements::default(),
            runs: SecondaryMap::new(),
            first,
        }
    }

    fn run(mut self) {
        let order = self.regions.order().to_vec();
        for &block in &order {
            self.params(block);
            let insts = if block == order[0] {
                std::mem::take(&mut self.first)
            } else {
                std::mem::take(&mut self.editor.func.block_mut(block).insts)
            };
            for inst in insts {
                self.inst(block, inst);
            }
        }
        let last = *order.last().expect("functions have an entry");
        let origin = self.editor.func.block(last).terminator_origin;
        let terminator = self.terminators[last].take().expect("blocks have an end");
        let func = self.editor.finish();
        func.set_terminator(order[0], terminator, origin);
        func.layout.truncate(1);
        self.replacements.apply(func);
    }

    fn inst(&mut self, block: Block, inst: Inst) {
        let func = &mut self.editor.func;
        let replacements = &mut self.replacements;
        func.inst_mut(inst).map_values(|v| replacements.find(v));
        if let InstData::Store { place, value } = func.inst(inst).clone()
            && !self.regions.always_runs(block)
        {
            self.editor.set_origin(self.editor.func.origin(inst));
            let value = self.new_or_old(block, &place, value);
            *self.editor.func.inst_mut(inst) = InstData::Store { place, value };
        }
        self.editor.keep(inst);
    }

    fn new_or_old(&mut self, block: Block, place: &Place, new: Value) -> Value {
        let runs = self.runs(block);
        let ty = self.editor.func.value_type(new);
        let place = place.clone();
        let old = self.editor.value(InstData::Load { place }, ty);
        self.choose(runs, new, old)
    }

    /// An `i1` that says whether a block runs in this scan.
    fn runs(&mut self, block: Block) -> Value {
        // Blocks up the dominator tree whose answer is not known yet.
        let (mut pending, mut at) = (Vec::new(), block);
        let mut known = loop {
            if self.regions.always_runs(at) {
                break self.editor.constant(Type::I1, 1);
            }
            if let Some(value) = self.runs[at] {
                break value;
            }
            pending.push(at);
            at = self.regions.dominator(at);
        };
        for block in pending.into_iter().rev() {
            let dominator = self.regions.dominator(block);
            if !self.regions.follows(dominator, block) {
                let [yes, no] = [1, 0].map(|bit| self.editor.constant(Type::I1, bit));
                let walk = self.regions.walk(&self.terminators, dominator, block);
                let ways = vec![yes; walk.ways_in()];
                let reached = self.value_of_walk(&walk, &ways, Some(no));
                known = self.editor.gate(BinaryOp::And, known, reached);
            }
            self.runs[block] = Some(known);
        }
        known
    }

    /// Replaces the parameters of a block by choices.
    fn params(&mut self, block: Block) {
        let params = self.editor.func.block(block).params.clone();
        if params.is_empty() || block == self.regions.order()[0] {
            return;
        }
        let dominator = self.regions.dominator(block);
        let origin = self.editor.func.block(dominator).terminator_origin;
        self.editor.set_origin(origin);
        let walk = self.regions.walk(&self.terminators, dominator, block);
        let mut conditions = BTreeMap::new();
        for (index, &param) in params.iter().enumerate() {
            let args = walk.arguments(&self.terminators, index);
            let args: Vec<Value> = args.map(|v| self.replacements.find(v)).collect();
            let value = self.choice(&walk, &args, &mut conditions);
            self.replacements.replace(param, value);
        }
    }

    /// The argument of the way that is taken.
    fn choice(
        &mut self,
        walk: &Walk,
        args: &[Value],
        conditions: &mut BTreeMap<Vec<bool>, Value>,
    ) -> Value {
        let first = args[0];
        let Some(&second) = args.iter().find(|&&arg| arg != first) else {
            return first;
        };
        if args.iter().any(|&arg| arg != first && arg != second) {
            return self.value_of_walk(walk, args, None);
        }
        let is_second: Vec<bool> = args.iter().map(|&arg| arg == second).collect();
        let cond = match conditions.get(&is_second) {
            Some(&cond) => cond,
            None => {
                let cond = self.condition(walk, &is_second);
                conditions.insert(is_second, cond);
                cond
            }
        };
        self.choose(cond, second, first)
    }

    /// Whether one of these ways is taken. After many branches it may be enough to ask whether some
    /// block ran, which is found once for all who ask and step by step: a chain of early returns
    /// would otherwise be written out anew for each variable.
    fn condition(&mut self, walk: &Walk, ways: &[bool]) -> Value {
        let split = (walk.steps().len() > MANY_STEPS).then(|| self.regions.split(walk, ways));
        if let Some((block, side)) = split.flatten() {
            let runs = self.runs(block);
            return if side { runs } else { self.editor.not(runs) };
        }
        let bits = ways.iter().map(|&bit| u64::from(bit));
        let ways: Vec<Value> = bits.map(|b| self.editor.constant(Type::I1, b)).collect();
        self.value_of_walk(walk, &ways, None)
    }

    /// The value of the way into the goal that is taken from the start of the walk; `missed` if
    /// none is, or anything if that does not matter.
    fn value_of_walk(&mut self, walk: &Walk, ways: &[Value], missed: Option<Value>) -> Value {
        let mut values: Vec<Option<Value>> = Vec::with_capacity(walk.steps().len());
        for step in walk.steps() {
            let of = |exit: &region::Exit| match *exit {
                region::Exit::Goal(way) => Some(ways[way]),
                region::Exit::Step(index) => values[index],
                region::Exit::Missed => missed,
            };
            let exits: Vec<Option<Value>> = step.exits.iter().map(of).collect();
            let value = self.branch(step.block, &exits);
            values.push(value);
        }
        let start = values.pop().flatten();
        start.expect("the goal is reached from its dominator")
    }

    /// What comes of a branch with these values behind its targets; `None` matters to nobody.
    fn branch(&mut self, block: Block, exits: &[Option<Value>]) -> Option<Value> {
        let known = exits.iter().flatten().next().copied()?;
        if exits.iter().flatten().all(|&value| value == known) {
            return Some(known);
        }
        // Not cloned: a branch may pass hundreds of arguments.
        match self.terminators[block]
            .as_ref()
            .expect("blocks have an end")
        {
            Terminator::Brif { cond, .. } => {
                let cond = self.replacements.find(*cond);
                Some(match (exits[0], exits[1]) {
                    (Some(yes), Some(no)) => self.choose(cond, yes, no),
                    _ => known,
                })
            }
            Terminator::Switch { value, cases, .. } => {
                let value = self.replacements.find(*value);
                let numbers: Vec<u64> = cases.iter().map(|(number, _)| *number).collect();
                Some(self.switch(value, &numbers, exits))
            }
            Terminator::Jump(_) | Terminator::Return(_) | Terminator::Fault(_) => {
                panic!("a branch has several targets")
            }
        }
    }

    /// One choice for each value, not for each case. The default comes first in `exits`.
    fn switch(&mut self, value: Value, numbers: &[u64], exits: &[Option<Value>]) -> Value {
        let mut groups: Vec<(Value, Vec<u64>)> = Vec::new();
        let mut group_of: BTreeMap<Value, usize> = BTreeMap::new();
        for (&number, exit) in numbers.iter().zip(&exits[1..]) {
            let Some(exit) = *exit else { continue };
            if exits[0] == Some(exit) {
                continue;
            }
            let index = *group_of.entry(exit).or_insert(groups.len());
            if index == groups.len() {
                groups.push((exit, Vec::new()));
            }
            groups[index].1.push(number);
        }
        let otherwise = exits[0].or_else(|| groups.pop().map(|(exit, _)| exit));
        let mut chosen = otherwise.expect("some way matters");
        for (exit, numbers) in groups.into_iter().rev() {
            let cond = self.is_one_of(value, &numbers);
            chosen = self.choose(cond, exit, chosen);
        }
        chosen
    }

    fn is_one_of(&mut self, value: Value, numbers: &[u64]) -> Value {
        let mut any = self.editor.constant(Type::I1, 0);
        for &number in numbers {
            let equal = (self.editor).compare_constant(CompareOp::Eq, value, number as i64);
            any = self.editor.gate(BinaryOp::Or, any, equal);
        }
        any
    }

    fn choose(&mut self, cond: Value, yes: Value, no: Value) -> Value {
        if self.editor.func.value_type(yes) == Type::I1 {
            return self.editor.select_bit(cond, yes, no);
        }
        self.editor.select(cond, yes, no)
    }
}
