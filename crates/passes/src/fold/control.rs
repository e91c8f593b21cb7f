//! Control flow with nothing left in it: branches to one place, blocks that only jump on,
//! parameters that always get the same value, blocks with one way in.

use crate::rewrite::{Replacements, remove_unreachable};
use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::analysis::Cfg;
use iecc_ir::{Block, Function, Target, Terminator, Value, ValueDef};

/// How many empty blocks one jump skips at once.
const MAX_HOPS: usize = 64;

/// Simplifies the control flow of a function. Says whether something changed.
pub(super) fn simplify_control(func: &mut Function) -> bool {
    let collapsed = collapse_branches(func);
    let threaded = thread_jumps(func);
    let removed = remove_unreachable(func);
    let params = drop_redundant_params(func);
    let merged = merge_chains(func);
    collapsed || threaded || removed || params || merged
}

fn collapse_branches(func: &mut Function) -> bool {
    let mut changed = false;
    for block in func.layout.clone() {
        if let Some(simpler) = collapsed(func.terminator(block)) {
            let origin = func.block(block).terminator_origin;
            func.set_terminator(block, simpler, origin);
            changed = true;
        }
    }
    changed
}

fn collapsed(terminator: &Terminator) -> Option<Terminator> {
    match terminator {
        Terminator::Brif {
            then, otherwise, ..
        } => (then == otherwise).then(|| Terminator::Jump(then.clone())),
        Terminator::Switch {
            value,
            cases,
            default,
        } => {
            let differs = |(_, target): &&(u64, Target)| target != default;
            let cases: Vec<_> = cases.iter().filter(differs).cloned().collect();
            let before = terminator.targets().len() - 1;
            if cases.is_empty() {
                return Some(Terminator::Jump(default.clone()));
            }
            (cases.len() < before).then(|| Terminator::Switch {
                value: *value,
                cases,
                default: default.clone(),
            })
        }
        Terminator::Jump(_) | Terminator::Return(_) | Terminator::Fault(_) => None,
    }
}

/// Lets jumps to an empty block go where that block goes. Its parameters must be used in it alone:
/// blocks behind it may then have other ways in.
fn thread_jumps(func: &mut Function) -> bool {
    let is_empty = |block: &Block| func.block(*block).insts.is_empty();
    if !func.layout.iter().skip(1).any(is_empty) {
        return false;
    }
    let skippable = Skippable::new(func);
    let mut changed = false;
    for block in func.layout.clone() {
        if !skippable.is_behind(func, block) {
            continue;
        }
        let mut terminator = func.terminator(block).clone();
        let mut rewritten = false;
        for target in terminator.targets_mut() {
            for _ in 0..MAX_HOPS {
                let Some(next) = skippable.next(func, target) else {
                    break;
                };
                *target = next;
                rewritten = true;
            }
        }
        if rewritten {
            let origin = func.block(block).terminator_origin;
            func.set_terminator(block, terminator, origin);
            changed = true;
        }
    }
    changed
}

struct Skippable {
    empty: EntitySet<Block>,
    /// Skipping a branch at the head of a loop could give the loop two entries.
    heads: EntitySet<Block>,
}

impl Skippable {
    fn new(func: &Function) -> Self {
        let cfg = Cfg::new(func);
        let mut skippable = Self {
            empty: EntitySet::new(),
            heads: loop_heads(&cfg),
        };
        let shared = blocks_whose_params_are_used_elsewhere(func);
        for &block in &cfg.reverse_postorder()[1..] {
            if func.block(block).insts.is_empty() && !shared.contains(block) {
                skippable.empty.insert(block);
            }
        }
        skippable
    }

    /// Whether a block jumps to an empty one.
    fn is_behind(&self, func: &Function, block: Block) -> bool {
        let targets = func.terminator(block).targets();
        targets
            .iter()
            .any(|target| self.empty.contains(target.block))
    }

    /// Where a jump to `target` ends up, if it can skip the target.
    fn next(&self, func: &Function, target: &Target) -> Option<Target> {
        let block = target.block;
        if !self.empty.contains(block) {
            return None;
        }
        let params = &func.block(block).params;
        let passed = |value: Value| {
            let position = params.iter().position(|&param| param == value);
            position.map_or(value, |position| target.args[position])
        };
        let next = match func.terminator(block) {
            Terminator::Jump(next) => next,
            Terminator::Brif { .. } | Terminator::Switch { .. } if self.heads.contains(block) => {
                return None;
            }
            Terminator::Brif {
                cond,
                then,
                otherwise,
            } => match func.constant(passed(*cond))? {
                0 => otherwise,
                _ => then,
            },
            Terminator::Switch {
                value,
                cases,
                default,
            } => {
                let bits = func.constant(passed(*value))?;
                let case = cases.iter().find(|(number, _)| *number == bits);
                case.map_or(default, |(_, target)| target)
            }
            Terminator::Return(_) | Terminator::Fault(_) => return None,
        };
        (next.block != block).then(|| Target {
            block: next.block,
            args: next.args.iter().map(|&v| passed(v)).collect(),
        })
    }
}

