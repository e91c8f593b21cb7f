//! JSR, SBR and RET: which routine is called, and whether values fit on both sides.
//!
//! Values are passed one by one, by value, in order. The types on both sides have to be the same;
//! a literal fits any number. What the controller would only notice as a major fault when the call
//! happens, too few values, is refused here.

use super::Analysis;
use super::operands::{Slot, literal_of};
use super::operation::Checker;
use super::tasks::{RoutineIndex, routine_named};
use super::words::{are, count_of};
use crate::hir::{Action, Condition, Const, Elementary, Operand, Place, PouId, Type};
use iecc_ast::logix::RoutineBody;
use iecc_ast::rung::{self, Instruction};
use iecc_diag::{Code, Diagnostic, closest};

impl Analysis<'_> {
    /// The places of an SBR, the first instruction of a routine.
    pub(crate) fn parameters(
        &mut self,
        unit: RoutineIndex,
        sbr: &Instruction,
    ) -> Vec<(Place, Elementary)> {
        let mut parameters = Vec::new();
        for operand in &sbr.operands {
            let slot = Slot {
                program: Some(unit.0),
                instruction: &sbr.mnemonic.node,
                name: "parameter",
                operand,
            };
            parameters.extend(self.value_target(slot));
        }
        parameters
    }

    /// The types that a RET gives back, and which are literals.
    pub(crate) fn result_types(
        &mut self,
        unit: RoutineIndex,
        ret: &Instruction,
    ) -> Vec<(Elementary, bool)> {
        let slot = |operand| Slot {
            program: Some(unit.0),
            instruction: &ret.mnemonic.node,
            name: "value",
            operand,
        };
        // Errors are reported when the RET itself is checked.
        let values: Vec<Option<Operand>> = self.silently(|analysis| {
            let operands = ret.operands.iter();
            operands
                .map(|operand| analysis.value(slot(operand)))
                .collect()
        });
        values
            .into_iter()
            .map(|value| match value {
                Some(Operand::Const(constant)) => (constant.ty(), true),
                Some(Operand::Place(_, ty)) => (ty, false),
                None => (Elementary::Dint, true),
            })
            .collect()
    }

    /// One value of any type: a literal, a number or a bit.
    fn value(&mut self, slot: Slot<'_>) -> Option<Operand> {
        if literal_of(slot.operand).is_some() {
            return self.number_operand(slot);
        }
        let (place, ty) = self.value_place(slot)?;
        Some(Operand::Place(place, ty))
    }

    fn value_place(&mut self, slot: Slot<'_>) -> Option<(Place, Elementary)> {
        let place = self.place_operand(slot, "a tag with one value")?;
        match self.type_of(&place) {
            Type::Elementary(ty) => Some((place, ty)),
            ty @ (Type::Struct(_) | Type::Array(_)) => {
                let message = format!(
                    "{} passes by value as a whole, which is not compiled yet",
                    self.describe(&place, ty)
                );
                self.report(Diagnostic::new(Code::E5033, slot.operand.span, message));
                None
            }
        }
    }

    /// One value of any type that is written.
    fn value_target(&mut self, slot: Slot<'_>) -> Option<(Place, Elementary)> {
        let (place, ty) = self.value_place(slot)?;
        self.check_write(&place, slot.operand.span);
        Some((place, ty))
    }
}

