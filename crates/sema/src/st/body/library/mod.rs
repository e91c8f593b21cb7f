//! Calls of the library: overloads, generic names, and what they stand for in a call.

mod binding;
mod generic;
mod intrinsic;
mod units;

use super::context::position_of;
use super::object::function_target;
use super::{Body, Operand};
use crate::st::signature::{PouId, Var};
use crate::st::types::TypeId;
use binding::Bound;
use generic::Generic;
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, ExprKind as Written};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

/// Most inputs of an extensible function.
const MAX_INPUTS: usize = 1024;

impl Body<'_, '_> {
    pub(super) fn call_stdlib(
        &mut self,
        functions: &[PouId],
        given: Given,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if given.operands.len() > MAX_INPUTS {
            let name = self.text(self.an.pou(functions[0]).name);
            let message = format!("`{name}` takes at most {MAX_INPUTS} inputs");
            return self.error(Message::E3018, range, message);
        }
        // Literals alone fit several overloads; the one that gives what is needed goes first.
        let wanted = want.filter(|_| given.has_literals());
        let suiting = functions
            .iter()
            .filter(|function| wanted.is_some_and(|want| self.suits(**function, &given, want)));
        let candidates: Vec<PouId> = suiting.chain(functions).copied().collect();
        if let Some((function, bound)) = self.first_bound(&candidates, &given, want) {
            return self.bound_call(function, bound, given, range, want);
        }
        let given = self.characters_as_texts(functions[0], given);
        if let Some((function, bound)) = self.first_bound(&candidates, &given, want) {
            return self.bound_call(function, bound, given, range, want);
        }
        if self.unknown_parameter(functions, &given) {
            return Operand::error(range);
        }
        if self.missing_argument(functions[0], &given, range) {
            return Operand::error(range);
        }
        let name = self.text(self.an.pou(functions[0]).name);
        let types: Vec<String> = given
            .operands
            .iter()
            .map(|(_, operand)| self.type_name(operand.ty))
            .collect();
        let message = format!("{name} does not take ({})", types.join(", "));
        self.error(Message::E3021, range, message)
    }

    /// The first function that takes the arguments.
    fn first_bound(
        &mut self,
        functions: &[PouId],
        given: &Given,
        want: Option<TypeId>,
    ) -> Option<(PouId, Bound)> {
        let mut functions = functions.iter();
        functions.find_map(|function| Some((*function, self.bind(*function, given, want)?)))
    }

    /// Characters become strings where nothing takes them as they are; but conversions are of what is
    /// written.
    fn characters_as_texts(&mut self, function: PouId, mut given: Given) -> Given {
        let converts = self.text(self.an.pou(function).name).starts_with("TO_");
        for (_, operand) in &mut given.operands {
            if !converts && self.character_width(operand).is_some() {
                *operand = self.character_text(operand);
            }
        }
        given
    }

    /// Reports a name that no parameter of any of the functions has.
    fn unknown_parameter(&mut self, functions: &[PouId], given: &Given) -> bool {
        let mut known = Vec::new();
        for &function in functions {
            let parameters = self.an.stdlib_parameters(function);
            known.extend(parameters.iter().map(|parameter| parameter.name));
        }
        let named = given.operands.iter().filter_map(|(kind, _)| match kind {
            ArgumentKind::Input(name) => Some(*name),
            ArgumentKind::Positional | ArgumentKind::Output(_) | ArgumentKind::NegatedOutput(_) => {
                None
            }
        });
        let unknown = named.into_iter().find(|name| !known.contains(&name.name));
        let Some(name) = unknown else { return false };
        self.no_parameter(functions[0], name, known);
        true
    }

    /// Reports inputs without an argument, where what is given does not say what is meant.
    fn missing_argument(&mut self, function: PouId, given: &Given, range: TextRange) -> bool {
        let parameters = self.an.stdlib_parameters(function);
        let positional = |(kind, _): &&(ArgumentKind, Operand)| *kind == ArgumentKind::Positional;
        let by_position = given.operands.iter().filter(positional).count();
        let is_given = |name| {
            let mut kinds = given.operands.iter().map(|(kind, _)| kind);
            kinds.any(|kind| matches!(kind, ArgumentKind::Input(given) if given.name == name))
        };
        let missing: Vec<&str> = parameters
            .iter()
            .skip(by_position)
            .filter(|parameter| !parameter.output && !is_given(parameter.name))
            .map(|parameter| self.text(parameter.name))
            .collect();
        if missing.is_empty() {
            return false;
        }
        let name = self.text(self.an.pou(function).name);
        let message = format!("`{name}` has no argument for `{}`", missing.join("`, `"));
        self.error(Message::E3022, range, message);
        true
    }

