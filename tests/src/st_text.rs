//! Random Structured Text that follows the grammar, with nesting kept small. Names mean nothing:
//! only the parser is meant to accept it.

use crate::rng::Rng;

/// A small file with at least one of everything the parser knows.
pub const SAMPLE: &str = include_str!("../st/sample.st");

const NAMES: [&str; 14] = [
    "a",
    "Start",
    "_x1",
    "valve",
    "step_no",
    "S",
    "r",
    "get",
    "Set",
    "property",
    "union",
    "IN",
    "PT",
    "reference",
];
const TYPES: [&str; 6] = ["INT", "BOOL", "TIME", "ns.Motor", "LREAL", "STRING"];
const LITERALS: [&str; 22] = [
    "0",
    "16#FF_00",
    "2#1010",
    "8#17",
    "1.5",
    "1_0.5E-3",
    "TRUE",
    "false",
    "NULL",
    "INT#-5",
    "Mode#idle",
    "BOOL#1",
    "'a$'b$41$N'",
    "\"c$\"$20AC\"",
    "WSTRING#'x'",
    "T#1d2h_30m1.5s",
    "LT#-5us",
    "D#2024-02-29",
    "TOD#23:59:59.999",
    "DT#1970-01-01-00:00:00",
    "%IX1.7",
    "%MW3",
];
const OPERATORS: [&str; 18] = [
    "+", "-", "*", "/", "MOD", "**", "=", "<>", "<", "<=", ">", ">=", "AND", "&", "OR", "XOR",
    "AND_THEN", "OR_ELSE",
];
const SPACES: [&str; 6] = [" ", "\n", "  ", " (* c (* d *) *) ", " // e\n", "\t "];

/// One file with a few units.
pub fn file(rng: &mut Rng) -> String {
    let mut text = Text {
        out: String::new(),
        rng,
    };
    for _ in 0..=text.rng.below(3) {
        text.unit();
    }
    text.out
}

struct Text<'r> {
    out: String,
    rng: &'r mut Rng,
}

