//! Initial values and other constants: what stands in declarations.

mod array;
mod evaluate;
mod part;

pub(crate) use evaluate::Computed;
pub use evaluate::Evaluator;

use super::analysis::Analysis;
use super::body::{Body, Operand};
use super::constant::Const;
use super::elementary::El;
use super::resolve::TypeScope;
use super::signature::{Initial, PouId};
use super::types::{TypeId, TypeKind};
use crate::hir::{InitId, code::Init};
use iecc_ast::st::{self, ArgumentKind, ExprKind};
use iecc_diag::{Code, Diagnostic};

impl Analysis<'_> {
    /// A constant of a type; a message if it is none.
    pub(crate) fn constant(
        &mut self,
        scope: TypeScope<'_>,
        expr: st::Id<st::Expr>,
        ty: TypeId,
    ) -> Option<Const> {
        let mut body = Body::for_constant(self, scope);
        let operand = body.expr(expr, Some(ty));
        body.constant_operand(&operand, ty)
    }

    /// A whole number; of any type if `ty` is that of literals.
    pub(crate) fn constant_int(
        &mut self,
        scope: TypeScope<'_>,
        expr: st::Id<st::Expr>,
        ty: TypeId,
    ) -> Option<i128> {
        let mut body = Body::for_constant(self, scope);
        let want = (ty != TypeId::UNTYPED_INT).then_some(ty);
        let operand = body.expr(expr, want);
        if want.is_some() {
            return body.constant_operand(&operand, ty)?.as_int();
        }
        if operand.is_error() {
            return None;
        }
        let integer = operand.ty == TypeId::UNTYPED_INT
            || body.an.types.elementary(operand.ty).is_some_and(El::is_int);
        match operand.as_const() {
            Some(Const::Int(value)) if integer => Some(*value),
            _ => {
                let span = body.an.span(scope.unit, operand.range);
                body.an
                    .error(Code::E2030, span, "a constant integer is needed here");
                None
            }
        }
    }

    /// What a scalar variable without an initial value holds.
    pub(crate) fn default_const(&mut self, ty: TypeId) -> Const {
        let bits = self
            .default_init(ty)
            .map_or(0, |init| match self.hir.inits.get(init) {
                Init::Bits(bits) => *bits,
                Init::Zero | Init::Address(_) | Init::Struct(_) | Init::Array(_) => 0,
            });
        Const::from_bits(self.constant_type(ty).unwrap_or(El::Ulint), bits)
    }

    /// The elementary type behind a type whose constants are numbers.
    pub(crate) fn constant_type(&self, ty: TypeId) -> Option<El> {
        let enumeration = self.types.enumeration(ty);
        enumeration.map_or_else(|| self.types.elementary(ty), |def| Some(def.base))
    }

    /// The initial value of a variable; `None` if all of it is 0.
    pub(crate) fn initial_value(&mut self, initial: Initial, ty: TypeId) -> Option<InitId> {
        let namespace = self.units[initial.unit.index()].namespace;
        let scope = TypeScope {
            unit: initial.unit,
            namespace,
            bindings: None,
            pou: self.unit_pou(initial.unit),
        };
        self.value_of(scope, initial.expr, ty)
    }

    /// The unit whose constants an initial value may name.
    fn unit_pou(&self, unit: super::signature::UnitId) -> Option<PouId> {
        self.pou_of_unit.get(&unit).copied()
    }

    /// Recursion is bounded by the depth of expressions.
    pub(crate) fn value_of(
        &mut self,
        scope: TypeScope<'_>,
        expr: st::Id<st::Expr>,
        ty: TypeId,
    ) -> Option<InitId> {
        if ty == TypeId::ERROR {
            return None;
        }
        let written = self.unit(scope.unit).arena[expr];
        match (self.types.base(ty).clone(), written.kind) {
            (
                TypeKind::Array {
                    dimensions,
                    element,
                },
                ExprKind::ArrayValue(values),
            ) => self.array_value(scope, values, &dimensions, element, written.range),
            (TypeKind::Struct(index), ExprKind::StructValue(_))
                if self.types.structs[index as usize].overlay.is_some() =>
            {
                let span = self.span(scope.unit, written.range);
                let message = "members that overlap have no initial values";
                self.error(Code::E2008, span, message);
                None
            }
            (TypeKind::Struct(index), ExprKind::StructValue(arguments)) => {
                self.struct_value(scope, arguments, index, ty)
            }
            (TypeKind::Instance(pou), ExprKind::StructValue(arguments)) => {
                self.instance_value(scope, arguments, pou)
            }
            // A message has been given.
            (_, ExprKind::Error) => None,
            (TypeKind::Array { .. } | TypeKind::Struct(_) | TypeKind::Instance(_), _) => {
                let span = self.span(scope.unit, written.range);
                let name = self.type_name(ty);
                let message = format!("this is no initial value of {name}");
                let note = "an array has its values in [ ], a structure in ( )";
                self.report(Diagnostic::new(Code::E2008, span, message).note(note));
                None
            }
            (TypeKind::Reference(..) | TypeKind::Interface(_), _) => {
                self.reference_value(scope, expr, ty)
            }
            (TypeKind::Text { .. }, _) => {
                let value = self.constant(scope, expr, ty)?;
                let mut body = Body::for_constant(self, scope);
                let init = body.text_init(&value, ty);
                (*self.hir.inits.get(init) != Init::Zero).then_some(init)
            }
            _ => {
                let value = self.constant(scope, expr, ty)?;
                let mut body = Body::for_constant(self, scope);
                let bits = body.const_bits(&value, ty);
                (bits != 0).then(|| self.init(Init::Bits(bits)))
            }
        }
    }

    fn struct_value(
        &mut self,
        scope: TypeScope<'_>,
        arguments: st::List<st::Argument>,
        index: u32,
        ty: TypeId,
    ) -> Option<InitId> {
        let def = self.types.structs[index as usize].clone();
        let mut given: Vec<Option<st::Id<st::Expr>>> = vec![None; def.members.len()];
        let arena = &self.unit(scope.unit).arena;
        for argument in &arena[arguments] {
            let ArgumentKind::Input(name) = argument.kind else {
                continue;
            };
            match def.by_name.get(&name.name) {
                Some(&position) => given[position as usize] = argument.value,
                None => {
                    let candidates = def.members.iter().map(|m| m.name);
                    self.no_such_member(scope, ty, name, candidates.collect());
                }
            }
        }
        let mut parts = Vec::new();
        for ((position, member), given) in (0..).zip(&def.members).zip(given) {
            let init = match (given, member.initial) {
                (Some(expr), _) => self.value_of(scope, expr, member.ty),
                (None, Some(initial)) => self.initial_value(initial, member.ty),
                (None, None) => self.default_init(member.ty),
            };
            parts.extend(init.map(|init| (position, init)));
        }
        self.struct_init(parts)
    }

    pub(crate) fn no_such_member(
        &mut self,
        scope: TypeScope<'_>,
        of: TypeId,
        name: st::Ident,
        candidates: Vec<iecc_ast::Symbol>,
    ) {
        let span = self.span(scope.unit, name.range);
        if self.may_have_more_members(of) {
            return;
        }
        let (owner, text) = (self.type_name(of), self.text(name.name));
        let message = format!("{owner} has no member `{text}`");
        let mut diagnostic = Diagnostic::new(Code::E1002, span, message);
        if let Some(close) = self.similar(name.name, candidates) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
    }
}

impl Body<'_, '_> {
    /// The value of an operand that must be a constant of a type.
    fn constant_operand(&mut self, operand: &Operand, ty: TypeId) -> Option<Const> {
        if operand.is_error() {
            return None;
        }
        if operand.as_const().is_none() {
            let span = self.an.span(self.unit, operand.range);
            self.an
                .error(Code::E2030, span, "a constant is needed here");
            return None;
        }
        self.constant_to(operand, ty)
    }
}
