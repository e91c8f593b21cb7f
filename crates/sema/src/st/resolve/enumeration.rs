//! Enumerations and named values: what type their values are of, and which numbers they have.

use super::TypeScope;
use crate::st::analysis::Analysis;
use crate::st::declare::{QUALIFIED_ONLY, STRICT};
use crate::st::elementary::El;
use crate::st::signature::Def;
use crate::st::types::{EnumDef, TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st;
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;
use rustc_hash::FxHashSet;

impl Analysis<'_> {
    pub(super) fn enumeration(
        &mut self,
        scope: TypeScope<'_>,
        base: Option<st::Id<st::Expr>>,
        values: st::List<st::EnumValue>,
        name: Option<Symbol>,
        range: TextRange,
    ) -> TypeId {
        let Some(el) = self.type_of_enumerators(scope, base, range) else {
            return TypeId::ERROR;
        };
        let strict = self.has_attribute(scope.unit, range.start, STRICT);
        let ty = self.types.add_enum(EnumDef {
            name,
            base: el,
            named_values: base.is_some() && !strict,
            qualified: self.has_attribute(scope.unit, range.start, QUALIFIED_ONLY),
            values: Vec::new(),
            span: self.span(scope.unit, range),
        });
        let (mut next, mut known) = (0, FxHashSet::default());
        for value in &self.unit(scope.unit).arena[values] {
            let written = value.value;
            let number = written.and_then(|expr| self.constant_int(scope, expr, TypeId::of(el)));
            let number = number.unwrap_or(next);
            next = number + 1;
            if known.insert(value.name.name) {
                self.counted_within(scope, el, value.name, number);
                self.add_enumerator(ty, value.name.name, number);
            } else {
                let span = self.span(scope.unit, value.name.range);
                let message = format!("`{}` is declared twice", self.text(value.name.name));
                self.error(Code::E1003, span, message);
            }
        }
        ty
    }

    /// A value that follows the one before it can be above the largest of the type.
    fn counted_within(&mut self, scope: TypeScope<'_>, el: El, name: st::Ident, number: i128) {
        let (low, high) = el.range();
        if !(low..=high).contains(&number) {
            let span = self.span(scope.unit, name.range);
            let message = format!("{number} does not fit {} ({low} to {high})", el.name());
            self.error(Code::E2005, span, message);
        }
    }

    /// The type of the values of an enumeration; `None` after a mistake.
    fn type_of_enumerators(
        &mut self,
        scope: TypeScope<'_>,
        base: Option<st::Id<st::Expr>>,
        range: TextRange,
    ) -> Option<El> {
        let Some(path) = base else {
            let short = self.options.codesys && !self.is_library(scope.unit);
            return Some(if short { El::Int } else { El::Dint });
        };
        let el = self.elementary_path(scope, path);
        if el.is_some_and(|el| !el.is_real()) {
            return el;
        }
        if el.is_none() && self.options.codesys && self.is_block(scope, path) {
            let span = self.span(scope.unit, range);
            let message = "arguments for FB_init are not compiled";
            let note = "initial values of inputs stand behind `:=`: (input := 1)";
            self.report(Diagnostic::new(Code::E8002, span, message).note(note));
            return None;
        }
        let span = self.span(scope.unit, self.unit(scope.unit).arena[path].range);
        let message = "named values are of an integer or bit string type";
        self.error(Code::E2022, span, message);
        None
    }

    fn add_enumerator(&mut self, ty: TypeId, name: Symbol, number: i128) {
        let TypeKind::Enum(index) = *self.types.kind(ty) else {
            unreachable!("the type of an enumeration")
        };
        let def = &mut self.types.enums[index as usize];
        def.values.push((name, number));
        if !def.qualified {
            let meanings = self.enumerators.entry(name).or_default();
            meanings.push((ty, number));
        }
    }

    fn is_block(&self, scope: TypeScope<'_>, path: st::Id<st::Expr>) -> bool {
        let found = self.path(scope.unit, scope.namespace, path);
        found.is_some_and(
            |defs| matches!(defs, [Def::Pou(pou), ..] if self.pou(*pou).has_instances()),
        )
    }
}
