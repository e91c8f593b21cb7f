//! Dead code: what nobody can see is dropped.
//!
//! After it, every instruction left either has an effect or has a result that matters, every block
//! is reachable, every block parameter is read, and every function is called. "Matters" is found
//! optimistically, so values that only feed each other around a loop go too. Stores stay: whether
//! a leaf of the state matters is a question about all scans, which the pass `state` answers. But a
//! local that nothing reads goes with all stores to it.

mod locals;

use crate::functions::remove_uncalled;
use crate::rewrite::remove_unreachable;
use cranelift_entity::EntitySet;
use iecc_ir::analysis::Cfg;
use iecc_ir::{Block, Function, Module, Terminator, Value, ValueDef};

/// Drops dead code and functions.
pub(crate) fn dce(module: &mut Module) {
    for func in module.funcs.values_mut() {
        remove_unreachable(func);
        sweep(func);
        if locals::remove_unread(func) {
            sweep(func);
        }
    }
    remove_uncalled(module);
}

fn sweep(func: &mut Function) {
    let cfg = Cfg::new(func);
    let live = Liveness::of(func, &cfg).live;
    for block in func.layout.clone() {
        let mut insts = std::mem::take(&mut func.block_mut(block).insts);
        insts.retain(|&inst| {
            func.inst(inst).has_effect() || func.results_of(inst).iter().any(|&v| live.contains(v))
        });
        func.block_mut(block).insts = insts;
    }
    for &block in &func.layout.clone()[1..] {
        let params = func.block(block).params.clone();
        if params.iter().any(|&param| !live.contains(param)) {
            let is_live = |index: usize| live.contains(params[index]);
            func.retain_params(block, cfg.predecessors(block), is_live);
        }
    }
}

struct Liveness<'f> {
    func: &'f Function,
    cfg: &'f Cfg,
    live: EntitySet<Value>,
    pending: Vec<Value>,
}

impl<'f> Liveness<'f> {
    fn of(func: &'f Function, cfg: &'f Cfg) -> Self {
        let mut liveness = Self {
            func,
            cfg,
            live: EntitySet::new(),
            pending: Vec::new(),
        };
        for &block in &func.layout {
            liveness.roots(block);
        }
        while let Some(value) = liveness.pending.pop() {
            liveness.operands(value);
        }
        liveness
    }

    fn mark(&mut self, value: Value) {
        if self.live.insert(value) {
            self.pending.push(value);
        }
    }

    /// What effects and decisions read. Arguments of jumps matter only if the parameter does.
    fn roots(&mut self, block: Block) {
        let func = self.func;
        for &inst in &func.block(block).insts {
            if func.inst(inst).has_effect() {
                func.inst(inst)
                    .values()
                    .into_iter()
                    .for_each(|v| self.mark(v));
            }
        }
        match func.terminator(block) {
            Terminator::Brif { cond: value, .. } | Terminator::Switch { value, .. } => {
                self.mark(*value);
            }
            Terminator::Return(values) => values.iter().for_each(|&v| self.mark(v)),
            Terminator::Jump(_) | Terminator::Fault(_) => {}
        }
    }

    fn operands(&mut self, value: Value) {
        let func = self.func;
        match func.value_def(value) {
            ValueDef::Result(inst, _) => {
                func.inst(inst)
                    .values()
                    .into_iter()
                    .for_each(|v| self.mark(v));
            }
            ValueDef::Param(block, index) => {
                let cfg = self.cfg;
                for &from in cfg.predecessors(block) {
                    let targets = func.terminator(from).targets();
                    for target in targets.into_iter().filter(|target| target.block == block) {
                        self.mark(target.args[index as usize]);
                    }
                }
            }
        }
    }
}
