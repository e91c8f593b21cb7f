//! Types and declarations of variables.

use super::super::{
    AccessDecl, AccessDirection, Declarations, Dimension, Edge, EnumValue, Expr, Id,
    InstanceConfig, List, TypeDecl, TypeKind, TypeSpec, VarDecl, VarSection,
};
use super::Printer;

impl Printer<'_> {
    pub(super) fn type_decl(&mut self, decl: TypeDecl) {
        self.line(decl.range.start);
        self.ident(decl.name);
        if let Some(base) = decl.extends {
            self.write(" EXTENDS ");
            self.expr(base);
        }
        self.write(" : ");
        self.ty(decl.ty);
        self.initial(decl.initial);
        self.write(";\n");
    }

    fn initial(&mut self, initial: Option<Id<Expr>>) {
        if let Some(initial) = initial {
            self.write(" := ");
            self.expr(initial);
        }
    }

    pub(super) fn ty(&mut self, ty: Id<TypeSpec>) {
        match self.arena[ty].kind {
            TypeKind::Named(path) => self.expr(path),
            TypeKind::Subrange { base, low, high } => {
                self.expr(base);
                self.write(" (");
                self.range(low, high);
                self.write(")");
            }
            TypeKind::Sized {
                base,
                length,
                round,
            } => {
                let (open, close) = if round { ("(", ")") } else { ("[", "]") };
                self.expr(base);
                self.write(open);
                self.expr(length);
                self.write(close);
            }
            TypeKind::Array {
                dimensions,
                element,
            } => {
                self.write("ARRAY [");
                self.comma(dimensions, Self::dimension);
                self.write("] OF ");
                self.ty(element);
            }
            TypeKind::Struct { overlap, members } => {
                let overlap = if overlap { " OVERLAP" } else { "" };
                self.format(format_args!("STRUCT{overlap}\n"));
                self.variables(members, "END_STRUCT");
            }
            TypeKind::Union { members } => {
                self.write("UNION\n");
                self.variables(members, "END_UNION");
            }
            TypeKind::Enum { base, values } => self.enumeration(base, values),
            TypeKind::RefTo(target) => self.pointer("REF_TO ", target),
            TypeKind::PointerTo(target) => self.pointer("POINTER TO ", target),
            TypeKind::ReferenceTo(target) => self.pointer("REFERENCE TO ", target),
            TypeKind::Error => self.write("?"),
        }
    }

    fn pointer(&mut self, words: &str, target: Id<TypeSpec>) {
        self.write(words);
        self.ty(target);
    }

    fn enumeration(&mut self, base: Option<Id<Expr>>, values: List<EnumValue>) {
        if let Some(base) = base {
            self.expr(base);
            self.write(" ");
        }
        self.write("(");
        self.comma(values, |printer, value| {
            printer.ident(value.name);
            printer.initial(value.value);
        });
        self.write(")");
    }

    fn dimension(&mut self, dimension: Dimension) {
        match dimension {
            Dimension::Range { low, high } => self.range(low, high),
            Dimension::Open => self.write("*"),
        }
    }

    fn range(&mut self, low: Id<Expr>, high: Id<Expr>) {
        self.expr(low);
        self.write("..");
        self.expr(high);
    }

    /// Declarations on lines of their own, and the word that ends them.
    fn variables(&mut self, list: List<VarDecl>, end: &str) {
        self.indented(|printer| {
            for &variable in &printer.arena[list] {
                printer.variable(variable);
            }
        });
        self.indentation();
        self.write(end);
    }

    fn variable(&mut self, variable: VarDecl) {
        self.line(variable.range.start);
        self.comma(variable.names, Self::ident);
        if !variable.names.is_empty() && variable.location.is_some() {
            self.write(" ");
        }
        self.location(variable.location);
        self.write(" : ");
        self.ty(variable.ty);
        match variable.edge {
            Some(Edge::Rising) => self.write(" R_EDGE"),
            Some(Edge::Falling) => self.write(" F_EDGE"),
            None => {}
        }
        self.initial(variable.initial);
        self.write(";\n");
    }

    fn location(&mut self, location: Option<Id<Expr>>) {
        if let Some(location) = location {
            self.write("AT ");
            self.expr(location);
        }
    }

    pub(super) fn section(&mut self, section: VarSection) {
        self.line(section.range.start);
        self.write(section.kind.as_str());
        for modifier in &self.arena[section.modifiers] {
            self.format(format_args!(" {}", modifier.kind.as_str()));
        }
        self.write("\n");
        match section.declarations {
            Declarations::Variables(list) => {
                self.indented(|printer| {
                    let list = &printer.arena[list];
                    list.iter().for_each(|&variable| printer.variable(variable));
                });
            }
            Declarations::Accesses(list) => {
                self.indented(|printer| {
                    let list = &printer.arena[list];
                    list.iter().for_each(|&access| printer.access(access));
                });
            }
            Declarations::Instances(list) => {
                self.indented(|printer| {
                    let list = &printer.arena[list];
                    list.iter().for_each(|&config| printer.instance(config));
                });
            }
        }
        self.pragmas_before(section.range.end);
        self.words("END_VAR");
    }

    fn access(&mut self, access: AccessDecl) {
        self.line(access.range.start);
        self.ident(access.name);
        self.write(" : ");
        self.expr(access.path);
        self.write(" : ");
        self.ty(access.ty);
        match access.direction {
            Some(AccessDirection::ReadOnly) => self.write(" READ_ONLY"),
            Some(AccessDirection::ReadWrite) => self.write(" READ_WRITE"),
            None => {}
        }
        self.write(";\n");
    }

    fn instance(&mut self, config: InstanceConfig) {
        self.line(config.range.start);
        self.expr(config.path);
        if config.location.is_some() {
            self.write(" ");
        }
        self.location(config.location);
        self.write(" : ");
        self.ty(config.ty);
        self.initial(config.initial);
        self.write(";\n");
    }
}
