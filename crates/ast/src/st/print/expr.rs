//! Expressions, with as few parentheses as give the same tree.

use super::super::{Argument, ArgumentKind, BinaryOp, Direct, Expr, ExprKind, Id, Part, UnaryOp};
use super::Printer;

impl Printer<'_> {
    pub(super) fn expr(&mut self, expr: Id<Expr>) {
        match self.arena[expr].kind {
            ExprKind::Literal(literal) => self.literal(literal),
            ExprKind::Name(name) => self.name(name),
            ExprKind::Typed { ty, value } => {
                self.expr(ty);
                self.write("#");
                self.expr(value);
            }
            ExprKind::Member { base, member } => {
                self.base(base);
                self.write(".");
                self.ident(member);
            }
            ExprKind::Part { base, part } => self.part(base, part),
            ExprKind::Index { base, indices } => {
                self.expr(base);
                self.write("[");
                self.exprs(indices);
                self.write("]");
            }
            ExprKind::Deref(base) => {
                self.expr(base);
                self.write("^");
            }
            ExprKind::Direct(direct) => self.direct(direct),
            ExprKind::This => self.write("THIS"),
            ExprKind::Super => self.write("SUPER"),
            ExprKind::Null => self.write("NULL"),
            ExprKind::Ref(operand) => {
                self.write("REF(");
                self.expr(operand);
                self.write(")");
            }
            ExprKind::Call { callee, arguments } => {
                self.expr(callee);
                self.write("(");
                self.comma(arguments, Self::argument);
                self.write(")");
            }
            ExprKind::Unary { op, operand } => self.unary(op, operand),
            ExprKind::Binary {
                op, left, right, ..
            } => self.binary(op, left, right),
            ExprKind::ArrayValue(values) => {
                self.write("[");
                self.exprs(values);
                self.write("]");
            }
            ExprKind::Repeat { count, values } => {
                self.expr(count);
                self.write("(");
                self.exprs(values);
                self.write(")");
            }
            ExprKind::StructValue(fields) => {
                self.write("(");
                self.comma(fields, Self::argument);
                self.write(")");
            }
            ExprKind::Error => self.write("?"),
        }
    }

    /// What stands before a dot. Digits before it would make a number of the dot.
    fn base(&mut self, base: Id<Expr>) {
        self.expr(base);
        if matches!(
            self.arena[base].kind,
            ExprKind::Part { .. } | ExprKind::Direct(_)
        ) {
            self.write(" ");
        }
    }

    fn part(&mut self, base: Id<Expr>, part: Part) {
        self.base(base);
        if part.short {
            self.format(format_args!(".{}", part.index));
        } else {
            self.format(format_args!(".%{}{}", part.size.letter(), part.index));
        }
    }

    fn direct(&mut self, direct: Direct) {
        if let Some(resource) = direct.resource {
            self.name(resource);
            self.write(".");
        }
        self.write("%");
        if let Some(area) = direct.area {
            self.format(format_args!("{}", area.letter()));
        }
        if let Some(size) = direct.size {
            self.format(format_args!("{}", size.letter()));
        }
        let Some(fields) = direct.fields else {
            return self.write("*");
        };
        let fields: Vec<String> = self.arena[fields].iter().map(u32::to_string).collect();
        self.write(&fields.join("."));
    }

    fn unary(&mut self, op: UnaryOp, operand: Id<Expr>) {
        self.write(op.as_str());
        if op == UnaryOp::Not {
            self.write(" ");
        }
        let is_binary = matches!(self.arena[operand].kind, ExprKind::Binary { .. });
        self.wrapped(operand, is_binary);
    }

    /// Operators group to the left, so the right operand needs parentheses also when it binds as
    /// tight.
    fn binary(&mut self, op: BinaryOp, left: Id<Expr>, right: Id<Expr>) {
        self.wrapped(left, self.binding(left) < op.binding());
        self.format(format_args!(" {} ", op.as_str()));
        self.wrapped(right, self.binding(right) <= op.binding());
    }

    fn binding(&self, expr: Id<Expr>) -> u8 {
        if let ExprKind::Binary { op, .. } = self.arena[expr].kind {
            op.binding()
        } else {
            u8::MAX
        }
    }

    fn wrapped(&mut self, expr: Id<Expr>, wrap: bool) {
        if wrap {
            self.write("(");
        }
        self.expr(expr);
        if wrap {
            self.write(")");
        }
    }

    pub(super) fn argument(&mut self, argument: Argument) {
        match argument.kind {
            ArgumentKind::Positional => {}
            ArgumentKind::Input(name) => {
                self.ident(name);
                self.write(" := ");
            }
            ArgumentKind::Output(name) => {
                self.ident(name);
                self.write(" => ");
            }
            ArgumentKind::NegatedOutput(name) => {
                self.write("NOT ");
                self.ident(name);
                self.write(" => ");
            }
        }
        if let Some(value) = argument.value {
            self.expr(value);
        }
    }
}
