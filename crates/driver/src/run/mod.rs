//! Runs a program on an engine, scan by scan, with what users set and what they want to see.
//!
//! Scans happen at 0, one period, two periods and so on. A row of the stimulus takes effect at the
//! first scan at or after its time; a row of the trace holds the time of a scan and the values after
//! it. Everything but [`TraceFile`] is text or data in, data out.
//!
//! 1. [`Stimulus::parse`] reads the stimulus, [`parse_duration`] and [`Schedule`] the times.
//! 2. [`Session::prepare`] finds what is named and opens the module to it ([`instrument`]).
//! 3. The module goes through passes to an engine.
//! 4. [`Session::run`] lets the engine scan, into a [`Trace`].

mod csv_text;
mod instrument;
mod mirror;
mod names;
mod probe;
mod session;
mod stimulus;
#[cfg(test)]
mod tests;
mod texts;
mod time;
mod trace;
mod value;

pub use instrument::{Instruments, Poke, Watch, instrument};
pub use mirror::initial_inputs;
pub use probe::{Probe, Probes};
pub use session::{Column, Request, RunError, Session};
pub use stimulus::Stimulus;
pub use texts::Shape;
pub use time::{Schedule, TimeUnit, parse_duration};
pub(crate) use value::write_value;

pub use trace::{CsvTrace, LastRow, NoTrace, Trace, TraceFile, VcdTrace};
