//! What the compiler must know about all functions before it compiles one: which are needed, which
//! can end a scan, which must count their work, and which references can be absent.
//!
//! Work is counted so that no program can hang its user. A function is *metered* if it has a loop,
//! calls a metered function, or could by calls alone (each function calling the next twice) do more
//! than [`FREE_WORK`] instructions. Everything else runs uncounted. In a metered function the entry
//! and every jump back pay for what runs until the next payment, so the budget of a scan bounds its
//! work, also with irreducible loops: every cycle contains a jump that goes back in reverse
//! postorder. A loop that surely goes round so often, and not very often, is part of the work of its function:
//! it is paid for ahead. A loop that counts is paid for where it is entered, with as many rounds as there can be, and
//! at most twice as many as there are.

use crate::aside::blocks_aside;
use cranelift_entity::{EntityRef, EntitySet, SecondaryMap};
use iecc_ir::analysis::{Cfg, Counted, Dominators, LocalRanges, Loop, Loops, callees_first};
use iecc_ir::{
    Block, FuncId, Function, InstData, Layout, MemType, Module, Place, RefParam, Root, Terminator,
    Value,
};
use std::collections::BTreeMap;

/// Most instructions a function without loops may execute uncounted, its callees included.
const FREE_WORK: u64 = 1 << 22;

/// Most instructions of a loop that is paid for ahead.
const AHEAD_WORK: u64 = 1 << 20;

/// Bytes that are moved or made 0 for the work of one instruction.
const BYTES_PER_WORK: u64 = 64;

/// Most bytes of locals that lie on the stack; those of a function with more have memory of the
/// engine.
const STACK_LOCAL_BYTES: u64 = 4 << 10;

/// Where the locals of a function lie.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Locals {
    /// It has none.
    #[default]
    None,
    /// In so many bytes of its stack frame.
    Stack(u32),
    /// In the engine's memory for locals. No function calls itself, so each has a place of its own.
    Engine {
        /// Where they begin there.
        offset: u64,
        /// How many bytes they take.
        bytes: u64,
    },
}

/// What is known about one function.
#[derive(Debug, Clone, Default)]
pub(crate) struct Facts {
    /// It, or a function it calls, can abandon the scan; so it returns a status.
    pub(crate) can_fault: bool,
    /// It counts its work.
    pub(crate) metered: bool,
    /// Where its locals lie.
    pub(crate) locals: Locals,
    /// Instructions executed when every block runs once, those of unmetered callees included.
    pub(crate) work: u64,
    /// References that can stand for an element outside its array: loads through them give 0 and
    /// stores do nothing.
    pub(crate) absent_refs: EntitySet<RefParam>,
    /// Instructions to pay for at the end of a block that jumps back.
    pub(crate) payments: BTreeMap<Block, u64>,
    /// What to pay at the end of a block that enters loops.
    pub(crate) entries: BTreeMap<Block, Vec<Entry>>,
    /// What its integers can be, if it counts or computes indices.
    pub(crate) ranges: Option<LocalRanges>,
    /// Blocks whose machine code lies behind that of the others.
    pub(crate) aside: EntitySet<Block>,
}

/// A way into a loop whose rounds are paid for there.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) counted: Counted,
    /// What the counter is at first.
    pub(crate) first: Value,
    /// Instructions of a round.
    pub(crate) work: u64,
}

/// The functions of a scan.
#[derive(Debug)]
pub(crate) struct Plan {
    /// What the scan reaches, callees before callers.
    pub(crate) order: Vec<FuncId>,
    facts: SecondaryMap<FuncId, Facts>,
    /// Memory the engine provides for locals.
    pub(crate) local_bytes: u64,
    /// Bytes of the state.
    pub(crate) state_len: u64,
    /// Bytes that lie behind its start: what is absent is read there.
    pub(crate) state_bytes: u64,
    /// Whether the state is also accessed by addresses, so that an `i1` may be any byte.
    pub(crate) has_addresses: bool,
}

impl Plan {
    /// Looks at every function the scan reaches.
    pub(crate) fn new(module: &Module, layout: &Layout) -> Self {
        let order = callees_first(module, [module.scan]);
        let state_len = layout.size(&module.types, MemType::Struct(module.state));
        let mut plan = Self {
            order: order.clone(),
            facts: SecondaryMap::new(),
            local_bytes: 0,
            state_len,
            // One more, so that its end is no place of other memory.
            state_bytes: state_len + 1,
            has_addresses: module.has_addresses(),
        };
        for &id in &order {
            let facts = plan.examine(module, layout, &module.funcs[id]);
            plan.facts[id] = facts;
        }
        for &id in order.iter().rev() {
            plan.pass_absent_refs(id, &module.funcs[id]);
            plan.reserve_for_absent(module, layout, id);
        }
        plan
    }

