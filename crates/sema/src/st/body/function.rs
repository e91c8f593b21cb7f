//! Calls of functions and methods, of the user and of the library.

use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::CompareOp;
use crate::hir::code::{
    BinaryOp as Op, Call, Conversion, ExprId, ExprKind, PathId, Root, StmtKind, UnaryOp as Unary,
};
use crate::st::constant::Const;
use crate::st::elementary::{El, Family};
use crate::st::signature::{Bindings, NamespaceId, PouId, Storage, Var};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{
    self, Argument, ArgumentKind, BinaryOp, Declarations, ExprKind as Written, SectionKind,
    TypeKind as WrittenType, UnaryOp, UnitKind,
};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// A call of a function, which may be overloaded or generic.
    pub(super) fn function_call(
        &mut self,
        functions: &[PouId],
        arguments: st::List<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let first = functions[0];
        if !self.an.is_library(self.an.pou(first).unit) {
            return self.user_call(first, None, arguments, range);
        }
        let written: Vec<Argument> = self.arena()[arguments].to_vec();
        let mut operands = Vec::with_capacity(written.len());
        for argument in &written {
            let Some(value) = argument.value else {
                continue;
            };
            match argument.kind {
                ArgumentKind::Input(name)
                | ArgumentKind::Output(name)
                | ArgumentKind::NegatedOutput(name)
                    if self.is_enable(name.name) => {}
                _ => operands.push((argument.kind, self.expr(value, None))),
            }
        }
        if operands.iter().any(|(_, operand)| operand.is_error()) {
            return Operand::error(range);
        }
        let eno = self.eno_target(arguments);
        self.library(functions, operands, eno, range, want)
    }

    /// A call of a library function by its name, made by the compiler.
    pub(super) fn library_call(
        &mut self,
        name: &str,
        operands: Vec<Operand>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let functions = self.an.library_functions(name);
        if functions.is_empty() {
            let message = format!("the library has no {name} yet");
            return self.error(Message::E2010, range, message);
        }
        let operands = operands
            .into_iter()
            .map(|operand| (ArgumentKind::Positional, operand))
            .collect();
        self.library(&functions, operands, None, range, want)
    }

    fn library(
        &mut self,
        functions: &[PouId],
        operands: Vec<(ArgumentKind, Operand)>,
        eno: Option<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        for &function in functions {
            if let Some(bound) = self.bind(function, &operands, want) {
                return self.bound_call(function, bound, operands, eno, range, want);
            }
        }
        let name = self.text(self.an.pou(functions[0]).name);
        let types: Vec<String> = operands
            .iter()
            .map(|(_, operand)| self.type_name(operand.ty))
            .collect();
        let message = format!("{name} does not take ({})", types.join(", "));
        self.error(Message::E3021, range, message)
    }

    /// What the generic names of a library function stand for with these arguments; `None` if they
    /// do not fit.
    fn bind(
        &mut self,
        function: PouId,
        operands: &[(ArgumentKind, Operand)],
        want: Option<TypeId>,
    ) -> Option<Bound> {
        let parameters = self.an.library_parameters(function);
        let extensible = self.an.pragma(function, "extensible");
        let mut bound = Bound::default();
        let mut generics: Vec<(Symbol, Option<TypeId>)> = Vec::new();
        for (index, (kind, operand)) in operands.iter().enumerate() {
            let position = match kind {
                ArgumentKind::Positional if extensible => index.min(parameters.len() - 1),
                ArgumentKind::Positional => index,
                ArgumentKind::Input(name)
                | ArgumentKind::Output(name)
                | ArgumentKind::NegatedOutput(name) => {
                    parameters.iter().position(|p| p.name == name.name)?
                }
            };
            let parameter = parameters.get(position)?;
            bound.positions.push(position);
            match &parameter.ty {
                ParameterType::Generic(name, class) => {
                    let known = generics.iter_mut().find(|(known, _)| known == name);
                    let slot = match known {
                        Some((_, slot)) => slot,
                        None => {
                            generics.push((*name, None));
                            &mut generics.last_mut().expect("just pushed").1
                        }
                    };
                    let before = *slot;
                    let joined = self.join(before, operand, *class)?;
                    let slot = generics.iter_mut().find(|(known, _)| known == name);
                    slot.expect("found above").1 = joined;
                }
                ParameterType::OpenText { wide } => match *self.an.types.base(operand.ty) {
                    TypeKind::Text { wide: w, .. } if w == *wide => {
                        let ty = self.an.types.strip(operand.ty);
                        bound.bindings.open.push((parameter.name, ty));
                    }
                    _ => return None,
                },
                ParameterType::Written => {}
            }
        }
        for parameter in &parameters {
            if let ParameterType::Generic(name, class) = parameter.ty {
                let ty = generics.iter().find(|(known, _)| *known == name);
                let ty = ty.and_then(|(_, ty)| *ty);
                let ty = ty.or_else(|| self.open_generic(class, operands, want))?;
                if !bound
                    .bindings
                    .generics
                    .iter()
                    .any(|(known, _)| *known == name)
                {
                    bound.bindings.generics.push((name, ty));
                }
            }
        }
        Some(bound)
    }

    /// The type of a generic name after one more argument. Literals leave it open.
    fn join(
        &mut self,
        known: Option<TypeId>,
        operand: &Operand,
        class: Generic,
    ) -> Option<Option<TypeId>> {
        if matches!(operand.ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL) {
            let fits = match known.and_then(|ty| self.an.types.elementary(ty)) {
                Some(el) => el.is_real() || operand.ty == TypeId::UNTYPED_INT,
                None => class.takes_literal(operand.ty),
            };
            return fits.then_some(known);
        }
        let ty = self.an.types.strip(operand.ty);
        let own = match self.an.types.elementary(ty) {
            Some(el) if class.takes(el) => TypeId::of(el),
            Some(_) => return None,
            None => match self.an.types.kind(ty) {
                TypeKind::Text { .. } if class.takes_text() => ty,
                TypeKind::Enum(_) if class.takes_enum() => ty,
                _ if class == Generic::Any => ty,
                _ => return None,
            },
        };
        let Some(known) = known else {
            return Some(Some(own));
        };
        if known == own {
            return Some(Some(own));
        }
        match (
            self.an.types.elementary(known),
            self.an.types.elementary(own),
        ) {
            (Some(a), Some(b)) => {
                let common = a.common(b).filter(|el| class.takes(*el))?;
                Some(Some(TypeId::of(common)))
            }
            _ => match (self.an.types.kind(known), self.an.types.kind(own)) {
                (TypeKind::Text { wide: a, length: m }, TypeKind::Text { wide: b, length: n })
                    if a == b =>
                {
                    Some(Some(if m >= n { known } else { own }))
                }
                _ => None,
            },
        }
    }

    /// The type of a generic name with literals only: the wanted one, or that of the literals.
    fn open_generic(
        &mut self,
        class: Generic,
        operands: &[(ArgumentKind, Operand)],
        want: Option<TypeId>,
    ) -> Option<TypeId> {
        let fraction = operands.iter().any(|(_, o)| o.ty == TypeId::UNTYPED_REAL);
        if let Some(el) = want.and_then(|ty| self.an.types.elementary(ty))
            && class.takes(el)
            && (el.is_real() || !fraction)
            && (el.is_num() || el.is_bits())
        {
            return Some(TypeId::of(el));
        }
        if class == Generic::Real || (fraction && class.takes(El::Real)) {
            return Some(TypeId::of(El::Real));
        }
        let untyped = operands.iter().find(|(_, o)| o.ty == TypeId::UNTYPED_INT);
        let settled = untyped.map(|(_, operand)| self.settle(operand))?;
        let el = self.an.types.elementary(settled)?;
        if class.takes(el) {
            return Some(settled);
        }
        let value = untyped
            .and_then(|(_, o)| o.as_const())
            .and_then(Const::as_int)?;
        let fits = |el: &&El| class.takes(**el) && !el.is_real() && el.range().1 >= value;
        El::ALL.iter().find(fits).map(|el| TypeId::of(*el))
    }

    fn bound_call(
        &mut self,
        function: PouId,
        bound: Bound,
        operands: Vec<(ArgumentKind, Operand)>,
        eno: Option<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if let Some(name) = self.an.intrinsic(function) {
            let mut ordered: Vec<(usize, Operand)> = bound
                .positions
                .iter()
                .copied()
                .zip(operands.into_iter().map(|(_, operand)| operand))
                .collect();
            ordered.sort_by_key(|(position, _)| *position);
            let operands = ordered.into_iter().map(|(_, operand)| operand).collect();
            let name = name.to_owned();
            let result = self.an.library_result(function, &bound.bindings).or(want);
            if let Some(eno) = eno {
                let place = self.temporary("ENO", TypeId::BOOL);
                self.eno_to(false, place, &eno);
            }
            return self.intrinsic(&name, &bound.bindings, operands, range, result);
        }
        if self.constant_only {
            return self.error(Message::E2030, range, "a constant is needed here");
        }
        let instance = self.an.instance(function, bound.bindings);
        if operands.len() > bound.positions.iter().max().map_or(0, |p| p + 1) {
            return self.folded_call(instance, operands, range);
        }
        let vars: Vec<Var> = self.an.parameters(instance);
        let arguments = bound
            .positions
            .iter()
            .zip(operands)
            .map(|(position, (_, operand))| (vars[*position].clone(), operand))
            .collect();
        self.finish_call(instance, None, arguments, Vec::new(), eno, range)
    }

    /// An extensible function with more than two arguments: from the left, two at a time.
    fn folded_call(
        &mut self,
        instance: PouId,
        operands: Vec<(ArgumentKind, Operand)>,
        range: TextRange,
    ) -> Operand {
        let vars = self.an.parameters(instance);
        let mut operands = operands.into_iter().map(|(_, operand)| operand);
        let mut result = operands
            .next()
            .expect("extensible functions have arguments");
        for operand in operands {
            let arguments = vec![(vars[0].clone(), result), (vars[1].clone(), operand)];
            result = self.finish_call(instance, None, arguments, Vec::new(), None, range);
        }
        result
    }

    /// A call of a function or method of the user.
    pub(super) fn user_call(
        &mut self,
        callee: PouId,
        place: Option<Place>,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Operand {
        self.an.complete(callee);
        let matched = self.matched(callee, arguments, range);
        self.require_in_outs(callee, &matched, range);
        let (mut given, mut outputs) = (Vec::new(), Vec::new());
        for (var, argument) in matched {
            let Some(value) = argument.value else {
                continue;
            };
            match var.section {
                SectionKind::Output => outputs.push((var, argument)),
                SectionKind::InOut => {
                    let operand = self.place(value, None);
                    given.push((var, operand));
                }
                _ => {
                    let operand = self.expr(value, Some(var.ty));
                    given.push((var, operand));
                }
            }
        }
        let eno = self.eno_target(arguments);
        self.finish_call(callee, place, given, outputs, eno, range)
    }

    /// Writes a call down: omitted inputs take their defaults, outputs go where they are wanted.
    fn finish_call(
        &mut self,
        callee: PouId,
        place: Option<Place>,
        given: Vec<(Var, Operand)>,
        outputs: Vec<(Var, Argument)>,
        eno: Option<Argument>,
        range: TextRange,
    ) -> Operand {
        let shape = self.an.call_shape(callee);
        let pou = self.an.pou(callee).clone();
        let find = |name| {
            given
                .iter()
                .find(|(var, _)| var.name == name)
                .map(|(_, o)| o.clone())
        };
        let (mut refs, mut args, mut after) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(place) = &place {
            refs.push(self.path_of(place, range));
        }
        for &index in &shape.refs {
            let var = &pou.vars[index];
            let path = match var.section {
                SectionKind::InOut => match find(var.name) {
                    Some(operand) => self.reference_argument(var, &operand),
                    None => None,
                },
                SectionKind::Output => {
                    let place = self.temporary(self.text(var.name), var.ty);
                    let path = self.path_of(&place, range);
                    after.push((var.name, place, var.ty));
                    Some(path)
                }
                _ => Some(self.aggregate_argument(callee, var, find(var.name), range)),
            };
            let Some(path) = path else {
                return Operand {
                    ty: TypeId::ERROR,
                    ..Operand::error(range)
                };
            };
            refs.push(path);
        }
        for &index in &shape.params {
            let var = &pou.vars[index];
            let value = match find(var.name) {
                Some(operand) => self.to_scalar(&operand, var.ty),
                None => self.default_argument(var, range),
            };
            args.push(value);
        }
        let result_place = match pou.result {
            Some(ty) if shape.result_by_ref => {
                let place = self.temporary("result", ty);
                refs.push(self.path_of(&place, range));
                Some(place)
            }
            _ => None,
        };
        let call = Call {
            callee: self.an.want(callee),
            refs,
            args,
            outputs: Vec::new(),
        };
        self.emit_call(call, &shape, &pou, result_place, &outputs, &after, eno, range)
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of one call")]
    fn emit_call(
        &mut self,
        mut call: Call,
        shape: &crate::st::signatures::CallShape,
        pou: &crate::st::signature::Pou,
        result_place: Option<Place>,
        outputs: &[(Var, Argument)],
        by_ref: &[(Symbol, Place, TypeId)],
        eno: Option<Argument>,
        range: TextRange,
    ) -> Operand {
        // Outputs pass through temporaries: a target may have another type, or be negated.
        let mut moves = Vec::new();
        for (var, argument) in outputs {
            let from = match by_ref.iter().find(|(name, ..)| *name == var.name) {
                Some((_, place, ty)) => (place.clone(), *ty),
                None => {
                    let place = self.temporary(self.text(var.name), var.ty);
                    let position = shape
                        .results
                        .iter()
                        .position(|i| pou.vars[*i].name == var.name);
                    let Some(position) = position else { continue };
                    let position = position as u32 + u32::from(shape.result_by_value);
                    let path = self.path_of(&place, range);
                    call.outputs.push((position, path));
                    (place, var.ty)
                }
            };
            moves.push((from, *argument));
        }
        let eno = eno.map(|argument| (argument, self.temporary("ENO", TypeId::BOOL)));
        if let (true, Some((_, place))) = (shape.eno, &eno) {
            let position = shape.results.len() as u32 + u32::from(shape.result_by_value);
            let path = self.path_of(place, range);
            call.outputs.push((position, path));
        }
        let direct = moves.is_empty() && eno.is_none() && shape.result_by_value;
        let ty = match pou.result {
            Some(ty) if shape.result_by_value => self.an.scalar(ty),
            _ => crate::hir::Elementary::Bool,
        };
        let call = self.add_call(call);
        let value = self.add_expr(ExprKind::Call(call), ty, range);
        if direct {
            return Operand::value(value, pou.result.expect("by value"), range);
        }
        let result = if shape.result_by_value {
            let result_ty = pou.result.expect("by value");
            let place = self.temporary("result", result_ty);
            let path = self.path_of(&place, range);
            self.before(StmtKind::Assign(path, value), range);
            Some(place)
        } else {
            self.before(StmtKind::Eval(value), range);
            result_place
        };
        for ((place, ty), argument) in moves {
            let from = Operand {
                kind: OperandKind::Place(place),
                ty,
                range: argument.range,
            };
            if let Some(target) = argument.value {
                self.output_to(from, target, &argument);
            }
        }
        if let Some((argument, place)) = eno {
            self.eno_to(shape.eno, place, &argument);
        }
        match (result, pou.result) {
            (Some(place), Some(ty)) => Operand {
                kind: OperandKind::Place(place),
                ty,
                range,
            },
            _ => Operand {
                kind: OperandKind::Const(Const::Null),
                ty: TypeId::NOTHING,
                range,
            },
        }
    }

    fn reference_argument(&mut self, var: &Var, operand: &Operand) -> Option<PathId> {
        if operand.is_error() {
            return None;
        }
        let OperandKind::Place(_) = &operand.kind else {
            let message = format!("in-out `{}` takes a variable", self.text(var.name));
            self.error(Message::E3015, operand.range, message);
            return None;
        };
        let place = self.writable(operand)?;
        if self.an.types.strip(operand.ty) != self.an.types.strip(var.ty) {
            self.mismatch(operand, var.ty);
            return None;
        }
        Some(self.path_of(&place, operand.range))
    }

    /// A structure, array or string by value: library code only reads it, others get a copy.
    fn aggregate_argument(
        &mut self,
        callee: PouId,
        var: &Var,
        operand: Option<Operand>,
        range: TextRange,
    ) -> PathId {
        if let Some(operand) = &operand
            && let OperandKind::Place(place) = &operand.kind
            && self.an.types.strip(operand.ty) == self.an.types.strip(var.ty)
            && (place.rights == Rights::Temporary || self.an.is_library(self.an.pou(callee).unit))
        {
            let place = place.clone();
            return self.path_of(&place, operand.range);
        }
        let place = self.temporary(self.text(var.name), var.ty);
        match operand {
            Some(operand) => {
                let range = operand.range;
                self.store(&place, var.ty, &operand, range);
            }
            None => {
                let init = match var.initial {
                    Some(initial) => self.an.initial_value(initial, var.ty),
                    None => self.an.default_init(var.ty),
                };
                if let Some(init) = init {
                    let path = self.path_of(&place, range);
                    self.before(StmtKind::Initialise(path, init), range);
                }
            }
        }
        self.path_of(&place, range)
    }

    fn default_argument(&mut self, var: &Var, range: TextRange) -> ExprId {
        let init = match var.initial {
            Some(initial) => self.an.initial_value(initial, var.ty),
            None => self.an.default_init(var.ty),
        };
        let bits = init.map_or(0, |init| match self.an.hir.inits.get(init) {
            crate::hir::code::Init::Bits(bits) => *bits,
            _ => 0,
        });
        let ty = self.an.scalar(var.ty);
        self.add_const(bits, ty, range)
    }

    /// `INT_TO_REAL(x)` and the like: the function `TO_REAL` for an argument of type INT.
    pub(super) fn typed_conversion(
        &mut self,
        callee: st::Id<st::Expr>,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Option<Operand> {
        let Written::Name(name) = self.arena()[callee].kind else {
            return None;
        };
        if self.own_symbol(name) || !self.an.lookup(self.namespace, name).is_empty() {
            return None;
        }
        let (function, source) = self.an.typed_name(name)?;
        let functions = self.an.library_functions(&function);
        let [argument] = self.arena()[arguments] else {
            if functions.is_empty() {
                return None;
            }
            return self.typed_function(&functions, source, arguments, range);
        };
        let value = argument.value?;
        let operand = self.expr(value, Some(source));
        if operand.is_error() {
            return Some(Operand::error(range));
        }
        let value = self.as_type(operand, source);
        let operands = vec![(ArgumentKind::Positional, value)];
        Some(self.library(&functions, operands, None, range, None))
    }

    /// `ADD_INT(a, b)`: a generic function with the type of its arguments in its name.
    fn typed_function(
        &mut self,
        functions: &[PouId],
        source: TypeId,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Option<Operand> {
        let written: Vec<Argument> = self.arena()[arguments].to_vec();
        let mut operands = Vec::new();
        for argument in written {
            let operand = self.expr(argument.value?, Some(source));
            if operand.is_error() {
                return Some(Operand::error(range));
            }
            operands.push((argument.kind, self.as_type(operand, source)));
        }
        let eno = self.eno_target(arguments);
        Some(self.library(functions, operands, eno, range, Some(source)))
    }

    /// An operand as one of a type; texts keep their length.
    fn as_type(&mut self, operand: Operand, ty: TypeId) -> Operand {
        if !self.an.types.is_scalar(ty) {
            return operand;
        }
        let range = operand.range;
        if operand.as_const().is_some() {
            return match self.constant_to(&operand, ty) {
                Some(value) => Operand::constant(value, ty, range),
                None => Operand::error(range),
            };
        }
        let value = self.to_scalar(&operand, ty);
        Operand::value(value, ty, range)
    }

    /// An operation that the library names and the compiler knows.
    fn intrinsic(
        &mut self,
        name: &str,
        bindings: &Bindings,
        operands: Vec<Operand>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if let Some(op) = binary_intrinsic(name) {
            let chain = binary_is_comparison(op) && operands.len() > 2;
            let mut operands = operands.into_iter();
            let first = operands.next().expect("intrinsics have arguments");
            if chain {
                return self.error(
                    Message::E2010,
                    range,
                    "chained comparisons are not compiled yet",
                );
            }
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
            "now" => {
                let value = self.add_expr(ExprKind::Now, El::Ltime.storage(), range);
                Operand::value(value, TypeId::of(El::Ltime), range)
            }
            "elapsed" => {
                let operand = next();
                let OperandKind::Place(place) = &operand.kind else {
                    return self.error(Message::E3015, range, "ELAPSED takes a variable");
                };
                let place = place.clone();
                let path = self.path_of(&place, range);
                let value = self.add_expr(ExprKind::Elapsed(path), El::Ltime.storage(), range);
                Operand::value(value, TypeId::of(El::Ltime), range)
            }
            _ => {
                let message = format!("the intrinsic {name} is not compiled yet");
                self.error(Message::E2010, range, message)
            }
        }
    }

    fn unary_intrinsic(
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
        let value = self.to_scalar(&operand, ty);
        let value = self.add_expr(ExprKind::Unary(op, value), el.storage(), range);
        Operand::value(value, ty, range)
    }

    fn shift(
        &mut self,
        op: Op,
        value: Operand,
        count: Operand,
        ty: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let ty = ty.unwrap_or(value.ty);
        let el = self.an.types.elementary(ty).unwrap_or(El::Dword);
        let value = self.to_scalar(&value, ty);
        let count = self.shift_count(&count, range);
        let value = self.add_expr(ExprKind::Binary(op, value, count), el.storage(), range);
        Operand::value(value, ty, range)
    }

    /// A count as UDINT: below 0 it is 0, above everything it is large.
    fn shift_count(&mut self, count: &Operand, range: TextRange) -> ExprId {
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

    fn select(
        &mut self,
        which: Operand,
        first: Operand,
        second: Operand,
        ty: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let ty = ty.unwrap_or(first.ty);
        if !self.an.types.is_scalar(ty) {
            return self.error(
                Message::E2010,
                range,
                "SEL of this type is not compiled yet",
            );
        }
        let storage = self.an.scalar(ty);
        let which = self.to_scalar(&which, TypeId::BOOL);
        let (first, second) = (self.to_scalar(&first, ty), self.to_scalar(&second, ty));
        let kind = ExprKind::Select(which, second, first);
        let value = self.add_expr(kind, storage, range);
        Operand::value(value, ty, range)
    }

    /// `convert`, `trunc`: the result type is the wanted one, which the library declares.
    fn conversion(
        &mut self,
        name: &str,
        operand: Operand,
        want: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let Some(to) = want.and_then(|ty| self.an.types.elementary(ty)) else {
            return self.error(
                Message::E3021,
                range,
                "the type of the result is not known here",
            );
        };
        let from_ty = self.settle(&operand);
        let Some(from) = self.an.types.elementary(from_ty) else {
            self.mismatch(&operand, TypeId::of(to));
            return Operand::error(range);
        };
        let truncates = name.starts_with("trunc");
        if let Some(value) = operand.as_const()
            && let Some(value) = fold_conversion(value, from, to, truncates)
        {
            return Operand::constant(value, TypeId::of(to), range);
        }
        let value = self.to_scalar(&operand, from_ty);
        let value = self.convert_expr(value, from, to, truncates, range);
        Operand::value(value, TypeId::of(to), range)
    }

    fn convert_expr(
        &mut self,
        value: ExprId,
        from: El,
        to: El,
        truncates: bool,
        range: TextRange,
    ) -> ExprId {
        // Short times count milliseconds as numbers, long ones nanoseconds (9.3).
        const MILLISECOND: i64 = 1_000_000;
        let time = |el: El| el.is_duration() || el.is_date();
        let scaled = |el: El| time(el) && !el.is_long_time();
        if scaled(from) && to.is_num() {
            return self.scaled_from(value, to, MILLISECOND, range);
        }
        if scaled(to) && from.is_num() {
            return self.scaled_to(value, from, MILLISECOND, range);
        }
        let how = match (from.is_bits(), to.is_bits()) {
            _ if truncates => Conversion::Truncate,
            (true, _) | (_, true) if !(from.is_int() && to == El::Bool) => Conversion::Bits,
            _ => Conversion::Value,
        };
        if from.storage() == to.storage() {
            return value;
        }
        self.add_expr(ExprKind::Convert(how, value), to.storage(), range)
    }

    fn scaled_from(&mut self, value: ExprId, to: El, unit: i64, range: TextRange) -> ExprId {
        let wide = if to.is_real() { El::Lreal } else { El::Lint };
        let value = self.convert_value(value, wide, range);
        let unit = Const::Int(i128::from(unit)).bits(wide);
        let unit = self.add_const(unit, wide.storage(), range);
        let kind = ExprKind::Binary(Op::DivideUnchecked, value, unit);
        let value = self.add_expr(kind, wide.storage(), range);
        self.convert_value(value, to, range)
    }

    fn scaled_to(&mut self, value: ExprId, from: El, unit: i64, range: TextRange) -> ExprId {
        let wide = if from.is_real() { El::Lreal } else { El::Lint };
        let value = self.convert_value(value, wide, range);
        let unit = Const::Int(i128::from(unit)).bits(wide);
        let unit = self.add_const(unit, wide.storage(), range);
        let value = self.add_expr(
            ExprKind::Binary(Op::Multiply, value, unit),
            wide.storage(),
            range,
        );
        self.convert_value(value, El::Lint, range)
    }

    /// Copies a string into one of another length.
    pub(super) fn copy_text(
        &mut self,
        target: &Place,
        ty: TypeId,
        from: &Place,
        operand: &Operand,
        range: TextRange,
    ) {
        let to = Operand {
            kind: OperandKind::Place(Place {
                rights: Rights::All,
                ..target.clone()
            }),
            ty,
            range,
        };
        let from = Operand {
            kind: OperandKind::Place(from.clone()),
            ty: operand.ty,
            range: operand.range,
        };
        let functions = self.an.library_functions("__ASSIGN");
        if functions.is_empty() {
            self.error(
                Message::E2010,
                range,
                "strings of different lengths are not compiled yet",
            );
            return;
        }
        let operands = vec![
            (ArgumentKind::Positional, to),
            (ArgumentKind::Positional, from),
        ];
        let result = self.library(&functions, operands, None, range, None);
        if let OperandKind::Value(value) = result.kind {
            self.before(StmtKind::Eval(value), range);
        }
    }

    /// An input that sees edges.
    pub(super) fn edge_input(&mut self, target: &Place, edge: st::Edge, operand: &Operand) {
        let range = operand.range;
        let bool_storage = crate::hir::Elementary::Bool;
        let mut memory = target.clone();
        if let Some(crate::hir::code::PathStep::Field(field)) = memory.steps.last_mut() {
            *field += 1;
        }
        let now = self.to_scalar(operand, TypeId::BOOL);
        let level = match edge {
            st::Edge::Rising => now,
            st::Edge::Falling => {
                self.add_expr(ExprKind::Unary(Unary::Not, now), bool_storage, range)
            }
        };
        let held = self.add_local("edge", crate::hir::Type::Elementary(bool_storage));
        let path = self.add_path(Root::Local(held), Vec::new(), range);
        self.before(StmtKind::Assign(path, level), range);
        let load = |body: &mut Self, place: &Place| {
            let path = body.path_of(place, range);
            body.add_expr(ExprKind::Load(path), bool_storage, range)
        };
        let held_place = Place {
            root: Root::Local(held),
            steps: Vec::new(),
            rights: Rights::All,
        };
        let (level, was) = (load(self, &held_place), load(self, &memory));
        let not_was = self.add_expr(ExprKind::Unary(Unary::Not, was), bool_storage, range);
        let edge = self.add_expr(
            ExprKind::Binary(Op::And, level, not_was),
            bool_storage,
            range,
        );
        let path = self.path_of(target, range);
        self.before(StmtKind::Assign(path, edge), range);
        let level = load(self, &held_place);
        let path = self.path_of(&memory, range);
        self.before(StmtKind::Assign(path, level), range);
    }
}

/// What the arguments of a library call mean.
#[derive(Debug, Default)]
struct Bound {
    bindings: Bindings,
    /// The parameter of each argument.
    positions: Vec<usize>,
}

/// A parameter of a library function.
#[derive(Debug, Clone)]
pub(crate) struct Parameter {
    name: Symbol,
    ty: ParameterType,
}

#[derive(Debug, Clone)]
enum ParameterType {
    Generic(Symbol, Generic),
    OpenText { wide: bool },
    Written,
}

/// The generic names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Generic {
    Any,
    Elementary,
    Magnitude,
    Num,
    Real,
    Int,
    Unsigned,
    Signed,
    Duration,
    Bit,
    Chars,
    String,
    Char,
    Date,
}

impl Generic {
    const ALL: [(&'static str, Self); 14] = [
        ("ANY", Self::Any),
        ("ANY_ELEMENTARY", Self::Elementary),
        ("ANY_MAGNITUDE", Self::Magnitude),
        ("ANY_NUM", Self::Num),
        ("ANY_REAL", Self::Real),
        ("ANY_INT", Self::Int),
        ("ANY_UNSIGNED", Self::Unsigned),
        ("ANY_SIGNED", Self::Signed),
        ("ANY_DURATION", Self::Duration),
        ("ANY_BIT", Self::Bit),
        ("ANY_CHARS", Self::Chars),
        ("ANY_STRING", Self::String),
        ("ANY_CHAR", Self::Char),
        ("ANY_DATE", Self::Date),
    ];

    /// Whether an elementary type belongs to it.
    fn takes(self, el: El) -> bool {
        let family = el.family();
        match self {
            Self::Any | Self::Elementary => true,
            Self::Magnitude => el.is_num() || el.is_duration(),
            Self::Num => el.is_num(),
            Self::Real => el.is_real(),
            Self::Int => el.is_int(),
            Self::Unsigned => family == Family::Unsigned,
            Self::Signed => family == Family::Signed,
            Self::Duration => el.is_duration(),
            Self::Bit => el.is_bits(),
            Self::Chars | Self::Char => family == Family::Character,
            Self::String => false,
            Self::Date => el.is_date(),
        }
    }

    fn takes_text(self) -> bool {
        matches!(
            self,
            Self::Any | Self::Elementary | Self::Chars | Self::String
        )
    }

    fn takes_enum(self) -> bool {
        matches!(self, Self::Any | Self::Elementary)
    }

    fn takes_literal(self, ty: TypeId) -> bool {
        match self {
            Self::Any | Self::Elementary | Self::Magnitude | Self::Num | Self::Real => true,
            Self::Int | Self::Unsigned | Self::Signed | Self::Bit => ty == TypeId::UNTYPED_INT,
            Self::Duration | Self::Chars | Self::String | Self::Char | Self::Date => false,
        }
    }
}

impl crate::st::analysis::Analysis<'_> {
    /// The functions of the library with a name.
    pub(crate) fn library_functions(&self, name: &str) -> Vec<PouId> {
        let Some(symbol) = self.names.find(name) else {
            return Vec::new();
        };
        let defs = self.lookup_in(NamespaceId::LIBRARY, symbol);
        defs.iter()
            .filter_map(|def| match def {
                crate::st::signature::Def::Pou(pou) => Some(*pou),
                _ => None,
            })
            .collect()
    }

    /// The parameters of a library function as they are written.
    fn library_parameters(&self, function: PouId) -> Vec<Parameter> {
        let unit = self.unit(self.pou(function).unit);
        let UnitKind::Pou(pou) = &unit.kind else {
            return Vec::new();
        };
        let mut parameters = Vec::new();
        for section in &unit.arena[pou.sections] {
            let Declarations::Variables(variables) = section.declarations else {
                continue;
            };
            if !matches!(
                section.kind,
                SectionKind::Input | SectionKind::InOut | SectionKind::Output
            ) {
                continue;
            }
            for decl in &unit.arena[variables] {
                let ty = self.parameter_type(&unit.arena, decl.ty);
                for ident in &unit.arena[decl.names] {
                    parameters.push(Parameter {
                        name: ident.name,
                        ty: ty.clone(),
                    });
                }
            }
        }
        parameters
    }

    fn parameter_type(&self, arena: &st::Arena, ty: st::Id<st::TypeSpec>) -> ParameterType {
        let WrittenType::Named(path) = arena[ty].kind else {
            return ParameterType::Written;
        };
        let Written::Name(name) = arena[path].kind else {
            return ParameterType::Written;
        };
        let text = self.text(name).to_ascii_uppercase();
        match Generic::ALL.iter().find(|(generic, _)| *generic == text) {
            Some((_, class)) => ParameterType::Generic(name, *class),
            None if text == "STRING" => ParameterType::OpenText { wide: false },
            None if text == "WSTRING" => ParameterType::OpenText { wide: true },
            None => ParameterType::Written,
        }
    }

    /// The result that a library function declares.
    fn library_result(&mut self, function: PouId, bindings: &Bindings) -> Option<TypeId> {
        let pou = self.pou(function);
        let (unit, namespace) = (pou.unit, pou.namespace);
        let UnitKind::Pou(written) = &self.unit(unit).kind else {
            return None;
        };
        let scope = crate::st::resolve::TypeScope {
            unit,
            namespace,
            bindings: Some(bindings),
            pou: None,
        };
        written.result.map(|ty| self.type_of_spec(scope, ty))
    }

    /// Whether the library says something of a function.
    fn pragma(&self, function: PouId, word: &str) -> bool {
        let unit = self.unit(self.pou(function).unit);
        unit.pragmas.iter().any(|pragma| pragma.text.contains(word))
    }

    /// The operation a library function stands for.
    fn intrinsic<'s>(&'s self, function: PouId) -> Option<&'s str> {
        let unit = self.units[self.pou(function).unit.index()].unit;
        unit.pragmas.iter().find_map(|pragma| {
            let (_, rest) = pragma.text.split_once("intrinsic")?;
            let (_, rest) = rest.split_once('\'')?;
            rest.split_once('\'').map(|(name, _)| name)
        })
    }

    /// A library function with its generic names bound.
    fn instance(&mut self, function: PouId, bindings: Bindings) -> PouId {
        if bindings == Bindings::default() {
            self.complete(function);
            return function;
        }
        let key = (function, bindings);
        if let Some(&known) = self.instances.get(&key) {
            return known;
        }
        let mut pou = self.pou(function).clone();
        pou.bindings = key.1.clone();
        let made = self.add_pou(pou);
        self.instances.insert(key, made);
        self.complete(made);
        made
    }

    /// Inputs, outputs and in-outs in order.
    fn parameters(&self, pou: PouId) -> Vec<Var> {
        let vars = self.pou(pou).vars.iter();
        vars.filter(|var| {
            matches!(
                var.section,
                SectionKind::Input | SectionKind::Output | SectionKind::InOut
            )
        })
        .cloned()
        .collect()
    }

    /// `INT_TO_REAL`: TO_REAL and INT. `ADD_INT`: ADD and INT.
    fn typed_name(&self, name: Symbol) -> Option<(String, TypeId)> {
        let text = self.text(name).to_ascii_uppercase();
        for marker in ["_TO_BCD_", "_BCD_TO_", "_TRUNC_", "_TO_"] {
            if let Some((source, target)) = text.split_once(marker) {
                let ty = self.named_elementary(source)?;
                return Some((format!("{}{target}", &marker[1..]), ty));
            }
        }
        let (function, ty) = text.rsplit_once('_')?;
        Some((function.to_owned(), self.named_elementary(ty)?))
    }

    fn named_elementary(&self, name: &str) -> Option<TypeId> {
        let symbol = self.names.find(name)?;
        self.elementary_names.get(&symbol).copied()
    }

    /// A method of a block or class, or of what it extends.
    pub(crate) fn method(&self, pou: PouId, name: Symbol) -> Option<PouId> {
        let mut at = Some(pou);
        while let Some(id) = at {
            let signature = self.pou(id);
            if let Some((_, method)) = signature.members.iter().find(|(known, _)| *known == name) {
                return Some(*method);
            }
            at = signature.extends.first().copied();
        }
        None
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

fn binary_is_comparison(op: BinaryOp) -> bool {
    op.binding() == BinaryOp::Equal.binding() || op.binding() == BinaryOp::Less.binding()
}

/// A conversion of a constant, where its value fits.
fn fold_conversion(value: &Const, from: El, to: El, truncates: bool) -> Option<Const> {
    let time = |el: El| el.is_duration() || el.is_date();
    if time(from) || time(to) {
        return None;
    }
    let real = match value {
        Const::Int(number) => {
            if to.is_real() {
                return (!from.is_bits())
                    .then(|| Const::Real(crate::st::constant::round_to(to, *number as f64)));
            }
            if from.is_bits() && to == El::Bool {
                return Some(Const::Int(number & 1));
            }
            let (low, high) = to.range();
            return (low..=high).contains(number).then_some(Const::Int(*number));
        }
        Const::Real(real) | Const::Literal(_, real) => *real,
        Const::Text(_) | Const::Null => return None,
    };
    if to.is_real() {
        return Some(Const::Real(crate::st::constant::round_to(to, real)));
    }
    if !to.is_int() {
        return None;
    }
    let whole = if truncates {
        real.trunc()
    } else {
        real.round_ties_even()
    };
    let (low, high) = to.range();
    (whole >= low as f64 && whole <= high as f64)
        .then_some(Const::Int(whole as i128))
        .filter(|value| value.as_int().is_some_and(|v| (low..=high).contains(&v)))
}
