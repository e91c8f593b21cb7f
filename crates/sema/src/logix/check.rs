//! Rungs: each instruction is looked up in the table, its operands are checked by kind, and what
//! comes out is an operation that needs no further decisions.

use super::operation::Checker;
use super::routines::Signature;
use super::tasks::{RoutineIndex, Schedule};
use super::types::fold;
use super::words::{are, count_of};
use super::{Analysis, instructions};
use crate::hir::{self, PouId};
use iecc_ast::rung::{Element, Instruction};
use iecc_diag::{Code, Diagnostic, closest};
use instructions::{INSTRUCTIONS, Meaning, NOT_LOGIX, Reason, Row};

/// Which routine is checked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cursor<'a> {
    pub(crate) unit: RoutineIndex,
    pub(crate) schedule: &'a Schedule,
    /// By id.
    pub(crate) signatures: &'a [Signature],
}

impl Cursor<'_> {
    pub(crate) fn program(&self) -> Option<usize> {
        Some(self.unit.0)
    }

    pub(crate) fn own_id(&self) -> Option<PouId> {
        self.schedule.units.get(&self.unit).copied()
    }
}

impl<'p> Analysis<'p> {
    /// Checks the live rungs of a routine. What has an error is left out.
    pub(crate) fn rungs(&mut self, cursor: Cursor<'_>) -> Vec<hir::Rung> {
        let live = self.live_rungs(cursor.unit);
        let mut rungs = Vec::with_capacity(live.len());
        for (position, rung) in live.into_iter().enumerate() {
            // A rung without body was reported when it was read.
            if let Some(body) = &rung.body {
                rungs.push(hir::Rung {
                    number: rung.number,
                    elements: self.series(cursor, &body.elements, position == 0),
                    span: body.span,
                });
            }
        }
        rungs
    }

    /// `start`: the series begins at the start of the routine.
    fn series(
        &mut self,
        cursor: Cursor<'_>,
        elements: &[Element],
        start: bool,
    ) -> Vec<hir::Element> {
        let mut series = Vec::with_capacity(elements.len());
        for (position, element) in elements.iter().enumerate() {
            match element {
                Element::Instruction(instruction) => {
                    let first = start && position == 0;
                    let checked = self.instruction(cursor, instruction, first);
                    self.incomplete |= checked.is_none() && cursor.own_id().is_some();
                    series.extend(checked.map(hir::Element::Instruction));
                }
                Element::Branch(branch) => {
                    let legs = branch
                        .legs
                        .iter()
                        .map(|leg| self.series(cursor, &leg.elements, false))
                        .collect();
                    series.push(hir::Element::Branch(legs));
                }
            }
        }
        series
    }

    fn instruction(
        &mut self,
        cursor: Cursor<'_>,
        instruction: &Instruction,
        first: bool,
    ) -> Option<hir::Instruction> {
        let row = self.row(instruction)?;
        if !row.is_variable() && instruction.operands.len() != row.operands.len() {
            self.wrong_count(instruction, row);
            return None;
        }
        let op = Checker {
            cursor,
            instruction,
            row,
            first,
        }
        .op(self)?;
        let mut places = Vec::new();
        op.for_each_place(&mut |place, _| places.push(place.clone()));
        let prescan = row
            .prescan
            .iter()
            .map(|&(index, effect)| (places[index].clone(), effect))
            .collect();
        Some(hir::Instruction {
            op,
            prescan,
            span: instruction.span,
        })
    }

    /// The row of an instruction that is compiled; reports when there is none.
    fn row(&mut self, instruction: &Instruction) -> Option<&'static Row> {
        let name = &instruction.mnemonic;
        if let Some(called) = self.add_on_instruction(&name.node) {
            let message = format!(
                "`{}` is an Add-On Instruction, whose calls are not compiled yet",
                name.node
            );
            self.report(
                Diagnostic::new(Code::E5024, name.span, message)
                    .also(called.span, "the instruction is defined here"),
            );
            return None;
        }
        let Some(row) = instructions::find(&name.node) else {
            self.unknown_instruction(name);
            return None;
        };
        if let Meaning::Refused(reason) = row.meaning {
            let message = format!("the instruction `{}` is not compiled", name.node);
            let diagnostic =
                Diagnostic::new(Code::E5021, name.span, message).note(Reason::explain(reason));
            self.report(diagnostic);
            return None;
        }
        Some(row)
    }

    fn add_on_instruction(&self, name: &str) -> Option<&'p iecc_ast::Name> {
        let found = self
            .project
            .instructions
            .iter()
            .find(|instruction| instruction.name.node.eq_ignore_ascii_case(name));
        found.map(|instruction| &instruction.name)
    }

    fn unknown_instruction(&mut self, name: &iecc_ast::Name) {
        let known = NOT_LOGIX
            .iter()
            .find(|(other, _)| other.eq_ignore_ascii_case(&name.node));
        if let Some((_, advice)) = known {
            let message = format!("`{}` is not a Logix instruction", name.node);
            self.report(Diagnostic::new(Code::E5022, name.span, message).note(*advice));
            return;
        }
        let message = format!(
            "`{}` is neither an instruction nor an Add-On Instruction of the file",
            name.node
        );
        let mut diagnostic = Diagnostic::new(Code::E1008, name.span, message);
        let built_in = INSTRUCTIONS.iter().flat_map(Row::names);
        let project = self.project;
        let mut known: Vec<&str> = built_in.collect();
        known.extend(project.instructions.iter().map(|i| i.name.node.as_str()));
        diagnostic = match closest(&name.node, known) {
            Some(near) => diagnostic.fix(format!("did you mean `{near}`?"), name.span, near),
            None => diagnostic
                .note("if it is an Add-On Instruction, export it together with the routine"),
        };
        self.report_once(format!("instruction {}", fold(&name.node)), diagnostic);
    }

    fn wrong_count(&mut self, instruction: &Instruction, row: &Row) {
        let names: Vec<&str> = row.operands.iter().map(|(name, _)| *name).collect();
        let wanted = match names.len() {
            0 => "no operands".to_owned(),
            count => format!("{} ({})", count_of(count, "operand"), names.join(", ")),
        };
        let message = format!(
            "{} takes {wanted}, but {} given",
            instruction.mnemonic.node,
            are(instruction.operands.len())
        );
        self.report(Diagnostic::new(Code::E5020, instruction.span, message));
    }
}
