//! Variables of one activation that are read where nothing can have assigned them. Only what is
//! certain is said: a variable counts as assigned from the first statement in the order of the
//! text that may assign it, loops taken as a whole.

use super::root;
use crate::st::analysis::Analysis;
use crate::st::signature::{Part, PouId, Storage, Var};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, ExprKind, PouKind, SectionKind, StmtKind};
use iecc_diag::Code;
use rustc_hash::FxHashSet;

/// What is known on the way through a body.
struct Walk<'a> {
    arena: &'a st::Arena,
    /// Not assigned so far, whatever the way here.
    open: FxHashSet<Symbol>,
    found: Vec<(Symbol, iecc_source::TextRange)>,
}

impl Analysis<'_> {
    /// Warns of the first read of each such variable.
    pub(super) fn read_before_assignment(&mut self, id: PouId, body: st::Block) {
        let pou = self.pou(id);
        let function = pou.kind == PouKind::Function || pou.part != Part::Whole;
        let candidates = pou
            .vars
            .iter()
            .filter(|var| self.starts_open(var, function));
        let open: FxHashSet<Symbol> = candidates.map(|var| var.name).collect();
        if open.is_empty() {
            return;
        }
        let unit = pou.unit;
        let arena = &self.unit(unit).arena;
        let mut walk = Walk {
            arena,
            open,
            found: Vec::new(),
        };
        walk.block(body);
        for (name, range) in walk.found {
            let text = format!(
                "`{}` is read before anything is assigned to it",
                self.text(name)
            );
            self.warning(unit, Code::E3056, range, text);
        }
    }

    fn starts_open(&self, var: &Var, function: bool) -> bool {
        let section = match var.section {
            SectionKind::Temp => true,
            SectionKind::Var => function,
            SectionKind::Input
            | SectionKind::Output
            | SectionKind::InOut
            | SectionKind::External
            | SectionKind::Global
            | SectionKind::Access
            | SectionKind::Config
            | SectionKind::Static
            | SectionKind::Instance => false,
        };
        let scalar = self.types.elementary(var.ty).is_some();
        section && scalar && var.initial.is_none() && var.storage == Storage::Local
    }
}

impl Walk<'_> {
    fn block(&mut self, block: st::Block) {
        for &stmt in &self.arena[block] {
            self.statement(stmt);
        }
    }

    fn statement(&mut self, stmt: st::Id<st::Stmt>) {
        match self.arena[stmt].kind {
            StmtKind::Assign { target, value, .. } => {
                self.read(value);
                self.assign(target);
            }
            StmtKind::AssignAll { targets, value } => {
                self.read(value);
                let targets = &self.arena[targets];
                targets.iter().for_each(|target| self.assign(*target));
            }
            StmtKind::For {
                variable,
                from,
                to,
                by,
                body,
            } => {
                [from, to]
                    .into_iter()
                    .chain(by)
                    .for_each(|expr| self.read(expr));
                self.assign(variable);
                self.assigned_in(body);
                self.block(body);
            }
            StmtKind::While { condition, body } => {
                self.assigned_in(body);
                self.read(condition);
                self.block(body);
            }
            StmtKind::Repeat { body, until } => {
                self.assigned_in(body);
                self.block(body);
                self.read(until);
            }
            StmtKind::If { .. }
            | StmtKind::Case { .. }
            | StmtKind::Call(_)
            | StmtKind::Mock(_)
            | StmtKind::MockFunction { .. } => {
                let arena = self.arena;
                arena.each_expr_of(stmt, |expr| self.read(expr));
                self.branches(stmt);
            }
            StmtKind::Return
            | StmtKind::Exit
            | StmtKind::Continue
            | StmtKind::Empty
            | StmtKind::Error => {}
        }
    }

    /// Each branch begins with what was open before; behind them is open what is open in all.
    fn branches(&mut self, stmt: st::Id<st::Stmt>) {
        let arena = self.arena;
        arena.each_block_of(stmt, |block| self.block(block));
    }

    /// What a loop assigns somewhere may be assigned from its second pass on.
    fn assigned_in(&mut self, body: st::Block) {
        let arena = self.arena;
        let mut stmts = Vec::new();
        arena.each_stmt_in(body, &mut |stmt| stmts.push(stmt));
        for stmt in stmts {
            if let StmtKind::AssignAll { targets, .. } = arena[stmt].kind {
                arena[targets]
                    .iter()
                    .for_each(|target| self.assign(*target));
            }
            if let StmtKind::Assign { target, .. }
            | StmtKind::For {
                variable: target, ..
            } = arena[stmt].kind
            {
                self.assign(target);
            }
            arena.each_expr_of(stmt, |expr| {
                arena.each_expr_in(expr, &mut |part| self.assigned_by(part));
            });
        }
    }

    fn assign(&mut self, target: st::Id<st::Expr>) {
        if let Some(name) = root(self.arena, target) {
            self.open.remove(&name);
        }
        let arena = self.arena;
        if !matches!(arena[target].kind, ExprKind::Name(_)) {
            arena.each_operand(target, |part| self.read(part));
        }
    }

    /// Calls may change what they are given, and a reference lets anybody.
    fn assigned_by(&mut self, expr: st::Id<st::Expr>) {
        let written = self.arena[expr].kind;
        if let ExprKind::Call { arguments, .. } = written {
            for argument in &self.arena[arguments] {
                self.passed(*argument);
            }
        }
        if let ExprKind::Ref(inner) = written {
            self.assign(inner);
        }
    }

    fn passed(&mut self, argument: Argument) {
        match argument.kind {
            ArgumentKind::Positional
            | ArgumentKind::Input(_)
            | ArgumentKind::Output(_)
            | ArgumentKind::NegatedOutput(_) => {
                if let Some(name) = argument.value.and_then(|value| root(self.arena, value)) {
                    self.open.remove(&name);
                }
            }
        }
    }

    fn read(&mut self, expr: st::Id<st::Expr>) {
        self.assigned_by(expr);
        if let ExprKind::Name(name) = self.arena[expr].kind
            && self.open.remove(&name)
        {
            self.found.push((name, self.arena[expr].range));
        }
        let arena = self.arena;
        arena.each_operand(expr, |part| self.read(part));
    }
}
