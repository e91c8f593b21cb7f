//! Who extends and implements whom.
//!
//! All of it is known before any variable is looked at, so that the set of types a method may run
//! on is closed. After this step there are no cycles, chains are at most [`MAX_CHAIN`] long, a class or
//! block extends at most one class or block, and interfaces extend and are implemented as such.
//!
//! A *family* is what one class or block and everything derived from it make up. Where a family has
//! more than one member or implements an interface, its root begins with a hidden number that says
//! which type an instance is of. Bases are the first member of what extends them, so an
//! instance and its number have one address, whatever type it is looked at as.

use crate::st::analysis::Analysis;
use crate::st::signature::{Def, NamespaceId, Part, PouId, UnitId};
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind, ModifierKind, PouKind, UnitKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// How many units may extend one another.
const MAX_CHAIN: usize = 64;

/// The relations between units, turned around.
#[derive(Debug, Default)]
pub(crate) struct Families {
    /// What extends or implements a unit directly, in order of declaration.
    heirs: FxHashMap<PouId, Vec<PouId>>,
    /// Roots whose instances begin with a type number.
    numbered: FxHashSet<PouId>,
    /// The numbers, from 1.
    numbers: FxHashMap<PouId, u32>,
}

impl Analysis<'_> {
    /// Resolves EXTENDS and IMPLEMENTS of all units.
    pub(crate) fn resolve_heritage(&mut self) {
        let units: Vec<PouId> = (0..self.pous.len() as u32)
            .map(PouId)
            .filter(|id| self.pou(*id).part == Part::Whole)
            .collect();
        for &id in &units {
            self.heritage(id);
        }
        for &id in &units {
            self.cut_cycle(id);
        }
        self.make_families(&units);
    }

    fn make_families(&mut self, units: &[PouId]) {
        for &id in units {
            let pou = self.pou(id);
            let related: Vec<PouId> = pou.extends.iter().chain(&pou.implements).copied().collect();
            let numbered = pou.kind != PouKind::Interface && !related.is_empty();
            for base in related {
                self.families.heirs.entry(base).or_default().push(id);
            }
            if numbered {
                let root = self.root_of(id);
                self.families.numbered.insert(root);
            }
        }
        for &id in units {
            if self.is_numbered(id) {
                let number = self.families.numbers.len() as u32 + 1;
                self.families.numbers.insert(id, number);
            }
        }
    }

    fn heritage(&mut self, id: PouId) {
        let (unit_id, namespace) = (self.pou(id).unit, self.pou(id).namespace);
        let UnitKind::Pou(written) = &self.unit(unit_id).kind else {
            return;
        };
        let bases = self.related(unit_id, namespace, written.extends, "EXTENDS");
        for (base, span) in bases {
            if self.may_extend(id, base, span) {
                self.pous[id.index()].extends.push(base);
            }
        }
        let interfaces = self.related(unit_id, namespace, written.implements, "IMPLEMENTS");
        for (interface, span) in interfaces {
            if self.may_implement(id, interface, span) {
                self.pous[id.index()].implements.push(interface);
            }
        }
    }

    /// The units that paths lead to.
    fn related(
        &mut self,
        unit_id: UnitId,
        namespace: NamespaceId,
        paths: st::List<st::Id<st::Expr>>,
        word: &str,
    ) -> Vec<(PouId, Span)> {
        let unit = self.unit(unit_id);
        let mut found = Vec::new();
        for &path in &unit.arena[paths] {
            let span = unit.span(unit.arena[path].range);
            if self.is_query_interface(unit_id, path) {
                continue;
            }
            match self.found(unit_id, namespace, path).as_deref() {
                Some([Def::Pou(base), ..]) => found.push((*base, span)),
                Some([]) if self.lost_units => {}
                Some([]) => {
                    let name = unit.arena[path].kind.last_name();
                    let name = name.map_or("?", |name| self.text(name));
                    let message = format!("no class, block or interface is named `{name}`");
                    self.error(Code::E1010, span, message);
                }
                Some(&[def, ..]) if self.is_damaged(def) => {}
                Some([Def::Type(_) | Def::Global(_) | Def::Namespace(_), ..]) => {
                    let message = format!("{word} names a class, block or interface");
                    self.error(Code::E1041, span, message);
                }
                None => {}
            }
        }
        found
    }

    /// `__SYSTEM.IQueryInterface` of CODESYS, which says that `__QUERYINTERFACE` may ask: every interface
    /// may be asked here, and it has no methods for users.
    fn is_query_interface(&self, unit: UnitId, path: st::Id<st::Expr>) -> bool {
        let unit = self.unit(unit);
        let ExprKind::Member { base, member } = unit.arena[path].kind else {
            return false;
        };
        let ExprKind::Name(base) = unit.arena[base].kind else {
            return false;
        };
        let is = |name, word: &str| self.text(name).eq_ignore_ascii_case(word);
        self.options.codesys && is(base, "__SYSTEM") && is(member.name, "IQueryInterface")
    }

    fn may_extend(&mut self, id: PouId, base: PouId, span: Span) -> bool {
        let (own, other) = (self.pou(id), self.pou(base));
        let (kind, base_kind) = (own.kind, other.kind);
        let allowed = match kind {
            PouKind::FunctionBlock => {
                matches!(base_kind, PouKind::FunctionBlock | PouKind::Class)
            }
            PouKind::Class | PouKind::Interface => kind == base_kind,
            PouKind::Function | PouKind::Program => false,
        };
        let several = kind != PouKind::Interface && !own.extends.is_empty();
        let is_final = other.modifiers.contains(&ModifierKind::Final);
        let declared = other.span;
        let name = self.text(other.name);
        if !allowed {
            let message = format!(
                "a {} cannot extend the {} `{name}`",
                kind.as_str(),
                base_kind.as_str()
            );
            let diagnostic = Diagnostic::new(Code::E1041, span, message);
            let note = match kind {
                PouKind::Function | PouKind::Program => {
                    "only classes, blocks and interfaces extend"
                }
                PouKind::FunctionBlock | PouKind::Class if base_kind == PouKind::Interface => {
                    "an interface stands behind IMPLEMENTS"
                }
                PouKind::Class => "a class extends a class",
                PouKind::FunctionBlock => "a block extends a block or a class",
                PouKind::Interface => "an interface extends interfaces",
            };
            self.report(diagnostic.note(note));
            return false;
        }
        if several {
            self.error(Code::E1041, span, "a class or block extends one other only");
            return false;
        }
        if is_final {
            let message = format!("`{name}` is FINAL, so nothing can extend it");
            let diagnostic = Diagnostic::new(Code::E1045, span, message);
            self.report(diagnostic.also(declared, "declared here"));
            return false;
        }
        true
    }

    fn may_implement(&mut self, id: PouId, interface: PouId, span: Span) -> bool {
        let (own, other) = (self.pou(id), self.pou(interface));
        let (kind, interface_kind) = (own.kind, other.kind);
        let twice = own.implements.contains(&interface);
        let name = self.text(other.name);
        let message = match (kind, interface_kind) {
            (PouKind::Class | PouKind::FunctionBlock, PouKind::Interface) if twice => {
                format!("`{name}` is named twice")
            }
            (PouKind::Class | PouKind::FunctionBlock, PouKind::Interface) => return true,
            (PouKind::Class | PouKind::FunctionBlock, _) => {
                format!(
                    "`{name}` is a {}, not an interface",
                    interface_kind.as_str()
                )
            }
            (PouKind::Interface, _) => "an interface extends others; it implements none".to_owned(),
            (PouKind::Function | PouKind::Program, _) => {
                format!("a {} implements no interfaces", kind.as_str())
            }
        };
        self.error(Code::E1041, span, message);
        false
    }

    /// Cuts what a unit extends if it extends itself that way, or too many others.
    fn cut_cycle(&mut self, id: PouId) {
        let mut level = self.pou(id).extends.clone();
        let mut seen: FxHashSet<PouId> = level.iter().copied().collect();
        for _ in 0..MAX_CHAIN {
            if level.is_empty() {
                return;
            }
            if level.contains(&id) {
                let (name, span) = (self.text(self.pou(id).name), self.pou(id).span);
                self.error(Code::E1040, span, format!("`{name}` extends itself"));
                self.pous[id.index()].extends.clear();
                return;
            }
            let next = level.iter().flat_map(|base| self.pou(*base).extends.iter());
            level = next.copied().filter(|base| seen.insert(*base)).collect();
        }
        let span = self.pou(id).span;
        let message = format!("more than {MAX_CHAIN} units extend one another");
        self.error(Code::E0013, span, message);
        self.pous[id.index()].extends.clear();
    }

    /// What a class or block extends, if anything.
    pub(crate) fn base_of(&self, id: PouId) -> Option<PouId> {
        self.pou(id).extends.first().copied()
    }

    /// A class or block and all it extends, the nearest first.
    pub(crate) fn lineage(&self, id: PouId) -> Vec<PouId> {
        std::iter::successors(Some(id), |id| self.base_of(*id)).collect()
    }

    fn root_of(&self, id: PouId) -> PouId {
        *self.lineage(id).last().expect("begins with the unit")
    }

    /// The unit as it is written, without the bounds of arrays that a call gives.
    fn written(&self, id: PouId) -> PouId {
        self.pou(id).template.unwrap_or(id)
    }

    /// Whether instances of a class or block have a type number.
    pub(crate) fn is_numbered(&self, id: PouId) -> bool {
        let root = self.root_of(self.written(id));
        self.families.numbered.contains(&root)
    }

    /// Whether the structure of a class or block begins with the type number.
    pub(crate) fn holds_number(&self, id: PouId) -> bool {
        self.families.numbered.contains(&self.written(id))
    }

    /// The number of the type of an instance.
    pub(crate) fn type_number(&self, id: PouId) -> u32 {
        self.families.numbers[&self.written(id)]
    }

    /// How many steps lead from an instance to the part of it that is a base.
    pub(crate) fn base_distance(&self, from: PouId, to: PouId) -> Option<usize> {
        self.lineage(from).iter().position(|id| *id == to)
    }

    /// Whether an instance of one type may stand for the other: the same, a base, or an interface
    /// of one of these.
    pub(crate) fn conforms(&self, from: PouId, to: PouId) -> bool {
        self.with_ancestors(from).contains(&to)
    }

    /// A unit, what it extends and implements, and so on; each once.
    pub(crate) fn with_ancestors(&self, id: PouId) -> Vec<PouId> {
        let mut all = vec![id];
        let mut seen: FxHashSet<PouId> = all.iter().copied().collect();
        let mut next = 0;
        while next < all.len() {
            let pou = self.pou(all[next]);
            let more = pou.extends.iter().chain(&pou.implements).copied();
            let new: Vec<PouId> = more.filter(|base| seen.insert(*base)).collect();
            all.extend(new);
            next += 1;
        }
        all
    }

    /// The types with instances that may stand for a type, in order of declaration.
    pub(crate) fn concrete_types(&self, of: PouId) -> Vec<PouId> {
        let mut all = vec![of];
        let mut seen: FxHashSet<PouId> = all.iter().copied().collect();
        let mut next = 0;
        while next < all.len() {
            let heirs = self.families.heirs.get(&all[next]);
            let heirs = heirs.map_or(&[][..], Vec::as_slice).iter().copied();
            all.extend(heirs.filter(|heir| seen.insert(*heir)));
            next += 1;
        }
        all.retain(|id| {
            let pou = self.pou(*id);
            pou.has_instances() && !pou.modifiers.contains(&ModifierKind::Abstract)
        });
        all.sort_unstable();
        all
    }

    /// The method of a class, block or interface with a name, its own or inherited.
    pub(crate) fn method(&self, of: PouId, name: Symbol) -> Option<PouId> {
        let declares = |id: PouId| {
            let members = &self.pou(id).members;
            members
                .iter()
                .find(|(known, _)| *known == name)
                .map(|(_, method)| *method)
        };
        match self.pou(of).kind {
            PouKind::Interface => self.with_ancestors(of).into_iter().find_map(declares),
            PouKind::Class | PouKind::FunctionBlock | PouKind::Program => {
                self.lineage(of).into_iter().find_map(declares)
            }
            PouKind::Function => None,
        }
    }
}
