//! The rewriting: parameters at the joins that need them, then a walk over the dominator tree that
//! turns loads into values.
//!
//! Parameters are placed by iterated dominance frontiers (Cytron et al. 1991). Ladder programs have
//! thousands of joins and thousands of variables, of which a join concerns one or two; construction
//! from reads backwards would give each join a parameter for each variable first.

use super::Promoted;
use super::candidates::variable_place;
use crate::rewrite::Replacements;
use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::analysis::{Cfg, Dominators};
use iecc_ir::{
    BinaryOp, Block, ConvertOp, Function, Index, Inst, InstData, Origin, Place, Projection, Root,
    Terminator, Type, UnaryOp, Value,
};
use std::collections::HashMap;

/// Turns the scalars into values. The function has at most one return if one of them is no local.
/// With `store_early`, what only the entry stores is stored at its end, where that cannot be seen.
pub(super) fn rename(func: &mut Function, promoted: &[Promoted], store_early: bool) {
    let cfg = Cfg::new(func);
    let dominators = Dominators::new(&cfg);
    let variables: HashMap<&Place, usize> = promoted.iter().map(|p| &p.place).zip(0..).collect();
    let stores = stores(func, &cfg, &variables, promoted.len());
    let early = match store_early && always_returns(func, &cfg) {
        true => early(func, &stores),
        false => vec![false; promoted.len()],
    };
    let joins = place_params(func, &cfg, &dominators, stores, promoted);
    let mut children: SecondaryMap<Block, Vec<Block>> = SecondaryMap::new();
    for &block in cfg.reverse_postorder() {
        if let Some(parent) = dominators.immediate(block) {
            children[parent].push(block);
        }
    }
    Renamer {
        func,
        promoted,
        early,
        variables,
        joins,
        children,
        replacements: Replacements::default(),
        initial: vec![None; promoted.len()],
        prologue: Vec::new(),
        current: vec![None; promoted.len()],
        undo: Vec::new(),
        out: Vec::new(),
        origin: None,
    }
    .run();
}

/// The blocks that store each variable.
fn stores(
    func: &Function,
    cfg: &Cfg,
    variables: &HashMap<&Place, usize>,
    count: usize,
) -> Vec<Vec<Block>> {
    let mut stores: Vec<Vec<Block>> = vec![Vec::new(); count];
    for &block in cfg.reverse_postorder() {
        for &inst in &func.block(block).insts {
            if let InstData::Store { place, .. } = func.inst(inst)
                && let Some(variable) = variable_of(variables, place)
                && stores[variable].last() != Some(&block)
            {
                stores[variable].push(block);
            }
        }
    }
    stores
}

/// Whether nothing but the return is behind the entry: no fault, no call, no way back.
fn always_returns(func: &Function, cfg: &Cfg) -> bool {
    let mut seen = EntitySet::new();
    cfg.reverse_postorder().iter().all(|&block| {
        let terminator = func.terminator(block);
        seen.insert(block);
        let mut insts = func.block(block).insts.iter();
        !matches!(terminator, Terminator::Fault(_))
            && !terminator.targets().iter().any(|t| seen.contains(t.block))
            && !insts.any(|&inst| matches!(func.inst(inst), InstData::Call { .. }))
    })
}

/// The variables that only the entry stores: at its end they are what they are at the return. Stored
/// there, what was computed for them is not kept, or computed again, behind branches.
fn early(func: &Function, stores: &[Vec<Block>]) -> Vec<bool> {
    let only_entry = [func.entry()];
    stores.iter().map(|blocks| *blocks == only_entry).collect()
}

/// Gives every join where different values of a variable meet a parameter for it; returns the
/// variables by block, in the order of the parameters, which stand behind those that were there.
fn place_params(
    func: &mut Function,
    cfg: &Cfg,
    dominators: &Dominators,
    stores: Vec<Vec<Block>>,
    promoted: &[Promoted],
) -> SecondaryMap<Block, Vec<(usize, Value)>> {
    let frontiers = frontiers(cfg, dominators);
    let mut joins: SecondaryMap<Block, Vec<(usize, Value)>> = SecondaryMap::new();
    for (variable, mut pending) in stores.into_iter().enumerate() {
        while let Some(block) = pending.pop() {
            for &join in &frontiers[block] {
                if joins[join].last().is_none_or(|(last, _)| *last != variable) {
                    let param = func.add_param(join, promoted[variable].ty);
                    joins[join].push((variable, param));
                    pending.push(join);
                }
            }
        }
    }
    joins
}

fn variable_of(variables: &HashMap<&Place, usize>, place: &Place) -> Option<usize> {
    variables.get(&variable_place(place)?).copied()
}

