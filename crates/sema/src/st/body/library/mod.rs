//! Calls of the library: overloads, generic names, and what they stand for in a call.

mod generic;
mod intrinsic;
mod units;

use super::object::function_target;
use super::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::signature::{Bindings, PouId, Var};
use crate::st::types::{TypeId, TypeKind};
use generic::Generic;
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, ExprKind as Written};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Body<'_, '_> {
    pub(super) fn library(
        &mut self,
        functions: &[PouId],
        given: Given,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        for &function in functions {
            if let Some(bound) = self.bind(function, &given, want) {
                return self.bound_call(function, bound, given, range, want);
            }
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

    /// Reports a name that no parameter of any of the functions has.
    fn unknown_parameter(&mut self, functions: &[PouId], given: &Given) -> bool {
        let mut known = Vec::new();
        for &function in functions {
            let parameters = self.an.library_parameters(function);
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
        let parameters = self.an.library_parameters(function);
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

    /// What the generic names of a library function stand for with these arguments; `None` if they
    /// do not fit.
    fn bind(&mut self, function: PouId, given: &Given, want: Option<TypeId>) -> Option<Bound> {
        let (operands, fixed) = (&given.operands[..], given.fixed);
        let parameters = self.an.library_parameters(function);
        let extensible = self.an.pragma(function, "extensible");
        let mut bound = Bound::default();
        let mut generics: Vec<(Symbol, Option<TypeId>)> = Vec::new();
        if let Some(fixed) = fixed {
            // The type in the name of the function is that of its first generic parameter.
            let first = parameters.iter().find_map(|parameter| match parameter.ty {
                ParameterType::Generic(name, class) => Some((name, class)),
                ParameterType::OpenText { .. } | ParameterType::Written(_) => None,
            });
            if let Some((name, class)) = first {
                let el = self.an.types.elementary(fixed);
                let takes = el.map_or(class.takes_text(), |el| class.takes(el));
                if !takes {
                    return None;
                }
                if self.an.types.is_scalar(fixed) {
                    generics.push((name, Some(fixed)));
                }
            }
        }
        for (index, (kind, operand)) in operands.iter().enumerate() {
            let position = match kind {
                ArgumentKind::Positional if extensible => index.min(parameters.len() - 1),
                ArgumentKind::Positional => index,
                ArgumentKind::Input(name)
                | ArgumentKind::Output(name)
                | ArgumentKind::NegatedOutput(name) => {
                    let known = parameters.iter().position(|p| p.name == name.name);
                    let more = || extensible && self.names_the_next(&parameters, index, name.name);
                    known.or_else(|| more().then(|| parameters.len() - 1))?
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
                    if let (Some(fixed), Some((first, _))) = (fixed, generics.first())
                        && first == name
                        && joined != Some(fixed)
                        && self.an.types.is_scalar(fixed)
                    {
                        return None;
                    }
                    let slot = generics.iter_mut().find(|(known, _)| known == name);
                    slot.expect("found above").1 = joined;
                }
                ParameterType::OpenText { wide } => {
                    let ty = self.an.types.strip(operand.ty);
                    if !matches!(self.an.types.kind(ty), TypeKind::Text { wide: w, .. } if w == wide)
                    {
                        return None;
                    }
                    bound.bindings.open.push((parameter.name, ty));
                }
                ParameterType::Written(spec) => {
                    let ty = self.an.library_type(function, *spec);
                    if !self.fits(operand, ty) {
                        return None;
                    }
                }
            }
        }
        // Only by name can inputs be left out.
        let by_position = operands
            .iter()
            .all(|(kind, _)| *kind == ArgumentKind::Positional);
        if by_position && given.outputs.is_empty() && operands.len() < parameters.len() {
            return None;
        }
        for (position, parameter) in parameters.iter().enumerate() {
            // An argument says how long a string is.
            let open = matches!(parameter.ty, ParameterType::OpenText { .. });
            if open && !parameter.output && !bound.positions.contains(&position) {
                return None;
            }
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

    /// Whether a name goes on with the numbers in those of the parameters: IN3 after IN1 and IN2, where it
    /// stands in their order.
    fn names_the_next(&self, parameters: &[Parameter], index: usize, name: Symbol) -> bool {
        let Some(last) = parameters.last() else {
            return false;
        };
        let last_text = self.text(last.name);
        let base = last_text.trim_end_matches(|c: char| c.is_ascii_digit());
        let Ok(number) = last_text[base.len()..].parse::<usize>() else {
            return false;
        };
        let next = (number + index).checked_sub(parameters.len() - 1);
        next.is_some_and(|next| {
            self.text(name)
                .eq_ignore_ascii_case(&format!("{base}{next}"))
        })
    }

    /// Whether a generic name takes a type that is not elementary.
    fn takes_other(&self, class: Generic, ty: TypeId) -> bool {
        let types = &self.an.types;
        class == Generic::Any
            || types.is_text(ty) && class.takes_text()
            || types.enumeration(ty).is_some() && class.takes_enum()
    }

    /// The type of a generic name after one more argument. Literals leave it open.
    pub(super) fn join(
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
            Some(el) => class.takes(el).then(|| TypeId::of(el))?,
            None => self.takes_other(class, ty).then_some(ty)?,
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
    pub(super) fn open_generic(
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
        given: Given,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        let Given {
            operands,
            outputs,
            eno,
            ..
        } = given;
        if let Some(name) = self.an.intrinsic(function) {
            let mut ordered: Vec<(usize, Operand)> = bound
                .positions
                .iter()
                .copied()
                .zip(operands.into_iter().map(|(_, operand)| operand))
                .collect();
            ordered.sort_by_key(|(position, _)| *position);
            let name = name.to_owned();
            let operands = self.typed_operands(function, ordered);
            let result = self.an.library_result(function, &bound.bindings).or(want);
            // Of these only MUX can fail.
            if let (Some(eno), false) = (eno, name == "mux") {
                let place = self.temporary("ENO", TypeId::BOOL);
                self.eno_to(false, place, &eno);
            }
            return self.intrinsic(&name, &bound.bindings, operands, eno, range, result);
        }
        if operands.len()
            > bound
                .positions
                .iter()
                .max()
                .map_or(0, |position| position + 1)
        {
            if eno.is_some() {
                let message =
                    "ENO of a function with more inputs than it names is not compiled yet";
                return self.error(Message::E2010, range, message);
            }
            return self.folded_call(function, operands, range, want);
        }
        let instance = self.an.instance(function, bound.bindings);
        let vars: Vec<Var> = self.an.parameters(instance);
        let arguments = bound
            .positions
            .iter()
            .zip(operands)
            .map(|(position, (_, operand))| (vars[*position].clone(), operand))
            .collect();
        let outputs = outputs
            .into_iter()
            .filter_map(|(name, argument)| {
                let var = vars.iter().find(|var| var.name == name.name)?;
                Some((var.clone(), argument))
            })
            .collect();
        self.finish_call(function_target(instance), arguments, outputs, eno, range)
    }

    /// Operands of an intrinsic in the types that the library writes for them.
    fn typed_operands(&mut self, function: PouId, operands: Vec<(usize, Operand)>) -> Vec<Operand> {
        let parameters = self.an.library_parameters(function);
        let typed = operands.into_iter().map(|(position, operand)| {
            match parameters.get(position).map(|parameter| &parameter.ty) {
                Some(ParameterType::Written(spec)) => {
                    let ty = self.an.library_type(function, *spec);
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
                body.library(&[function], Given::positional([left, right]), range, want)
            });
        }
        let first = operands
            .next()
            .expect("extensible functions have arguments");
        operands.fold(first, |left, right| {
            if left.is_error() {
                return left;
            }
            self.library(&[function], Given::positional([left, right]), range, want)
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
        let functions = self.an.library_functions(&function);
        if functions.is_empty() {
            return None;
        }
        let want = if converts { None } else { want };
        let mut given = self.library_arguments(functions[0], arguments, converts.then_some(source));
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
        Some(self.library(&functions, given, range, want))
    }

    /// The arguments of a library function, EN and ENO left out.
    pub(super) fn library_arguments(
        &mut self,
        function: PouId,
        arguments: st::List<Argument>,
        want: Option<TypeId>,
    ) -> Given {
        let parameters = self.an.library_parameters(function);
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
                    if let Some(value) = argument.value {
                        let operand = self.expr(value, want);
                        given.operands.push((argument.kind, operand));
                    }
                }
            }
        }
        given
    }

    /// Whether an operand becomes one of a type without being asked.
    pub(super) fn fits(&self, operand: &Operand, to: TypeId) -> bool {
        let types = &self.an.types;
        if types.strip(operand.ty) == types.strip(to) {
            return true;
        }
        match (operand.ty, operand.as_const(), types.elementary(to)) {
            (TypeId::UNTYPED_INT, Some(Const::Int(value)), Some(el)) => {
                if el.is_real() {
                    return true;
                }
                let (low, high) = el.range();
                (el.is_int() || el.is_bits()) && (low..=high).contains(value)
            }
            (TypeId::UNTYPED_REAL, _, Some(el)) => el.is_real(),
            (_, Some(Const::Text(units)), Some(El::Char | El::Wchar)) => units.len() == 1,
            (_, _, Some(el)) => types
                .elementary(operand.ty)
                .is_some_and(|own| own.widens_to(el)),
            (_, _, None) => match (types.base(operand.ty), types.base(to)) {
                (TypeKind::Text { wide: a, .. }, TypeKind::Text { wide: b, .. }) => a == b,
                (TypeKind::Null, TypeKind::Reference(..) | TypeKind::Interface(_)) => true,
                _ => false,
            },
        }
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

    /// Whether a message has been given for one of them.
    pub(super) fn has_errors(&self) -> bool {
        self.operands.iter().any(|(_, operand)| operand.is_error())
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
    pub(super) name: Symbol,
    pub(super) output: bool,
    pub(super) ty: ParameterType,
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
