//! What a scan runs: the programs of the one active task, in their order.
//!
//! Programs that no task runs are checked but not run. More than one active task, event tasks and
//! equipment phases are refused.

use super::Analysis;
use super::types::{duplicate, fold};
use crate::hir::PouId;
use iecc_ast::logix::{Program, RoutineBody, Task, TaskKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::Span;
use std::collections::BTreeMap;

/// A routine by its position: program, routine.
pub(crate) type RoutineIndex = (usize, usize);

/// What runs.
#[derive(Debug, Default)]
pub(crate) struct Schedule {
    /// Name of the task.
    pub(crate) task: String,
    /// Main routines in the order they are called.
    pub(crate) mains: Vec<RoutineIndex>,
    /// Every routine that runs and is ladder, in file order.
    pub(crate) units: BTreeMap<RoutineIndex, PouId>,
}

impl<'p> Analysis<'p> {
    /// Works out what runs; reports what cannot.
    pub(crate) fn schedule(&mut self) -> Schedule {
        self.unique_programs();
        let mut schedule = Schedule::default();
        if let Some(task) = self.active_task() {
            schedule.task = task.name.node.clone();
            schedule.mains = self.task_programs(task);
        }
        self.refuse_connections();
        schedule.units = self.units(&schedule.mains);
        self.refuse_recursion(&schedule);
        schedule
    }

    fn unique_programs(&mut self) {
        let mut seen = BTreeMap::new();
        for program in &self.project.programs {
            if let Some(first) = seen.insert(fold(&program.name.node), &program.name) {
                self.report(duplicate("program", &program.name, first));
            }
            let mut routines = BTreeMap::new();
            for routine in &program.routines {
                if let Some(first) = routines.insert(fold(&routine.name.node), &routine.name) {
                    self.report(duplicate("routine", &routine.name, first));
                }
            }
        }
    }

    fn active_task(&mut self) -> Option<&'p Task> {
        let project = self.project;
        let mut active = project
            .tasks
            .iter()
            .filter(|task| !task.inhibited && !task.programs.is_empty());
        let Some(task) = active.next() else {
            self.nothing_to_run();
            return None;
        };
        for other in active {
            let message = format!(
                "the task `{}` is active besides `{}`; programs with several tasks are not compiled yet",
                other.name.node, task.name.node
            );
            self.report(
                Diagnostic::new(Code::E6021, other.name.span, message)
                    .also(task.name.span, "the first active task"),
            );
        }
        self.check_task(task);
        Some(task)
    }

    fn check_task(&mut self, task: &Task) {
        let what = match &task.kind {
            TaskKind::Continuous | TaskKind::Periodic { .. } => None,
            TaskKind::Event { .. } => Some("runs on an event"),
            TaskKind::Unknown(_) => Some("is of a kind that iecc does not know"),
        };
        if let Some(what) = what {
            let message = format!(
                "the task `{}` {what}, which is not compiled yet",
                task.name.node
            );
            self.report(Diagnostic::new(Code::E6022, task.name.span, message));
        }
        if task.disable_update_outputs {
            let message = format!(
                "the task `{}` does not update outputs at its end, which is not compiled yet",
                task.name.node
            );
            self.report(Diagnostic::new(Code::E6026, task.name.span, message));
        }
    }

    fn nothing_to_run(&mut self) {
        let project = self.project;
        let what = project.target_type.as_ref().map_or("part", |t| &t.node);
        let (message, note) = if project.tasks.is_empty() {
            (
                format!("this export of a {what} has no task, so there is nothing to run"),
                "export the whole controller",
            )
        } else {
            (
                "every task is inhibited or has no program, so there is nothing to run".to_owned(),
                "schedule a program in a task that is not inhibited",
            )
        };
        let place = project.target_type.as_ref().map_or_else(
            || Span::point(project.span.file, project.span.start),
            |name| name.span,
        );
        self.report(Diagnostic::new(Code::E6020, place, message).note(note));
    }

    fn task_programs(&mut self, task: &Task) -> Vec<RoutineIndex> {
        let programs = &self.project.programs;
        let mut mains = Vec::new();
        for name in &task.programs {
            let found = programs
                .iter()
                .position(|program| program.name.node.eq_ignore_ascii_case(&name.node));
            match found {
                Some(index) => mains.extend(self.main_routine(index)),
                None => {
                    let message = format!(
                        "the task `{}` runs the program `{}`, which is not in the file",
                        task.name.node, name.node
                    );
                    self.report(Diagnostic::new(Code::E1009, name.span, message));
                }
            }
        }
        self.warn_idle_programs();
        mains
    }

    fn warn_idle_programs(&mut self) {
        let project = self.project;
        for program in &project.programs {
            let schedules = |task: &&Task| {
                let mut names = task.programs.iter();
                names.any(|name| name.node.eq_ignore_ascii_case(&program.name.node))
            };
            let why = match project.tasks.iter().find(schedules) {
                Some(task) if task.inhibited => "in an inhibited task",
                Some(_) => continue,
                None => "not scheduled",
            };
            let message = format!(
                "the program `{}` is {why}: it is checked but never runs",
                program.name.node
            );
            self.report(Diagnostic::new(Code::E6023, program.name.span, message));
        }
    }

    fn main_routine(&mut self, index: usize) -> Option<RoutineIndex> {
        let program = &self.project.programs[index];
        if program.disabled {
            return None;
        }
        if program.is_phase || program.safety {
            let what = if program.is_phase {
                "an equipment phase"
            } else {
                "a safety program"
            };
            let message = format!("`{}` is {what}, which is not compiled", program.name.node);
            self.report(Diagnostic::new(Code::E6027, program.name.span, message));
            return None;
        }
        let Some(main) = &program.main_routine else {
            let message = format!(
                "the program `{}` has no main routine, so nothing in it runs",
                program.name.node
            );
            self.report(Diagnostic::new(Code::E6028, program.name.span, message));
            return None;
        };
        let routine = routine_named(program, &main.node);
        if routine.is_none() {
            let message = format!(
                "the main routine `{}` is not in the program `{}`",
                main.node, program.name.node
            );
            self.report(Diagnostic::new(Code::E1007, main.span, message));
        }
        routine.map(|routine| (index, routine))
    }

    fn refuse_connections(&mut self) {
        for connection in &self.project.parameter_connections {
            let [a, b] = &connection.endpoints;
            let message = format!(
                "the connection of `{}` with `{}` is not compiled yet",
                a.node, b.node
            );
            self.report(Diagnostic::new(Code::E6029, connection.span, message));
        }
    }

    /// Every ladder routine that is reached from the main routines, in file order.
    fn units(&self, mains: &[RoutineIndex]) -> BTreeMap<RoutineIndex, PouId> {
        let mut reached: BTreeMap<RoutineIndex, PouId> = BTreeMap::new();
        let mut stack: Vec<RoutineIndex> = mains.to_vec();
        while let Some(unit) = stack.pop() {
            if reached.insert(unit, PouId(0)).is_none() {
                let targets = self.call_targets(unit);
                stack.extend(targets.into_iter().map(|(target, _)| target));
            }
        }
        reached.retain(|unit, _| matches!(self.routine(*unit).body, RoutineBody::Ladder(_)));
        for (number, id) in reached.values_mut().enumerate() {
            *id = PouId(number as u32);
        }
        reached
    }

    /// Refuses routines that call themselves, directly or through others. Depth first on an
    /// explicit stack, because the user decides how deep calls nest.
    fn refuse_recursion(&mut self, schedule: &Schedule) {
        let mut done: BTreeMap<RoutineIndex, bool> = BTreeMap::new();
        for &start in schedule.units.keys() {
            if done.contains_key(&start) {
                continue;
            }
            done.insert(start, false);
            let mut stack = vec![(start, self.call_targets(start).into_iter())];
            while let Some((unit, targets)) = stack.last_mut() {
                let unit = *unit;
                match targets.next() {
                    None => {
                        done.insert(unit, true);
                        stack.pop();
                    }
                    Some((target, span)) => match done.get(&target) {
                        Some(true) => {}
                        Some(false) => {
                            let open: Vec<RoutineIndex> =
                                stack.iter().map(|(unit, _)| *unit).collect();
                            self.recursion(&open, target, span);
                        }
                        None => {
                            done.insert(target, false);
                            let next = self.call_targets(target).into_iter();
                            stack.push((target, next));
                        }
                    },
                }
            }
        }
    }

    fn recursion(&mut self, open: &[RoutineIndex], target: RoutineIndex, span: Span) {
        let start = open.iter().position(|unit| *unit == target);
        let cycle = &open[start.expect("an open routine is on the stack")..];
        let names: Vec<&str> = cycle
            .iter()
            .map(|unit| self.routine(*unit).name.node.as_str())
            .chain([self.routine(target).name.node.as_str()])
            .collect();
        let shown = if names.len() > 10 {
            format!(
                "{} -> … -> {}",
                names[..8].join(" -> "),
                names[names.len() - 1]
            )
        } else {
            names.join(" -> ")
        };
        let message = format!("this call makes routines call themselves: {shown}");
        self.report(
            Diagnostic::new(Code::E5027, span, message)
                .note("every routine must be able to finish within the scan"),
        );
    }
}

/// Position of a routine in its program.
pub(crate) fn routine_named(program: &Program, name: &str) -> Option<usize> {
    program
        .routines
        .iter()
        .position(|routine| routine.name.node.eq_ignore_ascii_case(name))
}
