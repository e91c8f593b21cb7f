//! Statements that no run reaches, and functions that never give their result.

use super::is_abstract;
use crate::st::analysis::Analysis;
use crate::st::signature::{Part, PouId};
use iecc_ast::st::{self, ExprKind, StmtKind};
use iecc_diag::Code;

impl Analysis<'_> {
    /// Warns of the first statement behind one that always leaves.
    pub(super) fn unreached(&mut self, id: PouId, body: st::Block) {
        let unit = self.pou(id).unit;
        let arena = &self.unit(unit).arena;
        let mut found = Vec::new();
        leaves(arena, body, &mut found);
        for stmt in found {
            let range = arena[stmt].range;
            let text = "this statement is never reached".to_owned();
            self.warning(unit, Code::E3051, range, text);
        }
    }

    /// Warns of a function whose body does not name its result.
    pub(super) fn result_never_given(&mut self, id: PouId) {
        let pou = self.pou(id);
        if pou.result.is_none() || is_abstract(pou) || matches!(pou.part, Part::Setter(_)) {
            return;
        }
        let (unit, name, span) = (pou.unit, pou.result_name, pou.span);
        let arena = &self.unit(unit).arena;
        let named = |expr: &st::Expr| expr.kind == ExprKind::Name(name);
        if arena.all::<st::Expr>().iter().any(named) {
            return;
        }
        let text = format!(
            "`{}` never gets a value: the result is the default of its type",
            self.text(name)
        );
        self.warn(iecc_diag::Diagnostic::new(Code::E3052, span, text));
    }
}

/// Whether a block never goes on behind its end. Collects what stands behind such statements.
fn leaves(arena: &st::Arena, block: st::Block, found: &mut Vec<st::Id<st::Stmt>>) -> bool {
    let mut left = false;
    for &stmt in &arena[block] {
        if left && arena[stmt].kind != StmtKind::Empty {
            found.push(stmt);
            return true;
        }
        left |= statement_leaves(arena, stmt, found);
    }
    left
}

fn statement_leaves(
    arena: &st::Arena,
    stmt: st::Id<st::Stmt>,
    found: &mut Vec<st::Id<st::Stmt>>,
) -> bool {
    match arena[stmt].kind {
        StmtKind::Return | StmtKind::Exit | StmtKind::Continue => true,
        StmtKind::If { otherwise, .. } | StmtKind::Case { otherwise, .. } => {
            let mut all = otherwise.is_some();
            arena.each_block_of(stmt, |block| all &= leaves(arena, block, found));
            all
        }
        StmtKind::For { body, .. }
        | StmtKind::While { body, .. }
        | StmtKind::Repeat { body, .. } => {
            leaves(arena, body, found);
            false
        }
        StmtKind::Assign { .. }
        | StmtKind::AssignAll { .. }
        | StmtKind::Call(_)
        | StmtKind::Mock(_)
        | StmtKind::MockFunction { .. }
        | StmtKind::Empty
        | StmtKind::Error => false,
    }
}

/// Whether a loop body can leave its loop by itself: EXIT that belongs to it, or RETURN.
pub(in crate::st) fn can_leave(arena: &st::Arena, block: st::Block, inner: bool) -> bool {
    arena[block].iter().any(|&stmt| match arena[stmt].kind {
        StmtKind::Return => true,
        StmtKind::Exit => !inner,
        StmtKind::If { .. } | StmtKind::Case { .. } => {
            let mut any = false;
            arena.each_block_of(stmt, |block| any |= can_leave(arena, block, inner));
            any
        }
        StmtKind::For { body, .. }
        | StmtKind::While { body, .. }
        | StmtKind::Repeat { body, .. } => can_leave(arena, body, true),
        StmtKind::Assign { .. }
        | StmtKind::AssignAll { .. }
        | StmtKind::Call(_)
        | StmtKind::Mock(_)
        | StmtKind::MockFunction { .. }
        | StmtKind::Continue
        | StmtKind::Empty
        | StmtKind::Error => false,
    })
}
