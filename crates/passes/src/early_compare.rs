//! Takes comparisons of counters off the path from inputs to outputs.
//!
//! `x == k`, where x is a counter that this scan may have advanced, costs an adder and a wide
//! comparison behind the rung that enables it. But x is chosen among few things: the register, the
//! register plus a constant, constants. So the comparison moves to the choices: `c ? r + 1 : r`
//! equals k if `c ? r == k - 1 : r == k`. What remains are comparisons of registers with
//! constants; each is kept as a register of its own, one bit, whose next value is found the same
//! way. A flag beside the register that says the same (DN for ACC == PRE) is used instead.
//!
//! Works on scans in normal form; costs one bit and a comparison of the register per constant.

use crate::Settings;
use crate::edit::{BlockEditor, hoist_loads, replace_values};
use crate::range::Analysis;
use crate::scan_form::{ScanForm, add_state_leaf};
use iecc_ir::{BinaryOp, CompareOp, ConvertOp, Function, InstData, Module, Place, Type, Value};
use std::collections::{BTreeMap, HashMap};

/// How many choices deep a comparison is moved.
const DEPTH: u32 = 12;
/// Narrower registers are compared in one logic cell anyway.
const MIN_BITS: u32 = 5;

/// Runs the pass.
pub(crate) fn run(module: &mut Module, settings: &Settings) {
    let Some(form) = ScanForm::of(module) else {
        return;
    };
    let scan = module.scan;
    hoist_loads(&mut module.funcs[scan], form.block);
    let plan = Plan::of(module, settings);
    if plan.moved.is_empty() {
        return;
    }
    let registers: BTreeMap<(usize, i64), (Place, Value)> = plan
        .early
        .keys()
        .map(|&(leaf, k)| ((leaf, k), new_register(module, &form, leaf, k)))
        .collect();
    apply(&mut module.funcs[scan], &form, &plan, &registers);
}

/// A comparison with a constant, moved to the choices of its operand.
#[derive(Debug, Clone)]
enum Moved {
    Known(bool),
    /// A value or its opposite.
    Flag(Value, bool),
    /// Register `leaf == k` at the start of the scan.
    Register(usize, i64),
    Choice(Value, Box<Moved>, Box<Moved>),
}

/// What the pass will do.
struct Plan {
    /// Comparisons to replace, and by what; `true` for `==`.
    moved: BTreeMap<Value, (bool, Moved)>,
    /// Register comparisons that get a bit of their own, and its next value.
    early: BTreeMap<(usize, i64), Moved>,
}

impl Plan {
    fn of(module: &Module, settings: &Settings) -> Self {
        let mut plan = Self {
            moved: BTreeMap::new(),
            early: BTreeMap::new(),
        };
        let max_step = |unit_ns| settings.max_step(unit_ns);
        let Some(analysis) = Analysis::of(module, &max_step) else {
            return plan;
        };
        let func = &module.funcs[module.scan];
        for &inst in &func.block(func.entry()).insts {
            let InstData::Compare {
                op: op @ (CompareOp::Eq | CompareOp::Ne),
                args,
            } = func.inst(inst)
            else {
                continue;
            };
            let ty = func.value_type(args[0]);
            let Some(k) = func.constant(args[1]).filter(|_| ty != Type::I1) else {
                continue;
            };
            if analysis.leaf_of(args[0]).is_some() || analysis.base(args[0]).bits() < MIN_BITS {
                continue;
            }
            if let Some(moved) = moved(&analysis, func, args[0], ty.signed(k), DEPTH) {
                plan.add(
                    &analysis,
                    func,
                    func.result(inst),
                    *op == CompareOp::Eq,
                    moved,
                );
            }
        }
        plan
    }

