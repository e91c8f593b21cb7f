//! Sparse conditional constant propagation: optimistic, so that a loop or a branch that never
//! happens does not spoil a constant.

use super::{constant, evaluate};
use crate::rewrite::{Replacements, remove_unreachable};
use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::analysis::Cfg;
use iecc_ir::{BinaryOp, Block, Function, Inst, InstData, Target, Terminator, Value};
use smallvec::SmallVec;
use std::collections::BTreeSet;

/// What is known about a value. It only ever moves down this list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Fact {
    /// Nothing that defines it has been seen to happen.
    #[default]
    Unseen,
    /// Always these bits.
    Always(u64),
    /// Anything.
    Varies,
}

impl Fact {
    fn meet(self, other: Self) -> Self {
        match (self, other) {
            (Self::Unseen, fact) | (fact, Self::Unseen) => fact,
            (Self::Always(a), Self::Always(b)) if a == b => self,
            (Self::Always(_) | Self::Varies, _) => Self::Varies,
        }
    }

    fn bits(self) -> Option<u64> {
        match self {
            Self::Always(bits) => Some(bits),
            Self::Unseen | Self::Varies => None,
        }
    }
}

#[derive(Debug, Clone, Copy)]
enum User {
    Inst(Inst),
    /// Its branch decides by the value.
    Branch(Block),
    /// The block's jump to its n-th target passes the value for the m-th parameter. Looked at one
    /// by one: a jump may pass thousands.
    Argument(Block, u32, u32),
}

/// Replaces values that are always the same by constants and drops jumps that never happen. Says
/// whether something changed.
pub(super) fn propagate(func: &mut Function) -> bool {
    let mut solver = Solver::new(func);
    solver.run();
    let Solver { facts, reached, .. } = solver;
    let constants = write_constants(func, &facts, &reached);
    let jumps = write_jumps(func, &facts, &reached);
    remove_unreachable(func) || constants || jumps
}

struct Solver<'f> {
    func: &'f Function,
    facts: SecondaryMap<Value, Fact>,
    users: SecondaryMap<Value, SmallVec<[User; 2]>>,
    block_of: SecondaryMap<Inst, Block>,
    reached: EntitySet<Block>,
    /// Jumps seen to happen: block and position among its targets.
    taken: BTreeSet<(Block, usize)>,
    blocks: Vec<Block>,
    values: Vec<Value>,
}

impl<'f> Solver<'f> {
    fn new(func: &'f Function) -> Self {
        let mut users: SecondaryMap<Value, SmallVec<[User; 2]>> =
            SecondaryMap::with_capacity(func.value_count());
        let mut block_of = SecondaryMap::with_default(func.entry());
        for &block in &func.layout {
            for &inst in &func.block(block).insts {
                block_of[inst] = block;
                let data = func.inst(inst);
                let read = data.is_pure().then(|| data.values());
                read.into_iter()
                    .flatten()
                    .for_each(|v| users[v].push(User::Inst(inst)));
            }
            add_terminator(&mut users, func, block);
        }
        Self {
            func,
            facts: SecondaryMap::with_capacity(func.value_count()),
            users,
            block_of,
            reached: EntitySet::new(),
            taken: BTreeSet::new(),
            blocks: Vec::new(),
            values: Vec::new(),
        }
    }

    fn run(&mut self) {
        let entry = self.func.entry();
        for &param in &self.func.block(entry).params {
            self.lower(param, Fact::Varies);
        }
        self.reached.insert(entry);
        self.blocks.push(entry);
        loop {
            if let Some(block) = self.blocks.pop() {
                let func = self.func;
                func.block(block)
                    .insts
                    .iter()
                    .for_each(|&inst| self.inst(inst));
                self.terminator(block);
            } else if let Some(value) = self.values.pop() {
                self.value_changed(value);
            } else {
                break;
            }
        }
    }