    /// The facts about a function the scan reaches.
    pub(crate) fn facts(&self, func: FuncId) -> &Facts {
        &self.facts[func]
    }

    fn examine(&mut self, module: &Module, layout: &Layout, func: &Function) -> Facts {
        let cfg = Cfg::new(func);
        let mut facts = Facts::default();
        let mut loops = Loops::default();
        let goes_back = cfg.jumps_back().next().is_some();
        if goes_back || has_computed_indices(func) {
            let dominators = Dominators::new(&cfg);
            loops = Loops::new(&cfg, &dominators);
            facts.ranges = Some(LocalRanges::new(func, &cfg, &dominators, &loops));
            facts.aside = blocks_aside(func, &cfg, &dominators, &loops);
        }
        let (_, local_bytes) = layout.locals(&module.types, func);
        facts.locals = self.place_locals(local_bytes);
        facts.work = local_bytes / BYTES_PER_WORK;
        let own = |block| own_work(module, layout, func, block);
        for &block in cfg.reverse_postorder() {
            facts.work = facts
                .work
                .saturating_add(self.block_work(func, block, &own));
            facts.can_fault |= matches!(func.terminator(block), Terminator::Fault(_));
            for callee in func.calls_in(block) {
                facts.can_fault |= self.facts[callee].can_fault;
                facts.metered |= self.facts[callee].metered;
            }
        }
        self.add_payments(&mut facts, func, &cfg, &loops, &own);
        facts.metered |= !facts.payments.is_empty() || !facts.entries.is_empty();
        facts.metered |= facts.work > FREE_WORK;
        facts.can_fault |= facts.metered;
        facts
    }

    fn place_locals(&mut self, bytes: u64) -> Locals {
        match bytes {
            0 => Locals::None,
            1..=STACK_LOCAL_BYTES => Locals::Stack(bytes as u32),
            _ => {
                let offset = self.local_bytes;
                self.local_bytes += bytes;
                Locals::Engine { offset, bytes }
            }
        }
    }

    fn block_work(&self, func: &Function, block: Block, own: &dyn Fn(Block) -> u64) -> u64 {
        let own = own(block);
        func.calls_in(block)
            .map(|callee| &self.facts[callee])
            .filter(|callee| !callee.metered)
            .fold(own, |sum, callee| sum.saturating_add(callee.work))
    }

    /// Natural loops pay for their blocks, jumps back into irreducible ones for the whole function.
    fn add_payments(
        &self,
        facts: &mut Facts,
        func: &Function,
        cfg: &Cfg,
        loops: &Loops,
        own: &dyn Fn(Block) -> u64,
    ) {
        if loops.irreducible.is_some() {
            let work = facts.work;
            facts.payments = cfg.jumps_back().map(|block| (block, work)).collect();
            return;
        }
        let work = |each: &Loop| {
            let body = each.blocks.iter().map(|&b| self.block_work(func, b, own));
            body.fold(0, u64::saturating_add)
        };
        for each in &loops.natural {
            let body = work(each);
            if let Some(ahead) = rounds(facts, loops, each).map(|n| n.saturating_mul(body))
                && ahead <= AHEAD_WORK
            {
                facts.work = facts.work.saturating_add(ahead);
                continue;
            }
            if !self.may_end_early(facts, func, cfg, each, body)
                && let Some(entries) = entries(facts, func, cfg, each, body)
            {
                for (from, entry) in entries {
                    facts.entries.entry(from).or_default().push(entry);
                }
                continue;
            }
            for &latch in &each.latches {
                let payment = facts.payments.entry(latch).or_insert(0);
                *payment = body.max(*payment);
            }
        }
    }

