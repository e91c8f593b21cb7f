//! Statements, one to a line, blocks further in.

use super::super::{Block, CaseArm, Expr, Id, Label, Stmt, StmtKind};
use super::Printer;

impl Printer<'_> {
    pub(super) fn block(&mut self, block: Block) {
        self.indented(|printer| {
            for &stmt in &printer.arena[block] {
                printer.stmt(stmt);
            }
        });
    }

    fn stmt(&mut self, stmt: Id<Stmt>) {
        let node = self.arena[stmt];
        self.line(node.range.start);
        match node.kind {
            StmtKind::Assign { target, op, value } => {
                self.expr(target);
                self.format(format_args!(" {} ", op.as_str()));
                self.expr(value);
            }
            StmtKind::AssignAll { targets, value } => {
                for &target in &self.arena[targets] {
                    self.expr(target);
                    self.format(format_args!(" := "));
                }
                self.expr(value);
            }
            StmtKind::Call(call) => self.expr(call),
            StmtKind::If { arms, otherwise } => {
                for (index, &arm) in self.arena[arms].iter().enumerate() {
                    let word = if index == 0 { "IF" } else { "ELSIF" };
                    self.arm_head(index > 0, word, arm.condition);
                    self.block(arm.body);
                }
                self.otherwise(otherwise);
                self.end("END_IF");
            }
            StmtKind::Case {
                selector,
                arms,
                otherwise,
            } => {
                self.head("CASE", selector, "OF");
                self.indented(|printer| {
                    for &arm in &printer.arena[arms] {
                        printer.case_arm(arm);
                    }
                });
                self.otherwise(otherwise);
                self.end("END_CASE");
            }
            StmtKind::For {
                variable,
                from,
                to,
                by,
                body,
            } => {
                self.for_head(variable, from, to, by);
                self.block(body);
                self.end("END_FOR");
            }
            StmtKind::While { condition, body } => {
                self.head("WHILE", condition, "DO");
                self.block(body);
                self.end("END_WHILE");
            }
            StmtKind::Repeat { body, until } => {
                self.write("REPEAT\n");
                self.block(body);
                self.indentation();
                self.head("UNTIL", until, "END_REPEAT");
                self.out.pop();
            }
            StmtKind::Return => self.write("RETURN"),
            StmtKind::Exit => self.write("EXIT"),
            StmtKind::Continue => self.write("CONTINUE"),
            StmtKind::Mock(instance) => {
                self.write("MOCK ");
                self.expr(instance);
            }
            StmtKind::MockFunction { function, value } => {
                self.write("MOCK_FUNCTION ");
                self.expr(function);
                self.write(" RETURNS ");
                self.expr(value);
            }
            StmtKind::Empty => {}
            StmtKind::Error => self.write("?"),
        }
        self.write(";\n");
    }

    /// A word, an expression and a word on a line.
    fn head(&mut self, word: &str, expr: Id<Expr>, last: &str) {
        self.format(format_args!("{word} "));
        self.expr(expr);
        self.format(format_args!(" {last}\n"));
    }

    fn arm_head(&mut self, new_line: bool, word: &str, condition: Id<Expr>) {
        if new_line {
            self.indentation();
        }
        self.head(word, condition, "THEN");
    }

    fn otherwise(&mut self, block: Option<Block>) {
        if let Some(block) = block {
            self.words("ELSE");
            self.block(block);
        }
    }

    fn end(&mut self, word: &str) {
        self.indentation();
        self.write(word);
    }

    fn case_arm(&mut self, arm: CaseArm) {
        self.line(arm.range.start);
        self.comma(arm.labels, Self::label);
        self.write(":\n");
        self.block(arm.body);
    }

    fn label(&mut self, label: Label) {
        self.expr(label.low);
        if let Some(high) = label.high {
            self.write("..");
            self.expr(high);
        }
    }

    fn for_head(&mut self, variable: Id<Expr>, from: Id<Expr>, to: Id<Expr>, by: Option<Id<Expr>>) {
        self.write("FOR ");
        self.expr(variable);
        self.write(" := ");
        self.expr(from);
        self.write(" TO ");
        self.expr(to);
        if let Some(by) = by {
            self.write(" BY ");
            self.expr(by);
        }
        self.write(" DO\n");
    }
}
