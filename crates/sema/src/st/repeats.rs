//! One mistake gives one message: a name that is not declared, or not as it should be, is reported
//! where it is first used in a unit, and the other places are shown there.

use super::analysis::Analysis;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::Span;
use rustc_hash::FxHashMap;

/// How many more places are shown.
const MOST_PLACES: usize = 3;

/// Whether a message is about a name, so that the same words mean the same mistake.
fn is_about_name(diagnostic: &Diagnostic) -> bool {
    let message = &diagnostic.message;
    let code = diagnostic.code;
    let about = matches!(
        code,
        Code::E1002
            | Code::E1010
            | Code::E1012
            | Code::E1013
            | Code::E1016
            | Code::E1018
            | Code::E1019
    );
    about && message.contains('`') || code == Code::E3004 && message.starts_with('`')
}

/// The units of all files, by where they begin.
struct Units {
    starts: Vec<(iecc_source::FileId, u32)>,
}

impl Units {
    /// The unit that a place is in.
    fn of(&self, span: Span) -> usize {
        let at = (span.file, span.start);
        self.starts.partition_point(|start| *start <= at)
    }
}

impl Analysis<'_> {
    /// What was found, with each mistake once.
    pub(crate) fn take_found(&mut self) -> Diagnostics {
        let found = std::mem::take(&mut self.found);
        if !found.has_errors() {
            return found;
        }
        let units = self.units.iter().skip(self.first_user_unit as usize);
        let starts = units.map(|unit| (unit.unit.file, unit.unit.start));
        let mut starts: Vec<_> = starts.collect();
        starts.sort_unstable();
        merged(&found, &Units { starts })
    }
}

fn merged(found: &Diagnostics, units: &Units) -> Diagnostics {
    let mut list: Vec<Diagnostic> = found.iter().cloned().collect();
    list.sort_by_key(|diagnostic| diagnostic.primary.as_ref().map(|label| label.span));
    let mut first: FxHashMap<(usize, (Code, String)), usize> = FxHashMap::default();
    let mut made: Vec<Diagnostic> = Vec::with_capacity(list.len());
    let mut more: Vec<Vec<Span>> = Vec::with_capacity(list.len());
    for diagnostic in list {
        let place = diagnostic.primary.as_ref().map(|label| label.span);
        if let (true, Some(span)) = (is_about_name(&diagnostic), place) {
            let key = (units.of(span), subject(&diagnostic));
            let index = *first.entry(key).or_insert(made.len());
            if index < made.len() {
                let first = made[index].primary.as_ref().map(|label| label.span);
                if first != place && more[index].last() != Some(&span) {
                    more[index].push(span);
                }
                continue;
            }
        }
        made.push(diagnostic);
        more.push(Vec::new());
    }
    let mut found = Diagnostics::new();
    for (diagnostic, places) in made.into_iter().zip(more) {
        found.push(with_places(diagnostic, &places));
    }
    found
}

/// What a message is about: how a name that leads to nothing is used makes no difference.
fn subject(diagnostic: &Diagnostic) -> (Code, String) {
    let named = |begin: &str| diagnostic.message.strip_prefix(begin);
    let name =
        named("no variable is named ").or_else(|| named("no function or instance is named "));
    match name {
        Some(name) => (Code::E1012, name.to_owned()),
        None => (diagnostic.code, diagnostic.message.clone()),
    }
}

fn with_places(mut diagnostic: Diagnostic, places: &[Span]) -> Diagnostic {
    for &span in places.iter().take(MOST_PLACES) {
        diagnostic = diagnostic.also(span, "and here");
    }
    match places.len().saturating_sub(MOST_PLACES) {
        0 => diagnostic,
        1 => diagnostic.note("and at one more place"),
        more => diagnostic.note(format!("and at {more} more places")),
    }
}
