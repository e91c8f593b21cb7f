//! Operations that the library names and the compiler knows.

use crate::hir::CompareOp;
use crate::hir::code::{
    BinaryOp as Op, ExprId, ExprKind, PathId, PathStep, StmtKind, UnaryOp as Unary,
};
use crate::st::body::operator::compares;
use crate::st::body::{Body, Operand, OperandKind};
use crate::st::constant::Const;
use crate::st::elementary::{El, Family};
use crate::st::signature::{Bindings, PouId};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, Argument, BinaryOp, ExprKind as Written, UnaryOp};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// An operation that the library names and the compiler knows.
    pub(crate) fn intrinsic(
        &mut self,
        name: &str,
        bindings: &Bindings,
        operands: Vec<Operand>,
        eno: Option<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if let Some(op) = binary_intrinsic(name) {
            if compares(op) && operands.len() > 2 {
                return self.chain(op, operands, range);
            }
            if operands.len() < 2 {
                let message = "this function takes at least two arguments";
                return self.error(Message::E3021, range, message);
            }
            // One operand with a type says what the literals before it are.
            let typed = operands
                .iter()
                .find_map(|operand| self.number_beside(operand));
            let want = typed.or(want);
            let mut operands = operands.into_iter();
            let first = operands.next().expect("at least two");
            return operands.fold(first, |left, right| {
                self.binary_on(op, left, right, range, want)
            });
        }
        let ty = bindings.generics.first().map(|(_, ty)| *ty);
        let mut operands = operands.into_iter();
        let mut next = || operands.next().unwrap_or_else(|| Operand::error(range));
        match name {
            "not" => self.unary_on(UnaryOp::Not, next(), range, want),
            "neg" => self.unary_on(UnaryOp::Negate, next(), range, want),
            "move" => next(),
            "abs" => self.unary_intrinsic(Unary::Absolute, next(), ty, range),
            "sqrt" => self.unary_intrinsic(Unary::SquareRoot, next(), ty, range),
            "shl" => self.shift(Op::ShiftLeft, next(), next(), ty, range),
            "shr" => self.shift(Op::ShiftRight, next(), next(), ty, range),
            "sel" => self.select(next(), next(), next(), ty, range),
            _ if name.starts_with("convert") || name.starts_with("trunc") => {
                self.conversion(name, next(), want, range)
            }
            "length" => {
                let length = self.length(next(), range);
                match want {
                    Some(ty) => self.convert_length(length, ty, range),
                    None => length,
                }
            }
            "set_length" => self.set_length(next(), next(), range),
            "mux" => {
                let which = next();
                let inputs = operands.collect();
                self.multiplex(which, inputs, bindings, eno, range)
            }
            "now" => {
                let value = self.now(range);
                Operand::value(value, TypeId::of(El::Ltime), range)
            }
            "elapsed" => self.elapsed(ExprKind::Elapsed, El::Ltime, &next(), range),
            "elapsed_ms" => self.elapsed(ExprKind::ElapsedUnits, El::Dint, &next(), range),
            _ => {
                let message = format!("the intrinsic {name} is not compiled yet");
                self.error(Message::E2010, range, message)
            }
        }
    }

    /// The time since a variable was renewed.
    fn elapsed(
        &mut self,
        kind: fn(PathId) -> ExprKind,
        el: El,
        kept: &Operand,
        range: TextRange,
    ) -> Operand {
        let OperandKind::Place(place) = &kept.kind else {
            return self.error(Message::E3015, range, "ELAPSED takes a variable");
        };
        let path = self.path_of(place, range);
        let value = self.time_since(kind(path), el.storage(), path, range);
        Operand::value(value, TypeId::of(el), range)
    }

    /// `MAX_LENGTH(s)`, `LOWER_BOUND(a, 1)`: what is known from the type of the argument alone.
    pub(crate) fn type_query(
        &mut self,
        function: PouId,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Option<Operand> {
        let name = self.an.intrinsic(function)?;
        let lower = name == "lower_bound";
        if !(lower || matches!(name, "upper_bound" | "max_length")) {
            return None;
        }
        let bound = name != "max_length";
        let written: Vec<Argument> = self.arena()[arguments].to_vec();
        let value = written.first().and_then(|argument| argument.value)?;
        let ty = self.type_of(value)?;
        let number = match (self.an.types.base(ty).clone(), bound) {
            (TypeKind::Text { length, .. }, false) => Some(i128::from(length)),
            (TypeKind::Array { dimensions, .. }, true) => {
                let which = written.get(1).and_then(|argument| argument.value)?;
                let scope = self.type_scope();
                let which = self.an.constant_int(scope, which, TypeId::UNTYPED_INT)?;
                let index = usize::try_from(which).ok().and_then(|n| n.checked_sub(1));
                let found = index.and_then(|index| dimensions.get(index));
                let Some((low, high)) = found else {
                    let count = dimensions.len();
                    let message = format!("the array has {count} dimensions, none is {which}");
                    return Some(self.error(Message::E2004, range, message));
                };
                Some(i128::from(if lower { *low } else { *high }))
            }
            _ => None,
        };
        Some(match number {
            Some(number) => Operand::constant(Const::Int(number), TypeId::UNTYPED_INT, range),
            None => {
                let name = self.type_name(ty);
                self.error(Message::E3021, range, format!("{name} has no such limits"))
            }
        })
    }

    /// The type of an argument, which need not be constant and is not evaluated.
    fn type_of(&mut self, value: st::Id<st::Expr>) -> Option<TypeId> {
        if let Written::Name(name) = self.arena()[value].kind {
            let open = self.bindings.map_or(&[][..], |bindings| &bindings.open);
            if let Some((_, ty)) = open.iter().find(|(known, _)| *known == name) {
                return Some(*ty);
            }
            let own = self.pou.and_then(|pou| self.an.pou(pou).var(name));
            if let Some(var) = own {
                return Some(var.ty);
            }
        }
        let operand = self.expr(value, None);
        (!operand.is_error()).then_some(operand.ty)
    }

    /// `GT(a, b, c)`: every operand is compared with the next.
    fn chain(&mut self, op: BinaryOp, operands: Vec<Operand>, range: TextRange) -> Operand {
        self.chained(operands, range, &|body, left, right| {
            body.binary_on(op, left, right, range, None)
        })
    }

    /// Whether each of some operands compares with the next one.
    pub(crate) fn chained(
        &mut self,
        operands: Vec<Operand>,
        range: TextRange,
        compare: &dyn Fn(&mut Self, Operand, Operand) -> Operand,
    ) -> Operand {
        let held: Vec<Operand> = operands
            .into_iter()
            .map(|operand| self.hold(operand))
            .collect();
        let mut result: Option<Operand> = None;
        for pair in held.windows(2) {
            let next = compare(self, pair[0].clone(), pair[1].clone());
            result = Some(match result {
                None => next,
                Some(before) => self.binary_on(BinaryOp::And, before, next, range, None),
            });
        }
        result.unwrap_or_else(|| Operand::error(range))
    }

    /// An operand that can be used twice.
    pub(crate) fn hold(&mut self, operand: Operand) -> Operand {
        if !matches!(operand.kind, OperandKind::Value(_)) {
            return operand;
        }
        let (ty, range) = (operand.ty, operand.range);
        let place = self.temporary("held", ty);
        self.store(&place, ty, &operand, range);
        Operand {
            kind: OperandKind::Place(place),
            ty,
            range,
        }
    }

    /// How many characters a string has.
    fn length(&mut self, operand: Operand, range: TextRange) -> Operand {
        let storage = El::Dint.storage();
        let value = match &operand.kind {
            OperandKind::Const(Const::Text(units)) => {
                let length = Const::Int(units.len() as i128);
                return Operand::constant(length, TypeId::of(El::Dint), range);
            }
            OperandKind::Place(place) => {
                let mut steps = place.steps.clone();
                steps.push(PathStep::Field(0));
                let path = self.add_path(place.root, steps, range);
                self.add_expr(ExprKind::Load(path), storage, range)
            }
            OperandKind::Const(_) | OperandKind::Value(_) | OperandKind::Error => {
                return Operand::error(range);
            }
        };
        Operand::value(value, TypeId::of(El::Dint), range)
    }

    fn convert_length(&mut self, length: Operand, ty: TypeId, range: TextRange) -> Operand {
        let Some(el) = self.an.types.elementary(ty) else {
            return length;
        };
        if length.is_error() {
            return length;
        }
        if let Some(value) = length.as_const() {
            return Operand::constant(value.clone(), ty, range);
        }
        let value = self.raw(&length);
        let value = self.convert_value(value, el, range);
        Operand::value(value, ty, range)
    }

    /// Makes a string so many characters long, as far as it has room.
    fn set_length(&mut self, text: Operand, length: Operand, range: TextRange) -> Operand {
        let TypeKind::Text { length: limit, .. } = *self.an.types.base(text.ty) else {
            return Operand::error(range);
        };
        let OperandKind::Place(place) = &text.kind else {
            return Operand::error(range);
        };
        let mut steps = place.steps.clone();
        steps.push(PathStep::Field(0));
        let (root, el) = (place.root, El::Dint);
        let length = self.hold(length);
        let mut value = self.as_scalar(&length, TypeId::of(el));
        for (limit, op) in [(0, CompareOp::Less), (limit, CompareOp::Greater)] {
            let again = self.as_scalar(&length, TypeId::of(el));
            let limit = self.add_const(u64::from(limit), el.storage(), range);
            let kind = ExprKind::Compare(op, again, limit);
            let outside = self.add_expr(kind, crate::hir::Elementary::Bool, range);
            value = self.add_expr(ExprKind::Select(outside, limit, value), el.storage(), range);
        }
        let path = self.add_path(root, steps, range);
        self.before(StmtKind::Assign(path, value), range);
        Operand {
            kind: OperandKind::Const(Const::Null),
            ty: TypeId::NOTHING,
            range,
        }
    }

    /// `MUX(K, IN0, IN1, …)`: outside of the inputs the default of their type.
    fn multiplex(
        &mut self,
        which: Operand,
        inputs: Vec<Operand>,
        bindings: &Bindings,
        eno: Option<Argument>,
        range: TextRange,
    ) -> Operand {
        let ty = bindings.generics.get(1).map(|(_, ty)| *ty);
        let Some(ty) = ty.or_else(|| inputs.first().map(|input| input.ty)) else {
            return self.error(Message::E3021, range, "MUX needs inputs");
        };
        let which = self.hold(which);
        let place = self.temporary("mux", ty);
        if let Some(init) = self.an.default_init(ty) {
            let path = self.path_of(&place, range);
            self.before(StmtKind::Initialise(path, init), range);
        }
        // All inputs are evaluated, whichever counts.
        let inputs: Vec<Operand> = inputs.into_iter().map(|input| self.hold(input)).collect();
        let mut arms = Vec::with_capacity(inputs.len());
        for (number, input) in (0..).zip(&inputs) {
            let outer = std::mem::take(&mut self.pending);
            self.store(&place, ty, input, range);
            let block = std::mem::replace(&mut self.pending, outer);
            arms.push((vec![(number, number)], block));
        }
        let selector = self.raw(&which);
        let enabled = eno.map(|argument| (argument, self.temporary("ENO", TypeId::BOOL)));
        let mut otherwise = Vec::new();
        if let Some((_, flag)) = &enabled {
            let outer = std::mem::take(&mut self.pending);
            let inside = Operand::constant(Const::Int(1), TypeId::BOOL, range);
            self.store(flag, TypeId::BOOL, &inside, range);
            let set = std::mem::take(&mut self.pending);
            let outside = Operand::constant(Const::Int(0), TypeId::BOOL, range);
            self.store(flag, TypeId::BOOL, &outside, range);
            otherwise = std::mem::replace(&mut self.pending, outer);
            self.pending.extend(set);
        }
        let kind = StmtKind::Case {
            selector,
            arms,
            otherwise,
        };
        self.before(kind, range);
        if let Some((argument, flag)) = enabled {
            self.eno_to(true, flag, &argument);
        }
        Operand {
            kind: OperandKind::Place(place),
            ty,
            range,
        }
    }

    pub(crate) fn unary_intrinsic(
        &mut self,
        op: Unary,
        operand: Operand,
        ty: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let ty = ty.unwrap_or(operand.ty);
        let el = self.an.types.elementary(ty).unwrap_or(El::Real);
        if op == Unary::Absolute && el.family() == Family::Unsigned {
            return operand;
        }
        if operand.as_const().is_some() {
            return match self.constant_to(&operand, ty) {
                Some(Const::Int(value)) => self.folded(Const::Int(value.abs()), ty, range),
                Some(Const::Real(value)) if op == Unary::Absolute => {
                    self.folded(Const::Real(value.abs()), ty, range)
                }
                Some(Const::Real(value)) => {
                    let root = crate::st::constant::round_to(el, value.sqrt());
                    self.folded(Const::Real(root), ty, range)
                }
                Some(_) | None => Operand::error(range),
            };
        }
        let value = self.as_scalar(&operand, ty);
        let value = self.add_expr(ExprKind::Unary(op, value), el.storage(), range);
        Operand::value(value, ty, range)
    }

    pub(crate) fn shift(
        &mut self,
        op: Op,
        value: Operand,
        count: Operand,
        ty: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let ty = ty.unwrap_or(value.ty);
        let el = self.an.types.elementary(ty).unwrap_or(El::Dword);
        let value = self.as_scalar(&value, ty);
        let count = self.shift_count(&count, range);
        let value = self.add_expr(ExprKind::Binary(op, value, count), el.storage(), range);
        Operand::value(value, ty, range)
    }

    /// A count as UDINT: below 0 it is 0, above everything it is large.
    pub(crate) fn shift_count(&mut self, count: &Operand, range: TextRange) -> ExprId {
        if let Some(Const::Int(value)) = count.as_const() {
            let value = (*value).clamp(0, i128::from(u32::MAX));
            return self.add_const(value as u64, El::Udint.storage(), range);
        }
        let value = self.raw(count);
        let ty = self.code.expr(value).ty;
        let signed = ty.is_signed();
        let wide = self.convert_value(value, El::Lint, range);
        let storage = El::Lint.storage();
        let mut count = wide;
        if ty == El::Ulint.storage() {
            count = value;
        }
        let of = self.code.expr(count).ty;
        if signed {
            let zero = self.add_const(0, storage, range);
            let kind = ExprKind::Compare(CompareOp::Less, count, zero);
            let negative = self.add_expr(kind, crate::hir::Elementary::Bool, range);
            count = self.add_expr(ExprKind::Select(negative, zero, count), storage, range);
        }
        let limit = self.add_const(64, of, range);
        let kind = ExprKind::Compare(CompareOp::Greater, count, limit);
        let large = self.add_expr(kind, crate::hir::Elementary::Bool, range);
        let count = self.add_expr(ExprKind::Select(large, limit, count), of, range);
        self.convert_value(count, El::Udint, range)
    }

    fn select_whole(
        &mut self,
        which: Operand,
        first: Operand,
        second: Operand,
        ty: TypeId,
        range: TextRange,
    ) -> Operand {
        let place = self.temporary("sel", ty);
        let which = self.as_scalar(&which, TypeId::BOOL);
        let outer = std::mem::take(&mut self.pending);
        self.store(&place, ty, &second, range);
        let then = std::mem::take(&mut self.pending);
        self.store(&place, ty, &first, range);
        let otherwise = std::mem::replace(&mut self.pending, outer);
        let kind = StmtKind::If {
            arms: vec![(which, then)],
            otherwise,
        };
        self.before(kind, range);
        Operand {
            kind: OperandKind::Place(place),
            ty,
            range,
        }
    }

    pub(crate) fn select(
        &mut self,
        which: Operand,
        first: Operand,
        second: Operand,
        ty: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let ty = ty.unwrap_or(first.ty);
        if !self.an.types.is_scalar(ty) {
            return self.select_whole(which, first, second, ty, range);
        }
        let storage = self.an.scalar(ty);
        let which = self.as_scalar(&which, TypeId::BOOL);
        let (first, second) = (self.as_scalar(&first, ty), self.as_scalar(&second, ty));
        let kind = ExprKind::Select(which, second, first);
        let value = self.add_expr(kind, storage, range);
        Operand::value(value, ty, range)
    }
}

fn binary_intrinsic(name: &str) -> Option<BinaryOp> {
    Some(match name {
        "add" => BinaryOp::Add,
        "sub" => BinaryOp::Subtract,
        "mul" => BinaryOp::Multiply,
        "div" => BinaryOp::Divide,
        "mod" => BinaryOp::Modulo,
        "and" => BinaryOp::And,
        "or" => BinaryOp::Or,
        "xor" => BinaryOp::Xor,
        "eq" => BinaryOp::Equal,
        "ne" => BinaryOp::NotEqual,
        "lt" => BinaryOp::Less,
        "le" => BinaryOp::LessEqual,
        "gt" => BinaryOp::Greater,
        "ge" => BinaryOp::GreaterEqual,
        _ => return None,
    })
}
