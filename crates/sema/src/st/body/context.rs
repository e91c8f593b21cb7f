//! What a part of an expression means that is made of literals alone, such as `(1 + 1)` or `MAX(1, 2)`:
//! it takes the type of what it is computed or compared with, as a literal does, so that
//! `i / (1 + 1)` is `i / 2`. Only where nothing beside it has a type it takes that of its use.

use super::library::{Given, Parameter, ParameterType};
use super::operator::{Class, class};
use super::{Body, Operand};
use crate::st::elementary::El;
use crate::st::signature::{Def, PouId};
use crate::st::types::TypeId;
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, ExprKind as Written, Literal};

impl Body<'_, '_> {
    /// The operands of an operator. What is made of literals alone is looked at behind the other one;
    /// it does nothing, so that nobody can tell.
    pub(super) fn operands(
        &mut self,
        left: st::Id<st::Expr>,
        right: st::Id<st::Expr>,
        want: Option<TypeId>,
    ) -> (Operand, Operand) {
        match (self.is_open(left), self.is_open(right)) {
            (true, false) => {
                let right = self.expr(right, want);
                let beside = self.number_beside(&right);
                (self.expr(left, beside), right)
            }
            (false, true) => {
                let left = self.expr(left, want);
                let beside = self.number_beside(&left);
                let right = self.expr(right, beside);
                (left, right)
            }
            (true, true) | (false, false) => {
                let mut left = self.expr(left, want);
                let right = self.next_operand(Some(&mut left), |body| body.expr(right, want));
                (left, right)
            }
        }
    }

    /// The type that literals take beside an operand.
    pub(super) fn number_beside(&self, operand: &Operand) -> Option<TypeId> {
        let el = self.an.types.elementary(operand.ty)?;
        (el.is_num() || el.is_bits()).then(|| TypeId::of(el))
    }

    /// Whether nothing in an expression gives its number a type.
    pub(super) fn is_open(&self, id: st::Id<st::Expr>) -> bool {
        match self.arena()[id].kind {
            Written::Literal(literal) => match self.arena()[literal] {
                Literal::Int(_) | Literal::Real { .. } => true,
                Literal::Bool(_) | Literal::String(_) | Literal::Time(_) => false,
            },
            Written::Unary { operand, .. } => self.is_open(operand),
            Written::Binary {
                op, left, right, ..
            } => match class(op) {
                Class::Arithmetic(_) | Class::Logical(_) | Class::Power => {
                    self.is_open(right) && self.is_open(left)
                }
                Class::Compare(_) | Class::Lazy => false,
            },
            Written::Call { callee, arguments } => self.is_open_call(callee, arguments),
            Written::Typed { .. }
            | Written::Name(_)
            | Written::Member { .. }
            | Written::Part { .. }
            | Written::Index { .. }
            | Written::Deref(_)
            | Written::Direct(_)
            | Written::This
            | Written::Super
            | Written::Null
            | Written::Ref(_)
            | Written::ArrayValue(_)
            | Written::Repeat { .. }
            | Written::StructValue(_)
            | Written::Error => false,
        }
    }

    /// A call of the library whose result has the type of arguments that are open themselves.
    fn is_open_call(&self, callee: st::Id<st::Expr>, arguments: st::List<Argument>) -> bool {
        let Written::Name(name) = self.arena()[callee].kind else {
            return false;
        };
        let functions = self.overloads(name);
        let Some(&first) = functions.first() else {
            return false;
        };
        let parameters = self.an.stdlib_parameters(first);
        let result = self.an.stdlib_generic_result(first);
        if result.is_none() && functions.len() == 1 {
            return false;
        }
        let mut decides = false;
        self.arena()[arguments]
            .iter()
            .enumerate()
            .all(|(index, argument)| {
                let Some(value) = argument.value else {
                    return false;
                };
                let position = position_of(&parameters, index, &argument.kind);
                match position.map(|position| &parameters[position].ty) {
                    Some(ParameterType::Generic(generic, _)) if result != Some(*generic) => {
                        self.does_nothing(value)
                    }
                    Some(ParameterType::Written(_)) if result.is_some() => self.does_nothing(value),
                    Some(ParameterType::Generic(..) | ParameterType::Written(_)) => {
                        decides = true;
                        self.is_open(value)
                    }
                    Some(ParameterType::OpenText { .. }) | None => false,
                }
            })
            && decides
    }

