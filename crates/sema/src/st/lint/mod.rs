//! Warnings: what is right by the rules and most likely not meant. A program with errors gets
//! none, so that a mistake does not show twice. Each part looks at every node once.

mod assigned;
mod flow;
mod names;
mod reals;
mod recursion;

pub(super) use flow::can_leave;

use super::analysis::{Analysis, UnitRef};
use super::signature::{Part, Pou, PouId, UnitId};
use iecc_ast::st::{self, ExprKind, Member, ModifierKind, PouKind, UnitKind};
use iecc_diag::{Code, Diagnostic};

impl<'a> Analysis<'a> {
    /// Looks at the units of the user.
    pub(crate) fn lint(&mut self) {
        self.recursion();
        let is_broken = |unit: &UnitRef<'_>| unit.unit.has_errors;
        if self.found.has_errors() || self.units.iter().any(is_broken) {
            return;
        }
        let (configured, extended) = (self.names_in_configurations(), self.extended());
        for index in self.first_user_unit..self.units.len() as u32 {
            self.unused_names(UnitId(index), &configured, &extended);
        }
        for index in 0..self.pous.len() as u32 {
            self.lint_body(PouId(index));
        }
        let warnings = std::mem::take(&mut self.warnings);
        for warning in warnings {
            self.report(warning);
        }
    }

    fn lint_body(&mut self, id: PouId) {
        let pou = self.pou(id);
        let instance = !pou.bindings.generics.is_empty() || !pou.bindings.open.is_empty();
        if self.is_library(pou.unit) || instance {
            return;
        }
        if let Some(body) = self.written_body(id) {
            self.unreached(id, body);
            self.result_never_given(id);
            self.read_before_assignment(id, body);
        }
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
            _ => self.written_statements(id),
        }
    }

    /// As `written_body`, also where statements must not stand.
    pub(crate) fn written_statements(&self, id: PouId) -> Option<st::Block> {
        let pou = self.pou(id);
        let unit = self.unit(pou.unit);
        let whole = match &unit.kind {
            UnitKind::Pou(whole) => whole,
            UnitKind::Test(test) => return Some(test.body),
            _ => return None,
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
    loop {
        match arena[path].kind {
            ExprKind::Name(name) => return Some(name),
            ExprKind::Member { base, .. }
            | ExprKind::Part { base, .. }
            | ExprKind::Index { base, .. } => path = base,
            _ => return None,
        }
    }
}
