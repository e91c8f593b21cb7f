//! Initial values of arrays: `[1, 2(0), 3]` as runs of elements that hold the same.
//!
//! Values are given in the order of the elements, the last index fastest. Elements without a value
//! hold the default of their type. However often values are repeated, there are at most
//! [`MAX_RUNS`] runs and few more.

use super::Analysis;
use crate::hir::{InitId, code::Init};
use crate::st::resolve::TypeScope;
use crate::st::signature::{Def, Storage};
use crate::st::storage::extent;
use crate::st::types::TypeId;
use iecc_ast::st::{self, ArgumentKind, ExprKind};
use iecc_diag::Code;
use iecc_source::TextRange;

/// Beyond so many runs values are no longer repeated. Arrays of so many elements are too large anyway.
const MAX_RUNS: usize = 1 << 20;

/// Elements behind one another that hold the same; the zero of their type if there is no `init`.
#[derive(Debug, Clone, Copy)]
struct Run {
    first: u64,
    count: u64,
    init: Option<InitId>,
}

impl Run {
    fn end(self) -> u64 {
        self.first + self.count
    }
}

/// The elements that have got values.
struct Elements {
    runs: Vec<Run>,
    /// How many values were given.
    given: u64,
    /// How many elements there are.
    total: u64,
}

impl Elements {
    fn push(&mut self, count: u64, init: Option<InitId>) {
        self.runs.push(Run {
            first: self.given,
            count,
            init,
        });
        self.given = self.given.saturating_add(count);
    }

    /// Makes the values from a run on, which stand there once, stand there `count` times.
    fn repeat_from(&mut self, run: usize, count: u64) {
        let Some(&Run { first, .. }) = self.runs.get(run) else {
            return;
        };
        let once = self.given - first;
        self.given = first.saturating_add(once.saturating_mul(count));
        if self.given == first {
            self.runs.truncate(run);
            return;
        }
        let last = self.runs.len();
        if last == run + 1 && once == 1 {
            self.runs[run].count = count;
            return;
        }
        for round in 1..count {
            let shift = round * once;
            if first + shift > self.total || self.runs.len() > MAX_RUNS {
                break;
            }
            for at in run..last {
                let made = self.runs[at];
                self.runs.push(Run {
                    first: made.first + shift,
                    ..made
                });
            }
        }
    }
}

/// `count(values)`
struct Repetition {
    count: st::Id<st::Expr>,
    values: Vec<st::Id<st::Expr>>,
}

impl Analysis<'_> {
    /// The values of an array in the order of its elements, then of its dimensions.
    pub(super) fn array_value(
        &mut self,
        scope: TypeScope<'_>,
        values: st::List<st::Id<st::Expr>>,
        dimensions: &[(i64, i64)],
        element: TypeId,
        range: TextRange,
    ) -> Option<InitId> {
        let total: u64 = dimensions.iter().map(|d| u64::from(extent(*d))).product();
        let mut elements = Elements {
            runs: Vec::new(),
            given: 0,
            total,
        };
        let values = &self.unit(scope.unit).arena[values];
        self.element_values(scope, values, element, &mut elements);
        let given = elements.given;
        if given > total {
            let span = self.span(scope.unit, range);
            let message = format!("the array has {total} elements but {given} values are given");
            self.error(Code::E2008, span, message);
            return None;
        }
        let default = self.default_init(element);
        if given < total && default.is_some() {
            elements.push(total - given, default);
        }
        self.nested_runs(&elements.runs, dimensions, 0, total)
    }

    fn element_values(
        &mut self,
        scope: TypeScope<'_>,
        values: &[st::Id<st::Expr>],
        element: TypeId,
        elements: &mut Elements,
    ) {
        for &value in values {
            match self.repetition(scope, value) {
                Some(repeated) => self.repeated_values(scope, &repeated, element, elements),
                None => {
                    let init = self.value_of(scope, value, element);
                    elements.push(1, init);
                }
            }
        }
    }

    fn repeated_values(
        &mut self,
        scope: TypeScope<'_>,
        repeated: &Repetition,
        element: TypeId,
        elements: &mut Elements,
    ) {
        let count = self.constant_int(scope, repeated.count, TypeId::UNTYPED_INT);
        let count = u64::try_from(count.unwrap_or(0)).unwrap_or(0);
        if repeated.values.is_empty() {
            let init = self.default_init(element);
            elements.push(count, init);
            return;
        }
        let run = elements.runs.len();
        self.element_values(scope, &repeated.values, element, elements);
        elements.repeat_from(run, count);
    }

    /// What a value of an array says to repeat. Behind a named constant the values look like the
    /// arguments of a call.
    fn repetition(&mut self, scope: TypeScope<'_>, value: st::Id<st::Expr>) -> Option<Repetition> {
        let arena = &self.unit(scope.unit).arena;
        if let ExprKind::Repeat { count, values } = arena[value].kind {
            let values = arena[values].to_vec();
            return Some(Repetition { count, values });
        }
        if let ExprKind::Call { callee, arguments } = arena[value].kind
            && self.is_count(scope, callee)
        {
            let arguments = &arena[arguments];
            let values = arguments.iter().filter_map(|a| a.value).collect();
            if let Some(named) = arguments
                .iter()
                .find(|a| a.kind != ArgumentKind::Positional)
            {
                let span = self.span(scope.unit, named.range);
                self.error(Code::E2008, span, "values that are repeated have no names");
            }
            return Some(Repetition {
                count: callee,
                values,
            });
        }
        None
    }

    /// Whether what looks like a call is a named constant that says how often values stand there.
    fn is_count(&mut self, scope: TypeScope<'_>, callee: st::Id<st::Expr>) -> bool {
        let arena = &self.unit(scope.unit).arena;
        let Some(name) = arena[callee].kind.name() else {
            return false;
        };
        let own = scope.pou.and_then(|pou| self.pou(pou).var(name));
        own.is_some_and(|var| matches!(var.storage, Storage::Const(_)))
            || matches!(self.lookup(scope.namespace, name), [Def::Global(_)])
    }

    /// Runs over all elements as initial values of nested arrays.
    fn nested_runs(
        &mut self,
        runs: &[Run],
        dimensions: &[(i64, i64)],
        start: u64,
        total: u64,
    ) -> Option<InitId> {
        let (first, inner) = dimensions.split_first().expect("at least one dimension");
        let count = u64::from(extent(*first));
        let mut made: Vec<(u32, u32, InitId)> = Vec::new();
        if inner.is_empty() {
            for run in runs {
                let (from, to) = (run.first.max(start), run.end().min(start + total));
                if let (Some(init), true) = (run.init, from < to) {
                    made.push(((from - start) as u32, (to - from) as u32, init));
                }
            }
        } else {
            let each = total / count;
            for position in 0..count {
                let from = start + position * each;
                let low = runs.partition_point(|run| run.end() <= from);
                let high = runs.partition_point(|run| run.first < from + each);
                let init = self.nested_runs(&runs[low..high], inner, from, each);
                match (init, made.last_mut()) {
                    (Some(init), Some((at, n, last)))
                        if *last == init && u64::from(*at + *n) == position =>
                    {
                        *n += 1;
                    }
                    (Some(init), _) => made.push((position as u32, 1, init)),
                    (None, _) => {}
                }
            }
        }
        (!made.is_empty()).then(|| self.init(Init::Array(made)))
    }
}
