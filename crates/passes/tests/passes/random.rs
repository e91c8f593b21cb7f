//! Random programs: whatever a pass does to them, they must go on doing the same.

use crate::check::{module, same_behaviour};
use iecc_ir::{
    BinaryOp, Block, CompareOp, ConvertOp, FaultCode, FuncId, FunctionBuilder, Index, Module,
    Place, Root, Type, UnaryOp, Value, Variable,
};
use iecc_passes::{CHANGE_STATE, HARDWARE, PASSES, SOFTWARE, Settings, run, run_pipeline};

/// Numbers from a seed (xorshift64*).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    pub(crate) fn below(&mut self, limit: u64) -> u64 {
        (self.next() >> 33) % limit
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len() as u64) as usize]
    }

    /// Bits of a value, mostly small or at an edge.
    pub(crate) fn bits(&mut self, ty: Type) -> u64 {
        let any = self.next();
        let edge = ty.mask() >> 1;
        let bits = match self.below(8) {
            0 => 0,
            1 => u64::MAX,
            2 => edge,
            3 => edge + 1,
            4 => any,
            5 if ty == Type::F32 => u64::from(1.5f32.to_bits()),
            5 if ty == Type::F64 => (-2.0f64).to_bits(),
            _ => any % 9,
        };
        bits & ty.mask()
    }
}

const HEADER: &str = "module random
struct T { n: i32, on: i1, last: i64, w: i16 }
state { a: i1, b: i1, c: i8, d: i16, e: i32, f: i64, g: f32, h: f64, t: T, u: T, v: [3 x T], \
p: [4 x i32], q: [5 x i1], w: i32, word: i16 }
input { ia: i1, ib: i1, ic: i8, id: i16, ie: i32, if: i64, ig: f32, ih: f64 }
output { oa: i1, ob: i1, oc: i8, od: i16, oe: i32, of: i64, og: f32, oh: f64 }
init e = 5
init t.n = 3
init w = 170
init word = -2
init q[2] = 1
name \"word.3\" = state.word.3
scan @scan
";

const TYPES: [Type; 8] = [
    Type::I1,
    Type::I1,
    Type::I8,
    Type::I16,
    Type::I32,
    Type::I64,
    Type::F32,
    Type::F64,
];

struct Generator<'r> {
    random: &'r mut Random,
    builder: FunctionBuilder,
    variables: Vec<(Type, Variable)>,
    /// The place the function's own instance lies at; a reference in callees.
    instance: Place,
    callees: Vec<FuncId>,
    is_scan: bool,
    left: u32,
}