    fn add(
        &mut self,
        analysis: &Analysis<'_>,
        func: &Function,
        value: Value,
        equal: bool,
        moved: Moved,
    ) {
        for (leaf, k) in registers_of(&moved) {
            let Some(next) = analysis.form().leaves[leaf].next else {
                return;
            };
            let Some(next) = self::moved(analysis, func, next, k, DEPTH) else {
                return;
            };
            self.early.insert((leaf, k), next);
        }
        self.moved.insert(value, (equal, moved));
    }
}

/// `value == k` in terms of registers; `None` if the value is no choice of registers plus
/// constants.
fn moved(
    analysis: &Analysis<'_>,
    func: &Function,
    value: Value,
    k: i64,
    depth: u32,
) -> Option<Moved> {
    if !analysis.base(value).contains(k) {
        return Some(Moved::Known(false));
    }
    if let Some(only) = analysis.base(value).as_constant() {
        return Some(Moved::Known(only == k));
    }
    if let Some(leaf) = analysis.leaf_of(value) {
        let flag = analysis.flag_that_decides(CompareOp::Eq, value, k);
        return Some(flag.map_or(Moved::Register(leaf, k), |(flag, same)| {
            Moved::Flag(flag, same)
        }));
    }
    if depth == 0 {
        return None;
    }
    match func.def_inst(value)? {
        InstData::Select { cond, args } => {
            let yes = moved(analysis, func, args[0], k, depth - 1)?;
            let no = moved(analysis, func, args[1], k, depth - 1)?;
            Some(Moved::Choice(*cond, Box::new(yes), Box::new(no)))
        }
        InstData::Binary {
            op: BinaryOp::Add,
            args,
        } => moved_sum(analysis, func, value, *args, k, depth - 1),
        InstData::Convert {
            op: ConvertOp::Zext | ConvertOp::Sext,
            arg,
            ..
        } if func.value_type(*arg) != Type::I1 && analysis.base(*arg).lo >= 0 => {
            moved(analysis, func, *arg, k, depth - 1)
        }
        InstData::Convert {
            op: ConvertOp::Trunc,
            arg,
            ..
        } if analysis.base(*arg) == analysis.base(value) => {
            moved(analysis, func, *arg, k, depth - 1)
        }
        _ => None,
    }
}

/// `x + d == k` for constant d, or for d that is 0 or 1: then it chooses between two sums.
fn moved_sum(
    analysis: &Analysis<'_>,
    func: &Function,
    sum: Value,
    args: [Value; 2],
    k: i64,
    depth: u32,
) -> Option<Moved> {
    let exact = |x: Value, d: Value| {
        let (x, d) = (analysis.base(x), analysis.base(d));
        let whole = iecc_ir::analysis::Range::of_type(func.value_type(sum));
        let fits = |a: i64, b: i64| a.checked_add(b).is_some_and(|s| whole.contains(s));
        fits(x.lo, d.lo) && fits(x.hi, d.hi)
    };
    for (x, d) in [(args[0], args[1]), (args[1], args[0])] {
        if !exact(x, d) {
            continue;
        }
        if let Some(d) = analysis.base(d).as_constant() {
            return moved(analysis, func, x, k.checked_sub(d)?, depth);
        }
        if let Some(bit) = as_bit(func, d) {
            let yes = moved(analysis, func, x, k.checked_sub(1)?, depth)?;
            let no = moved(analysis, func, x, k, depth)?;
            return Some(Moved::Choice(bit, Box::new(yes), Box::new(no)));
        }
        if is_bit_step(analysis, func, d) {
            let yes = moved(analysis, func, x, k.checked_sub(1)?, depth)?;
            let no = moved(analysis, func, x, k, depth)?;
            return Some(Moved::Choice(d, Box::new(yes), Box::new(no)));
        }
    }
    None
}

/// The `i1` that a value extends.
fn as_bit(func: &Function, value: Value) -> Option<Value> {
    match func.def_inst(value)? {
        InstData::Convert {
            op: ConvertOp::Zext,
            arg,
            ..
        } if func.value_type(*arg) == Type::I1 => Some(*arg),
        _ => None,
    }
}

