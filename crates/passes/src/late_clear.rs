//! Clears counters a scan later, off the path from inputs to outputs.
//!
//! `ACC := rung ? a : 0` makes the counter wait for its rung, the longest path there is. But where a
//! flag keeps the rung (`EN := rung`), it can be cleared by the flag in the next scan: what the
//! register holds while EN is 0 does not matter if everybody reads `EN ? register : 0` instead. And
//! since it matters only when the rung was true, `a` may be computed as if the rung were true.
//!
//! Every value that was read from the leaf before is read now as that choice, so nothing else
//! changes; only the leaf itself holds other numbers while its flag is 0. Works on scans in normal
//! form.

use crate::Settings;
use crate::edit::{BlockEditor, hoist_loads};
use crate::scan_form::ScanForm;
use iecc_ir::{BinaryOp, CompareOp, Function, Inst, InstData, Module, Place, Type, Value};
use std::collections::{BTreeMap, HashMap};

/// How far behind the kept value what is known is put in.
const DEPTH: u32 = 8;

/// Runs the pass.
pub(crate) fn run(module: &mut Module, _settings: &Settings) {
    let Some(form) = ScanForm::of(module) else {
        return;
    };
    let scan = module.scan;
    let func = &mut module.funcs[scan];
    hoist_loads(func, form.block);
    let clears = clears(func, &form);
    if !clears.is_empty() {
        apply(func, &form, &clears);
    }
}

/// A leaf whose next value is `condition ? kept : cleared`.
struct Clear {
    place: Place,
    load: Value,
    /// The load of the flag that keeps the condition.
    flag: Value,
    condition: Value,
    kept: Value,
    cleared: u64,
}

fn clears(func: &Function, form: &ScanForm) -> Vec<Clear> {
    let mut keepers: BTreeMap<Value, (Value, u64)> = BTreeMap::new();
    for leaf in form.leaves.iter().filter(|leaf| leaf.ty == Type::I1) {
        if let (Some(load), Some(next)) = (leaf.load, leaf.next) {
            keepers.entry(next).or_insert((load, leaf.init));
        }
    }
    let clear = |leaf: &crate::scan_form::Leaf| {
        let (load, next) = (leaf.load?, leaf.next?);
        let (condition, kept, cleared) = cleared_by(func, next)?;
        let &(flag, flag_init) = keepers.get(&condition)?;
        let starts_cleared = flag_init == 1 || leaf.init == cleared;
        let own = flag == load;
        (starts_cleared && !own).then(|| Clear {
            place: leaf.place.clone(),
            load,
            flag,
            condition,
            kept,
            cleared,
        })
    };
    form.leaves.iter().filter_map(clear).collect()
}

/// `c ? a : constant`, as condition, a and the constant.
fn cleared_by(func: &Function, next: Value) -> Option<(Value, Value, u64)> {
    match func.def_inst(next)? {
        InstData::Select { cond, args } if is_number(func.value_type(next)) => {
            Some((*cond, args[0], func.constant(args[1])?))
        }
        _ => None,
    }
}

/// Bits stay as they are: one of them may be the flag that another leaf is read by.
fn is_number(ty: Type) -> bool {
    ty.is_int() && ty != Type::I1
}

fn apply(func: &mut Function, form: &ScanForm, clears: &[Clear]) {
    let (mut editor, insts) = BlockEditor::new(func, form.block);
    let is_load = |func: &Function, inst: Inst| matches!(func.inst(inst), InstData::Load { .. });
    let loads = insts
        .iter()
        .take_while(|&&inst| is_load(editor.func, inst))
        .count();
    insts[..loads].iter().for_each(|&inst| editor.keep(inst));
    let mut read = HashMap::new();
    for clear in clears {
        let ty = editor.func.value_type(clear.load);
        let cleared = editor.constant(ty, clear.cleared);
        let choice = InstData::Select {
            cond: clear.flag,
            args: [clear.load, cleared],
        };
        read.insert(clear.load, editor.value(choice, ty));
    }
    let by_place: BTreeMap<&Place, &Clear> =
        clears.iter().map(|clear| (&clear.place, clear)).collect();
    for &inst in &insts[loads..] {
        let read_here = |v: Value| read.get(&v).copied().unwrap_or(v);
        if !mask_equality(&mut editor, clears, inst) {
            editor.func.inst_mut(inst).map_values(read_here);
        }
        let stored = match editor.func.inst(inst) {
            InstData::Store { place, .. } => by_place.get(place),
            _ => None,
        };
        if let Some(clear) = stored {
            let value = next(&mut editor, clear, read[&clear.load]);
            let place = clear.place.clone();
            *editor.func.inst_mut(inst) = InstData::Store { place, value };
        }
        editor.keep(inst);
    }
    editor.finish();
}

/// `(flag ? register : cleared) == k` is `flag and register == k` unless k is what it is cleared to.
fn mask_equality(editor: &mut BlockEditor<'_>, clears: &[Clear], inst: Inst) -> bool {
    let InstData::Compare {
        op: CompareOp::Eq,
        args,
    } = *editor.func.inst(inst)
    else {
        return false;
    };
    let Some(k) = editor.func.constant(args[1]) else {
        return false;
    };
    let found = clears
        .iter()
        .find(|clear| clear.load == args[0] && clear.cleared != k);
    let Some(clear) = found else {
        return false;
    };
    let equal = editor.value(
        InstData::Compare {
            op: CompareOp::Eq,
            args,
        },
        Type::I1,
    );
    let masked = InstData::Binary {
        op: BinaryOp::And,
        args: [clear.flag, equal],
    };
    *editor.func.inst_mut(inst) = masked;
    true
}

/// What the leaf holds next: `flag ? kept : kept`, each as if the condition were true, and each with
/// what the flag says about the leaf. The flag stands outside, where it is a register's reset.
fn next(editor: &mut BlockEditor<'_>, clear: &Clear, read: Value) -> Value {
    let ty = editor.func.value_type(clear.load);
    let (no, yes) = (editor.constant(Type::I1, 0), editor.constant(Type::I1, 1));
    let cleared = editor.constant(ty, clear.cleared);
    let arms = [(yes, clear.load), (no, cleared)].map(|(flag, leaf)| {
        let mut known = BTreeMap::from([(clear.condition, yes), (clear.flag, flag), (read, leaf)]);
        rebuild(editor, clear.kept, DEPTH, &mut known)
    });
    editor.value(
        InstData::Select {
            cond: clear.flag,
            args: arms,
        },
        ty,
    )
}

/// `value` with some values replaced, as far as it is followed. `known` grows by what was rebuilt.
fn rebuild(
    editor: &mut BlockEditor<'_>,
    value: Value,
    depth: u32,
    known: &mut BTreeMap<Value, Value>,
) -> Value {
    if let Some(&found) = known.get(&value) {
        return found;
    }
    let data = match editor.func.def_inst(value) {
        Some(
            data @ (InstData::Select { .. }
            | InstData::Unary { .. }
            | InstData::Binary { .. }
            | InstData::Compare { .. }
            | InstData::Convert { .. }),
        ) if depth > 0 => data.clone(),
        _ => return value,
    };
    let operands = data.values();
    let mut new = Vec::with_capacity(operands.len());
    for &operand in &operands {
        new.push(rebuild(editor, operand, depth - 1, known));
    }
    if new[..] == operands[..] {
        return value;
    }
    let mut data = data;
    let mut operands = new.into_iter();
    data.map_values(|_| operands.next().expect("one for each operand"));
    let ty = editor.func.value_type(value);
    let result = editor.value(data, ty);
    known.insert(value, result);
    result
}
