//! Recursion: no unit may be running when it is called, whatever lies between. State is laid out
//! once, so this is an error; it is said once for everything that calls one another.

use crate::hir;
use crate::st::analysis::Analysis;
use crate::st::bodies::Checked;
use iecc_diag::{Code, Diagnostic};
use iecc_source::Span;
use std::collections::VecDeque;

/// Who calls whom, and where first.
type Calls = Vec<Vec<(usize, Span)>>;

impl Analysis<'_> {
    /// Reports every circle of calls.
    pub(super) fn recursion(&mut self, bodies: &[Checked]) {
        let indexed = |&(callee, span): &(hir::PouId, Span)| (callee.index(), span);
        let calls = bodies.iter().map(|one| &one.calls);
        let calls: Calls = calls.map(|one| one.iter().map(indexed).collect()).collect();
        for circle in circles(&calls, &self.hir.pous) {
            let diagnostic = self.circle(&circle);
            self.report(diagnostic);
        }
    }

    /// `circle` has each unit and where it calls the next one; the last calls the first.
    fn circle(&self, circle: &[(usize, Span)]) -> Diagnostic {
        let name = |unit: usize| self.hir.pous[unit].name.as_str();
        let mut path: Vec<&str> = circle.iter().map(|(unit, _)| name(*unit)).collect();
        path.push(name(circle[0].0));
        let message = format!("recursion: `{}`", path.join("` -> `"));
        let mut diagnostic = Diagnostic::new(Code::E3040, circle[0].1, message);
        for (index, (_, span)) in circle.iter().enumerate().skip(1) {
            let text = format!("`{}` calls `{}` here", path[index], path[index + 1]);
            diagnostic = diagnostic.also(*span, text);
        }
        diagnostic
            .note("a unit has its variables once, so it cannot be called while it runs; use a loop")
    }
}

/// A shortest circle through the first unit of everything that calls one another.
fn circles(calls: &Calls, pous: &[hir::Pou]) -> Vec<Vec<(usize, Span)>> {
    let components = components(calls);
    let mut first: Vec<Option<usize>> = vec![None; calls.len()];
    for (unit, &component) in components.iter().enumerate() {
        let known = &mut first[component];
        if known.is_none_or(|known| pous[unit].span < pous[known].span) {
            *known = Some(unit);
        }
    }
    let starts = first.into_iter().flatten();
    starts
        .filter_map(|start| circle_through(calls, &components, start))
        .collect()
}

/// Breadth first from a unit back to it, within its component.
fn circle_through(calls: &Calls, components: &[usize], start: usize) -> Option<Vec<(usize, Span)>> {
    let mut reached: std::collections::BTreeMap<usize, (usize, Span)> = Default::default();
    let mut queue = VecDeque::from([start]);
    while let Some(unit) = queue.pop_front() {
        for &(callee, span) in &calls[unit] {
            if components[callee] != components[start] || reached.contains_key(&callee) {
                continue;
            }
            reached.insert(callee, (unit, span));
            if callee == start {
                return Some(way_back(&reached, start));
            }
            queue.push_back(callee);
        }
    }
    None
}

fn way_back(
    reached: &std::collections::BTreeMap<usize, (usize, Span)>,
    start: usize,
) -> Vec<(usize, Span)> {
    let mut circle = Vec::new();
    let mut at = start;
    loop {
        let (from, span) = reached[&at];
        circle.push((from, span));
        at = from;
        if at == start {
            circle.reverse();
            return circle;
        }
    }
}

/// The strongly connected component of each unit, by a number (Tarjan, without recursion).
fn components(calls: &Calls) -> Vec<usize> {
    let mut state = Tarjan {
        order: vec![usize::MAX; calls.len()],
        low: vec![0; calls.len()],
        component: vec![usize::MAX; calls.len()],
        open: Vec::new(),
        next: 0,
        components: 0,
    };
    for unit in 0..calls.len() {
        if state.order[unit] == usize::MAX {
            state.visit(calls, unit);
        }
    }
    state.component
}

struct Tarjan {
    order: Vec<usize>,
    low: Vec<usize>,
    component: Vec<usize>,
    open: Vec<usize>,
    next: usize,
    components: usize,
}

impl Tarjan {
    fn visit(&mut self, calls: &Calls, start: usize) {
        let mut work = vec![(start, 0)];
        self.enter(start);
        while let Some((unit, edge)) = work.pop() {
            if let Some(&(callee, _)) = calls[unit].get(edge) {
                work.push((unit, edge + 1));
                if self.order[callee] == usize::MAX {
                    self.enter(callee);
                    work.push((callee, 0));
                } else if self.component[callee] == usize::MAX {
                    self.low[unit] = self.low[unit].min(self.order[callee]);
                }
                continue;
            }
            self.leave(unit);
            if let Some((caller, _)) = work.last() {
                self.low[*caller] = self.low[*caller].min(self.low[unit]);
            }
        }
    }

    fn enter(&mut self, unit: usize) {
        self.order[unit] = self.next;
        self.low[unit] = self.next;
        self.next += 1;
        self.open.push(unit);
    }

    fn leave(&mut self, unit: usize) {
        if self.low[unit] != self.order[unit] {
            return;
        }
        while let Some(member) = self.open.pop() {
            self.component[member] = self.components;
            if member == unit {
                break;
            }
        }
        self.components += 1;
    }
}
