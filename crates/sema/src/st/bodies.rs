//! Checks the bodies that are needed, each once, until no new ones come up; then looks for what
//! only all of them show.

use super::analysis::Analysis;
use super::recheck::{Callee, Earlier, Finding, Kept};
use super::signature::PouId;
use super::testing::Suite;
use crate::hir::code::{CallId, Code, ExprKind};
use crate::hir::{self, Body};
use iecc_diag::{Diagnostic, Diagnostics};
use iecc_source::Span;

/// What a body calls, and where first, in the order of what is called.
pub(crate) type Calls = Vec<(hir::PouId, Span)>;

/// A body that was checked.
#[derive(Debug, Default)]
pub(crate) struct Checked {
    /// Whether it was not looked at, because what is found in it was known.
    pub known: bool,
    pub calls: Calls,
    pub finding: Finding,
}

/// What was noted in the course of a check, for the next one.
#[derive(Debug)]
pub(crate) struct Notes {
    /// By place in the typed program.
    pub bodies: Vec<Checked>,
    /// Warnings of names that are not used, by unit of the user, where they were looked for.
    pub unused: Vec<Option<Vec<Diagnostic>>>,
}

impl Analysis<'_> {
    /// Checks all bodies.
    pub(crate) fn finish(mut self, diagnostics: &mut Diagnostics) -> (hir::Program, Suite) {
        let mut earlier = Earlier::default();
        self.check_bodies(&mut earlier);
        self.show_results();
        let suite = self.suite();
        diagnostics.append(self.take_found());
        (self.hir, suite)
    }

    /// Checks the bodies for which nothing is kept. There is no program then.
    pub(crate) fn finish_again(mut self, kept: &mut Kept, diagnostics: &mut Diagnostics) {
        let mut earlier = std::mem::take(kept).for_text(&self);
        let notes = self.check_bodies(&mut earlier);
        *kept = earlier.next(&self, notes);
        diagnostics.append(self.take_found());
    }

    fn check_bodies(&mut self, earlier: &mut Earlier) -> Notes {
        self.declared_pous = self.pous.len();
        let mut bodies = Vec::new();
        while bodies.len() < self.wanted.len() {
            let (made, checked) = self.next_body(bodies.len(), earlier);
            self.hir.pous.push(made);
            bodies.push(checked);
        }
        self.check_uncalled();
        let users = self.units.len() - self.first_user_unit as usize;
        let unused = (0..users).map(|unit| earlier.take_unused(unit)).collect();
        let mut notes = Notes { bodies, unused };
        self.lint(&mut notes);
        notes
    }

    fn next_body(&mut self, index: usize, earlier: &mut Earlier) -> (hir::Pou, Checked) {
        let made = |(at, _): &(hir::PouId, hir::Pou)| at.index() == index;
        if let Some(position) = self.synthetics.iter().position(made) {
            let pou = self.synthetics.swap_remove(position).1;
            let calls = calls_of(&pou);
            let finding = Finding::default();
            return (
                pou,
                Checked {
                    known: false,
                    calls,
                    finding,
                },
            );
        }
        let id = self.wanted[index];
        let unit = self.written_in(id);
        match unit.and_then(|unit| earlier.take(unit, id)) {
            Some(finding) => self.known_pou(id, finding),
            None => self.checked_pou(id),
        }
    }

    /// A body that was checked before: it asks for what it calls, and has no code.
    fn known_pou(&mut self, id: PouId, finding: Finding) -> (hir::Pou, Checked) {
        finding
            .errors
            .iter()
            .for_each(|error| self.report(error.clone()));
        self.warnings.extend(finding.warnings.iter().cloned());
        let calls = finding.calls.iter();
        let calls = calls.map(|&(callee, span)| (self.want_again(callee), span));
        let calls = calls.collect();
        let pou = self.text_pou(id, Code::default());
        (
            pou,
            Checked {
                known: true,
                calls,
                finding,
            },
        )
    }

    fn want_again(&mut self, callee: Callee) -> hir::PouId {
        match callee {
            Callee::Declared(id) => self.want(id),
            Callee::Received { body, of } => {
                let body = self.body_for(body, of);
                self.want(body)
            }
            Callee::Chooser {
                of,
                method,
                signature,
            } => self.made_dispatcher(of, method, signature).unit,
        }
    }

    /// A body that is looked at.
    pub(crate) fn checked_pou(&mut self, id: PouId) -> (hir::Pou, Checked) {
        self.complete(id);
        let (errors, warnings) = (self.found.len(), self.warnings.len());
        let again = self.pou(id).receiver.is_some();
        let kept = again.then(|| std::mem::take(&mut self.found));
        let code = self.body(id);
        // Mistakes in a body are reported once, not for every type that it runs on.
        if let Some(kept) = kept {
            self.found = kept;
            self.warnings.truncate(warnings);
        }
        let pou = self.text_pou(id, code);
        let finding = Finding {
            errors: self.found.iter().skip(errors).cloned().collect(),
            warnings: self.warnings[warnings..].to_vec(),
            lints: None,
            calls: Vec::new(),
        };
        let calls = calls_of(&pou);
        (
            pou,
            Checked {
                known: false,
                calls,
                finding,
            },
        )
    }

    fn text_pou(&mut self, id: PouId, code: Code) -> hir::Pou {
        let pou = self.pou(id);
        let (span, own) = (pou.span, self.text(pou.name));
        let name = match pou.owner {
            _ if self.is_test(pou.unit) => self.test_name(id).unwrap_or_default(),
            Some(owner) => format!("{}.{own}", self.text(self.pou(owner).name)),
            None => own.to_owned(),
        };
        let name = self.unique_unit_name(name);
        hir::Pou {
            name,
            parameters: Vec::new(),
            results: Vec::new(),
            body: Body::Text(Box::new(code)),
            span,
        }
    }

    /// Instances of generic units and units of different namespaces may have one name.
    pub(crate) fn unique_unit_name(&mut self, name: String) -> String {
        let number = self.unit_names.entry(name.clone()).or_insert(0);
        *number += 1;
        match *number {
            1 => name,
            number => format!("{name}'{number}"),
        }
    }
}

fn calls_of(pou: &hir::Pou) -> Calls {
    let Body::Text(code) = &pou.body else {
        return Vec::new();
    };
    let mut found: Calls = Vec::new();
    for expr in &code.exprs {
        if let ExprKind::Call(CallId(call)) = expr.kind {
            found.push((code.calls[call as usize].callee, expr.span));
        }
    }
    found.sort_by_key(|(callee, span)| (callee.index(), *span));
    found.dedup_by_key(|(callee, _)| callee.index());
    found
}
