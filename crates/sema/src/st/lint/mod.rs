//! Warnings: what is right by the rules and most likely not meant. A program with errors gets
//! none, so that a mistake does not show twice. Each part looks at every node once.

mod assigned;
mod flow;
mod names;
mod reals;
mod recursion;

pub(super) use flow::can_leave;

use super::analysis::{Analysis, UnitRef};
use super::bodies::{Checked, Notes};
use super::signature::{Part, Pou, PouId, UnitId};
use iecc_ast::st::{self, Member, ModifierKind, PouKind, UnitKind};
use iecc_diag::{Code, Diagnostic};

impl<'a> Analysis<'a> {
    /// Looks at the units of the user, as far as nothing is noted for them.
    pub(crate) fn lint(&mut self, notes: &mut Notes) {
        self.recursion(&notes.bodies);
        let is_broken = |unit: &UnitRef<'_>| unit.unit.has_errors;
        if self.found.has_errors() || self.units.iter().any(is_broken) {
            return;
        }
        let (configured, extended) = (self.names_in_configurations(), self.extended());
        for (index, noted) in (self.first_user_unit..).zip(&mut notes.unused) {
            self.noted(noted, |an| {
                an.unused_names(UnitId(index), &configured, &extended);
            });
        }
        for index in 0..self.pous.len() as u32 {
            self.lint_body(PouId(index), &mut notes.bodies);
        }
        let warnings = std::mem::take(&mut self.warnings);
        for warning in warnings {
            self.report(warning);
        }
    }

    /// Gives the warnings that are noted, or looks for them and notes them.
    fn noted(&mut self, noted: &mut Option<Vec<Diagnostic>>, look: impl FnOnce(&mut Self)) {
        let before = self.warnings.len();
        match noted {
            Some(known) => self.warnings.extend(known.iter().cloned()),
            None => {
                look(self);
                *noted = Some(self.warnings[before..].to_vec());
            }
        }
    }

    fn lint_body(&mut self, id: PouId, bodies: &mut [Checked]) {
        let pou = self.pou(id);
        let instance = !pou.bindings.generics.is_empty() || !pou.bindings.open.is_empty();
        if self.is_library(pou.unit) || instance || pou.receiver.is_some() {
            return;
        }
        let Some(body) = self.written_body(id) else {
            return;
        };
        let mut nowhere = None;
        let place = self.hir_ids.get(&id);
        let noted = place.map_or(&mut nowhere, |place| {
            &mut bodies[place.index()].finding.lints
        });
        self.noted(noted, |an| {
            an.unreached(id, body);
            an.result_never_given(id);
            an.read_before_assignment(id, body);
        });
    }

    /// Gives a warning if there will be no errors, once for a place.
    pub(crate) fn warn(&mut self, diagnostic: Diagnostic) {
        let same = |other: &Diagnostic| {
            other.code == diagnostic.code && other.primary == diagnostic.primary
        };
        if !self.warnings.iter().rev().take(RECENT).any(same) {
            self.warnings.push(diagnostic);
        }
    }

    fn warning(&mut self, unit: UnitId, code: Code, range: iecc_source::TextRange, text: String) {
        let span = self.span(unit, range);
        self.warn(Diagnostic::new(code, span, text));
    }

    /// The statements of a unit or member, if it has any.
    pub(crate) fn written_body(&self, id: PouId) -> Option<st::Block> {
        match &self.unit(self.pou(id).unit).kind {
            UnitKind::Pou(whole) if whole.kind == PouKind::Interface => None,
            UnitKind::Types { .. }
            | UnitKind::Pou(_)
            | UnitKind::Configuration(_)
            | UnitKind::Test(_)
            | UnitKind::Globals(_)
            | UnitKind::Using(_)
            | UnitKind::Nothing
            | UnitKind::Error => self.written_statements(id),
        }
    }

    /// As `written_body`, also where statements must not stand.
    pub(crate) fn written_statements(&self, id: PouId) -> Option<st::Block> {
        let pou = self.pou(id);
        let unit = self.unit(pou.unit);
        let whole = match &unit.kind {
            UnitKind::Pou(whole) => whole,
            UnitKind::Test(test) => return Some(test.body),
            UnitKind::Types { .. }
            | UnitKind::Configuration(_)
            | UnitKind::Globals(_)
            | UnitKind::Using(_)
            | UnitKind::Nothing
            | UnitKind::Error => return None,
        };
        match pou.part {
            Part::Whole => Some(whole.body),
            Part::Member(index) | Part::Getter(index) | Part::Setter(index) => {
                member_body(&unit.arena[whole.members][index as usize], pou)
            }
        }
    }
}

/// What one statement says twice, it says at once.
const RECENT: usize = 8;

fn member_body(member: &Member, pou: &Pou) -> Option<st::Block> {
    match member {
        Member::Method(method) => Some(method.body),
        Member::Action(action) => Some(action.body),
        Member::Property(property) => {
            let accessor = if matches!(pou.part, Part::Getter(_)) {
                property.get
            } else {
                property.set
            };
            accessor.map(|accessor| accessor.body)
        }
    }
}

/// Whether nobody is expected to fill a body in.
fn is_abstract(pou: &Pou) -> bool {
    pou.modifiers.contains(&ModifierKind::Abstract)
}

/// The name that a path begins with, if it does.
fn root(arena: &st::Arena, mut path: st::Id<st::Expr>) -> Option<iecc_ast::Symbol> {
    while let Some(base) = arena[path].kind.base() {
        path = base;
    }
    arena[path].kind.name()
}
