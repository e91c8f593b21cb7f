//! Statements as they are reduced, and expressions that stand where a statement should.

use super::{Build, CaseItem};
use iecc_ast::st::{
    AssignOp, BinaryOp, Block, CaseArm, Expr, ExprKind, Id, IfArm, Label, MAX_BLOCK_DEPTH, Stmt,
    StmtKind,
};
use iecc_diag::{Code, Diagnostic};

impl Build<'_, '_> {
    pub(crate) fn statement(&mut self, start: u32, kind: StmtKind, end: u32) -> Id<Stmt> {
        let range = self.range(start, end);
        let depth = 1;
        let stmt = self.arena.add(Stmt { kind, range, depth });
        let depth = self.deepest_in(stmt) + 1;
        self.arena[stmt].depth = depth;
        if depth > MAX_BLOCK_DEPTH {
            self.too_deep("statements", MAX_BLOCK_DEPTH, range);
            self.arena[stmt].kind = StmtKind::Error;
            self.arena[stmt].depth = 1;
        }
        stmt
    }

    fn deepest_in(&self, stmt: Id<Stmt>) -> u16 {
        let mut deepest = 0;
        self.arena.each_block_of(stmt, |block| {
            let depths = self.arena[block]
                .iter()
                .map(|&inner| self.arena[inner].depth);
            deepest = depths.fold(deepest, u16::max);
        });
        deepest
    }

    pub(crate) fn assignment(
        &mut self,
        start: u32,
        target: Id<Expr>,
        op: AssignOp,
        value: Id<Expr>,
        end: u32,
    ) -> Id<Stmt> {
        let kind = if self.is_unbalanced(start, end) {
            StmtKind::Error
        } else if self.is_path(target) {
            StmtKind::Assign { target, op, value }
        } else {
            self.no_target(target);
            StmtKind::Error
        };
        self.statement(start, kind, end)
    }

    /// `target := … := value;`, the further targets in reverse.
    pub(crate) fn assignments(
        &mut self,
        start: u32,
        target: Id<Expr>,
        (mut targets, value): (Vec<Id<Expr>>, Id<Expr>),
        end: u32,
    ) -> Id<Stmt> {
        targets.push(target);
        targets.reverse();
        let kind = match targets.iter().find(|target| !self.is_path(**target)) {
            None => StmtKind::AssignAll {
                targets: self.arena.list(targets),
                value,
            },
            Some(&wrong) => {
                self.no_target(wrong);
                StmtKind::Error
            }
        };
        self.statement(start, kind, end)
    }

    /// Whether an expression is a path rather than something with operators. What it leads to is
    /// not known here.
    fn is_path(&self, expr: Id<Expr>) -> bool {
        // A chain that begins with a path is a path or has an operator.
        !matches!(self.arena[expr].kind, ExprKind::Binary { .. })
    }

    fn no_target(&mut self, target: Id<Expr>) {
        let span = self.span_of(self.arena[target].range);
        let diagnostic = Diagnostic::new(Code::E0029, span, "a value cannot be assigned to this")
            .label("expected a variable");
        self.report(diagnostic);
    }

    /// `inst(…);`, or an expression that does nothing.
    /// A condition, or a selector.
    pub(crate) fn condition(&mut self, start: u32, expr: Id<Expr>, end: u32) -> Id<Expr> {
        if self.is_unbalanced(start, end) {
            return self.expr(start, ExprKind::Error, end);
        }
        expr
    }

    pub(crate) fn expression_statement(
        &mut self,
        start: u32,
        expr: Id<Expr>,
        end: u32,
    ) -> Id<Stmt> {
        let kind = if self.is_unbalanced(start, end) {
            StmtKind::Error
        } else if self.is_path(expr) {
            StmtKind::Call(expr)
        } else {
            self.value_as_statement(expr);
            StmtKind::Error
        };
        self.statement(start, kind, end)
    }

