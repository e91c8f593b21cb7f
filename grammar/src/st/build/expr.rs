//! Expressions as they are reduced: where they begin and end, how deep they are, and the slips that
//! only the whole of one shows.

use super::Build;
use iecc_ast::Symbol;
use iecc_ast::st::{
    AddressSize, Area, Argument, ArgumentKind, BinaryOp, Direct, Expr, ExprKind, Id, Ident,
    MAX_EXPR_DEPTH, Part, UnaryOp,
};
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;

/// Letters of the word `NOT`.
const NOT_LENGTH: u32 = 3;

impl Build<'_, '_> {
    /// A node without children.
    pub(crate) fn expr(&mut self, start: u32, kind: ExprKind, end: u32) -> Id<Expr> {
        let range = self.range(start, end);
        self.node(kind, range, 1)
    }

    pub(crate) fn reference(&mut self, start: u32, operand: Id<Expr>, end: u32) -> Id<Expr> {
        let range = self.range(start, end);
        let depth = self.depth_above(operand);
        self.node(ExprKind::Ref(operand), range, depth)
    }

    fn node(&mut self, kind: ExprKind, range: TextRange, depth: u16) -> Id<Expr> {
        let kind = if depth > MAX_EXPR_DEPTH {
            self.too_deep("expressions", MAX_EXPR_DEPTH, range);
            ExprKind::Error
        } else {
            kind
        };
        let depth = if kind == ExprKind::Error { 1 } else { depth };
        self.arena.add(Expr {
            kind,
            range,
            depth,
            parenthesised: false,
        })
    }

    fn depth_above(&self, child: Id<Expr>) -> u16 {
        self.arena[child].depth + 1
    }

    fn depth_above_all(&self, children: &[Id<Expr>]) -> u16 {
        let depths = children.iter().map(|&child| self.arena[child].depth);
        depths.max().unwrap_or(0) + 1
    }

    fn depth_above_arguments(&self, arguments: &[Argument]) -> u16 {
        let values = arguments.iter().filter_map(|argument| argument.value);
        values
            .map(|value| self.arena[value].depth)
            .max()
            .unwrap_or(0)
            + 1
    }

    fn expr_range(&self, expr: Id<Expr>) -> TextRange {
        self.arena[expr].range
    }

    /// Adds an operator and its right operand to a chain: the operator takes as its left operand
    /// what binds at least as tight on the right edge of the tree so far.
    ///
    /// That edge has one node per level of precedence at most, so this is constant time.
    pub(crate) fn binary(
        &mut self,
        chain: Id<Expr>,
        (op, op_start): (BinaryOp, u32),
        right: Id<Expr>,
    ) -> Id<Expr> {
        let mut looser = Vec::new();
        let mut left = chain;
        while let Some(inner) = self.looser_right(left, op) {
            looser.push(left);
            left = inner;
        }
        let kind = ExprKind::Binary {
            op,
            op_start: op_start - self.base,
            left,
            right,
        };
        let range = self.expr_range(left).to(self.expr_range(right));
        let depth = self.depth_above_all(&[left, right]);
        let mut tree = self.node(kind, range, depth);
        for parent in looser.into_iter().rev() {
            self.replace_right(parent, tree);
            tree = parent;
        }
        tree
    }

    /// The right operand of an operator that binds looser than `op`.
    fn looser_right(&self, expr: Id<Expr>, op: BinaryOp) -> Option<Id<Expr>> {
        let expr = &self.arena[expr];
        let ExprKind::Binary {
            op: outer, right, ..
        } = expr.kind
        else {
            return None;
        };
        (!expr.parenthesised && outer.binding() < op.binding()).then_some(right)
    }

    fn replace_right(&mut self, parent: Id<Expr>, new: Id<Expr>) {
        let (depth, end) = (self.depth_above(new), self.expr_range(new).end);
        let node = &mut self.arena[parent];
        node.range.end = end;
        node.depth = node.depth.max(depth);
        if let ExprKind::Binary { right, .. } = &mut node.kind {
            *right = new;
        }
        if node.depth > MAX_EXPR_DEPTH {
            (node.kind, node.depth) = (ExprKind::Error, 1);
            let range = node.range;
            self.too_deep("expressions", MAX_EXPR_DEPTH, range);
        }
    }

    pub(crate) fn unary(&mut self, start: u32, op: UnaryOp, operand: Id<Expr>) -> Id<Expr> {
        let range = self.range(start, start).to(self.expr_range(operand));
        let depth = self.depth_above(operand);
        self.node(ExprKind::Unary { op, operand }, range, depth)
    }