/// A number that can only be 0 or 1; as a condition it is tested against 0.
fn is_bit_step(analysis: &Analysis<'_>, func: &Function, value: Value) -> bool {
    func.value_type(value) != Type::I1
        && analysis.base(value) == iecc_ir::analysis::Range::new(0, 1)
}

fn registers_of(moved: &Moved) -> Vec<(usize, i64)> {
    let (mut found, mut stack) = (Vec::new(), vec![moved]);
    while let Some(moved) = stack.pop() {
        match moved {
            Moved::Known(_) | Moved::Flag(..) => {}
            Moved::Register(leaf, k) => found.push((*leaf, *k)),
            Moved::Choice(_, yes, no) => stack.extend([&**yes, &**no]),
        }
    }
    found
}

/// Adds the bit `leaf == k` to the state, with its initial value and a load at the start.
fn new_register(module: &mut Module, form: &ScanForm, leaf: usize, k: i64) -> (Place, Value) {
    let leaf = &form.leaves[leaf];
    let name = format!("{}_is_{k}", leaf_name(module, &leaf.place));
    let init = u64::from(leaf.ty.signed(leaf.init) == k);
    let place = add_state_leaf(module, &name, Type::I1, init);
    let scan = module.scan;
    let func = &mut module.funcs[scan];
    let load = func.make_inst(
        InstData::Load {
            place: place.clone(),
        },
        &[Type::I1],
        None,
    );
    func.block_mut(form.block).insts.insert(0, load);
    let value = func.result(load);
    (place, value)
}

fn leaf_name(module: &Module, place: &Place) -> String {
    let func = &module.funcs[module.scan];
    let text = iecc_ir::print_place(module, func, place);
    text.trim_start_matches("state.").replace('"', "")
}

type Registers = BTreeMap<(usize, i64), (Place, Value)>;

fn apply(func: &mut Function, form: &ScanForm, plan: &Plan, registers: &Registers) {
    let (mut editor, insts) = BlockEditor::new(func, form.block);
    let mut same = HashMap::new();
    for inst in insts {
        let result = editor.func.results_of(inst).first().copied();
        let Some((value, (equal, moved))) = result.and_then(|v| Some((v, plan.moved.get(&v)?)))
        else {
            editor.keep(inst);
            continue;
        };
        editor.set_origin(editor.func.origin(inst));
        let bit = emit(&mut editor, form, moved, registers);
        same.insert(value, if *equal { bit } else { editor.not(bit) });
    }
    editor.set_origin(None);
    for (key, next) in &plan.early {
        let value = emit(&mut editor, form, next, registers);
        editor.effect(InstData::Store {
            place: registers[key].0.clone(),
            value,
        });
    }
    editor.finish();
    replace_values(func, &same);
}

/// Builds a moved comparison. A register comparison without a bit of its own is computed.
fn emit(
    editor: &mut BlockEditor<'_>,
    form: &ScanForm,
    moved: &Moved,
    registers: &Registers,
) -> Value {
    match moved {
        Moved::Known(bit) => editor.constant(Type::I1, u64::from(*bit)),
        Moved::Flag(flag, true) => *flag,
        Moved::Flag(flag, false) => editor.not(*flag),
        Moved::Register(leaf, k) => match registers.get(&(*leaf, *k)) {
            Some((_, bit)) => *bit,
            None => {
                let load = form.leaves[*leaf].load.expect("compared leaves are loaded");
                editor.compare_constant(CompareOp::Eq, load, *k)
            }
        },
        Moved::Choice(cond, yes, no) => {
            let yes = emit(editor, form, yes, registers);
            let no = emit(editor, form, no, registers);
            let cond = as_condition(editor, *cond);
            editor.select_bit(cond, yes, no)
        }
    }
}

fn as_condition(editor: &mut BlockEditor<'_>, cond: Value) -> Value {
    match editor.func.value_type(cond) {
        Type::I1 => cond,
        _ => editor.compare_constant(CompareOp::Ne, cond, 0),
    }
}
