//! Statements to blocks: what is behind a jump out of a loop or of the body is left out.

use super::expr::number;
use super::{Loop, Unit};
use crate::types::scalar;
use crate::values;
use iecc_ir::{BinaryOp, Block as IrBlock, Value};
use iecc_sema::hir::code::{Block, ExprId, PathId, StmtId, StmtKind};
use iecc_sema::hir::{self, CompareOp, Elementary};

/// Values of a range, and of all ranges of a CASE, that become numbers of a `switch`; what is beyond
/// is compared.
const SWITCH_RANGE: i128 = 64;
const SWITCH_TOTAL: usize = 1024;

type Arm = (Vec<(u64, u64)>, Block);

impl<'p> Unit<'_, 'p> {
    pub(super) fn stmt(&mut self, id: StmtId) {
        let stmt = self.code.stmt(id);
        self.at(stmt.span);
        match &stmt.kind {
            StmtKind::Assign(to, value) => {
                let value = self.expr(*value);
                let to = self.locate(*to);
                self.put(to, value);
            }
            StmtKind::Copy(to, from) => self.copy(*to, *from),
            StmtKind::Initialise(to, init) => {
                let to = self.locate(*to);
                self.initialise(&to, *init);
            }
            StmtKind::Eval(expr) => self.effects(*expr),
            StmtKind::If { arms, otherwise } => self.branch(arms, otherwise),
            StmtKind::Case {
                selector,
                arms,
                otherwise,
            } => self.case(*selector, arms, otherwise),
            StmtKind::For {
                variable,
                from,
                to,
                by,
                body,
            } => self.count(*variable, [*from, *to, *by], body, stmt.span),
            StmtKind::While(condition, body) => self.repeat_while(*condition, body, stmt.span),
            StmtKind::Repeat(body, condition) => self.repeat_until(body, *condition, stmt.span),
            StmtKind::Exit => {
                let Loop { behind, .. } = self.innermost();
                self.builder.jump(behind);
            }
            StmtKind::Continue => {
                let Loop { next, .. } = self.innermost();
                self.builder.jump(next);
            }
            StmtKind::Return => self.leave(),
        }
    }

    fn innermost(&self) -> Loop {
        *self.loops.last().expect("EXIT and CONTINUE stand in loops")
    }

    /// The source is found first, as that of an assignment.
    fn copy(&mut self, to: PathId, from: PathId) {
        let from = self.locate(from);
        let to = self.locate(to);
        match from.ty {
            hir::Type::Elementary(_) => {
                let value = self.read(&from);
                self.write(&to, value);
            }
            hir::Type::Struct(_) | hir::Type::Array(_) => {
                let (to, from) = (to.in_memory().cloned(), from.in_memory().cloned());
                let both = to.zip(from).expect("structures and arrays lie in memory");
                self.builder.copy(both.0, both.1);
            }
        }
    }

    fn branch(&mut self, arms: &'p [(ExprId, Block)], otherwise: &'p Block) {
        let behind = self.builder.create_block();
        for (index, (condition, block)) in arms.iter().enumerate() {
            let condition = self.expr(*condition);
            let then = self.builder.create_block();
            let last = index + 1 == arms.len() && otherwise.is_empty();
            let next = if last {
                behind
            } else {
                self.builder.create_block()
            };
            self.builder.brif(condition, then, next);
            self.go_on(then);
            self.block(block);
            self.jump(behind);
            if last {
                return self.go_on(behind);
            }
            self.go_on(next);
        }
        self.block(otherwise);
        self.jump(behind);
        self.go_on(behind);
    }

    /// The arms are disjoint, so the order in which they are tried does not matter.
    fn case(&mut self, selector: ExprId, arms: &'p [Arm], otherwise: &'p Block) {
        let ty = self.code.expr(selector).ty;
        let value = self.expr(selector);
        let blocks: Vec<IrBlock> = arms.iter().map(|_| self.builder.create_block()).collect();
        let (default, behind) = (self.builder.create_block(), self.builder.create_block());
        let mut numbers = Vec::new();
        for ((ranges, _), &block) in arms.iter().zip(&blocks) {
            for &range in ranges {
                match expanded(ty, range, SWITCH_TOTAL - numbers.len()) {
                    Some(bits) => numbers.extend(bits.map(|bits| (bits, block))),
                    None => self.try_range(value, ty, range, block),
                }
            }
        }
        if numbers.is_empty() {
            self.builder.jump(default);
        } else {
            self.builder.switch(value, numbers, default);
        }
        let bodies = arms.iter().map(|(_, body)| body).chain([otherwise]);
        for (block, body) in blocks.into_iter().chain([default]).zip(bodies) {
            self.go_on(block);
            self.block(body);
            self.jump(behind);
        }
        self.go_on(behind);
    }

    /// Goes to `block` if a value is in a range, and on here if not.
    fn try_range(
        &mut self,
        value: Value,
        ty: Elementary,
        (first, last): (u64, u64),
        block: IrBlock,
    ) {
        let [first, last] = [first, last].map(|bits| self.builder.constant(scalar(ty), bits));
        let above = values::compare(&mut self.builder, CompareOp::GreaterEqual, ty, value, first);
        let below = values::compare(&mut self.builder, CompareOp::LessEqual, ty, value, last);
        let inside = self.builder.binary(BinaryOp::And, above, below);
        let next = self.builder.create_block();
        self.builder.brif(inside, block, next);
        self.go_on(next);
    }
}

/// The numbers of a range, if they are few and at most `room`.
fn expanded(
    ty: Elementary,
    (first, last): (u64, u64),
    room: usize,
) -> Option<impl Iterator<Item = u64>> {
    let mask = scalar(ty).mask();
    let count = number(ty, last) - number(ty, first) + 1;
    let few = count <= SWITCH_RANGE.min(room as i128);
    few.then(|| (0..count).map(move |step| first.wrapping_add(step as u64) & mask))
}
