//! The unit that runs the test that is chosen: SETUP, the test unless SETUP failed, TEARDOWN.

use super::Body;
use crate::hir::code::{Block, Call, ExprId, ExprKind, PathStep, Root, StmtKind};
use crate::hir::{self, CompareOp, Elementary, Place, PouId, Step, TagId};
use crate::st::analysis::Analysis;
use crate::st::signature::UnitId;
use iecc_source::TextRange;

/// A test with the bodies around it, and what they run on.
pub(crate) struct TestRun {
    /// What chooses it.
    pub number: u64,
    pub unit: UnitId,
    pub test: (PouId, Place),
    pub setup: Option<(PouId, Place)>,
    /// Without SETUP there is nothing that it runs on.
    pub teardown: Option<(PouId, Option<Place>)>,
}

impl Analysis<'_> {
    /// A unit without parameters that runs one of some tests; `None` if there are none.
    pub(crate) fn test_runner(
        &mut self,
        choice: TagId,
        failed: TagId,
        runs: &[TestRun],
    ) -> Option<PouId> {
        let first = runs.first()?.unit;
        let span = self.span(first, TextRange::default());
        let mut body = Body::outside(self, first);
        let selector = body.load_udint(choice);
        let mut arms = Vec::with_capacity(runs.len());
        for run in runs {
            body.unit = run.unit;
            let label = vec![(run.number, run.number)];
            arms.push((label, body.test_run(failed, run)));
        }
        body.unit = first;
        let otherwise = Block::new();
        let kind = StmtKind::Case {
            selector,
            arms,
            otherwise,
        };
        body.before(kind, TextRange::default());
        body.code.body = std::mem::take(&mut body.pending);
        let code = std::mem::take(&mut body.code);
        Some(self.synthetic("tests'".to_owned(), code, span))
    }
}

impl Body<'_, '_> {
    fn load_udint(&mut self, tag: TagId) -> ExprId {
        let range = TextRange::default();
        let path = self.add_path(Root::Tag(tag), Vec::new(), range);
        self.add_expr(ExprKind::Load(path), Elementary::Udint, range)
    }

    /// Whether no check has failed.
    pub(super) fn none_failed(&mut self, failed: TagId) -> ExprId {
        let range = TextRange::default();
        let number = self.load_udint(failed);
        let none = self.add_const(0, Elementary::Udint, range);
        let kind = ExprKind::Compare(CompareOp::Equal, number, none);
        self.add_expr(kind, Elementary::Bool, range)
    }

    fn test_run(&mut self, failed: TagId, run: &TestRun) -> Block {
        let range = TextRange::default();
        if let Some((setup, fixture)) = &run.setup {
            self.run_on_tag(*setup, Some(fixture));
        }
        let outer = std::mem::take(&mut self.pending);
        self.run_on_tag(run.test.0, Some(&run.test.1));
        let test = std::mem::replace(&mut self.pending, outer);
        let arms = vec![(self.none_failed(failed), test)];
        let otherwise = Block::new();
        self.before(StmtKind::If { arms, otherwise }, range);
        if let Some((teardown, fixture)) = &run.teardown {
            self.run_on_tag(*teardown, fixture.as_ref());
        }
        std::mem::take(&mut self.pending)
    }

    fn run_on_tag(&mut self, callee: PouId, instance: Option<&Place>) {
        let range = TextRange::default();
        let refs = instance.map(|place| {
            let steps = place.path.iter().map(|step| match *step {
                Step::Field(field) => PathStep::Field(field),
                Step::Index(index) => PathStep::Index(index),
                Step::Bit(first) => PathStep::Bits { first, count: 1 },
            });
            let steps = steps.collect();
            self.add_path(Root::Tag(place.tag), steps, range)
        });
        let call = self.add_call(Call {
            callee,
            refs: refs.into_iter().collect(),
            args: Vec::new(),
            outputs: Vec::new(),
        });
        let value = self.add_expr(ExprKind::Call(call), hir::Elementary::Bool, range);
        self.before(StmtKind::Eval(value), range);
    }
}
