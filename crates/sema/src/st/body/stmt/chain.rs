//! `a := b := value` (CODESYS): the last variable is assigned first, with the conversion that its type
//! needs, and what it holds then is assigned to the one before it.

use crate::st::body::Body;
use iecc_ast::st::{self, AssignOp, ExprKind as Written};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    pub(super) fn assign_all(
        &mut self,
        targets: st::List<st::Id<st::Expr>>,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) {
        let arena = self.arena();
        if arena[targets][1..].iter().any(|&target| self.calls(target)) {
            return;
        }
        let (mut value, before) = (value, self.an.found.len());
        for &target in arena[targets].iter().rev() {
            if self.an.found.len() == before {
                self.assign(target, AssignOp::Set, value, range);
            } else {
                // What is wrong with a value is told once.
                self.assign_target(target);
            }
            value = target;
        }
    }

    /// Whether a variable that is written and read again calls something, which would run twice; a
    /// message if it does.
    fn calls(&mut self, target: st::Id<st::Expr>) -> bool {
        let (arena, mut found) = (self.arena(), None);
        arena.each_expr_in(target, &mut |part| {
            if let Written::Call { .. } = arena[part].kind {
                found.get_or_insert(arena[part].range);
            }
        });
        let Some(range) = found else {
            return false;
        };
        let message = "a call in a variable that is assigned on the way is not compiled";
        let diagnostic = Diagnostic::new(Message::E8002, self.span(range), message);
        self.report(diagnostic.note("assign the variables one after the other"));
        true
    }
}
