//! Common subexpressions: what has been computed is not computed again.
//!
//! Global value numbering along the dominator tree: a pure instruction whose equal stands in a
//! dominating place is replaced by it; operands of commutative operations are sorted first, and
//! `a > b` is written `b < a`. Inside a block, a load gives what was last stored or loaded there,
//! if nothing in between may have changed it. Behind `brif c`, in a block reached from there
//! alone, c is known.

mod available;

use crate::references::References;
use crate::rewrite::Replacements;
use available::Available;
use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::{Cfg, Dominators};
use iecc_ir::{BinaryOp, Block, Function, Inst, InstData, Module, Root, Terminator, Type, Value};
use std::collections::HashMap;

/// For so many instructions, constants not counted, a value of memory is kept for machine code. Loading it again is cheaper than
/// keeping it any longer, in a register that others need or in another place of memory.
const NEAR: usize = 48;

/// Shares common subexpressions in every function.
pub(crate) fn cse(module: &mut Module) {
    share(module, usize::MAX);
}

/// The same, but loads again what was loaded or stored long before.
pub(crate) fn cse_near(module: &mut Module) {
    share(module, NEAR);
}

fn share(module: &mut Module, memory: usize) {
    let references = References::of(module);
    for (id, func) in module.funcs.iter_mut() {
        Numbering::new(func, &|root| references.certain(id, root), memory).run();
    }
}

/// What to do next on the walk over the dominator tree.
enum Visit {
    Enter(Block),
    /// Forget everything known since the trails were this long.
    Leave(usize, usize),
}

/// An instruction, written so that equal ones are equal, and the type of its result.
type Key = (InstData, Type);

struct Numbering<'f> {
    func: &'f mut Function,
    replacements: Replacements,
    known: HashMap<Key, Value>,
    /// Keys in the order they became known. A key is learnt only if it is not known.
    trail: Vec<Key>,
    /// Bits of values that the branches on the way here decided.
    decided: HashMap<Value, u64>,
    decided_trail: Vec<Value>,
    cfg: Cfg,
    children: SecondaryMap<Block, Vec<Block>>,
    /// Whether a root is memory in every call.
    certain: &'f dyn Fn(Root) -> bool,
    /// For how many instructions a value of memory is of use.
    memory: usize,
}

impl<'f> Numbering<'f> {
    fn new(func: &'f mut Function, certain: &'f dyn Fn(Root) -> bool, memory: usize) -> Self {
        let cfg = Cfg::new(func);
        let dominators = Dominators::new(&cfg);
        let mut children: SecondaryMap<Block, Vec<Block>> = SecondaryMap::new();
        for &block in cfg.reverse_postorder() {
            if let Some(parent) = dominators.immediate(block) {
                children[parent].push(block);
            }
        }
        Self {
            func,
            replacements: Replacements::default(),
            known: HashMap::new(),
            trail: Vec::new(),
            decided: HashMap::new(),
            decided_trail: Vec::new(),
            cfg,
            children,
            certain,
            memory,
        }
    }

    fn run(mut self) {
        let mut stack = vec![Visit::Enter(self.func.entry())];
        while let Some(visit) = stack.pop() {
            match visit {
                Visit::Enter(block) => {
                    stack.push(Visit::Leave(self.trail.len(), self.decided_trail.len()));
                    self.decide(block);
                    self.block(block);
                    let children = self.children[block].iter().rev();
                    stack.extend(children.map(|&child| Visit::Enter(child)));
                }
                Visit::Leave(known, decided) => self.forget(known, decided),
            }
        }
        self.replacements.apply(self.func);
    }

    fn forget(&mut self, known: usize, decided: usize) {
        for key in self.trail.drain(known..) {
            self.known.remove(&key);
        }
        for value in self.decided_trail.drain(decided..) {
            self.decided.remove(&value);
        }
    }

    /// Learns what the only way into a block says.
    fn decide(&mut self, block: Block) {
        let &[from] = self.cfg.predecessors(block) else {
            return;
        };
        match self.func.terminator(from) {
            Terminator::Brif {
                cond,
                then,
                otherwise,
            } if then.block != otherwise.block => {
                let (cond, bit) = (*cond, u64::from(then.block == block));
                self.decide_bit(cond, bit);
            }
            Terminator::Switch {
                value,
                cases,
                default,
            } if default.block != block => {
                let (value, mut ways) = (*value, cases.iter().filter(|(_, t)| t.block == block));
                if let (Some(&(bits, _)), None) = (ways.next(), ways.next()) {
                    self.decide_value(value, bits);
                }
            }
            _ => {}
        }
    }

