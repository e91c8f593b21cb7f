//! Inlining: bodies in place of calls.
//!
//! After `inline`, `scan` and `prescan` contain no call, unless the program is so large that the
//! bound on copied instructions is reached: then the calls that are left are still right, and
//! hardware refuses them. A reference parameter becomes the place that is passed, so that all
//! places begin at a region. An instruction keeps its origin; one without takes that of the call.
//! Functions nobody calls any more are dropped. Locals of a callee become locals of the caller, one
//! set for all calls of the same function, and are cleared where the callee is entered.

use crate::functions;
use crate::rewrite::goes_back;
use cranelift_entity::{EntityRef, EntitySet, SecondaryMap, packed_option::PackedOption};
use iecc_ir::analysis::{Cfg, Dominators, Loops};
use iecc_ir::{
    Block, FuncId, Function, Inst, InstData, Layout, Local, LocalData, MAX_LOCAL_BYTES, Module,
    Origin, Place, Root, Target, Terminator, Type, Value,
};
use std::collections::{BTreeMap, BTreeSet};

/// Instructions one function may grow to, and how many may be copied in all. Calls that fan out
/// over a few dozen levels would otherwise fill any memory.
const MAX_FUNCTION: usize = 1 << 20;
const MAX_COPIED: usize = 1 << 22;

/// What `inline_small` takes: bodies up to the first, and up to the second if there is one call.
const SMALL: usize = 32;
const SMALL_IF_CALLED_ONCE: usize = 1 << 10;
/// What `inline_straight` takes: there are no branches in it, and what it loads is mostly what its caller
/// has just stored.
const STRAIGHT: usize = 80;
/// What a function may grow to by `inline_small`; machine code generators dislike giants.
const SMALL_FUNCTION: usize = 1 << 14;

/// Most bytes of locals of a function that `inline_small` takes: they are cleared also where the
/// call is not reached.
const SMALL_LOCALS: u64 = 1 << 10;

/// Inlines every call.
pub(crate) fn inline(module: &mut Module) {
    Inliner::new(MAX_FUNCTION, MAX_LOCAL_BYTES).run(module, &|_, _| true);
}

/// Inlines calls of small functions, and of larger ones that are called in one place only; but for loops,
/// which want all registers for themselves.
pub(crate) fn inline_small(module: &mut Module) {
    let mut count: SecondaryMap<FuncId, u32> = SecondaryMap::new();
    let mut loops = EntitySet::<FuncId>::new();
    for (id, func) in module.funcs.iter() {
        func.calls().for_each(|callee| count[callee] += 1);
        if size(func) > SMALL && goes_back(func) {
            loops.insert(id);
        }
    }
    Inliner::new(SMALL_FUNCTION, SMALL_LOCALS).run(module, &|callee, size| {
        let is_single = count[callee] == 1 && !loops.contains(callee);
        size <= SMALL || (is_single && size <= SMALL_IF_CALLED_ONCE)
    });
}

/// Inlines calls of functions that are one block of few instructions.
pub(crate) fn inline_straight(module: &mut Module) {
    let mut straight = EntitySet::<FuncId>::new();
    for (id, func) in module.funcs.iter() {
        if func.layout.len() == 1 {
            straight.insert(id);
        }
    }
    Inliner::new(SMALL_FUNCTION, SMALL_LOCALS).run(module, &|callee, size| {
        size <= STRAIGHT && straight.contains(callee)
    });
}

struct Inliner {
    /// Instructions of each finished function.
    sizes: SecondaryMap<FuncId, usize>,
    max_function: usize,
    copies_left: usize,
    /// Bytes of the locals of each finished function.
    local_bytes: SecondaryMap<FuncId, u64>,
    max_locals: u64,
    locals_left: u64,
}

impl Inliner {
    fn new(max_function: usize, max_locals: u64) -> Self {
        Self {
            sizes: SecondaryMap::new(),
            max_function,
            copies_left: MAX_COPIED,
            local_bytes: SecondaryMap::new(),
            max_locals,
            locals_left: 0,
        }
    }

