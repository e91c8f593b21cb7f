//! Namespaces: what USING makes visible, what INTERNAL hides, what is ambiguous.
//!
//! A unit with USING behind its header gets a namespace of its own, inside the one it stands in, that
//! declares nothing. A name that is INTERNAL, be it that of a namespace, is seen only from inside
//! the namespace that declares it.

use crate::st::analysis::{Analysis, Namespace};
use crate::st::signature::{Def, NamespaceId, UnitId};
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind, UnitKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;

/// What a name stands for where it is used.
enum Seen<'d> {
    Nothing,
    Defs(&'d [Def]),
    /// It is in several of the namespaces that are used.
    Ambiguous(Vec<NamespaceId>),
    /// It is INTERNAL in a namespace.
    Hidden(NamespaceId),
}

impl Analysis<'_> {
    /// Makes namespaces visible where USING says so. To be called when all names are declared.
    pub(crate) fn resolve_usings(&mut self) {
        for index in 0..self.units.len() as u32 {
            let id = UnitId(index);
            match &self.unit(id).kind {
                UnitKind::Using(paths) => {
                    let namespace = self.units[id.index()].namespace;
                    self.use_all(id, namespace, namespace, *paths);
                }
                UnitKind::Pou(pou) if !pou.usings.is_empty() => {
                    let outer = self.units[id.index()].namespace;
                    let inner = self.unit_namespace(id, outer);
                    self.use_all(id, outer, inner, pou.usings);
                }
                UnitKind::Pou(_)
                | UnitKind::Types { .. }
                | UnitKind::Configuration(_)
                | UnitKind::Globals(_)
                | UnitKind::Test(_)
                | UnitKind::Nothing
                | UnitKind::Error => {}
            }
        }
    }

    /// A namespace for the names that one unit uses.
    fn unit_namespace(&mut self, unit: UnitId, outer: NamespaceId) -> NamespaceId {
        let inner = NamespaceId(self.namespaces.len() as u32);
        self.namespaces.push(Namespace {
            parent: Some(outer),
            ..Namespace::default()
        });
        self.units[unit.index()].namespace = inner;
        for pou in self.pous.iter_mut().filter(|pou| pou.unit == unit) {
            pou.namespace = inner;
        }
        inner
    }

    fn use_all(
        &mut self,
        unit: UnitId,
        from: NamespaceId,
        into: NamespaceId,
        paths: st::List<st::Id<st::Expr>>,
    ) {
        for &path in &self.unit(unit).arena[paths] {
            let range = self.unit(unit).arena[path].range;
            match self.found(unit, from, path).as_deref() {
                Some([Def::Namespace(used), ..]) => {
                    let usings = &mut self.namespaces[into.index()].usings;
                    if !usings.contains(used) {
                        usings.push(*used);
                    }
                }
                Some(_) => {
                    let span = self.span(unit, range);
                    self.error(Code::E1042, span, "no namespace has this name");
                }
                None => {}
            }
        }
    }

    /// Whether a namespace is another one or inside of it.
    pub(crate) fn is_inside(&self, inner: NamespaceId, outer: NamespaceId) -> bool {
        let parent = |id: &NamespaceId| self.namespaces[id.index()].parent;
        std::iter::successors(Some(inner), parent).any(|id| id == outer)
    }

    /// The namespace that INTERNAL in a unit is about.
    pub(crate) fn home_namespace(&self, id: NamespaceId) -> NamespaceId {
        let namespace = &self.namespaces[id.index()];
        match (namespace.name, namespace.parent) {
            (None, Some(parent)) => parent,
            (Some(_), _) | (None, None) => id,
        }
    }

    fn seen(&self, from: NamespaceId, name: Symbol) -> Seen<'_> {
        let mut at = Some(from);
        while let Some(id) = at {
            let here = &self.namespaces[id.index()];
            if let Some(defs) = here.defs.get(&name) {
                return Seen::Defs(defs);
            }
            let used = self.seen_by_using(from, id, name);
            if !matches!(used, Seen::Nothing) {
                return used;
            }
            at = here.parent;
        }
        let library = &self.namespaces[NamespaceId::LIBRARY.index()];
        library
            .defs
            .get(&name)
            .map_or(Seen::Nothing, |d| Seen::Defs(d))
    }

    fn seen_by_using(&self, from: NamespaceId, at: NamespaceId, name: Symbol) -> Seen<'_> {
        let usings = self.namespaces[at.index()].usings.iter().copied();
        let having: Vec<NamespaceId> = usings
            .filter(|used| self.namespaces[used.index()].defs.contains_key(&name))
            .collect();
        let open = having
            .iter()
            .copied()
            .filter(|used| self.is_open(from, *used, name));
        let open: Vec<NamespaceId> = open.collect();
        match (having.as_slice(), open.as_slice()) {
            ([], _) => Seen::Nothing,
            ([hidden, ..], []) => Seen::Hidden(*hidden),
            (_, [one]) => Seen::Defs(self.lookup_in(*one, name)),
            (_, several) => Seen::Ambiguous(several.to_vec()),
        }
    }

    fn seen_in(&self, from: NamespaceId, namespace: NamespaceId, name: Symbol) -> Seen<'_> {
        let defs = self.lookup_in(namespace, name);
        if defs.is_empty() {
            return Seen::Nothing;
        }
        if self.is_open(from, namespace, name) {
            Seen::Defs(defs)
        } else {
            Seen::Hidden(namespace)
        }
    }

    /// Whether a name of a namespace may be used from another one.
    fn is_open(&self, from: NamespaceId, of: NamespaceId, name: Symbol) -> bool {
        !self.namespaces[of.index()].internal.contains(&name) || self.is_inside(from, of)
    }

    /// What a name stands for where it is used: nothing if it is not known. `None` after a
    /// message.
    pub(crate) fn found_name(
        &mut self,
        unit: UnitId,
        from: NamespaceId,
        name: Symbol,
        range: TextRange,
    ) -> Option<Vec<Def>> {
        let problem = match self.seen(from, name) {
            Seen::Nothing => return Some(Vec::new()),
            Seen::Defs(defs) => return Some(defs.to_vec()),
            Seen::Ambiguous(several) => self.ambiguous(unit, &several, name, range),
            Seen::Hidden(of) => self.hidden(unit, of, name, range),
        };
        self.report(problem);
        None
    }

    /// As `found_name`, for a name in a namespace.
    pub(crate) fn found_in(
        &mut self,
        unit: UnitId,
        from: NamespaceId,
        of: NamespaceId,
        name: st::Ident,
    ) -> Option<Vec<Def>> {
        let problem = match self.seen_in(from, of, name.name) {
            Seen::Nothing | Seen::Ambiguous(_) => return Some(Vec::new()),
            Seen::Defs(defs) => return Some(defs.to_vec()),
            Seen::Hidden(of) => self.hidden(unit, of, name.name, name.range),
        };
        self.report(problem);
        None
    }

    /// As `found_name`, for a path of names. Recursion is bounded by the depth of expressions.
    pub(crate) fn found(
        &mut self,
        unit: UnitId,
        from: NamespaceId,
        path: st::Id<st::Expr>,
    ) -> Option<Vec<Def>> {
        let written = self.unit(unit).arena[path];
        if let ExprKind::Name(name) = written.kind {
            return self.found_name(unit, from, name, written.range);
        }
        let ExprKind::Member { base, member } = written.kind else {
            return Some(Vec::new());
        };
        if self.is_standard_library(from, unit, base) {
            return Some(self.lookup_in(NamespaceId::LIBRARY, member.name).to_vec());
        }
        match self.found(unit, from, base)?[..] {
            [Def::Namespace(inner), ..] => self.found_in(unit, from, inner, member),
            [] | [Def::Type(_) | Def::Pou(_) | Def::Global(_), ..] => Some(Vec::new()),
        }
    }

    /// Whether a path is the name that CODESYS or TwinCAT give the library of the standard.
    fn is_standard_library(&self, from: NamespaceId, unit: UnitId, path: st::Id<st::Expr>) -> bool {
        let ExprKind::Name(name) = self.unit(unit).arena[path].kind else {
            return false;
        };
        let text = self.text(name);
        let mut libraries = ["Standard", "Tc2_Standard"].into_iter();
        self.options.codesys
            && libraries.any(|library| text.eq_ignore_ascii_case(library))
            && self.lookup(from, name).is_empty()
    }

    fn ambiguous(
        &self,
        unit: UnitId,
        several: &[NamespaceId],
        name: Symbol,
        range: TextRange,
    ) -> Diagnostic {
        let text = self.text(name);
        let paths: Vec<String> = several
            .iter()
            .map(|id| format!("{}.{text}", self.namespace_path(*id)))
            .collect();
        let message = format!("`{text}` is in several of the namespaces that are used here");
        let diagnostic = Diagnostic::new(Code::E1043, self.span(unit, range), message);
        diagnostic.note(format!("write {}", paths.join(" or ")))
    }

    fn hidden(&self, unit: UnitId, of: NamespaceId, name: Symbol, range: TextRange) -> Diagnostic {
        let message = format!(
            "`{}` is INTERNAL: only namespace `{}` itself uses it",
            self.text(name),
            self.namespace_path(of)
        );
        Diagnostic::new(Code::E1044, self.span(unit, range), message)
    }

    /// A namespace as users write it.
    fn namespace_path(&self, id: NamespaceId) -> String {
        let parent = |id: &NamespaceId| self.namespaces[id.index()].parent;
        let mut names: Vec<&str> = std::iter::successors(Some(id), parent)
            .filter_map(|id| self.namespaces[id.index()].name)
            .map(|name| self.text(name))
            .collect();
        names.reverse();
        names.join(".")
    }
}
