//! Calls that may be skipped: because EN is FALSE, or because the instance or what an in-out is to stand
//! for is not there, being an element at a wrong subscript or behind NULL.
//!
//! What is not there is a fault. Where faults do not stop, the call is skipped as with EN = FALSE: no
//! argument is evaluated but the in-outs, nothing is stored, ENO is FALSE, and the value is the default of
//! its type. Instance and in-outs are looked for before anything else is evaluated.

use crate::hir::Elementary;
use crate::hir::code::{
    BinaryOp, Block, ExprId, ExprKind, Init, LocalId, PathStep, Root, StmtKind,
};
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::constant::Const;
use crate::st::signature::Var;
use crate::st::types::TypeId;
use iecc_ast::Symbol;
use iecc_ast::st::{Argument, SectionKind};
use iecc_source::TextRange;

/// What has to hold for a call to be made. Nothing is tested where all is there anyway.
#[derive(Debug, Default)]
pub(crate) struct Presence {
    /// Evaluates what the conditions need.
    before: Block,
    conditions: Vec<ExprId>,
}

impl Body<'_, '_> {
    /// A place for a call: what is computed on the way is evaluated once and first, and if the place might not
    /// be there, that becomes a condition.
    pub(crate) fn present(
        &mut self,
        mut place: Place,
        range: TextRange,
        presence: &mut Presence,
    ) -> Place {
        let (mut computed, mut in_doubt) = (false, false);
        each_test(&mut place, |checked| {
            computed = true;
            in_doubt |= !*checked;
        });
        if !computed {
            return place;
        }
        let outer = std::mem::replace(&mut self.pending, std::mem::take(&mut presence.before));
        self.freeze(&mut place, range);
        presence.before = std::mem::replace(&mut self.pending, outer);
        if in_doubt {
            let path = self.path_of(&place, range);
            let there = self.add_expr(ExprKind::Exists(path), Elementary::Bool, range);
            presence.conditions.push(there);
            each_test(&mut place, |checked| *checked = true);
        }
        place
    }

    /// In-outs of a call, by their names.
    pub(crate) fn present_in_outs(
        &mut self,
        matched: &[(Var, Argument)],
        presence: &mut Presence,
    ) -> Vec<(Symbol, Operand)> {
        let mut found = Vec::new();
        for (var, argument) in matched {
            let Some(value) = argument.value.filter(|_| var.section == SectionKind::InOut) else {
                continue;
            };
            let outer = std::mem::replace(&mut self.pending, std::mem::take(&mut presence.before));
            let mut operand = self.place(value, None);
            presence.before = std::mem::replace(&mut self.pending, outer);
            // What is only read may be a value, and reads as one.
            if let (OperandKind::Place(place), false) = (&operand.kind, var.constant) {
                let place = self.present(place.clone(), operand.range, presence);
                operand.kind = OperandKind::Place(place);
            }
            found.push((var.name, operand));
        }
        found
    }

    /// Subscripts and references are evaluated now, for several uses.
    fn freeze(&mut self, place: &mut Place, range: TextRange) {
        if let Root::Deref { address, .. } = &mut place.root {
            *address = self.freeze_value(*address, range);
        }
        for step in &mut place.steps {
            if let PathStep::IndexBy { value, .. } | PathStep::Character { value, .. } = step {
                *value = self.freeze_value(*value, range);
            }
        }
    }

    fn freeze_value(&mut self, value: ExprId, range: TextRange) -> ExprId {
        let ty = self.code.expr(value).ty;
        let local = self.add_local("index", crate::hir::Type::Elementary(ty));
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        self.before(StmtKind::Assign(path, value), range);
        self.load_local(local, ty, range)
    }

    fn load_local(&mut self, local: LocalId, ty: Elementary, range: TextRange) -> ExprId {
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        self.add_expr(ExprKind::Load(path), ty, range)
    }