    fn run(&mut self, module: &mut Module, wanted: &dyn Fn(FuncId, usize) -> bool) {
        let layout = Layout::new(&module.types);
        let bytes = |func| layout.locals(&module.types, func).1;
        let all = module.funcs.values().map(bytes).sum();
        self.locals_left = MAX_LOCAL_BYTES.saturating_sub(all);
        for id in functions::callees_first(module) {
            let mut size = size(&module.funcs[id]);
            let before = size;
            self.local_bytes[id] = layout.locals(&module.types, &module.funcs[id]).1;
            let chosen = self.choose(id, &module.funcs[id], &mut size, wanted);
            if chosen.contains(&true) {
                module.funcs[id] = Expansion::new(module, &module.funcs[id], &chosen).run();
                self.copies_left -= size - before;
            }
            self.sizes[id] = size;
        }
        functions::remove_uncalled(module);
    }

    /// For every call in layout order, whether to inline it; `size` grows accordingly.
    fn choose(
        &mut self,
        id: FuncId,
        func: &Function,
        size: &mut usize,
        wanted: &dyn Fn(FuncId, usize) -> bool,
    ) -> Vec<bool> {
        let limit = self.max_function.min(*size + self.copies_left);
        let mut with_locals = BTreeSet::new();
        func.calls()
            .map(|callee| {
                // One for the jump, so that empty bodies count too.
                let grown = *size + self.sizes[callee] + 1;
                let locals = self.local_bytes[callee];
                let more_locals = if with_locals.contains(&callee) {
                    0
                } else {
                    locals
                };
                let chosen = grown <= limit
                    && locals <= self.max_locals
                    && more_locals <= self.locals_left
                    && wanted(callee, self.sizes[callee]);
                if chosen {
                    *size = grown;
                    with_locals.insert(callee);
                    self.locals_left -= more_locals;
                    self.local_bytes[id] += more_locals;
                }
                chosen
            })
            .collect()
    }
}

/// Instructions in the blocks of the layout.
fn size(func: &Function) -> usize {
    func.layout
        .iter()
        .map(|&block| func.block(block).insts.len() + 1)
        .sum()
}

/// Which block and value of the new function stands for one of a copied function, and what its
/// references are bound to.
struct Copied<'f> {
    from: &'f Function,
    blocks: SecondaryMap<Block, PackedOption<Block>>,
    values: SecondaryMap<Value, PackedOption<Value>>,
    /// Empty for the caller itself, whose references stay.
    refs: Vec<Place>,
    /// What its locals became; empty for the caller itself, whose locals stay.
    locals: Vec<Local>,
    /// For instructions without their own.
    origin: Option<Origin>,
}

impl<'f> Copied<'f> {
    fn new(
        from: &'f Function,
        refs: Vec<Place>,
        locals: Vec<Local>,
        origin: Option<Origin>,
    ) -> Self {
        Self {
            from,
            blocks: SecondaryMap::with_capacity(from.block_count()),
            values: SecondaryMap::with_capacity(from.value_count()),
            refs,
            locals,
            origin,
        }
    }

    fn value(&self, value: Value) -> Value {
        self.values[value].expect("definitions are copied before uses")
    }

    fn block(&self, block: Block) -> Block {
        self.blocks[block].expect("reachable blocks are created first")
    }

    fn place(&self, place: &Place) -> Place {
        let mut mapped = place.clone();
        mapped.values_mut().for_each(|v| *v = self.value(*v));
        match mapped.root {
            Root::Ref(param) if !self.refs.is_empty() => {
                self.refs[param.index()].clone().join(&mapped.path)
            }
            Root::Local(local) if !self.locals.is_empty() => Place {
                root: Root::Local(self.locals[local.index()]),
                path: mapped.path,
            },
            Root::Ref(_)
            | Root::Local(_)
            | Root::Deref { .. }
            | Root::State
            | Root::Input
            | Root::Output => mapped,
        }
    }

    fn inst(&self, data: &InstData) -> InstData {
        match data {
            InstData::Load { place } => InstData::Load {
                place: self.place(place),
            },
            InstData::Store { place, value } => InstData::Store {
                place: self.place(place),
                value: self.value(*value),
            },
            InstData::Copy { to, from } => InstData::Copy {
                to: self.place(to),
                from: self.place(from),
            },
            InstData::Clear { place } => InstData::Clear {
                place: self.place(place),
            },
            InstData::Address { place } => match self.place(place) {
                // A reference to a local has the address 0.
                Place {
                    root: Root::Local(_),
                    ..
                } => InstData::Const {
                    ty: Type::I64,
                    bits: 0,
                },
                place => InstData::Address { place },
            },
            InstData::Elapsed { place, unit_ns, ty } => InstData::Elapsed {
                place: self.place(place),
                unit_ns: *unit_ns,
                ty: *ty,
            },
            InstData::Call { func, refs, args } => InstData::Call {
                func: *func,
                refs: refs.iter().map(|place| self.place(place)).collect(),
                args: args.iter().map(|&v| self.value(v)).collect(),
            },
            InstData::Const { .. }
            | InstData::Unary { .. }
            | InstData::Binary { .. }
            | InstData::Compare { .. }
            | InstData::Convert { .. }
            | InstData::Select { .. }
            | InstData::Now
            | InstData::Step { .. } => {
                let mut mapped = data.clone();
                mapped.map_values(|v| self.value(v));
                mapped
            }
        }
    }

