//! Types and declarations of variables.

use super::{Build, SpecItem};
use iecc_ast::st::{
    AccessDecl, Declarations, Dimension, Edge, EnumValue, Expr, ExprKind, Id, Ident,
    InstanceConfig, List, MAX_TYPE_DEPTH, Modifier, SectionKind, TypeDecl, TypeKind, TypeSpec,
    UnitKind, VarDecl, VarSection,
};
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;

impl Build<'_, '_> {
    pub(crate) fn type_spec(&mut self, start: u32, kind: TypeKind, end: u32) -> Id<TypeSpec> {
        let range = self.range(start, end);
        let depth = self.deepest_type(&kind) + 1;
        let (kind, depth) = if depth > MAX_TYPE_DEPTH {
            self.too_deep("types", MAX_TYPE_DEPTH, range);
            (TypeKind::Error, 1)
        } else {
            (kind, depth)
        };
        self.arena.add(TypeSpec { kind, range, depth })
    }

    fn deepest_type(&self, kind: &TypeKind) -> u16 {
        match *kind {
            TypeKind::Array { element: inner, .. }
            | TypeKind::RefTo(inner)
            | TypeKind::PointerTo(inner)
            | TypeKind::ReferenceTo(inner) => self.arena[inner].depth,
            TypeKind::Struct { members, .. } | TypeKind::Union { members } => {
                let depth = |member: &VarDecl| self.arena[member.ty].depth;
                self.arena[members].iter().map(depth).max().unwrap_or(0)
            }
            TypeKind::Named(_)
            | TypeKind::Subrange { .. }
            | TypeKind::Sized { .. }
            | TypeKind::Enum { .. }
            | TypeKind::Error => 0,
        }
    }

    pub(crate) fn named_type(&mut self, path: Id<Expr>) -> Id<TypeSpec> {
        let range = self.arena[path].range;
        self.arena.add(TypeSpec {
            kind: TypeKind::Named(path),
            range,
            depth: 1,
        })
    }

    pub(crate) fn array_type(
        &mut self,
        start: u32,
        dimensions: Vec<Dimension>,
        element: Id<TypeSpec>,
        end: u32,
    ) -> Id<TypeSpec> {
        let dimensions = self.arena.list(dimensions);
        let kind = TypeKind::Array {
            dimensions,
            element,
        };
        self.type_spec(start, kind, end)
    }

    pub(crate) fn structure(
        &mut self,
        start: u32,
        overlap: bool,
        members: Vec<VarDecl>,
        end: u32,
    ) -> Id<TypeSpec> {
        let members = self.arena.list(members);
        self.type_spec(start, TypeKind::Struct { overlap, members }, end)
    }

    pub(crate) fn union(&mut self, start: u32, members: Vec<VarDecl>, end: u32) -> Id<TypeSpec> {
        let members = self.arena.list(members);
        self.type_spec(start, TypeKind::Union { members }, end)
    }

    /// `INT (0..5)`, `STRING(20)`, `DINT (A, B := 2)`.
    pub(crate) fn parenthesised_type(
        &mut self,
        start: u32,
        base: Id<Expr>,
        items: Vec<SpecItem>,
        end: u32,
    ) -> Id<TypeSpec> {
        let kind = match items[..] {
            [SpecItem::Range(low, high)] => TypeKind::Subrange { base, low, high },
            [SpecItem::Value(length)] if self.is_string(base) => TypeKind::Sized {
                base,
                length,
                round: true,
            },
            _ => return self.enumeration(start, Some(base), items, end),
        };
        self.type_spec(start, kind, end)
    }

    fn is_string(&self, base: Id<Expr>) -> bool {
        let range = self.arena[base].range;
        let name = self.text(range.start + self.base, range.end + self.base);
        ["STRING", "WSTRING"]
            .iter()
            .any(|string| string.eq_ignore_ascii_case(name))
    }

