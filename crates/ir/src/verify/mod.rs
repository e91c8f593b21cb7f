//! The rules a module keeps. Everything behind the verifier relies on them.
//!
//! Module
//!  1. Names of structs, of fields in a struct, of functions, of reference parameters and locals of a
//!     function and (ignoring ASCII case) of aliases are unique; no reference or local is called
//!     `state`, `input` or `output`.
//!  2. Arrays have at least one element; each region has at most `MAX_REGION_BYTES`, the locals of all
//!     functions together have at most `MAX_LOCAL_BYTES`; the image has the size of the state region and `i1` bytes in it are 0 or 1.
//!     A view fits the scalars of its field; a field of structs has the plain one. A field has at most as many
//!     first numbers as dimensions, the last one is not 0, and the numbers of all elements fit `i64`.
//!  3. `scan` and `prescan` have no parameters and no results.
//!  4. Aliases are static places of the state.
//!  5. No function calls itself, directly or through others.
//!
//! Function
//!  6. There is an entry block; nothing jumps to it.
//!  7. Every block of the layout has a terminator; jumps go to blocks of the layout.
//!  8. Every value is defined once, before its use in its block or in a dominating block. In
//!     unreachable blocks the order is free.
//!  9. A jump passes as many arguments as the target has parameters, of the same types; `return`
//!     passes the results of the function.
//! 10. Operands and results have the types of the op table; a constant has no bits above its width.
//! 11. `brif` and `select` test an `i1`; `switch` has an integer and unequal cases within its width.
//!
//! Memory and time
//! 12. A place follows its types; constant indices and bits are inside the bounds; index values are
//!     `i32`, addresses `i64`. `address` takes no bit and nothing of an input, an output or a local, and
//!     gives an `i64`.
//! 13. Loads and stores move one scalar or bit of the result's or operand's type; `copy` moves and
//!     `clear` makes 0 whole scalars, structs and arrays, not bits, between places of one type.
//!     Inputs are not written to, outputs not read.
//! 14. A call passes one place per reference, of the same type, no input or output, and
//!     not ending in a bit; one value per parameter; its results are those of the callee.
//! 15. `elapsed` keeps its time in an `i64` that is no input or output; units are at least 1 ns;
//!     `elapsed` and `step` give `i32` or `i64`.

mod function;
mod inst;
mod module;

use crate::{Module, Origin};
use function::FunctionCheck;
use module::ModuleCheck;
use std::fmt;
use std::ops::Deref;

/// A module that keeps the rules. Back ends accept nothing else.
#[derive(Debug, Clone, Copy)]
pub struct Verified<'m>(&'m Module);

impl Deref for Verified<'_> {
    type Target = Module;

    fn deref(&self) -> &Module {
        self.0
    }
}

/// A broken rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VerifyError {
    /// Number of the rule in the list of `verify.rs`.
    pub rule: u8,
    /// The function it is broken in.
    pub function: Option<String>,
    /// What is wrong.
    pub message: String,
    /// Where the code comes from.
    pub origin: Option<Origin>,
}

impl fmt::Display for VerifyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.function {
            Some(name) => write!(f, "rule {}: @{name}: {}", self.rule, self.message),
            None => write!(f, "rule {}: {}", self.rule, self.message),
        }
    }
}

/// Checks all rules and reports every one that is broken.
pub fn verify(module: &Module) -> Result<Verified<'_>, Vec<VerifyError>> {
    let mut errors = Vec::new();
    ModuleCheck::new(module, &mut errors).run();
    // Function rules presuppose sane types.
    if errors.is_empty() {
        for func in module.funcs.values() {
            FunctionCheck::new(module, func, &mut errors).run();
        }
    }
    if errors.is_empty() {
        Ok(Verified(module))
    } else {
        Err(errors)
    }
}
