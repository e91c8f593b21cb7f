//! Calls of blocks: inputs are stored in the instance, the body runs, outputs are fetched.

use super::presence::Presence;
use crate::hir::code::{Call, ExprKind, PathId, PathStep, StmtKind};
use crate::st::body::object::Target;
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::constant::Const;
use crate::st::signature::{PouId, Storage, Var};
use crate::st::types::TypeId;
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, Direction, SectionKind};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// `instance(input := …, output => …)`.
    pub(crate) fn block_call(
        &mut self,
        pou: PouId,
        place: Place,
        arguments: st::List<Argument>,
        range: TextRange,
    ) {
        self.an.complete(pou);
        let Some(pou) = self.open_instance(pou, arguments, range) else {
            return;
        };
        let mut presence = Presence::default();
        let place = self.present(place, range, &mut presence);
        let matched = self.matched(pou, arguments, range);
        let in_outs = self.present_in_outs(&matched, &mut presence);
        let eno = self.eno_target(arguments);
        self.if_present(presence, eno, range, |body| {
            body.present_block_call(pou, &place, &matched, &in_outs, eno, range);
            Operand::nothing(range)
        });
    }

    /// A call of an instance that is there, with in-outs that are.
    fn present_block_call(
        &mut self,
        pou: PouId,
        place: &Place,
        matched: &[(Var, Argument)],
        in_outs: &[(Symbol, Operand)],
        eno: Option<Argument>,
        range: TextRange,
    ) {
        let refs = self.block_arguments(pou, place, matched, in_outs);
        self.require_in_outs(pou, matched, range);
        let run = self.run(pou, place, None, pou, range);
        let target = Target {
            signature: pou,
            run,
            presence: Presence::default(),
        };
        let eno_place = eno.map(|_| self.temporary("ENO", TypeId::BOOL));
        let mut changes_eno = false;
        if let Some(refs) = refs {
            changes_eno = self.shape_of(&target).eno;
            let changed = eno_place.as_ref().filter(|_| changes_eno);
            self.run_block(&target, place, refs, changed, range);
        }
        for (var, argument) in matched {
            if var.section == SectionKind::Output {
                self.block_output(pou, place, var, argument);
            }
        }
        if let (Some(eno), Some(place)) = (eno, eno_place) {
            self.eno_to(changes_eno, place, &eno);
        }
    }

    /// Stores the inputs, and gives what the in-outs stand for; `None` after a mistake in them.
    fn block_arguments(
        &mut self,
        pou: PouId,
        place: &Place,
        matched: &[(Var, Argument)],
        in_outs: &[(Symbol, Operand)],
    ) -> Option<Vec<PathId>> {
        let shape = self.an.call_shape(pou);
        let mut refs: Vec<Option<PathId>> = vec![None; shape.refs.len()];
        for (var, argument) in matched {
            let Some(value) = argument.value else {
                continue;
            };
            match var.section.direction() {
                Some(Direction::In) => self.block_input(pou, place, var, value),
                Some(Direction::InOut) => {
                    let found = in_outs.iter().find(|(name, _)| *name == var.name);
                    let (_, operand) = found.expect("in-outs were looked for");
                    let path = self.reference_argument(var, operand);
                    if let (Storage::Ref(position), Some(path)) = (&var.storage, path) {
                        refs[*position as usize - 1] = Some(path);
                    }
                }
                Some(Direction::Out) | None => {}
            }
        }
        refs.into_iter().collect()
    }

    /// Runs the body of an instance, unless the instance is mocked. `eno` is where its ENO goes.
    fn run_block(
        &mut self,
        target: &Target,
        place: &Place,
        in_outs: Vec<PathId>,
        eno: Option<&Place>,
        range: TextRange,
    ) {
        let callee = self.run_unit(target);
        let (mut refs, args) = self.receiver(target, range);
        refs.extend(in_outs);
        let outputs = eno.map(|eno| (0, self.path_of(eno, range)));
        let call = self.add_call(Call {
            callee,
            refs,
            args,
            outputs: outputs.into_iter().collect(),
        });
        let value = self.add_expr(ExprKind::Call(call), crate::hir::Elementary::Bool, range);
        let call = self.add_stmt(StmtKind::Eval(value), range);
        let call = self.unless_mocked(target.signature, place, call, eno, range);
        self.pending.push(call);
    }

    /// Stores the ENO of a call; it is TRUE where the body does not change it.
    pub(crate) fn eno_to(&mut self, changes: bool, place: Place, argument: &Argument) {
        let value = if changes {
            Operand {
                kind: OperandKind::Place(place),
                ty: TypeId::BOOL,
                range: argument.range,
            }
        } else {
            Operand::constant(Const::Int(1), TypeId::BOOL, argument.range)
        };
        if let Some(target) = argument.value {
            self.output_to(value, target, argument);
        }
    }

    fn block_input(&mut self, pou: PouId, place: &Place, var: &Var, value: st::Id<st::Expr>) {
        let operand = self.expr(value, Some(var.ty));
        let Some(steps) = self.field_steps(pou, place, var) else {
            return;
        };
        let target = Place {
            root: place.root,
            steps,
            rights: Rights::All,
        };
        self.store(&target, var.ty, &operand, operand.range);
    }

    /// The steps to a variable of an instance or of what it extends.
    fn field_steps(&self, pou: PouId, place: &Place, var: &Var) -> Option<Vec<PathStep>> {
        let Storage::Field(field) = var.storage else {
            return None;
        };
        let (of, _) = self.an.instance_var(pou, var.name)?;
        let mut steps = place.steps.clone();
        let distance = self.an.base_distance(pou, of).unwrap_or(0);
        steps.extend(std::iter::repeat_n(PathStep::Field(0), distance));
        steps.push(PathStep::Field(field));
        Some(steps)
    }

    fn block_output(&mut self, pou: PouId, place: &Place, var: &Var, argument: &Argument) {
        let Some(target) = argument.value else { return };
        let Some(steps) = self.field_steps(pou, place, var) else {
            return;
        };
        let from = Operand {
            kind: OperandKind::Place(Place {
                root: place.root,
                steps,
                rights: Rights::OtherOutput,
            }),
            ty: var.ty,
            range: argument.range,
        };
        self.output_to(from, target, argument);
    }

    /// Stores an output where `=>` points.
    pub(crate) fn output_to(
        &mut self,
        from: Operand,
        target: st::Id<st::Expr>,
        argument: &Argument,
    ) {
        let target = self.place(target, None);
        let Some(to) = self.writable(&target) else {
            return;
        };
        let from = if matches!(argument.kind, ArgumentKind::NegatedOutput(_)) {
            self.unary_on(st::UnaryOp::Not, from, argument.range, None)
        } else {
            from
        };
        self.store(&to, target.ty, &from, argument.range);
    }

    /// The place an in-out stands for.
    pub(crate) fn in_out(&mut self, var: &Var, value: st::Id<st::Expr>) -> Option<PathId> {
        let operand = self.place(value, None);
        self.reference_argument(var, &operand)
    }
}
