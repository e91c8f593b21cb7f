//! Wires the pipeline: files in, verified modules out.
//!
//! The only crate besides the command line that reads files. Every command and every test goes
//! through the functions here, so there is one pipeline and no second, laxer path.

mod build;
mod comments;
mod constants;
mod engine;
mod explain;
mod front;
mod output;
mod pipeline;
mod refusal;
pub mod run;
pub mod sim;

pub use build::{Replay, VerilogRequest, build_verilog};
pub use engine::EngineKind;
pub use explain::{explain_instruction, list_instructions};
pub use front::{FrontOptions, TimerBase, check, compile, load};
pub use iecc_sema::logix::{Edits, Init};
pub use output::write_artifacts;
pub use pipeline::{After, NoSuchPlace, Pipeline, list_passes, show};
