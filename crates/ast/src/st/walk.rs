//! The children of nodes, for whoever looks at all nodes of a kind.

use super::{Arena, Argument, Block, Expr, ExprKind, Id, Stmt, StmtKind};

impl Arena {
    /// Calls `visit` with each expression that is directly part of an expression, in the order of
    /// the text.
    pub fn each_operand(&self, expr: Id<Expr>, mut visit: impl FnMut(Id<Expr>)) {
        match self[expr].kind {
            ExprKind::Literal(_)
            | ExprKind::Name(_)
            | ExprKind::Direct(_)
            | ExprKind::This
            | ExprKind::Super
            | ExprKind::Null
            | ExprKind::Error => {}
            ExprKind::Member { base: one, .. }
            | ExprKind::Part { base: one, .. }
            | ExprKind::Deref(one)
            | ExprKind::Ref(one)
            | ExprKind::Unary { operand: one, .. } => visit(one),
            ExprKind::Typed {
                ty: one,
                value: other,
            }
            | ExprKind::Binary {
                left: one,
                right: other,
                ..
            } => [one, other].into_iter().for_each(visit),
            ExprKind::Index {
                base: one,
                indices: others,
            }
            | ExprKind::Repeat {
                count: one,
                values: others,
            } => {
                visit(one);
                self[others].iter().copied().for_each(visit);
            }
            ExprKind::ArrayValue(others) => self[others].iter().copied().for_each(visit),
            ExprKind::Call { callee, arguments } => {
                visit(callee);
                self.each_value(&self[arguments], visit);
            }
            ExprKind::StructValue(arguments) => self.each_value(&self[arguments], visit),
        }
    }

    fn each_value(&self, arguments: &[Argument], visit: impl FnMut(Id<Expr>)) {
        arguments
            .iter()
            .filter_map(|argument| argument.value)
            .for_each(visit);
    }

    /// Calls `visit` with an expression and all that it is made of, each before its parts.
    pub fn each_expr_in(&self, expr: Id<Expr>, visit: &mut dyn FnMut(Id<Expr>)) {
        visit(expr);
        self.each_operand(expr, |operand| self.each_expr_in(operand, visit));
    }

    /// Calls `visit` with each expression that is directly part of a statement, those of its blocks
    /// left aside.
    pub fn each_expr_of(&self, stmt: Id<Stmt>, mut visit: impl FnMut(Id<Expr>)) {
        match self[stmt].kind {
            StmtKind::Assign { target, value, .. }
            | StmtKind::MockFunction {
                function: target,
                value,
            } => [target, value].into_iter().for_each(visit),
            StmtKind::AssignAll { targets, value } => {
                self[targets].iter().copied().for_each(&mut visit);
                visit(value);
            }
            StmtKind::Call(expr)
            | StmtKind::Mock(expr)
            | StmtKind::While {
                condition: expr, ..
            }
            | StmtKind::Repeat { until: expr, .. } => visit(expr),
            StmtKind::If { arms, .. } => {
                let conditions = self[arms].iter().map(|arm| arm.condition);
                conditions.for_each(visit);
            }
            StmtKind::Case { selector, arms, .. } => {
                visit(selector);
                for arm in &self[arms] {
                    for label in &self[arm.labels] {
                        visit(label.low);
                        label.high.into_iter().for_each(&mut visit);
                    }
                }
            }
            StmtKind::For {
                variable,
                from,
                to,
                by,
                ..
            } => [variable, from, to].into_iter().chain(by).for_each(visit),
            StmtKind::Return
            | StmtKind::Exit
            | StmtKind::Continue
            | StmtKind::Empty
            | StmtKind::Error => {}
        }
    }

    /// Calls `visit` with each block of a statement, in the order of the text.
    pub fn each_block_of(&self, stmt: Id<Stmt>, mut visit: impl FnMut(Block)) {
        match self[stmt].kind {
            StmtKind::If { arms, otherwise } => {
                self[arms].iter().for_each(|arm| visit(arm.body));
                otherwise.into_iter().for_each(visit);
            }
            StmtKind::Case {
                arms, otherwise, ..
            } => {
                self[arms].iter().for_each(|arm| visit(arm.body));
                otherwise.into_iter().for_each(visit);
            }
            StmtKind::For { body, .. }
            | StmtKind::While { body, .. }
            | StmtKind::Repeat { body, .. } => visit(body),
            StmtKind::Assign { .. }
            | StmtKind::AssignAll { .. }
            | StmtKind::Call(_)
            | StmtKind::Mock(_)
            | StmtKind::MockFunction { .. }
            | StmtKind::Return
            | StmtKind::Exit
            | StmtKind::Continue
            | StmtKind::Empty
            | StmtKind::Error => {}
        }
    }

    /// Calls `visit` with every statement of a block and of the blocks in it, each before its parts.
    pub fn each_stmt_in(&self, block: Block, visit: &mut dyn FnMut(Id<Stmt>)) {
        for &stmt in &self[block] {
            visit(stmt);
            self.each_block_of(stmt, |inner| self.each_stmt_in(inner, visit));
        }
    }
}
