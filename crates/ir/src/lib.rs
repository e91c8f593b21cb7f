//! Defines the step language: what a controller computes in one scan.
//!
//! A [`Module`] is a pure step `(state, inputs, now) -> (state', outputs)` or a [`FaultCode`]. It
//! has three memory regions (`state`, `input`, `output`), an image of the initial state, and
//! functions in SSA form; `scan` is the function of one activation.
//!
//! * **Values** are `i1 i8 i16 i32 i64 f32 f64` ([`Type`]); signedness is in the operation.
//!   Structs and arrays exist in memory only.
//! * **Control** is basic blocks with parameters and one [`Terminator`] each. Any graph is legal.
//! * **Memory** is reached through [`Place`]s only: a root plus `.field`, `[index]` and bit
//!   projections. A root is a region, a reference parameter, or a local: memory of one activation of
//!   a function, 0 when it begins. Two places overlap only if one is a prefix of the other, up to
//!   indices. For references that are values there are addresses: byte offsets in the state, which
//!   are checked when they are followed, and behind which anything in the state may lie.
//! * **Every operation is total**; `ops.rs` is the one table that says what each computes, and
//!   [`eval`] computes it, for the interpreter and for passes that fold. A language error is an
//!   explicit branch to `fault`, so no back end decides what an error does. A fault leaves state
//!   and outputs as they were before the scan.
//! * **Time** is the parameter `now`, the same for a whole scan, in nanoseconds since the first.
//!
//! The text form ([`print_module`], [`parse_module`]) holds everything: printing is a fixed point
//! of parsing. [`verify`] lists the rules and is the only way to a [`Verified`]. Nothing here
//! knows a source language, reads files, or runs code.

pub mod analysis;
mod builder;
pub mod eval;
mod fault;
mod function;
mod image;
mod inst;
mod layout;
mod module;
mod ops;
mod place;
mod ssa;
mod text;
mod types;
mod verify;

pub use builder::FunctionBuilder;
pub use fault::FaultCode;
pub use function::{
    Block, BlockData, Function, Inst, Local, LocalData, RefParam, RefParamData, Value, ValueDef,
};
pub use image::{Image, Scalar};
pub use inst::{InstData, Target, Terminator, Values};
pub use layout::{Layout, MAX_LOCAL_BYTES, MAX_REGION_BYTES};
pub use module::{FuncId, Module, Origin, OriginData, Region};
pub use ops::{BinaryOp, CompareOp, ConvertOp, OperandClass, UnaryOp};
pub use place::{Index, Place, PlaceType, Projection, Root};
pub use ssa::{SsaConstruction, Variable};
pub use text::{ParseError, parse_module, print_function, print_module, print_place};
pub use types::{
    ArrayId, ArrayType, FieldDef, MemType, StructDef, StructId, Type, TypeTable, View,
};
pub use verify::{Verified, VerifyError, verify};
