//! Sparse conditional constant propagation: optimistic, so that a loop or a branch that never
//! happens does not spoil a constant.

use super::{constant, evaluate};
use crate::rewrite::{Replacements, remove_unreachable};
use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::analysis::Cfg;
use iecc_ir::{BinaryOp, Block, Function, Inst, InstData, Target, Terminator, Value};
use rustc_hash::FxHashSet;
use smallvec::SmallVec;

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
    /// In this block.
    Inst(Inst, Block),
    /// Its branch decides by the value.
    Branch(Block),
    /// The block's jump to its n-th target passes the value for the m-th parameter. Looked at one
    /// by one: a jump may pass thousands.
    Argument(Block, u32, u32),
}

/// Replaces values that are always the same by constants and drops jumps that never happen. Says
/// whether something changed.
pub(super) fn propagate(func: &mut Function) -> bool {
    let cfg = Cfg::new(func);
    let mut solver = Solver::new(func);
    solver.run(cfg.reverse_postorder());
    let Solver { facts, reached, .. } = solver;
    let constants = write_constants(func, &cfg, &facts, &reached);
    let jumps = write_jumps(func, &facts, &reached);
    // What cannot be reached for another reason is for `control` to remove.
    let removed = jumps && remove_unreachable(func);
    removed || constants || jumps
}

/// Looks at every block that is reached once, in reverse postorder; after that only at what uses
/// a value of which less is known than when it was looked at. Without loops that is nothing.
struct Solver<'f> {
    func: &'f Function,
    facts: SecondaryMap<Value, Fact>,
    /// Made when the first value changes.
    users: Option<Users>,
    reached: EntitySet<Block>,
    /// Blocks that were looked at.
    seen: EntitySet<Block>,
    /// Jumps seen to happen: block and position among its targets.
    taken: FxHashSet<(Block, usize)>,
    /// Values that changed behind the back of something that was looked at.
    values: Vec<Value>,
    /// Blocks that are reached behind their turn.
    late: Vec<Block>,
    /// Whether blocks still have their turn.
    in_order: bool,
}

impl<'f> Solver<'f> {
    fn new(func: &'f Function) -> Self {
        let mut facts = SecondaryMap::new();
        facts.resize(func.value_count());
        Self {
            func,
            facts,
            users: None,
            reached: EntitySet::new(),
            seen: EntitySet::new(),
            taken: FxHashSet::default(),
            values: Vec::new(),
            late: Vec::new(),
            in_order: true,
        }
    }

    fn run(&mut self, order: &[Block]) {
        let entry = self.func.entry();
        for &param in &self.func.block(entry).params {
            self.facts[param] = Fact::Varies;
        }
        self.reached.insert(entry);
        for &block in order {
            if self.reached.contains(block) {
                self.look_at(block);
            }
        }
        self.in_order = false;
        let missed = order.iter().copied();
        let missed =
            missed.filter(|&block| self.reached.contains(block) && !self.seen.contains(block));
        self.late = missed.collect();
        loop {
            if let Some(block) = self.late.pop() {
                self.look_at(block);
            } else if let Some(value) = self.values.pop() {
                self.value_changed(value);
            } else {
                break;
            }
        }
    }

    /// Nothing that uses the results was looked at before: they are used behind this block only.
    fn look_at(&mut self, block: Block) {
        self.seen.insert(block);
        let func = self.func;
        for &inst in &func.block(block).insts {
            let fact = self.result(func.inst(inst));
            for &value in func.results_of(inst) {
                self.facts[value] = self.facts[value].meet(fact);
            }
        }
        self.terminator(block);
    }

    fn value_changed(&mut self, value: Value) {
        let func = self.func;
        let users = self.users.get_or_insert_with(|| Users::of(func));
        let of_value = std::mem::take(&mut users.of[value]);
        for &user in &of_value {
            match user {
                User::Inst(inst, block) if self.seen.contains(block) => self.inst(inst),
                User::Branch(block) if self.seen.contains(block) => self.terminator(block),
                User::Argument(block, target, position)
                    if self.taken.contains(&(block, target as usize)) =>
                {
                    let target = func.terminator(block).targets()[target as usize].block;
                    let param = func.block(target).params[position as usize];
                    self.lower(param, self.facts[value]);
                }
                User::Inst(..) | User::Branch(_) | User::Argument(..) => {}
            }
        }
        if let Some(users) = &mut self.users {
            users.of[value] = of_value;
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
        let seen = self.seen.contains(target.block);
        for (&param, &arg) in func.block(target.block).params.iter().zip(&target.args) {
            if seen {
                self.lower(param, self.facts[arg]);
            } else {
                self.facts[param] = self.facts[param].meet(self.facts[arg]);
            }
        }
        if self.reached.insert(target.block) && !self.in_order {
            self.late.push(target.block);
        }
    }
}

/// What reads each value.
struct Users {
    of: SecondaryMap<Value, SmallVec<[User; 2]>>,
}

impl Users {
    fn of(func: &Function) -> Self {
        let mut users = Self {
            of: SecondaryMap::with_capacity(func.value_count()),
        };
        for &block in &func.layout {
            for &inst in &func.block(block).insts {
                let data = func.inst(inst);
                let read = data.is_pure().then(|| data.values());
                read.into_iter()
                    .flatten()
                    .for_each(|v| users.of[v].push(User::Inst(inst, block)));
            }
            users.add_terminator(func, block);
        }
        users
    }

    fn add_terminator(&mut self, func: &Function, block: Block) {
        let terminator = func.terminator(block);
        if let Terminator::Brif { cond: value, .. } | Terminator::Switch { value, .. } = terminator
        {
            self.of[*value].push(User::Branch(block));
        }
        for (index, target) in (0..).zip(terminator.targets()) {
            for (position, &arg) in (0..).zip(&target.args) {
                self.of[arg].push(User::Argument(block, index, position));
            }
        }
    }
}

fn write_constants(
    func: &mut Function,
    cfg: &Cfg,
    facts: &SecondaryMap<Value, Fact>,
    reached: &EntitySet<Block>,
) -> bool {
    let mut replacements = Replacements::default();
    let mut changed = false;
    for &block in cfg.reverse_postorder() {
        if reached.contains(block) {
            changed |= constant_results(func, block, facts);
            constant_params(func, cfg, block, facts, &mut replacements);
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
