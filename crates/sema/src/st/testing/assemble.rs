//! The program that runs tests: an instance of each, and a scan that runs the one that is chosen.

use super::{Suite, Tests, point, whole_or_base};
use crate::hir::{Elementary, Place, Task, Trigger, View};
use crate::st::analysis::Analysis;
use crate::st::body::TestRun;
use crate::st::types::TypeKind;

impl Analysis<'_> {
    /// Makes what runs: the program of the user, or the one that runs tests.
    pub(crate) fn assemble_all(&mut self) {
        match self.options.tests {
            Tests::LeftOut | Tests::Checked => self.assemble(),
            Tests::Run { .. } => self.assemble_tests(),
        }
    }

    fn assemble_tests(&mut self) {
        let choice = self.hidden_tag(Suite::CHOICE, Elementary::Udint, View::Number);
        let failed = self.failed_tag();
        let mut runs = Vec::new();
        for (position, case) in (0..).zip(self.testing.cases.clone()) {
            if !self.options.tests.runs(position) {
                continue;
            }
            let ty = self.types.intern(TypeKind::Instance(case.test));
            let (storage, init) = (self.storage(ty), self.default_init(ty));
            let name = format!("test'{}", position + 1);
            let span = self.pou(case.test).span;
            let tag = self.add_tag(&name, storage, View::Number, init, Some(span));
            self.testing.cases[position as usize].tag = Some(tag);
            let fixture = whole_or_base(tag, case.setup.is_some());
            runs.push(TestRun {
                number: u64::from(position) + 1,
                unit: self.pou(case.test).unit,
                test: (self.want(case.test), Place::whole(tag)),
                setup: case.setup.map(|setup| (self.want(setup), fixture.clone())),
                teardown: case
                    .teardown
                    .map(|teardown| (self.want(teardown), case.setup.map(|_| fixture))),
            });
        }
        let main = self.test_runner(choice, failed, &runs);
        self.hir.name = "tests".to_owned();
        self.hir.inputs = vec![point(Suite::CHOICE, choice)];
        self.hir.tasks.push(Task {
            name: "tests".to_owned(),
            trigger: Trigger::EveryScan,
            priority: 0,
            calls: main.into_iter().collect(),
        });
    }

    /// Shows what checks store. To be done when all bodies are written.
    pub(crate) fn show_results(&mut self) {
        if !matches!(self.options.tests, Tests::Run { .. }) {
            return;
        }
        let failed = self.failed_tag();
        let mut tags: Vec<_> = self.testing.operands.values().copied().collect();
        tags.sort_unstable();
        tags.insert(0, failed);
        let points = tags
            .into_iter()
            .map(|tag| point(&self.hir.tag(tag).name, tag));
        self.hir.outputs = points.collect();
    }
}
