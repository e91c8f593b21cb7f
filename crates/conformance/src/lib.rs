//! The conformance suite of IEC 61131-3: cases, their runner, and the compliance statement.
//!
//! A case is one file of Structured Text that begins with a comment: which features of the standard
//! it covers, what it is about, and a table of scans with inputs and expected values, which people
//! work out by hand ([`Case::parse`]). [`run_case`] takes it through the pipeline that users have, runs
//! it on every engine, compares every expected value, and every output of every engine with those of
//! the reference interpreter. [`statement`] says which features that proves.
//!
//! Nothing here reads files: the texts of cases come in as arguments.

mod case;
mod cell;
mod engines;
mod features;
mod header;
mod messages;
mod run;
mod statement;
mod suite;
mod tables;
mod trace;

pub use case::{Case, CaseError, Only};
pub use engines::Family;
pub use features::{Edition, Feature, FeatureId, features};
pub use messages::Expected;
pub use run::{CaseResult, EngineResult, Outcome, run_case, run_module};
pub use statement::statement;
pub use suite::{Misread, failures, read_suite, summary};
pub use tables::{ErrorCondition, Extension, Parameter, errors, extensions, parameters};
pub use trace::{Row, Trace};
