//! Units: their headers, sections and bodies in the order of the source.

use super::super::{
    Accessor, Configuration, Expr, Id, List, Member, Method, Pou, ProgramConfig, ProgramElement,
    Property, Resource, Task, Test, Unit, UnitKind, VarSection,
};
use super::Printer;

impl Printer<'_> {
    pub(super) fn unit(&mut self, unit: &Unit) {
        match &unit.kind {
            UnitKind::Types { modifiers, types } => {
                self.write("TYPE");
                for modifier in &self.arena[*modifiers] {
                    self.format(format_args!(" {}", modifier.kind.as_str()));
                }
                self.write("\n");
                self.indented(|printer| {
                    let types = &printer.arena[*types];
                    types.iter().for_each(|&decl| printer.type_decl(decl));
                });
                self.end_unit("TYPE");
            }
            UnitKind::Pou(pou) => self.pou(pou),
            UnitKind::Configuration(configuration) => self.configuration(configuration),
            UnitKind::Test(test) => self.test(test),
            UnitKind::Globals(section) => self.section(*section),
            UnitKind::Using(paths) => {
                self.pragmas_before(u32::MAX);
                self.paths("USING ", *paths, ";\n");
            }
            UnitKind::Nothing => {}
            UnitKind::Error => self.write("?\n"),
        }
    }

    fn pou(&mut self, pou: &Pou) {
        self.line(pou.range.start);
        self.format(format_args!("{} ", pou.kind.as_str()));
        self.modifiers(pou.modifiers);
        self.ident(pou.name);
        if let Some(result) = pou.result {
            self.write(" : ");
            self.ty(result);
        }
        self.paths(" EXTENDS ", pou.extends, "");
        self.paths(" IMPLEMENTS ", pou.implements, "");
        self.write("\n");
        self.indented(|printer| {
            if !pou.usings.is_empty() {
                printer.indentation();
                printer.paths("USING ", pou.usings, ";\n");
            }
            printer.sections(pou.sections);
            for member in &printer.arena[pou.members] {
                printer.member(member);
            }
        });
        self.block(pou.body);
        self.end_unit(pou.kind.as_str());
    }

    fn test(&mut self, test: &Test) {
        self.line(test.range.start);
        self.write(test.kind.as_str());
        if let Some(title) = test.title {
            self.write(" ");
            self.expr(title);
        }
        self.write("\n");
        self.indented(|printer| printer.sections(test.sections));
        self.block(test.body);
        self.end_unit(test.kind.as_str());
    }

    /// The last line. Pragmas that are left stand before it: behind it they would belong to the
    /// next unit.
    fn end_unit(&mut self, word: &str) {
        self.pragmas_before(u32::MAX);
        self.format(format_args!("END_{word}\n"));
    }

    fn paths(&mut self, before: &str, paths: List<Id<Expr>>, after: &str) {
        if !paths.is_empty() {
            self.write(before);
            self.exprs(paths);
            self.write(after);
        }
    }

    fn sections(&mut self, sections: List<VarSection>) {
        for &section in &self.arena[sections] {
            self.section(section);
        }
    }

    fn member(&mut self, member: &Member) {
        self.line(member.range().start);
        match member {
            Member::Method(method) => self.method(method),
            Member::Property(property) => self.property(property),
            Member::Action(action) => {
                self.write("ACTION ");
                self.ident(action.name);
                self.write(":\n");
                self.block(action.body);
                self.words("END_ACTION");
            }
        }
    }

    fn method(&mut self, method: &Method) {
        self.write("METHOD ");
        self.modifiers(method.modifiers);
        self.ident(method.name);
        if let Some(result) = method.result {
            self.write(" : ");
            self.ty(result);
        }
        self.write("\n");
        self.indented(|printer| printer.sections(method.sections));
        self.block(method.body);
        self.words("END_METHOD");
    }

    fn property(&mut self, property: &Property) {
        self.write("PROPERTY ");
        self.modifiers(property.modifiers);
        self.ident(property.name);
        self.write(" : ");
        self.ty(property.ty);
        self.write("\n");
        self.indented(|printer| {
            printer.accessor("GET", property.get);
            printer.accessor("SET", property.set);
        });
        self.words("END_PROPERTY");
    }

    fn accessor(&mut self, word: &str, accessor: Option<Accessor>) {
        let Some(accessor) = accessor else {
            return;
        };
        self.line(accessor.range.start);
        self.write(word);
        for modifier in &self.arena[accessor.modifiers] {
            self.format(format_args!(" {}", modifier.kind.as_str()));
        }
        self.write("\n");
        self.indented(|printer| printer.sections(accessor.sections));
        self.block(accessor.body);
        self.words(&format!("END_{word}"));
    }

    fn configuration(&mut self, configuration: &Configuration) {
        self.line(configuration.range.start);
        self.write("CONFIGURATION ");
        self.ident(configuration.name);
        self.write("\n");
        self.indented(|printer| {
            printer.sections(configuration.sections);
            for resource in &printer.arena[configuration.resources] {
                printer.resource(resource);
            }
        });
        self.end_unit("CONFIGURATION");
    }

    fn resource(&mut self, resource: &Resource) {
        let (Some(name), Some(on)) = (resource.name, resource.on) else {
            return self.resource_body(resource);
        };
        self.line(resource.range.start);
        self.write("RESOURCE ");
        self.ident(name);
        self.write(" ON ");
        self.ident(on);
        self.write("\n");
        self.indented(|printer| printer.resource_body(resource));
        self.words("END_RESOURCE");
    }

    fn resource_body(&mut self, resource: &Resource) {
        self.sections(resource.sections);
        for task in &self.arena[resource.tasks] {
            self.task(task);
        }
        for program in &self.arena[resource.programs] {
            self.program(program);
        }
    }

    fn task(&mut self, task: &Task) {
        self.line(task.range.start);
        self.write("TASK ");
        self.ident(task.name);
        self.write("(");
        self.comma(task.parameters, Self::argument);
        self.write(");\n");
    }

    fn program(&mut self, program: &ProgramConfig) {
        self.line(program.range.start);
        self.write("PROGRAM ");
        self.modifiers(program.modifiers);
        self.ident(program.name);
        if let Some(task) = program.task {
            self.write(" WITH ");
            self.ident(task);
        }
        self.write(" : ");
        self.expr(program.program);
        if !program.elements.is_empty() {
            self.write("(");
            self.comma(program.elements, Self::program_element);
            self.write(")");
        }
        self.write(";\n");
    }

    fn program_element(&mut self, element: ProgramElement) {
        match element {
            ProgramElement::Source { variable, source } => {
                self.expr(variable);
                self.write(" := ");
                self.expr(source);
            }
            ProgramElement::Sink { variable, sink } => {
                self.expr(variable);
                self.write(" => ");
                self.expr(sink);
            }
            ProgramElement::Task { block, task } => {
                self.expr(block);
                self.write(" WITH ");
                self.ident(task);
            }
        }
    }
}