    fn value_changed(&mut self, value: Value) {
        for index in 0..self.users[value].len() {
            match self.users[value][index] {
                User::Inst(inst) if self.reached.contains(self.block_of[inst]) => self.inst(inst),
                User::Branch(block) if self.reached.contains(block) => self.terminator(block),
                User::Argument(block, target, position)
                    if self.taken.contains(&(block, target as usize)) =>
                {
                    let target = self.func.terminator(block).targets()[target as usize].block;
                    let param = self.func.block(target).params[position as usize];
                    self.lower(param, self.facts[value]);
                }
                User::Inst(_) | User::Branch(_) | User::Argument(..) => {}
            }
        }
    }

    fn lower(&mut self, value: Value, fact: Fact) {
        let met = self.facts[value].meet(fact);
        if met != self.facts[value] {
            self.facts[value] = met;
            self.values.push(value);
        }
    }

    fn inst(&mut self, inst: Inst) {
        let func = self.func;
        let data = func.inst(inst);
        let fact = self.result(data);
        for &value in func.results_of(inst) {
            self.lower(value, fact);
        }
    }

    fn result(&self, data: &InstData) -> Fact {
        if let Some(bits) = self.absorbed(data) {
            return Fact::Always(bits);
        }
        if data.values().iter().any(|&v| self.facts[v] == Fact::Unseen) && data.is_pure() {
            return self.unseen_operand(data);
        }
        evaluate(self.func, data, |v| self.facts[v].bits()).map_or(Fact::Varies, Fact::Always)
    }

    /// A select may have a result though the other arm has not been seen.
    fn unseen_operand(&self, data: &InstData) -> Fact {
        match data {
            InstData::Select { cond, args } => match self.facts[*cond] {
                Fact::Always(0) => self.facts[args[1]],
                Fact::Always(_) => self.facts[args[0]],
                Fact::Unseen | Fact::Varies => Fact::Unseen,
            },
            InstData::Const { .. }
            | InstData::Unary { .. }
            | InstData::Binary { .. }
            | InstData::Compare { .. }
            | InstData::Convert { .. }
            | InstData::Load { .. }
            | InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Address { .. }
            | InstData::Now
            | InstData::Elapsed { .. }
            | InstData::Step { .. }
            | InstData::Call { .. } => Fact::Unseen,
        }
    }

    /// `x and 0`, `x or -1`, `x * 0`, whatever x is.
    fn absorbed(&self, data: &InstData) -> Option<u64> {
        let InstData::Binary { op, args } = data else {
            return None;
        };
        let all = self.func.value_type(args[0]).mask();
        let absorbing = match op {
            BinaryOp::And | BinaryOp::Mul => 0,
            BinaryOp::Or => all,
            BinaryOp::Add
            | BinaryOp::Sub
            | BinaryOp::Sdiv
            | BinaryOp::Udiv
            | BinaryOp::Srem
            | BinaryOp::Urem
            | BinaryOp::Xor
            | BinaryOp::Shl
            | BinaryOp::Ushr
            | BinaryOp::Sshr
            | BinaryOp::Fadd
            | BinaryOp::Fsub
            | BinaryOp::Fmul
            | BinaryOp::Fdiv => return None,
        };
        let found = args
            .iter()
            .any(|&v| self.facts[v] == Fact::Always(absorbing));
        found.then_some(absorbing)
    }

    fn terminator(&mut self, block: Block) {
        let func = self.func;
        let terminator = func.terminator(block);
        let targets = terminator.targets();
        match terminator {
            Terminator::Jump(_) => self.jump(block, 0, targets[0]),
            Terminator::Brif { cond, .. } => match self.facts[*cond] {
                Fact::Unseen => {}
                Fact::Always(bits) => {
                    let index = usize::from(bits == 0);
                    self.jump(block, index, targets[index]);
                }
                Fact::Varies => self.all_jumps(block, &targets),
            },
            Terminator::Switch { value, cases, .. } => match self.facts[*value] {
                Fact::Unseen => {}
                Fact::Always(bits) => {
                    let case = cases.iter().position(|(number, _)| *number == bits);
                    let index = case.map_or(0, |case| case + 1);
                    self.jump(block, index, targets[index]);
                }
                Fact::Varies => self.all_jumps(block, &targets),
            },
            Terminator::Return(_) | Terminator::Fault(_) => {}
        }
    }

