//! Any text as a program in Structured Text: errors, or a module that keeps the rules of the IR.
#![no_main]

use iecc_driver::{FrontOptions, ParsedLibrary};
use std::sync::LazyLock;

static LIBRARY: LazyLock<ParsedLibrary> = LazyLock::new(ParsedLibrary::parse);

libfuzzer_sys::fuzz_target!(|text: &str| {
    iecc_tests::check::st_program(&LIBRARY, text, &FrontOptions::default());
});