/// For each block the joins where what it dominates ends.
fn frontiers(cfg: &Cfg, dominators: &Dominators) -> SecondaryMap<Block, Vec<Block>> {
    let mut frontiers: SecondaryMap<Block, Vec<Block>> = SecondaryMap::new();
    for &join in cfg.reverse_postorder() {
        let end = dominators.immediate(join);
        let predecessors = cfg.predecessors(join).iter().copied();
        for from in predecessors.filter(|&from| cfg.is_reachable(from)) {
            let mut at = Some(from);
            while let Some(block) = at.filter(|_| at != end) {
                // Whoever has this join already has passed it on to its dominators.
                if frontiers[block].last() == Some(&join) {
                    break;
                }
                frontiers[block].push(join);
                at = dominators.immediate(block);
            }
        }
    }
    frontiers
}

enum Visit {
    Enter(Block),
    Leave(usize),
}

struct Renamer<'f> {
    func: &'f mut Function,
    promoted: &'f [Promoted],
    /// Which are stored at the end of the entry.
    early: Vec<bool>,
    variables: HashMap<&'f Place, usize>,
    joins: SecondaryMap<Block, Vec<(usize, Value)>>,
    children: SecondaryMap<Block, Vec<Block>>,
    replacements: Replacements,
    /// Values at the entry, made when needed.
    initial: Vec<Option<Value>>,
    prologue: Vec<Inst>,
    /// Values here; `None` is the initial one.
    current: Vec<Option<Value>>,
    /// What variables were before they changed.
    undo: Vec<(usize, Option<Value>)>,
    out: Vec<Inst>,
    origin: Option<Origin>,
}

