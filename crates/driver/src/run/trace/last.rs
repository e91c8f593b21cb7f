//! What the columns held after the last scan, for who only wants to see how a run ended.

use super::Trace;
use crate::run::Column;
use crate::run::value::write_value;
use std::io;

/// Keeps the last row.
#[derive(Debug, Clone, Default)]
pub struct LastRow {
    values: Option<Vec<u64>>,
}

impl LastRow {
    /// A line `name = value` for each column; nothing before the first scan.
    pub fn text(&self, columns: &[Column]) -> String {
        let width = columns.iter().map(|column| column.name.chars().count());
        let width = width.max().unwrap_or(0);
        let mut text = String::new();
        for (column, &bits) in columns.iter().zip(self.values.iter().flatten()) {
            text.push_str(&format!("{:width$} = ", column.name));
            write_value(&mut text, column.ty, column.view, bits);
            text.push('\n');
        }
        text
    }
}

impl Trace for LastRow {
    fn row(&mut self, _now_ns: u64, values: &[u64]) -> io::Result<()> {
        match &mut self.values {
            Some(kept) => kept.copy_from_slice(values),
            None => self.values = Some(values.to_vec()),
        }
        Ok(())
    }
}
