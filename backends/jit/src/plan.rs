//! What the compiler must know about all functions before it compiles one: which are needed, which
//! can end a scan, which must count their work, and which references can be absent.
//!
//! Work is counted so that no program can hang its user. A function is *metered* if it has a loop,
//! calls a metered function, or could by calls alone (each function calling the next twice) do more
//! than [`FREE_WORK`] instructions. Everything else runs uncounted. In a metered function the entry
//! and every jump back pay for what runs until the next payment, so the budget of a scan bounds its
//! work, also with irreducible loops: every cycle contains a jump that goes back in reverse
//! postorder.

use cranelift_entity::{EntityRef, EntitySet, SecondaryMap};
use iecc_ir::analysis::{Cfg, Dominators, Loops};
use iecc_ir::{Block, FuncId, Function, InstData, Module, Place, RefParam, Root, Terminator};
use std::collections::BTreeMap;

/// Most instructions a function without loops may execute uncounted, its callees included.
const FREE_WORK: u64 = 1 << 22;

/// What is known about one function.
#[derive(Debug, Clone, Default)]
pub(crate) struct Facts {
    /// It, or a function it calls, can abandon the scan; so it returns a status.
    pub(crate) can_fault: bool,
    /// It counts its work.
    pub(crate) metered: bool,
    /// Instructions executed when every block runs once, those of unmetered callees included.
    pub(crate) work: u64,
    /// References that can stand for an element outside its array: loads through them give 0 and
    /// stores do nothing.
    pub(crate) absent_refs: EntitySet<RefParam>,
    /// Instructions to pay for at the end of a block that jumps back.
    pub(crate) payments: BTreeMap<Block, u64>,
}

/// The functions of a scan.
#[derive(Debug)]
pub(crate) struct Plan {
    /// What the scan reaches, callees before callers.
    pub(crate) order: Vec<FuncId>,
    facts: SecondaryMap<FuncId, Facts>,
}

impl Plan {
    /// Looks at every function the scan reaches.
    pub(crate) fn new(module: &Module) -> Self {
        let order = callees_first(module);
        let mut plan = Self {
            order: order.clone(),
            facts: SecondaryMap::new(),
        };
        for &id in &order {
            let facts = plan.examine(&module.funcs[id]);
            plan.facts[id] = facts;
        }
        for &id in order.iter().rev() {
            plan.pass_absent_refs(id, &module.funcs[id]);
        }
        plan
    }

    /// The facts about a function the scan reaches.
    pub(crate) fn facts(&self, func: FuncId) -> &Facts {
        &self.facts[func]
    }

    fn examine(&self, func: &Function) -> Facts {
        let cfg = Cfg::new(func);
        let mut facts = Facts::default();
        for &block in cfg.reverse_postorder() {
            facts.work = facts.work.saturating_add(self.block_work(func, block));
            facts.can_fault |= matches!(func.terminator(block), Terminator::Fault(_));
            for callee in calls(func, block) {
                facts.can_fault |= self.facts[callee].can_fault;
                facts.metered |= self.facts[callee].metered;
            }
        }
        facts.payments = self.payments(func, &cfg, facts.work);
        facts.metered |= !facts.payments.is_empty() || facts.work > FREE_WORK;
        facts.can_fault |= facts.metered;
        facts
    }

    fn block_work(&self, func: &Function, block: Block) -> u64 {
        let own = func.block(block).insts.len() as u64 + 1;
        calls(func, block)
            .map(|callee| &self.facts[callee])
            .filter(|callee| !callee.metered)
            .fold(own, |sum, callee| sum.saturating_add(callee.work))
    }

    /// Natural loops pay for their blocks, jumps back into irreducible ones for the whole function.
    fn payments(&self, func: &Function, cfg: &Cfg, work: u64) -> BTreeMap<Block, u64> {
        let mut position = SecondaryMap::with_default(0);
        for (index, &block) in cfg.reverse_postorder().iter().enumerate() {
            position[block] = index;
        }
        let mut payments = BTreeMap::new();
        for &block in cfg.reverse_postorder() {
            let back = |&to: &Block| position[to] <= position[block];
            if cfg.successors(block).iter().copied().any(|to| back(&to)) {
                payments.insert(block, work);
            }
        }
        if payments.is_empty() {
            return payments;
        }
        let loops = Loops::new(cfg, &Dominators::new(cfg));
        if loops.irreducible.is_none() {
            payments.clear();
            for each in &loops.natural {
                let body = each.blocks.iter().map(|&b| self.block_work(func, b));
                let body = body.fold(0, u64::saturating_add);
                for &latch in &each.latches {
                    let payment = payments.entry(latch).or_insert(0);
                    *payment = body.max(*payment);
                }
            }
        }
        payments
    }

    /// Callers come first, so what `func` itself is passed is known.
    fn pass_absent_refs(&mut self, id: FuncId, func: &Function) {
        for &block in &func.layout {
            for &inst in &func.block(block).insts {
                let InstData::Call {
                    func: callee, refs, ..
                } = func.inst(inst)
                else {
                    continue;
                };
                for (index, place) in refs.iter().enumerate() {
                    if self.can_be_absent(id, place) {
                        self.facts[*callee].absent_refs.insert(RefParam::new(index));
                    }
                }
            }
        }
    }

    /// Whether the place may lie outside an array when `func` runs.
    pub(crate) fn can_be_absent(&self, func: FuncId, place: &Place) -> bool {
        let inherited = match place.root {
            Root::Ref(param) => self.facts[func].absent_refs.contains(param),
            Root::State | Root::Input | Root::Output => false,
        };
        inherited || !place.is_static()
    }
}

/// The callees of a block, in order.
pub(crate) fn calls(func: &Function, block: Block) -> impl Iterator<Item = FuncId> + '_ {
    let insts = func.block(block).insts.iter();
    insts.filter_map(|&inst| match func.inst(inst) {
        InstData::Call { func, .. } => Some(*func),
        InstData::Const { .. }
        | InstData::Unary { .. }
        | InstData::Binary { .. }
        | InstData::Compare { .. }
        | InstData::Convert { .. }
        | InstData::Select { .. }
        | InstData::Load { .. }
        | InstData::Store { .. }
        | InstData::Now
        | InstData::Elapsed { .. }
        | InstData::Step { .. } => None,
    })
}

/// Postorder over calls with a stack of our own, so that deep chains of calls are harmless.
fn callees_first(module: &Module) -> Vec<FuncId> {
    let callees = |id: FuncId| {
        let func = &module.funcs[id];
        let all: Vec<FuncId> = func.layout.iter().flat_map(|&b| calls(func, b)).collect();
        all.into_iter()
    };
    let (mut order, mut seen) = (Vec::new(), EntitySet::<FuncId>::new());
    seen.insert(module.scan);
    let mut path = vec![(module.scan, callees(module.scan))];
    while let Some((func, rest)) = path.last_mut() {
        match rest.next() {
            Some(callee) if seen.insert(callee) => path.push((callee, callees(callee))),
            Some(_) => {}
            None => {
                order.push(*func);
                path.pop();
            }
        }
    }
    order
}
