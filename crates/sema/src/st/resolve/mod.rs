//! What written types mean: declared types, arrays, subranges, enumerations, structures.
//!
//! Declarations are resolved on demand, so their order does not matter; meeting one again while
//! it is being resolved is a type that contains itself.

mod enumeration;
mod extended;
mod suitable;

use super::analysis::{Analysis, MAX_RESOLUTION_DEPTH, Resolution};
use super::declare::PACK_MODE;
use super::elementary::El;
use super::signature::{Bindings, Def, Initial, NamespaceId, TypeDeclId, UnitId};
use super::storage::MAX_ELEMENTS;
use super::storage::Shape;
use super::types::{AliasDef, Member, ReferenceKind, StructDef, TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Dimension, ExprKind, TypeKind as Written};
use iecc_diag::{Code, Diagnostic};
use iecc_source::{Span, TextRange};
use rustc_hash::FxHashMap;

/// Where a type is written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TypeScope<'s> {
    pub unit: UnitId,
    pub namespace: NamespaceId,
    /// Values for generic names.
    pub bindings: Option<&'s Bindings>,
    /// The unit whose constants may be used.
    pub pou: Option<super::signature::PouId>,
}

/// Longest string: LEN is an INT.
const MAX_TEXT: i128 = 32_767;

/// Most dimensions of an array.
const MAX_DIMENSIONS: usize = 16;

/// The length of strings that do not say it.
pub(crate) const DEFAULT_TEXT: u32 = 80;

