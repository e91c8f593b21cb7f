//! Traces: what the columns held after each scan, as CSV or VCD.

mod csv;
mod file;
mod last;
mod shown;
mod vcd;

pub use csv::CsvTrace;
pub use file::TraceFile;
pub use last::LastRow;
pub use vcd::VcdTrace;

use std::io;

/// Takes the rows of a run.
pub trait Trace {
    /// The bits of every column after the scan at `now_ns`.
    ///
    /// # Errors
    /// The row cannot be written.
    fn row(&mut self, now_ns: u64, values: &[u64]) -> io::Result<()>;
}

/// Drops everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoTrace;

impl Trace for NoTrace {
    fn row(&mut self, _now_ns: u64, _values: &[u64]) -> io::Result<()> {
        Ok(())
    }
}
