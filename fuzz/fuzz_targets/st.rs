//! Any text as Structured Text: messages, or a tree that prints to text of the same tree.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    iecc_tests::check::st(text);
});