impl Analysis<'_> {
    /// Where names of a unit outside of bodies are looked up.
    pub(crate) fn global_scope(&self, unit: UnitId) -> TypeScope<'static> {
        let namespace = self.units.get(unit.index());
        TypeScope {
            unit,
            namespace: namespace.map_or(NamespaceId::GLOBAL, |unit| unit.namespace),
            bindings: None,
            pou: self.pou_of_unit.get(&unit).copied(),
        }
    }

    /// The type that a declaration declares.
    pub(crate) fn declared_type(&mut self, id: TypeDeclId) -> TypeId {
        let declared = self.type_decl(id);
        let (unit, decl, namespace) = (declared.unit, declared.decl, declared.namespace);
        match declared.state {
            Resolution::Done(ty) => return ty,
            Resolution::InProgress => {
                let span = self.span(unit, decl.name.range);
                let name = self.text(decl.name.name);
                self.error(Code::E2009, span, format!("type `{name}` contains itself"));
                return TypeId::ERROR;
            }
            Resolution::Untouched => {}
        }
        self.type_decls[id.index()].state = Resolution::InProgress;
        self.declaring += 1;
        let scope = TypeScope {
            unit,
            namespace,
            bindings: None,
            pou: None,
        };
        let ty = self.named_type(scope, &decl);
        self.declaring -= 1;
        self.type_decls[id.index()].state = Resolution::Done(ty);
        if let Some(alias) = self.forward.get(&id) {
            self.types.settle_alias(*alias, ty);
        }
        ty
    }

    /// What a reference in a declared type refers to, if that is declared and not known yet. A structure may
    /// so refer to others of its kind. All declarations are known before any reference is followed.
    fn forward_type(
        &mut self,
        scope: TypeScope<'_>,
        target: st::Id<st::TypeSpec>,
    ) -> Option<TypeId> {
        let Written::Named(path) = self.unit(scope.unit).arena[target].kind else {
            return None;
        };
        let [Def::Type(id)] = *self.path(scope.unit, scope.namespace, path)? else {
            return None;
        };
        let decl = self.type_decl(id);
        let known = matches!(decl.state, Resolution::Done(_));
        if known || self.declaring == 0 {
            return None;
        }
        let name = decl.decl.name.name;
        if let Some(known) = self.forward.get(&id) {
            return Some(*known);
        }
        let base = TypeId::ERROR;
        let alias = self.types.add_alias(AliasDef {
            name,
            base,
            initial: None,
        });
        self.forward.insert(id, alias);
        Some(alias)
    }

    fn named_type(&mut self, scope: TypeScope<'_>, decl: &st::TypeDecl) -> TypeId {
        let name = Some(decl.name.name);
        let written = self.unit(scope.unit).arena[decl.ty];
        let base = self.written_type(scope, decl.ty, name);
        let base = match decl.extends {
            Some(extended) => self.extended_struct(scope, base, extended),
            None => base,
        };
        let own = matches!(written.kind, Written::Enum { .. } | Written::Struct { .. });
        if base == TypeId::ERROR || (own && decl.initial.is_none()) {
            return base;
        }
        self.types.add_alias(AliasDef {
            name: decl.name.name,
            base,
            initial: decl.initial.map(|expr| Initial {
                unit: scope.unit,
                expr,
            }),
        })
    }

    /// The type that is written somewhere.
    pub(crate) fn type_of_spec(
        &mut self,
        scope: TypeScope<'_>,
        spec: st::Id<st::TypeSpec>,
    ) -> TypeId {
        self.written_type(scope, spec, None)
    }

    fn written_type(
        &mut self,
        scope: TypeScope<'_>,
        spec: st::Id<st::TypeSpec>,
        name: Option<Symbol>,
    ) -> TypeId {
        let written = self.unit(scope.unit).arena[spec];
        if self.depth >= MAX_RESOLUTION_DEPTH {
            let span = self.span(scope.unit, written.range);
            self.error(Code::E0013, span, "types nest too deeply");
            return TypeId::ERROR;
        }
        self.depth += 1;
        let ty = self.written_kind(scope, written, name);
        self.depth -= 1;
        ty
    }

    fn written_kind(
        &mut self,
        scope: TypeScope<'_>,
        written: st::TypeSpec,
        name: Option<Symbol>,
    ) -> TypeId {
        match written.kind {
            Written::Named(path) => self.type_by_path(scope, path),
            Written::Subrange { base, low, high } => self.subrange(scope, base, low, high),
            Written::Sized { base, length, .. } => self.sized_text(scope, base, length),
            Written::Array {
                dimensions,
                element,
            } => self.array(scope, dimensions, element, written.range),
            Written::Struct { members, overlap } => {
                let shape = if overlap {
                    Shape::Overlap
                } else {
                    Shape::Plain
                };
                self.structure(scope, members, name, written.range, shape)
            }
            Written::Union { members } => {
                self.structure(scope, members, name, written.range, Shape::Union)
            }
            Written::Enum { base, values } => {
                self.enumeration(scope, base, values, name, written.range)
            }
            Written::RefTo(target) => self.reference(scope, ReferenceKind::RefTo, target),
            Written::PointerTo(target) => self.reference(scope, ReferenceKind::Pointer, target),
            Written::ReferenceTo(target) => self.reference(scope, ReferenceKind::Implicit, target),
            Written::Error => TypeId::ERROR,
        }
    }

    /// Refuses what cannot be compiled yet.
    pub(crate) fn unsupported(&mut self, unit: UnitId, range: TextRange, what: &str) -> TypeId {
        let span = self.span(unit, range);
        self.error(Code::E2010, span, format!("{what} is not compiled yet"));
        TypeId::ERROR
    }

    fn reference(
        &mut self,
        scope: TypeScope<'_>,
        kind: ReferenceKind,
        target: st::Id<st::TypeSpec>,
    ) -> TypeId {
        let target = match self.forward_type(scope, target) {
            Some(forward) => forward,
            None => self.written_type(scope, target, None),
        };
        if target == TypeId::ERROR {
            return target;
        }
        self.types.intern(TypeKind::Reference(kind, target))
    }

    /// The type a path of names stands for.
    pub(crate) fn type_by_path(&mut self, scope: TypeScope<'_>, path: st::Id<st::Expr>) -> TypeId {
        let written = self.unit(scope.unit).arena[path];
        if let ExprKind::Name(name) = written.kind
            && let Some(ty) = self.predefined_type(scope, name)
        {
            return ty;
        }
        let Some(defs) = self.found(scope.unit, scope.namespace, path) else {
            return TypeId::ERROR;
        };
        match defs.first().copied() {
            Some(Def::Type(id)) => self.declared_type(id),
            Some(Def::Pou(id)) => match self.pou(id).kind {
                st::PouKind::FunctionBlock | st::PouKind::Class => {
                    self.types.intern(TypeKind::Instance(id))
                }
                st::PouKind::Program if self.is_test(scope.unit) => {
                    self.types.intern(TypeKind::Instance(id))
                }
                st::PouKind::Program => {
                    let span = self.span(scope.unit, written.range);
                    let name = self.text(self.pou(id).name);
                    let message = format!("`{name}` is a program: instances stand in a RESOURCE");
                    self.error(Code::E2022, span, message);
                    TypeId::ERROR
                }
                st::PouKind::Interface => self.types.intern(TypeKind::Interface(id)),
                st::PouKind::Function => {
                    let span = self.span(scope.unit, written.range);
                    let name = self.text(self.pou(id).name);
                    self.error(
                        Code::E2021,
                        span,
                        format!("`{name}` is a function, not a type"),
                    );
                    TypeId::ERROR
                }
            },
            Some(Def::Global(_) | Def::Namespace(_)) => {
                let span = self.span(scope.unit, written.range);
                self.error(Code::E2021, span, "this is not a type");
                TypeId::ERROR
            }
            None => {
                self.unknown_type(scope, written);
                TypeId::ERROR
            }
        }
    }

    fn unknown_type(&mut self, scope: TypeScope<'_>, written: st::Expr) {
        let span = self.span(scope.unit, written.range);
        let ExprKind::Name(name) = written.kind else {
            self.error(Code::E1010, span, "this path leads to no type");
            return;
        };
        if self.is_missing(name) || self.lost_units {
            return;
        }
        if name == self.words.bit && !self.options.codesys {
            self.foreign(scope.unit, written.range, "BIT");
            return;
        }
        if self.options.codesys && self.text(name).eq_ignore_ascii_case("PVOID") {
            let message = "PVOID is not compiled: a pointer refers to variables of one type";
            let note = "POINTER TO and the type of what it refers to";
            self.report(Diagnostic::new(Code::E8002, span, message).note(note));
            return;
        }
        let message = format!("no type is named `{}`", self.text(name));
        let mut diagnostic = Diagnostic::new(Code::E1010, span, message);
        if self.text(name).eq_ignore_ascii_case("VOID") {
            let note = "what gives no value is declared without `:` and a type";
            self.report(diagnostic.note(note));
            return;
        }
        let mut candidates = self.visible(scope.namespace);
        candidates.retain(|candidate| self.names_type(scope.namespace, *candidate));
        let known = El::ALL.iter().flat_map(|el| [el.name(), el.short_name()]);
        let candidates = candidates.into_iter().map(|c| self.names.text(c));
        if let Some(close) = iecc_diag::closest(self.text(name), candidates.chain(known)) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
    }

    /// Whether variables can be declared of what a name stands for.
    fn names_type(&self, namespace: NamespaceId, name: Symbol) -> bool {
        let defs = self.lookup(namespace, name).first();
        defs.is_some_and(|def| match def {
            Def::Type(_) => true,
            Def::Pou(pou) => match self.pou(*pou).kind {
                st::PouKind::FunctionBlock | st::PouKind::Class | st::PouKind::Interface => true,
                st::PouKind::Function | st::PouKind::Program => false,
            },
            Def::Global(_) | Def::Namespace(_) => false,
        })
    }

    /// Elementary types, strings without a length, generic names.
    fn predefined_type(&mut self, scope: TypeScope<'_>, name: Symbol) -> Option<TypeId> {
        if let Some(bindings) = scope.bindings {
            let bound = bindings
                .generics
                .iter()
                .find(|(generic, _)| *generic == name);
            if let Some((_, ty)) = bound {
                return Some(*ty);
            }
        }
        self.elementary_names.get(&name).copied()
    }

    fn elementary_path(&mut self, scope: TypeScope<'_>, path: st::Id<st::Expr>) -> Option<El> {
        let ty = self.type_by_path(scope, path);
        self.types.elementary(ty)
    }

    fn subrange(
        &mut self,
        scope: TypeScope<'_>,
        base: st::Id<st::Expr>,
        low: st::Id<st::Expr>,
        high: st::Id<st::Expr>,
    ) -> TypeId {
        let arena = &self.unit(scope.unit).arena;
        let (base_range, range) = (arena[base].range, arena[low].range.to(arena[high].range));
        let ty = self.type_by_path(scope, base);
        let Some(el) = self.types.elementary(ty).filter(|el| el.is_int()) else {
            let span = self.span(scope.unit, base_range);
            if ty != TypeId::ERROR {
                self.error(Code::E2022, span, "a subrange is of an integer type");
            }
            return TypeId::ERROR;
        };
        let ty = TypeId::of(el);
        let (low, high) = (
            self.constant_int(scope, low, ty),
            self.constant_int(scope, high, ty),
        );
        let (Some(low), Some(high)) = (low, high) else {
            return TypeId::ERROR;
        };
        if low > high {
            let span = self.span(scope.unit, range);
            let message = format!("the lower limit {low} is above the upper limit {high}");
            self.error(Code::E2023, span, message);
            return TypeId::ERROR;
        }
        self.types.intern(TypeKind::Subrange {
            base: el,
            low,
            high,
        })
    }

    fn sized_text(
        &mut self,
        scope: TypeScope<'_>,
        base: st::Id<st::Expr>,
        length: st::Id<st::Expr>,
    ) -> TypeId {
        let base_range = self.unit(scope.unit).arena[base].range;
        let length_range = self.unit(scope.unit).arena[length].range;
        let ty = self.type_by_path(scope, base);
        let TypeKind::Text { wide, .. } = *self.types.base(ty) else {
            if ty != TypeId::ERROR {
                let span = self.span(scope.unit, base_range);
                self.error(Code::E2022, span, "only strings have a length in brackets");
            }
            return TypeId::ERROR;
        };
        let Some(length) = self.constant_int(scope, length, TypeId::UNTYPED_INT) else {
            return TypeId::ERROR;
        };
        // What a function of the library puts together is cut there.
        let length = match self.is_library(scope.unit) {
            true => length.min(MAX_TEXT),
            false => length,
        };
        if !(0..=MAX_TEXT).contains(&length) {
            let span = self.span(scope.unit, length_range);
            let message = format!("a string has between 0 and {MAX_TEXT} characters, not {length}");
            self.error(Code::E2024, span, message);
            return TypeId::ERROR;
        }
        self.types.intern(TypeKind::Text {
            wide,
            length: length as u32,
        })
    }

    fn array(
        &mut self,
        scope: TypeScope<'_>,
        dimensions: st::List<Dimension>,
        element: st::Id<st::TypeSpec>,
        range: TextRange,
    ) -> TypeId {
        let written: Vec<Dimension> = self.unit(scope.unit).arena[dimensions].to_vec();
        let open = written
            .iter()
            .filter(|d| matches!(d, Dimension::Open))
            .count();
        let element = self.written_type(scope, element, None);
        if element == TypeId::ERROR {
            return element;
        }
        if written.len() > MAX_DIMENSIONS {
            let span = self.span(scope.unit, range);
            let message = format!("an array has at most {MAX_DIMENSIONS} dimensions");
            self.error(Code::E0013, span, message);
            return TypeId::ERROR;
        }
        if open == written.len() {
            return self.types.intern(TypeKind::OpenArray {
                dimensions: open as u32,
                element,
            });
        }
        let (mut bounds, mut elements) = (Vec::new(), 1u64);
        for dimension in written {
            let Dimension::Range { low, high } = dimension else {
                let span = self.span(scope.unit, range);
                self.error(
                    Code::E2025,
                    span,
                    "either all bounds of an array are `*`, or none",
                );
                return TypeId::ERROR;
            };
            let Some(bound) = self.bounds(scope, low, high) else {
                return TypeId::ERROR;
            };
            elements =
                elements.saturating_mul((i128::from(bound.1) - i128::from(bound.0) + 1) as u64);
            bounds.push(bound);
        }
        if elements > MAX_ELEMENTS {
            let span = self.span(scope.unit, range);
            let message = format!("an array has at most {MAX_ELEMENTS} elements");
            self.error(Code::E2007, span, message);
            return TypeId::ERROR;
        }
        self.types.intern(TypeKind::Array {
            dimensions: bounds.into(),
            element,
        })
    }

    fn bounds(
        &mut self,
        scope: TypeScope<'_>,
        low: st::Id<st::Expr>,
        high: st::Id<st::Expr>,
    ) -> Option<(i64, i64)> {
        let arena = &self.unit(scope.unit).arena;
        let range = arena[low].range.to(arena[high].range);
        let first = self.constant_int(scope, low, TypeId::UNTYPED_INT);
        let last = self.constant_int(scope, high, TypeId::UNTYPED_INT);
        let (first, last) = (first?, last?);
        let span = self.span(scope.unit, range);
        if first > last {
            let message = format!("the lower bound {first} is above the upper bound {last}");
            self.error(Code::E2023, span, message);
            return None;
        }
        match (i64::try_from(first), i64::try_from(last)) {
            (Ok(first), Ok(last)) if i128::from(last) - i128::from(first) < 1 << 31 => {
                Some((first, last))
            }
            _ => {
                self.error(
                    Code::E2007,
                    span,
                    "an array has at most 2147483648 elements",
                );
                None
            }
        }
    }

    fn structure(
        &mut self,
        scope: TypeScope<'_>,
        members: st::List<st::VarDecl>,
        name: Option<Symbol>,
        range: TextRange,
        shape: Shape,
    ) -> TypeId {
        let unit = self.unit(scope.unit);
        let (mut made, mut by_name) = (Vec::new(), FxHashMap::default());
        for decl in &unit.arena[members] {
            let partly = self.member_location(scope.unit, decl);
            let ty = self.written_type(scope, decl.ty, None);
            let initial = decl.initial.map(|expr| Initial {
                unit: scope.unit,
                expr,
            });
            for ident in &unit.arena[decl.names] {
                let span = unit.span(ident.range);
                if let Some(&first) = by_name.get(&ident.name) {
                    let first: &Member = &made[first as usize];
                    let other = first.span;
                    if ty != TypeId::ERROR {
                        self.declared_twice(ident.name, span, other);
                    }
                    continue;
                }
                by_name.insert(ident.name, made.len() as u32);
                made.push(Member {
                    name: ident.name,
                    ty,
                    initial,
                    partly,
                    span,
                });
            }
        }
        let Ok(overlay) = self.overlay(scope, members, &made, shape) else {
            return TypeId::ERROR;
        };
        let packed = self.has_attribute(scope.unit, range.start, PACK_MODE);
        self.types.add_struct(StructDef {
            name,
            members: made,
            by_name,
            overlay,
            packed,
            span: unit.span(range),
        })
    }

    /// Reports a name that has a meaning already.
    pub(crate) fn declared_twice(&mut self, name: Symbol, span: Span, first: Span) {
        let message = format!("`{}` is declared twice", self.text(name));
        let diagnostic = Diagnostic::new(Code::E1003, span, message);
        self.report(diagnostic.also(first, "declared here first"));
    }
}
