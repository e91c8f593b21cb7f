//! Initial values and other constants: what stands in declarations.

use super::analysis::Analysis;
use super::body::{Body, Operand};
use super::constant::Const;
use super::elementary::El;
use super::resolve::TypeScope;
use super::signature::{Initial, PouId, Storage};
use super::storage::extent;
use super::types::{TypeId, TypeKind};
use crate::hir::{InitId, code::Init};
use iecc_ast::st::{self, ArgumentKind, ExprKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;

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
        match self.types.base(ty) {
            TypeKind::Enum(index) => Some(self.types.enums[*index as usize].base),
            _ => self.types.elementary(ty),
        }
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
                self.struct_value(scope, arguments, index)
            }
            (TypeKind::Instance(pou), ExprKind::StructValue(arguments)) => {
                self.instance_value(scope, arguments, pou)
            }
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

    /// The values of an array in the order of its elements, then of its dimensions.
    fn array_value(
        &mut self,
        scope: TypeScope<'_>,
        values: st::List<st::Id<st::Expr>>,
        dimensions: &[(i64, i64)],
        element: TypeId,
        range: TextRange,
    ) -> Option<InitId> {
        let total: u64 = dimensions.iter().map(|d| u64::from(extent(*d))).product();
        let mut runs: Vec<(u64, u64, Option<InitId>)> = Vec::new();
        let mut at = 0u64;
        self.element_values(scope, values, element, &mut runs, &mut at, total);
        if at > total {
            let span = self.span(scope.unit, range);
            let message = format!("the array has {total} elements but {at} values are given");
            self.error(Code::E2008, span, message);
            return None;
        }
        let default = self.default_init(element);
        if at < total && default.is_some() {
            runs.push((at, total - at, default));
        }
        self.nested_runs(&runs, dimensions, 0, total)
    }

    fn element_values(
        &mut self,
        scope: TypeScope<'_>,
        values: st::List<st::Id<st::Expr>>,
        element: TypeId,
        runs: &mut Vec<(u64, u64, Option<InitId>)>,
        at: &mut u64,
        total: u64,
    ) {
        let arena = &self.unit(scope.unit).arena;
        for &value in &arena[values] {
            let repeated = match arena[value].kind {
                ExprKind::Repeat { count, values } => Some((count, values.len(), Some(values))),
                ExprKind::Call { callee, arguments } => {
                    self.is_count(scope, callee)
                        .then_some((callee, arguments.len(), None))
                }
                _ => None,
            };
            let Some((count, len, inner)) = repeated else {
                let init = self.value_of(scope, value, element);
                runs.push((*at, 1, init));
                *at += 1;
                continue;
            };
            let count = self
                .constant_int(scope, count, TypeId::UNTYPED_INT)
                .unwrap_or(0);
            let count = u64::try_from(count).unwrap_or(0);
            let start = runs.len();
            if len == 0 {
                let init = self.default_init(element);
                runs.push((*at, count, init));
                *at = at.saturating_add(count);
                continue;
            }
            let first = *at;
            match inner {
                Some(inner) => {
                    self.element_values(scope, inner, element, runs, at, total);
                }
                None => self.called_values(scope, value, element, runs, at),
            }
            let (once, made) = (*at - first, runs[start..].to_vec());
            if let [(_, 1, init)] = made[..] {
                runs[start].1 = count;
                *at = first.saturating_add(count);
                let _ = init;
                continue;
            }
            for round in 1..count {
                if *at > total || runs.len() > (1 << 20) {
                    *at = first.saturating_add(once.saturating_mul(count));
                    break;
                }
                let shift = round * once;
                runs.extend(made.iter().map(|(from, n, init)| (from + shift, *n, *init)));
                *at += once;
            }
        }
    }

    /// Whether what looks like a call is a named constant that says how often values stand there.
    fn is_count(&mut self, scope: TypeScope<'_>, callee: st::Id<st::Expr>) -> bool {
        let arena = &self.unit(scope.unit).arena;
        let ExprKind::Name(name) = arena[callee].kind else {
            return false;
        };
        let own = scope.pou.and_then(|pou| self.pou(pou).var(name));
        own.is_some_and(|var| matches!(var.storage, Storage::Const(_)))
            || matches!(
                self.lookup(scope.namespace, name),
                [super::signature::Def::Global(_)]
            )
    }

    fn called_values(
        &mut self,
        scope: TypeScope<'_>,
        call: st::Id<st::Expr>,
        element: TypeId,
        runs: &mut Vec<(u64, u64, Option<InitId>)>,
        at: &mut u64,
    ) {
        let arena = &self.unit(scope.unit).arena;
        let ExprKind::Call { arguments, .. } = arena[call].kind else {
            return;
        };
        for argument in &arena[arguments] {
            if let Some(value) = argument.value {
                let init = self.value_of(scope, value, element);
                runs.push((*at, 1, init));
                *at += 1;
            }
        }
    }

    /// Runs over all elements as initial values of nested arrays.
    fn nested_runs(
        &mut self,
        runs: &[(u64, u64, Option<InitId>)],
        dimensions: &[(i64, i64)],
        start: u64,
        total: u64,
    ) -> Option<InitId> {
        let (first, inner) = dimensions.split_first().expect("at least one dimension");
        let count = u64::from(extent(*first));
        let mut made: Vec<(u32, u32, InitId)> = Vec::new();
        if inner.is_empty() {
            for &(from, n, init) in runs {
                let (from, to) = (from.max(start), (from + n).min(start + total));
                if let (Some(init), true) = (init, from < to) {
                    made.push(((from - start) as u32, (to - from) as u32, init));
                }
            }
        } else {
            let each = total / count;
            for position in 0..count {
                let from = start + position * each;
                let low = runs.partition_point(|(at, n, _)| at + n <= from);
                let high = runs.partition_point(|(at, _, _)| *at < from + each);
                let init = self.nested_runs(&runs[low..high], inner, from, each);
                match (init, made.last_mut()) {
                    (Some(init), Some((at, n, last)))
                        if *last == init && u64::from(*at + *n) == position =>
                    {
                        *n += 1;
                    }
                    (Some(init), _) => made.push((position as u32, 1, init)),
                    (None, _) => {}
                }
            }
        }
        (!made.is_empty()).then(|| self.init(Init::Array(made)))
    }

    fn struct_value(
        &mut self,
        scope: TypeScope<'_>,
        arguments: st::List<st::Argument>,
        index: u32,
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
                    self.no_such_member(scope, name, candidates.collect());
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
        name: st::Ident,
        candidates: Vec<iecc_ast::Symbol>,
    ) {
        let span = self.span(scope.unit, name.range);
        let message = format!("there is no member `{}`", self.text(name.name));
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
