//! Tasks: when they are ready, and in which order they run.

use crate::hand::{Run, Text, program, unit, value};
use iecc_ir::print_module;
use iecc_lower::Options;
use iecc_sema::hir::code::BinaryOp;
use iecc_sema::hir::{Elementary as E, Place, Program, TagId, Task, Trigger};

const MS: u64 = 1_000_000;

/// A task that appends its digit to `log`, once a run, and then sets the bits of `sets`.
fn task(
    hir: &mut Program,
    digit: u32,
    priority: u32,
    trigger: Trigger,
    sets: &[(TagId, bool)],
) -> usize {
    let log = TagId::from_index(0);
    let mut text = Text::new();
    let (old, ten) = (text.get(E::Dint, log), text.num(E::Dint, 10));
    let (shifted, own) = (
        text.bin(BinaryOp::Multiply, old, ten),
        text.num(E::Dint, digit.into()),
    );
    let new = text.add(shifted, own);
    let mut body = vec![text.set_tag(log, new)];
    for &(tag, to) in sets {
        let to = text.num(E::Bool, u64::from(to).into());
        body.push(text.set_tag(tag, to));
    }
    let pou = unit(hir, &format!("Unit{digit}"), text.body(&body));
    hir.tasks.push(Task {
        name: format!("T{digit}"),
        trigger,
        priority,
        calls: vec![pou],
    });
    hir.tasks.len() - 1
}

fn logged() -> Program {
    let mut hir = program();
    value(&mut hir, "log", E::Dint, 0);
    hir
}

fn every(interval_ms: u64) -> Trigger {
    Trigger::Timed {
        interval_ns: interval_ms * MS,
        single: None,
    }
}

fn on(tag: TagId, interval_ms: u64) -> Trigger {
    Trigger::Timed {
        interval_ns: interval_ms * MS,
        single: Some(Place::whole(tag)),
    }
}

/// The digits of the tasks that ran in a scan.
fn ran(run: &mut Run, at_ms: u64) -> i64 {
    run.poke("log", 0);
    assert_eq!(run.scan(at_ms * MS), Ok(()));
    run.number("log")
}

#[test]
fn one_task_of_every_scan_needs_no_state() {
    let mut hir = logged();
    task(&mut hir, 1, 0, Trigger::EveryScan, &[]);
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!([ran(&mut run, 0), ran(&mut run, 10)], [1, 1]);
    let text = print_module(run.module());
    let scan = &text[text.find("fn @scan").unwrap()..text.find("fn @prescan").unwrap()];
    assert!(scan.starts_with("fn @scan[]() -> () {\nb0:\n  call @Unit1[]()"));
    assert_eq!(scan.matches("\n  ").count(), 2, "a call and a return");
    assert!(!text.contains("__"));
}

#[test]
fn tasks_run_by_priority_then_by_declaration() {
    let mut hir = logged();
    for (digit, priority) in [(1, 5), (2, 1), (3, 5), (4, 0)] {
        task(&mut hir, digit, priority, Trigger::EveryScan, &[]);
    }
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!(ran(&mut run, 0), 4213);
}

#[test]
fn intervals_begin_at_the_first_scan() {
    let mut hir = logged();
    task(&mut hir, 1, 1, every(10), &[]);
    task(&mut hir, 2, 2, every(30), &[]);
    for start in [0, 10, 7_000_000] {
        let mut run = Run::new(&hir, &Options::default());
        let found = [0, 10, 20, 30, 40, 50, 60].map(|at| ran(&mut run, start + at));
        assert_eq!(found, [12, 1, 1, 12, 1, 1, 12], "from {start} ms");
        assert_eq!(run.number("__task.T1/overruns"), 0);
    }
}

#[test]
fn releases_between_scans_are_kept_in_step() {
    let mut hir = logged();
    task(&mut hir, 1, 1, every(25), &[]);
    let mut run = Run::new(&hir, &Options::default());
    // Releases at 0, 25, 50, 75, 100.
    let found = [0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100].map(|at| ran(&mut run, at));
    assert_eq!(found, [1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 1]);
}

#[test]
fn missed_releases_are_counted_and_not_made_up_for() {
    let mut hir = logged();
    task(&mut hir, 1, 1, every(10), &[]);
    let mut run = Run::new(&hir, &Options::default());
    let overruns = |run: &Run| run.number("__task.T1/overruns");
    assert_eq!(ran(&mut run, 0), 1);
    // Releases at 10, 20, 30: two of them are missed.
    assert_eq!((ran(&mut run, 35), overruns(&run)), (1, 2));
    assert_eq!((ran(&mut run, 39), overruns(&run)), (0, 2));
    assert_eq!((ran(&mut run, 40), overruns(&run)), (1, 2));
    let names = &run.module().names;
    assert_eq!(names.len(), 1);
    assert_eq!(names[0].0, "T1.overruns");
}

