//! The table of keys: what a project file can say. The manual lists them all.

use super::Project;
use super::read::{Reader, Value};
use crate::Rename;
use crate::choices::{DIALECTS, EDITS, FAULTS, INITS, LEVELS};
use iecc_diag::Code;
use iecc_source::Spanned;

/// Takes the value of a key.
type Read = fn(&mut Reader, &mut Project, &Value<'_>);

/// Takes the value of a key whose name users choose.
type ReadNamed = fn(&mut Reader, &mut Project, &Spanned<String>, &Value<'_>);

/// A key and what it does.
pub(super) struct Key {
    /// As written.
    pub(super) name: &'static str,
    /// Takes its value.
    pub(super) read: Read,
}

/// A table of keys.
pub(super) struct Table {
    /// As written between brackets.
    pub(super) name: &'static str,
    /// Keys that it may hold.
    pub(super) keys: &'static [Key],
    /// Takes all other keys, where there may be others.
    pub(super) others: Option<ReadNamed>,
}

const fn key(name: &'static str, read: Read) -> Key {
    Key { name, read }
}

/// What stands before the first table.
pub(super) const KEYS: &[Key] = &[
    key("name", |reader, project, value| {
        project.options.name = reader.text(value).and_then(|text| reader.identifier(&text));
    }),
    key("sources", |reader, project, value| {
        project.sources = reader.texts(value);
    }),
    key("tests", |reader, project, value| {
        project.tests = reader.texts(value).unwrap_or_default();
    }),
    key("entry", |reader, project, value| {
        project.options.entry = reader.text(value).map(|text| text.node);
    }),
    key("dialect", |reader, project, value| {
        if let Some(dialect) = reader.choice(value, DIALECTS) {
            project.options.dialect = dialect;
        }
    }),
    key("on-fault", |reader, project, value| {
        if let Some(on_fault) = reader.choice(value, FAULTS) {
            project.options.on_fault = on_fault;
        }
    }),
    key("init", |reader, project, value| {
        if let Some(init) = reader.choice(value, INITS) {
            project.options.init = init;
        }
    }),
    key("edits", |reader, project, value| {
        if let Some(edits) = reader.choice(value, EDITS) {
            project.options.edits = edits;
        }
    }),
    key("timer-base", |reader, project, value| {
        for unit in reader.texts(value).unwrap_or_default() {
            if let Err(wrong) = project.options.timer_base.set(&unit.node) {
                reader.refuse(unit.span, wrong);
            }
        }
    }),
    key("period", |reader, project, value| {
        project.period_ns = reader.duration(value);
    }),
];

/// The tables.
pub(super) const TABLES: &[Table] = &[
    Table {
        name: "warnings",
        keys: &[key("all", |reader, project, value| {
            if let Some(level) = reader.choice(value, LEVELS) {
                project.options.levels.set_others(level);
            }
        })],
        others: Some(warning),
    },
    Table {
        name: "names",
        keys: &[],
        others: Some(rename),
    },
    Table {
        name: "verilog",
        keys: &[
            key("clock-hz", |reader, project, value| {
                project.verilog.clock_hz = reader.number(value);
            }),
            key("tick", |reader, project, value| {
                project.verilog.tick_ns = reader.duration(value);
            }),
            key("board", |reader, project, value| {
                project.verilog.board = reader.text(value).map(|text| text.node);
            }),
            key("pins", |reader, project, value| {
                let path = reader.text(value);
                project.verilog.pins = path.map(|path| project.folder.join(path.node));
            }),
        ],
        others: None,
    },
];

fn rename(reader: &mut Reader, project: &mut Project, name: &Spanned<String>, point: &Value<'_>) {
    let node = reader.identifier(name);
    if let (Some(node), Some(point)) = (node, reader.text(point)) {
        let name = Spanned::new(node, name.span);
        project.options.renames.push(Rename { name, point });
    }
}

fn warning(reader: &mut Reader, project: &mut Project, name: &Spanned<String>, value: &Value<'_>) {
    let Some(code) = Code::parse(&name.node) else {
        return reader.no_code(name);
    };
    if let Some(level) = reader.choice(value, LEVELS)
        && let Err(wrong) = project.options.levels.set(code, level)
    {
        reader.refuse(name.span, wrong);
    }
}

impl Reader {
    /// A name as programs have them.
    fn identifier(&mut self, text: &Spanned<String>) -> Option<String> {
        let mut letters = text.node.chars();
        let begins = letters
            .next()
            .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
        if begins && letters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return Some(text.node.clone());
        }
        let message = format!(
            "`{}` is no name: letters, digits and `_` make one",
            text.node
        );
        self.refuse(text.span, message);
        None
    }
}
