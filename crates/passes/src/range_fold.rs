//! Uses ranges to decide and to weaken comparisons.
//!
//! * What can only be one number becomes that constant.
//! * `x >= k`, where x is never above k, becomes `x == k`; so at every edge of a range.
//! * What a bit can only be when another bit lets it through is put there: a timer's `EN or not DN`
//!   is 1, because DN without EN does not happen.
//! * A comparison of a state leaf that a flag beside it decides becomes that flag: a timer's
//!   `ACC == PRE` is its DN.
//!
//! Works on scans in normal form; `step` is bounded by the settings.

use crate::Settings;
use crate::edit::{BlockEditor, hoist_loads, replace_values};
use crate::range::Analysis;
use crate::scan_form::ScanForm;
use iecc_ir::analysis::Range;
use iecc_ir::{BinaryOp, CompareOp, Function, InstData, Module, Root, Type, UnaryOp, Value};
use std::collections::HashMap;

/// Runs the pass.
pub(crate) fn run(module: &mut Module, settings: &Settings) {
    let Some(form) = ScanForm::of(module) else {
        return;
    };
    let scan = module.scan;
    hoist_loads(&mut module.funcs[scan], form.block);
    let replacements = plan(module, settings);
    apply(&mut module.funcs[scan], &form, &replacements);
}

/// What a value is replaced by.
enum Replacement {
    Constant(u64),
    /// The flag, or its opposite.
    Flag(Value, bool),
    Compare(CompareOp, Value, i64),
    /// A choice with arms that are constant when they are chosen.
    Select(Value, [Arm; 2]),
}

/// An arm of a select.
#[derive(Clone, Copy)]
enum Arm {
    Value(Value),
    Bit(bool),
}

fn plan(module: &Module, settings: &Settings) -> HashMap<Value, Replacement> {
    let max_step = |unit_ns| settings.max_step(unit_ns);
    let Some(analysis) = Analysis::of(module, &max_step) else {
        return HashMap::new();
    };
    let func = &module.funcs[module.scan];
    let values =
        func.block(func.entry())
            .insts
            .iter()
            .filter_map(|&inst| match func.results_of(inst) {
                [value] => Some(*value),
                _ => None,
            });
    values
        .filter_map(|value| Some((value, replacement(&analysis, func, value)?)))
        .collect()
}

fn replacement(analysis: &Analysis<'_>, func: &Function, value: Value) -> Option<Replacement> {
    let ty = func.value_type(value);
    let inst = func.def_inst(value)?;
    let is_input = matches!(inst, InstData::Load { place } if place.root != Root::State);
    if ty.is_float() || is_input || matches!(inst, InstData::Const { .. }) {
        return None;
    }
    if let Some(k) = analysis.base(value).as_constant() {
        return Some(Replacement::Constant(k as u64 & ty.mask()));
    }
    if ty == Type::I1
        && let Some(found) = gate(analysis, value, inst)
    {
        return Some(found);
    }
    let InstData::Compare { op, args } = inst else {
        return None;
    };
    if func.value_type(args[0]).is_float() {
        return None;
    }
    let (op, x, k) = against_constant(analysis, func, *op, *args)?;
    if let Some((flag, value)) = analysis.flag_that_decides(op, x, k) {
        return Some(Replacement::Flag(flag, value));
    }
    let (op, k) = at_edge(op, analysis.base(x), k)?;
    Some(Replacement::Compare(op, x, k))
}

