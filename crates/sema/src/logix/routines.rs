//! Routines: which rungs are live, who calls whom, and the values that calls pass.
//!
//! Routines that run are checked first and in full. Those that never run are checked too, but what
//! is refused there is only a warning.

use super::check::Cursor;
use super::instructions::{self, Meaning, Passing};
use super::tasks::{RoutineIndex, Schedule, routine_named};
use super::{Analysis, Edits};
use crate::hir::{Body, Elementary, Place, Pou, PouId};
use iecc_ast::logix::{Routine, RoutineBody, Rung, RungKind};
use iecc_ast::rung::{Element, Instruction};
use iecc_diag::{Code, Diagnostic, Diagnostics, Severity};
use iecc_source::Span;

/// What a routine takes and gives.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Signature {
    pub(crate) parameters: Vec<(Place, Elementary)>,
    /// The type of each value, and whether it is only ever a literal, which fits any number.
    pub(crate) results: Vec<(Elementary, bool)>,
}

impl<'p> Analysis<'p> {
    pub(crate) fn routine(&self, (program, routine): RoutineIndex) -> &'p Routine {
        &self.project.programs[program].routines[routine]
    }

    /// The rungs that the controller executes.
    pub(crate) fn live_rungs(&self, (program, routine): RoutineIndex) -> Vec<&'p Rung> {
        let test_edits = match self.options.edits {
            Edits::AsExported => self.project.programs[program].test_edits,
            Edits::Original => false,
            Edits::Test => true,
        };
        match &self.routine((program, routine)).body {
            RoutineBody::Ladder(rungs) => rungs
                .iter()
                .filter(|rung| rung.kind.is_live(test_edits))
                .collect(),
            RoutineBody::StructuredText(_)
            | RoutineBody::FunctionBlock(_)
            | RoutineBody::SequentialChart(_)
            | RoutineBody::Encoded(_)
            | RoutineBody::Unknown(_) => Vec::new(),
        }
    }

    /// The routines that a routine calls and where, as far as they exist.
    pub(crate) fn call_targets(&self, unit: RoutineIndex) -> Vec<(RoutineIndex, Span)> {
        let program = &self.project.programs[unit.0];
        let mut targets = Vec::new();
        for body in self
            .live_rungs(unit)
            .iter()
            .filter_map(|rung| rung.body.as_ref())
        {
            for call in body.instructions() {
                let name = call.operands.first().and_then(|operand| operand.as_name());
                if let Some(name) = name.filter(|_| calls_routine(call)) {
                    let target = routine_named(program, &name.node);
                    targets.extend(target.map(|target| ((unit.0, target), call.span)));
                }
            }
        }
        targets
    }

    /// Checks every routine of the project; gives those that run.
    pub(crate) fn check_routines(&mut self, schedule: &Schedule) -> Vec<Pou> {
        let signatures = self.signatures(schedule);
        let mut pous = Vec::new();
        for (&unit, &id) in &schedule.units {
            pous.push(self.pou(unit, id, schedule, &signatures));
        }
        self.check_mains(schedule, &signatures);
        for (program, routine) in self.all_routines() {
            if !schedule.units.contains_key(&(program, routine)) {
                self.idle_routine((program, routine), schedule, &signatures);
            }
        }
        pous
    }

    fn all_routines(&self) -> Vec<RoutineIndex> {
        let programs = self.project.programs.iter().enumerate();
        programs
            .flat_map(|(index, program)| (0..program.routines.len()).map(move |r| (index, r)))
            .collect()
    }

    fn pou(
        &mut self,
        unit: RoutineIndex,
        id: PouId,
        schedule: &Schedule,
        signatures: &[Signature],
    ) -> Pou {
        self.warn_edits(unit);
        let routine = self.routine(unit);
        let cursor = Cursor {
            unit,
            schedule,
            signatures,
        };
        let rungs = self.rungs(cursor);
        let signature = &signatures[id.index()];
        let program = &self.project.programs[unit.0].name.node;
        Pou {
            name: format!("{program}/{}", routine.name.node),
            parameters: signature
                .parameters
                .iter()
                .map(|(place, _)| place.clone())
                .collect(),
            results: signature.results.iter().map(|(ty, _)| *ty).collect(),
            body: Body::Ladder(rungs),
            span: routine.name.span,
        }
    }

    /// Main routines are called without values.
    fn check_mains(&mut self, schedule: &Schedule, signatures: &[Signature]) {
        for main in &schedule.mains {
            let routine = self.routine(*main);
            match schedule.units.get(main) {
                Some(id) if !signatures[id.index()].parameters.is_empty() => {
                    let message = format!(
                        "the main routine `{}` takes parameters, but the task passes none",
                        routine.name.node
                    );
                    self.report(Diagnostic::new(Code::E5030, routine.name.span, message));
                }
                Some(_) => {}
                None => self.refuse_kind(routine, routine.name.span),
            }
        }
    }

    /// Reports a routine whose language is not compiled, where it is called.
    pub(crate) fn refuse_kind(&mut self, routine: &Routine, span: Span) {
        let diagnostic = match language(routine) {
            Err(code) => Diagnostic::new(
                code,
                span,
                format!("the routine `{}` {}", routine.name.node, refusal(routine)),
            )
            .also(routine.name.span, "the routine"),
            Ok(()) => return,
        };
        self.report_once(kind_key(routine), diagnostic);
    }

    /// Checks a routine that never runs.
    fn idle_routine(&mut self, unit: RoutineIndex, schedule: &Schedule, signatures: &[Signature]) {
        let routine = self.routine(unit);
        if language(routine).is_err() {
            if self.reported.contains(&kind_key(routine)) {
                return;
            }
            let message = format!(
                "the routine `{}` {}; nothing that runs calls it",
                routine.name.node,
                refusal(routine)
            );
            self.report(Diagnostic::new(Code::E5028, routine.name.span, message));
            return;
        }
        let before = std::mem::take(&mut self.diagnostics);
        self.rungs(Cursor {
            unit,
            schedule,
            signatures,
        });
        let found = std::mem::replace(&mut self.diagnostics, before);
        self.diagnostics.append(soften(&found));
    }

    fn warn_edits(&mut self, unit: RoutineIndex) {
        let RoutineBody::Ladder(rungs) = &self.routine(unit).body else {
            return;
        };
        let pending = rungs.iter().filter(|rung| rung.kind != RungKind::Normal);
        let Some(first) = pending.clone().next() else {
            return;
        };
        let count = pending.count();
        let live = self.live_rungs(unit).len();
        let message = format!(
            "the routine `{}` has {count} rungs with pending edits; {live} of its {} rungs run",
            self.routine(unit).name.node,
            rungs.len()
        );
        let side = match self.options.edits {
            Edits::AsExported if self.project.programs[unit.0].test_edits => {
                "the edited rungs run, because test edits were active at export"
            }
            Edits::AsExported => {
                "the original rungs run, because test edits were not active at export"
            }
            Edits::Original => "the original rungs run, as asked for",
            Edits::Test => "the edited rungs run, as asked for",
        };
        self.report(
            Diagnostic::new(Code::E5032, first.span, message)
                .label("the first of them")
                .note(side),
        );
    }

    /// Signatures of all routines that run, by id.
    fn signatures(&mut self, schedule: &Schedule) -> Vec<Signature> {
        let units: Vec<RoutineIndex> = schedule.units.keys().copied().collect();
        units.into_iter().map(|unit| self.signature(unit)).collect()
    }

    fn signature(&mut self, unit: RoutineIndex) -> Signature {
        let rungs = self.live_rungs(unit);
        let mut signature = Signature::default();
        let first = rungs.first().and_then(|rung| rung.body.as_ref());
        if let Some(Element::Instruction(call)) = first.and_then(|body| body.elements.first())
            && is(call, Passing::Subroutine)
        {
            signature.parameters = self.parameters(unit, call);
        }
        let mut results: Option<Vec<(Elementary, bool)>> = None;
        for body in rungs.iter().filter_map(|rung| rung.body.as_ref()) {
            for ret in body.instructions() {
                if is(ret, Passing::Return) && !ret.operands.is_empty() {
                    let types = self.result_types(unit, ret);
                    results = Some(match results {
                        Some(other) => self.merge_results(other, types, ret),
                        None => types,
                    });
                }
            }
        }
        signature.results = results.unwrap_or_default();
        signature
    }

    fn merge_results(
        &mut self,
        mut first: Vec<(Elementary, bool)>,
        second: Vec<(Elementary, bool)>,
        ret: &Instruction,
    ) -> Vec<(Elementary, bool)> {
        let mut same = first.len() == second.len();
        for (a, b) in first.iter_mut().zip(second) {
            match (a.1, b.1) {
                (true, false) => *a = b,
                (false, true) => {}
                (_, _) => same &= a.0 == b.0,
            }
        }
        if !same {
            let message = "this RET gives back other values than the RET before it in the routine";
            self.report(
                Diagnostic::new(Code::E5030, ret.span, message).note(
                    "every RET with values needs the same number of values of the same types",
                ),
            );
        }
        first
    }
}