#[test]
fn an_edge_of_single_runs_once() {
    let mut hir = logged();
    let go = value(&mut hir, "go", E::Bool, 0);
    task(&mut hir, 1, 1, on(go, 0), &[]);
    let mut run = Run::new(&hir, &Options::default());
    let mut found = Vec::new();
    for (at, bit) in (0..).zip([0, 1, 1, 0, 1, 0]) {
        run.poke("go", bit);
        found.push(ran(&mut run, at));
    }
    assert_eq!(found, [0, 1, 0, 0, 1, 0]);
}

#[test]
fn single_that_is_true_at_first_is_an_edge() {
    let mut hir = logged();
    let go = value(&mut hir, "go", E::Bool, 1);
    task(&mut hir, 1, 1, on(go, 0), &[]);
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!([ran(&mut run, 0), ran(&mut run, 1)], [1, 0]);
}

#[test]
fn there_are_no_releases_by_time_while_single_is_true() {
    let mut hir = logged();
    let go = value(&mut hir, "go", E::Bool, 0);
    task(&mut hir, 1, 1, on(go, 10), &[]);
    let mut run = Run::new(&hir, &Options::default());
    let mut found = Vec::new();
    for (at, bit) in [(0, 0), (10, 1), (20, 1), (45, 1), (49, 0), (50, 0), (60, 0)] {
        run.poke("go", bit);
        found.push(ran(&mut run, at));
    }
    // At 10 by the edge, at 50 and 60 by time.
    assert_eq!(found, [1, 1, 0, 0, 0, 1, 1]);
    assert_eq!(run.number("__task.T1/overruns"), 0);
}

#[test]
fn an_event_found_in_a_scan_runs_behind_tasks_of_higher_priority() {
    let mut hir = logged();
    let go = value(&mut hir, "go", E::Bool, 0);
    // 1 raises go; 3 waits for it; 2 stands between them, 4 behind.
    task(&mut hir, 3, 3, on(go, 0), &[]);
    task(&mut hir, 1, 1, every(20), &[(go, true)]);
    task(&mut hir, 2, 2, every(10), &[]);
    task(&mut hir, 4, 4, every(10), &[(go, false)]);
    let mut run = Run::new(&hir, &Options::default());
    let found = [0, 10, 20, 30].map(|at| ran(&mut run, at));
    assert_eq!(found, [1234, 24, 1234, 24]);
}

#[test]
fn an_event_for_a_task_that_had_its_turn_waits_for_the_next_scan() {
    let mut hir = logged();
    let go = value(&mut hir, "go", E::Bool, 0);
    task(&mut hir, 1, 1, on(go, 0), &[(go, false)]);
    task(&mut hir, 2, 2, every(20), &[(go, true)]);
    let mut run = Run::new(&hir, &Options::default());
    let found = [0, 10, 20, 30].map(|at| ran(&mut run, at));
    assert_eq!(found, [2, 1, 2, 1]);
}

#[test]
fn a_pulse_between_two_tasks_is_seen() {
    let mut hir = logged();
    let go = value(&mut hir, "go", E::Bool, 0);
    task(&mut hir, 1, 1, Trigger::EveryScan, &[(go, true)]);
    task(&mut hir, 2, 2, Trigger::EveryScan, &[(go, false)]);
    task(&mut hir, 3, 3, on(go, 0), &[]);
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!([ran(&mut run, 0), ran(&mut run, 1)], [123, 123]);
}

#[test]
fn events_of_one_task_that_meet_run_it_once_and_are_counted() {
    let mut hir = logged();
    let go = value(&mut hir, "go", E::Bool, 0);
    // go rises behind 1 and again behind 3, before 4 has its turn.
    task(&mut hir, 1, 1, every(1), &[(go, true)]);
    task(&mut hir, 2, 2, every(1), &[(go, false)]);
    task(&mut hir, 3, 3, every(1), &[(go, true)]);
    task(&mut hir, 4, 4, on(go, 0), &[(go, false)]);
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!([ran(&mut run, 0), ran(&mut run, 1)], [1234, 1234]);
    assert_eq!(run.number("__task.T4/overruns"), 2);
}

#[test]
fn a_task_without_interval_and_event_never_runs() {
    let mut hir = logged();
    task(&mut hir, 1, 1, every(0), &[]);
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!([ran(&mut run, 0), ran(&mut run, 10)], [0, 0]);
}

#[test]
fn names_of_users_come_first() {
    let mut hir = logged();
    value(&mut hir, "__task.T1", E::Int, 5);
    value(&mut hir, "t1.OVERRUNS", E::Int, 6);
    task(&mut hir, 1, 1, every(10), &[]);
    let mut run = Run::new(&hir, &Options::default());
    assert_eq!(
        [ran(&mut run, 0), ran(&mut run, 5), ran(&mut run, 10)],
        [1, 0, 1]
    );
    assert_eq!(run.number("__task.T1"), 5);
    assert_eq!(run.module().names, []);
}
