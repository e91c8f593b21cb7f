//! What the check of a text found, kept for the check of the text after a change.
//!
//! What is found in a body depends on the text of its unit and on what is declared anywhere, on
//! nothing else: neither statements elsewhere nor the place of the unit in its file. So as long as all
//! that is declared stays the same, which a hash tells, what was found in a unit is found again in
//! the same text. The units are then the same ones in the same order, so that their ids and those of
//! their bodies mean the same as before. What is made for one call (a unit with open arrays, by the
//! arrays of the call) has no such id; a body with such a call is looked at again every time.

use super::analysis::Analysis;
use super::bodies::{Checked, Notes};
use super::signature::PouId;
use crate::hir;
use iecc_ast::Symbol;
use iecc_ast::st;
use iecc_diag::Diagnostic;
use iecc_source::{ContentHash, FileId, Span};
use rustc_hash::FxHashMap;

/// What is known of a text that was checked. Nothing at first.
#[derive(Debug, Default)]
pub struct Kept {
    /// The hash of everything that was declared.
    declared: Option<ContentHash>,
    /// By unit of the user.
    units: Vec<KeptUnit>,
    /// How many bodies the last check looked at.
    looked_at: usize,
}

#[derive(Debug)]
struct KeptUnit {
    file: FileId,
    start: u32,
    hash: ContentHash,
    /// Whether it names ENO, which tells callers of an output.
    names_eno: bool,
    /// Warnings of names that are not used, if they were looked for.
    unused: Option<Vec<Diagnostic>>,
    bodies: Vec<(PouId, Finding)>,
}

/// What was found in a body.
#[derive(Debug, Clone, Default)]
pub(crate) struct Finding {
    pub errors: Vec<Diagnostic>,
    /// What is given only where there are no errors.
    pub warnings: Vec<Diagnostic>,
    /// More of it, if it was looked for.
    pub lints: Option<Vec<Diagnostic>>,
    /// What it calls, library units left out, and where.
    pub calls: Vec<(Callee, Span)>,
}

/// Names something called, in every check of the same declarations.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Callee {
    Declared(PouId),
    /// A body of a base, made for what extends it.
    Received {
        body: PouId,
        of: PouId,
    },
    /// What chooses a body by the type of an instance.
    Chooser {
        of: PouId,
        method: Option<Symbol>,
        signature: PouId,
    },
}

impl Kept {
    /// How many bodies of the user the last check looked at.
    pub fn looked_at(&self) -> usize {
        self.looked_at
    }

    /// What of it is good for a text. The rest is dropped.
    pub(crate) fn for_text(self, an: &Analysis<'_>) -> Earlier {
        let names_eno: Vec<bool> = (0..)
            .zip(an.user_units())
            .map(|(index, unit)| self.names_eno(an, index, unit))
            .collect();
        let declared = an.declared_hash(&names_eno);
        let declared = Some(declared);
        let same = self.declared == declared;
        let units = if same { self.units } else { Vec::new() };
        let starts = units.iter().zip(an.user_units());
        let starts = starts.map(|(kept, unit)| (kept.hash == unit.hash).then_some(unit.start));
        Earlier {
            declared,
            names_eno,
            starts: starts.collect(),
            units,
        }
    }

    fn names_eno(&self, an: &Analysis<'_>, index: usize, unit: &st::Unit) -> bool {
        match self.units.get(index) {
            Some(kept) if kept.hash == unit.hash => kept.names_eno,
            Some(_) | None => an.names_eno(unit),
        }
    }
}

/// What is known from an earlier check of the same declarations.
#[derive(Debug, Default)]
pub(crate) struct Earlier {
    declared: Option<ContentHash>,
    names_eno: Vec<bool>,
    /// Empty, or by unit of the user.
    units: Vec<KeptUnit>,
    /// Where the units begin now that did not change.
    starts: Vec<Option<u32>>,
}

impl Earlier {
    /// What was found in a body, where it is now.
    pub(crate) fn take(&mut self, unit: usize, pou: PouId) -> Option<Finding> {
        (*self.starts.get(unit)?)?;
        let bodies = &mut self.units[unit].bodies;
        let position = bodies.iter().position(|(id, _)| *id == pou)?;
        let finding = bodies.swap_remove(position).1;
        let calls = finding.calls.into_iter();
        let calls = calls.map(|(callee, span)| Some((callee, self.moved_span(span)?)));
        Some(Finding {
            errors: self.moved(finding.errors)?,
            warnings: self.moved(finding.warnings)?,
            lints: match finding.lints {
                Some(lints) => Some(self.moved(lints)?),
                None => None,
            },
            calls: calls.collect::<Option<_>>()?,
        })
    }

    /// Warnings of names of a unit, if they were looked for.
    pub(crate) fn take_unused(&mut self, unit: usize) -> Option<Vec<Diagnostic>> {
        (*self.starts.get(unit)?)?;
        let unused = self.units[unit].unused.take()?;
        self.moved(unused)
    }

    /// `None` if one points into a unit that changed.
    fn moved(&self, diagnostics: Vec<Diagnostic>) -> Option<Vec<Diagnostic>> {
        let moved = diagnostics.into_iter().map(|diagnostic| {
            let stays = diagnostic
                .spans()
                .all(|span| self.moved_span(span).is_some());
            stays.then(|| diagnostic.moved(|span| self.moved_span(span).unwrap_or(span)))
        });
        moved.collect()
    }

