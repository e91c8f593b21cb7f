//! Time that has passed, in whole units: never negative, never wrapping.

use crate::Type;

/// How many boundaries of `unit_ns` lie between `since_ns` and `now_ns`, both read as unsigned:
/// what `elapsed` and `step` give. At least 0, at most the signed maximum of `ty`.
pub fn eval_elapsed(now_ns: u64, since_ns: u64, unit_ns: u64, ty: Type) -> u64 {
    let units = (now_ns / unit_ns).saturating_sub(since_ns / unit_ns);
    units.min(ty.mask() >> 1)
}
