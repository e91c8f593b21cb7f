//! Mocks. An instance has a hidden number: 0, or while it is a mock one more than how often it was
//! called since then. A call of a mock takes inputs and gives outputs, but runs nothing. A function
//! has a hidden flag and value that its body looks at first.

use crate::hir::code::{BinaryOp as Op, Block, ExprId, ExprKind, PathStep, Root, StmtId, StmtKind};
use crate::hir::{CompareOp, Elementary};
use crate::st::body::assertion::{tag_operand, whole_tag};
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::signature::{Def, PouId};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, BinaryOp, PouKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

const COUNT: TypeId = TypeId::of(El::Lint);

impl Body<'_, '_> {
    /// `MOCK instance;`
    pub(crate) fn mock(&mut self, instance: st::Id<st::Expr>, range: TextRange) {
        if !self.in_test() {
            return self.outside_of_test("MOCK", range);
        }
        let number = self.instance_to_mock(instance);
        let Some(number) = number.and_then(|(pou, place)| self.mock_number(pou, &place)) else {
            return;
        };
        let path = self.path_of(&number, range);
        let one = self.add_const(1, Elementary::Lint, range);
        self.before(StmtKind::Assign(path, one), range);
    }

    /// An instance of something that can be called; a message if it is none.
    fn instance_to_mock(&mut self, id: st::Id<st::Expr>) -> Option<(PouId, Place)> {
        let operand = self.place(id, None);
        if operand.is_error() {
            return None;
        }
        if let (OperandKind::Place(place), TypeKind::Instance(pou)) =
            (&operand.kind, self.an.types.base(operand.ty))
            && self.an.pou(*pou).kind != PouKind::Class
        {
            return Some((*pou, place.clone()));
        }
        let name = self.type_name(operand.ty);
        let message = format!("an instance of a block is needed here, not {name}");
        self.error(Message::E3062, operand.range, message);
        None
    }

    /// The hidden number of an instance; there is none where no test mocks an instance.
    fn mock_number(&self, pou: PouId, place: &Place) -> Option<Place> {
        let (distance, field) = self.an.mock_field(pou)?;
        let mut steps = place.steps.clone();
        steps.extend(std::iter::repeat_n(PathStep::Field(0), distance));
        steps.push(PathStep::Field(field));
        Some(Place {
            root: place.root,
            steps,
            rights: Rights::All,
        })
    }

    /// The calls of an instance since it is a mock; -1 if it is none.
    fn mock_calls(&mut self, id: st::Id<st::Expr>, range: TextRange) -> Operand {
        let Some((pou, place)) = self.instance_to_mock(id) else {
            return Operand::error(range);
        };
        let Some(number) = self.mock_number(pou, &place) else {
            return Operand::constant(Const::Int(-1), COUNT, range);
        };
        let path = self.path_of(&number, range);
        let number = self.add_expr(ExprKind::Load(path), Elementary::Lint, range);
        let one = self.add_const(1, Elementary::Lint, range);
        let calls = ExprKind::Binary(Op::Subtract, number, one);
        let calls = self.add_expr(calls, Elementary::Lint, range);
        let calls = Operand::value(calls, COUNT, range);
        self.hold(calls)
    }

    /// `MOCK_VERIFY_CALLED(instance)`
    pub(crate) fn was_called(
        &mut self,
        instance: st::Id<st::Expr>,
        range: TextRange,
    ) -> (Vec<Operand>, Operand) {
        let calls = self.mock_calls(instance, range);
        let none = Operand::constant(Const::Int(0), COUNT, range);
        let holds = self.binary_on(BinaryOp::Greater, calls.clone(), none, range, None);
        (vec![calls], holds)
    }

    /// `MOCK_VERIFY_CALL_COUNT(instance, count)`
    pub(crate) fn calls_are(
        &mut self,
        values: &[st::Id<st::Expr>],
        range: TextRange,
    ) -> (Vec<Operand>, Operand) {
        let calls = self.mock_calls(values[0], range);
        let expected = self.expr(values[1], Some(COUNT));
        let fits = |ty: TypeId| self.an.types.elementary(ty).is_some_and(El::is_int);
        if !expected.is_error() && expected.ty != TypeId::UNTYPED_INT && !fits(expected.ty) {
            self.mismatch(&expected, COUNT);
            return (Vec::new(), Operand::error(range));
        }
        let expected = self.hold(expected);
        let holds = self.binary_on(
            BinaryOp::Equal,
            calls.clone(),
            expected.clone(),
            range,
            None,
        );
        (vec![calls, expected], holds)
    }