impl Text<'_> {
    fn put(&mut self, text: &str) {
        self.out.push_str(text);
        let space = if self.rng.one_in(8) {
            self.rng.pick(&SPACES)
        } else {
            " "
        };
        self.out.push_str(space);
    }

    fn one(&mut self, choices: &[&str]) {
        let choice = self.rng.pick(choices);
        self.put(choice);
    }

    fn name(&mut self) {
        self.one(&NAMES);
    }

    /// `separator` between up to `most` things, one at least.
    fn list(&mut self, most: usize, separator: &str, thing: impl Fn(&mut Self)) {
        thing(self);
        for _ in 0..self.rng.below(most) {
            self.put(separator);
            thing(self);
        }
    }

    /// Up to `most` things, or none.
    fn some(&mut self, most: usize, thing: impl Fn(&mut Self)) {
        for _ in 0..self.rng.below(most + 1) {
            thing(self);
        }
    }

    fn maybe(&mut self, thing: impl Fn(&mut Self)) {
        if self.rng.one_in(2) {
            thing(self);
        }
    }

    fn unit(&mut self) {
        match self.rng.below(8) {
            0 => self.types(),
            1 => self.configuration(),
            2 => {
                self.put("NAMESPACE a.b");
                self.pou();
                self.put("END_NAMESPACE");
            }
            3 => self.section("VAR_GLOBAL"),
            4 => self.put("USING a.b, c;"),
            _ => self.pou(),
        }
    }

    fn types(&mut self) {
        self.put("TYPE");
        self.some(4, |text| {
            text.name();
            text.put(":");
            text.ty(2);
            text.maybe(Self::initial);
            text.put(";");
        });
        self.put("END_TYPE");
    }

    fn initial(&mut self) {
        self.put(":=");
        self.value(2);
    }

    /// An initial value.
    fn value(&mut self, depth: usize) {
        match self.rng.below(if depth == 0 { 1 } else { 4 }) {
            0 => self.expression(2),
            1 => {
                self.put("(");
                self.list(2, ",", |text| {
                    text.name();
                    text.put(":=");
                    text.value(depth - 1);
                });
                self.put(")");
            }
            2 => {
                self.put("[");
                self.list(3, ",", |text| text.value(depth - 1));
                self.put("]");
            }
            _ => {
                self.put("[ 3(");
                self.list(2, ",", |text| text.value(depth - 1));
                self.put(")]");
            }
        }
    }

    fn ty(&mut self, depth: usize) {
        match self.rng.below(if depth == 0 { 5 } else { 9 }) {
            0 => self.put("INT (-5 .. 5)"),
            1 => self.put("STRING[20]"),
            2 => self.put("(idle, run := 3)"),
            3 => self.put("WORD (x := 1, y)"),
            4 => self.one(&TYPES),
            5 => {
                self.put("ARRAY [0..3, *] OF");
                self.ty(depth - 1);
            }
            6 => {
                self.one(&["REF_TO", "POINTER TO", "REFERENCE TO"]);
                self.ty(depth - 1);
            }
            7 => {
                self.put("STRUCT");
                self.some(3, |text| text.variable(depth - 1));
                self.put("END_STRUCT");
            }
            _ => {
                self.put("UNION a : INT;");
                self.some(2, |text| text.variable(depth - 1));
                self.put("END_UNION");
            }
        }
    }

    fn variable(&mut self, depth: usize) {
        self.list(3, ",", Self::name);
        self.maybe(|text| text.put("AT %QB7"));
        self.put(":");
        self.ty(depth);
        self.maybe(Self::initial);
        self.put(";");
    }

    fn section(&mut self, word: &str) {
        self.put(word);
        self.maybe(|text| text.one(&["CONSTANT", "RETAIN", "NON_RETAIN", "PRIVATE"]));
        self.some(4, |text| text.variable(1));
        self.put("END_VAR");
    }

    fn sections(&mut self) {
        self.some(3, |text| {
            let word = text
                .rng
                .pick(&["VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR_TEMP"]);
            text.section(word);
        });
    }

    fn pou(&mut self) {
        let (open, close) = self.rng.pick(&[
            ("FUNCTION f : INT", "END_FUNCTION"),
            ("FUNCTION g : ARRAY [0..1] OF BOOL", "END_FUNCTION"),
            (
                "FUNCTION_BLOCK FINAL b EXTENDS c IMPLEMENTS d, e.f",
                "END_FUNCTION_BLOCK",
            ),
            ("PROGRAM p", "END_PROGRAM"),
        ]);
        self.put(open);
        self.sections();
        self.some(2, Self::member);
        self.some(5, |text| text.statement(3));
        self.put(close);
    }

    fn member(&mut self) {
        if self.rng.one_in(3) {
            self.put("PROPERTY PUBLIC level : INT GET");
            self.some(2, |text| text.statement(1));
            self.put("END_GET END_PROPERTY");
        } else {
            self.put("METHOD PUBLIC OVERRIDE m : BOOL");
            self.sections();
            self.some(3, |text| text.statement(2));
            self.put("END_METHOD");
        }
    }

    fn configuration(&mut self) {
        self.put("CONFIGURATION c");
        self.maybe(|text| text.section("VAR_GLOBAL"));
        self.put("RESOURCE r ON cpu TASK t(INTERVAL := T#10ms, PRIORITY := 1);");
        self.some(2, |text| {
            text.put("PROGRAM p WITH t : a.b (x :=");
            text.expression(1);
            text.put(", y => z.w, fb WITH t);");
        });
        self.put("END_RESOURCE VAR_CONFIG r.p.x AT %IX0.0 : BOOL; END_VAR END_CONFIGURATION");
    }

    fn block(&mut self, depth: usize) {
        self.some(3, |text| text.statement(depth));
    }

    fn statement(&mut self, depth: usize) {
        match self.rng.below(if depth == 0 { 5 } else { 10 }) {
            0 => self.one(&["RETURN;", "EXIT;", "CONTINUE;", ";", "SUPER();"]),
            1 => {
                self.path(2);
                self.call(2);
                self.put(";");
            }
            2..5 => {
                self.path(2);
                self.one(&[":=", "?=", "S=", "R=", ":="]);
                self.expression(3);
                self.put(";");
            }
            5 => self.if_statement(depth - 1),
            6 => self.case_statement(depth - 1),
            7 => {
                self.put("FOR i :=");
                self.expression(1);
                self.put("TO");
                self.expression(1);
                self.maybe(|text| text.put("BY -1"));
                self.put("DO");
                self.block(depth - 1);
                self.put("END_FOR;");
            }
            8 => {
                self.put("WHILE");
                self.expression(2);
                self.put("DO");
                self.block(depth - 1);
                self.put("END_WHILE;");
            }
            _ => {
                self.put("REPEAT");
                self.block(depth - 1);
                self.put("UNTIL");
                self.expression(2);
                self.put("END_REPEAT;");
            }
        }
    }

    fn if_statement(&mut self, depth: usize) {
        self.put("IF");
        self.list(3, "ELSIF", |text| {
            text.expression(2);
            text.put("THEN");
            text.block(depth);
        });
        self.maybe(|text| {
            text.put("ELSE");
            text.block(depth);
        });
        self.put("END_IF;");
    }

    fn case_statement(&mut self, depth: usize) {
        self.put("CASE");
        self.expression(1);
        self.put("OF");
        self.some(3, |text| {
            text.list(2, ",", |text| {
                text.one(&["1", "2..5", "idle", "Mode#run", "-3"]);
            });
            text.put(":");
            text.block(depth);
        });
        self.maybe(|text| {
            text.put("ELSE");
            text.block(depth);
        });
        self.put("END_CASE;");
    }

    fn expression(&mut self, depth: usize) {
        if depth == 0 {
            return self.one(&LITERALS);
        }
        match self.rng.below(7) {
            0 => self.one(&LITERALS),
            1 => {
                self.one(&["-", "NOT", "+"]);
                self.expression(depth - 1);
            }
            2 => {
                self.put("(");
                self.expression(depth - 1);
                self.put(")");
            }
            3 | 4 => {
                self.expression(depth - 1);
                self.one(&OPERATORS);
                self.expression(depth - 1);
            }
            5 => {
                self.path(depth);
                self.maybe(|text| text.call(depth - 1));
            }
            _ => self.put("REF(a.b)"),
        }
    }

    fn path(&mut self, depth: usize) {
        self.name();
        self.some(3, |text| match text.rng.below(4) {
            0 if depth > 0 => {
                text.put("[");
                text.list(2, ",", |text| text.expression(depth - 1));
                text.put("]");
            }
            1 => text.put("^"),
            2 => text.one(&[".3", ".%X3", ".%B1"]),
            _ => {
                text.put(".");
                text.name();
            }
        });
    }

    fn call(&mut self, depth: usize) {
        self.put("(");
        self.maybe(|text| {
            text.list(3, ",", |text| match text.rng.below(4) {
                0 => text.put("NOT q => a"),
                1 => text.put("Q => b.c"),
                2 => {
                    text.put("IN :=");
                    text.expression(depth.min(2));
                }
                _ => text.expression(depth.min(2)),
            });
        });
        self.put(")");
    }
}
