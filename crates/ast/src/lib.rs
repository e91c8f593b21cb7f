//! Holds what was written, before anything decides what it means.
//!
//! [`rung`] is one ladder rung, [`logix`] a Rockwell project, [`st`] Structured Text. Everything is
//! plain data; every name and text keeps the place where it stands. Names keep the spelling of the user: all languages
//! here ignore case, and whoever compares names folds them. Nothing is checked beyond syntax, so
//! names may be missing, doubled or unknown.
//!
//! Readers bound the nesting of everything that is a tree here, so visitors may recurse: expressions of
//! ladder count at most 64 brackets and 256 operators, rungs 64 branches, tag data 128 levels, Structured
//! Text what [`st`] says.

mod data;
pub mod logix;
mod names;
mod numbers;
pub mod rung;
mod rung_text;
pub mod st;

pub use data::{Initial, L5kValue, Parameters, StringData, Value, ValueKind};
pub use names::{Names, Symbol};
pub use numbers::{Number, RealText, StringLiteral, parse_number, underlines_are_between_digits};

/// A name or a short text, as spelled, and where.
pub type Name = iecc_source::Spanned<String>;