    /// Whether a fault may end a loop long before it has done what is paid for it ahead.
    fn may_end_early(
        &self,
        facts: &Facts,
        func: &Function,
        cfg: &Cfg,
        each: &Loop,
        body: u64,
    ) -> bool {
        let is_fault = |&to: &Block| matches!(func.terminator(to), Terminator::Fault(_));
        let faults = |&block: &Block| {
            cfg.successors(block).iter().any(is_fault)
                || func
                    .calls_in(block)
                    .any(|callee| self.facts[callee].can_fault)
        };
        let trips = facts.ranges.as_ref().and_then(|r| r.trips(each.header));
        let ahead = trips.map_or(u64::MAX, |trips| {
            trips.most.saturating_add(1).saturating_mul(body)
        });
        ahead > AHEAD_WORK && each.blocks.iter().any(faults)
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

    fn reserve_for_absent(&mut self, module: &Module, layout: &Layout, id: FuncId) {
        for (param, data) in module.funcs[id].refs.iter() {
            if self.facts[id].absent_refs.contains(param) {
                let bytes = layout.size(&module.types, data.ty);
                self.state_bytes = self.state_bytes.max(bytes);
            }
        }
        if self.has_addresses {
            self.reserve_for_addresses(module, layout, id);
        }
    }

    fn reserve_for_addresses(&mut self, module: &Module, layout: &Layout, id: FuncId) {
        let func = &module.funcs[id];
        let blocks = func.layout.iter().map(|&block| func.block(block));
        for &inst in blocks.flat_map(|block| &block.insts) {
            for place in func.inst(inst).places() {
                if let Root::Deref { ty, .. } = place.root {
                    let bytes = layout.size(&module.types, ty);
                    self.state_bytes = self.state_bytes.max(bytes);
                }
            }
        }
    }

    /// Whether the place may lie outside an array when `func` runs.
    pub(crate) fn can_be_absent(&self, func: FuncId, place: &Place) -> bool {
        let inherited = match place.root {
            Root::Ref(param) => self.facts[func].absent_refs.contains(param),
            Root::State | Root::Input | Root::Output | Root::Local(_) | Root::Deref { .. } => false,
        };
        inherited || !place.is_static()
    }
}

/// How often a loop goes back in a call of its function: as often as it does each time it is entered, times the
/// rounds of the loops around it. `None` if that is not the same always.
fn rounds(facts: &Facts, loops: &Loops, each: &Loop) -> Option<u64> {
    let around = loops.natural.iter();
    let around = around.filter(|outer| outer.blocks.contains(&each.header));
    let mut rounds = 1u64;
    for outer in around {
        let trips = facts.ranges.as_ref()?.trips(outer.header)?;
        let times = u64::from(outer.header != each.header).checked_add(trips.most)?;
        rounds = rounds.checked_mul(times).filter(|_| trips.is_exact)?;
    }
    Some(rounds)
}

/// The ways into a loop that is counted, if each of them enters it in one way.
fn entries(
    facts: &Facts,
    func: &Function,
    cfg: &Cfg,
    each: &Loop,
    work: u64,
) -> Option<Vec<(Block, Entry)>> {
    let counted = facts.ranges.as_ref()?.counted(each.header)?;
    // So the price of all rounds is a number of 64 bits.
    let is_narrow = func.value_type(counted.param).bits() <= 32;
    if !is_narrow || work > FREE_WORK {
        return None;
    }
    let params = &func.block(each.header).params;
    let index = params.iter().position(|&param| param == counted.param)?;
    let outside = |from: &&Block| cfg.is_reachable(**from) && !each.blocks.contains(from);
    let ways_in = cfg.predecessors(each.header).iter().filter(outside);
    let entry = |&from: &Block| {
        let targets = func.terminator(from).targets();
        let mut targets = targets
            .into_iter()
            .filter(|target| target.block == each.header);
        let (target, None) = (targets.next()?, targets.next()) else {
            return None;
        };
        let first = target.args[index];
        Some((
            from,
            Entry {
                counted,
                first,
                work,
            },
        ))
    };
    ways_in.map(entry).collect()
}

/// Whether a place has an index by value.
fn has_computed_indices(func: &Function) -> bool {
    let blocks = func.layout.iter().map(|&block| func.block(block));
    let mut insts = blocks.flat_map(|block| &block.insts);
    insts.any(|&inst| {
        func.inst(inst)
            .places()
            .iter()
            .any(|place| !place.is_static())
    })
}

/// The work of a block without that of the functions it calls.
fn own_work(module: &Module, layout: &Layout, func: &Function, block: Block) -> u64 {
    let insts = &func.block(block).insts;
    let moved = insts
        .iter()
        .map(|&inst| layout.moved_bytes(module, func, func.inst(inst)) / BYTES_PER_WORK);
    moved.fold(insts.len() as u64 + 1, u64::saturating_add)
}
