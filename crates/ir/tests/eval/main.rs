//! What every operation of the table computes, in values worked out by hand. Each table must cover
//! every operation of its family, so a new one does not go untested.

mod binary;
mod compare;
mod convert;
mod time;
mod unary;

use std::collections::BTreeSet;

/// Both canonical NaN, a NaN with a sign and payload per width, and other floats by name.
const NAN_32: u64 = 0x7fc0_0000;
const NAN_64: u64 = 0x7ff8_0000_0000_0000;
const OTHER_NAN_32: u64 = 0xffc1_2345;
const OTHER_NAN_64: u64 = 0xfff8_0000_0000_0123;
const SIGNALLING_32: u64 = 0x7f80_0001;
const SIGNALLING_64: u64 = 0x7ff0_0000_0000_0001;
const MINUS_0_32: u64 = 0x8000_0000;
const MINUS_0_64: u64 = 0x8000_0000_0000_0000;
const INF_32: u64 = 0x7f80_0000;
const MINUS_INF_32: u64 = 0xff80_0000;
const INF_64: u64 = 0x7ff0_0000_0000_0000;
const MINUS_INF_64: u64 = 0xfff0_0000_0000_0000;

fn f32_bits(number: f32) -> u64 {
    u64::from(number.to_bits())
}

fn f64_bits(number: f64) -> u64 {
    number.to_bits()
}

/// Panics unless the table's operations are all of the family.
fn covers<Op: Copy + Ord + std::fmt::Debug>(all: &[Op], tested: impl Iterator<Item = Op>) {
    let tested: BTreeSet<Op> = tested.collect();
    let missing: Vec<&Op> = all.iter().filter(|op| !tested.contains(op)).collect();
    assert!(missing.is_empty(), "no test for {missing:?}");
}
