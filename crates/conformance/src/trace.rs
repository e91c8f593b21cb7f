//! The table of a case: scans with what is set before them and what must hold after them.
//!
//! `t | inputs | values`, then a line for each scan. Cells are separated by white space; those in
//! quotes may hold blanks; `-` leaves an input as it is, or does not look at a value.

use crate::case::CaseError;
use crate::header::TableLine;
use iecc_driver::run::parse_duration;

/// What stands in a cell that says nothing.
const NOTHING: &str = "-";

/// Scans in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trace {
    /// Paths that are set.
    pub inputs: Vec<String>,
    /// Paths that are looked at.
    pub outputs: Vec<String>,
    /// The line of the paths.
    pub line: usize,
    /// The scans; at least one.
    pub rows: Vec<Row>,
}

/// A scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Its line in the case.
    pub line: usize,
    /// Its time.
    pub now_ns: u64,
    /// What each input is set to.
    pub inputs: Vec<Option<String>>,
    /// What each value must be.
    pub outputs: Vec<Option<String>>,
}

impl Trace {
    /// Reads the lines of a table.
    pub(crate) fn parse(lines: &[TableLine], at: usize) -> Result<Self, CaseError> {
        let Some((head, rows)) = lines.split_first() else {
            return Err(CaseError::at(at, "the trace has no table"));
        };
        let [time, inputs, outputs] = split(head)?;
        if time != ["t"] {
            return Err(CaseError::at(head.line, "a table begins with `t |`"));
        }
        let mut trace = Self {
            inputs,
            outputs,
            line: head.line,
            rows: Vec::with_capacity(rows.len()),
        };
        for line in rows {
            let row = trace.row(line)?;
            trace.rows.push(row);
        }
        trace.check()?;
        Ok(trace)
    }

    fn row(&self, line: &TableLine) -> Result<Row, CaseError> {
        let error = |message: String| CaseError::at(line.line, message);
        let [time, inputs, outputs] = split(line)?;
        let [time] = &time[..] else {
            return Err(error("a scan has one time, such as `10ms`".to_owned()));
        };
        let now_ns = parse_duration(time).map_err(|diagnostic| error(diagnostic.message))?;
        for (what, found, expected) in [
            ("inputs", inputs.len(), self.inputs.len()),
            ("values", outputs.len(), self.outputs.len()),
        ] {
            if found != expected {
                return Err(error(format!(
                    "{found} {what}, but the table has {expected}"
                )));
            }
        }
        if self
            .rows
            .last()
            .is_some_and(|before| now_ns < before.now_ns)
        {
            return Err(error("the scan is before the one above".to_owned()));
        }
        let cell = |text: String| (text != NOTHING).then_some(text);
        Ok(Row {
            line: line.line,
            now_ns,
            inputs: inputs.into_iter().map(cell).collect(),
            outputs: outputs.into_iter().map(cell).collect(),
        })
    }

    /// A table that checks nothing, or not all it names, is a mistake.
    fn check(&self) -> Result<(), CaseError> {
        let error = |message: String| Err(CaseError::at(self.line, message));
        if self.rows.is_empty() {
            return error("the table has no scans".to_owned());
        }
        for (column, path) in self.inputs.iter().enumerate() {
            if self.rows.iter().all(|row| row.inputs[column].is_none()) {
                return error(format!("`{path}` is never set"));
            }
        }
        for (column, path) in self.outputs.iter().enumerate() {
            if self.rows.iter().all(|row| row.outputs[column].is_none()) {
                return error(format!("`{path}` is never looked at"));
            }
        }
        Ok(())
    }

    /// The period, if scans are at 0, one period, two periods and so on.
    pub(crate) fn period_ns(&self) -> Option<u64> {
        let period_ns = self.rows.get(1).map_or(1_000_000, |row| row.now_ns);
        let regular = (0..)
            .zip(&self.rows)
            .all(|(scan, row)| period_ns.checked_mul(scan) == Some(row.now_ns));
        (regular && period_ns > 0).then_some(period_ns)
    }

    /// The longest time from one scan to the next.
    pub(crate) fn longest_gap_ns(&self) -> u64 {
        let times = self.rows.iter().map(|row| row.now_ns);
        let gaps = times.clone().zip(std::iter::once(0).chain(times));
        gaps.map(|(now, before)| now - before).max().unwrap_or(0)
    }
}

/// The cells of the three parts of a line.
fn split(line: &TableLine) -> Result<[Vec<String>; 3], CaseError> {
    let mut parts = vec![Vec::new()];
    for token in tokens(line)? {
        if token == "|" {
            parts.push(Vec::new());
        } else {
            parts.last_mut().expect("never empty").push(token);
        }
    }
    parts.try_into().map_err(|_| {
        CaseError::at(
            line.line,
            "a line of the table has three parts: `t | inputs | values`",
        )
    })
}

