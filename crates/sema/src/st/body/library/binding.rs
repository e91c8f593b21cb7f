//! Which argument of a call goes to which parameter of a library function, and what its generic names
//! stand for there.

use super::generic::Generic;
use super::{Given, Parameter, ParameterType};
use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::signature::{Bindings, PouId};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::ArgumentKind;

/// What the arguments of a library call mean.
#[derive(Debug, Default)]
pub(super) struct Bound {
    pub(super) bindings: Bindings,
    /// The parameter of each argument.
    pub(super) positions: Vec<usize>,
}

/// The generic names of a function, in the order in which they came up. Literals leave them open.
struct Generics {
    known: Vec<(Symbol, Option<TypeId>)>,
    /// The type in the name of the function, if it is a number: that of the first generic name.
    fixed: Option<TypeId>,
}

impl Generics {
    fn ty(&self, name: Symbol) -> Option<TypeId> {
        let found = self.known.iter().find(|(known, _)| *known == name);
        found.and_then(|(_, ty)| *ty)
    }

    /// Whether the name of the function lets a name stand for a type.
    fn allows(&self, name: Symbol, ty: Option<TypeId>) -> bool {
        let is_first = self.known.first().is_none_or(|(first, _)| *first == name);
        !is_first || self.fixed.is_none() || ty == self.fixed
    }

    fn set(&mut self, name: Symbol, ty: Option<TypeId>) {
        match self.known.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => *known = ty,
            None => self.known.push((name, ty)),
        }
    }
}

impl Body<'_, '_> {
    /// What the generic names of a library function stand for with these arguments; `None` if they
    /// do not fit.
    pub(super) fn bind(
        &mut self,
        function: PouId,
        given: &Given,
        want: Option<TypeId>,
    ) -> Option<Bound> {
        let parameters = self.an.stdlib_parameters(function);
        let mut generics = self.named_generic(&parameters, given.fixed)?;
        let mut bound = Bound::default();
        for (index, (kind, operand)) in given.operands.iter().enumerate() {
            let position = self.position_of(function, &parameters, index, *kind)?;
            let parameter = parameters.get(position)?;
            bound.positions.push(position);
            match &parameter.ty {
                ParameterType::Generic(name, class) => {
                    let joined = self.join(generics.ty(*name), operand, *class)?;
                    if !generics.allows(*name, joined) {
                        return None;
                    }
                    generics.set(*name, joined);
                }
                ParameterType::OpenText { wide } => {
                    let ty = self.text_of(operand, *wide)?;
                    bound.bindings.open.push((parameter.name, ty));
                }
                ParameterType::Written(spec) => {
                    let ty = self.an.stdlib_type(function, *spec);
                    self.fits(operand, ty).then_some(())?;
                }
            }
        }
        if leaves_out_too_much(&parameters, given, &bound) {
            return None;
        }
        bound.bindings.generics = self.settled_generics(&parameters, &generics, given, want)?;
        Some(bound)
    }

    /// The type in the name of a function is that of its first generic name; `None` if it cannot be.
    fn named_generic(&self, parameters: &[Parameter], fixed: Option<TypeId>) -> Option<Generics> {
        let mut generics = Generics {
            known: Vec::new(),
            fixed: fixed.filter(|ty| self.an.types.is_scalar(*ty)),
        };
        let first = parameters.iter().find_map(|parameter| match parameter.ty {
            ParameterType::Generic(name, class) => Some((name, class)),
            ParameterType::OpenText { .. } | ParameterType::Written(_) => None,
        });
        if let (Some(fixed), Some((name, class))) = (fixed, first) {
            let el = self.an.types.elementary(fixed);
            let takes = el.map_or(class.takes_text(), |el| class.takes(el));
            takes.then_some(())?;
            if generics.fixed.is_some() {
                generics.set(name, Some(fixed));
            }
        }
        Some(generics)
    }

    /// The parameter of an argument. The last one of an extensible function takes all that follow.
    fn position_of(
        &self,
        function: PouId,
        parameters: &[Parameter],
        index: usize,
        kind: ArgumentKind,
    ) -> Option<usize> {
        let extensible = self.an.pragma(function, "extensible");
        let last = parameters.len().wrapping_sub(1);
        match kind {
            ArgumentKind::Positional if extensible => Some(index.min(last)),
            ArgumentKind::Positional => Some(index),
            ArgumentKind::Input(name)
            | ArgumentKind::Output(name)
            | ArgumentKind::NegatedOutput(name) => {
                let known = parameters.iter().position(|p| p.name == name.name);
                let more = || extensible && self.names_the_next(parameters, index, name.name);
                known.or_else(|| more().then_some(last))
            }
        }
    }

    /// The type of a text of one width.
    fn text_of(&self, operand: &Operand, wide: bool) -> Option<TypeId> {
        let ty = self.an.types.strip(operand.ty);
        let fits = matches!(self.an.types.kind(ty), TypeKind::Text { wide: w, .. } if *w == wide);
        fits.then_some(ty)
    }

    /// What every generic name stands for, also those that only literals have.
    fn settled_generics(
        &mut self,
        parameters: &[Parameter],
        generics: &Generics,
        given: &Given,
        want: Option<TypeId>,
    ) -> Option<Vec<(Symbol, TypeId)>> {
        let mut settled: Vec<(Symbol, TypeId)> = Vec::new();
        for parameter in parameters {
            let ParameterType::Generic(name, class) = parameter.ty else {
                continue;
            };
            let open = || self.open_generic(class, &given.operands, want);
            let ty = generics.ty(name).or_else(open)?;
            if !settled.iter().any(|(known, _)| *known == name) {
                settled.push((name, ty));
            }
        }
        Some(settled)
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
    pub(crate) fn join(
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
    pub(crate) fn open_generic(
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

    /// Whether an operand becomes one of a type without being asked.
    pub(crate) fn fits(&self, operand: &Operand, to: TypeId) -> bool {
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
}

/// Whether inputs have no argument that need one: all of them where none is given by name, and texts,
/// whose arguments say how long they are.
fn leaves_out_too_much(parameters: &[Parameter], given: &Given, bound: &Bound) -> bool {
    let positional = |(kind, _): &(ArgumentKind, Operand)| *kind == ArgumentKind::Positional;
    let by_position = given.operands.iter().all(positional) && given.outputs.is_empty();
    if by_position && given.operands.len() < parameters.len() {
        return true;
    }
    let mut texts = parameters.iter().enumerate().filter(|(_, parameter)| {
        matches!(parameter.ty, ParameterType::OpenText { .. }) && !parameter.output
    });
    texts.any(|(position, _)| !bound.positions.contains(&position))
}
