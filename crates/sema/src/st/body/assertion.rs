//! Statements of tests that look like calls: assertions and ADVANCE_TIME.
//!
//! An assertion becomes a condition; where that does not hold, its number and operands are stored
//! and the body is left. Operands are computed once, before the condition.

use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::Elementary;
use crate::hir::code::{BinaryOp as Op, Block, ExprId, ExprKind, Root, StmtKind};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::testing::{Check, CheckKind, Word};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, Argument, ArgumentKind, BinaryOp, Literal, UnaryOp};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

/// What a check compares and whether it holds.
struct Tried {
    operands: Vec<Operand>,
    holds: Operand,
}

impl From<(Vec<Operand>, Operand)> for Tried {
    fn from((operands, holds): (Vec<Operand>, Operand)) -> Self {
        Self { operands, holds }
    }
}

impl Body<'_, '_> {
    /// Whether the body is that of a test, or runs before or after tests.
    pub(super) fn in_test(&self) -> bool {
        self.an.is_test(self.unit)
    }

    /// A call of a word of tests, if it is one here.
    pub(super) fn test_word(&self, callee: st::Id<st::Expr>) -> Option<Word> {
        let st::ExprKind::Name(name) = self.arena()[callee].kind else {
            return None;
        };
        let word = self.an.testing.word(name)?;
        (self.in_test() && !self.own_symbol(name)).then_some(word)
    }

    /// What stands in tests only stands elsewhere.
    pub(super) fn outside_of_test(&mut self, what: &str, range: TextRange) {
        let message = format!("{what} stands in TEST, SETUP and TEARDOWN only");
        self.error(Message::E3060, range, message);
    }

    pub(super) fn test_statement(
        &mut self,
        word: Word,
        arguments: st::List<Argument>,
        range: TextRange,
    ) {
        let Some((values, message)) = self.test_arguments(word, arguments, range) else {
            return;
        };
        match word {
            Word::AdvanceTime => self.advance_time(values[0], range),
            Word::Check(kind) => {
                let tried = self.tried(kind, &values, range);
                if !tried.holds.is_error() {
                    self.check(kind, tried, message, range);
                }
            }
        }
    }

