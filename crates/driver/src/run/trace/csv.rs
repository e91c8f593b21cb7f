//! A trace as CSV: the time, then the columns; one row for each scan, or for each that changed
//! something.

use super::Trace;
use crate::run::Column;
use crate::run::time::TimeUnit;
use crate::run::value::write_value;
use iecc_ir::{Type, View};
use std::io::{self, Write};

/// Writes CSV.
pub struct CsvTrace<W: Write> {
    writer: csv::Writer<W>,
    types: Vec<(Type, View)>,
    unit: TimeUnit,
    changes_only: bool,
    /// The row before.
    before: Option<Vec<u64>>,
    text: String,
}

impl<W: Write> CsvTrace<W> {
    /// Writes the header. With `changes_only`, rows equal to the one before are left out.
    ///
    /// # Errors
    /// The header cannot be written.
    pub fn new(out: W, columns: &[Column], unit: TimeUnit, changes_only: bool) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        let names = columns.iter().map(|column| column.name.as_str());
        writer.write_record([unit.column()].into_iter().chain(names))?;
        Ok(Self {
            writer,
            types: columns.iter().map(|c| (c.ty, c.view)).collect(),
            unit,
            changes_only,
            before: None,
            text: String::new(),
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
        if self.changes_only && self.before.as_deref() == Some(values) {
            return Ok(());
        }
        self.text.clear();
        let time = now_ns / self.unit.nanoseconds();
        write_value(&mut self.text, Type::I64, View::Plain, time);
        self.writer.write_field(&self.text)?;
        for (&(ty, view), &bits) in self.types.iter().zip(values) {
            self.text.clear();
            write_value(&mut self.text, ty, view, bits);
            self.writer.write_field(&self.text)?;
        }
        self.writer.write_record(None::<&[u8]>)?;
        if self.changes_only {
            self.before = Some(values.to_vec());
        }
        Ok(())
    }
}
