//! Random programs in Structured Text, one for each seed: all engines for software agree.
#![no_main]

use iecc_driver::ParsedLibrary;
use iecc_tests::random_st::{Options, check_seed};
use std::sync::LazyLock;

static LIBRARY: LazyLock<ParsedLibrary> = LazyLock::new(ParsedLibrary::parse);

libfuzzer_sys::fuzz_target!(|seed: [u8; 8]| {
    let seed = u64::from_le_bytes(seed);
    if let Err(what) = check_seed(&LIBRARY, seed, Options::default()) {
        panic!("{what}");
    }
});
