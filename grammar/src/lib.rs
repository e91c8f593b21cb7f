//! Turns text into AST.
//!
//! Lexers never fail: bytes that fit no token become `Unknown` tokens, which no grammar accepts,
//! so that the parser reports them at their exact place. Grammars accept a superset of the
//! language; what needs names or types to judge is left to the semantic analysis. Every entry
//! point bounds the nesting of what it returns.

mod rung;
mod rung_actions;
mod rung_lexer;
pub mod st;

pub use rung::{MAX_NESTING, MAX_OPERATORS, parse_rung};

/// The generated parsers of the `.lalrpop` files.
mod generated {
    #![allow(
        clippy::all,
        clippy::pedantic,
        clippy::restriction,
        missing_docs,
        unreachable_pub,
        unused_imports,
        rust_2018_idioms,
        reason = "generated code"
    )]
    lalrpop_util::lalrpop_mod!(pub rung);
    lalrpop_util::lalrpop_mod!(pub st);
}