    fn terminator(&self, terminator: &Terminator) -> Terminator {
        let mut mapped = terminator.clone();
        mapped.map_values(|v| self.value(v));
        for target in mapped.targets_mut() {
            target.block = self.block(target.block);
        }
        mapped
    }
}

/// Builds one function anew with the chosen calls expanded. Blocks are visited in reverse
/// postorder, so definitions come before uses and unreachable blocks vanish.
struct Expansion<'m> {
    module: &'m Module,
    caller: &'m Function,
    out: Function,
    /// The layout of the result; blocks of a callee stand where its call stood.
    order: Vec<Block>,
    chosen: SecondaryMap<Inst, bool>,
    /// The locals that stand for those of a callee.
    locals: BTreeMap<FuncId, Vec<Local>>,
    /// Blocks of the caller that may run more than once; `None` for all.
    repeated: Option<EntitySet<Block>>,
}

impl<'m> Expansion<'m> {
    fn new(module: &'m Module, caller: &'m Function, chosen: &[bool]) -> Self {
        let mut out = Function::new(caller.name.clone(), caller.results.clone());
        out.refs = caller.refs.clone();
        out.locals = caller.locals.clone();
        let insts = caller
            .layout
            .iter()
            .flat_map(|&block| &caller.block(block).insts);
        let calls = insts.filter(|&&inst| matches!(caller.inst(inst), InstData::Call { .. }));
        let mut by_inst = SecondaryMap::new();
        for (&inst, &chosen) in calls.zip(chosen) {
            by_inst[inst] = chosen;
        }
        Self {
            module,
            caller,
            out,
            order: Vec::new(),
            chosen: by_inst,
            locals: BTreeMap::new(),
            repeated: None,
        }
    }

    fn run(mut self) -> Function {
        let caller = self.caller;
        let cfg = Cfg::new(caller);
        self.repeated = repeated(&cfg);
        let mut map = Copied::new(caller, Vec::new(), Vec::new(), None);
        self.create_blocks(&mut map, cfg.reverse_postorder());
        for &block in cfg.reverse_postorder() {
            self.caller_block(&mut map, block);
        }
        self.out.layout = self.order;
        self.out
    }

    fn create_blocks(&mut self, map: &mut Copied<'_>, blocks: &[Block]) {
        for &block in blocks {
            let copy = self.out.add_block();
            map.blocks[block] = copy.into();
            for &param in &map.from.block(block).params {
                let value = self.out.add_param(copy, map.from.value_type(param));
                map.values[param] = value.into();
            }
        }
    }

    fn caller_block(&mut self, map: &mut Copied<'m>, block: Block) {
        let caller = self.caller;
        let mut current = map.block(block);
        self.order.push(current);
        for &inst in &caller.block(block).insts {
            if !self.chosen[inst] {
                self.copy_inst(map, inst, current);
                continue;
            }
            let InstData::Call { func, refs, args } = map.inst(caller.inst(inst)) else {
                panic!("only calls are chosen")
            };
            let origin = caller.origin(inst);
            let locals = self.locals_of(func, block, current, origin);
            let callee = Copied::new(&self.module.funcs[func], refs, locals, origin);
            let (next, results) = self.expand(callee, current, &args);
            current = next;
            bind(&mut map.values, caller.results_of(inst), &results);
        }
        let terminator = map.terminator(caller.terminator(block));
        let origin = caller.block(block).terminator_origin;
        self.out.set_terminator(current, terminator, origin);
    }

