//! Units, their members, and configurations.

use super::{Build, ConfigItem, ConfigParts, Damage, Parts, SyntaxError};
use iecc_ast::st::{
    Accessor, Action, Argument, Configuration, Expr, Id, Ident, List, Member, Method, Modifier,
    Pou, PouKind, ProgramConfig, ProgramElement, Property, Resource, Stmt, StmtKind, Task, Test,
    TestKind, TypeSpec, UnitKind, VarSection,
};
use iecc_diag::{Code, Diagnostic};
use lalrpop_util::ParseError;

impl Parts {
    pub(crate) fn extends(mut self: Box<Self>, paths: Vec<Id<Expr>>) -> Box<Self> {
        self.extends.extend(paths);
        self
    }

    pub(crate) fn implements(mut self: Box<Self>, paths: Vec<Id<Expr>>) -> Box<Self> {
        self.implements.extend(paths);
        self
    }

    pub(crate) fn usings(mut self: Box<Self>, paths: Vec<Id<Expr>>) -> Box<Self> {
        self.usings.extend(paths);
        self
    }

    pub(crate) fn member(mut self: Box<Self>, member: Member) -> Box<Self> {
        self.members.push(member);
        self
    }
}

impl Build<'_, '_> {
    /// Sections stand before statements; a message says so otherwise.
    pub(crate) fn section_part(
        &mut self,
        mut parts: Box<Parts>,
        section: VarSection,
    ) -> Box<Parts> {
        if let Some(statement) = parts.first_statement {
            let word = section.kind.as_str();
            let start = section.range.start + self.base;
            let end = start + word.len() as u32;
            let written = self.tokens.text.get(start as usize..end as usize);
            if !written.is_some_and(|written| written.eq_ignore_ascii_case(word)) {
                // Put in by the repair, which has told so.
                parts.sections.push(section);
                return parts;
            }
            if std::mem::replace(&mut parts.disordered, true) {
                parts.sections.push(section);
                return parts;
            }
            let span = self.span(start, end);
            let message = format!("{word} stands behind statements");
            let diagnostic = Diagnostic::new(Code::E0027, span, message)
                .label("expected before the first statement")
                .also(self.span_of(statement), "the first statement");
            self.report(diagnostic);
        }
        parts.sections.push(section);
        parts
    }

