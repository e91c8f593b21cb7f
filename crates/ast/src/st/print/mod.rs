//! Canonical text of Structured Text: parsing it gives the same tree, and printing that gives the
//! same text.
//!
//! Keywords are in capitals, names as they were first spelled, parentheses only where the tree
//! needs them. Comments are gone; pragmas stand before the statement, declaration or unit they
//! stood in or before. Nodes of kind `Error` print as `?`, which does not parse.

mod expr;
mod literal;
mod stmt;
mod types;
mod unit;

pub use literal::string_text;

use super::{Arena, File, Ident, Item, Modifier, Pragma, Scope, ScopeId, Unit};
use super::{Expr, Id, List, Stored};
use crate::names::{Names, Symbol};
use std::fmt;

/// The text of a file.
pub fn print_file(file: &File, names: &Names) -> String {
    let mut out = String::new();
    print_scope(file, &file.scopes[0], names, &mut out);
    out
}

fn print_scope(file: &File, scope: &Scope, names: &Names, out: &mut String) {
    for (index, &item) in scope.items.iter().enumerate() {
        if index > 0 {
            out.push('\n');
        }
        match item {
            Item::Unit(unit) => out.push_str(&print_unit(&file.units[unit as usize], names)),
            Item::Scope(ScopeId(inner)) => {
                print_namespace(file, &file.scopes[inner as usize], names, out);
            }
        }
    }
}

fn print_namespace(file: &File, scope: &Scope, names: &Names, out: &mut String) {
    out.push_str("NAMESPACE ");
    if scope.internal {
        out.push_str("INTERNAL ");
    }
    let parts: Vec<&str> = scope
        .name
        .iter()
        .map(|part| names.text(part.name))
        .collect();
    out.push_str(&parts.join("."));
    out.push_str("\n\n");
    print_scope(file, scope, names, out);
    out.push_str("\nEND_NAMESPACE\n");
}

/// The text of a unit.
pub fn print_unit(unit: &Unit, names: &Names) -> String {
    let mut printer = Printer::new(&unit.arena, names, &unit.pragmas);
    printer.unit(unit);
    printer.pragmas_before(u32::MAX);
    printer.out
}

/// The text of an expression of a unit.
pub fn print_expr(arena: &Arena, expr: Id<Expr>, names: &Names) -> String {
    let mut printer = Printer::new(arena, names, &[]);
    printer.expr(expr);
    printer.out
}

struct Printer<'p> {
    arena: &'p Arena,
    names: &'p Names,
    /// Those not yet printed.
    pragmas: std::slice::Iter<'p, Pragma>,
    out: String,
    indent: usize,
}

impl<'p> Printer<'p> {
    fn new(arena: &'p Arena, names: &'p Names, pragmas: &'p [Pragma]) -> Self {
        Self {
            arena,
            names,
            pragmas: pragmas.iter(),
            out: String::new(),
            indent: 0,
        }
    }

    fn write(&mut self, text: &str) {
        self.out.push_str(text);
    }

    fn format(&mut self, arguments: fmt::Arguments<'_>) {
        fmt::Write::write_fmt(&mut self.out, arguments).expect("writing to a string succeeds");
    }

    /// Begins a line for what stood at `start` in the unit, behind the pragmas before it.
    fn line(&mut self, start: u32) {
        self.pragmas_before(start);
        self.indentation();
    }

    fn indentation(&mut self) {
        for _ in 0..self.indent {
            self.write("  ");
        }
    }

    /// A line of its own.
    fn words(&mut self, words: &str) {
        self.indentation();
        self.write(words);
        self.write("\n");
    }

    fn indented(&mut self, print: impl FnOnce(&mut Self)) {
        self.indent += 1;
        print(self);
        self.indent -= 1;
    }

    fn pragmas_before(&mut self, start: u32) {
        while let Some(pragma) = self.pragmas.as_slice().first()
            && pragma.range.start < start
        {
            self.pragmas.next();
            self.indentation();
            self.format(format_args!("{{{}}}\n", pragma.text));
        }
    }

    fn name(&mut self, symbol: Symbol) {
        let names = self.names;
        self.write(names.text(symbol));
    }

    fn ident(&mut self, ident: Ident) {
        self.name(ident.name);
    }

    fn modifiers(&mut self, modifiers: List<Modifier>) {
        for modifier in &self.arena[modifiers] {
            self.write(modifier.kind.as_str());
            self.write(" ");
        }
    }

    /// Elements with a comma between them.
    fn comma<T: Stored + Copy + 'p>(&mut self, list: List<T>, print: impl Fn(&mut Self, T)) {
        for (index, &element) in self.arena[list].iter().enumerate() {
            if index > 0 {
                self.write(", ");
            }
            print(self, element);
        }
    }

    fn exprs(&mut self, list: List<Id<Expr>>) {
        self.comma(list, Self::expr);
    }
}
