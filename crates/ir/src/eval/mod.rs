//! What the operations of the table compute, on bits.
//!
//! This is the one place that decides: the interpreter and the folding of constants call it, and
//! the back ends are tested against it. Operands and results are the bits of values, with 0 above
//! the width of their type. Every function is total for the types the table allows and panics for
//! others, which the verifier refuses.

mod binary;
mod compare;
mod convert;
mod float;
mod time;
mod unary;

pub use binary::eval_binary;
pub use compare::eval_compare;
pub use convert::eval_convert;
pub use float::canonical_nan;
pub use time::eval_elapsed;
pub use unary::eval_unary;
