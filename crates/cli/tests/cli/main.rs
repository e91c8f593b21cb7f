//! The real program `iecc`, run on files as users run it.
#![expect(clippy::disallowed_methods, reason = "the program is run on files")]

mod bad_input;
mod commands;
mod conformance;
mod sources;
mod support;
mod unit_tests;
