//! Wires the pipeline: files in, verified modules out.
//!
//! The only crate besides the command line that reads files. Every command and every test goes
//! through the functions here, so there is one pipeline and no second, laxer path.

mod build;
mod choices;
mod comments;
mod constants;
mod engine;
mod evaluate;
mod explain;
mod front;
mod levels;
mod output;
mod parallel;
mod parsed_library;
mod pipeline;
mod project;
mod refusal;
mod rename;
pub mod run;
pub mod sim;
mod sources;
pub mod testing;

pub use build::{Replay, VerilogRequest, build_object, build_verilog};
pub use choices::{Choice, DIALECTS, EDITS, FAULTS, INITS, LEVELS, find as find_choice};
pub use engine::EngineKind;
pub use evaluate::Constants;
pub use explain::{explain_instruction, list_instructions};
pub use front::{
    Compiled, FrontOptions, TimerBase, check, check_options, compile, compile_with_tick,
};
pub use iecc_grammar::st::Dialect;

pub use iecc_jit::Cpu;
pub use iecc_lower::OnFault;
pub use iecc_sema::logix::{Edits, Init};
pub use iecc_sema::st::testing::Tests;
pub use levels::{Level, Levels};
pub use output::{write_artifacts, write_file};
pub use parallel::parallel_map;
pub use parsed_library::ParsedLibrary;
pub use pipeline::{After, NoSuchPlace, Pipeline, list_passes, show};
pub use project::{Found, PROJECT_FILE, Project, VerilogSettings, find};
pub use rename::Rename;
pub use sources::{FRONTENDS, FrontEnd, Language, Sources, load};
