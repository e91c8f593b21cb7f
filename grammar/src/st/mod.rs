//! Structured Text: text to [`File`](iecc_ast::st::File).
//!
//! [`lex`] makes tokens, [`slice()`] cuts them into units, [`parse_unit`] makes a tree of one unit;
//! [`parse_file`] does all of it. A unit that is right is parsed as it stands. Only when that
//! fails its blocks are balanced and what is plainly missing is put in, each with one message, and
//! it is parsed again with recovery from what is left; so the guesses of the repair never touch a
//! program that is right.

#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "`Kind` is an alphabet: whoever names some tokens means all others alike"
)]

pub(crate) mod build;
mod declared;
mod depth;
mod explain;
mod feed;
mod file;
mod foreign;
mod lexer;
mod repair;
mod slice;
mod soft;
pub(crate) mod token;
mod unit;

pub use file::{Parsed, parse_file, reparse_file};
pub use lexer::{Tokens, lex};
pub use slice::{Fragment, FragmentKind, slice};
pub use token::{Kind, Token};
pub use unit::parse_unit;

/// Whose keywords hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Dialect {
    /// IEC 61131-3, edition 3.
    #[default]
    Iec,
    /// IEC 61131-3, edition 2: the words that edition 3 added are names.
    IecEdition2,
    /// CODESYS and TwinCAT: the words of Sequential Function Chart are names.
    Codesys,
}
