//! Any text as rung text: messages, or a tree that prints to text of the same tree.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    iecc_tests::check::rung(text);
});
