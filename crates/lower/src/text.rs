//! Bodies in text: statements and expressions to blocks and values.

use crate::Lowering;
use iecc_ir::Function;
use iecc_sema::hir::{Code, Pou};

/// The function of a unit.
pub(crate) fn unit(_lowering: &mut Lowering<'_>, pou: &Pou, _code: &Code) -> Function {
    unreachable!("{}: no front end makes text yet", pou.name)
}