    pub(crate) fn enumeration(
        &mut self,
        start: u32,
        base: Option<Id<Expr>>,
        items: Vec<SpecItem>,
        end: u32,
    ) -> Id<TypeSpec> {
        let values: Vec<_> = items
            .into_iter()
            .filter_map(|item| self.enum_value(item))
            .collect();
        let values = self.arena.list(values);
        self.type_spec(start, TypeKind::Enum { base, values }, end)
    }

    fn enum_value(&mut self, item: SpecItem) -> Option<EnumValue> {
        let wrong = match item {
            SpecItem::Named(name, value) => {
                let value = Some(value);
                return Some(EnumValue { name, value });
            }
            SpecItem::Value(value) => {
                let node = self.arena[value];
                if let ExprKind::Name(name) = node.kind {
                    let range = node.range;
                    let name = Ident { name, range };
                    return Some(EnumValue { name, value: None });
                }
                node
            }
            SpecItem::Range(low, _) => self.arena[low],
        };
        if wrong.kind != ExprKind::Error {
            let span = self.span_of(wrong.range);
            let message = "a value of an enumeration is a name";
            self.report(Diagnostic::new(Code::E0010, span, message).label("expected a name"));
        }
        None
    }

    pub(crate) fn type_decl(
        &mut self,
        start: u32,
        name: Ident,
        extends: Option<Id<Expr>>,
        ty: Id<TypeSpec>,
        initial: Option<Id<Expr>>,
        end: u32,
    ) -> TypeDecl {
        TypeDecl {
            name,
            extends,
            ty,
            initial,
            range: self.range(start, end),
        }
    }

    pub(crate) fn types(&mut self, modifiers: Vec<Modifier>, types: Vec<TypeDecl>) -> UnitKind {
        UnitKind::Types {
            modifiers: self.arena.list(modifiers),
            types: self.arena.list(types),
        }
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of a declaration")]
    pub(crate) fn variable(
        &mut self,
        start: u32,
        names: Vec<Ident>,
        location: Option<Id<Expr>>,
        ty: Id<TypeSpec>,
        edge: Option<Edge>,
        initial: Option<(Id<Expr>, bool)>,
        end: u32,
    ) -> VarDecl {
        VarDecl {
            names: self.arena.list(names),
            location,
            ty,
            edge,
            initial: initial.map(|(value, _)| value),
            bound: initial.is_some_and(|(_, bound)| bound),
            range: self.range(start, end),
        }
    }

    pub(crate) fn variables(
        &mut self,
        start: u32,
        kind: SectionKind,
        modifiers: Vec<Modifier>,
        list: Vec<VarDecl>,
        end: u32,
    ) -> Box<VarSection> {
        let list = Declarations::Variables(self.arena.list(list));
        self.section(kind, modifiers, list, self.range(start, end))
    }

    pub(crate) fn accesses(
        &mut self,
        start: u32,
        modifiers: Vec<Modifier>,
        list: Vec<AccessDecl>,
        end: u32,
    ) -> Box<VarSection> {
        let list = Declarations::Accesses(self.arena.list(list));
        self.section(SectionKind::Access, modifiers, list, self.range(start, end))
    }

    pub(crate) fn instances(
        &mut self,
        start: u32,
        modifiers: Vec<Modifier>,
        list: Vec<InstanceConfig>,
        end: u32,
    ) -> Box<VarSection> {
        let list = Declarations::Instances(self.arena.list(list));
        self.section(SectionKind::Config, modifiers, list, self.range(start, end))
    }

    fn section(
        &mut self,
        kind: SectionKind,
        modifiers: Vec<Modifier>,
        declarations: Declarations,
        range: TextRange,
    ) -> Box<VarSection> {
        let modifiers: List<Modifier> = self.arena.list(modifiers);
        Box::new(VarSection {
            kind,
            modifiers,
            declarations,
            range,
        })
    }
}
