//! Random programs in Structured Text, one for each seed: all engines for software agree.
#![no_main]

use iecc_tests::random_st::{Options, check_seed};

libfuzzer_sys::fuzz_target!(|seed: [u8; 8]| {
    if let Err(what) = check_seed(u64::from_le_bytes(seed), Options::default()) {
        panic!("{what}");
    }
});
