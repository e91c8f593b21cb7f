//! Measures how long a module of the size of 100 000 lines takes from the builder to machine code.
//!
//! `cargo run --release -p iecc-tests --example big_module [FUNCTIONS] [STATEMENTS]`

#![expect(clippy::disallowed_methods, reason = "it measures time")]
#![expect(clippy::print_stdout, reason = "it reports what it measured")]

use iecc_ir::{
    BinaryOp, CompareOp, FieldDef, FuncId, Function, FunctionBuilder, Image, Layout, MemType,
    Module, Place, Root, StructId, Type, TypeTable, parse_module, print_module, verify,
};
use iecc_jit::Jit;
use iecc_passes::{SOFTWARE, Settings};
use std::time::Instant;

/// Fields of the struct that stands for a function block.
const FIELDS: u32 = 24;

fn main() {
    let mut numbers = std::env::args()
        .skip(1)
        .map(|text| text.parse().expect("a number"));
    let functions = numbers.next().unwrap_or(3_000u32);
    let statements = numbers.next().unwrap_or(32u32);
    let mut module = timed("build", || module(functions, statements));
    let count: usize = module.funcs.values().map(Function::inst_count).sum();
    println!("{functions} functions, {count} instructions");
    let text = timed("print", || print_module(&module));
    timed("parse", || parse_module(&text).expect("it was printed"));
    timed("verify", || verify(&module).expect("it keeps the rules"));
    for (number, name) in SOFTWARE.iter().enumerate() {
        let label = format!("pass {number} {name}");
        timed(&label, || {
            iecc_passes::run(name, &mut module, &Settings::default())
        })
        .expect("it is a pass");
    }
    let count: usize = module.funcs.values().map(instructions).sum();
    println!("{} functions, {count} instructions", module.funcs.len());
    let verified = timed("verify", || verify(&module).expect("passes keep the rules"));
    timed("machine code", || {
        Jit::new(verified).expect("it is not too large")
    });
}

fn instructions(func: &Function) -> usize {
    func.layout
        .iter()
        .map(|&block| func.block(block).insts.len())
        .sum()
}

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    println!("{:8.1} ms  {what}", start.elapsed().as_secs_f64() * 1e3);
    result
}

fn module(functions: u32, statements: u32) -> Module {
    let mut types = TypeTable::default();
    let number = |index| FieldDef::new(format!("v{index}"), MemType::Scalar(Type::I32));
    let block = types.add_struct("BLOCK", (0..FIELDS).map(number).collect());
    let instance = |index| FieldDef::new(format!("block{index}"), MemType::Struct(block));
    let state = types.add_struct("state", (0..functions).map(instance).collect());
    let input = types.add_struct("input", vec![number(0)]);
    let output = types.add_struct("output", vec![number(0)]);
    let mut module = Module {
        name: "big".to_owned(),
        image: Image::zero(&Layout::new(&types), &types, state),
        types,
        state,
        input,
        output,
        funcs: cranelift_entity::PrimaryMap::new(),
        scan: FuncId::from_u32(0),
        prescan: None,
        names: Vec::new(),
        origins: cranelift_entity::PrimaryMap::new(),
    };
    for index in 0..functions {
        module.funcs.push(block_function(index, block, statements));
    }
    module.scan = module.funcs.push(scan(functions));
    module
}

/// `IF v1 > v2 THEN v3 := v1 + v2; ELSE v3 := v1 * v2 - v3; END_IF`, over all fields.
fn block_function(index: u32, block: StructId, statements: u32) -> Function {
    let mut builder = FunctionBuilder::new(format!("block{index}"), &[], &[]);
    let this = builder.add_ref("this", MemType::Struct(block));
    let place = |field: u32| Place::root(Root::Ref(this)).field(field % FIELDS);
    let temporary = builder.declare(Type::I32);
    for statement in 0..statements {
        let fields = [statement + index, statement * 7 + 1, statement * 3 + 2];
        let [a, b, c] = fields.map(place);
        let (x, y) = (builder.load(a, Type::I32), builder.load(b, Type::I32));
        let cond = builder.compare(CompareOp::Sgt, x, y);
        let [then, otherwise, join] = [(); 3].map(|()| builder.create_block());
        builder.brif(cond, then, otherwise);
        builder.seal(then);
        builder.switch_to(then);
        let sum = builder.binary(BinaryOp::Add, x, y);
        builder.assign(temporary, sum);
        builder.jump(join);
        builder.seal(otherwise);
        builder.switch_to(otherwise);
        let product = builder.binary(BinaryOp::Mul, x, y);
        let old = builder.read(temporary);
        let difference = builder.binary(BinaryOp::Sub, product, old);
        builder.assign(temporary, difference);
        builder.jump(join);
        builder.seal(join);
        builder.switch_to(join);
        let result = builder.read(temporary);
        builder.store(c, result);
    }
    builder.ret(Vec::new());
    builder.finish()
}

fn scan(functions: u32) -> Function {
    let mut builder = FunctionBuilder::new("scan", &[], &[]);
    for index in 0..functions {
        let instance = Place::root(Root::State).field(index);
        builder.call(FuncId::from_u32(index), vec![instance], Vec::new(), &[]);
    }
    builder.ret(Vec::new());
    builder.finish()
}
