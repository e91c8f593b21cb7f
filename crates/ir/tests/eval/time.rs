//! Time that has passed, counted in boundaries of a unit.

use iecc_ir::Type::{I32, I64};
use iecc_ir::eval::eval_elapsed;

#[test]
fn elapsed_counts_boundaries() {
    let table = [
        (0, 0, 1_000_000, I32, 0),
        (999_999, 0, 1_000_000, I32, 0),
        (1_000_000, 999_999, 1_000_000, I32, 1),
        (10_500_000, 500_000, 1_000_000, I32, 10),
        (1_999_999, 1_000_000, 1_000_000, I64, 0),
        // Time that seems to run backwards counts 0.
        (5, 6, 1, I64, 0),
        (0, u64::MAX, 1, I64, 0),
        (3_000_000_000, 0, 1, I32, 0x7fff_ffff),
        (3_000_000_000, 0, 1, I64, 3_000_000_000),
        // Read as unsigned, then bounded by the signed maximum.
        (u64::MAX, 0, 1, I64, i64::MAX as u64),
    ];
    for (now, since, unit, ty, expected) in table {
        assert_eq!(
            eval_elapsed(now, since, unit, ty),
            expected,
            "{now} {since} {unit}"
        );
    }
}