fn is(instruction: &Instruction, passing: Passing) -> bool {
    let row = instructions::find(&instruction.mnemonic.node);
    row.is_some_and(|row| row.meaning == Meaning::Control(passing))
}

/// JSR, and what else makes a routine run.
fn calls_routine(instruction: &Instruction) -> bool {
    ["JSR", "FOR", "SFR", "SFP"]
        .iter()
        .any(|name| instruction.mnemonic.node.eq_ignore_ascii_case(name))
}

/// Whether the language of a routine is compiled; else the code of the refusal.
fn language(routine: &Routine) -> Result<(), Code> {
    match routine.body {
        RoutineBody::Ladder(_) => Ok(()),
        RoutineBody::StructuredText(_)
        | RoutineBody::FunctionBlock(_)
        | RoutineBody::SequentialChart(_)
        | RoutineBody::Unknown(_) => Err(Code::E5025),
        RoutineBody::Encoded(_) => Err(Code::E5026),
    }
}

fn refusal(routine: &Routine) -> &'static str {
    match routine.body {
        RoutineBody::Ladder(_) => "is ladder",
        RoutineBody::StructuredText(_) => "is structured text, which is not compiled yet",
        RoutineBody::FunctionBlock(_) => "is a function block diagram, which is not compiled",
        RoutineBody::SequentialChart(_) => "is a sequential function chart, which is not compiled",
        RoutineBody::Encoded(_) => "is encrypted, so it cannot be compiled",
        RoutineBody::Unknown(_) => "is of a kind that iecc does not know",
    }
}

/// Under which the kind of a routine is reported once.
fn kind_key(routine: &Routine) -> String {
    format!("kind {:?}", routine.span)
}

/// What cannot be compiled does no harm where it never runs; mistakes stay errors.
fn soften(found: &Diagnostics) -> Diagnostics {
    let mut softened = Diagnostics::new();
    for diagnostic in found {
        let mut diagnostic = diagnostic.clone();
        if is_refusal(diagnostic.code) {
            diagnostic.severity = Severity::Warning;
            diagnostic = diagnostic.note("nothing that runs calls this routine");
        }
        softened.push(diagnostic);
    }
    softened
}

/// Codes that say "correct, but not compiled".
fn is_refusal(code: Code) -> bool {
    [
        Code::E2010,
        Code::E5021,
        Code::E5023,
        Code::E5024,
        Code::E5025,
        Code::E5026,
        Code::E5029,
        Code::E5033,
        Code::E6024,
    ]
    .contains(&code)
}