    /// The arguments by position, and the message; nothing after a mistake.
    fn test_arguments(
        &mut self,
        word: Word,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Option<(Vec<st::Id<st::Expr>>, Option<String>)> {
        let written = &self.arena()[arguments];
        let (name, needed) = (word.name(), word.arguments());
        let plain = |argument: &Argument| argument.kind == ArgumentKind::Positional;
        if let Some(named) = written.iter().find(|argument| !plain(argument)) {
            let message = format!("arguments of {name} have no names");
            self.error(Message::E3061, named.range, message);
            return None;
        }
        let values: Vec<_> = written
            .iter()
            .filter_map(|argument| argument.value)
            .collect();
        let most = needed + usize::from(word.takes_message());
        if !(needed..=most).contains(&values.len()) {
            let behind = if word.takes_message() {
                ", and a message behind them"
            } else {
                ""
            };
            let plural = if needed == 1 { "" } else { "s" };
            let message = format!(
                "{name} takes {needed} argument{plural}{behind}, not {}",
                values.len()
            );
            self.error(Message::E3061, range, message);
            return None;
        }
        let (values, message) = values.split_at(needed);
        let message = match message.first() {
            Some(&message) => Some(self.literal_text(message)?),
            None => None,
        };
        Some((values.to_vec(), message))
    }

    /// The text of a message, which is a literal.
    fn literal_text(&mut self, id: st::Id<st::Expr>) -> Option<String> {
        let written = self.arena()[id];
        if let st::ExprKind::Literal(literal) = written.kind
            && let Literal::String(string) = &self.arena()[literal]
        {
            return Some(String::from_utf16_lossy(&string.units));
        }
        if written.kind != st::ExprKind::Error {
            let message = "the message of an assertion is a literal between quotes";
            self.error(Message::E3061, written.range, message);
        }
        None
    }

    fn tried(&mut self, kind: CheckKind, values: &[st::Id<st::Expr>], range: TextRange) -> Tried {
        match kind {
            CheckKind::Equal => self.compared(BinaryOp::Equal, values, range),
            CheckKind::NotEqual => self.compared(BinaryOp::NotEqual, values, range),
            CheckKind::Greater => self.compared(BinaryOp::Greater, values, range),
            CheckKind::GreaterEqual => self.compared(BinaryOp::GreaterEqual, values, range),
            CheckKind::Less => self.compared(BinaryOp::Less, values, range),
            CheckKind::LessEqual => self.compared(BinaryOp::LessEqual, values, range),
            CheckKind::True | CheckKind::False => self.truth(kind, values[0], range),
            CheckKind::Near => self.near(values, range),
            CheckKind::Called => Tried::from(self.was_called(values[0], range)),
            CheckKind::CallCount => Tried::from(self.calls_are(values, range)),
        }
    }

    /// An operand that is computed now.
    fn operand(&mut self, id: st::Id<st::Expr>, want: Option<TypeId>) -> Operand {
        let operand = self.expr(id, want);
        if operand.is_error() || operand.ty == TypeId::NOTHING {
            return operand;
        }
        self.hold(operand)
    }

    /// Two operands; the second may be an enumerator of the type of the first.
    fn pair(&mut self, values: &[st::Id<st::Expr>]) -> (Operand, Operand) {
        if self.is_open(values[0]) && !self.is_open(values[1]) {
            let right = self.operand(values[1], None);
            let beside = self.number_beside(&right);
            return (self.operand(values[0], beside), right);
        }
        let left = self.operand(values[0], None);
        let named = matches!(self.an.types.base(left.ty), TypeKind::Enum(_));
        let open = self.is_open(values[1]);
        let beside = self.number_beside(&left).filter(|_| open);
        let right = self.operand(values[1], named.then_some(left.ty).or(beside));
        (left, right)
    }

    fn compared(&mut self, op: BinaryOp, values: &[st::Id<st::Expr>], range: TextRange) -> Tried {
        let (left, right) = self.pair(values);
        let holds = self.binary_on(op, left.clone(), right.clone(), range, None);
        let operands = vec![left, right];
        Tried { operands, holds }
    }

    fn truth(&mut self, kind: CheckKind, value: st::Id<st::Expr>, range: TextRange) -> Tried {
        let operand = self.expr(value, Some(TypeId::BOOL));
        if operand.is_error() {
            return Tried::from((Vec::new(), operand));
        }
        let value = self.condition(&operand);
        let operand = self.hold(Operand::value(value, TypeId::BOOL, operand.range));
        let holds = if kind == CheckKind::False {
            self.unary_on(UnaryOp::Not, operand.clone(), range, None)
        } else {
            operand.clone()
        };
        Tried::from((vec![operand], holds))
    }

    /// `ABS(left - right) <= tolerance`, also where the types have no negative values or the
    /// difference does not fit.
    fn near(&mut self, values: &[st::Id<st::Expr>], range: TextRange) -> Tried {
        let (left, right) = self.pair(values);
        let tolerance = self.operand(values[2], None);
        let above = self.within(&left, &right, &tolerance, range);
        let below = match above.is_error() {
            true => above.clone(),
            false => self.within(&right, &left, &tolerance, range),
        };
        let holds = self.binary_on(BinaryOp::Or, above, below, range, None);
        let operands = vec![left, right, tolerance];
        Tried { operands, holds }
    }

    /// `high >= low`, and their difference is between 0 and the tolerance.
    fn within(
        &mut self,
        high: &Operand,
        low: &Operand,
        tolerance: &Operand,
        range: TextRange,
    ) -> Operand {
        let difference = self.binary_on(BinaryOp::Subtract, high.clone(), low.clone(), range, None);
        if difference.is_error() || tolerance.is_error() {
            return Operand::error(range);
        }
        let difference = self.hold(difference);
        let zero = Operand::constant(Const::Int(0), TypeId::UNTYPED_INT, range);
        let zero = match self.an.types.elementary(difference.ty) {
            Some(el) if el.is_duration() => Operand {
                ty: difference.ty,
                ..zero
            },
            Some(_) | None => zero,
        };
        let ordered = self.binary_on(
            BinaryOp::GreaterEqual,
            high.clone(),
            low.clone(),
            range,
            None,
        );
        let op = BinaryOp::GreaterEqual;
        let positive = self.binary_on(op, difference.clone(), zero, range, None);
        let op = BinaryOp::LessEqual;
        let small = self.binary_on(op, difference, tolerance.clone(), range, None);
        let both = self.binary_on(BinaryOp::And, ordered, positive, range, None);
        self.binary_on(BinaryOp::And, both, small, range, None)
    }

    /// Leaves the body where something does not hold, and says what it was.
    fn check(&mut self, kind: CheckKind, tried: Tried, message: Option<String>, range: TextRange) {
        let condition = self.condition(&tried.holds);
        let outer = std::mem::take(&mut self.pending);
        let types = self.shown_types(&tried.operands);
        let mut operands = Vec::new();
        for (position, (operand, ty)) in tried.operands.iter().zip(types).enumerate() {
            let (tag, shown) = self.an.operand_tag(ty, position);
            self.store(&whole_tag(tag), ty, operand, range);
            operands.push(shown);
        }
        let span = self.span(range);
        let number = self.an.add_check(Check {
            kind,
            span,
            operands,
            message,
        });
        let failed = self.an.failed_tag();
        let number = self.add_const(number, Elementary::Udint, range);
        let path = self.add_path(Root::Tag(failed), Vec::new(), range);
        self.before(StmtKind::Assign(path, number), range);
        let stores = std::mem::replace(&mut self.pending, outer);
        // In TEARDOWN what failed first counts.
        let arms = vec![(self.none_failed(failed), stores)];
        let otherwise = Block::new();
        let note = self.add_stmt(StmtKind::If { arms, otherwise }, range);
        let leave = self.add_stmt(StmtKind::Return, range);
        let kind = StmtKind::If {
            arms: vec![(condition, Block::new())],
            otherwise: vec![note, leave],
        };
        self.before(kind, range);
    }

    /// The types that operands are shown in: literals in that of what they are compared with, if
    /// they fit.
    fn shown_types(&self, operands: &[Operand]) -> Vec<TypeId> {
        let typed =
            |operand: &&Operand| !matches!(operand.ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
        let partner = operands.iter().find(typed);
        let partner = partner.and_then(|operand| self.an.types.elementary(operand.ty));
        let shown = |operand: &Operand| match (operand.ty, partner) {
            (TypeId::UNTYPED_INT, Some(el)) if el.is_num() && fits(operand, el) => TypeId::of(el),
            (TypeId::UNTYPED_INT, Some(el)) if el.is_bits() && fits(operand, el) => TypeId::of(el),
            (TypeId::UNTYPED_REAL, Some(el)) if el.is_real() => TypeId::of(el),
            _ => self.settle(operand),
        };
        operands.iter().map(shown).collect()
    }

    /// Lets time pass. An integer counts nanoseconds.
    fn advance_time(&mut self, value: st::Id<st::Expr>, range: TextRange) {
        let operand = self.expr(value, Some(TypeId::of(El::Ltime)));
        if operand.is_error() {
            return;
        }
        let whole = operand.ty == TypeId::UNTYPED_INT
            || self.an.types.elementary(operand.ty).is_some_and(El::is_int);
        let ty = TypeId::of(if whole { El::Lint } else { El::Ltime });
        if matches!(operand.as_const(), Some(Const::Int(number)) if *number < 0) {
            let span = self.span(operand.range);
            let diagnostic = Diagnostic::new(Message::E3061, span, "time does not go back");
            self.report(diagnostic);
            return;
        }
        let passed = self.as_scalar(&operand, ty);
        let passed = self.not_negative(passed, range);
        let clock = self.an.test_clock();
        let path = self.add_path(Root::Tag(clock), Vec::new(), range);
        let now = self.add_expr(ExprKind::Load(path), Elementary::Lint, range);
        let sum = ExprKind::Binary(Op::Add, now, passed);
        let sum = self.add_expr(sum, Elementary::Lint, range);
        let sum = self.not_negative(sum, range);
        let path = self.add_path(Root::Tag(clock), Vec::new(), range);
        self.before(StmtKind::Assign(path, sum), range);
    }

    fn not_negative(&mut self, value: ExprId, range: TextRange) -> ExprId {
        let kind = ExprKind::Within {
            value,
            low: 0,
            high: i64::MAX as u64,
        };
        self.add_expr(kind, Elementary::Lint, range)
    }
}

/// Whether a literal is a value of a type.
fn fits(operand: &Operand, el: El) -> bool {
    let Some(Const::Int(value)) = operand.as_const() else {
        return false;
    };
    let (low, high) = el.range();
    el.is_real() || (low..=high).contains(value)
}

/// All of a tag.
pub(super) fn whole_tag(tag: crate::hir::TagId) -> Place {
    Place {
        root: Root::Tag(tag),
        steps: Vec::new(),
        rights: Rights::All,
    }
}

/// All of a tag, as an operand.
pub(super) fn tag_operand(tag: crate::hir::TagId, ty: TypeId, range: TextRange) -> Operand {
    Operand {
        kind: OperandKind::Place(whole_tag(tag)),
        ty,
        range,
    }
}
