//! Tasks: what a scan runs, and in which order.
//!
//! Every task has at most one turn in a scan, in the order of priority, then of declaration; so a
//! scan ends, without a loop. At its turn a task that is ready runs to its end.
//!
//! * `EveryScan` is always ready.
//! * An interval makes ready in the first scan, and then whenever as much time has passed again,
//!   unless SINGLE is TRUE at the start of the scan. Releases that were missed are not made up for, only
//!   counted as overruns.
//! * A rising edge of SINGLE makes ready. Edges are looked for at the start of a scan and behind each
//!   task. One that is found when the task has had its turn waits for the next scan, with its kind
//!   counted as overruns while it waits.
//!
//! What tasks need to know lies in hidden fields of the state: `__scan` holds the time of the last
//! scan, `__task.name` that of one task. Time is accumulated from what has elapsed, so that hardware can
//! keep it in as few bits as an interval needs.

use crate::scan::call_main;
use crate::types::{TypeMap, place};
use crate::{Lowering, fresh};
use iecc_ir::{
    BinaryOp, CompareOp, FieldDef, FuncId, FunctionBuilder, MemType, Place, Root, StructId, Type,
    UnaryOp, Value, View,
};
use iecc_sema::hir::{self, Program, Task, Trigger};

/// Fields of `__scan`.
const LAST: u32 = 0;
const STARTED: u32 = 1;
/// Fields of `__task.name`.
const SINCE: u32 = 0;
const SINGLE: u32 = 1;
const READY: u32 = 2;
const OVERRUNS: u32 = 3;

/// Where the hidden fields of tasks are.
pub(crate) struct TaskState {
    /// `__scan`, if a task has an interval.
    scan: Option<u32>,
    /// Of each task, if it is not run in every scan.
    tasks: Vec<Option<u32>>,
}

/// Adds the hidden fields of tasks to those of the state.
pub(crate) fn add_state(
    program: &Program,
    types: &mut TypeMap<'_>,
    state: &mut Vec<FieldDef>,
) -> TaskState {
    let mut hidden = TaskState {
        scan: None,
        tasks: Vec::with_capacity(program.tasks.len()),
    };
    let mut add = |name: &str, ty: StructId| {
        let taken = |name: &str| state.iter().any(|field| field.name == name);
        let name = fresh(name, taken);
        state.push(FieldDef::new(name, MemType::Struct(ty)));
        state.len() as u32 - 1
    };
    if program.tasks.iter().any(|task| interval(task).is_some()) {
        let fields = [leaf("last", Type::I64, View::Time), bit("started")];
        let ty = types.hidden("__scan", fields.to_vec());
        hidden.scan = Some(add("__scan", ty));
    }
    let mut shared = None;
    for task in &program.tasks {
        let field = match task.trigger {
            Trigger::EveryScan => None,
            Trigger::Timed { .. } => {
                let ty = *shared.get_or_insert_with(|| task_struct(types));
                Some(add(&format!("__task.{}", task.name), ty))
            }
        };
        hidden.tasks.push(field);
    }
    hidden
}

fn task_struct(types: &mut TypeMap<'_>) -> StructId {
    let fields = vec![
        leaf("since", Type::I64, View::Time),
        bit("single"),
        bit("ready"),
        leaf("overruns", Type::I32, View::Unsigned),
    ];
    types.hidden("__task", fields)
}

fn leaf(name: &str, ty: Type, view: View) -> FieldDef {
    FieldDef::new(name, MemType::Scalar(ty)).with_view(view)
}

fn bit(name: &str) -> FieldDef {
    leaf(name, Type::I1, View::Plain)
}

/// Names under which people see overruns.
pub(crate) fn names(program: &Program, hidden: &TaskState) -> Vec<(String, Place)> {
    let tasks = program.tasks.iter().zip(&hidden.tasks);
    let named = tasks.filter_map(|(task, field)| {
        let overruns = at((*field)?, OVERRUNS);
        Some((format!("{}.overruns", task.name), overruns))
    });
    named.collect()
}

/// Runs the tasks of one scan.
pub(crate) fn run(lowering: &mut Lowering<'_>, hidden: &TaskState, builder: &mut FunctionBuilder) {
    let program = lowering.program;
    let events = events(lowering, hidden);
    let look = |builder: &mut FunctionBuilder| {
        if let Some(events) = events {
            builder.call(events, Vec::new(), Vec::new(), &[]);
        }
    };
    look(builder);
    if let Some(scan) = hidden.scan {
        release(lowering, hidden, scan, builder);
    }
    let mut order: Vec<usize> = (0..program.tasks.len()).collect();
    order.sort_by_key(|&task| program.tasks[task].priority);
    for index in order {
        let task = &program.tasks[index];
        let origin = lowering.origin(&task.name, None);
        builder.set_origin(Some(origin));
        match hidden.tasks[index] {
            None => {
                call_all(program, task, builder);
                look(builder);
            }
            Some(field) => {
                let ready = builder.load(at(field, READY), Type::I1);
                when(builder, ready, |builder| {
                    store_bit(builder, at(field, READY), false);
                    call_all(program, task, builder);
                    look(builder);
                });
            }
        }
    }
}

fn call_all(program: &Program, task: &Task, builder: &mut FunctionBuilder) {
    for &main in &task.calls {
        call_main(program, builder, main);
    }
}

