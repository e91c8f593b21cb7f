//! One block of operations on few, recent values and telling constants, where the rules of algebra
//! meet each other.

use crate::rng::Rng;
use crate::stimulus::random_bits;
use iecc_ir::{
    BinaryOp, CompareOp, ConvertOp, FunctionBuilder, Module, Place, Root, Type, UnaryOp, Value,
    parse_module,
};

/// Operations of a scan.
const OPERATIONS: usize = 24;

/// Inputs and outputs of all types.
const EMPTY: &str = "module expressions
state { }
input { a: i1, b: i8, c: i16, d: i32, e: i64, f: f32, g: f64 }
output { a: i1, b: i8, c: i16, d: i32, e: i64, f: f32, g: f64 }
scan @scan

fn @scan[]() -> () {
b0:
  return
}
";

/// The module of a seed.
pub fn random_expressions(seed: u64) -> Module {
    let rng = &mut Rng::new(seed);
    let mut module = parse_module(EMPTY).expect("the text form");
    let mut builder = FunctionBuilder::new("scan", &[], &[]);
    let fields = (0..).zip(Type::ALL);
    let inputs = fields.map(|(field, ty)| builder.load(Place::root(Root::Input).field(field), ty));
    let mut scan = Expressions {
        pool: inputs.collect(),
        builder,
        rng,
    };
    // One integer type, so that operations follow each other; bits and conversions around it.
    let ty = scan
        .rng
        .pick(&[Type::I1, Type::I8, Type::I16, Type::I32, Type::I64]);
    for _ in 0..OPERATIONS {
        let wanted = if scan.rng.one_in(4) { Type::I1 } else { ty };
        let value = scan.operation(wanted);
        scan.pool.extend(value);
    }
    module.funcs[module.scan] = scan.finish();
    module
}

struct Expressions<'r> {
    pool: Vec<Value>,
    builder: FunctionBuilder,
    rng: &'r mut Rng,
}

impl Expressions<'_> {
    fn finish(mut self) -> iecc_ir::Function {
        for (field, ty) in (0..).zip(Type::ALL) {
            let mut latest = self.pool.iter().rev();
            let found = latest.find(|&&value| self.builder.value_type(value) == ty);
            let place = Place::root(Root::Output).field(field);
            self.builder
                .store(place, *found.expect("every input is there"));
        }
        self.builder.ret(Vec::new());
        self.builder.finish()
    }

    /// An operation on two operands of a type, if there is one as chosen.
    fn operation(&mut self, ty: Type) -> Option<Value> {
        let [left, right] = [(); 2].map(|()| self.operand(ty));
        match self.rng.below(10) {
            0 => {
                let op = self.rng.pick(&[UnaryOp::Not, UnaryOp::Neg]);
                let accepted = op.class().accepts(ty);
                accepted.then(|| self.builder.unary(op, left))
            }
            1 | 2 => {
                let op = self.rng.pick(CompareOp::ALL);
                let accepted = op.class().accepts(ty);
                accepted.then(|| self.builder.compare(op, left, right))
            }
            3 => {
                let cond = self.operand(Type::I1);
                Some(self.builder.select(cond, left, right))
            }
            4 | 5 => self.conversion(),
            _ => {
                let op = self.rng.pick(BinaryOp::ALL);
                let accepted = op.class().accepts(ty);
                accepted.then(|| self.builder.binary(op, left, right))
            }
        }
    }

    fn conversion(&mut self) -> Option<Value> {
        let (op, to) = (self.rng.pick(ConvertOp::ALL), self.rng.pick(&Type::ALL));
        let from = self.rng.pick(&self.pool);
        let accepted = op.accepts(self.builder.value_type(from), to);
        accepted.then(|| self.builder.convert(op, to, from))
    }

    /// A recent value, or a constant that rules look for: a power of two, a width, an edge.
    fn operand(&mut self, ty: Type) -> Value {
        if self.rng.one_in(3) {
            let width = ty.bits() as usize;
            let bits = match self.rng.below(4) {
                0 => 1 << self.rng.below(width),
                1 => self.rng.below(width + 2) as u64,
                _ => random_bits(ty, self.rng),
            };
            return self.builder.constant(ty, bits & ty.mask());
        }
        let fitting = self.pool.iter().rev();
        let fitting = fitting.filter(|&&value| self.builder.value_type(value) == ty);
        let recent: Vec<Value> = fitting.take(4).copied().collect();
        self.rng.pick(&recent)
    }
}
