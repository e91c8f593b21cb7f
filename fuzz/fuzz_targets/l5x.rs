//! Any text as an L5X export: no panic, and a message where there is no project.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| iecc_tests::check::l5x(text));
