//! What is known of a program while it is looked at: all units, names, types and signatures.

use super::signature::{Def, Global, GlobalId, NamespaceId, Pou, PouId, TypeDeclId, UnitId};
use super::storage::StorageTypes;
use super::types::{TypeId, Types};
use crate::hir;
use iecc_ast::st::{self, Unit};
use iecc_ast::{Names, Symbol};
use iecc_diag::{Code, Diagnostic, Diagnostics, closest};
use iecc_source::{Span, TextRange};
use rustc_hash::{FxHashMap, FxHashSet};

/// A namespace, or what is in none.
#[derive(Debug, Default)]
pub(crate) struct Namespace {
    /// What it is in.
    pub parent: Option<NamespaceId>,
    /// Its name; the file itself and what one unit uses have none.
    pub name: Option<Symbol>,
    /// What it declares; several only for overloads of the library.
    pub defs: FxHashMap<Symbol, Vec<Def>>,
    /// What `USING` makes visible.
    pub usings: Vec<NamespaceId>,
    /// What of it cannot be seen from outside.
    pub internal: FxHashSet<Symbol>,
}

/// A declaration of a type, and what came of it.
#[derive(Debug)]
pub(crate) struct TypeDecl {
    pub unit: UnitId,
    pub decl: st::TypeDecl,
    pub namespace: NamespaceId,
    pub state: Resolution,
}

/// How far a declaration is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Resolution {
    Untouched,
    InProgress,
    Done(TypeId),
}

/// A unit and where it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnitRef<'a> {
    pub unit: &'a Unit,
    pub namespace: NamespaceId,
}

/// Words that mean something although they are no keywords.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Words {
    pub en: Symbol,
    pub eno: Symbol,
    pub interval: Symbol,
    pub single: Symbol,
    pub priority: Symbol,
    pub bit: Symbol,
}

/// Everything.
pub(crate) struct Analysis<'a> {
    pub names: &'a Names,
    pub words: Words,
    pub options: super::Options,
    pub evaluator: &'a dyn super::Evaluator,
    pub units: Vec<UnitRef<'a>>,
    pub namespaces: Vec<Namespace>,
    pub types: Types,
    pub type_decls: Vec<TypeDecl>,
    pub pous: Vec<Pou>,
    pub globals: Vec<Global>,
    /// The hidden names of the accessors of properties.
    pub accessors: FxHashMap<Symbol, super::declare::Accessors>,
    /// Variables of VAR_STAT, by where they are declared.
    pub statics: FxHashMap<(UnitId, iecc_source::TextRange), GlobalId>,
    /// Lists of global variables and their names.
    pub lists: Vec<(UnitId, Option<Symbol>)>,
    /// Bare enumerators and the enumerations that have them.
    pub enumerators: FxHashMap<Symbol, Vec<(TypeId, i128)>>,
    /// Types that need no declaration.
    pub elementary_names: FxHashMap<Symbol, TypeId>,
    /// The unit with a body that a unit of the source is.
    pub pou_of_unit: FxHashMap<UnitId, PouId>,
    pub storage: StorageTypes,
    pub memory: super::memory::Memory,
    pub hir: hir::Program,
    pub addresses: super::address::Addresses,
    /// The instances of programs, by name.
    pub program_instances: Vec<(Symbol, PouId, hir::TagId)>,
    /// The names of variables and programs outside of units, in lower case.
    pub tag_names: FxHashSet<String>,
    /// All instances of each program.
    pub program_tags: FxHashMap<PouId, Vec<hir::TagId>>,
    /// Instances of library units, by what was bound.
    pub instances: FxHashMap<(PouId, super::signature::Bindings), PouId>,
    /// The bodies that are needed, in the order they came up, and their place in the typed program.
    pub wanted: Vec<PouId>,
    /// Units whose bodies name ENO.
    pub eno_units: std::cell::RefCell<FxHashMap<UnitId, bool>>,
    /// Who extends and implements whom.
    pub families: super::objects::Families,
    /// Bodies of a base made for what extends it.
    pub receivers: FxHashMap<(PouId, PouId), PouId>,
    /// Units that choose a body by the type of an instance.
    pub dispatchers: FxHashMap<(PouId, Option<Symbol>), super::objects::Dispatcher>,
    /// Bodies that no source has.
    pub synthetics: Vec<(hir::PouId, hir::Pou)>,
    /// How many bodies have a name.
    pub unit_names: FxHashMap<String, u32>,
    pub hir_ids: FxHashMap<PouId, hir::PouId>,
    /// Bodies that constants have called.
    pub computed: super::initial::Computed,
    /// The unit tests.
    pub testing: super::testing::Testing,
    pub found: Diagnostics,
    /// How many names were compared with all others.
    pub suggestions: std::cell::Cell<u32>,
    /// What is given only where there are no errors.
    pub warnings: Vec<Diagnostic>,
    /// Whether types may have more members or values than are known.
    pub lost_members: bool,
    /// Whether units were found that no name is known of.
    pub lost_units: bool,
    /// How deep declarations are being resolved.
    pub depth: u32,
    /// How many declarations of types are being resolved.
    pub declaring: u32,
    /// What stands for declared types in references to them, where those were met first.
    pub forward: FxHashMap<TypeDeclId, TypeId>,
    /// Constants that were looked at before their turn, by where they are declared.
    pub ahead: FxHashSet<(PouId, TextRange)>,
    /// The first unit that is not of the library.
    pub first_user_unit: u32,
    /// How many of `pous` were there before any body was looked at.
    pub declared_pous: usize,
}

