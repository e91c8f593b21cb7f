//! Random function bodies: statements over variables, which the builder turns into SSA.

use super::places::{Route, routes};
use super::types::{ACC, DONE, LAST, TIMERS, timer_field, value_types};
use super::{MAX_COST, Options, Signature};
use crate::rng::Rng;
use crate::stimulus::random_bits;
use iecc_ir::{
    BinaryOp, Block, CompareOp, FaultCode, Function, FunctionBuilder, MemType, Module, Origin,
    Place, PlaceType, Root, Type, Value, Variable,
};

/// How deep statements nest.
const DEPTH: u32 = 4;
/// Times a loop runs at most.
const TURNS: u64 = 4;

/// A function being made.
pub(super) struct Body<'a> {
    pub(super) module: &'a Module,
    callees: &'a [Signature],
    pub(super) options: &'a Options,
    pub(super) rng: &'a mut Rng,
    pub(super) builder: FunctionBuilder,
    pub(super) routes: Vec<Route>,
    pub(super) refs: Vec<MemType>,
    name: String,
    types: Vec<Type>,
    variables: Vec<(Variable, Type)>,
    results: Vec<Type>,
    statements: usize,
    /// Instructions executed at most so far, and how often the present statement runs.
    cost: u64,
    turns: u64,
}

impl<'a> Body<'a> {
    pub(super) fn new(
        module: &'a Module,
        callees: &'a [Signature],
        options: &'a Options,
        rng: &'a mut Rng,
        name: &str,
    ) -> Self {
        Self {
            module,
            callees,
            options,
            rng,
            builder: FunctionBuilder::new(name, &[], &[]),
            routes: Vec::new(),
            refs: Vec::new(),
            name: name.to_owned(),
            types: value_types(options),
            variables: Vec::new(),
            results: Vec::new(),
            statements: 0,
            cost: 0,
            turns: 1,
        }
    }

    /// Makes a function without loops, whose blocks jump to any later blocks: every graph without loops
    /// can come of it.
    pub(super) fn finish_graph(mut self, blocks: usize) -> Function {
        let later: Vec<Block> = (0..blocks).map(|_| self.builder.create_block()).collect();
        for next in 0..blocks {
            for _ in 0..self.rng.below(4) {
                self.simple_statement();
            }
            self.jump_on(&later[next..]);
            self.continue_in(later[next]);
        }
        self.publish();
        self.return_now();
        self.builder.finish()
    }

    /// A statement that may depend on a branch in hardware: it leaves outputs alone, whose old value
    /// cannot be loaded.
    fn simple_statement(&mut self) {
        if self.rng.one_in(2) {
            return self.assign();
        }
        if self.rng.one_in(2) {
            return self.accumulate();
        }
        let ty = self.random_type();
        let value = self.value(ty);
        if let Some(place) = self.place(|route| route.is_value(ty) && route.is_kept()) {
            self.builder.store(place, value);
        }
    }

    /// Jumps to near blocks more often, so that graphs are deep.
    fn jump_on(&mut self, later: &[Block]) {
        let targets = [(); 3].map(|()| {
            let reach = self.rng.pick(&[2, 4, later.len()]);
            later[self.rng.below(reach.min(later.len()))]
        });
        match self.rng.below(4) {
            0 => self.builder.jump(targets[0]),
            1 => {
                let value = self.value(Type::I8);
                let cases = vec![(0, targets[1]), (1, targets[2]), (255, targets[1])];
                self.builder.switch(value, cases, targets[0]);
            }
            _ => {
                let cond = self.value(Type::I1);
                self.builder.brif(cond, targets[0], targets[1]);
            }
        }
    }

    /// Starts the function with these references, locals, parameters and results.
    pub(super) fn begin(
        &mut self,
        refs: &[MemType],
        locals: &[MemType],
        params: &[Type],
        results: &[Type],
    ) {
        self.builder = FunctionBuilder::new(self.name.as_str(), params, results);
        for (index, &ty) in refs.iter().enumerate() {
            self.builder.add_ref(format!("r{index}"), ty);
        }
        for (index, &ty) in locals.iter().enumerate() {
            self.builder.local(format!("l{index}"), ty);
        }
        self.routes = routes(self.module, refs, locals);
        self.refs = refs.to_vec();
        self.results = results.to_vec();
        for (index, &ty) in params.iter().enumerate() {
            let param = self.builder.param(index);
            self.new_variable(ty, param);
        }
        // Two variables of each type: one starts with a constant, one is 0 until assigned.
        for ty in self.types.clone() {
            let start = self.constant(ty);
            self.new_variable(ty, start);
            let unassigned = self.builder.declare(ty);
            self.variables.push((unassigned, ty));
        }
        self.statements = 1 + self.rng.below(self.options.statements);
    }