    /// The functions of the library that a name stands for here.
    fn overloads(&self, name: Symbol) -> Vec<PouId> {
        if self.own_symbol(name) {
            return Vec::new();
        }
        let defs = self.an.lookup(self.namespace, name);
        let functions = defs.iter().filter_map(|def| match def {
            Def::Pou(pou) if self.an.is_library(self.an.pou(*pou).unit) => Some(*pou),
            Def::Pou(_) | Def::Type(_) | Def::Global(_) | Def::Namespace(_) => None,
        });
        functions.filter(|pou| self.is_function(*pou)).collect()
    }

    /// Whether an expression only reads.
    fn does_nothing(&self, id: st::Id<st::Expr>) -> bool {
        match self.arena()[id].kind {
            Written::Literal(_) | Written::Typed { .. } | Written::Name(_) => true,
            Written::Member { base, .. } | Written::Part { base, .. } => self.does_nothing(base),
            Written::Unary { operand, .. } => self.does_nothing(operand),
            Written::Binary { left, right, .. } => {
                self.does_nothing(left) && self.does_nothing(right)
            }
            Written::Index { .. }
            | Written::Deref(_)
            | Written::Direct(_)
            | Written::This
            | Written::Super
            | Written::Null
            | Written::Ref(_)
            | Written::Call { .. }
            | Written::ArrayValue(_)
            | Written::Repeat { .. }
            | Written::StructValue(_)
            | Written::Error => false,
        }
    }

    /// The type that an open argument takes: that of an argument of the same generic type, else that
    /// of the use of the call where the result has it.
    pub(super) fn argument_type(
        &self,
        functions: &[PouId],
        parameters: &[Parameter],
        position: usize,
        typed: &[(Symbol, TypeId)],
        want: Option<TypeId>,
    ) -> Option<TypeId> {
        match parameters[position].ty {
            ParameterType::Generic(name, _) => {
                let beside = typed.iter().find(|(generic, _)| *generic == name);
                match beside {
                    Some((_, ty)) => Some(*ty),
                    None if self.an.stdlib_generic_result(functions[0]) == Some(name) => want,
                    None => None,
                }
            }
            ParameterType::Written(_) => {
                let own = self.an.stdlib_elementary(functions[0], position)?;
                if functions.len() == 1 {
                    return Some(own);
                }
                let wanted = want.filter(|want| {
                    let mut functions = functions.iter();
                    functions.any(|function| {
                        let taken = self.an.stdlib_elementary(*function, position);
                        taken == Some(*want) && taken == self.an.stdlib_elementary_result(*function)
                    })
                });
                let real = self.an.types.elementary(own).is_some_and(El::is_real);
                wanted.or(real.then_some(own))
            }
            ParameterType::OpenText { .. } => None,
        }
    }

    /// Whether a function of the library gives the wanted type and takes these arguments as they are;
    /// literals have no type yet.
    pub(super) fn suits(&self, function: PouId, given: &Given, want: TypeId) -> bool {
        if self.an.stdlib_elementary_result(function) != Some(self.an.types.strip(want)) {
            return false;
        }
        let parameters = self.an.stdlib_parameters(function);
        let mut operands = given.operands.iter().enumerate();
        operands.all(|(index, (kind, operand))| {
            let position = position_of(&parameters, index, kind);
            let untyped = matches!(operand.ty, TypeId::UNTYPED_INT | TypeId::UNTYPED_REAL);
            let taken = position.map(|position| self.an.stdlib_elementary(function, position));
            untyped || taken == Some(None) || taken == Some(Some(self.an.types.strip(operand.ty)))
        })
    }
}

/// Where the parameter of an argument stands.
pub(super) fn position_of(
    parameters: &[Parameter],
    index: usize,
    kind: &ArgumentKind,
) -> Option<usize> {
    let last = parameters.len().checked_sub(1)?;
    match kind {
        ArgumentKind::Positional => Some(index.min(last)),
        ArgumentKind::Input(name) => {
            let named = parameters.iter().position(|known| known.name == name.name);
            Some(named.unwrap_or(last))
        }
        ArgumentKind::Output(_) | ArgumentKind::NegatedOutput(_) => None,
    }
}