/// A hidden leaf.
fn at(field: u32, leaf: u32) -> Place {
    Place::root(Root::State).field(field).field(leaf)
}

fn store_bit(builder: &mut FunctionBuilder, place: Place, value: bool) {
    let value = builder.constant(Type::I1, u64::from(value));
    builder.store(place, value);
}

fn when(builder: &mut FunctionBuilder, condition: Value, build: impl FnOnce(&mut FunctionBuilder)) {
    let (then, behind) = (builder.create_block(), builder.create_block());
    builder.brif(condition, then, behind);
    builder.seal(then);
    builder.switch_to(then);
    build(builder);
    builder.jump(behind);
    builder.seal(behind);
    builder.switch_to(behind);
}

fn interval(task: &Task) -> Option<u64> {
    match task.trigger {
        Trigger::Timed { interval_ns, .. } => (interval_ns > 0).then_some(interval_ns),
        Trigger::EveryScan => None,
    }
}

fn single(task: &Task) -> Option<&hir::Place> {
    match &task.trigger {
        Trigger::Timed { single, .. } => single.as_ref(),
        Trigger::EveryScan => None,
    }
}

/// The function that looks for rising edges, if there is a task that waits for one.
fn events(lowering: &mut Lowering<'_>, hidden: &TaskState) -> Option<FuncId> {
    let program = lowering.program;
    program.tasks.iter().find_map(single)?;
    let mut builder = FunctionBuilder::new(lowering.fresh_function("tasks.events"), &[], &[]);
    for (task, field) in program.tasks.iter().zip(&hidden.tasks) {
        if let (Some(single), &Some(field)) = (single(task), field) {
            let origin = lowering.origin(&task.name, None);
            builder.set_origin(Some(origin));
            event(&mut builder, single, field);
        }
    }
    builder.ret(Vec::new());
    Some(lowering.funcs.push(builder.finish()))
}

fn event(builder: &mut FunctionBuilder, single: &hir::Place, field: u32) {
    let now = builder.load(place(single), Type::I1);
    let before = builder.load(at(field, SINGLE), Type::I1);
    let fresh = builder.unary(UnaryOp::Not, before);
    let edge = builder.binary(BinaryOp::And, now, fresh);
    builder.store(at(field, SINGLE), now);
    let waiting = builder.load(at(field, READY), Type::I1);
    let ready = builder.binary(BinaryOp::Or, waiting, edge);
    builder.store(at(field, READY), ready);
    let lost = builder.binary(BinaryOp::And, waiting, edge);
    when(builder, lost, |builder| {
        let one = builder.constant(Type::I32, 1);
        overrun(builder, field, one);
    });
}

fn overrun(builder: &mut FunctionBuilder, field: u32, more: Value) {
    let overruns = builder.load(at(field, OVERRUNS), Type::I32);
    let sum = builder.binary(BinaryOp::Add, overruns, more);
    builder.store(at(field, OVERRUNS), sum);
}

/// Makes ready whose time has come.
fn release(
    lowering: &mut Lowering<'_>,
    hidden: &TaskState,
    scan: u32,
    builder: &mut FunctionBuilder,
) {
    let elapsed = builder.elapsed(at(scan, LAST), 1, Type::I64);
    let started = builder.load(at(scan, STARTED), Type::I1);
    store_bit(builder, at(scan, STARTED), true);
    for (task, field) in lowering.program.tasks.iter().zip(&hidden.tasks) {
        if let (Some(interval_ns), &Some(field)) = (interval(task), field) {
            let origin = lowering.origin(&task.name, None);
            builder.set_origin(Some(origin));
            let interval = builder.constant(Type::I64, interval_ns);
            let since = builder.load(at(field, SINCE), Type::I64);
            let sum = builder.binary(BinaryOp::Add, since, elapsed);
            let since = builder.select(started, sum, interval);
            builder.store(at(field, SINCE), since);
            let due = builder.compare(CompareOp::Uge, since, interval);
            when(builder, due, |builder| {
                due_task(builder, task, field, since, interval);
            });
        }
    }
}

/// An interval or more is over: keeps what is beyond it, and counts releases that were missed.
fn due_task(builder: &mut FunctionBuilder, task: &Task, field: u32, since: Value, interval: Value) {
    let enabled = match single(task) {
        Some(single) => {
            let on = builder.load(place(single), Type::I1);
            builder.unary(UnaryOp::Not, on)
        }
        None => builder.constant(Type::I1, 1),
    };
    let waiting = builder.load(at(field, READY), Type::I1);
    let ready = builder.binary(BinaryOp::Or, waiting, enabled);
    builder.store(at(field, READY), ready);
    let beyond = builder.binary(BinaryOp::Sub, since, interval);
    builder.store(at(field, SINCE), beyond);
    let late = builder.compare(CompareOp::Uge, beyond, interval);
    when(builder, late, |builder| {
        let missed = builder.binary(BinaryOp::Udiv, beyond, interval);
        let rest = builder.binary(BinaryOp::Urem, beyond, interval);
        builder.store(at(field, SINCE), rest);
        let missed = builder.convert(iecc_ir::ConvertOp::Trunc, Type::I32, missed);
        let none = builder.constant(Type::I32, 0);
        let counted = builder.select(enabled, missed, none);
        overrun(builder, field, counted);
    });
}