    /// Makes the statements and ends the function; also says what it costs.
    pub(super) fn finish(mut self) -> (Function, u64) {
        while self.statements > 0 {
            self.statement(DEPTH);
        }
        self.publish();
        if self.options.faults && self.rng.one_in(3) {
            // All that was stored is to be undone.
            self.fault();
        }
        self.return_now();
        (self.builder.finish(), self.cost)
    }

    fn new_variable(&mut self, ty: Type, value: Value) -> Variable {
        let variable = self.builder.declare(ty);
        self.builder.assign(variable, value);
        self.variables.push((variable, ty));
        variable
    }

    pub(super) fn variables_of(&self, wanted: Type) -> impl Iterator<Item = Variable> {
        let variables = self.variables.iter();
        variables.filter_map(move |&(variable, ty)| (ty == wanted).then_some(variable))
    }

    pub(super) fn random_type(&mut self) -> Type {
        self.rng.pick(&self.types)
    }

    fn integer_types(&self) -> Vec<Type> {
        let types = self.types.iter().copied();
        types.filter(|ty| ty.is_int()).collect()
    }

    /// Counts instructions of the present statement.
    pub(super) fn spend(&mut self, instructions: u64) {
        self.cost += instructions * self.turns;
    }

    /// Shows some variables to the outside, so that what was computed matters.
    fn publish(&mut self) {
        for (variable, ty) in self.variables.clone() {
            if self.rng.one_in(2) {
                let value = self.builder.read(variable);
                self.store_value(ty, value);
            }
        }
    }

    fn block_of(&mut self, depth: u32) {
        for _ in 0..1 + self.rng.below(3) {
            self.statement(depth);
        }
    }

    fn statement(&mut self, depth: u32) {
        self.statements = self.statements.saturating_sub(1);
        self.origin();
        let nest = depth > 0 && self.statements > 0;
        let cheap = self.cost < MAX_COST / 4;
        match self.rng.below(25) {
            0..=2 => self.assign(),
            3..=5 => self.store(),
            6 | 7 => self.call(),
            8..=10 if nest => self.if_else(depth - 1),
            11 if nest => self.switch(depth - 1),
            12 if nest && cheap && self.options.loops => self.counted_loop(depth - 1),
            13 if nest && cheap && self.options.loops => self.tangle(depth - 1),
            14 => self.leave_early(),
            15 if self.options.faults => self.fault(),
            16 | 17 if self.options.timers => self.timer(),
            18 | 19 => self.accumulate(),
            20 | 21 => self.overlap(),
            22 | 23 => self.copy(),
            24 => self.clear(),
            _ => self.assign(),
        }
    }

    fn origin(&mut self) {
        let origins: Vec<Origin> = self.module.origins.keys().collect();
        let origin = self.rng.one_in(2).then(|| self.rng.pick(&origins));
        self.builder.set_origin(origin);
    }

    fn assign(&mut self) {
        let (variable, ty) = self.rng.pick(&self.variables);
        let value = self.value(ty);
        self.builder.assign(variable, value);
    }

    fn store(&mut self) {
        let ty = self.random_type();
        let value = self.value(ty);
        self.store_value(ty, value);
    }

    fn store_value(&mut self, ty: Type, value: Value) {
        self.spend(1);
        let place = self.place(|route| route.is_value(ty) && !route.is_constant);
        if let Some(place) = place {
            self.builder.store(place, value);
        }
    }

    /// Changes what is kept by what it was.
    fn accumulate(&mut self) {
        let integers = self.integer_types();
        let ty = self.rng.pick(&integers);
        let Some(place) = self.place(|route| route.is_value(ty) && route.is_kept()) else {
            return;
        };
        let (before, change) = (self.builder.load(place.clone(), ty), self.value(ty));
        let op = if ty == Type::I1 {
            BinaryOp::Xor
        } else {
            BinaryOp::Add
        };
        let after = self.builder.binary(op, before, change);
        self.builder.store(place, after);
        self.spend(3);
    }

    /// Moves a scalar, struct or array; from a local as often as possible.
    fn copy(&mut self) {
        let wanted = self.rng.one_in(2);
        let is_local = |route: &Route| !wanted || matches!(route.root, Root::Local(_));
        let to =
            self.place_and_end(|route| is_part(route) && !route.is_constant && is_local(route));
        let Some((to, end)) = to else { return };
        let from = self.place(|route| route.end == end && route.root != Root::Output);
        if let Some(from) = from {
            self.builder.copy(to, from);
            self.spend(4);
        }
    }

    fn clear(&mut self) {
        let place = self.place(|route| is_part(route) && !route.is_constant);
        if let Some(place) = place {
            self.builder.clear(place);
            self.spend(2);
        }
    }