fn loop_heads(cfg: &Cfg) -> EntitySet<Block> {
    let (mut seen, mut heads) = (EntitySet::new(), EntitySet::new());
    for &block in cfg.reverse_postorder() {
        seen.insert(block);
        let back = cfg.successors(block).iter();
        back.filter(|&&to| seen.contains(to)).for_each(|&to| {
            heads.insert(to);
        });
    }
    heads
}

fn blocks_whose_params_are_used_elsewhere(func: &Function) -> EntitySet<Block> {
    let mut shared = EntitySet::new();
    for &block in &func.layout {
        let insts = func.block(block).insts.iter();
        let read = insts.flat_map(|&inst| func.inst(inst).values());
        for value in read.chain(func.terminator(block).values()) {
            if let ValueDef::Param(home, _) = func.value_def(value)
                && home != block
            {
                shared.insert(home);
            }
        }
    }
    shared
}

/// Replaces parameters that get one value only, themselves aside, by that value.
fn drop_redundant_params(func: &mut Function) -> bool {
    let has_params = |block: &Block| !func.block(*block).params.is_empty();
    if !func.layout.iter().skip(1).any(has_params) {
        return false;
    }
    let cfg = Cfg::new(func);
    let mut replacements = Replacements::default();
    let mut dropped: SecondaryMap<Block, Vec<bool>> = SecondaryMap::new();
    for &block in &cfg.reverse_postorder()[1..] {
        let only = only_arguments(func, &cfg, block, &mut replacements);
        let params = func.block(block).params.clone();
        dropped[block] = only.iter().map(Option::is_some).collect();
        for (&param, only) in params.iter().zip(only) {
            if let Some(value) = only {
                replacements.replace(param, value);
            }
        }
    }
    for &block in &cfg.reverse_postorder()[1..] {
        let drop = &dropped[block];
        if drop.contains(&true) {
            func.retain_params(block, cfg.predecessors(block), |index| !drop[index]);
        }
    }
    replacements.apply(func)
}

/// For each parameter the only value it gets, if there is just one besides itself.
fn only_arguments(
    func: &Function,
    cfg: &Cfg,
    block: Block,
    replacements: &mut Replacements,
) -> Vec<Option<Value>> {
    let params = &func.block(block).params;
    let mut found: Vec<Option<Value>> = vec![None; params.len()];
    let mut several = vec![false; params.len()];
    if params.is_empty() {
        return found;
    }
    for &from in cfg.predecessors(block) {
        let targets = func.terminator(from).targets();
        for target in targets.into_iter().filter(|target| target.block == block) {
            for (index, &arg) in target.args.iter().enumerate() {
                let arg = replacements.find(arg);
                if arg != params[index] {
                    several[index] |= found[index].is_some_and(|other| other != arg);
                    found[index] = Some(arg);
                }
            }
        }
    }
    let keep = found.into_iter().zip(several);
    keep.map(|(value, several)| value.filter(|_| !several))
        .collect()
}

/// Puts blocks with one way in behind the block that jumps there.
fn merge_chains(func: &mut Function) -> bool {
    let mut ways_in: SecondaryMap<Block, u32> = SecondaryMap::new();
    for &block in &func.layout {
        for target in func.terminator(block).targets() {
            ways_in[target.block] += 1;
        }
    }
    let mut replacements = Replacements::default();
    let mut merged = EntitySet::<Block>::new();
    for block in func.layout.clone() {
        if merged.contains(block) {
            continue;
        }
        while let Some(next) = sole_successor(func, block, &ways_in) {
            merge(func, block, &next, &mut replacements);
            merged.insert(next.block);
        }
    }
    func.layout.retain(|&block| !merged.contains(block));
    replacements.apply(func);
    !merged.is_empty()
}

fn sole_successor(
    func: &Function,
    block: Block,
    ways_in: &SecondaryMap<Block, u32>,
) -> Option<Target> {
    match func.terminator(block) {
        Terminator::Jump(target) if ways_in[target.block] == 1 && target.block != block => {
            Some(target.clone())
        }
        Terminator::Jump(_)
        | Terminator::Brif { .. }
        | Terminator::Switch { .. }
        | Terminator::Return(_)
        | Terminator::Fault(_) => None,
    }
}

fn merge(func: &mut Function, block: Block, next: &Target, replacements: &mut Replacements) {
    let behind = std::mem::take(func.block_mut(next.block));
    for (&param, &arg) in behind.params.iter().zip(&next.args) {
        replacements.replace(param, arg);
    }
    let data = func.block_mut(block);
    data.insts.extend(behind.insts);
    data.terminator = behind.terminator;
    data.terminator_origin = behind.terminator_origin;
}