    fn decide_value(&mut self, value: Value, bits: u64) {
        if self.func.constant(value).is_none() && !self.decided.contains_key(&value) {
            self.decided.insert(value, bits);
            self.decided_trail.push(value);
        }
    }

    /// If `a and b` holds, so do both; if `a or b` does not, neither does.
    fn decide_bit(&mut self, cond: Value, bit: u64) {
        let mut pending = vec![cond];
        while let Some(value) = pending.pop() {
            self.decide_value(value, bit);
            match self.func.def_inst(value) {
                Some(InstData::Binary { op, args })
                    if (*op == BinaryOp::And && bit == 1) || (*op == BinaryOp::Or && bit == 0) =>
                {
                    let new = |v: &&Value| !self.decided.contains_key(v);
                    pending.extend(args.iter().filter(new));
                }
                _ => {}
            }
        }
    }

    fn block(&mut self, block: Block) {
        let mut available = Available::new(self.memory);
        let mut kept = Vec::new();
        for inst in std::mem::take(&mut self.func.block_mut(block).insts) {
            let mut data = self.func.inst(inst).clone();
            if !matches!(data, InstData::Const { .. }) {
                available.next();
            }
            data.map_values(|v| self.resolve(v, &mut kept));
            *self.func.inst_mut(inst) = data;
            let redundant = if self.func.inst(inst).is_pure() {
                self.pure(inst)
            } else {
                self.memory(inst, &mut available)
            };
            if !redundant {
                kept.push(inst);
            }
        }
        self.func.block_mut(block).insts = Vec::new();
        let mut terminator = self.func.terminator(block).clone();
        terminator.map_values(|v| self.resolve(v, &mut kept));
        let origin = self.func.block(block).terminator_origin;
        self.func.set_terminator(block, terminator, origin);
        self.func.block_mut(block).insts = kept;
    }

    /// What to read for a value here: an equal one, or a constant if a branch decided it.
    fn resolve(&mut self, value: Value, kept: &mut Vec<Inst>) -> Value {
        let value = self.replacements.find(value);
        let Some(&bits) = self.decided.get(&value) else {
            return value;
        };
        let ty = self.func.value_type(value);
        let key = (InstData::Const { ty, bits }, ty);
        if let Some(&same) = self.known.get(&key) {
            return same;
        }
        let inst = self.func.make_inst(key.0.clone(), &[ty], None);
        kept.push(inst);
        let value = self.func.result(inst);
        self.learn(key, value);
        value
    }

    fn learn(&mut self, key: Key, value: Value) {
        let hidden = self.known.insert(key.clone(), value);
        debug_assert_eq!(hidden, None);
        self.trail.push(key);
    }

    /// Whether the instruction is known already.
    fn pure(&mut self, inst: Inst) -> bool {
        let value = self.func.result(inst);
        let key = (
            normalised(self.func.inst(inst)),
            self.func.value_type(value),
        );
        match self.known.get(&key) {
            Some(&same) => {
                self.replacements.replace(value, same);
                true
            }
            None => {
                self.learn(key, value);
                false
            }
        }
    }

    /// Whether the instruction is a load of what is known to be there.
    fn memory(&mut self, inst: Inst, available: &mut Available) -> bool {
        match self.func.inst(inst) {
            InstData::Load { place } => {
                let value = self.func.result(inst);
                let Some(same) = available.get(place) else {
                    available.loaded(place, value);
                    return false;
                };
                self.replacements.replace(value, same);
                true
            }
            InstData::Store { place, value } => {
                available.changed(place);
                if (self.certain)(place.root) {
                    available.stored(place, *value);
                }
                false
            }
            InstData::Elapsed { place, .. } => {
                available.changed(place);
                false
            }
            InstData::Copy { to: place, .. } | InstData::Clear { place } => {
                available.all_changed(place);
                false
            }
            InstData::Call { refs, .. } => {
                available.called(refs);
                false
            }
            _ => false,
        }
    }
}

/// The same instruction, written in one way only.
fn normalised(data: &InstData) -> InstData {
    let mut data = data.clone();
    match &mut data {
        InstData::Binary { op, args } if op.is_commutative() => args.sort_unstable(),
        InstData::Compare { op, args } if args[0] > args[1] => {
            *op = op.swapped();
            args.swap(0, 1);
        }
        _ => {}
    }
    data
}
