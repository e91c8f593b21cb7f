//! A trace in a file: written under a temporary name beside its place and renamed when complete, so
//! that no reader ever sees half of one.

use super::{CsvTrace, Trace, VcdTrace};
use crate::output::{cannot_write, temporary_in};
use crate::run::Column;
use crate::run::time::Schedule;
use iecc_diag::{Code, Diagnostic};
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

type Out = BufWriter<File>;

enum Writer {
    Csv(Box<CsvTrace<Out>>),
    Vcd(VcdTrace<Out>),
}

/// A trace that becomes a file when it is finished.
pub struct TraceFile {
    writer: Writer,
    file: NamedTempFile,
    path: PathBuf,
}

impl TraceFile {
    /// Begins a trace; its format is told by the end of the name, `.csv` or `.vcd`. `program` names
    /// the outermost scope of a VCD; with `changes_only` a CSV has no rows that repeat the one
    /// before (a VCD never has).
    ///
    /// # Errors
    /// E6013 if the file cannot be created, E6015 if the name has another end.
    pub fn create(
        path: &Path,
        program: &str,
        columns: &[Column],
        schedule: Schedule,
        changes_only: bool,
    ) -> Result<Self, Diagnostic> {
        let end = path.extension().and_then(|end| end.to_str()).unwrap_or("");
        let csv = end.eq_ignore_ascii_case("csv");
        if !csv && !end.eq_ignore_ascii_case("vcd") {
            let message = format!(
                "`{}` is no trace: its name must end in .csv or .vcd",
                path.display()
            );
            return Err(Diagnostic::without_place(Code::E6015, message));
        }
        let begin = || -> io::Result<Self> {
            let file = temporary(path)?;
            let out = BufWriter::new(file.as_file().try_clone()?);
            let writer = if csv {
                Writer::Csv(Box::new(CsvTrace::new(
                    out,
                    columns,
                    schedule.unit(),
                    changes_only,
                )?))
            } else {
                Writer::Vcd(VcdTrace::new(out, program, columns, schedule)?)
            };
            let path = path.to_owned();
            Ok(Self { writer, file, path })
        };
        begin().map_err(|error| cannot_write(path, &error))
    }

    /// Completes the trace and puts it in its place.
    ///
    /// # Errors
    /// E6013 if that fails.
    pub fn finish(self) -> Result<(), Diagnostic> {
        let Self { writer, file, path } = self;
        let complete = || -> io::Result<()> {
            match writer {
                Writer::Csv(trace) => trace.finish()?,
                Writer::Vcd(trace) => trace.finish()?,
            }
            file.persist(&path)?;
            Ok(())
        };
        complete().map_err(|error| cannot_write(&path, &error))
    }
}

impl Trace for TraceFile {
    fn row(&mut self, now_ns: u64, values: &[u64]) -> io::Result<()> {
        match &mut self.writer {
            Writer::Csv(trace) => trace.row(now_ns, values),
            Writer::Vcd(trace) => trace.row(now_ns, values),
        }
    }
}

/// A new file in the folder of `path`.
fn temporary(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    temporary_in(folder.unwrap_or(Path::new(".")))
}