impl Renamer<'_> {
    fn run(mut self) {
        let entry = self.func.entry();
        let mut stack = vec![Visit::Enter(entry)];
        while let Some(visit) = stack.pop() {
            match visit {
                Visit::Enter(block) => {
                    stack.push(Visit::Leave(self.undo.len()));
                    self.block(block);
                    let children = self.children[block].iter().rev();
                    stack.extend(children.map(|&child| Visit::Enter(child)));
                }
                Visit::Leave(len) => {
                    for (variable, value) in self.undo.drain(len..).rev() {
                        self.current[variable] = value;
                    }
                }
            }
        }
        self.func.block_mut(entry).insts.splice(0..0, self.prologue);
        self.replacements.apply(self.func);
    }

    fn block(&mut self, block: Block) {
        for index in 0..self.joins[block].len() {
            let (variable, param) = self.joins[block][index];
            self.set(variable, param);
        }
        for inst in std::mem::take(&mut self.func.block_mut(block).insts) {
            self.origin = self.func.origin(inst);
            self.inst(inst);
        }
        if block == self.func.entry() {
            self.store_all(true);
        }
        if matches!(self.func.terminator(block), Terminator::Return(_)) {
            self.store_all(false);
        }
        self.func.block_mut(block).insts = std::mem::take(&mut self.out);
        self.arguments(block);
    }

    fn inst(&mut self, inst: Inst) {
        let data = self.func.inst(inst).clone();
        let Some(variable) = data
            .place()
            .and_then(|place| variable_of(&self.variables, place))
        else {
            self.out.push(inst);
            return;
        };
        match data {
            InstData::Load { place } => {
                let word = self.get(variable);
                let value = match bit_of(&place) {
                    Some(bit) => self.take_bit(word, bit),
                    None => word,
                };
                self.replacements.replace(self.func.result(inst), value);
            }
            InstData::Store { place, value } => {
                let value = self.replacements.find(value);
                let value = match bit_of(&place).filter(|_| place.root != Root::Output) {
                    Some(bit) => {
                        let word = self.get(variable);
                        self.put_bit(word, bit, value)
                    }
                    None => value,
                };
                self.set(variable, value);
            }
            _ => self.out.push(inst),
        }
    }

    fn set(&mut self, variable: usize, value: Value) {
        self.undo.push((variable, self.current[variable]));
        self.current[variable] = Some(value);
    }

    fn get(&mut self, variable: usize) -> Value {
        self.current[variable].unwrap_or_else(|| self.initial(variable))
    }

    /// The old value: loaded; of a local 0; of an output anything, since it is stored on every way
    /// on.
    fn initial(&mut self, variable: usize) -> Value {
        if let Some(value) = self.initial[variable] {
            return value;
        }
        let Promoted { place, ty, .. } = &self.promoted[variable];
        let data = match place.root {
            Root::Output | Root::Local(_) => InstData::Const { ty: *ty, bits: 0 },
            Root::State | Root::Input | Root::Ref(_) | Root::Deref { .. } => InstData::Load {
                place: place.clone(),
            },
        };
        let inst = self.func.make_inst(data, &[*ty], None);
        self.prologue.push(inst);
        let value = self.func.result(inst);
        self.initial[variable] = Some(value);
        value
    }

    /// Stores what is to be stored here and not as it was; locals are gone with the return.
    fn store_all(&mut self, early: bool) {
        for (variable, promoted) in self.promoted.iter().enumerate() {
            if self.early[variable] != early {
                continue;
            }
            let current = self.current[variable].map(|value| self.replacements.find(value));
            let kept = promoted.is_stored && !promoted.is_local();
            let Some(value) = current.filter(|_| kept) else {
                continue;
            };
            if promoted.place.root == Root::Output || self.initial[variable] != Some(value) {
                let place = promoted.place.clone();
                let data = InstData::Store { place, value };
                let inst = self.func.make_inst(data, &[], None);
                self.out.push(inst);
            }
        }
    }

    fn arguments(&mut self, block: Block) {
        let mut terminator = self.func.terminator(block).clone();
        let mut changed = false;
        for target in terminator.targets_mut() {
            for index in 0..self.joins[target.block].len() {
                let (variable, _) = self.joins[target.block][index];
                target.args.push(self.get(variable));
                changed = true;
            }
        }
        if changed {
            let origin = self.func.block(block).terminator_origin;
            self.func.set_terminator(block, terminator, origin);
        }
    }

    fn emit(&mut self, data: InstData, ty: Type) -> Value {
        let inst = self.func.make_inst(data, &[ty], self.origin);
        self.out.push(inst);
        self.func.result(inst)
    }

    fn number(&mut self, ty: Type, bits: u64) -> Value {
        let bits = bits & ty.mask();
        self.emit(InstData::Const { ty, bits }, ty)
    }

    fn binary(&mut self, op: BinaryOp, left: Value, right: Value) -> Value {
        let ty = self.func.value_type(left);
        let args = [left, right];
        self.emit(InstData::Binary { op, args }, ty)
    }

    /// The value as another integer type of the same or another width, filled with 0.
    fn resize(&mut self, value: Value, to: Type) -> Value {
        let from = self.func.value_type(value);
        let op = match from.bits().cmp(&to.bits()) {
            std::cmp::Ordering::Equal => return value,
            std::cmp::Ordering::Less => ConvertOp::Zext,
            std::cmp::Ordering::Greater => ConvertOp::Trunc,
        };
        self.emit(InstData::Convert { op, to, arg: value }, to)
    }

    /// A word wide enough that every bit number above the real width stays a bit number that is
    /// not there, and the bit number in its type. Negative numbers are large ones.
    fn widened(&mut self, word: Value, number: Value) -> (Value, Value) {
        let number = self.replacements.find(number);
        let ty = self.func.value_type(word).max(Type::I32);
        (self.resize(word, ty), self.resize(number, ty))
    }

    fn take_bit(&mut self, word: Value, bit: Index) -> Value {
        let shifted = match bit {
            Index::Const(0) => word,
            Index::Const(bit) => {
                let count = self.number(self.func.value_type(word), u64::from(bit));
                self.binary(BinaryOp::Ushr, word, count)
            }
            Index::Value(number) => {
                let (word, count) = self.widened(word, number);
                self.binary(BinaryOp::Ushr, word, count)
            }
        };
        self.resize(shifted, Type::I1)
    }

    fn put_bit(&mut self, word: Value, bit: Index, value: Value) -> Value {
        let ty = self.func.value_type(word);
        match bit {
            Index::Const(bit) => {
                let others = self.number(ty, !(1 << bit));
                let cleared = self.binary(BinaryOp::And, word, others);
                let value = self.resize(value, ty);
                let count = self.number(ty, u64::from(bit));
                let shifted = self.binary(BinaryOp::Shl, value, count);
                self.binary(BinaryOp::Or, cleared, shifted)
            }
            Index::Value(number) => {
                let (wide, count) = self.widened(word, number);
                let wide_ty = self.func.value_type(wide);
                let one = self.number(wide_ty, 1);
                let mask = self.binary(BinaryOp::Shl, one, count);
                let set = self.binary(BinaryOp::Or, wide, mask);
                let arg = mask;
                let op = UnaryOp::Not;
                let others = self.emit(InstData::Unary { op, arg }, wide_ty);
                let cleared = self.binary(BinaryOp::And, wide, others);
                let args = [set, cleared];
                let cond = value;
                let chosen = self.emit(InstData::Select { cond, args }, wide_ty);
                self.resize(chosen, ty)
            }
        }
    }
}

fn bit_of(place: &Place) -> Option<Index> {
    match place.path.last() {
        Some(Projection::Bit(index)) => Some(*index),
        _ => None,
    }
}
