//! Collects what units declare: namespaces, types, units with bodies, globals. Nothing is resolved
//! yet, so the order of declarations does not matter.

mod dialect;
mod hidden;
mod lists;
mod namespaces;
mod pragmas;
mod spelling;

pub(crate) use dialect::is_reference;
pub use hidden::intern_hidden;
pub(crate) use hidden::{Accessors, Property};
pub(crate) use pragmas::{PACK_MODE, QUALIFIED_ONLY, STRICT};

use super::analysis::{Analysis, Resolution, TypeDecl, UnitRef};
use super::signature::{Bindings, Def, NamespaceId, Part, Pou, PouId, State, TypeDeclId, UnitId};
use super::testing::Tests;
use iecc_ast::Symbol;
use iecc_ast::st::{self, File, Item, Member, ScopeId, UnitKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::Span;
use rustc_hash::FxHashMap;

impl<'a> Analysis<'a> {
    /// Declares everything of a file in a namespace.
    pub(crate) fn declare_file(&mut self, file: &'a File, root: NamespaceId) {
        let mut scopes = vec![root; file.scopes.len()];
        for (index, scope) in file.scopes.iter().enumerate().skip(1) {
            let parent = scope
                .parent
                .map_or(root, |parent| scopes[parent.0 as usize]);
            scopes[index] = self.namespace(parent, &scope.name, scope.internal, scope.span);
        }
        self.declare_scope(file, ScopeId::FILE, &scopes);
    }

    /// Recursion is bounded by the depth of namespaces.
    fn declare_scope(&mut self, file: &'a File, scope: ScopeId, namespaces: &[NamespaceId]) {
        for item in &file.scopes[scope.0 as usize].items {
            match *item {
                Item::Unit(unit) => {
                    let namespace = namespaces[scope.0 as usize];
                    self.declare_unit(&file.units[unit as usize], namespace, file.name);
                }
                Item::Scope(inner) => self.declare_scope(file, inner, namespaces),
            }
        }
    }

    /// The namespace with a path below another, opened again or new.
    fn namespace(
        &mut self,
        parent: NamespaceId,
        path: &[st::Ident],
        internal: bool,
        span: Span,
    ) -> NamespaceId {
        let mut at = parent;
        for part in path {
            let known = self.lookup_in(at, part.name).first().copied();
            at = match known {
                Some(Def::Namespace(id)) => id,
                Some(_) | None => {
                    let id = NamespaceId(self.namespaces.len() as u32);
                    self.namespaces.push(super::analysis::Namespace {
                        parent: Some(at),
                        name: Some(part.name),
                        ..Default::default()
                    });
                    self.define(at, part.name, Def::Namespace(id), span);
                    id
                }
            };
        }
        if let (true, [.., last]) = (internal, path) {
            let parent = self.namespaces[at.index()].parent.unwrap_or(parent);
            self.hide(parent, last.name);
        }
        at
    }

    /// Makes a name one that only its own namespace sees.
    fn hide(&mut self, namespace: NamespaceId, name: Symbol) {
        self.namespaces[namespace.index()].internal.insert(name);
    }

    fn declare_unit(&mut self, unit: &'a st::Unit, namespace: NamespaceId, list: Option<Symbol>) {
        let is_test = matches!(unit.kind, UnitKind::Test(_));
        if is_test && self.options.tests == Tests::LeftOut {
            return;
        }
        let id = UnitId(self.units.len() as u32);
        self.units.push(UnitRef { unit, namespace });
        match &unit.kind {
            UnitKind::Types { modifiers, types } => {
                self.lost_members |= unit.lost_names;
                let internal = is_internal(&unit.arena[*modifiers]);
                for decl in &unit.arena[*types] {
                    let def = Def::Type(TypeDeclId(self.type_decls.len() as u32));
                    self.type_decls.push(TypeDecl {
                        unit: id,
                        decl: *decl,
                        namespace,
                        state: Resolution::Untouched,
                    });
                    self.define(namespace, decl.name.name, def, unit.span(decl.name.range));
                    if internal {
                        self.hide(namespace, decl.name.name);
                    }
                }
            }
            UnitKind::Pou(pou) => {
                self.declare_pou(id, unit, pou, namespace);
                for section in &unit.arena[pou.sections] {
                    self.declare_globals(id, namespace, section);
                }
            }
            UnitKind::Configuration(configuration) => {
                for section in &unit.arena[configuration.sections] {
                    self.declare_globals(id, namespace, section);
                }
                for resource in &unit.arena[configuration.resources] {
                    for section in &unit.arena[resource.sections] {
                        self.declare_globals(id, namespace, section);
                    }
                }
            }
            UnitKind::Test(_) => self.note_test(id),
            UnitKind::Globals(_) => self.lists.push((id, list)),
            UnitKind::Error => self.lost_units = true,
            UnitKind::Using(_) | UnitKind::Nothing => {}
        }
    }

    fn declare_pou(
        &mut self,
        id: UnitId,
        unit: &'a st::Unit,
        pou: &'a st::Pou,
        namespace: NamespaceId,
    ) {
        let span = unit.span(pou.name.range);
        let whole = self.add_pou(Pou {
            name: pou.name.name,
            kind: pou.kind,
            unit: id,
            part: Part::Whole,
            owner: None,
            namespace,
            span,
            result: None,
            result_name: pou.name.name,
            vars: Vec::new(),
            by_name: FxHashMap::default(),
            members: Vec::new(),
            extends: Vec::new(),
            implements: Vec::new(),
            receiver: None,
            modifiers: unit.arena[pou.modifiers].iter().map(|m| m.kind).collect(),
            bindings: Bindings::default(),
            template: None,
            state: State::Declared,
        });
        self.define(namespace, pou.name.name, Def::Pou(whole), span);
        if is_internal(&unit.arena[pou.modifiers]) {
            self.hide(namespace, pou.name.name);
        }
        self.declare_statics(id, pou.sections, self.text(pou.name.name).to_owned());
        for (index, member) in (0..).zip(&unit.arena[pou.members]) {
            let name = member.name();
            match member {
                Member::Method(method) => {
                    let part = Part::Member(index);
                    self.declare_member(whole, part, name, name.name, &[method.modifiers]);
                    self.declare_member_statics(whole, name.name, method.sections);
                }
                Member::Action(_) => {
                    self.declare_member(whole, Part::Member(index), name, name.name, &[]);
                }
                Member::Property(property) => self.declare_property(whole, index, property),
            }
        }
    }

    /// The accessors of a property are methods.
    fn declare_property(&mut self, whole: PouId, index: u32, property: &st::Property) {
        let accessors = Accessors {
            get: self.hidden_name(property.name.name, "GET"),
            set: self.hidden_name(property.name.name, "SET"),
        };
        self.accessors.insert(property.name.name, accessors);
        let both = [
            (property.get, Part::Getter(index), accessors.get),
            (property.set, Part::Setter(index), accessors.set),
        ];
        for (accessor, part, name) in both {
            let Some(accessor) = accessor else { continue };
            let modifiers = [accessor.modifiers, property.modifiers];
            self.declare_member(whole, part, property.name, name, &modifiers);
            self.declare_member_statics(whole, name, accessor.sections);
        }
    }

    /// Something with a body that belongs to a unit. The first word about access counts.
    fn declare_member(
        &mut self,
        whole: PouId,
        part: Part,
        written: st::Ident,
        name: Symbol,
        modifiers: &[st::List<st::Modifier>],
    ) {
        let unit = self.unit(self.pou(whole).unit);
        let mut made = self.pou(whole).clone();
        made.name = name;
        made.result_name = written.name;
        made.kind = st::PouKind::Function;
        made.part = part;
        made.owner = Some(whole);
        made.span = unit.span(written.range);
        let modifiers = modifiers.iter().flat_map(|list| &unit.arena[*list]);
        made.modifiers = modifiers.map(|m| m.kind).collect();
        made.members = Vec::new();
        let made = self.add_pou(made);
        self.pous[whole.index()].members.push((name, made));
    }

    fn declare_member_statics(
        &mut self,
        whole: PouId,
        name: Symbol,
        sections: st::List<st::VarSection>,
    ) {
        let pou = self.pou(whole);
        let path = format!("{}.{}", self.text(pou.name), self.text(name));
        self.declare_statics(pou.unit, sections, path);
    }

    pub(crate) fn add_pou(&mut self, pou: Pou) -> PouId {
        self.pous.push(pou);
        PouId(self.pous.len() as u32 - 1)
    }

    /// Gives a name a meaning, which it may have once; library functions may be overloaded.
    pub(crate) fn define(&mut self, namespace: NamespaceId, name: Symbol, def: Def, span: Span) {
        if self.is_missing(name) {
            self.lost_units = true;
            return;
        }
        let known = self.namespaces[namespace.index()].defs.get(&name);
        if let Some(&first) = known.and_then(|defs| defs.first())
            && namespace != NamespaceId::LIBRARY
            && !self.is_of_damaged_unit(first)
        {
            let other = self.def_span(first);
            let message = format!("`{}` is declared twice", self.text(name));
            let mut diagnostic = Diagnostic::new(Code::E1003, span, message);
            if let Some(other) = other {
                diagnostic = diagnostic.also(other, "declared here first");
            }
            self.report(diagnostic);
            return;
        }
        let defs = &mut self.namespaces[namespace.index()].defs;
        defs.entry(name).or_default().push(def);
    }

    /// Whether a type stands for something that could not be read.
    fn is_of_damaged_unit(&self, def: Def) -> bool {
        match def {
            Def::Type(id) => self.unit(self.type_decl(id).unit).lost_names,
            Def::Pou(_) | Def::Global(_) | Def::Namespace(_) => false,
        }
    }

    fn def_span(&self, def: Def) -> Option<Span> {
        match def {
            Def::Type(id) => {
                let decl = self.type_decl(id);
                Some(self.span(decl.unit, decl.decl.name.range))
            }
            Def::Pou(id) => Some(self.pou(id).span),
            Def::Global(id) => Some(self.global(id).span),
            Def::Namespace(_) => None,
        }
    }
}

fn is_internal(modifiers: &[st::Modifier]) -> bool {
    modifiers
        .iter()
        .any(|modifier| modifier.kind == st::ModifierKind::Internal)
}
