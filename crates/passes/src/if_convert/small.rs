//! Small choices: a branch around a handful of cheap operations costs more than doing them.
//!
//! A flag that only picks a number stays a branch: see [`compares`].
//!
//! A store in an arm becomes a store behind both, of what the arm stores or what was there before.

use crate::rewrite::{Replacements, remove_unreachable};
use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::analysis::Cfg;
use iecc_ir::{
    BinaryOp, Block, Function, InstData, Module, Place, Root, Target, Terminator, Type, UnaryOp,
    Value,
};

/// How many operations both arms may have together, and how many choices may come of it.
const MAX_OPERATIONS: usize = 8;
const MAX_CHOICES: usize = 3;

/// Converts branches whose arms are cheap and meet at once, inner ones first. Loops and faults
/// elsewhere do not matter.
pub(crate) fn if_convert_small(module: &mut Module) {
    // Storing what was loaded makes a bit of any byte that an address may have put there.
    let with_stores = !module.has_addresses();
    for func in module.funcs.values_mut() {
        convert(func, with_stores);
    }
}

fn convert(func: &mut Function, with_stores: bool) {
    remove_unreachable(func);
    let mut ways_in: SecondaryMap<Block, u32> = SecondaryMap::new();
    for &block in &func.layout {
        for target in func.terminator(block).targets() {
            ways_in[target.block] += 1;
        }
    }
    let mut conversion = Conversion {
        ways_in,
        gone: EntitySet::new(),
        replacements: Replacements::default(),
    };
    let order = Cfg::new(func).reverse_postorder().to_vec();
    for &block in order.iter().rev() {
        while let Some(choice) = Choice::at(func, block, &conversion.ways_in, with_stores) {
            conversion.write(func, block, choice);
        }
    }
    func.layout
        .retain(|&block| !conversion.gone.contains(block));
    conversion.replacements.apply(func);
}

struct Conversion {
    ways_in: SecondaryMap<Block, u32>,
    gone: EntitySet<Block>,
    replacements: Replacements,
}

impl Conversion {
    fn write(&mut self, func: &mut Function, block: Block, choice: Choice) {
        let origin = func.block(block).terminator_origin;
        for arm in choice.arms.into_iter().flatten() {
            let mut insts = std::mem::take(&mut func.block_mut(arm).insts);
            insts.retain(|&inst| stored(func.inst(inst)).is_none());
            func.block_mut(block).insts.extend(insts);
            self.gone.insert(arm);
        }
        sink(func, block, &choice);
        let [yes, no] = choice.ends;
        let mut target = Target::new(yes.block);
        for (&yes, &no) in yes.args.iter().zip(&no.args) {
            let args = [yes, no].map(|value| self.replacements.find(value));
            let value = if args[0] == args[1] {
                args[0]
            } else {
                let cond = choice.cond;
                let ty = func.value_type(yes);
                let data = InstData::Select { cond, args };
                let inst = func.append_inst(block, data, &[ty], origin);
                func.result(inst)
            };
            target.args.push(value);
        }
        self.ways_in[target.block] -= 1;
        if self.ways_in[target.block] == 1 {
            self.merge(func, block, &target);
        } else {
            func.set_terminator(block, Terminator::Jump(target), origin);
        }
    }

    /// Goes on in the block where the arms met, so that a branch around it finds one arm.
    fn merge(&mut self, func: &mut Function, block: Block, next: &Target) {
        let behind = std::mem::take(func.block_mut(next.block));
        for (&param, &arg) in behind.params.iter().zip(&next.args) {
            self.replacements.replace(param, arg);
        }
        let data = func.block_mut(block);
        data.insts.extend(behind.insts);
        data.terminator = behind.terminator;
        data.terminator_origin = behind.terminator_origin;
        self.gone.insert(next.block);
    }
}

/// A branch that can be converted.
struct Choice {
    cond: Value,
    arms: [Option<Block>; 2],
    /// What each arm passes to the block where they meet.
    ends: [Target; 2],
    /// What each arm leaves where; nothing where `None`.
    stores: Vec<(Place, [Option<Value>; 2])>,
}

impl Choice {
    fn at(
        func: &Function,
        block: Block,
        ways_in: &SecondaryMap<Block, u32>,
        with_stores: bool,
    ) -> Option<Self> {
        let Terminator::Brif {
            cond,
            then,
            otherwise,
        } = func.terminator(block)
        else {
            return None;
        };
        let sides = [then, otherwise].map(|target| arm(func, target, ways_in));
        // Either both arms meet, or one of them is the block where the other ends.
        let candidates = [
            (sides[0].clone(), sides[1].clone()),
            (sides[0].clone(), Some((None, otherwise.clone()))),
            (Some((None, then.clone())), sides[1].clone()),
            (Some((None, then.clone())), Some((None, otherwise.clone()))),
        ];
        let (a, b) = candidates.into_iter().find_map(|(a, b)| {
            let (a, b) = (a?, b?);
            (a.1.block == b.1.block && a.1.block != block).then_some((a, b))
        })?;
        let arms = [a.0, b.0];
        let choice = Self {
            cond: *cond,
            arms,
            ends: [a.1, b.1],
            stores: stores(func, arms),
        };
        let can_sink = choice.stores.is_empty() || (with_stores && are_apart(&choice.stores));
        (can_sink && choice.is_cheap(func)).then_some(choice)
    }