    fn bound_call(
        &mut self,
        function: PouId,
        bound: Bound,
        given: Given,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if let Some(name) = self.an.intrinsic(function) {
            let name = name.to_owned();
            return self.intrinsic_call(function, &name, bound, given, range, want);
        }
        let named = bound.positions.iter().max().map_or(0, |last| last + 1);
        if given.operands.len() > named {
            if given.eno.is_some() {
                let message =
                    "ENO of a function with more inputs than it names is not compiled yet";
                return self.error(Message::E2010, range, message);
            }
            return self.folded_call(function, given.operands, range, want);
        }
        let instance = self.an.instance(function, bound.bindings);
        let vars: Vec<Var> = self.an.parameters(instance);
        let operands = bound.positions.iter().zip(given.operands);
        let arguments = operands.map(|(position, (_, operand))| (vars[*position].clone(), operand));
        let outputs = given.outputs.into_iter().filter_map(|(name, argument)| {
            let var = vars.iter().find(|var| var.name == name.name)?;
            Some((var.clone(), argument))
        });
        let (arguments, outputs) = (arguments.collect(), outputs.collect());
        self.finish_call(
            function_target(instance),
            arguments,
            outputs,
            given.eno,
            range,
        )
    }

    /// A call of what the compiler knows, with its operands in the order of the parameters.
    fn intrinsic_call(
        &mut self,
        function: PouId,
        name: &str,
        bound: Bound,
        given: Given,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let operands = given.operands.into_iter().map(|(_, operand)| operand);
        let mut ordered: Vec<(usize, Operand)> =
            bound.positions.into_iter().zip(operands).collect();
        ordered.sort_by_key(|(position, _)| *position);
        let operands = self.typed_operands(function, ordered);
        let result = self.an.stdlib_result(function, &bound.bindings).or(want);
        // Of these only MUX can fail.
        if let (Some(eno), false) = (given.eno, name == "mux") {
            let place = self.temporary("ENO", TypeId::BOOL);
            self.eno_to(false, place, &eno);
        }
        self.intrinsic(name, &bound.bindings, operands, given.eno, range, result)
    }

    /// Operands of an intrinsic in the types that the library writes for them.
    fn typed_operands(&mut self, function: PouId, operands: Vec<(usize, Operand)>) -> Vec<Operand> {
        let parameters = self.an.stdlib_parameters(function);
        let typed = operands.into_iter().map(|(position, operand)| {
            match parameters.get(position).map(|parameter| &parameter.ty) {
                Some(ParameterType::Written(spec)) => {
                    let ty = self.an.stdlib_type(function, *spec);
                    if self.an.types.strip(ty) == self.an.types.strip(operand.ty) {
                        return operand;
                    }
                    self.as_type(operand, ty)
                }
                Some(ParameterType::Generic(..) | ParameterType::OpenText { .. }) | None => operand,
            }
        });
        typed.collect()
    }

    /// An extensible function with more than two arguments: from the left, two at a time; a
    /// comparison of each with the next one.
    fn folded_call(
        &mut self,
        function: PouId,
        operands: Vec<(ArgumentKind, Operand)>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let mut operands = operands.into_iter().map(|(_, operand)| operand);
        if self.an.pragma(function, "chain") {
            return self.chained(operands.collect(), range, &|body, left, right| {
                body.call_stdlib(&[function], Given::positional([left, right]), range, want)
            });
        }
        let first = operands
            .next()
            .expect("extensible functions have arguments");
        operands.fold(first, |left, right| {
            if left.is_error() {
                return left;
            }
            self.call_stdlib(&[function], Given::positional([left, right]), range, want)
        })
    }

