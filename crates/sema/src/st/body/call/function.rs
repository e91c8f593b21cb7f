//! Calls of functions and methods, of the user and of the library.

use crate::hir::code::{Call, ExprId, ExprKind, PathId, StmtKind};
use crate::st::body::library::Given;
use crate::st::body::object::{Run, Target, function_target};
use crate::st::body::place::shared_bytes;
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::signature::{Bindings, Pou, PouId, Var};
use crate::st::signatures::CallShape;
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, Direction};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

/// A call that is being written down.
struct Passing {
    pou: Pou,
    shape: CallShape,
    call: Call,
    /// Where outputs are that are passed by reference.
    outputs: Vec<(Symbol, Place)>,
    range: TextRange,
}

fn operand_for(given: &[(Var, Operand)], name: Symbol) -> Option<&Operand> {
    let mut given = given.iter();
    given
        .find(|(var, _)| var.name == name)
        .map(|(_, operand)| operand)
}

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
        let mut given = self.stdlib_arguments(functions, arguments, None, want);
        if given.has_errors() {
            return Operand::error(range);
        }
        if self.text(self.an.pou(first).name).starts_with("TO_") {
            self.enumerations_as_numbers(&mut given);
        }
        self.call_stdlib(functions, given, range, want)
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
    pub(crate) fn stdlib_call(
        &mut self,
        name: &str,
        operands: Vec<Operand>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let functions = self.an.stdlib_functions(name);
        if functions.is_empty() {
            let message = format!("the library has no {name} yet");
            return self.error(Message::E2010, range, message);
        }
        self.call_stdlib(&functions, Given::positional(operands), range, want)
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
        let (mut given, mut outputs) = (Vec::<(Var, Operand)>::new(), Vec::new());
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
                    let earlier = given.iter_mut().filter_map(|(var, operand)| {
                        (var.section.direction() != Some(Direction::InOut)).then_some(operand)
                    });
                    let operand =
                        self.next_argument(earlier, |body| body.expr(value, Some(var.ty)));
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

    /// The instance that a call is for, as the first reference or value that is passed.
    pub(super) fn receiver(
        &mut self,
        target: &Target,
        range: TextRange,
    ) -> (Vec<PathId>, Vec<ExprId>) {
        match &target.run {
            Run::Function => (Vec::new(), Vec::new()),
            Run::On { instance, .. } => (vec![self.path_of(instance, range)], Vec::new()),
            Run::Choose { address, .. } => (Vec::new(), vec![*address]),
        }
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
        let (refs, args) = self.receiver(&target, range);
        let call = Call {
            callee: self.run_unit(&target),
            refs,
            args,
            outputs: Vec::new(),
        };
        let mut passing = Passing {
            pou: self.an.pou(target.signature).clone(),
            shape: self.shape_of(&target),
            call,
            outputs: Vec::new(),
            range,
        };
        if !self.pass_references(&mut passing, target.signature, &given) {
            return Operand::error(range);
        }
        self.pass_values(&mut passing, &given);
        let result = self.pass_result(&mut passing);
        self.emit_call(passing, result, &outputs, eno)
    }

    /// Passes in-outs, and inputs and outputs of more than one number; whether that went well.
    fn pass_references(
        &mut self,
        passing: &mut Passing,
        callee: PouId,
        given: &[(Var, Operand)],
    ) -> bool {
        let range = passing.range;
        for &index in &passing.shape.refs {
            let var = &passing.pou.vars[index];
            let operand = operand_for(given, var.name);
            let path = match var.section.direction() {
                Some(Direction::InOut) => {
                    operand.and_then(|operand| self.reference_argument(var, operand))
                }
                Some(Direction::Out) => {
                    let place = self.temporary(self.text(var.name), var.ty);
                    let path = self.path_of(&place, range);
                    passing.outputs.push((var.name, place));
                    Some(path)
                }
                Some(Direction::In) | None => {
                    Some(self.aggregate_argument(callee, var, operand.cloned(), range))
                }
            };
            let Some(path) = path else { return false };
            passing.call.refs.push(path);
        }
        true
    }

    fn pass_values(&mut self, passing: &mut Passing, given: &[(Var, Operand)]) {
        for &index in &passing.shape.params {
            let var = &passing.pou.vars[index];
            let value = match operand_for(given, var.name) {
                Some(operand) => self.as_scalar(operand, var.ty),
                None => self.default_argument(var, passing.range),
            };
            passing.call.args.push(value);
        }
    }

    /// Where a result goes that is more than one number.
    fn pass_result(&mut self, passing: &mut Passing) -> Option<Place> {
        let ty = passing.pou.result.filter(|_| passing.shape.result_by_ref)?;
        let place = self.temporary("result", ty);
        let path = self.path_of(&place, passing.range);
        passing.call.refs.push(path);
        Some(place)
    }

    fn emit_call(
        &mut self,
        mut passing: Passing,
        result: Option<Place>,
        outputs: &[(Var, Argument)],
        eno: Option<Argument>,
    ) -> Operand {
        let range = passing.range;
        let moves = self.moves(&mut passing, outputs);
        let eno = eno.map(|argument| (argument, self.temporary("ENO", TypeId::BOOL)));
        if let (true, Some((_, place))) = (passing.shape.eno, &eno) {
            let position = passing.shape.results.len();
            self.fetch(&mut passing, position, place);
        }
        let by_value = passing.pou.result.filter(|_| passing.shape.result_by_value);
        let storage = by_value.map_or(crate::hir::Elementary::Bool, |ty| self.an.scalar(ty));
        let call = self.add_call(passing.call);
        let value = self.add_expr(ExprKind::Call(call), storage, range);
        let result = match by_value {
            Some(ty) if moves.is_empty() && eno.is_none() => {
                return Operand::value(value, ty, range);
            }
            Some(ty) => {
                let place = self.temporary("result", ty);
                let path = self.path_of(&place, range);
                self.before(StmtKind::Assign(path, value), range);
                Some(place)
            }
            None => {
                self.before(StmtKind::Eval(value), range);
                result
            }
        };
        for (from, argument) in moves {
            if let Some(target) = argument.value {
                self.output_to(from, target, &argument);
            }
        }
        if let Some((argument, place)) = eno {
            self.eno_to(passing.shape.eno, place, &argument);
        }
        match (result, passing.pou.result) {
            (Some(place), Some(ty)) => Operand {
                kind: OperandKind::Place(place),
                ty,
                range,
            },
            (Some(_), None) | (None, _) => Operand::nothing(range),
        }
    }

    /// Outputs that are wanted, with where they go. They pass through temporaries: a target may have
    /// another type, or be negated.
    fn moves(
        &mut self,
        passing: &mut Passing,
        outputs: &[(Var, Argument)],
    ) -> Vec<(Operand, Argument)> {
        let mut moves = Vec::new();
        for (var, argument) in outputs {
            let by_ref = passing.outputs.iter().find(|(name, _)| *name == var.name);
            let place = match by_ref {
                Some((_, place)) => place.clone(),
                None => {
                    let mut results = passing.shape.results.iter();
                    let is_it = |index: &usize| passing.pou.vars[*index].name == var.name;
                    let Some(position) = results.position(is_it) else {
                        continue;
                    };
                    let place = self.temporary(self.text(var.name), var.ty);
                    self.fetch(passing, position, &place);
                    place
                }
            };
            let from = Operand {
                kind: OperandKind::Place(place),
                ty: var.ty,
                range: argument.range,
            };
            moves.push((from, *argument));
        }
        moves
    }

    /// Has one of the results stored at a place, counted without the result by value.
    fn fetch(&mut self, passing: &mut Passing, position: usize, place: &Place) {
        let position = position + usize::from(passing.shape.result_by_value);
        let path = self.path_of(place, passing.range);
        passing.call.outputs.push((position as u32, path));
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
        let functions = self.an.stdlib_functions("__ASSIGN");
        if functions.is_empty() {
            self.error(
                Message::E2010,
                range,
                "strings of different lengths are not compiled yet",
            );
            return;
        }
        let result = self.call_stdlib(&functions, Given::positional([to, from]), range, None);
        if let OperandKind::Value(value) = result.kind {
            self.before(StmtKind::Eval(value), range);
        }
    }
}
