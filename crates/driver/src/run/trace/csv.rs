//! A trace as CSV: the time, then the columns; one row for each scan, or for each that changed
//! something.

use super::Trace;
use super::shown::{Shown, shown};
use crate::run::Column;
use crate::run::time::TimeUnit;
use std::io::{self, Write};

/// Writes CSV.
pub struct CsvTrace<W: Write> {
    writer: csv::Writer<W>,
    shown: Vec<Shown>,
    unit: TimeUnit,
    changes_only: bool,
    /// The row before, and what was shown of it.
    before: Option<(Vec<u64>, Vec<String>)>,
}

impl<W: Write> CsvTrace<W> {
    /// Writes the header. With `changes_only`, rows equal to the one before are left out.
    ///
    /// # Errors
    /// The header cannot be written.
    pub fn new(out: W, columns: &[Column], unit: TimeUnit, changes_only: bool) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        let shown = shown(columns);
        let names = shown.iter().map(|shown| shown.name.as_str());
        writer.write_record([unit.column()].into_iter().chain(names))?;
        Ok(Self {
            writer,
            shown,
            unit,
            changes_only,
            before: None,
        })
    }

    /// Writes what is still kept.
    ///
    /// # Errors
    /// The last rows cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl<W: Write> Trace for CsvTrace<W> {
    fn row(&mut self, now_ns: u64, values: &[u64]) -> io::Result<()> {
        let before = self.before.as_ref();
        if before.is_some_and(|(before, _)| before == values) {
            return Ok(());
        }
        let shown = self.shown.iter().map(|shown| shown.text(values));
        let shown: Vec<String> = shown.collect();
        // Characters behind the end of a string do not show.
        if before.is_none_or(|(_, before)| *before != shown) {
            let time = now_ns / self.unit.nanoseconds();
            self.writer.write_field(time.to_string())?;
            self.writer.write_record(&shown)?;
        }
        if self.changes_only {
            self.before = Some((values.to_vec(), shown));
        }
        Ok(())
    }
}