impl Checker<'_> {
    pub(crate) fn subroutine(&self, analysis: &mut Analysis<'_>) -> Option<Condition> {
        if !self.first {
            let message = "SBR must be the first instruction of its routine";
            analysis.report(Diagnostic::new(Code::E5031, self.instruction.span, message));
            return None;
        }
        if self.cursor.own_id().is_none() {
            // Routines that run were checked with their signatures.
            analysis.parameters(self.cursor.unit, self.instruction);
        }
        Some(Condition::Subroutine)
    }

    pub(crate) fn return_values(&self, analysis: &mut Analysis<'_>) -> Option<Action> {
        let values: Vec<Option<Operand>> = self
            .instruction
            .operands
            .iter()
            .map(|operand| analysis.value(self.named_slot("value", operand)))
            .collect();
        let values: Option<Vec<Operand>> = values.into_iter().collect();
        let mut values = values?;
        let id = self.cursor.own_id()?;
        // A literal takes the type that other RETs of the routine give.
        let results = &self.cursor.signatures[id.index()].results;
        for (value, (ty, _)) in values.iter_mut().zip(results) {
            if let Operand::Const(constant) = value {
                *constant = retype(*constant, *ty);
            }
        }
        Some(Action::Return(values))
    }

    pub(crate) fn call(&self, analysis: &mut Analysis<'_>) -> Option<Action> {
        let target = self.target(analysis)?;
        let operands = &self.instruction.operands;
        let count = self.input_count(analysis)?;
        let rest = operands.get(2..).unwrap_or_default();
        if count > rest.len() {
            let message = format!(
                "{} announces {}, but {} given",
                self.instruction.mnemonic.node,
                count_of(count, "input"),
                are(rest.len())
            );
            analysis.report(Diagnostic::new(Code::E5020, self.instruction.span, message));
            return None;
        }
        let (inputs, returns) = rest.split_at(count);
        let inputs: Vec<Option<Operand>> = inputs
            .iter()
            .map(|operand| analysis.value(self.named_slot("input", operand)))
            .collect();
        let returns: Vec<Option<(Place, Elementary)>> = returns
            .iter()
            .map(|operand| analysis.value_target(self.named_slot("return", operand)))
            .collect();
        let (inputs, returns): (Option<Vec<_>>, Option<Vec<_>>) =
            (inputs.into_iter().collect(), returns.into_iter().collect());
        let pou = *self.cursor.schedule.units.get(&target)?;
        self.fit(analysis, pou, inputs?, returns?)
    }

    /// The routine a call names, in the same program.
    fn target(&self, analysis: &mut Analysis<'_>) -> Option<RoutineIndex> {
        let program = &analysis.project.programs[self.cursor.unit.0];
        let Some(operand) = self.instruction.operands.first() else {
            let message = format!("{} names no routine", self.instruction.mnemonic.node);
            analysis.report(Diagnostic::new(Code::E5020, self.instruction.span, message));
            return None;
        };
        let Some(name) = operand.as_name() else {
            let message = format!(
                "the first operand of {} must be the name of a routine",
                self.instruction.mnemonic.node
            );
            analysis.report(Diagnostic::new(Code::E2001, operand.span, message));
            return None;
        };
        let Some(routine) = routine_named(program, &name.node) else {
            let message = format!(
                "the program `{}` has no routine `{}`",
                program.name.node, name.node
            );
            let diagnostic = Diagnostic::new(Code::E1007, name.span, message);
            let names = program.routines.iter().map(|r| r.name.node.as_str());
            analysis.report(match closest(&name.node, names) {
                Some(near) => diagnostic.fix(format!("did you mean `{near}`?"), name.span, near),
                None => diagnostic,
            });
            return None;
        };
        let found = &program.routines[routine];
        match found.body {
            RoutineBody::Ladder(_) => Some((self.cursor.unit.0, routine)),
            RoutineBody::StructuredText(_)
            | RoutineBody::FunctionBlock(_)
            | RoutineBody::SequentialChart(_)
            | RoutineBody::Encoded(_)
            | RoutineBody::Unknown(_) => {
                analysis.refuse_kind(found, name.span);
                None
            }
        }
    }

    /// The second operand: how many of the others are inputs.
    fn input_count(&self, analysis: &mut Analysis<'_>) -> Option<usize> {
        let Some(operand) = self.instruction.operands.get(1) else {
            return Some(0);
        };
        let literal = literal_of(operand).and_then(|literal| analysis.literal(literal));
        match literal {
            Some(Const::Integer { bits, .. }) => usize::try_from(bits).ok(),
            Some(Const::Float { .. }) | None => {
                let message = format!(
                    "the second operand of {} must be the number of inputs",
                    self.instruction.mnemonic.node
                );
                analysis.report(Diagnostic::new(Code::E2001, operand.span, message));
                None
            }
        }
    }

    /// Fits the values of a call to what the routine takes and gives. On the controller too few
    /// values are a major fault when the call happens; here the call is refused.
    fn fit(
        &self,
        analysis: &mut Analysis<'_>,
        pou: PouId,
        mut inputs: Vec<Operand>,
        returns: Vec<(Place, Elementary)>,
    ) -> Option<Action> {
        let signature = &self.cursor.signatures[pou.index()];
        let operands = self.instruction.operands.get(2..).unwrap_or_default();
        if inputs.len() < signature.parameters.len() {
            return self.misfit(
                analysis,
                format!(
                    "the routine takes {}, but {} passed",
                    count_of(signature.parameters.len(), "value"),
                    are(inputs.len())
                ),
            );
        }
        if returns.len() > signature.results.len() {
            return self.misfit(
                analysis,
                format!(
                    "the routine gives back {}, but {} expected",
                    count_of(signature.results.len(), "value"),
                    are(returns.len())
                ),
            );
        }
        let count = inputs.len();
        inputs.truncate(signature.parameters.len());
        let mut fits = true;
        for (index, (input, (_, ty))) in inputs.iter_mut().zip(&signature.parameters).enumerate() {
            match input {
                Operand::Const(constant) if ty.is_number() => *constant = retype(*constant, *ty),
                Operand::Const(_) | Operand::Place(..) => {
                    fits &= self.same(analysis, &operands[index], input.ty(), *ty);
                }
            }
        }
        for (index, ((_, to), (from, literal))) in
            returns.iter().zip(&signature.results).enumerate()
        {
            if !(*literal && to.is_number()) {
                fits &= self.same(analysis, &operands[count + index], *to, *from);
            }
        }
        fits.then_some(Action::Call {
            pou,
            inputs,
            returns,
        })
    }

    fn same(
        &self,
        analysis: &mut Analysis<'_>,
        operand: &rung::Operand,
        here: Elementary,
        there: Elementary,
    ) -> bool {
        if here != there {
            let message = format!(
                "this value is {}, but the routine has {} here",
                here.name(),
                there.name()
            );
            analysis.report(Diagnostic::new(Code::E5030, operand.span, message));
        }
        here == there
    }

    fn misfit(&self, analysis: &mut Analysis<'_>, message: String) -> Option<Action> {
        analysis.report(
            Diagnostic::new(Code::E5030, self.instruction.span, message)
                .note("SBR says what a routine takes, RET what it gives back"),
        );
        None
    }
}

/// A literal in the type of the value it is passed as.
fn retype(constant: Const, ty: Elementary) -> Const {
    match constant {
        Const::Integer { bits, ty: own } if ty.is_integer() => {
            let wide = if own.is_signed() {
                ((bits << (64 - own.bits())) as i64 >> (64 - own.bits())) as u64
            } else {
                bits
            };
            Const::Integer {
                ty,
                bits: wide & (u64::MAX >> (64 - ty.bits())),
            }
        }
        Const::Integer { .. } | Const::Float { .. } => constant,
    }
}