    fn value_as_statement(&mut self, expr: Id<Expr>) {
        let node = self.arena[expr];
        let span = self.span_of(node.range);
        let diagnostic = if let ExprKind::Binary {
            op: BinaryOp::Equal,
            op_start,
            left,
            ..
        } = node.kind
            && self.is_path(left)
        {
            let op = self.span(op_start + self.base, op_start + self.base + 1);
            Diagnostic::new(Code::E0028, op, "`=` compares, it does not assign")
                .label("expected `:=`")
                .also(span, "the result of this comparison is not used")
                .fix("assign with `:=`", op, ":=")
        } else {
            let message = "the value of this expression is not used";
            Diagnostic::new(Code::E0028, span, message).label("expected a statement")
        };
        self.report(diagnostic);
    }

    pub(crate) fn if_arm(
        &mut self,
        start: u32,
        condition: Id<Expr>,
        body: Vec<Id<Stmt>>,
        end: u32,
    ) -> IfArm {
        IfArm {
            condition,
            body: self.arena.list(body),
            range: self.range(start, end),
        }
    }

    pub(crate) fn if_statement(
        &mut self,
        first: IfArm,
        rest: Vec<IfArm>,
        otherwise: Option<Block>,
    ) -> StmtKind {
        let arms = self.arena.list(std::iter::once(first).chain(rest));
        StmtKind::If { arms, otherwise }
    }

    pub(crate) fn for_statement(
        &mut self,
        variable: Id<Expr>,
        from: Id<Expr>,
        to: Id<Expr>,
        by: Option<Id<Expr>>,
        body: Vec<Id<Stmt>>,
    ) -> StmtKind {
        let body = self.arena.list(body);
        StmtKind::For {
            variable,
            from,
            to,
            by,
            body,
        }
    }

    pub(crate) fn damaged_for(&mut self, start: u32, end: u32, body: Vec<Id<Stmt>>) -> StmtKind {
        let error = self.expr(start, ExprKind::Error, end);
        self.for_statement(error, error, error, None, body)
    }

    /// Groups labels with the statements behind them. Statements before the first label have no
    /// place; a message says so.
    pub(crate) fn case_statement(
        &mut self,
        selector: Id<Expr>,
        items: Vec<CaseItem>,
        otherwise: Option<Block>,
    ) -> StmtKind {
        let mut arms: Vec<CaseArm> = Vec::new();
        let mut body = Vec::new();
        let mut labels: Option<(u32, Vec<Label>)> = None;
        for item in items {
            match item {
                CaseItem::Labels(start, next) => {
                    self.close_arm(&mut arms, labels.take(), std::mem::take(&mut body));
                    labels = Some((start, next));
                }
                CaseItem::Statement(statement) => body.push(statement),
            }
        }
        self.close_arm(&mut arms, labels, body);
        let arms = self.arena.list(arms);
        StmtKind::Case {
            selector,
            arms,
            otherwise,
        }
    }

    fn close_arm(
        &mut self,
        arms: &mut Vec<CaseArm>,
        labels: Option<(u32, Vec<Label>)>,
        body: Vec<Id<Stmt>>,
    ) {
        let Some((start, labels)) = labels else {
            return self.statements_before_label(&body);
        };
        let start = self.range(start, start);
        let end = body.last().map_or(start, |&last| self.arena[last].range);
        let arm = CaseArm {
            labels: self.arena.list(labels),
            body: self.arena.list(body),
            range: start.to(end),
        };
        arms.push(arm);
    }

    fn statements_before_label(&mut self, body: &[Id<Stmt>]) {
        let statement =
            |stmt: &Id<Stmt>| !matches!(self.arena[*stmt].kind, StmtKind::Empty | StmtKind::Error);
        let Some(&first) = body.iter().find(|stmt| statement(stmt)) else {
            return;
        };
        let span = self.span_of(self.arena[first].range);
        let diagnostic = Diagnostic::new(
            Code::E0010,
            span,
            "a statement stands before the first label of CASE",
        )
        .label("expected a value and `:`");
        self.report(diagnostic);
    }
}