    fn is_cheap(&self, func: &Function) -> bool {
        let arms = self.arms.iter().flatten();
        let insts = arms.flat_map(|&arm| &func.block(arm).insts);
        let is_free =
            |data: &InstData| matches!(data, InstData::Const { .. } | InstData::Store { .. });
        let operations = insts.filter(|&&inst| !is_free(func.inst(inst))).count();
        let differ = self.ends[0].args.iter().zip(&self.ends[1].args);
        let choices = differ.filter(|(a, b)| a != b).count() + self.stores.len();
        operations <= MAX_OPERATIONS
            && choices <= MAX_CHOICES
            && (operations > 0 || compares(func, self.cond) || self.chooses_bits(func))
    }

    /// Whether bits depend on the condition, of which choices are logic.
    fn chooses_bits(&self, func: &Function) -> bool {
        let passed = self.ends[0].args.iter().zip(&self.ends[1].args);
        let passed = passed.filter(|(a, b)| a != b).map(|(&a, _)| a);
        let stored = self.stores.iter().filter_map(|(_, [a, b])| a.or(*b));
        let mut values = passed.chain(stored);
        values.any(|value| func.value_type(value) == Type::I1)
    }
}

/// Whether a condition compares values. One that does not is made of flags, which seldom change from
/// scan to scan: the processor foresees the branch, while a choice would wait for the flag, often
/// stored just before by the caller, and all that comes behind would wait for the choice.
fn compares(func: &Function, cond: Value) -> bool {
    matches!(func.def_inst(cond), Some(InstData::Compare { .. }))
}

/// A block with one way in, cheap operations only, and a jump; and what it passes on.
fn arm(
    func: &Function,
    target: &Target,
    ways_in: &SecondaryMap<Block, u32>,
) -> Option<(Option<Block>, Target)> {
    let data = func.block(target.block);
    let mut has_stored = false;
    let cheap = data.insts.iter().all(|&inst| {
        let data = func.inst(inst);
        let is_store = is_sinkable(func, data);
        // A load behind a store of its arm would have to see it.
        let in_order = !(has_stored && matches!(data, InstData::Load { .. }));
        has_stored |= is_store;
        in_order && (is_store || is_cheap(data))
    });
    match func.terminator(target.block) {
        Terminator::Jump(end) if cheap && data.params.is_empty() && ways_in[target.block] == 1 => {
            Some((Some(target.block), end.clone()))
        }
        _ => None,
    }
}

fn is_cheap(data: &InstData) -> bool {
    match data {
        InstData::Binary { op, .. } => !matches!(
            op,
            BinaryOp::Sdiv | BinaryOp::Udiv | BinaryOp::Srem | BinaryOp::Urem | BinaryOp::Fdiv
        ),
        InstData::Unary { op, .. } => *op != UnaryOp::Fsqrt,
        InstData::Step { .. } => false,
        // Every load is legal; one from a fixed place is a few cycles.
        InstData::Load { place } => place.is_static(),
        data => data.is_pure(),
    }
}

/// A store of an integer at a fixed place that can be loaded.
fn is_sinkable(func: &Function, data: &InstData) -> bool {
    stored(data).is_some_and(|(place, value)| {
        let is_known = match place.root {
            Root::State | Root::Ref(_) | Root::Local(_) => place.is_static(),
            Root::Input | Root::Output | Root::Deref { .. } => false,
        };
        is_known && func.value_type(value).is_int()
    })
}

fn stored(data: &InstData) -> Option<(&Place, Value)> {
    match data {
        InstData::Store { place, value } => Some((place, *value)),
        _ => None,
    }
}

/// What two arms leave in memory, place by place.
fn stores(func: &Function, arms: [Option<Block>; 2]) -> Vec<(Place, [Option<Value>; 2])> {
    let mut all: Vec<(Place, [Option<Value>; 2])> = Vec::new();
    for (side, arm) in arms.into_iter().enumerate() {
        let insts = arm.into_iter().flat_map(|arm| &func.block(arm).insts);
        for (place, value) in insts.filter_map(|&inst| stored(func.inst(inst))) {
            match all.iter_mut().find(|(known, _)| known == place) {
                Some((_, values)) => values[side] = Some(value),
                None => {
                    let mut values = [None; 2];
                    values[side] = Some(value);
                    all.push((place.clone(), values));
                }
            }
        }
    }
    all
}

/// Whether no two places can be the same memory.
fn are_apart(stores: &[(Place, [Option<Value>; 2])]) -> bool {
    let meet = |a: &Place, b: &Place| match a.root == b.root {
        true => a.may_overlap(b),
        false => a.root.may_alias() && b.root.may_alias(),
    };
    let rest = |index: usize| stores[index + 1..].iter();
    stores
        .iter()
        .enumerate()
        .all(|(index, (a, _))| rest(index).all(|(b, _)| !meet(a, b)))
}

/// Stores behind the arms: what was there is loaded before anything is stored.
fn sink(func: &mut Function, block: Block, choice: &Choice) {
    let origin = func.block(block).terminator_origin;
    let mut values = Vec::with_capacity(choice.stores.len());
    for (place, sides) in &choice.stores {
        let ty = func.value_type(sides[0].or(sides[1]).expect("one arm stores"));
        let args = sides.map(|side| {
            side.unwrap_or_else(|| {
                let place = place.clone();
                let inst = func.append_inst(block, InstData::Load { place }, &[ty], origin);
                func.result(inst)
            })
        });
        let cond = choice.cond;
        let data = InstData::Select { cond, args };
        let inst = func.append_inst(block, data, &[ty], origin);
        values.push(func.result(inst));
    }
    for ((place, _), value) in choice.stores.iter().zip(values) {
        let place = place.clone();
        func.append_inst(block, InstData::Store { place, value }, &[], origin);
    }
}
