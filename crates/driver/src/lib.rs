//! Wires the pipeline: files in, verified modules out.
//!
//! The only crate besides the command line that reads files. Every command and every test goes
//! through the functions here, so there is one pipeline and no second, laxer path.

mod front;
pub mod run;

pub use front::{FrontOptions, TimerBase, check, compile, load};
