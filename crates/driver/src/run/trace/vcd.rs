//! A trace as a value change dump (IEEE 1364-2005, 18.2), for waveform viewers. Dotted names become
//! nested scopes, numbers of bits and elements stand in parentheses.

use super::Trace;
use crate::run::Column;
use crate::run::time::{Schedule, TimeUnit};
use iecc_ir::Type;
use std::io::{self, Write};
use vcd::{IdCode, ScopeType, TimescaleUnit, Value, VarType};

/// Writes a value change dump.
pub struct VcdTrace<W: Write> {
    writer: vcd::Writer<W>,
    columns: Vec<(IdCode, Type)>,
    unit: TimeUnit,
    period_ns: u64,
    before: Vec<u64>,
    last_ns: Option<u64>,
}

/// A part of the tree of names, in the order in which names first appear.
#[derive(Debug, Default)]
struct Scope {
    variables: Vec<(String, usize)>,
    scopes: Vec<(String, Scope)>,
}

impl Scope {
    fn add(&mut self, name: &str, column: usize) {
        let mut parts = parts(name);
        let variable = parts.pop().unwrap_or_default();
        let mut scope = self;
        for part in parts {
            let known = scope.scopes.iter().position(|(name, _)| *name == part);
            let index = known.unwrap_or_else(|| {
                scope.scopes.push((part, Scope::default()));
                scope.scopes.len() - 1
            });
            scope = &mut scope.scopes[index].1;
        }
        scope.variables.push((variable, column));
    }
}

/// The identifiers of a dotted name. The number of a bit is no identifier: it joins the part before.
fn parts(name: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for part in name.split('.') {
        let is_bit = !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
        match parts.last_mut().filter(|_| is_bit) {
            Some(word) => word.push_str(&format!("({part})")),
            None => parts.push(identifier(part)),
        }
    }
    parts
}

/// Identifiers end at blanks; brackets would be read as a range of bits.
fn identifier(part: &str) -> String {
    let safe = part.chars().map(|c| match c {
        '[' => '(',
        ']' => ')',
        c if c.is_whitespace() || c.is_control() || c == '$' => '_',
        c => c,
    });
    let safe: String = safe.collect();
    if safe.is_empty() {
        "_".to_owned()
    } else {
        safe
    }
}

impl<W: Write> VcdTrace<W> {
    /// Writes the header: one scope named after the program with all columns.
    ///
    /// # Errors
    /// The header cannot be written.
    pub fn new(out: W, name: &str, columns: &[Column], schedule: Schedule) -> io::Result<Self> {
        let unit = schedule.unit();
        let mut trace = Self {
            writer: vcd::Writer::new(out),
            columns: vec![(IdCode::FIRST, Type::I1); columns.len()],
            unit,
            period_ns: schedule.period_ns(),
            before: Vec::new(),
            last_ns: None,
        };
        let timescale = match unit {
            TimeUnit::Milliseconds => TimescaleUnit::MS,
            TimeUnit::Microseconds => TimescaleUnit::US,
            TimeUnit::Nanoseconds => TimescaleUnit::NS,
        };
        trace.writer.timescale(1, timescale)?;
        let mut root = Scope::default();
        for (index, column) in columns.iter().enumerate() {
            root.add(&column.name, index);
        }
        trace.declare(&identifier(name), &root, columns)?;
        trace.writer.enddefinitions()?;
        Ok(trace)
    }

    /// Declares a scope with a stack of our own: names may have any number of parts.
    fn declare(&mut self, name: &str, root: &Scope, columns: &[Column]) -> io::Result<()> {
        self.open(name, root, columns)?;
        let mut path = vec![root.scopes.iter()];
        while let Some(rest) = path.last_mut() {
            match rest.next() {
                Some((name, scope)) => {
                    self.open(name, scope, columns)?;
                    path.push(scope.scopes.iter());
                }
                None => {
                    self.writer.upscope()?;
                    path.pop();
                }
            }
        }
        Ok(())
    }

    fn open(&mut self, name: &str, scope: &Scope, columns: &[Column]) -> io::Result<()> {
        self.writer.scope_def(ScopeType::Module, name)?;
        for (name, index) in &scope.variables {
            let ty = columns[*index].ty;
            let id = if ty.is_float() {
                self.writer.add_var(VarType::Real, ty.bits(), name, None)?
            } else {
                self.writer.add_wire(ty.bits(), name)?
            };
            self.columns[*index] = (id, ty);
        }
        Ok(())
    }

    fn change(&mut self, column: usize, bits: u64) -> io::Result<()> {
        let (id, ty) = self.columns[column];
        match ty {
            Type::I1 => self.writer.change_scalar(id, bits != 0),
            Type::F32 => self
                .writer
                .change_real(id, f64::from(f32::from_bits(bits as u32))),
            Type::F64 => self.writer.change_real(id, f64::from_bits(bits)),
            Type::I8 | Type::I16 | Type::I32 | Type::I64 => {
                let digits = (0..ty.bits())
                    .rev()
                    .map(|bit| Value::from(bits >> bit & 1 != 0));
                self.writer.change_vector(id, digits)
            }
        }
    }

    /// Marks the end of the last scan's period and writes what is still kept.
    ///
    /// # Errors
    /// The end cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        if let Some(last_ns) = self.last_ns {
            let end_ns = last_ns.saturating_add(self.period_ns);
            self.writer.timestamp(end_ns / self.unit.nanoseconds())?;
        }
        self.writer.flush()
    }
}

impl<W: Write> Trace for VcdTrace<W> {
    fn row(&mut self, now_ns: u64, values: &[u64]) -> io::Result<()> {
        let first = self.last_ns.is_none();
        self.last_ns = Some(now_ns);
        if !first && self.before == values {
            return Ok(());
        }
        self.writer.timestamp(now_ns / self.unit.nanoseconds())?;
        for (column, &bits) in values.iter().enumerate() {
            if first || self.before[column] != bits {
                self.change(column, bits)?;
            }
        }
        self.before.clear();
        self.before.extend_from_slice(values);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn names_are_cut_into_identifiers() {
        assert_eq!(parts("Lamp"), ["Lamp"]);
        assert_eq!(parts("t.ACC"), ["t", "ACC"]);
        assert_eq!(parts("Local:2:I.Data.8"), ["Local:2:I", "Data(8)"]);
        assert_eq!(parts("grid[1][2].0"), ["grid(1)(2)(0)"]);
        assert_eq!(parts("two words.$x"), ["two_words", "_x"]);
        assert_eq!(parts(""), ["_"]);
        assert_eq!(parts("8"), ["8"]);
    }
}