impl Generator<'_> {
    fn any_type(&mut self) -> Type {
        self.random.pick(&TYPES)
    }

    fn value(&mut self, ty: Type) -> Value {
        let fitting: Vec<Variable> = self
            .variables
            .iter()
            .filter(|(t, _)| *t == ty)
            .map(|(_, v)| *v)
            .collect();
        if self.random.one_in(4) {
            let bits = self.random.bits(ty);
            return self.builder.constant(ty, bits);
        }
        let variable = self.random.pick(&fitting);
        self.builder.read(variable)
    }

    fn assign(&mut self, value: Value) {
        let ty = self.builder.value_type(value);
        let fitting: Vec<Variable> = self
            .variables
            .iter()
            .filter(|(t, _)| *t == ty)
            .map(|(_, v)| *v)
            .collect();
        let variable = self.random.pick(&fitting);
        self.builder.assign(variable, value);
    }

    fn index(&mut self, len: u64) -> Index {
        if self.random.one_in(3) {
            Index::Value(self.value(Type::I32))
        } else {
            Index::Const(self.random.below(len) as u32)
        }
    }

    fn bit_index(&mut self, ty: Type) -> Index {
        if self.random.one_in(6) {
            Index::Value(self.value(Type::I32))
        } else {
            Index::Const(self.random.below(u64::from(ty.bits())) as u32)
        }
    }

    /// A scalar or bit of the state.
    fn state_place(&mut self) -> (Place, Type) {
        let state = Place::root(Root::State);
        let in_instance = self.random.one_in(3) || !self.is_scan;
        if in_instance {
            let base = match self.random.below(4) {
                _ if !self.is_scan && !self.random.one_in(5) => self.instance.clone(),
                0 => state.field(8),
                1 => state.field(9),
                _ => {
                    let index = self.index(3);
                    state.field(10).index(index)
                }
            };
            return match self.random.below(4) {
                0 => (base.field(0), Type::I32),
                1 => (base.field(1), Type::I1),
                2 => {
                    let bit = self.bit_index(Type::I16);
                    (base.field(3).bit(bit), Type::I1)
                }
                _ => {
                    let bit = self.bit_index(Type::I32);
                    (base.field(0).bit(bit), Type::I1)
                }
            };
        }
        match self.random.below(12) {
            field @ 0..=7 => {
                let types = [
                    Type::I1,
                    Type::I1,
                    Type::I8,
                    Type::I16,
                    Type::I32,
                    Type::I64,
                    Type::F32,
                    Type::F64,
                ];
                (state.field(field as u32), types[field as usize])
            }
            8 => {
                let index = self.index(4);
                (state.field(11).index(index), Type::I32)
            }
            9 => {
                let index = self.index(5);
                (state.field(12).index(index), Type::I1)
            }
            10 => {
                let bit = self.bit_index(Type::I32);
                (state.field(13).bit(bit), Type::I1)
            }
            _ => {
                let bit = Index::Const(self.random.below(16) as u32);
                (state.field(14).bit(bit), Type::I1)
            }
        }
    }

    fn expression(&mut self) -> Value {
        let ty = self.any_type();
        match self.random.below(8) {
            0 => {
                let (place, ty) = self.state_place();
                self.builder.load(place, ty)
            }
            1 if self.is_scan => {
                let field = self.random.below(8) as u32;
                let ty = [0, 1, 2, 3, 4, 5, 6, 7].map(|i: usize| TYPES_OF_IO[i])[field as usize];
                self.builder.load(Place::root(Root::Input).field(field), ty)
            }
            2 => {
                let op = self.random.pick(UnaryOp::ALL);
                let arg = self.value(ty);
                if op.class().accepts(ty) {
                    self.builder.unary(op, arg)
                } else {
                    arg
                }
            }
            3 => {
                let op = self.random.pick(CompareOp::ALL);
                let args = [self.value(ty), self.value(ty)];
                if op.class().accepts(ty) {
                    self.builder.compare(op, args[0], args[1])
                } else {
                    args[0]
                }
            }
            4 => {
                let (op, to) = (self.random.pick(ConvertOp::ALL), self.any_type());
                let arg = self.value(ty);
                if op.accepts(ty, to) {
                    self.builder.convert(op, to, arg)
                } else {
                    arg
                }
            }
            5 => {
                let cond = self.value(Type::I1);
                let args = [self.value(ty), self.value(ty)];
                self.builder.select(cond, args[0], args[1])
            }
            _ => {
                let op = self.random.pick(BinaryOp::ALL);
                let args = [self.value(ty), self.value(ty)];
                if op.class().accepts(ty) {
                    self.builder.binary(op, args[0], args[1])
                } else {
                    args[1]
                }
            }
        }
    }

    fn statement(&mut self, depth: u32) {
        match self.random.below(20) {
            0..=8 => {
                let value = self.expression();
                self.assign(value);
            }
            9..=11 => {
                let (place, ty) = self.state_place();
                let value = self.value(ty);
                self.builder.store(place, value);
            }
            12 if self.is_scan && self.random.one_in(2) => {
                let field = self.random.below(8);
                let value = self.value(TYPES_OF_IO[field as usize]);
                let place = Place::root(Root::Output).field(field as u32);
                self.builder.store(place, value);
            }
            13 => self.time(),
            14 if depth < 4 && self.random.one_in(3) => self.repeat(depth),
            15 if depth < 4 => self.choose(depth),
            16 if self.random.one_in(6) => self.fault(),
            17 => self.call(),
            _ if depth < 4 => self.branch(depth),
            _ => {}
        }
    }

    fn time(&mut self) {
        let value = match self.random.below(4) {
            0 => self.builder.now(),
            _ => {
                let place = self.instance.clone().field(2);
                let ty = self.random.pick(&[Type::I32, Type::I64]);
                self.builder.elapsed(place, 1_000_000, ty)
            }
        };
        self.assign(value);
    }

    fn call(&mut self) {
        if self.callees.is_empty() {
            return;
        }
        let callee = self.random.pick(&self.callees.clone());
        let place = if self.is_scan {
            match self.random.below(3) {
                0 => Place::root(Root::State).field(8),
                1 => Place::root(Root::State).field(9),
                _ => {
                    let index = self.index(3);
                    Place::root(Root::State).field(10).index(index)
                }
            }
        } else {
            self.instance.clone()
        };
        let args = vec![self.value(Type::I32), self.value(Type::I1)];
        let results = self
            .builder
            .call(callee, vec![place], args, &[Type::I32, Type::I1]);
        results.into_iter().for_each(|value| self.assign(value));
    }

    fn statements(&mut self, depth: u32) {
        let count = 1 + self.random.below(6);
        for _ in 0..count {
            if self.left == 0 || !self.builder.is_open() {
                return;
            }
            self.left -= 1;
            self.statement(depth);
        }
    }

    fn arm(&mut self, block: Block, join: Block, depth: u32) {
        self.builder.switch_to(block);
        self.builder.seal(block);
        self.statements(depth + 1);
        if self.builder.is_open() {
            if self.random.one_in(12) {
                self.leave();
            } else {
                self.builder.jump(join);
            }
        }
    }

    fn branch(&mut self, depth: u32) {
        let cond = self.value(Type::I1);
        let blocks = [(); 3].map(|()| self.builder.create_block());
        let [then, otherwise, join] = blocks;
        if self.random.one_in(3) {
            self.builder.brif(cond, then, join);
            // A block nobody jumps to is legal.
            self.builder.seal(otherwise);
            self.builder.switch_to(otherwise);
            self.builder.fault(FaultCode::Range);
        } else {
            self.builder.brif(cond, then, otherwise);
            self.arm(otherwise, join, depth);
        }
        self.arm(then, join, depth);
        self.builder.seal(join);
        self.builder.switch_to(join);
    }

    fn choose(&mut self, depth: u32) {
        let ty = self.random.pick(&[Type::I1, Type::I8, Type::I32]);
        let value = self.value(ty);
        let blocks = [(); 3].map(|()| self.builder.create_block());
        let [one, two, join] = blocks;
        let cases = match ty {
            Type::I1 => vec![(1, one), (0, two)],
            Type::I8 | Type::I16 | Type::I32 | Type::I64 | Type::F32 | Type::F64 => {
                vec![(1, one), (3, two), (7, one), (2, join)]
            }
        };
        self.builder.switch(value, cases, join);
        self.arm(one, join, depth);
        self.arm(two, join, depth);
        self.builder.seal(join);
        self.builder.switch_to(join);
    }

    /// A loop that runs at most three times.
    fn repeat(&mut self, depth: u32) {
        let counter = self.builder.declare(Type::I8);
        let [head, body, exit] = [(); 3].map(|()| self.builder.create_block());
        let three = self.builder.constant(Type::I8, 3);
        self.builder.assign(counter, three);
        self.builder.jump(head);
        self.builder.switch_to(head);
        let count = self.builder.read(counter);
        let zero = self.builder.constant(Type::I8, 0);
        let more = self.builder.compare(CompareOp::Sgt, count, zero);
        self.builder.brif(more, body, exit);
        self.builder.switch_to(body);
        self.builder.seal(body);
        let one = self.builder.constant(Type::I8, 1);
        let fewer = self.builder.binary(BinaryOp::Sub, count, one);
        self.builder.assign(counter, fewer);
        self.statements(depth + 1);
        if self.builder.is_open() {
            self.builder.jump(head);
        }
        self.builder.seal(head);
        self.builder.seal(exit);
        self.builder.switch_to(exit);
    }

    fn fault(&mut self) {
        let cond = self.value(Type::I1);
        let [stop, on] = [(); 2].map(|()| self.builder.create_block());
        self.builder.brif(cond, stop, on);
        self.builder.seal(stop);
        self.builder.switch_to(stop);
        self.builder.fault(FaultCode::Index);
        self.builder.seal(on);
        self.builder.switch_to(on);
    }

    fn leave(&mut self) {
        if self.is_scan {
            for (field, ty) in TYPES_OF_IO.into_iter().enumerate() {
                let value = self.value(ty);
                let place = Place::root(Root::Output).field(field as u32);
                self.builder.store(place, value);
            }
            self.builder.ret(Vec::new());
        } else {
            let values = vec![self.value(Type::I32), self.value(Type::I1)];
            self.builder.ret(values);
        }
    }
}

