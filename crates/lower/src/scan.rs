//! The functions of the whole program: `scan`, one activation of the task, and `prescan`.

use crate::ladder::copy;
use crate::tasks::{self, TaskState};
use crate::types::{place, result_types, scalar};
use crate::{Lowering, MILLISECOND_NS};
use iecc_ir::{FuncId, Function, FunctionBuilder, Place, Root, Type};
use iecc_sema::hir::{self, Action, Body, Instruction, Op, Pou, PouId, Prescan};

/// Inputs to state words, the main routines in order, state words to outputs.
pub(crate) fn scan(lowering: &mut Lowering<'_>, hidden: &TaskState) -> Function {
    let program = lowering.program;
    let mut builder = FunctionBuilder::new(lowering.fresh_function("scan"), &[], &[]);
    let origin = lowering.origin("inputs", None);
    builder.set_origin(Some(origin));
    for (index, point) in program.inputs.iter().enumerate() {
        let public = Place::root(Root::Input).field(index as u32);
        move_point(program, &mut builder, point, public, place(&point.place));
    }
    tasks::run(lowering, hidden, &mut builder);
    if let Some(first_scan) = &program.first_scan {
        let zero = builder.constant(Type::I1, 0);
        builder.store(place(first_scan), zero);
    }
    let origin = lowering.origin("outputs", None);
    builder.set_origin(Some(origin));
    for (index, point) in program.outputs.iter().enumerate() {
        let public = Place::root(Root::Output).field(index as u32);
        move_point(program, &mut builder, point, place(&point.place), public);
    }
    builder.ret(Vec::new());
    builder.finish()
}

fn move_point(
    program: &hir::Program,
    builder: &mut FunctionBuilder,
    point: &hir::IoPoint,
    from: Place,
    to: Place,
) {
    match program.type_of(&point.place) {
        hir::Type::Elementary(ty) => copy(builder, from, to, scalar(ty)),
        hir::Type::Struct(_) | hir::Type::Array(_) => builder.copy(to, from),
    }
}

/// What a main routine gives back goes nowhere.
pub(crate) fn call_main(program: &hir::Program, builder: &mut FunctionBuilder, main: PouId) {
    let types = result_types(program.pou(main));
    let func = FuncId::from_u32(main.index() as u32);
    builder.call(func, Vec::new(), Vec::new(), &types);
}

/// Walks every routine that runs once, in the order of calls, and does what the instruction table
/// says of prescan. Calls are followed on an explicit stack, because the user decides their depth.
pub(crate) fn prescan(lowering: &mut Lowering<'_>) -> Function {
    let program = lowering.program;
    let mut builder = FunctionBuilder::new(lowering.fresh_function("prescan"), &[], &[]);
    let mut seen = vec![false; program.pous.len()];
    for main in program.tasks.iter().flat_map(|task| &task.calls) {
        let mut stack = Vec::new();
        if !std::mem::replace(&mut seen[main.index()], true) {
            stack.push(instructions(program.pou(*main)).into_iter());
        }
        while let Some(rest) = stack.last_mut() {
            let Some((label, instruction)) = rest.next() else {
                stack.pop();
                continue;
            };
            effects(lowering, &mut builder, &label, instruction);
            if let Op::Action(Action::Call { pou, .. }) = &instruction.op
                && !std::mem::replace(&mut seen[pou.index()], true)
            {
                stack.push(instructions(program.pou(*pou)).into_iter());
            }
        }
    }
    builder.ret(Vec::new());
    builder.finish()
}

/// The instructions of a unit in order, each with the label of its rung.
fn instructions(pou: &Pou) -> Vec<(String, &Instruction)> {
    let mut found = Vec::new();
    match &pou.body {
        Body::Ladder(rungs) => {
            for rung in rungs {
                let label = format!("{} rung {}", pou.name, rung.number);
                rung.for_each_instruction(&mut |instruction| {
                    found.push((label.clone(), instruction));
                });
            }
        }
        Body::Text(_) => {}
    }
    found
}

fn effects(
    lowering: &mut Lowering<'_>,
    builder: &mut FunctionBuilder,
    label: &str,
    instruction: &Instruction,
) {
    for (target, effect) in &instruction.prescan {
        let origin = lowering.origin(label, Some(instruction.span));
        builder.set_origin(Some(origin));
        match effect {
            Prescan::Clear | Prescan::Set => {
                let bit = builder.constant(Type::I1, u64::from(*effect == Prescan::Set));
                builder.store(place(target), bit);
            }
            Prescan::Timer(kind) => {
                let func = lowering.stdlib_function(kind.prescan_function(), MILLISECOND_NS);
                builder.call(func, vec![place(target)], Vec::new(), &[]);
            }
            Prescan::Counter(kind) => {
                let func = lowering.stdlib_function(kind.prescan_function(), MILLISECOND_NS);
                builder.call(func, vec![place(target)], Vec::new(), &[]);
            }
        }
    }
}
