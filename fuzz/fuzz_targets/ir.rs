//! Any text as a module in the text form: a message, or a module that prints to itself and, if it
//! keeps the verifier's rules, runs.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    iecc_tests::check::ir(text);
});