const TYPES_OF_IO: [Type; 8] = TYPES;

/// Functions of one reference that call the ones before; then the scan, of about `size` statements.
fn random_module(random: &mut Random, size: u32) -> Module {
    let dummy = "fn @f0[t: T](i32, i1) -> (i32, i1) {\nb0(v0: i32, v1: i1):\n  return v0, v1\n}\n\
                 fn @f1[t: T](i32, i1) -> (i32, i1) {\nb0(v0: i32, v1: i1):\n  return v0, v1\n}\n\
                 fn @scan[]() -> () {\nb0:\n  return\n}\n";
    let mut module = module(&format!("{HEADER}{dummy}"));
    let ids: Vec<FuncId> = module.funcs.keys().collect();
    for (position, &id) in ids.iter().enumerate() {
        let is_scan = id == module.scan;
        let (name, params, results): (_, &[Type], &[Type]) = match is_scan {
            true => ("scan".to_owned(), &[], &[]),
            false => (
                format!("f{position}"),
                &[Type::I32, Type::I1],
                &[Type::I32, Type::I1],
            ),
        };
        let mut builder = FunctionBuilder::new(name, params, results);
        let mut instance = Place::root(Root::State).field(8);
        if !is_scan {
            let ty = module.funcs[id].refs.values().next().expect("one").ty;
            instance = Place::root(Root::Ref(builder.add_ref("t", ty)));
        }
        let mut variables = Vec::new();
        for ty in [TYPES, TYPES].concat() {
            variables.push((ty, builder.declare(ty)));
        }
        let mut generator = Generator {
            random,
            builder,
            variables,
            instance,
            callees: ids[..position].to_vec(),
            is_scan,
            left: if is_scan { size } else { size / 4 },
        };
        for index in 0..params.len() {
            let param = generator.builder.param(index);
            generator.assign(param);
        }
        while generator.left > 0 {
            generator.statements(0);
        }
        generator.leave();
        module.funcs[id] = generator.builder.finish();
    }
    module
}