    /// The locals for an expansion of a callee at the end of `current`, all 0 there.
    fn locals_of(
        &mut self,
        callee: FuncId,
        block: Block,
        current: Block,
        origin: Option<Origin>,
    ) -> Vec<Local> {
        let func = &self.module.funcs[callee];
        let is_first = !self.locals.contains_key(&callee);
        if is_first {
            let taken = self.out.locals.values().map(|data| data.name.clone());
            let taken = taken.chain(self.out.refs.values().map(|data| data.name.clone()));
            let taken: BTreeSet<String> = taken.collect();
            let new = func.locals.values().map(|data| {
                let name = functions::unique(&format!("{}.{}", func.name, data.name), &taken);
                self.out.locals.push(LocalData { name, ty: data.ty })
            });
            let new = new.collect();
            self.locals.insert(callee, new);
        }
        let locals = self.locals[&callee].clone();
        let once = self
            .repeated
            .as_ref()
            .is_some_and(|repeated| !repeated.contains(block));
        if !(is_first && once) {
            for &local in &locals {
                let place = Place::root(Root::Local(local));
                self.out
                    .append_inst(current, InstData::Clear { place }, &[], origin);
            }
        }
        locals
    }

    fn copy_inst(&mut self, map: &mut Copied<'_>, inst: Inst, to: Block) {
        let from = map.from;
        let types: Vec<_> = from
            .results_of(inst)
            .iter()
            .map(|&v| from.value_type(v))
            .collect();
        let data = map.inst(from.inst(inst));
        let origin = from.origin(inst).or(map.origin);
        let copy = self.out.append_inst(to, data, &types, origin);
        bind(
            &mut map.values,
            from.results_of(inst),
            self.out.results_of(copy),
        );
    }

    /// Copies a callee, its entry at the end of `current`. Gives the block in which the caller
    /// goes on and the results.
    fn expand(
        &mut self,
        mut map: Copied<'_>,
        current: Block,
        args: &[Value],
    ) -> (Block, Vec<Value>) {
        let callee = map.from;
        let cfg = Cfg::new(callee);
        let (entry, others) = cfg
            .reverse_postorder()
            .split_first()
            .expect("functions have an entry");
        bind(&mut map.values, &callee.block(*entry).params, args);
        map.blocks[*entry] = current.into();
        self.create_blocks(&mut map, others);
        let mut returns = Vec::new();
        for &block in cfg.reverse_postorder() {
            if block != *entry {
                self.order.push(map.block(block));
            }
            if let Some(values) = self.callee_block(&mut map, block) {
                returns.push((map.block(block), values));
            }
        }
        match returns.len() {
            1 => returns.remove(0),
            _ => self.join_returns(callee, returns, map.origin),
        }
    }

    /// Copies a block; gives the results if it returns, and then leaves the copy without end.
    fn callee_block(&mut self, map: &mut Copied<'_>, block: Block) -> Option<Vec<Value>> {
        let to = map.block(block);
        for &inst in &map.from.block(block).insts {
            self.copy_inst(map, inst, to);
        }
        let origin = map.from.block(block).terminator_origin.or(map.origin);
        match map.from.terminator(block) {
            Terminator::Return(values) => Some(values.iter().map(|&v| map.value(v)).collect()),
            other @ (Terminator::Jump(_)
            | Terminator::Brif { .. }
            | Terminator::Switch { .. }
            | Terminator::Fault(_)) => {
                let terminator = map.terminator(other);
                self.out.set_terminator(to, terminator, origin);
                None
            }
        }
    }

    fn join_returns(
        &mut self,
        callee: &Function,
        returns: Vec<(Block, Vec<Value>)>,
        origin: Option<Origin>,
    ) -> (Block, Vec<Value>) {
        let join = self.out.add_block();
        self.order.push(join);
        let params = callee
            .results
            .iter()
            .map(|&ty| self.out.add_param(join, ty));
        let params = params.collect();
        for (from, args) in returns {
            let jump = Terminator::Jump(Target { block: join, args });
            self.out.set_terminator(from, jump, origin);
        }
        (join, params)
    }
}

/// The blocks that may run more than once in an activation; `None` if it may be any.
fn repeated(cfg: &Cfg) -> Option<EntitySet<Block>> {
    let loops = Loops::new(cfg, &Dominators::new(cfg));
    if loops.irreducible.is_some() {
        return None;
    }
    let mut blocks = EntitySet::new();
    for block in loops.natural.iter().flat_map(|each| &each.blocks) {
        blocks.insert(*block);
    }
    Some(blocks)
}

fn bind(map: &mut SecondaryMap<Value, PackedOption<Value>>, from: &[Value], to: &[Value]) {
    for (&from, &to) in from.iter().zip(to) {
        map[from] = to.into();
    }
}
