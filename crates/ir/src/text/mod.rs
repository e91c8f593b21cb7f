//! The text form of modules: `print` and `parse`, inverse to each other.
//!
//! ```text
//! module demo
//! struct TIMER { EN: i1, DN: i1, PRE: i32, last: i64 }
//! state { run: i1, t: TIMER, "Local:2:I": i16 as bits, a: [4 x i32] from [1] }
//! input { Start: i1 }
//! output { Lamp: i1 }
//! init t.PRE = 2000                        ; scalars that are not 0
//! name "Local:2:I.3" = state."Local:2:I".3 ; bit 3 of an integer
//! origin @0 = "Main rung 5" 0:120..140     ; label, file number, bytes
//! scan @scan                               ; and perhaps: prescan @name
//!
//! fn @helper[t: TIMER](i1) -> (i32) {
//! b0(v0: i1):
//!   v1: i32 = elapsed t.last, 1ms
//!   brif v0, b1, b2(v1) @0
//! b1:
//!   return v1
//! b2(v2: i32):
//!   v3: i32 = const -7
//!   v4: i32 = add v2, v3
//!   return v4
//! }
//! fn @scan[]() -> () {
//! b0:
//!   v0: i1 = load input.Start @0
//!   v1: i32 = call @helper[state.t](v0)
//!   store state.a[3], v1
//!   store state."Local:2:I".[v1], v0       ; bit by value
//!   call @spare[state.t]()
//!   return
//! }
//! fn @spare[t: TIMER]() -> () {
//!   local old: TIMER                       ; memory of this activation, 0 at its start
//! b0:
//!   copy old, t                            ; whole structs and arrays
//!   clear t
//!   v0: i64 = address t.PRE               ; where it lies in the state, as a number
//!   v1: i32 = load deref v0: i32           ; and what lies there
//!   return
//! }
//! ```
//!
//! `from` behind the type of a field is the number people give the first element in each dimension; places
//! count from 0 nevertheless. `as` is how people see its numbers; `plain` is left out. Comments run from `;` to the end of the line. Names that are not plain identifiers stand in
//! double quotes. `@n` behind an instruction is its origin.

mod lex;
mod parse;
mod print;

pub use parse::{ParseError, parse_module};
pub use print::{print_function, print_module, print_place};
