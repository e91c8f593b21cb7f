//! Structured Text: what texts mean as trees, and which messages mistakes give.

mod check;
mod declarations;
mod dialects;
mod expressions;
mod lexer;
mod literals;
mod mistakes;
mod slices;
mod statements;
mod tests;