    /// Loads a place before and after a store that may change it.
    fn overlap(&mut self) {
        let ty = self.random_type();
        let is_ref = |route: &Route| matches!(route.root, Root::Ref(_));
        let by_ref = self.place(|route| route.is_value(ty) && is_ref(route));
        let one = by_ref.or_else(|| self.place(|route| route.is_value(ty) && route.is_kept()));
        let other = self.shared_place(|route| route.is_value(ty) && route.is_kept());
        let (Some(mut one), Some(mut other)) = (one, other) else {
            return;
        };
        if self.rng.one_in(3) {
            other = one.clone();
        }
        if self.rng.one_in(2) {
            std::mem::swap(&mut one, &mut other);
        }
        let value = self.value(ty);
        let before = self.builder.load(one.clone(), ty);
        self.builder.store(other, value);
        let after = self.builder.load(one, ty);
        self.spend(3);
        for value in [before, after] {
            self.show(ty, value);
        }
    }

    /// An on-delay timer: counts to a constant while a condition holds. Its time runs in every
    /// scan, or only while it counts.
    fn timer(&mut self) {
        let timer = self.rng.below(TIMERS as usize) as u32;
        let at = timer_field(&self.module.types, self.module.state, timer);
        let place = |field| Place::root(Root::State).field(at).field(field);
        let unit_ns = [1_000_000, 1, 10_000_000][timer as usize];
        let always = self.rng.one_in(2);
        let cond = self.value(Type::I1);
        let delta = always.then(|| self.builder.elapsed(place(LAST), unit_ns, Type::I32));
        let [on, off, join] = self.blocks();
        self.builder.brif(cond, on, off);
        self.continue_in(on);
        let delta = delta.unwrap_or_else(|| self.builder.elapsed(place(LAST), unit_ns, Type::I32));
        let acc = self.builder.load(place(ACC), Type::I32);
        let preset = self.rng.pick(&[0, 1, 90, 2_000, 0x7fff_ffff]);
        let preset = self.builder.constant(Type::I32, preset);
        let room = self.builder.binary(BinaryOp::Sub, preset, acc);
        let done = self.builder.compare(CompareOp::Sge, delta, room);
        let sum = self.builder.binary(BinaryOp::Add, acc, delta);
        let acc = self.builder.select(done, preset, sum);
        self.builder.store(place(ACC), acc);
        self.builder.store(place(DONE), done);
        self.builder.jump(join);
        self.continue_in(off);
        let zero = self.builder.constant(Type::I32, 0);
        let no = self.builder.constant(Type::I1, 0);
        self.builder.store(place(ACC), zero);
        self.builder.store(place(DONE), no);
        self.builder.jump(join);
        self.continue_in(join);
        self.spend(16);
    }

    /// Stores where it is seen at once, if there is an output of the type.
    fn show(&mut self, ty: Type, value: Value) {
        match self.place(|route| route.root == Root::Output && route.is_value(ty)) {
            Some(place) => self.builder.store(place, value),
            None => self.store_value(ty, value),
        }
    }

    /// A call that keeps the cost of this function within the limit.
    fn call(&mut self) {
        let left = MAX_COST.saturating_sub(self.cost) / self.turns;
        let callees = self.callees.iter().filter(|callee| callee.cost < left);
        let callees: Vec<&Signature> = callees.collect();
        if callees.is_empty() {
            return self.store();
        }
        let callee = self.rng.pick(&callees);
        let mut refs = Vec::new();
        for &ty in &callee.refs {
            refs.push(self.referenced_place(ty));
        }
        let args = callee.params.iter().map(|&ty| self.value(ty)).collect();
        self.spend(callee.cost);
        let results = self.builder.call(callee.id, refs, args, &callee.results);
        for (&value, &ty) in results.iter().zip(&callee.results) {
            let variables: Vec<_> = self.variables_of(ty).collect();
            let variable = self.rng.pick(&variables);
            self.builder.assign(variable, value);
        }
    }

    fn if_else(&mut self, depth: u32) {
        let cond = self.value(Type::I1);
        let [then, join] = self.blocks();
        if self.rng.one_in(2) {
            let [otherwise] = self.blocks();
            self.builder.brif(cond, then, otherwise);
            self.arm(otherwise, join, depth);
        } else {
            self.builder.brif(cond, then, join);
        }
        self.arm(then, join, depth);
        self.continue_in(join);
    }

    fn switch(&mut self, depth: u32) {
        let integers = self.integer_types();
        let ty = self.rng.pick(&integers);
        let value = self.value(ty);
        let join = self.builder.create_block();
        let mut cases: Vec<(u64, Block)> = Vec::new();
        for _ in 0..self.rng.below(4) {
            let bits = random_bits(ty, self.rng);
            if cases.iter().all(|(case, _)| *case != bits) {
                // Two cases may share a block.
                let shared = cases
                    .last()
                    .filter(|_| self.rng.one_in(3))
                    .map(|(_, block)| *block);
                let block = shared.unwrap_or_else(|| self.builder.create_block());
                cases.push((bits, block));
            }
        }
        let default = self.builder.create_block();
        self.builder.switch(value, cases.clone(), default);
        let mut arms: Vec<Block> = cases.into_iter().map(|(_, block)| block).collect();
        arms.dedup();
        for block in arms.into_iter().chain([default]) {
            self.arm(block, join, depth);
        }
        self.continue_in(join);
    }

