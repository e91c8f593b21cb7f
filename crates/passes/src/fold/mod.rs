//! Folding: what can be computed now is computed now.
//!
//! Three steps, repeated while something changes, up to a bound:
//! * `propagate`: sparse conditional constant propagation (Wegman, Zadeck 1991). Constants are
//!   found through joins and loops, assuming only those jumps that can happen.
//! * `simplify`: algebra on single instructions, in reverse postorder.
//! * `control`: branches on constants, blocks and parameters that are not needed.
//!
//! Numbers are computed by `iecc_ir::eval` alone, so folding cannot disagree with execution.

mod algebra;
mod bits;
mod choice;
mod compare;
mod control;
mod memory;
mod propagate;
mod simplify;

use iecc_ir::eval::{eval_binary, eval_compare, eval_convert, eval_unary};
use iecc_ir::{Function, InstData, Module, Type, TypeTable, Value};
pub(crate) use memory::Regions;

/// Rounds per function. Each makes the function smaller or leaves it; the bound keeps contrived
/// programs from costing quadratic time.
const MAX_ROUNDS: usize = 6;

/// Folds every function.
pub(crate) fn fold(module: &mut Module) {
    let regions = Regions::of(module);
    for func in module.funcs.values_mut() {
        fold_function(&module.types, regions, func);
    }
}

/// Folds one function.
pub(crate) fn fold_function(types: &TypeTable, regions: Regions, func: &mut Function) {
    let mut control = true;
    for _ in 0..MAX_ROUNDS {
        let constants = propagate::propagate(func);
        let algebra = simplify::simplify(types, regions, func);
        if !(constants || algebra || control) {
            break;
        }
        control = control::simplify_control(func);
        if !(constants || algebra || control) {
            break;
        }
    }
}

/// The result of a pure operation whose operands' bits are known.
fn evaluate(func: &Function, data: &InstData, known: impl Fn(Value) -> Option<u64>) -> Option<u64> {
    let ty = |value| func.value_type(value);
    match data {
        InstData::Const { bits, .. } => Some(*bits),
        InstData::Unary { op, arg } => Some(eval_unary(*op, ty(*arg), known(*arg)?)),
        InstData::Binary { op, args: [a, b] } => {
            Some(eval_binary(*op, ty(*a), known(*a)?, known(*b)?))
        }
        InstData::Compare { op, args: [a, b] } => {
            Some(u64::from(eval_compare(*op, ty(*a), known(*a)?, known(*b)?)))
        }
        InstData::Convert { op, to, arg } => Some(eval_convert(*op, ty(*arg), *to, known(*arg)?)),
        InstData::Select { cond, args: [a, b] } => match known(*cond) {
            Some(0) => known(*b),
            Some(_) => known(*a),
            None => known(*a).filter(|&a| known(*b) == Some(a)),
        },
        InstData::Load { .. }
        | InstData::Store { .. }
        | InstData::Copy { .. }
        | InstData::Clear { .. }
        | InstData::Address { .. }
        | InstData::Now
        | InstData::Elapsed { .. }
        | InstData::Step { .. }
        | InstData::Call { .. } => None,
    }
}

/// A constant instruction.
fn constant(ty: Type, bits: u64) -> InstData {
    InstData::Const {
        ty,
        bits: bits & ty.mask(),
    }
}