/// What operands say about each other.
fn gate(analysis: &Analysis<'_>, value: Value, inst: &InstData) -> Option<Replacement> {
    match inst {
        InstData::Binary {
            op: op @ (BinaryOp::And | BinaryOp::Or),
            args,
        } => {
            // An operand that lets the other through decides nothing itself.
            let neutral = *op == BinaryOp::And;
            for bit in [false, true] {
                if analysis.is_never(value, !bit) {
                    return Some(Replacement::Constant(u64::from(bit)));
                }
            }
            [(args[0], args[1]), (args[1], args[0])]
                .into_iter()
                .find_map(|(a, b)| {
                    let passes = analysis.bit_when(a, neutral, b)? == neutral;
                    passes.then_some(Replacement::Flag(a, true))
                })
        }
        InstData::Select { cond, args } => {
            let arm = |value, is| match analysis.bit_when(*cond, is, value) {
                Some(bit) => Arm::Bit(bit),
                None => Arm::Value(value),
            };
            let arms = [arm(args[0], true), arm(args[1], false)];
            let learned = arms.iter().any(|arm| matches!(arm, Arm::Bit(_)));
            learned.then_some(Replacement::Select(*cond, arms))
        }
        _ => None,
    }
}

/// The comparison as `x op k`, signed where that is the same.
fn against_constant(
    analysis: &Analysis<'_>,
    func: &Function,
    op: CompareOp,
    [a, b]: [Value; 2],
) -> Option<(CompareOp, Value, i64)> {
    if func.value_type(a) == Type::I1 {
        return None;
    }
    let (op, x, k) = match (
        analysis.base(a).as_constant(),
        analysis.base(b).as_constant(),
    ) {
        (None, Some(k)) => (op, a, k),
        (Some(k), None) => (op.swapped(), b, k),
        _ => return None,
    };
    let signed = match op {
        CompareOp::Ult => CompareOp::Slt,
        CompareOp::Ule => CompareOp::Sle,
        CompareOp::Ugt => CompareOp::Sgt,
        CompareOp::Uge => CompareOp::Sge,
        op => return Some((op, x, k)),
    };
    let same = k >= 0 && analysis.base(x).lo >= 0;
    same.then_some((signed, x, k))
}

/// The equality that `x op k` is for x in this range, if it cuts off one number only.
fn at_edge(op: CompareOp, x: Range, k: i64) -> Option<(CompareOp, i64)> {
    // The smallest number for which `>=` holds, or the largest for which `<=` holds.
    let (upwards, from) = match op {
        CompareOp::Sge => (true, k),
        CompareOp::Sgt => (true, k.checked_add(1)?),
        CompareOp::Sle => (false, k),
        CompareOp::Slt => (false, k.checked_sub(1)?),
        _ => return None,
    };
    match upwards {
        true if from == x.hi => Some((CompareOp::Eq, x.hi)),
        true if from == x.lo.checked_add(1)? => Some((CompareOp::Ne, x.lo)),
        false if from == x.lo => Some((CompareOp::Eq, x.lo)),
        false if from == x.hi.checked_sub(1)? => Some((CompareOp::Ne, x.hi)),
        _ => None,
    }
}

fn apply(func: &mut Function, form: &ScanForm, replacements: &HashMap<Value, Replacement>) {
    let (mut editor, insts) = BlockEditor::new(func, form.block);
    let mut same = HashMap::new();
    for inst in insts {
        let result = editor.func.results_of(inst).first().copied();
        let Some((value, replacement)) = result.and_then(|v| Some((v, replacements.get(&v)?)))
        else {
            editor.keep(inst);
            continue;
        };
        editor.set_origin(editor.func.origin(inst));
        let ty = editor.func.value_type(value);
        let data = match *replacement {
            Replacement::Constant(bits) => InstData::Const { ty, bits },
            Replacement::Flag(flag, true) => {
                same.insert(value, flag);
                continue;
            }
            Replacement::Flag(flag, false) => InstData::Unary {
                op: UnaryOp::Not,
                arg: flag,
            },
            Replacement::Select(cond, arms) => {
                let args = arms.map(|arm| match arm {
                    Arm::Value(value) => value,
                    Arm::Bit(bit) => editor.constant(Type::I1, u64::from(bit)),
                });
                InstData::Select { cond, args }
            }
            Replacement::Compare(op, x, k) => {
                let k = editor.constant(editor.func.value_type(x), k as u64);
                InstData::Compare { op, args: [x, k] }
            }
        };
        *editor.func.inst_mut(inst) = data;
        editor.keep(inst);
    }
    editor.finish();
    replace_values(func, &same);
}