    fn blocks<const N: usize>(&mut self) -> [Block; N] {
        [(); N].map(|()| self.builder.create_block())
    }

    /// Fills a block that has all its predecessors and goes on in `join`.
    fn arm(&mut self, block: Block, join: Block, depth: u32) {
        self.builder.seal(block);
        self.builder.switch_to(block);
        self.block_of(depth);
        self.builder.jump(join);
    }

    fn continue_in(&mut self, block: Block) {
        self.builder.seal(block);
        self.builder.switch_to(block);
    }

    /// `n := few; while n > 0 { n := n - 1; …; if c { break } }`, the counter out of reach.
    fn counted_loop(&mut self, depth: u32) {
        let counter = self.counter();
        let [head, body, latch, exit] = self.blocks();
        self.builder.jump(head);
        self.builder.switch_to(head);
        let more = self.count_down(counter);
        self.builder.brif(more, body, exit);
        self.continue_in(body);
        let turns = self.turns;
        self.turns *= TURNS + 1;
        self.spend(8);
        self.block_of(depth);
        if self.rng.one_in(3) {
            let cond = self.value(Type::I1);
            self.builder.brif(cond, exit, latch);
        } else {
            self.builder.jump(latch);
        }
        self.turns = turns;
        self.continue_in(latch);
        self.builder.jump(head);
        self.builder.seal(head);
        self.continue_in(exit);
    }

    /// Two blocks that go on in each other and are both entered from outside.
    fn tangle(&mut self, depth: u32) {
        let counter = self.counter();
        let cond = self.value(Type::I1);
        let [left, right, exit] = self.blocks();
        self.builder.brif(cond, left, right);
        let turns = self.turns;
        self.turns *= TURNS + 1;
        self.spend(8);
        for (block, other) in [(left, right), (right, left)] {
            self.builder.switch_to(block);
            self.block_of(depth.min(1));
            let more = self.count_down(counter);
            self.builder.brif(more, other, exit);
        }
        self.turns = turns;
        self.builder.seal(left);
        self.builder.seal(right);
        self.continue_in(exit);
    }

    /// A variable for counting, which no other statement sees.
    fn counter(&mut self) -> Variable {
        let turns = self.rng.next_u64() % (TURNS + 1);
        let start = self.builder.constant(Type::I32, turns);
        let counter = self.builder.declare(Type::I32);
        self.builder.assign(counter, start);
        counter
    }

    /// Counts down; whether it was above 0.
    fn count_down(&mut self, counter: Variable) -> Value {
        let before = self.builder.read(counter);
        let zero = self.builder.constant(Type::I32, 0);
        let one = self.builder.constant(Type::I32, 1);
        let more = self.builder.compare(CompareOp::Sgt, before, zero);
        let after = self.builder.binary(BinaryOp::Sub, before, one);
        self.builder.assign(counter, after);
        more
    }

    /// Returns under a condition; rarely always, with blocks behind that nothing reaches.
    fn leave_early(&mut self) {
        let [leave, stay] = self.blocks();
        if self.rng.one_in(6) {
            self.builder.jump(leave);
        } else {
            let cond = self.rare();
            self.builder.brif(cond, leave, stay);
        }
        self.continue_in(leave);
        self.return_now();
        self.continue_in(stay);
    }

    fn fault(&mut self) {
        let [fail, stay] = self.blocks();
        let often = self.rng.one_in(3);
        let cond = if often {
            self.value(Type::I1)
        } else {
            self.rare()
        };
        self.builder.brif(cond, fail, stay);
        self.continue_in(fail);
        let code = self.rng.pick(FaultCode::ALL);
        self.builder.fault(code);
        self.continue_in(stay);
    }

    /// A condition that seldom holds.
    fn rare(&mut self) -> Value {
        let (value, small) = (self.value(Type::I8), self.constant(Type::I8));
        self.builder.compare(CompareOp::Eq, value, small)
    }

    fn return_now(&mut self) {
        let results = self.results.clone();
        let values = results.into_iter().map(|ty| self.value(ty)).collect();
        self.builder.ret(values);
    }
}

/// Memory, but not the whole state, which holds the times of timers.
fn is_part(route: &Route) -> bool {
    let is_state = route.root == Root::State && route.steps.is_empty();
    matches!(route.end, PlaceType::Mem(_)) && !is_state
}
