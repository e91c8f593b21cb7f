//! Calls of functions and methods, of the user and of the library.

use crate::hir::code::{Call, ExprId, ExprKind, PathId, StmtKind};
use crate::st::body::library::Given;
use crate::st::body::object::{Run, Target, function_target};
use crate::st::body::place::shared_bytes;
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::signature::{Bindings, PouId, Var};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, Direction};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// A call of a function, which may be overloaded or generic.
    pub(crate) fn function_call(
        &mut self,
        functions: &[PouId],
        arguments: st::List<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let first = functions[0];
        if !self.an.is_library(self.an.pou(first).unit) {
            return self.user_call(function_target(first), arguments, range);
        }
        if let Some(value) = self.type_query(first, arguments, range) {
            return value;
        }
        let mut given = self.library_arguments(first, arguments, None);
        if given.has_errors() {
            return Operand::error(range);
        }
        if self.text(self.an.pou(first).name).starts_with("TO_") {
            self.enumerations_as_numbers(&mut given);
        }
        self.library(functions, given, range, want)
    }

    /// `TO_INT(colour)` of CODESYS: the number of a value of an enumeration.
    fn enumerations_as_numbers(&self, given: &mut Given) {
        for (_, operand) in &mut given.operands {
            let is_enum = matches!(self.an.types.base(operand.ty), TypeKind::Enum(_));
            if let Some(el) = self.number_behind(operand.ty).filter(|_| is_enum) {
                operand.ty = TypeId::of(el);
            }
        }
    }

    /// A call of a library function by its name, made by the compiler.
    pub(crate) fn library_call(
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
        self.library(&functions, Given::positional(operands), range, want)
    }

    /// A call of a function or method of the user.
    pub(crate) fn user_call(
        &mut self,
        target: Target,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Operand {
        let callee = target.signature;
        self.an.complete(callee);
        let Some(mut target) = self.open_target(target, arguments, range) else {
            return Operand::error(range);
        };
        let callee = target.signature;
        let matched = self.matched(callee, arguments, range);
        self.require_in_outs(callee, &matched, range);
        let mut presence = std::mem::take(&mut target.presence);
        let in_outs = self.present_in_outs(&matched, &mut presence);
        let eno = self.eno_target(arguments);
        self.if_present(presence, eno, range, |body| {
            body.with_arguments(target, matched, &in_outs, eno, range)
        })
    }

    /// A call on an instance that is there, with in-outs that are.
    fn with_arguments(
        &mut self,
        target: Target,
        matched: Vec<(Var, Argument)>,
        in_outs: &[(Symbol, Operand)],
        eno: Option<Argument>,
        range: TextRange,
    ) -> Operand {
        let (mut given, mut outputs) = (Vec::new(), Vec::new());
        for (var, argument) in matched {
            let Some(value) = argument.value else {
                continue;
            };
            match var.section.direction() {
                Some(Direction::Out) => outputs.push((var, argument)),
                Some(Direction::InOut) => {
                    let found = in_outs.iter().find(|(name, _)| *name == var.name);
                    let (_, operand) = found.expect("in-outs were looked for");
                    given.push((var, operand.clone()));
                }
                Some(Direction::In) | None => {
                    let operand = self.expr(value, Some(var.ty));
                    given.push((var, operand));
                }
            }
        }
        self.finish_call(target, given, outputs, eno, range)
    }

    /// The unit itself, or where it has open arrays the one for the arrays of this call; `None` after a
    /// mistake.
    pub(crate) fn open_instance(
        &mut self,
        callee: PouId,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Option<PouId> {
        if !self.an.has_open_arrays(callee) {
            return Some(callee);
        }
        let matched = self.matched(callee, arguments, range);
        let mut bindings = Bindings::default();
        for (var, argument) in &matched {
            let TypeKind::OpenArray {
                dimensions,
                element,
            } = *self.an.types.base(var.ty)
            else {
                continue;
            };
            let value = argument.value?;
            let operand = self.place(value, None);
            if operand.is_error() {
                return None;
            }
            let types = &self.an.types;
            let fits = matches!(
                types.base(operand.ty),
                TypeKind::Array { dimensions: given, element: of }
                    if given.len() == dimensions as usize
                        && types.strip(*of) == types.strip(element)
            );
            if !fits {
                self.mismatch(&operand, var.ty);
                return None;
            }
            let ty = types.strip(operand.ty);
            bindings.open.push((var.name, ty));
        }
        Some(self.an.instance(callee, bindings))
    }

    /// As `open_instance`, with the body that runs.
    fn open_target(
        &mut self,
        target: Target,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Option<Target> {
        let signature = self.open_instance(target.signature, arguments, range)?;
        if signature == target.signature {
            return Some(target);
        }
        let run = match target.run {
            Run::Function => Run::Function,
            Run::On { body, instance } if body == target.signature => Run::On {
                body: signature,
                instance,
            },
            Run::On { body, instance } => Run::On {
                body: self.open_instance(body, arguments, range)?,
                instance,
            },
            Run::Choose { .. } => {
                let message =
                    "a call with open arrays that is chosen at run time is not compiled yet";
                self.error(Message::E2010, range, message);
                return None;
            }
        };
        Some(Target {
            signature,
            run,
            presence: target.presence,
        })
    }

    /// Writes a call down: omitted inputs take their defaults, outputs go where they are wanted.
    pub(crate) fn finish_call(
        &mut self,
        target: Target,
        given: Vec<(Var, Operand)>,
        outputs: Vec<(Var, Argument)>,
        eno: Option<Argument>,
        range: TextRange,
    ) -> Operand {
        let callee = target.signature;
        let shape = self.shape_of(&target);
        let pou = self.an.pou(callee).clone();
        let find = |name| {
            given
                .iter()
                .find(|(var, _)| var.name == name)
                .map(|(_, o)| o.clone())
        };
        let (mut refs, mut args, mut after) = (Vec::new(), Vec::new(), Vec::new());
        match &target.run {
            Run::Function => {}
            Run::On { instance, .. } => refs.push(self.path_of(instance, range)),
            Run::Choose { address, .. } => args.push(*address),
        }
        for &index in &shape.refs {
            let var = &pou.vars[index];
            let path = match var.section.direction() {
                Some(Direction::InOut) => match find(var.name) {
                    Some(operand) => self.reference_argument(var, &operand),
                    None => None,
                },
                Some(Direction::Out) => {
                    let place = self.temporary(self.text(var.name), var.ty);
                    let path = self.path_of(&place, range);
                    after.push((var.name, place, var.ty));
                    Some(path)
                }
                Some(Direction::In) | None => {
                    Some(self.aggregate_argument(callee, var, find(var.name), range))
                }
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
                Some(operand) => self.as_scalar(&operand, var.ty),
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
            callee: self.run_unit(&target),
            refs,
            args,
            outputs: Vec::new(),
        };
        self.emit_call(
            call,
            &shape,
            &pou,
            result_place,
            &outputs,
            &after,
            eno,
            range,
        )
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
            _ => Operand::nothing(range),
        }
    }

    /// The place that an in-out stands for.
    pub(crate) fn reference_argument(&mut self, var: &Var, operand: &Operand) -> Option<PathId> {
        if operand.is_error() {
            return None;
        }
        if var.constant {
            return Some(self.constant_in_out(var, operand));
        }
        let OperandKind::Place(given) = &operand.kind else {
            let message = format!("in-out `{}` takes a variable", self.text(var.name));
            self.error(Message::E3015, operand.range, message);
            return None;
        };
        if let Some(what) = shared_bytes(given) {
            let name = self.text(var.name);
            let message = format!("in-out `{name}` takes a whole variable, not {what}");
            self.error(Message::E3015, operand.range, message);
            return None;
        }
        let place = self.writable(operand)?;
        if let Some(place) = self.as_base(&place, operand.ty, var.ty) {
            return Some(self.path_of(&place, operand.range));
        }
        if self.an.types.strip(operand.ty) != self.an.types.strip(var.ty) {
            if var.ty != TypeId::ERROR {
                self.mismatch(operand, var.ty);
            }
            return None;
        }
        Some(self.path_of(&place, operand.range))
    }

    /// What a VAR_IN_OUT CONSTANT stands for (CODESYS): nothing changes it, so a value will do.
    fn constant_in_out(&mut self, var: &Var, operand: &Operand) -> PathId {
        let same = self.an.types.strip(operand.ty) == self.an.types.strip(var.ty);
        if let (OperandKind::Place(place), true) = (&operand.kind, same)
            && shared_bytes(place).is_none()
        {
            let place = place.clone();
            return self.path_of(&place, operand.range);
        }
        let place = self.temporary(self.text(var.name), var.ty);
        self.store(&place, var.ty, operand, operand.range);
        self.path_of(&place, operand.range)
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
                if let Some(init) = self.own_init(var) {
                    let path = self.path_of(&place, range);
                    self.before(StmtKind::Initialise(path, init), range);
                }
            }
        }
        self.path_of(&place, range)
    }

    fn default_argument(&mut self, var: &Var, range: TextRange) -> ExprId {
        let init = self.own_init(var);
        self.init_expr(init, var.ty, range)
    }

    /// Copies a string into one of another length.
    pub(crate) fn copy_text(
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
        let result = self.library(&functions, Given::positional([to, from]), range, None);
        if let OperandKind::Value(value) = result.kind {
            self.before(StmtKind::Eval(value), range);
        }
    }
}
