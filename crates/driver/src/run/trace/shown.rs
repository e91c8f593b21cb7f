//! What people see of columns: each value by itself, but the length and the characters of a string as
//! one literal under the name of the string.

use crate::run::Column;
use crate::run::value::write_value;
use iecc_ast::st::{StringLiteral, string_text};
use iecc_ir::{Type, View};

/// One or several columns that are shown as one.
#[derive(Debug, Clone)]
pub(super) struct Shown {
    pub(super) name: String,
    ty: Type,
    view: View,
    /// The first of the columns.
    first: usize,
    /// How many columns with characters follow, and whether they are wide.
    characters: Option<(usize, bool)>,
}

/// What is shown of columns, in their order.
pub(super) fn shown(columns: &[Column]) -> Vec<Shown> {
    let mut shown = Vec::with_capacity(columns.len());
    let mut at = 0;
    while let Some(column) = columns.get(at) {
        let characters = columns[at + 1..].get(..column.characters);
        let characters = characters.and_then(|all| Some((all.len(), all.first()?.ty)));
        let whole = column
            .name
            .strip_suffix(".LEN")
            .filter(|_| characters.is_some());
        shown.push(Shown {
            name: whole.unwrap_or(&column.name).to_owned(),
            ty: column.ty,
            view: column.view,
            first: at,
            characters: characters.map(|(count, ty)| (count, ty != Type::I8)),
        });
        at += 1 + characters.map_or(0, |(count, _)| count);
    }
    shown
}

impl Shown {
    /// What it shows of a row.
    pub(super) fn text(&self, values: &[u64]) -> String {
        let bits = values[self.first];
        let Some((count, double)) = self.characters else {
            let mut text = String::new();
            write_value(&mut text, self.ty, self.view, bits);
            return text;
        };
        let most = i64::try_from(count).unwrap_or(i64::MAX);
        let length = self.ty.signed(bits).clamp(0, most) as usize;
        let units = &values[self.first + 1..][..length];
        string_text(&StringLiteral {
            double,
            units: units.iter().map(|unit| *unit as u16).collect(),
        })
    }
}
