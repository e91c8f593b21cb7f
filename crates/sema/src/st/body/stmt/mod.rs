//! Statements as code. Operands that are computed before a statement stand before it, in the order
//! in which they are written.

mod assign;
mod case;
mod chain;
mod loops;

use crate::hir::code::{Block, Root, StmtKind};
use crate::st::body::Body;
use crate::st::signature::{PouId, Storage};
use crate::st::types::TypeId;
use iecc_ast::st::{self, SectionKind, StmtKind as Written};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// Initial values of what lives as long as the call, then the statements of the unit.
    pub(crate) fn statements_of(&mut self, id: PouId) {
        let mut body = Vec::new();
        self.initialise(id, &mut body);
        self.sample_edges(id, &mut body);
        if let Some(eno) = self.eno {
            let range = TextRange::default();
            let path = self.add_path(Root::Local(eno), Vec::new(), range);
            let value = self.add_const(1, crate::hir::Elementary::Bool, range);
            body.push(self.add_stmt(StmtKind::Assign(path, value), range));
        }
        self.mocked_result(id, &mut body);
        if let Some(written) = self.an.written_body(id) {
            body.extend(self.block(written));
        }
        self.code.body = body;
    }

    /// Variables that are made anew by every call get their initial values, the result included.
    fn initialise(&mut self, id: PouId, body: &mut Block) {
        let pou = self.an.pou(id).clone();
        for (index, var) in pou.vars.iter().enumerate() {
            let reset = match var.storage {
                Storage::Local => var.section != SectionKind::Input,
                Storage::Ref(_) => var.section == SectionKind::Output,
                Storage::Field(_)
                | Storage::Global(_)
                | Storage::Const(_)
                | Storage::Located(_) => false,
            };
            if !reset {
                continue;
            }
            let root = match (&var.storage, self.locals[index]) {
                (Storage::Ref(reference), _) => Root::Ref(*reference),
                (_, Some(local)) => Root::Local(local),
                (_, None) => continue,
            };
            match var.initial {
                Some(initial) if self.an.is_address(var.ty) => {
                    self.start_reference(root, var, initial, body);
                }
                _ => {
                    let init = self.own_init(var);
                    self.start(root, init, var.range, body);
                }
            }
        }
        let result = self
            .result
            .map(Root::Local)
            .or(self.result_ref.map(Root::Ref));
        if let (Some(root), Some(ty)) = (result, pou.result) {
            let init = self.an.default_init(ty);
            self.start(root, init, TextRange::default(), body);
        }
    }

    /// Locals are 0 at the start; what is passed by reference is not.
    fn start(
        &mut self,
        root: Root,
        init: Option<crate::hir::InitId>,
        range: TextRange,
        body: &mut Block,
    ) {
        let init = match (root, init) {
            (Root::Ref(_), None) => self.an.init(crate::hir::code::Init::Zero),
            (_, None) => return,
            (_, Some(init)) => init,
        };
        let path = self.add_path(root, Vec::new(), range);
        body.push(self.add_stmt(StmtKind::Initialise(path, init), range));
    }

    /// Statements, with what has to run before each of them.
    pub(crate) fn block(&mut self, block: st::Block) -> Block {
        let mut statements = Vec::with_capacity(block.len());
        for &stmt in &self.arena()[block] {
            let outer = std::mem::take(&mut self.pending);
            let made = self.statement(stmt);
            statements.append(&mut self.pending);
            self.pending = outer;
            if let Some(kind) = made {
                let range = self.arena()[stmt].range;
                statements.push(self.add_stmt(kind, range));
            }
        }
        statements
    }

    fn statement(&mut self, id: st::Id<st::Stmt>) -> Option<StmtKind> {
        let arena = self.arena();
        let range = arena[id].range;
        match arena[id].kind {
            Written::Assign { target, op, value } => {
                self.assign(target, op, value, range);
                None
            }
            Written::AssignAll { targets, value } => {
                self.assign_all(targets, value, range);
                None
            }
            Written::Call(call) => {
                self.call_statement(call);
                None
            }
            Written::If { arms, otherwise } => Some(self.if_statement(arms, otherwise)),
            Written::Case {
                selector,
                arms,
                otherwise,
            } => self.case(selector, arms, otherwise),
            Written::For {
                variable,
                from,
                to,
                by,
                body,
            } => self.for_loop(variable, from, to, by, body, range),
            Written::While { condition, body } => {
                let value = self.loop_condition(condition);
                self.must_end(value, 1, condition, body);
                self.loops.push(None);
                let body = self.block(body);
                self.loops.pop();
                Some(StmtKind::While(value, body))
            }
            Written::Repeat { body, until } => {
                self.loops.push(None);
                let made = self.block(body);
                self.loops.pop();
                let value = self.loop_condition(until);
                self.must_end(value, 0, until, body);
                Some(StmtKind::Repeat(made, value))
            }
            Written::Return => Some(StmtKind::Return),
            Written::Mock(instance) => {
                self.mock(instance, range);
                None
            }
            Written::MockFunction { function, value } => {
                self.mock_function(function, value, range);
                None
            }
            Written::Exit => self.in_loop("EXIT", StmtKind::Exit, range),
            Written::Continue => self.in_loop("CONTINUE", StmtKind::Continue, range),
            Written::Empty | Written::Error => None,
        }
    }

    fn if_statement(
        &mut self,
        arms: st::List<st::IfArm>,
        otherwise: Option<st::Block>,
    ) -> StmtKind {
        let mut made = Vec::with_capacity(arms.len());
        for (index, arm) in self.arena()[arms].iter().enumerate() {
            // Only the first condition is evaluated in any case.
            let condition = if index == 0 {
                let operand = self.expr(arm.condition, Some(TypeId::BOOL));
                self.condition(&operand)
            } else {
                self.loop_condition(arm.condition)
            };
            made.push((condition, self.block(arm.body)));
        }
        StmtKind::If {
            arms: made,
            otherwise: otherwise.map_or_else(Vec::new, |block| self.block(block)),
        }
    }
}