/// Words and bars. In a word quotes hold blanks and bars; `$` before a quote makes it a character.
fn tokens(line: &TableLine) -> Result<Vec<String>, CaseError> {
    let mut tokens = Vec::new();
    let mut word = String::new();
    let mut quote = None;
    let mut characters = line.text.chars();
    while let Some(c) = characters.next() {
        if quote.is_some() {
            word.push(c);
            if c == '$' {
                word.extend(characters.next());
            } else if quote == Some(c) {
                quote = None;
            }
        } else if c == '|' || c.is_whitespace() {
            tokens.extend((!word.is_empty()).then(|| std::mem::take(&mut word)));
            tokens.extend((c == '|').then(|| c.to_string()));
        } else {
            quote = matches!(c, '\'' | '"').then_some(c);
            word.push(c);
        }
    }
    if quote.is_some() {
        return Err(CaseError::at(
            line.line,
            "a string of the table is not closed",
        ));
    }
    tokens.extend((!word.is_empty()).then_some(word));
    Ok(tokens)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    fn parse(lines: &[&str]) -> Result<Trace, CaseError> {
        let lines: Vec<TableLine> = (10..)
            .zip(lines)
            .map(|(line, text)| TableLine {
                text: (*text).to_owned(),
                line,
            })
            .collect();
        Trace::parse(&lines, 9)
    }

    fn cells(cells: &[&str]) -> Vec<Option<String>> {
        let cell = |text: &&str| (*text != "-").then(|| (*text).to_owned());
        cells.iter().map(cell).collect()
    }

    #[test]
    fn a_table_has_times_inputs_and_values() {
        let trace = parse(&[
            "t    | a s       | x y",
            "0ms  | 1 'a | b' | 3 TRUE",
            "10ms | - 'c$' '  | - T#20ms",
        ])
        .unwrap();
        assert_eq!(trace.inputs, ["a", "s"]);
        assert_eq!(trace.outputs, ["x", "y"]);
        assert_eq!(trace.rows[0].now_ns, 0);
        assert_eq!(trace.rows[0].inputs, cells(&["1", "'a | b'"]));
        assert_eq!(trace.rows[1].line, 12);
        assert_eq!(trace.rows[1].now_ns, 10 * MS);
        assert_eq!(trace.rows[1].inputs, cells(&["-", "'c$' '"]));
        assert_eq!(trace.rows[1].outputs, cells(&["-", "T#20ms"]));
    }

    #[test]
    fn a_table_may_have_no_inputs_or_no_values() {
        let trace = parse(&["t | | x", "0ms | | 1"]).unwrap();
        assert!(trace.inputs.is_empty() && trace.rows[0].inputs.is_empty());
        let trace = parse(&["t | a |", "0ms | 1 |"]).unwrap();
        assert!(trace.outputs.is_empty());
    }

    #[test]
    fn regular_scans_have_a_period() {
        for (times, period, gap) in [
            (&["0ms", "10ms", "20ms"][..], Some(10), 10),
            (&["0ms"], Some(1), 0),
            (&["10ms", "20ms"], None, 10),
            (&["0ms", "10ms", "25ms"], None, 15),
            (&["0ms", "0ms"], None, 0),
        ] {
            let lines: Vec<String> = times.iter().map(|t| format!("{t} | | 1")).collect();
            let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
            let trace = parse(&[&["t | | x"], &lines[..]].concat()).unwrap();
            assert_eq!(trace.period_ns(), period.map(|ms| ms * MS), "{times:?}");
            assert_eq!(trace.longest_gap_ns(), gap * MS, "{times:?}");
        }
    }

    #[test]
    fn what_is_no_table_is_refused_with_its_line() {
        for (lines, line) in [
            (&[][..], 9),
            (&["t | | x"], 10),
            (&["x | | x", "0ms | | 1"], 10),
            (&["t | x", "0ms | 1"], 10),
            (&["t | | x", "0ms | | 1 2"], 11),
            (&["t | a | x", "0ms | | 1"], 11),
            (&["t | | x", "0 | | 1"], 11),
            (&["t | | x", "5ms | | 1", "4ms | | 1"], 12),
            (&["t | | x", "0ms | | 'a"], 11),
            (&["t | | x y", "0ms | | 1 -"], 10),
            (&["t | a | x", "0ms | - | 1"], 10),
        ] {
            assert_eq!(parse(lines).unwrap_err().line, line, "{lines:?}");
        }
    }
}
