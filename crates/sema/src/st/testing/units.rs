//! Declares tests as units with bodies. To be done when it is known who extends whom: tests extend
//! the SETUP of their file, but are no relatives that references could mean.

use super::{Case, Test};
use crate::st::analysis::Analysis;
use crate::st::signature::{Bindings, Def, Part, Pou, PouId, State, UnitId};
use iecc_ast::st::{self, ExprKind, Literal, PouKind, Stmt, StmtKind, TestKind, UnitKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::{FileId, Span};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// What runs around the tests of a file.
#[derive(Debug, Clone, Copy, Default)]
struct Fixture {
    setup: Option<PouId>,
    teardown: Option<PouId>,
}

impl Analysis<'_> {
    /// Notes a unit that is a test.
    pub(crate) fn note_test(&mut self, unit: UnitId) {
        self.testing.units.push(unit);
    }

    /// Declares the tests that were noted.
    pub(crate) fn declare_tests(&mut self) {
        let units = self.testing.units.clone();
        let mut fixtures: BTreeMap<FileId, Fixture> = BTreeMap::new();
        for &unit in &units {
            self.note_mocks(unit);
            let fixture = fixtures.entry(self.unit(unit).file).or_default();
            self.setup_or_teardown(unit, fixture);
        }
        for fixture in fixtures.values() {
            if let Some(teardown) = fixture.teardown {
                self.pous[teardown.index()].owner = fixture.setup;
            }
        }
        let mut titles: FxHashMap<(FileId, String), Span> = FxHashMap::default();
        for &unit in &units {
            if self.written_test(unit).kind != TestKind::Test {
                continue;
            }
            let fixture = fixtures[&self.unit(unit).file];
            let test = self.declare_test(unit, PouKind::FunctionBlock);
            self.pous[test.index()].extends.extend(fixture.setup);
            let Test {
                file, title, span, ..
            } = self.described(test);
            match titles.get(&(file, title.clone())) {
                Some(&first) => {
                    let message = format!("this file has a test `{title}` already");
                    self.twice(message, span, first);
                }
                None => drop(titles.insert((file, title), span)),
            }
            self.testing.cases.push(Case {
                test,
                setup: fixture.setup,
                teardown: fixture.teardown,
                tag: None,
            });
        }
    }

    fn written_test(&self, unit: UnitId) -> st::Test {
        match &self.unit(unit).kind {
            UnitKind::Test(test) => **test,
            UnitKind::Types { .. }
            | UnitKind::Pou(_)
            | UnitKind::Configuration(_)
            | UnitKind::Globals(_)
            | UnitKind::Using(_)
            | UnitKind::Nothing
            | UnitKind::Error => unreachable!("only tests are noted"),
        }
    }

    fn setup_or_teardown(&mut self, unit: UnitId, fixture: &mut Fixture) {
        let kind = self.written_test(unit).kind;
        let (first, pou_kind) = match kind {
            TestKind::Test => return,
            TestKind::Setup => (&mut fixture.setup, PouKind::FunctionBlock),
            TestKind::Teardown => (&mut fixture.teardown, PouKind::Function),
        };
        let made = self.declare_test(unit, pou_kind);
        if let Some(first) = *first {
            let (span, first) = (self.pou(made).span, self.pou(first).span);
            let message = format!("this file has a {} already", kind.as_str());
            self.twice(message, span, first);
            return;
        }
        *first = Some(made);
    }

    fn twice(&mut self, message: String, span: Span, first: Span) {
        let diagnostic = Diagnostic::new(Code::E1003, span, message);
        self.report(diagnostic.also(first, "here"));
    }

    fn declare_test(&mut self, unit: UnitId, kind: PouKind) -> PouId {
        let written = self.written_test(unit);
        let name = self.names.find(written.kind.as_str());
        let name = name.expect("words are interned first");
        let range = match written.title {
            Some(title) => self.unit(unit).arena[title].range,
            None => written.opener,
        };
        let id = self.add_pou(Pou {
            name,
            kind,
            unit,
            part: Part::Whole,
            owner: None,
            namespace: self.units[unit.index()].namespace,
            span: self.span(unit, range),
            result: None,
            result_name: name,
            vars: Vec::new(),
            by_name: FxHashMap::default(),
            members: Vec::new(),
            extends: Vec::new(),
            implements: Vec::new(),
            receiver: None,
            modifiers: Vec::new(),
            bindings: Bindings::default(),
            template: None,
            state: State::Declared,
        });
        self.pou_of_unit.insert(unit, id);
        id
    }

    /// The file, title and place of a test.
    pub(super) fn described(&self, test: PouId) -> Test {
        let pou = self.pou(test);
        Test {
            file: self.unit(pou.unit).file,
            title: self.title(pou.unit),
            span: pou.span,
            tag: None,
        }
    }

    fn title(&self, unit: UnitId) -> String {
        let arena = &self.unit(unit).arena;
        let title = self.written_test(unit).title.map(|title| arena[title].kind);
        let Some(ExprKind::Literal(literal)) = title else {
            return String::new();
        };
        match &arena[literal] {
            Literal::String(string) => String::from_utf16_lossy(&string.units),
            Literal::Bool(_) | Literal::Int(_) | Literal::Real { .. } | Literal::Time(_) => {
                String::new()
            }
        }
    }

    /// How a test is called where faults and circles of calls are reported; `None` for other units.
    pub(crate) fn test_name(&self, id: PouId) -> Option<String> {
        let unit = self.pou(id).unit;
        if !self.is_test(unit) {
            return None;
        }
        let kind = self.written_test(unit).kind;
        Some(match kind {
            TestKind::Test => format!("TEST '{}'", self.title(unit)),
            TestKind::Setup | TestKind::Teardown => kind.as_str().to_owned(),
        })
    }

    /// What the statements of a test mock. Paths that lead to no function get their message when the
    /// statement is looked at.
    fn note_mocks(&mut self, unit: UnitId) {
        let namespace = self.units[unit.index()].namespace;
        for stmt in self.unit(unit).arena.all::<Stmt>() {
            if let StmtKind::Mock(_) = stmt.kind {
                self.testing.mocks = true;
            }
            if let StmtKind::MockFunction { function, .. } = stmt.kind
                && let Some(&[Def::Pou(found), ..]) = self.path(unit, namespace, function)
            {
                self.testing.functions.entry(found).or_default();
            }
        }
    }
}
