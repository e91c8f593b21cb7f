//! Which bits a NaN may have in machine code.
//!
//! The step language knows one NaN as the result of arithmetic, a processor several. Nobody can tell
//! them apart before their bits are seen, so machine code computes with any of them, and makes the
//! right one of it only where bits leave: in memory, in `float_bits`, at calls and returns. What is
//! loaded or made of an integer's bits keeps them, whatever NaN it is.

use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::Cfg;
use iecc_ir::eval::canonical_nan;
use iecc_ir::{Block, ConvertOp, Function, InstData, Type, Value};

/// What is known about the bits of a float in machine code.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum NanBits {
    /// They are what the step language says: it is no NaN, or the canonical one.
    #[default]
    Canonical,
    /// Any NaN stands for the canonical one.
    Free,
    /// They are what the step language says, and any NaN is possible.
    Fixed,
}

/// By value; integers are canonical.
pub(crate) type NanClasses = SecondaryMap<Value, NanBits>;

/// Classifies the floats of a function. A parameter of a block is what all of its arguments can be.
pub(crate) fn classify(func: &Function, cfg: &Cfg) -> NanClasses {
    let mut classes = NanClasses::new();
    let entry_params = &func.block(func.entry()).params;
    for &param in entry_params.iter().filter(|&&v| is_float(func, v)) {
        classes[param] = NanBits::Fixed;
    }
    let mut changed = true;
    while changed {
        changed = false;
        for &block in cfg.reverse_postorder() {
            results(func, block, &mut classes);
            changed |= arguments(func, block, &mut classes);
        }
    }
    classes
}

fn is_float(func: &Function, value: Value) -> bool {
    func.value_type(value).is_float()
}

fn results(func: &Function, block: Block, classes: &mut NanClasses) {
    for &inst in &func.block(block).insts {
        for &result in func.results_of(inst) {
            if is_float(func, result) {
                classes[result] = of_result(func.inst(inst), classes);
            }
        }
    }
}

/// Passes the classes of arguments on to parameters; whether that changed one.
fn arguments(func: &Function, block: Block, classes: &mut NanClasses) -> bool {
    let mut changed = false;
    for target in func.terminator(block).targets() {
        let params = &func.block(target.block).params;
        for (&param, &arg) in params.iter().zip(&target.args) {
            let joined = classes[param].max(classes[arg]);
            changed |= joined != classes[param];
            if joined != classes[param] {
                classes[param] = joined;
            }
        }
    }
    changed
}

fn of_result(data: &InstData, classes: &NanClasses) -> NanBits {
    match data {
        InstData::Const { ty, bits } if is_other_nan(*ty, *bits) => NanBits::Fixed,
        InstData::Const { .. } => NanBits::Canonical,
        InstData::Unary { .. } | InstData::Binary { .. } => NanBits::Free,
        InstData::Select { args, .. } => classes[args[0]].max(classes[args[1]]),
        InstData::Convert { op, .. } => match op {
            ConvertOp::Promote | ConvertOp::Demote => NanBits::Free,
            ConvertOp::SintToFloat | ConvertOp::UintToFloat => NanBits::Canonical,
            ConvertOp::BitsFloat => NanBits::Fixed,
            ConvertOp::Trunc
            | ConvertOp::Zext
            | ConvertOp::Sext
            | ConvertOp::FloatToSint
            | ConvertOp::FloatToUint
            | ConvertOp::FloatBits => panic!("the result is no float"),
        },
        InstData::Load { .. } | InstData::Call { .. } => NanBits::Fixed,
        InstData::Compare { .. }
        | InstData::Store { .. }
        | InstData::Copy { .. }
        | InstData::Clear { .. }
        | InstData::Address { .. }
        | InstData::Now
        | InstData::Elapsed { .. }
        | InstData::Step { .. } => panic!("the result is no float"),
    }
}

fn is_other_nan(ty: Type, bits: u64) -> bool {
    let is_nan = match ty {
        Type::F32 => f32::from_bits(bits as u32).is_nan(),
        Type::F64 => f64::from_bits(bits).is_nan(),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => return false,
    };
    is_nan && bits != canonical_nan(ty)
}
