//! Rockwell Logix: from the AST of a project to the typed program.
//!
//! Steps: types, tags and aliases (`types`, `symbols`, `modules`, `initial`); which routines run
//! (`tasks`, `routines`); rungs (`check`, `operands`, `reference`); I/O points (`io`). Every step
//! reports and goes on, so that one run shows all errors. Names are reported once where they are
//! used; declarations that nobody uses cannot break a program.

mod calls;
mod check;
mod initial;
pub mod instructions;
mod io;
mod modules;
mod operands;
mod operation;
mod reference;
mod routines;
mod symbols;
mod tasks;
mod types;
mod words;

use crate::hir::{self, CounterKind, ResetKind, TimerKind};
use iecc_ast::logix::Project;
use iecc_diag::{Diagnostic, Diagnostics};
use std::collections::{BTreeMap, BTreeSet};
use symbols::Symbols;
use types::NamedTypes;

/// What the tags hold before prescan and the first scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Init {
    /// Zero; but presets of timers and counters, lengths of CONTROLs, and constants as exported.
    #[default]
    Cold,
    /// Every value as exported.
    Export,
}

/// Which side of pending edits runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Edits {
    /// The one that ran when the file was exported (`TestEdits`).
    #[default]
    AsExported,
    /// The original rungs.
    Original,
    /// The edited rungs.
    Test,
}

/// Choices the export does not make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Initial values.
    pub init: Init,
    /// Pending edits.
    pub edits: Edits,
}

/// The functions of the library that instructions stand for.
pub fn stdlib_functions() -> Vec<&'static str> {
    let timers = TimerKind::ALL.into_iter();
    let timers = timers.flat_map(|kind| [kind.function(), kind.prescan_function()]);
    let counters = CounterKind::ALL.into_iter();
    let counters = counters.flat_map(|kind| [kind.function(), kind.prescan_function()]);
    let resets = ResetKind::ALL.into_iter().map(ResetKind::function);
    timers.chain(counters).chain(resets).collect()
}

/// Decides what a project means. `library` has the functions that instructions stand for, see
/// [`stdlib_functions`]. The result may be lowered if no error was reported.
pub fn analyze(
    project: &Project,
    library: hir::Program,
    options: &Options,
    diagnostics: &mut Diagnostics,
) -> hir::Program {
    let mut found = Diagnostics::new();
    let types = NamedTypes::collect(project, &mut found);
    let mut analysis = Analysis {
        project,
        options: *options,
        types,
        tags: Vec::new(),
        symbols: Symbols::default(),
        reported: BTreeSet::new(),
        without_data: BTreeSet::new(),
        unread_values: BTreeMap::new(),
        constants: BTreeSet::new(),
        silent: false,
        incomplete: false,
        diagnostics: found,
    };
    analysis.declare();
    let schedule = analysis.schedule();
    let pous = analysis.check_routines(&schedule);
    let program = analysis.finish(&schedule, pous, library);
    let incomplete = analysis.incomplete;
    diagnostics.append(analysis.diagnostics);
    assert!(
        !incomplete || diagnostics.has_errors(),
        "what is left out of a program is reported"
    );
    program
}

/// Everything known about the project so far.
struct Analysis<'p> {
    project: &'p Project,
    options: Options,
    types: NamedTypes,
    tags: Vec<hir::Tag>,
    symbols: Symbols<'p>,
    /// Names already reported as unknown or unusable, so that each is reported once.
    reported: BTreeSet<String>,
    /// Tags for which the file gives no values.
    without_data: BTreeSet<hir::TagId>,
    /// What is wrong with values of tags that nothing has used so far.
    unread_values: BTreeMap<hir::TagId, Diagnostics>,
    /// Tags that logic may not write.
    constants: BTreeSet<hir::TagId>,
    /// Nothing is reported for now.
    silent: bool,
    /// Something that runs was left out because of an error.
    incomplete: bool,
    diagnostics: Diagnostics,
}

impl Analysis<'_> {
    fn report(&mut self, diagnostic: Diagnostic) {
        if !self.silent {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Reports unless something with the same key was reported before.
    fn report_once(&mut self, key: String, diagnostic: Diagnostic) {
        if !self.silent && self.reported.insert(key) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Looks something up whose mistakes are reported elsewhere, or harm nobody.
    fn silently<T>(&mut self, look_up: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.silent, true);
        let found = look_up(self);
        self.silent = before;
        found
    }

    /// The tag part of a message: a place as users write it.
    fn display(&self, place: &hir::Place) -> String {
        let tag = &self.tags[place.tag.index()];
        place.display(&self.types.table, &tag.name, tag.ty)
    }

    fn type_of(&self, place: &hir::Place) -> hir::Type {
        place.type_from(&self.types.table, self.tags[place.tag.index()].ty)
    }
}
