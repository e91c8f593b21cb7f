//! Decides what a program means: names, types, constants, operands, order of execution.
//!
//! [`logix::analyze`] turns the AST of a Rockwell project into the typed program of [`hir`], and
//! reports every error of the file in one run. What this version does not compile is refused with
//! a code at its place; in code that never runs a refusal is only a warning. Nothing here reads
//! files or knows the IR.

pub mod hir;
pub mod logix;
pub mod st;