fn seeds() -> std::ops::Range<u64> {
    1..300
}

#[test]
fn every_pass_alone_keeps_the_meaning_of_random_programs() {
    for seed in seeds() {
        let before = random_module(&mut Random::new(seed), 30);
        for pass in PASSES {
            let mut after = before.clone();
            run(pass.name, &mut after, &Settings::default()).unwrap();
            let same_state = !CHANGE_STATE.contains(&pass.name);
            let when = format!("seed {seed}, {}", pass.name);
            same_behaviour(&before, &after, same_state, &when);
        }
    }
}

#[test]
fn pipelines_keep_the_meaning_of_random_programs() {
    for seed in seeds() {
        let before = random_module(&mut Random::new(seed), 60);
        for pipeline in [SOFTWARE, HARDWARE] {
            let mut after = before.clone();
            let mut same_state = true;
            let mut compare = |name: &str, module: &Module| {
                same_state &= !CHANGE_STATE.contains(&name);
                let when = format!("seed {seed}, up to {name}");
                same_behaviour(&before, module, same_state, &when);
            };
            run_pipeline(&mut after, pipeline, &Settings::default(), &mut compare).unwrap();
        }
    }
}

/// One block of operations on few, recent values and telling constants, where the rules of algebra
/// meet each other.
fn random_expressions(random: &mut Random) -> Module {
    let mut module = module(&format!(
        "{HEADER}fn @scan[]() -> () {{\nb0:\n  return\n}}\n"
    ));
    let mut builder = FunctionBuilder::new("scan", &[], &[]);
    let mut pool: Vec<Value> = Vec::new();
    for (field, ty) in TYPES_OF_IO.into_iter().enumerate() {
        pool.push(builder.load(Place::root(Root::Input).field(field as u32), ty));
    }
    // One integer type, so that operations follow each other; bits and conversions around it.
    let ty = random.pick(&[Type::I1, Type::I8, Type::I16, Type::I32, Type::I64]);
    for _ in 0..24 {
        let wanted = if random.one_in(4) { Type::I1 } else { ty };
        let args = [(); 2].map(|()| operand(random, &mut builder, &pool, wanted));
        let value = match random.below(10) {
            0 => {
                let op = random.pick(&[UnaryOp::Not, UnaryOp::Neg]);
                op.class()
                    .accepts(wanted)
                    .then(|| builder.unary(op, args[0]))
            }
            1 | 2 => {
                let op = random.pick(CompareOp::ALL);
                let accepted = op.class().accepts(wanted);
                accepted.then(|| builder.compare(op, args[0], args[1]))
            }
            3 => {
                let cond = operand(random, &mut builder, &pool, Type::I1);
                Some(builder.select(cond, args[0], args[1]))
            }
            4 | 5 => {
                let (op, to) = (random.pick(ConvertOp::ALL), random.pick(&TYPES));
                let from = random.pick(&pool);
                let accepted = op.accepts(builder.value_type(from), to);
                accepted.then(|| builder.convert(op, to, from))
            }
            _ => {
                let op = random.pick(BinaryOp::ALL);
                let accepted = op.class().accepts(wanted);
                accepted.then(|| builder.binary(op, args[0], args[1]))
            }
        };
        pool.extend(value);
    }
    for (field, ty) in TYPES_OF_IO.into_iter().enumerate() {
        let found = pool.iter().rev().find(|&&v| builder.value_type(v) == ty);
        let place = Place::root(Root::Output).field(field as u32);
        builder.store(place, *found.expect("every input is there"));
    }
    builder.ret(Vec::new());
    module.funcs[module.scan] = builder.finish();
    module
}

