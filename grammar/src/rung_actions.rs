//! What the productions of `rung.lalrpop` build, and the mistakes only visible while building.

use iecc_ast::rung::{
    BinaryOp, Element, Expr, ExprKind, IntLiteral, IntSuffix, Leg, Member, Operand, OperandKind,
    Radix, Reference, UnaryOp,
};
use iecc_ast::{Name, RealText, StringLiteral};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{MappedText, Span, Spanned};

/// The start of a reference, before its members.
pub(crate) struct PathHead {
    pub(crate) program: Option<Name>,
    pub(crate) base: Name,
}

/// Makes AST nodes from byte offsets in the rung text.
pub(crate) struct Builder<'b> {
    pub(crate) text: &'b MappedText,
    pub(crate) diagnostics: Diagnostics,
}

impl Builder<'_> {
    pub(crate) fn span(&self, start: usize, end: usize) -> Span {
        self.text.span(start..end.max(start))
    }

    pub(crate) fn spanned<T>(&self, start: usize, node: T, end: usize) -> Spanned<T> {
        Spanned::new(node, self.span(start, end))
    }

    pub(crate) fn name(&self, start: usize, text: &str, end: usize) -> Name {
        self.spanned(start, text.to_owned(), end)
    }

    pub(crate) fn list<T>(&self, first: T, mut rest: Vec<T>) -> Vec<T> {
        rest.insert(0, first);
        rest
    }

    pub(crate) fn leg(&self, at: usize, elements: Vec<Element>) -> Leg {
        let span = match (elements.first(), elements.last()) {
            (Some(first), Some(last)) => element_span(first).to(element_span(last)),
            (None | Some(_), _) => self.span(at, at),
        };
        Leg { elements, span }
    }

    /// Between `()` stands no operand at all, rather than one that is left out.
    pub(crate) fn operands(&self, mut operands: Vec<Operand>) -> Vec<Operand> {
        if let [only] = &operands[..]
            && only.kind == OperandKind::Empty
        {
            operands.clear();
        }
        operands
    }

    pub(crate) fn words(&self, first: &str, rest: Vec<&str>) -> OperandKind {
        OperandKind::Words(self.list(first, rest).join(" "))
    }

    pub(crate) fn expr(&self, start: usize, kind: ExprKind, end: usize) -> Expr {
        Expr {
            kind,
            span: self.span(start, end),
        }
    }

    pub(crate) fn unary(&self, op: Spanned<UnaryOp>, operand: Expr) -> Expr {
        let span = op.span.to(operand.span);
        Expr {
            kind: ExprKind::Unary {
                op,
                operand: Box::new(operand),
            },
            span,
        }
    }

    pub(crate) fn binary(&self, left: Expr, op: Spanned<BinaryOp>, right: Expr) -> Expr {
        let span = left.span.to(right.span);
        let (left, right) = (Box::new(left), Box::new(right));
        Expr {
            kind: ExprKind::Binary { op, left, right },
            span,
        }
    }

    pub(crate) fn real(&self, text: &str) -> ExprKind {
        ExprKind::Real(RealText(text.to_owned()))
    }

    pub(crate) fn string(&self, text: &str) -> ExprKind {
        ExprKind::String(StringLiteral {
            raw: text[1..text.len() - 1].to_owned(),
        })
    }

    pub(crate) fn reference(
        &self,
        start: usize,
        head: PathHead,
        members: Vec<Member>,
        end: usize,
    ) -> Reference {
        let PathHead { program, base } = head;
        Reference {
            program,
            base,
            members,
            span: self.span(start, end),
        }
    }

    pub(crate) fn base(&self, start: usize, first: &str, rest: Vec<&str>, end: usize) -> Name {
        let name = self.list(first, rest).join(":");
        self.spanned(start, name, end)
    }

    pub(crate) fn bit(&mut self, start: usize, text: &str, end: usize) -> Member {
        let bit = text.parse::<u32>().unwrap_or_else(|_| {
            self.too_large(start, text, end);
            0
        });
        Member::Bit(self.spanned(start, bit, end))
    }

    pub(crate) fn int(&mut self, start: usize, text: &str, end: usize) -> ExprKind {
        let (number, suffix) = split_suffix(text);
        let (digits, radix) = split_radix(number);
        let digits = digits.replace('_', "");
        let base = radix_value(radix);
        if let Some(bad) = digits.chars().find(|c| !c.is_digit(base)) {
            self.bad_digit(start, bad, base, end);
        }
        // Only the magnitude can be wrong now: digits are digits, and there is one at least.
        let value = u64::from_str_radix(&digits, base).unwrap_or_else(|_| {
            self.too_large(start, text, end);
            0
        });
        ExprKind::Int(IntLiteral {
            value,
            radix,
            suffix,
        })
    }

    fn bad_digit(&mut self, start: usize, bad: char, base: u32, end: usize) {
        let message = format!("`{bad}` is not a digit of base {base}");
        self.diagnostics
            .push(Diagnostic::new(Code::E5003, self.span(start, end), message));
    }

    fn too_large(&mut self, start: usize, text: &str, end: usize) {
        if self.diagnostics.has_errors() {
            return;
        }
        let message = format!("the number `{text}` is too large");
        let diagnostic = Diagnostic::new(Code::E5005, self.span(start, end), message)
            .note("the largest integer type has 64 bits");
        self.diagnostics.push(diagnostic);
    }
}

fn element_span(element: &Element) -> Span {
    match element {
        Element::Instruction(instruction) => instruction.span,
        Element::Branch(branch) => branch.span,
    }
}

fn split_suffix(text: &str) -> (&str, Option<IntSuffix>) {
    let digits = text.trim_end_matches(['u', 'U', 'l', 'L']);
    let suffix = match text[digits.len()..].to_ascii_uppercase().as_str() {
        "U" => Some(IntSuffix::Unsigned),
        "L" => Some(IntSuffix::Long),
        "UL" => Some(IntSuffix::UnsignedLong),
        _ => None,
    };
    (digits, suffix)
}

fn split_radix(number: &str) -> (&str, Radix) {
    match number.split_once('#') {
        Some(("2", digits)) => (digits, Radix::Binary),
        Some(("8", digits)) => (digits, Radix::Octal),
        Some((_, digits)) => (digits, Radix::Hexadecimal),
        None => (number, Radix::Decimal),
    }
}

fn radix_value(radix: Radix) -> u32 {
    match radix {
        Radix::Binary => 2,
        Radix::Octal => 8,
        Radix::Decimal => 10,
        Radix::Hexadecimal => 16,
    }
}
