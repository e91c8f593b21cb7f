//! Every operation of the op table at its edges: machine code gives what `iecc_ir::eval` gives, for
//! operands known only at run time and for a constant right operand.

use iecc_ir::eval::{eval_binary, eval_compare, eval_convert, eval_elapsed, eval_unary};
use iecc_ir::{BinaryOp, CompareOp, ConvertOp, Type, UnaryOp, parse_module, verify};
use iecc_jit::Jit;
use iecc_target::Engine;

fn compile(text: &str) -> Jit {
    let module = parse_module(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let verified = verify(&module).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
    Jit::new(verified).unwrap()
}

/// Operands where operations change their behaviour, as bits.
fn edges(ty: Type) -> Vec<u64> {
    match ty {
        Type::I1 => vec![0, 1],
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => int_edges(ty),
        Type::F32 => float_edges()
            .iter()
            .map(|&x| u64::from((x as f32).to_bits()))
            .chain(odd_f32())
            .collect(),
        Type::F64 => float_edges()
            .iter()
            .map(|x| x.to_bits())
            .chain(odd_f64())
            .collect(),
    }
}

fn int_edges(ty: Type) -> Vec<u64> {
    let (mask, sign, width) = (ty.mask(), 1 << (ty.bits() - 1), u64::from(ty.bits()));
    let mut all = vec![0, 1, 2, 3, 7, 10, 100, width - 1, width, width + 1];
    all.extend([sign - 1, sign, sign + 1, mask - 9, mask - 2, mask - 1, mask]);
    all.extend([
        0x0123_4567_89ab_cdef & mask,
        0x20_0000_0000_0001 & mask,
        0x100_0001 & mask,
    ]);
    all
}

fn float_edges() -> Vec<f64> {
    let mut all = vec![
        0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.5, 3.5, 1e-40, 1e-310, 1e10, 1e30, 1e300,
    ];
    for bits in [7, 8, 15, 16, 31, 32, 53, 63, 64] {
        let power = 2f64.powi(bits);
        all.extend([
            power,
            power - 1.0,
            power - 0.5,
            power - 0.25,
            power + 0.5,
            power + 1.0,
        ]);
    }
    all.push(f64::INFINITY);
    let negative: Vec<f64> = all.iter().map(|x| -x).collect();
    all.extend(negative);
    all
}

/// NaN with payload and sign, quiet and signalling, and the ends of the range.
fn odd_f32() -> Vec<u64> {
    vec![
        0x7fc0_0000,
        0xffc0_0000,
        0x7f80_0001,
        0xffbf_ffff,
        0x7fc1_2345,
        1,
        0x7f7f_ffff,
        0x0080_0000,
    ]
}

fn odd_f64() -> Vec<u64> {
    let high = [
        0x7ff8, 0xfff8, 0x7ff4, 0xfff1, 0x7fef, 0x0010, 0x36a0, 0x47ef,
    ];
    let mut all: Vec<u64> = high.iter().map(|h| h << 48).collect();
    all.extend([
        0x7ff0_0000_0000_0001,
        0xfff8_0000_dead_beef,
        1,
        0x47ef_ffff_f000_0000,
    ]);
    all
}

fn bytes(ty: Type, bits: u64) -> Vec<u8> {
    bits.to_le_bytes()[..ty.bytes() as usize].to_vec()
}

fn run(jit: &mut Jit, operands: &[(Type, u64)], result: Type) -> u64 {
    let inputs: Vec<u8> = operands
        .iter()
        .flat_map(|&(ty, bits)| bytes(ty, bits))
        .collect();
    let mut outputs = vec![0; result.bytes() as usize];
    jit.step(0, &inputs, &mut outputs).unwrap();
    let mut bits = [0; 8];
    bits[..outputs.len()].copy_from_slice(&outputs);
    u64::from_le_bytes(bits)
}

fn one_operand(from: Type, to: Type, operation: &str) -> Jit {
    compile(&format!(
        "module m\nstate {{ }}\ninput {{ x: {from} }}\noutput {{ r: {to} }}\nscan @s\n\
         fn @s[]() -> () {{\nb0:\n  v0: {from} = load input.x\n  v1: {to} = {operation} v0\n  \
         store output.r, v1\n  return\n}}\n"
    ))
}

/// The right operand is a second input, or the constant.
fn two_operands(ty: Type, to: Type, operation: &str, constant: Option<u64>) -> Jit {
    let right = match constant {
        Some(bits) => format!("const {bits:#x}"),
        None => "load input.y".to_owned(),
    };
    compile(&format!(
        "module m\nstate {{ }}\ninput {{ x: {ty}, y: {ty} }}\noutput {{ r: {to} }}\nscan @s\n\
         fn @s[]() -> () {{\nb0:\n  v0: {ty} = load input.x\n  v1: {ty} = {right}\n  \
         v2: {to} = {operation} v0, v1\n  store output.r, v2\n  return\n}}\n"
    ))
}

#[test]
fn unary_operations_are_those_of_the_table() {
    for &op in UnaryOp::ALL {
        for ty in Type::ALL.into_iter().filter(|&ty| op.class().accepts(ty)) {
            let mut jit = one_operand(ty, ty, op.name());
            for x in edges(ty) {
                let found = run(&mut jit, &[(ty, x)], ty);
                assert_eq!(found, eval_unary(op, ty, x), "{op} {ty} {x:#x}");
            }
        }
    }
}

fn check_pairs(name: &str, ty: Type, to: Type, eval: &dyn Fn(u64, u64) -> u64) {
    let mut jit = two_operands(ty, to, name, None);
    for y in edges(ty) {
        let mut by_constant = two_operands(ty, to, name, Some(y));
        for x in edges(ty) {
            let (operands, expected) = ([(ty, x), (ty, y)], eval(x, y));
            let found = run(&mut jit, &operands, to);
            assert_eq!(found, expected, "{name} {ty} {x:#x}, {y:#x}");
            let found = run(&mut by_constant, &operands, to);
            assert_eq!(found, expected, "{name} {ty} {x:#x}, constant {y:#x}");
        }
    }
}

#[test]
fn binary_operations_are_those_of_the_table() {
    for &op in BinaryOp::ALL {
        for ty in Type::ALL.into_iter().filter(|&ty| op.class().accepts(ty)) {
            check_pairs(op.name(), ty, ty, &|x, y| eval_binary(op, ty, x, y));
        }
    }
}

#[test]
fn comparisons_are_those_of_the_table() {
    for &op in CompareOp::ALL {
        for ty in Type::ALL.into_iter().filter(|&ty| op.class().accepts(ty)) {
            check_pairs(op.name(), ty, Type::I1, &|x, y| {
                eval_compare(op, ty, x, y).into()
            });
        }
    }
}

#[test]
fn conversions_are_those_of_the_table() {
    let pairs = Type::ALL
        .into_iter()
        .flat_map(|from| Type::ALL.map(|to| (from, to)));
    for (from, to) in pairs {
        for &op in ConvertOp::ALL.iter().filter(|op| op.accepts(from, to)) {
            let mut jit = one_operand(from, to, op.name());
            for x in edges(from) {
                let found = run(&mut jit, &[(from, x)], to);
                assert_eq!(
                    found,
                    eval_convert(op, from, to, x),
                    "{op} {from} {x:#x} to {to}"
                );
            }
        }
    }
}

#[test]
fn select_takes_the_first_for_1_and_moves_bits_unchanged() {
    for ty in Type::ALL {
        let mut jit = compile(&format!(
            "module m\nstate {{ }}\ninput {{ x: {ty}, y: {ty}, c: i1 }}\noutput {{ r: {ty} }}\nscan @s\n\
             fn @s[]() -> () {{\nb0:\n  v0: {ty} = load input.x\n  v1: {ty} = load input.y\n  \
             v2: i1 = load input.c\n  v3: {ty} = select v2, v0, v1\n  store output.r, v3\n  return\n}}\n"
        ));
        // The region is padded to the alignment of its widest field.
        let padding = vec![(Type::I8, 0); ty.bytes() as usize - 1];
        for x in edges(ty) {
            for (c, expected) in [(1, x), (0, x ^ 1)] {
                let mut operands = vec![(ty, x), (ty, x ^ 1), (Type::I1, c)];
                operands.extend(&padding);
                assert_eq!(
                    run(&mut jit, &operands, ty),
                    expected,
                    "select {c} {ty} {x:#x}"
                );
            }
        }
    }
}

#[test]
fn elapsed_counts_boundaries_of_the_unit() {
    const MS: u64 = 1_000_000;
    let times = [
        0,
        1,
        MS - 1,
        MS,
        MS + 1,
        5 * MS,
        u64::MAX >> 1,
        u64::MAX - 1,
        u64::MAX,
    ];
    for (ty, unit, unit_ns) in [
        (Type::I32, "1ms", MS),
        (Type::I32, "1ns", 1),
        (Type::I64, "1ns", 1),
        (Type::I64, "7us", 7_000),
    ] {
        for since in times {
            let mut jit = compile(&format!(
                "module m\nstate {{ t: i64 }}\ninput {{ }}\noutput {{ r: {ty} }}\ninit t = {since:#x}\nscan @s\n\
                 fn @s[]() -> () {{\nb0:\n  v0: {ty} = elapsed state.t, {unit}\n  store output.r, v0\n  return\n}}\n"
            ));
            for now in times {
                jit.set_state(&since.to_le_bytes());
                let mut outputs = vec![0; ty.bytes() as usize];
                jit.step(now, &[], &mut outputs).unwrap();
                let expected = eval_elapsed(now, since, unit_ns, ty);
                assert_eq!(outputs, bytes(ty, expected), "{since} to {now} in {unit}");
                assert_eq!(jit.state(), now.to_le_bytes(), "the time is renewed");
            }
        }
    }
}