    /// Where a place is now. Units are in the order of the text; what stands in none of them is
    /// the library.
    fn moved_span(&self, span: Span) -> Option<Span> {
        let behind = |unit: &KeptUnit| (unit.file, unit.start) <= (span.file, span.start);
        let position = self.units.partition_point(behind).checked_sub(1);
        let Some(index) = position.filter(|index| self.units[*index].file == span.file) else {
            return Some(span);
        };
        let (from, to) = (self.units[index].start, self.starts[index]?);
        Some(Span::new(
            span.file,
            span.start - from + to,
            span.end - from + to,
        ))
    }

    /// What the next check is to know.
    pub(crate) fn next(self, an: &Analysis<'_>, notes: Notes) -> Kept {
        let units = an.user_units().zip(notes.unused).zip(self.names_eno);
        let mut units: Vec<KeptUnit> = units
            .map(|((unit, unused), names_eno)| KeptUnit {
                file: unit.file,
                start: unit.start,
                hash: unit.hash,
                names_eno,
                unused,
                bodies: Vec::new(),
            })
            .collect();
        let (callees, mut looked_at) = (Callees::of(an), 0);
        for (index, checked) in notes.bodies.into_iter().enumerate() {
            let id = an.wanted[index];
            let Some(unit) = an.written_in(id) else {
                continue;
            };
            looked_at += usize::from(!checked.known);
            if let Some(finding) = callees.finding(an, checked) {
                units[unit].bodies.push((id, finding));
            }
        }
        let in_order = units.is_sorted_by_key(|unit| (unit.file, unit.start));
        let declared = self.declared.filter(|_| in_order);
        Kept {
            declared,
            units,
            looked_at,
        }
    }
}

impl<'a> Analysis<'a> {
    /// The user's units.
    pub(crate) fn user_units(&self) -> impl Iterator<Item = &'a st::Unit> + use<'_, 'a> {
        let units = &self.units[self.first_user_unit as usize..];
        units.iter().map(|unit| unit.unit)
    }

    /// The position among the user's units of the one that a body is written in; `None` for
    /// everything that was made of a body.
    pub(crate) fn written_in(&self, id: PouId) -> Option<usize> {
        let pou = self.pous.get(id.index())?;
        let written = id.index() < self.declared_pous && pou.receiver.is_none();
        let position = pou.unit.0.checked_sub(self.first_user_unit)?;
        written.then_some(position as usize)
    }

    fn names_eno(&self, unit: &st::Unit) -> bool {
        let eno = st::ExprKind::Name(self.words.eno);
        unit.arena.all::<st::Expr>().iter().any(|e| e.kind == eno)
    }

    fn declared_hash(&self, names_eno: &[bool]) -> ContentHash {
        let mut bytes = vec![u8::from(self.options.codesys)];
        for (index, unit) in self.units[self.first_user_unit as usize..]
            .iter()
            .enumerate()
        {
            bytes.extend(unit.unit.declared.bytes());
            bytes.extend((unit.unit.file.index() as u32).to_le_bytes());
            bytes.extend(unit.namespace.0.to_le_bytes());
            bytes.push(u8::from(names_eno[index]));
        }
        for namespace in &self.namespaces {
            let name = namespace.name.map_or("", |name| self.text(name));
            bytes.extend(name.as_bytes());
            bytes.push(0);
            bytes.extend(namespace.parent.map_or(u32::MAX, |id| id.0).to_le_bytes());
            bytes.extend((namespace.internal.len() as u32).to_le_bytes());
        }
        ContentHash::of_bytes(&bytes)
    }
}

/// What called units are in terms that outlive the check.
struct Callees {
    received: FxHashMap<PouId, (PouId, PouId)>,
    choosers: FxHashMap<hir::PouId, Callee>,
}

/// Something called, as far as it can be kept.
enum Known {
    Callee(Callee),
    /// It calls nothing of the user's.
    Library,
    /// It exists because of this call.
    Unnamed,
}

impl Callees {
    fn of(an: &Analysis<'_>) -> Self {
        let received = an.receivers.iter().map(|(key, made)| (*made, *key));
        let choosers = an.dispatchers.iter().map(|(&(of, method), made)| {
            let signature = made.signature;
            let callee = Callee::Chooser {
                of,
                method,
                signature,
            };
            (made.unit, callee)
        });
        Self {
            received: received.collect(),
            choosers: choosers.collect(),
        }
    }

    /// What was found in a body, if it can be found again without looking.
    fn finding(&self, an: &Analysis<'_>, checked: Checked) -> Option<Finding> {
        let mut finding = checked.finding;
        finding.calls.clear();
        for (callee, span) in checked.calls {
            match self.known(an, callee) {
                Known::Callee(callee) => finding.calls.push((callee, span)),
                Known::Library => {}
                Known::Unnamed => return None,
            }
        }
        Some(finding)
    }

    fn known(&self, an: &Analysis<'_>, callee: hir::PouId) -> Known {
        if let Some(&chooser) = self.choosers.get(&callee) {
            return Known::Callee(chooser);
        }
        let id = an.wanted[callee.index()];
        if let Some(&(body, of)) = self.received.get(&id) {
            return Known::Callee(Callee::Received { body, of });
        }
        match an.pous.get(id.index()) {
            None => Known::Unnamed,
            Some(pou) if an.is_library(pou.unit) => Known::Library,
            Some(_) if id.index() < an.declared_pous => Known::Callee(Callee::Declared(id)),
            Some(_) => Known::Unnamed,
        }
    }
}