    /// `INT_TO_REAL(x)` and `ADD_INT(a, b)`: functions with the type of their arguments in the name.
    pub(super) fn typed_conversion(
        &mut self,
        callee: st::Id<st::Expr>,
        arguments: st::List<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Option<Operand> {
        let Written::Name(name) = self.arena()[callee].kind else {
            return None;
        };
        if self.own_symbol(name) || !self.an.lookup(self.namespace, name).is_empty() {
            return None;
        }
        let (function, source, converts) = self.an.typed_name(name)?;
        let functions = self.an.stdlib_functions(&function);
        if functions.is_empty() {
            return None;
        }
        let want = if converts { None } else { want };
        let mut given = {
            let (source, want) = (converts.then_some(source), Some(source));
            self.stdlib_arguments(&functions, arguments, source, want)
        };
        if given.has_errors() {
            return Some(Operand::error(range));
        }
        if let ([(_, operand)], true) = (&mut given.operands[..], converts) {
            *operand = self.as_type(operand.clone(), source);
            if let Some(made) = self.time_and_bits(name, &function, operand, range) {
                return Some(made);
            }
            if given.eno.is_none()
                && let Some(folded) = self.folded_conversion(&function, operand, range)
            {
                return Some(folded);
            }
        }
        given.fixed = (!converts).then_some(source);
        Some(self.call_stdlib(&functions, given, range, want))
    }

    /// The arguments of a library function, EN and ENO left out. All are of type `source`, if it is
    /// given; else those made of literals alone take their types from others, or from what is wanted.
    pub(super) fn stdlib_arguments(
        &mut self,
        functions: &[PouId],
        arguments: st::List<Argument>,
        source: Option<TypeId>,
        want: Option<TypeId>,
    ) -> Given {
        let parameters = self.an.stdlib_parameters(functions[0]);
        let (mut open, mut typed) = (Vec::new(), Vec::new());
        let written: Vec<Argument> = self.arena()[arguments].to_vec();
        let mut given = Given {
            eno: self.eno_target(arguments),
            ..Given::default()
        };
        for (index, argument) in written.iter().enumerate() {
            let output = parameters.get(index).filter(|parameter| parameter.output);
            match argument.kind {
                ArgumentKind::Positional if output.is_some() => {
                    let name = output.map_or(self.an.words.eno, |parameter| parameter.name);
                    let range = argument.range;
                    given.outputs.push((st::Ident { name, range }, *argument));
                }
                ArgumentKind::Input(name)
                | ArgumentKind::Output(name)
                | ArgumentKind::NegatedOutput(name)
                    if self.is_enable(name.name) => {}
                ArgumentKind::Output(name) | ArgumentKind::NegatedOutput(name) => {
                    given.outputs.push((name, *argument));
                }
                ArgumentKind::Positional | ArgumentKind::Input(_) => {
                    let Some(value) = argument.value else {
                        continue;
                    };
                    let position = position_of(&parameters, index, &argument.kind);
                    if source.is_none() && self.is_open(value) {
                        open.push((given.operands.len(), position, value));
                        let later = Operand::error(argument.range);
                        given.operands.push((argument.kind, later));
                        continue;
                    }
                    let earlier = given.operands.iter_mut().map(|(_, operand)| operand);
                    let operand = self.next_argument(earlier, |body| body.expr(value, source));
                    let generic = position.and_then(|position| parameters[position].generic());
                    let ty = self.number_beside(&operand);
                    typed.extend(generic.zip(ty));
                    given.operands.push((argument.kind, operand));
                }
            }
        }
        for (at, position, value) in open {
            let ty = position.and_then(|position| {
                self.argument_type(functions, &parameters, position, &typed, want)
            });
            given.operands[at].1 = self.expr(value, ty);
        }
        given
    }

    /// An operand as one of a type; texts keep their length.
    pub(super) fn as_type(&mut self, operand: Operand, ty: TypeId) -> Operand {
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
        let value = self.as_scalar(&operand, ty);
        Operand::value(value, ty, range)
    }
}

/// The arguments of a library call.
#[derive(Debug, Default)]
pub(super) struct Given {
    /// Inputs and in-outs.
    pub operands: Vec<(ArgumentKind, Operand)>,
    /// Outputs, with where they go.
    pub outputs: Vec<(st::Ident, Argument)>,
    /// Where ENO goes.
    pub eno: Option<Argument>,
    /// The type that the name of the function says.
    pub fixed: Option<TypeId>,
}

impl Given {
    /// Arguments by position.
    pub(super) fn positional(operands: impl IntoIterator<Item = Operand>) -> Self {
        let operands = operands.into_iter();
        Self {
            operands: operands
                .map(|operand| (ArgumentKind::Positional, operand))
                .collect(),
            ..Self::default()
        }
    }

    /// Whether one of them has no type yet.
    fn has_literals(&self) -> bool {
        let untyped = [TypeId::UNTYPED_INT, TypeId::UNTYPED_REAL];
        let mut operands = self.operands.iter();
        operands.any(|(_, operand)| untyped.contains(&operand.ty))
    }

    /// Whether a message has been given for one of them.
    pub(super) fn has_errors(&self) -> bool {
        self.operands.iter().any(|(_, operand)| operand.is_error())
    }
}

/// A parameter of a library function.
#[derive(Debug, Clone)]
pub(crate) struct Parameter {
    pub(super) name: Symbol,
    pub(super) output: bool,
    pub(super) ty: ParameterType,
}

impl Parameter {
    /// The name of its generic type.
    fn generic(&self) -> Option<Symbol> {
        match self.ty {
            ParameterType::Generic(name, _) => Some(name),
            ParameterType::OpenText { .. } | ParameterType::Written(_) => None,
        }
    }
}

#[derive(Debug, Clone)]
pub(super) enum ParameterType {
    Generic(Symbol, Generic),
    OpenText {
        wide: bool,
    },
    /// A type that is not generic.
    Written(st::Id<st::TypeSpec>),
}