fn operand(random: &mut Random, builder: &mut FunctionBuilder, pool: &[Value], ty: Type) -> Value {
    if random.one_in(3) {
        let powers = 1 << random.below(u64::from(ty.bits()));
        let bits = match random.below(4) {
            0 => powers,
            1 => random.below(u64::from(ty.bits()) + 2),
            _ => random.bits(ty),
        };
        return builder.constant(ty, bits);
    }
    let fitting = pool.iter().rev().filter(|&&v| builder.value_type(v) == ty);
    let recent: Vec<Value> = fitting.take(4).copied().collect();
    random.pick(&recent)
}

#[test]
fn folding_keeps_the_meaning_of_random_expressions() {
    for seed in 1..4000 {
        let before = random_expressions(&mut Random::new(seed));
        let mut after = before.clone();
        run("fold", &mut after, &Settings::default()).unwrap();
        same_behaviour(&before, &after, true, &format!("seed {seed}"));
    }
}

/// A scan whose blocks jump to any later blocks: every graph without loops can come of it.
fn random_forward_graph(random: &mut Random, blocks: u64) -> Module {
    let mut module = module(&format!(
        "{HEADER}fn @scan[]() -> () {{\nb0:\n  return\n}}\n"
    ));
    let mut builder = FunctionBuilder::new("scan", &[], &[]);
    let variables = [TYPES, TYPES]
        .concat()
        .into_iter()
        .map(|ty| (ty, builder.declare(ty)))
        .collect();
    let mut generator = Generator {
        random,
        builder,
        variables,
        instance: Place::root(Root::State).field(8),
        callees: Vec::new(),
        is_scan: true,
        left: u32::MAX,
    };
    for (field, ty) in TYPES_OF_IO.into_iter().enumerate() {
        let place = Place::root(Root::Input).field(field as u32);
        let value = generator.builder.load(place, ty);
        generator.assign(value);
    }
    let later: Vec<Block> = (0..blocks)
        .map(|_| generator.builder.create_block())
        .collect();
    for next in 0..later.len() {
        generator.small_statements();
        generator.jump_on(&later[next..]);
        generator.builder.seal(later[next]);
        generator.builder.switch_to(later[next]);
    }
    generator.leave();
    module.funcs[module.scan] = generator.builder.finish();
    module
}

impl Generator<'_> {
    fn small_statements(&mut self) {
        for _ in 0..self.random.below(4) {
            let value = self.expression();
            self.assign(value);
            if self.random.one_in(3) {
                let (place, ty) = self.state_place();
                let value = self.value(ty);
                self.builder.store(place, value);
            }
        }
    }

    fn jump_on(&mut self, later: &[Block]) {
        // Near blocks more often, so that graphs are deep.
        let mut near = || {
            let reach = [2, 4, later.len()][self.random.below(3) as usize];
            later[self.random.below(reach.min(later.len()) as u64) as usize]
        };
        let targets = [near(), near(), near()];
        match self.random.below(4) {
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
}

#[test]
fn every_graph_without_loops_becomes_one_block_that_does_the_same() {
    for seed in 1..600 {
        let blocks = 2 + seed % 24;
        let before = random_forward_graph(&mut Random::new(seed), blocks);
        for passes in [
            &["promote", "if_convert"][..],
            &["if_convert_small"],
            HARDWARE,
            SOFTWARE,
        ] {
            let mut after = before.clone();
            let same_state = !passes.iter().any(|name| CHANGE_STATE.contains(name));
            let mut compare = |name: &str, module: &Module| {
                let when = format!("seed {seed}, up to {name}");
                same_behaviour(&before, module, same_state, &when);
            };
            run_pipeline(&mut after, passes, &Settings::default(), &mut compare).unwrap();
            if passes.contains(&"if_convert") {
                assert_eq!(after.funcs[after.scan].layout.len(), 1, "seed {seed}");
            }
        }
    }
}