    fn all_jumps(&mut self, block: Block, targets: &[&Target]) {
        for (index, target) in targets.iter().enumerate() {
            self.jump(block, index, target);
        }
    }

    fn jump(&mut self, block: Block, index: usize, target: &Target) {
        if !self.taken.insert((block, index)) {
            return;
        }
        let func = self.func;
        for (&param, &arg) in func.block(target.block).params.iter().zip(&target.args) {
            self.lower(param, self.facts[arg]);
        }
        if self.reached.insert(target.block) {
            self.blocks.push(target.block);
        }
    }
}

fn add_terminator(
    users: &mut SecondaryMap<Value, SmallVec<[User; 2]>>,
    func: &Function,
    block: Block,
) {
    let terminator = func.terminator(block);
    if let Terminator::Brif { cond: value, .. } | Terminator::Switch { value, .. } = terminator {
        users[*value].push(User::Branch(block));
    }
    for (index, target) in (0..).zip(terminator.targets()) {
        for (position, &arg) in (0..).zip(&target.args) {
            users[arg].push(User::Argument(block, index, position));
        }
    }
}

fn write_constants(
    func: &mut Function,
    facts: &SecondaryMap<Value, Fact>,
    reached: &EntitySet<Block>,
) -> bool {
    let cfg = Cfg::new(func);
    let mut replacements = Replacements::default();
    let mut changed = false;
    for &block in cfg.reverse_postorder() {
        if reached.contains(block) {
            changed |= constant_results(func, block, facts);
            constant_params(func, &cfg, block, facts, &mut replacements);
        }
    }
    replacements.apply(func) || changed
}

fn constant_results(func: &mut Function, block: Block, facts: &SecondaryMap<Value, Fact>) -> bool {
    let mut changed = false;
    for index in 0..func.block(block).insts.len() {
        let inst = func.block(block).insts[index];
        let data = func.inst(inst);
        if !data.is_pure() || matches!(data, InstData::Const { .. }) {
            continue;
        }
        let value = func.result(inst);
        if let Some(bits) = facts[value].bits() {
            *func.inst_mut(inst) = constant(func.value_type(value), bits);
            changed = true;
        }
    }
    changed
}

fn constant_params(
    func: &mut Function,
    cfg: &Cfg,
    block: Block,
    facts: &SecondaryMap<Value, Fact>,
    replacements: &mut Replacements,
) {
    let params = func.block(block).params.clone();
    let mut made = Vec::new();
    for &param in &params {
        if let Some(bits) = facts[param].bits() {
            let ty = func.value_type(param);
            let inst = func.make_inst(constant(ty, bits), &[ty], None);
            replacements.replace(param, func.result(inst));
            made.push(inst);
        }
    }
    if !made.is_empty() {
        func.block_mut(block).insts.splice(0..0, made);
        let varies = |index: usize| facts[params[index]].bits().is_none();
        func.retain_params(block, cfg.predecessors(block), varies);
    }
}

fn write_jumps(
    func: &mut Function,
    facts: &SecondaryMap<Value, Fact>,
    reached: &EntitySet<Block>,
) -> bool {
    let mut changed = false;
    for block in func.layout.clone() {
        if reached.contains(block)
            && let Some(target) = only_target(func.terminator(block), facts)
        {
            let origin = func.block(block).terminator_origin;
            func.set_terminator(block, Terminator::Jump(target), origin);
            changed = true;
        }
    }
    changed
}

fn only_target(terminator: &Terminator, facts: &SecondaryMap<Value, Fact>) -> Option<Target> {
    match terminator {
        Terminator::Brif {
            cond,
            then,
            otherwise,
        } => {
            let bits = facts[*cond].bits()?;
            Some(if bits == 0 { otherwise } else { then }.clone())
        }
        Terminator::Switch {
            value,
            cases,
            default,
        } => {
            let bits = facts[*value].bits()?;
            let case = cases.iter().find(|(number, _)| *number == bits);
            Some(case.map_or(default, |(_, target)| target).clone())
        }
        Terminator::Jump(_) | Terminator::Return(_) | Terminator::Fault(_) => None,
    }
}
