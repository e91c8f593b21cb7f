//! What a test feeds to an engine: the time and the inputs of each scan.

use crate::leaves::{Leaf, leaves};
use crate::rng::Rng;
use iecc_ir::{Module, Region, Type};
use iecc_target::region_bytes;

/// One scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanInput {
    /// Its time.
    pub now_ns: u64,
    /// The bytes of the input region.
    pub inputs: Vec<u8>,
}

/// A random stimulus: time starts at 0 and never runs backwards; each input changes now and then,
/// often to a value at the edge of its type.
pub fn random_stimulus(module: &Module, rng: &mut Rng, scans: usize) -> Vec<ScanInput> {
    let leaves = leaves(module, Region::Input);
    let mut inputs = region_bytes(module, Region::Input);
    let mut now_ns = 0;
    let mut stimulus = Vec::with_capacity(scans);
    for _ in 0..scans {
        for leaf in &leaves {
            change(leaf, rng, &mut inputs);
        }
        stimulus.push(ScanInput {
            now_ns,
            inputs: inputs.clone(),
        });
        now_ns += interval_ns(rng);
    }
    stimulus
}

fn change(leaf: &Leaf, rng: &mut Rng, inputs: &mut [u8]) {
    if !rng.one_in(3) {
        leaf.set(inputs, random_bits(leaf.ty, rng));
    }
}

/// Mostly a scan of some milliseconds, sometimes none, an odd one, or hours.
fn interval_ns(rng: &mut Rng) -> u64 {
    match rng.below(8) {
        0 => 0,
        1 => rng.next_u64() % 3_000_000,
        2 => rng.next_u64() % 10_000_000_000_000,
        _ => 1_000_000 * rng.pick(&[1, 5, 10, 100]),
    }
}

/// A value of a type: an edge, a small number, or anything; `i1` is 0 or 1.
pub fn random_bits(ty: Type, rng: &mut Rng) -> u64 {
    let bits = match rng.below(4) {
        0 => edge(ty, rng),
        1 => small(ty, rng),
        _ => rng.next_u64(),
    };
    bits & ty.mask()
}

fn edge(ty: Type, rng: &mut Rng) -> u64 {
    match ty {
        Type::I1 => rng.next_u64(),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => {
            let max = ty.mask() >> 1;
            rng.pick(&[0, 1, max, max + 1, max - 1, ty.mask(), ty.mask() - 1])
        }
        Type::F32 => u64::from(rng.pick(&FLOAT_EDGES).to_bits()),
        Type::F64 => f64::from(rng.pick(&FLOAT_EDGES)).to_bits(),
    }
}

const FLOAT_EDGES: [f32; 12] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.5,
    -2.5,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    f32::MAX,
    f32::MIN_POSITIVE,
];

fn small(ty: Type, rng: &mut Rng) -> u64 {
    let number = rng.below(20) as i64 - 6;
    match ty {
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => number as u64,
        Type::F32 => u64::from((number as f32 / 2.0).to_bits()),
        Type::F64 => (number as f64 / 2.0).to_bits(),
    }
}