/// How many names that mean nothing are compared with all others.
const MAX_SUGGESTIONS: u32 = 100;

/// How deep types, instances and constants may refer to one another.
pub(crate) const MAX_RESOLUTION_DEPTH: u32 = 128;

impl<'a> Analysis<'a> {
    /// A unit.
    pub(crate) fn unit(&self, id: UnitId) -> &'a Unit {
        self.units[id.index()].unit
    }

    /// A place in a unit.
    pub(crate) fn span(&self, unit: UnitId, range: TextRange) -> Span {
        self.unit(unit).span(range)
    }

    /// Reports a mistake.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.found.push(diagnostic);
    }

    /// Reports a mistake in a unit.
    pub(crate) fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.report(Diagnostic::new(code, span, message));
    }

    /// A name as the user spells it.
    pub(crate) fn text(&self, name: Symbol) -> &'a str {
        self.names.text(name)
    }

    /// Whether a name is that of nothing: a message says that one is missing.
    pub(crate) fn is_missing(&self, name: Symbol) -> bool {
        self.text(name) == "?"
    }

    /// Whether a unit, or what it extends, may have more names than are known.
    pub(crate) fn has_lost_names(&self, pou: PouId) -> bool {
        let all = self.with_ancestors(pou);
        all.into_iter()
            .any(|id| self.unit(self.pou(id).unit).lost_names)
    }

    /// Whether a structure or instance may have more members than are known.
    pub(crate) fn may_have_more_members(&self, ty: TypeId) -> bool {
        match self.types.object(ty) {
            Some(of) => self.has_lost_names(of),
            None => self.lost_members,
        }
    }

    /// Whether a message was given for the declaration of what a name leads to.
    pub(crate) fn is_damaged(&mut self, def: Def) -> bool {
        match def {
            Def::Type(id) => self.declared_type(id) == TypeId::ERROR,
            Def::Pou(_) | Def::Global(_) | Def::Namespace(_) => false,
        }
    }

    /// A unit with a signature.
    pub(crate) fn pou(&self, id: PouId) -> &Pou {
        &self.pous[id.index()]
    }

    /// A type as users write it.
    pub(crate) fn type_name(&self, ty: TypeId) -> String {
        self.types
            .name(ty, self.names, &|pou| self.pous[pou.index()].name)
    }

    /// What a name stands for, seen from a namespace: there, in those around it, in what they use,
    /// and last in the library.
    pub(crate) fn lookup(&self, namespace: NamespaceId, name: Symbol) -> &[Def] {
        let mut at = Some(namespace);
        while let Some(id) = at {
            let here = &self.namespaces[id.index()];
            if let Some(defs) = here.defs.get(&name) {
                return defs;
            }
            for used in &here.usings {
                if let Some(defs) = self.namespaces[used.index()].defs.get(&name) {
                    return defs;
                }
            }
            at = here.parent;
        }
        let library = &self.namespaces[NamespaceId::LIBRARY.index()];
        library.defs.get(&name).map_or(&[], Vec::as_slice)
    }

    /// What a name in a namespace stands for, and nowhere else.
    pub(crate) fn lookup_in(&self, namespace: NamespaceId, name: Symbol) -> &[Def] {
        let defs = self.namespaces[namespace.index()].defs.get(&name);
        defs.map_or(&[], Vec::as_slice)
    }

    /// A name close to one that means nothing; not for ever more names, as each is compared with all.
    pub(crate) fn similar(
        &self,
        name: Symbol,
        candidates: impl IntoIterator<Item = Symbol>,
    ) -> Option<&'a str> {
        let names = self.names;
        let asked = self.suggestions.get();
        if asked == MAX_SUGGESTIONS {
            return None;
        }
        self.suggestions.set(asked + 1);
        closest(
            names.text(name),
            candidates.into_iter().map(|c| names.text(c)),
        )
    }

    /// Every name that can be seen from a namespace, in a fixed order.
    pub(crate) fn visible(&self, namespace: NamespaceId) -> Vec<Symbol> {
        let mut all = Vec::new();
        let mut at = Some(namespace);
        while let Some(id) = at {
            let here = &self.namespaces[id.index()];
            all.extend(here.defs.keys().copied());
            for used in &here.usings {
                all.extend(self.namespaces[used.index()].defs.keys().copied());
            }
            at = here.parent;
        }
        all.extend(self.namespaces[NamespaceId::LIBRARY.index()].defs.keys());
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The namespace, type, unit or variable that a path of names stands for.
    pub(crate) fn path(
        &self,
        unit: UnitId,
        namespace: NamespaceId,
        path: st::Id<st::Expr>,
    ) -> Option<&[Def]> {
        let arena = &self.unit(unit).arena;
        let written = arena[path].kind;
        if let Some(name) = written.name() {
            return Some(self.lookup(namespace, name));
        }
        if let st::ExprKind::Member { base, member } = written
            && let [Def::Namespace(inner)] = self.path(unit, namespace, base)?
        {
            return Some(self.lookup_in(*inner, member.name));
        }
        None
    }

    /// Whether a unit is part of the library.
    pub(crate) fn is_library(&self, unit: UnitId) -> bool {
        unit.0 < self.first_user_unit
    }

    /// The place of a body in the typed program; it will be compiled.
    pub(crate) fn want(&mut self, pou: PouId) -> hir::PouId {
        if let Some(&known) = self.hir_ids.get(&pou) {
            return known;
        }
        let id = hir::PouId::from_index(self.wanted.len());
        self.wanted.push(pou);
        self.hir_ids.insert(pou, id);
        id
    }

    /// Takes back what was wanted from a number of bodies on. Nothing that stays may call it.
    pub(crate) fn drop_wanted(&mut self, mark: usize) {
        for dropped in self.wanted.drain(mark..) {
            self.hir_ids.remove(&dropped);
        }
    }

    /// A variable or global by its id.
    pub(crate) fn global(&self, id: GlobalId) -> &Global {
        &self.globals[id.index()]
    }

    /// A declared type.
    pub(crate) fn type_decl(&self, id: TypeDeclId) -> &TypeDecl {
        &self.type_decls[id.index()]
    }
}
