//! Rungs as canonical neutral text: no blank that the grammar does not need, except one before
//! `,` and `]` of a branch as the vendor's tools write it; parentheses only where precedence asks
//! for them. The text parses back to the same tree.

use crate::rung::{
    BinaryOp, Branch, Element, Expr, ExprKind, Instruction, IntLiteral, IntSuffix, Member, Operand,
    OperandKind, Radix, Reference, Rung, UnaryOp,
};
use std::fmt::{Display, Formatter, Result, Write};

impl Display for Rung {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        series(&self.elements, f)?;
        f.write_char(';')
    }
}

fn series(elements: &[Element], f: &mut Formatter<'_>) -> Result {
    elements.iter().try_for_each(|element| element.fmt(f))
}

fn separated<T: Display>(items: &[T], separator: &str, f: &mut Formatter<'_>) -> Result {
    for (index, item) in items.iter().enumerate() {
        if index > 0 {
            f.write_str(separator)?;
        }
        item.fmt(f)?;
    }
    Ok(())
}

impl Display for Element {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Instruction(instruction) => instruction.fmt(f),
            Self::Branch(branch) => branch.fmt(f),
        }
    }
}

impl Display for Branch {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_char('[')?;
        for (index, leg) in self.legs.iter().enumerate() {
            if index > 0 {
                f.write_str(" ,")?;
            }
            series(&leg.elements, f)?;
        }
        f.write_str(" ]")
    }
}

impl Display for Instruction {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{}(", self.mnemonic.node)?;
        separated(&self.operands, ",", f)?;
        f.write_char(')')
    }
}

impl Display for Operand {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.kind {
            OperandKind::Empty => Ok(()),
            OperandKind::InTag => f.write_char('?'),
            OperandKind::Expr(expr) => expr.fmt(f),
            OperandKind::Words(words) => f.write_str(words),
        }
    }
}

impl Display for Expr {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.kind {
            ExprKind::Int(literal) => literal.fmt(f),
            ExprKind::Real(real) => f.write_str(&real.0),
            ExprKind::String(string) => write!(f, "'{}'", string.raw),
            ExprKind::Reference(reference) => reference.fmt(f),
            ExprKind::Unary { op, operand } => unary(op.node, operand, f),
            ExprKind::Binary { op, left, right } => binary(op.node, left, right, f),
            ExprKind::Call {
                function,
                arguments,
            } => {
                write!(f, "{}(", function.node)?;
                separated(arguments, ",", f)?;
                f.write_char(')')
            }
        }
    }
}

/// How tightly the text of an expression holds together.
fn precedence(expr: &Expr) -> u8 {
    match &expr.kind {
        ExprKind::Int(_)
        | ExprKind::Real(_)
        | ExprKind::String(_)
        | ExprKind::Reference(_)
        | ExprKind::Call { .. } => u8::MAX,
        ExprKind::Unary { .. } => UnaryOp::PRECEDENCE,
        ExprKind::Binary { op, .. } => op.node.precedence(),
    }
}

fn at_least(expr: &Expr, wanted: u8, f: &mut Formatter<'_>) -> Result {
    if precedence(expr) < wanted {
        write!(f, "({expr})")
    } else {
        expr.fmt(f)
    }
}

fn unary(op: UnaryOp, operand: &Expr, f: &mut Formatter<'_>) -> Result {
    f.write_str(op.symbol())?;
    if op == UnaryOp::Not {
        f.write_char(' ')?;
    }
    at_least(operand, UnaryOp::PRECEDENCE, f)
}

fn binary(op: BinaryOp, left: &Expr, right: &Expr, f: &mut Formatter<'_>) -> Result {
    at_least(left, op.precedence(), f)?;
    let is_word = op.symbol().starts_with(|c: char| c.is_ascii_alphabetic());
    if is_word {
        write!(f, " {} ", op.symbol())?;
    } else {
        f.write_str(op.symbol())?;
    }
    at_least(right, op.precedence() + 1, f)
}

impl Display for IntLiteral {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self.radix {
            Radix::Binary => write!(f, "2#{:b}", self.value),
            Radix::Octal => write!(f, "8#{:o}", self.value),
            Radix::Decimal => write!(f, "{}", self.value),
            Radix::Hexadecimal => write!(f, "16#{:x}", self.value),
        }?;
        f.write_str(match self.suffix {
            None => "",
            Some(IntSuffix::Unsigned) => "U",
            Some(IntSuffix::Long) => "L",
            Some(IntSuffix::UnsignedLong) => "UL",
        })
    }
}

impl Display for Reference {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if let Some(program) = &self.program {
            write!(f, "\\{}.", program.node)?;
        }
        f.write_str(&self.base.node)?;
        self.members.iter().try_for_each(|member| member.fmt(f))
    }
}

impl Display for Member {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Field(name) => write!(f, ".{}", name.node),
            Self::Bit(bit) => write!(f, ".{}", bit.node),
            Self::BitIndex(index) => write!(f, ".[{index}]"),
            Self::Index(indexes) => {
                f.write_char('[')?;
                separated(indexes, ",", f)?;
                f.write_char(']')
            }
        }
    }
}
