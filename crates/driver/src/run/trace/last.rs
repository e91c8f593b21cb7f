//! What the columns held after the last scan, for who only wants to see how a run ended.

use super::Trace;
use super::shown::shown;
use crate::run::Column;
use std::io;

/// Keeps the last row.
#[derive(Debug, Clone, Default)]
pub struct LastRow {
    values: Option<Vec<u64>>,
}

impl LastRow {
    /// A line `name = value` for each column; nothing before the first scan.
    pub fn text(&self, columns: &[Column]) -> String {
        let Some(values) = &self.values else {
            return String::new();
        };
        let all = shown(columns);
        let width = all.iter().map(|shown| shown.name.chars().count());
        let width = width.max().unwrap_or(0);
        let mut text = String::new();
        for shown in &all {
            text.push_str(&format!("{:width$} = {}\n", shown.name, shown.text(values)));
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