    /// The call of an instance, which runs only if it is no mock. ENO of a mock is TRUE.
    pub(crate) fn unless_mocked(
        &mut self,
        pou: PouId,
        place: &Place,
        call: StmtId,
        eno: Option<&Place>,
        range: TextRange,
    ) -> StmtId {
        let Some(number) = self.mock_number(pou, place) else {
            return call;
        };
        let load = |body: &mut Self| -> ExprId {
            let path = body.path_of(&number, range);
            body.add_expr(ExprKind::Load(path), Elementary::Lint, range)
        };
        let now = load(self);
        let none = self.add_const(0, Elementary::Lint, range);
        let real = ExprKind::Compare(CompareOp::Equal, now, none);
        let real = self.add_expr(real, Elementary::Bool, range);
        let before = load(self);
        let one = self.add_const(1, Elementary::Lint, range);
        let next = ExprKind::Binary(Op::Add, before, one);
        let next = self.add_expr(next, Elementary::Lint, range);
        let path = self.path_of(&number, range);
        let mut otherwise = vec![self.add_stmt(StmtKind::Assign(path, next), range)];
        if let Some(eno) = eno {
            let path = self.path_of(eno, range);
            let truth = self.add_const(1, Elementary::Bool, range);
            otherwise.push(self.add_stmt(StmtKind::Assign(path, truth), range));
        }
        let arms = vec![(real, vec![call])];
        self.add_stmt(StmtKind::If { arms, otherwise }, range)
    }

    /// `MOCK_FUNCTION function RETURNS value;`
    pub(crate) fn mock_function(
        &mut self,
        function: st::Id<st::Expr>,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) {
        if !self.in_test() {
            return self.outside_of_test("MOCK_FUNCTION", range);
        }
        let Some(found) = self.function_to_mock(function) else {
            self.expr(value, None);
            return;
        };
        self.an.complete(found);
        let Some(result) = self.an.pou(found).result else {
            let range = self.arena()[function].range;
            self.error(Message::E3014, range, "this function gives no value");
            return;
        };
        let value = self.expr(value, Some(result));
        let mocked = self.an.mocked_function(found);
        let mocked = mocked.expect("functions are noted before bodies are looked at");
        self.store(&whole_tag(mocked.value), result, &value, range);
        let flag = self.add_path(Root::Tag(mocked.flag), Vec::new(), range);
        let truth = self.add_const(1, Elementary::Bool, range);
        self.before(StmtKind::Assign(flag, truth), range);
    }

    /// The function at a path; a message if there is none, or it cannot be mocked.
    fn function_to_mock(&mut self, path: st::Id<st::Expr>) -> Option<PouId> {
        let range = self.arena()[path].range;
        let found = self.an.found(self.unit, self.namespace, path)?;
        match found.first() {
            Some(&Def::Pou(pou)) if self.an.pou(pou).kind == PouKind::Function => {
                if !self.an.is_library(self.an.pou(pou).unit) {
                    return Some(pou);
                }
                let name = self.text(self.an.pou(pou).name);
                let message = format!("`{name}` is a standard function, which cannot be mocked");
                self.error(Message::E3062, range, message);
            }
            Some(_) => {
                self.error(Message::E3062, range, "a function is needed here");
            }
            None => {
                let mut diagnostic = Diagnostic::new(
                    Message::E1018,
                    self.span(range),
                    "there is no such function",
                );
                if let st::ExprKind::Name(name) = self.arena()[path].kind
                    && let Some(close) = self.an.similar(name, self.an.visible(self.namespace))
                {
                    diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
                }
                self.report(diagnostic);
            }
        }
        None
    }

    /// What the body of a function does first, if some test mocks it.
    pub(crate) fn mocked_result(&mut self, function: PouId, body: &mut Block) {
        let Some(mocked) = self.an.mocked_function(function) else {
            return;
        };
        let Some(result) = self.an.pou(function).result else {
            return;
        };
        let range = TextRange::default();
        let own = self.result.map(Root::Local);
        let Some(root) = own.or(self.result_ref.map(Root::Ref)) else {
            return;
        };
        let outer = std::mem::take(&mut self.pending);
        let target = Place {
            root,
            steps: Vec::new(),
            rights: Rights::All,
        };
        let value = tag_operand(mocked.value, result, range);
        self.store(&target, result, &value, range);
        self.before(StmtKind::Return, range);
        let then = std::mem::replace(&mut self.pending, outer);
        let path = self.add_path(Root::Tag(mocked.flag), Vec::new(), range);
        let flag = self.add_expr(ExprKind::Load(path), Elementary::Bool, range);
        let kind = StmtKind::If {
            arms: vec![(flag, then)],
            otherwise: Block::new(),
        };
        body.push(self.add_stmt(kind, range));
    }
}