    /// What `run` does, if all that it needs is there.
    pub(crate) fn if_present(
        &mut self,
        presence: Presence,
        eno: Option<Argument>,
        range: TextRange,
        run: impl FnOnce(&mut Self) -> Operand,
    ) -> Operand {
        let Presence { before, conditions } = presence;
        let all = conditions.into_iter().reduce(|all, next| {
            let both = ExprKind::Binary(BinaryOp::And, all, next);
            self.add_expr(both, Elementary::Bool, range)
        });
        if all.is_none() && before.is_empty() {
            return run(self);
        }
        let outer = std::mem::replace(&mut self.pending, before);
        let result = match all {
            Some(all) => self.call_if(all, eno, range, run),
            None => run(self),
        };
        let mut made = std::mem::replace(&mut self.pending, outer);
        // A number is computed where it is needed, as by other calls.
        let value = match &result.kind {
            OperandKind::Value(value) if !made.is_empty() => *value,
            OperandKind::Place(place) if all.is_some() && self.an.types.is_scalar(result.ty) => {
                let path = self.path_of(place, range);
                let ty = self.an.scalar(result.ty);
                self.add_expr(ExprKind::Load(path), ty, range)
            }
            OperandKind::Error
            | OperandKind::Const(_)
            | OperandKind::Value(_)
            | OperandKind::Place(_) => {
                self.pending.append(&mut made);
                return result;
            }
        };
        let ty = self.code.expr(value).ty;
        let value = self.add_expr(ExprKind::After(made, value), ty, range);
        Operand::value(value, result.ty, range)
    }

    /// What `run` does, only if a condition holds; else ENO of the call is FALSE, the value is the
    /// default of its type, and nothing happens.
    pub(crate) fn call_if(
        &mut self,
        condition: ExprId,
        eno: Option<Argument>,
        range: TextRange,
        run: impl FnOnce(&mut Self) -> Operand,
    ) -> Operand {
        let outer = std::mem::take(&mut self.pending);
        let result = run(self);
        let result = self.kept_result(result, range);
        let then = std::mem::take(&mut self.pending);
        if let OperandKind::Place(place) = &result.kind {
            let init = self.an.default_init(result.ty);
            let init = init.unwrap_or_else(|| self.an.init(Init::Zero));
            let path = self.path_of(place, range);
            self.before(StmtKind::Initialise(path, init), range);
        }
        if let Some(eno) = eno
            && let Some(target) = eno.value
        {
            let none = Operand::constant(Const::Int(0), TypeId::BOOL, range);
            self.output_to(none, target, &eno);
        }
        let otherwise = std::mem::replace(&mut self.pending, outer);
        let arms = vec![(condition, then)];
        self.before(StmtKind::If { arms, otherwise }, range);
        result
    }

    /// A result in a variable that is there whether the call was made or not.
    fn kept_result(&mut self, result: Operand, range: TextRange) -> Operand {
        if result.is_error() || result.ty == TypeId::NOTHING {
            return result;
        }
        if let OperandKind::Place(place) = &result.kind
            && place.rights == Rights::Temporary
            && matches!(place.root, Root::Local(_))
        {
            return result;
        }
        let ty = self.settle(&result);
        let place = self.temporary("result", ty);
        self.store(&place, ty, &result, range);
        Operand {
            kind: OperandKind::Place(place),
            ty,
            range,
        }
    }
}

/// What is computed on the way to a place, by whether it need not be tested.
fn each_test(place: &mut Place, mut f: impl FnMut(&mut bool)) {
    if let Root::Deref { checked, .. } = &mut place.root {
        f(checked);
    }
    for step in &mut place.steps {
        match step {
            PathStep::IndexBy { checked, .. } | PathStep::Character { checked, .. } => f(checked),
            PathStep::Field(_)
            | PathStep::Index(_)
            | PathStep::Bits { .. }
            | PathStep::Bytes { .. } => {}
        }
    }
}