    /// `NOT operand`; with named arguments in the parentheses it is a call.
    pub(crate) fn not(&mut self, start: u32, name: Symbol, operand: Id<Expr>) -> Id<Expr> {
        let ExprKind::StructValue(fields) = self.arena[operand].kind else {
            return self.unary(start, UnaryOp::Not, operand);
        };
        let callee = self.expr(start, ExprKind::Name(name), start + NOT_LENGTH);
        let depth = self.depth_above(operand);
        let range = self.expr_range(callee).to(self.expr_range(operand));
        let call = ExprKind::Call {
            callee,
            arguments: fields,
        };
        self.node(call, range, depth)
    }

    /// `NOT(IN := a, ENO => b)`.
    pub(crate) fn not_call(
        &mut self,
        start: u32,
        name: Symbol,
        mut arguments: Vec<Argument>,
        outputs: Vec<Argument>,
        end: u32,
    ) -> Id<Expr> {
        arguments.extend(outputs);
        let callee = self.expr(start, ExprKind::Name(name), start + NOT_LENGTH);
        self.call(callee, arguments, end)
    }

    pub(crate) fn parenthesised(&mut self, start: u32, inner: Id<Expr>, end: u32) -> Id<Expr> {
        let range = self.range(start, end);
        let node = &mut self.arena[inner];
        node.range = range;
        node.parenthesised = true;
        inner
    }

    pub(crate) fn member(&mut self, base: Id<Expr>, member: Ident) -> Id<Expr> {
        let range = self.expr_range(base).to(member.range);
        let depth = self.depth_above(base);
        self.node(ExprKind::Member { base, member }, range, depth)
    }

    pub(crate) fn index(&mut self, base: Id<Expr>, indices: Vec<Id<Expr>>, end: u32) -> Id<Expr> {
        let depth = self.depth_above(base).max(self.depth_above_all(&indices));
        let range = self.expr_range(base).to(self.range(end, end));
        let indices = self.arena.list(indices);
        self.node(ExprKind::Index { base, indices }, range, depth)
    }

    pub(crate) fn deref(&mut self, base: Id<Expr>, end: u32) -> Id<Expr> {
        let range = self.expr_range(base).to(self.range(end, end));
        let depth = self.depth_above(base);
        self.node(ExprKind::Deref(base), range, depth)
    }

    pub(crate) fn call(
        &mut self,
        callee: Id<Expr>,
        arguments: Vec<Argument>,
        end: u32,
    ) -> Id<Expr> {
        let depth = self.depth_above(callee);
        let depth = depth.max(self.depth_above_arguments(&arguments));
        let range = self.expr_range(callee).to(self.range(end, end));
        let arguments = self.arena.list(arguments);
        self.node(ExprKind::Call { callee, arguments }, range, depth)
    }

    pub(crate) fn argument(
        &mut self,
        start: u32,
        kind: ArgumentKind,
        value: Option<Id<Expr>>,
        end: u32,
    ) -> Argument {
        let range = self.range(start, end);
        Argument { kind, value, range }
    }

    pub(crate) fn struct_value(&mut self, start: u32, fields: Vec<Argument>, end: u32) -> Id<Expr> {
        let depth = self.depth_above_arguments(&fields);
        let fields = self.arena.list(fields);
        let range = self.range(start, end);
        self.node(ExprKind::StructValue(fields), range, depth)
    }

    pub(crate) fn array_value(
        &mut self,
        start: u32,
        values: Option<Vec<Id<Expr>>>,
        end: u32,
    ) -> Id<Expr> {
        let values = values.unwrap_or_default();
        let depth = self.depth_above_all(&values);
        let values = self.arena.list(values);
        let range = self.range(start, end);
        self.node(ExprKind::ArrayValue(values), range, depth)
    }

    pub(crate) fn repeat(
        &mut self,
        start: u32,
        count: Id<Expr>,
        values: Option<Vec<Id<Expr>>>,
        end: u32,
    ) -> Id<Expr> {
        let values = values.unwrap_or_default();
        let depth = self.depth_above(count).max(self.depth_above_all(&values));
        let values = self.arena.list(values);
        let range = self.range(start, end);
        self.node(ExprKind::Repeat { count, values }, range, depth)
    }

