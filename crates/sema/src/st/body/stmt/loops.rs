//! FOR, WHILE, REPEAT and what stands in them alone.

use crate::hir::code::{ExprId, ExprKind, StmtKind};
use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::lint::can_leave;
use crate::st::types::TypeId;
use iecc_ast::st::{self};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    pub(super) fn in_loop(
        &mut self,
        word: &str,
        kind: StmtKind,
        range: TextRange,
    ) -> Option<StmtKind> {
        if self.loops.is_empty() {
            self.error(
                Message::E3005,
                range,
                format!("{word} stands outside of a loop"),
            );
            return None;
        }
        Some(kind)
    }

    /// A condition that is evaluated again and again: what has to run before it becomes part of it.
    pub(super) fn loop_condition(&mut self, id: st::Id<st::Expr>) -> ExprId {
        let outer = std::mem::take(&mut self.pending);
        let operand = self.expr(id, Some(TypeId::BOOL));
        let value = self.condition(&operand);
        let inner = std::mem::replace(&mut self.pending, outer);
        if inner.is_empty() {
            return value;
        }
        let kind = ExprKind::After(inner, value);
        self.add_expr(kind, crate::hir::Elementary::Bool, operand.range)
    }

    /// A loop whose condition is always the one that repeats needs another way out.
    pub(super) fn must_end(
        &mut self,
        condition: ExprId,
        repeats: u64,
        written: st::Id<st::Expr>,
        body: st::Block,
    ) {
        let arena = self.arena();
        let constant = self.code.expr(condition).kind == ExprKind::Const(repeats);
        let broken = arena[written].kind == st::ExprKind::Error;
        if constant && !broken && !self.an.found.has_errors() && !can_leave(arena, body, false) {
            let message = "this loop never ends: its condition is constant, and nothing leaves it";
            self.error(Message::E3041, arena[written].range, message);
        }
    }

    pub(super) fn for_loop(
        &mut self,
        variable: st::Id<st::Expr>,
        from: st::Id<st::Expr>,
        to: st::Id<st::Expr>,
        by: Option<st::Id<st::Expr>>,
        body: st::Block,
        range: TextRange,
    ) -> Option<StmtKind> {
        let counter = self.place(variable, None);
        let el = self
            .an
            .types
            .elementary(counter.ty)
            .filter(|el| self.counts(*el));
        if el.is_none() && !counter.is_error() {
            let message = format!(
                "a loop counts in an integer, not {}",
                self.type_name(counter.ty)
            );
            self.error(Message::E3008, counter.range, message);
        }
        let ty = el.map_or(TypeId::ERROR, TypeId::of);
        let from = self.expr(from, Some(ty));
        let to = self.expr(to, Some(ty));
        let step = by.map(|by| self.expr(by, Some(ty)));
        let place = self.writable(&counter);
        let key = place
            .as_ref()
            .map(|place| (place.root, place.steps.clone()));
        if let Some(step) = &step
            && matches!(step.as_const(), Some(Const::Int(0)))
        {
            self.error(Message::E3009, step.range, "a step of 0 never ends");
        }
        let parts = place.zip(el).map(|(place, el)| {
            let (from, to) = (self.as_scalar(&from, ty), self.as_scalar(&to, ty));
            let by = match &step {
                Some(step) => self.loop_step(step, el),
                None => self.add_const(1, el.storage(), range),
            };
            (self.path_of(&place, counter.range), from, to, by)
        });
        self.loops.push(key);
        let body = self.block(body);
        self.loops.pop();
        let (variable, from, to, by) = parts?;
        Some(StmtKind::For {
            variable,
            from,
            to,
            by,
            body,
        })
    }

    fn loop_step(&mut self, step: &Operand, el: El) -> ExprId {
        self.as_scalar(step, TypeId::of(el))
    }
}