    pub(crate) fn statement_part(&mut self, mut parts: Box<Parts>, stmt: Id<Stmt>) -> Box<Parts> {
        let node = &self.arena[stmt];
        // Semicolons behind END_METHOD and the like are no statements.
        let has_begun = parts.first_statement.is_some();
        if node.kind != StmtKind::Empty || has_begun {
            parts.first_statement.get_or_insert(node.range);
            parts.body.push(stmt);
        }
        parts
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of a unit")]
    pub(crate) fn pou(
        &mut self,
        start: u32,
        kind: PouKind,
        opener_end: u32,
        modifiers: Vec<Modifier>,
        name: Ident,
        result: Option<Id<TypeSpec>>,
        parts: Parts,
        close: PouKind,
        end: u32,
    ) -> Result<UnitKind, SyntaxError> {
        if close != kind {
            return Err(ParseError::User {
                error: Damage::WrongCloser,
            });
        }
        let pou = Pou {
            kind,
            modifiers: self.arena.list(modifiers),
            name,
            result,
            extends: self.arena.list(parts.extends),
            implements: self.arena.list(parts.implements),
            usings: self.arena.list(parts.usings),
            sections: self.arena.list(parts.sections),
            members: self.arena.list(parts.members),
            body: self.arena.list(parts.body),
            opener: self.range(start, opener_end),
            range: self.range(start, end),
        };
        Ok(UnitKind::Pou(Box::new(pou)))
    }

    pub(crate) fn method(
        &mut self,
        start: u32,
        modifiers: Vec<Modifier>,
        name: Ident,
        result: Option<Id<TypeSpec>>,
        parts: Parts,
        end: u32,
    ) -> Box<Member> {
        Box::new(Member::Method(Method {
            modifiers: self.arena.list(modifiers),
            name,
            result,
            sections: self.arena.list(parts.sections),
            body: self.arena.list(parts.body),
            range: self.range(start, end),
        }))
    }

    pub(crate) fn action(
        &mut self,
        start: u32,
        name: Ident,
        body: Vec<Id<Stmt>>,
        end: u32,
    ) -> Box<Member> {
        Box::new(Member::Action(Action {
            name,
            body: self.arena.list(body),
            range: self.range(start, end),
        }))
    }

    /// An accessor, and whether it is GET.
    pub(crate) fn accessor(
        &mut self,
        get: bool,
        start: u32,
        modifiers: Vec<Modifier>,
        parts: Parts,
        end: u32,
    ) -> (bool, Accessor) {
        let accessor = Accessor {
            modifiers: self.arena.list(modifiers),
            sections: self.arena.list(parts.sections),
            body: self.arena.list(parts.body),
            range: self.range(start, end),
        };
        (get, accessor)
    }

    pub(crate) fn property(
        &mut self,
        start: u32,
        modifiers: Vec<Modifier>,
        name: Ident,
        ty: Id<TypeSpec>,
        accessors: Vec<(bool, Accessor)>,
        end: u32,
    ) -> Box<Member> {
        let (mut get, mut set) = (None, None);
        for (is_get, accessor) in accessors {
            let place = if is_get { &mut get } else { &mut set };
            if let Some(first) = place.replace(accessor) {
                *place = Some(first);
                self.second_accessor(is_get, first, accessor);
            }
        }
        Box::new(Member::Property(Property {
            modifiers: self.arena.list(modifiers),
            name,
            ty,
            get,
            set,
            range: self.range(start, end),
        }))
    }

    fn second_accessor(&mut self, get: bool, first: Accessor, second: Accessor) {
        let word = if get { "GET" } else { "SET" };
        let message = format!("the property has a second {word}");
        let diagnostic = Diagnostic::new(Code::E0010, self.span_of(second.range), message)
            .also(self.span_of(first.range), "the first one");
        self.report(diagnostic);
    }

    pub(crate) fn test(
        &mut self,
        start: u32,
        kind: TestKind,
        title: Option<Id<Expr>>,
        opener_end: u32,
        parts: Parts,
        end: u32,
    ) -> UnitKind {
        UnitKind::Test(Box::new(Test {
            kind,
            title,
            sections: self.arena.list(parts.sections),
            body: self.arena.list(parts.body),
            opener: self.range(start, opener_end),
            range: self.range(start, end),
        }))
    }

    pub(crate) fn task(
        &mut self,
        start: u32,
        name: Ident,
        parameters: Vec<Argument>,
        end: u32,
    ) -> Box<ConfigItem> {
        let parameters = self.arena.list(parameters);
        let range = self.range(start, end);
        Box::new(ConfigItem::Task(Task {
            name,
            parameters,
            range,
        }))
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of an instance")]
    pub(crate) fn program(
        &mut self,
        start: u32,
        modifiers: Vec<Modifier>,
        name: Ident,
        task: Option<Ident>,
        program: Id<Expr>,
        elements: Option<Vec<ProgramElement>>,
        end: u32,
    ) -> Box<ConfigItem> {
        Box::new(ConfigItem::Program(ProgramConfig {
            modifiers: self.arena.list(modifiers),
            name,
            task,
            program,
            elements: self.arena.list(elements.unwrap_or_default()),
            range: self.range(start, end),
        }))
    }

    pub(crate) fn config_item(
        &mut self,
        mut parts: Box<ConfigParts>,
        item: ConfigItem,
    ) -> Box<ConfigParts> {
        match item {
            ConfigItem::Section(section) => parts.sections.push(section),
            ConfigItem::Task(task) => parts.tasks.push(task),
            ConfigItem::Program(program) => parts.programs.push(program),
        }
        parts
    }

    pub(crate) fn resource(
        &mut self,
        mut parts: Box<ConfigParts>,
        start: u32,
        name: Ident,
        on: Ident,
        inner: ConfigParts,
        end: u32,
    ) -> Box<ConfigParts> {
        let resource = Resource {
            name: Some(name),
            on: Some(on),
            sections: self.arena.list(inner.sections),
            tasks: self.arena.list(inner.tasks),
            programs: self.arena.list(inner.programs),
            range: self.range(start, end),
        };
        parts.resources.push(resource);
        parts
    }

    pub(crate) fn configuration(
        &mut self,
        start: u32,
        name: Ident,
        parts: ConfigParts,
        end: u32,
    ) -> UnitKind {
        let range = self.range(start, end);
        let mut resources = parts.resources;
        if !parts.tasks.is_empty() || !parts.programs.is_empty() {
            let unnamed = Resource {
                name: None,
                on: None,
                sections: List::EMPTY,
                tasks: self.arena.list(parts.tasks),
                programs: self.arena.list(parts.programs),
                range,
            };
            resources.insert(0, unnamed);
        }
        UnitKind::Configuration(Box::new(Configuration {
            name,
            sections: self.arena.list(parts.sections),
            resources: self.arena.list(resources),
            range,
        }))
    }
}