    /// `INT#5`, `Color#Red`, `path.Color#Red`. The name begins at `start`; `prefix_end` is behind
    /// the `#`.
    pub(crate) fn typed(
        &mut self,
        path: Option<Id<Expr>>,
        start: u32,
        name: Symbol,
        prefix_end: u32,
        value: Id<Expr>,
    ) -> Id<Expr> {
        let ty = match path {
            None => self.expr(start, ExprKind::Name(name), prefix_end - 1),
            Some(base) => {
                let range = self.range(start, prefix_end - 1);
                self.member(base, Ident { name, range })
            }
        };
        let range = self.expr_range(ty).to(self.expr_range(value));
        let depth = self.depth_above_all(&[ty, value]);
        self.node(ExprKind::Typed { ty, value }, range, depth)
    }

    /// `base.3` and `base.%X3`; also `resource.%IX0.3`.
    pub(crate) fn part(&mut self, base: Id<Expr>, start: u32, end: u32) -> Id<Expr> {
        let text = self.text(start, end);
        if let (ExprKind::Name(resource), Some(mut direct)) =
            (self.arena[base].kind, self.direct_parts(text))
            && direct.area.is_some()
        {
            direct.resource = Some(resource);
            let range = self.expr_range(base).to(self.range(end, end));
            let depth = self.depth_above(base);
            return self.node(ExprKind::Direct(direct), range, depth);
        }
        let Some(part) = part(text) else {
            let message = format!("`{text}` is no part of a bit string");
            let diagnostic = Diagnostic::new(Code::E0026, self.span(start, end), message)
                .label("expected a number, or `%X`, `%B`, `%W`, `%D` or `%L` and a number");
            self.report(diagnostic);
            return self.expr(start, ExprKind::Error, end);
        };
        let range = self.expr_range(base).to(self.range(end, end));
        let depth = self.depth_above(base);
        self.node(ExprKind::Part { base, part }, range, depth)
    }

    /// `%IX1.0`, `%Q*`.
    pub(crate) fn direct(&mut self, start: u32, end: u32) -> Id<Expr> {
        let text = self.text(start, end);
        let kind = match self.direct_parts(text) {
            Some(direct) => ExprKind::Direct(direct),
            None => {
                self.bad_address(text, start, end);
                ExprKind::Error
            }
        };
        self.expr(start, kind, end)
    }

    fn direct_parts(&mut self, text: &str) -> Option<Direct> {
        let (area, size, numbers) = direct(text)?;
        Some(Direct {
            resource: None,
            area,
            size,
            fields: numbers.map(|numbers| self.arena.list(numbers)),
        })
    }

    fn bad_address(&mut self, text: &str, start: u32, end: u32) {
        let message = format!("`{text}` is not a direct address");
        let diagnostic = Diagnostic::new(Code::E0026, self.span(start, end), message)
            .label("expected `%`, an area, a size, and numbers with dots between them")
            .note("areas are I, Q and M; sizes are X, B, W, D and L; `*` in place of the numbers leaves them to VAR_CONFIG");
        self.report(diagnostic);
    }
}

fn part(text: &str) -> Option<Part> {
    let digits = |text: &str| text.replace('_', "").parse().ok();
    let Some(rest) = text.strip_prefix('%') else {
        return Some(Part {
            size: AddressSize::Bit,
            index: digits(text)?,
            short: true,
        });
    };
    Some(Part {
        size: size(rest.chars().next()?)?,
        index: digits(&rest[1..])?,
        short: false,
    })
}

fn size(letter: char) -> Option<AddressSize> {
    Some(match letter.to_ascii_uppercase() {
        'X' => AddressSize::Bit,
        'B' => AddressSize::Byte,
        'W' => AddressSize::Word,
        'D' => AddressSize::DoubleWord,
        'L' => AddressSize::LongWord,
        _ => return None,
    })
}

fn area(letter: char) -> Option<Area> {
    Some(match letter.to_ascii_uppercase() {
        'I' => Area::Input,
        'Q' => Area::Output,
        'M' => Area::Memory,
        _ => return None,
    })
}

/// Area, size, and numbers; `None` in place of the numbers is `*`.
type DirectParts = (Option<Area>, Option<AddressSize>, Option<Vec<u32>>);

fn direct(text: &str) -> Option<DirectParts> {
    let mut rest = &text[1..];
    let area = rest.chars().next().and_then(area);
    rest = &rest[usize::from(area.is_some())..];
    let size = rest.chars().next().and_then(size);
    rest = &rest[usize::from(size.is_some())..];
    if area.is_none() && size.is_none() {
        return None;
    }
    if rest == "*" {
        return Some((area, size, None));
    }
    let numbers: Option<Vec<u32>> = rest.split('.').map(|field| field.parse().ok()).collect();
    Some((area, size, Some(numbers?)))
}
