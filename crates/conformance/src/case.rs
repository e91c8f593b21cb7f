//! Cases as they are written.

use crate::engines::Family;
use crate::features::{Edition, FeatureId, feature};
use crate::header::{Header, Key, header};
use crate::messages::{Expected, expected};
use crate::trace::Trace;
use iecc_diag::Severity;
use iecc_driver::Dialect;
use iecc_ir::FaultCode;
use std::fmt;

/// A case: what it covers, how its text is compiled, and what is expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Case {
    /// Folder and file name without the extension: `t71/multiplication_before_addition`.
    pub name: String,
    /// The whole file; the comment in front is part of the program text.
    pub text: String,
    /// Rows of the feature tables.
    pub covers: Vec<FeatureId>,
    /// The behaviour in a sentence.
    pub about: String,
    /// Whose keywords hold.
    pub dialect: Dialect,
    /// The program to run, where there are several.
    pub entry: Option<String>,
    /// Whether language errors stop the program (`trap`) or not.
    pub stops_at_faults: bool,
    /// The fault with which the last scan must end.
    pub fault: Option<FaultCode>,
    /// Engines that must run the case, if not all.
    pub only: Option<Only>,
    /// How far the last digits of REAL values may be off.
    pub ulp: u64,
    /// Messages, sorted; with errors among them there is no trace.
    pub messages: Vec<Expected>,
    /// What is set and what must hold, scan by scan.
    pub trace: Option<Trace>,
}

/// Why a case does not run everywhere.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Only {
    /// Engines that must run it.
    pub families: Vec<Family>,
    /// Why others need not.
    pub because: String,
}

/// A file that is no case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
}

/// The folder of cases about what CODESYS adds.
const EXTENSIONS: &str = "codesys";

impl CaseError {
    pub(crate) fn at(line: usize, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { line, message }
    }
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for CaseError {}

impl Case {
    /// Reads a case.
    ///
    /// # Errors
    /// What is wrong with the comment at the start, the marks of messages, or the name.
    pub fn parse(name: &str, text: &str) -> Result<Self, CaseError> {
        let header = header(text)?;
        let mut case = Self {
            name: name.to_owned(),
            text: text.to_owned(),
            covers: Vec::new(),
            about: String::new(),
            dialect: Dialect::Iec,
            entry: None,
            stops_at_faults: true,
            fault: None,
            only: None,
            ulp: 0,
            messages: expected(text)?,
            trace: None,
        };
        let mut because = None;
        for key in &header.keys {
            case.take(key, &mut because)?;
        }
        case.explain(because)?;
        case.read_trace(&header)?;
        case.check()?;
        Ok(case)
    }

    fn take(&mut self, key: &Key, because: &mut Option<String>) -> Result<(), CaseError> {
        let value = key.value.as_str();
        let unknown = |what: &str| {
            let message = format!("`{value}` is no {what}");
            Err(CaseError::at(key.line, message))
        };
        if value.is_empty() {
            let message = format!("`{}` has no value", key.name);
            return Err(CaseError::at(key.line, message));
        }
        match key.name.as_str() {
            "covers" => self.covers = covers(key)?,
            "about" => self.about = value.to_owned(),
            "edition" => match value {
                "3" => self.dialect = Dialect::Iec,
                "2" => self.dialect = Dialect::IecEdition2,
                _ => return unknown("edition: there are 2 and 3"),
            },
            "dialect" => match value {
                "codesys" => self.dialect = Dialect::Codesys,
                _ => return unknown("dialect: there is codesys"),
            },
            "entry" => self.entry = Some(value.to_owned()),
            "on_fault" => match value {
                "trap" => self.stops_at_faults = true,
                "continue" => self.stops_at_faults = false,
                _ => return unknown("policy: there are trap and continue"),
            },
            "fault" => match FaultCode::parse(value) {
                Some(code) => self.fault = Some(code),
                None => return unknown("fault"),
            },
            "only" => self.only = Some(only(key)?),
            "because" => *because = Some(value.to_owned()),
            "ulp" => match value.parse() {
                Ok(ulp) => self.ulp = ulp,
                Err(_) => return unknown("number of units in the last place"),
            },
            other => {
                let message = format!("there is no key `{other}`");
                return Err(CaseError::at(key.line, message));
            }
        }
        Ok(())
    }

    fn explain(&mut self, because: Option<String>) -> Result<(), CaseError> {
        match (&mut self.only, because) {
            (Some(only), Some(because)) => only.because = because,
            (None, None) => {}
            (Some(_), None) => return Err(CaseError::at(1, "`only` needs `because`")),
            (None, Some(_)) => return Err(CaseError::at(1, "`because` needs `only`")),
        }
        Ok(())
    }

    fn read_trace(&mut self, header: &Header) -> Result<(), CaseError> {
        if let Some(table) = &header.table {
            self.trace = Some(Trace::parse(table, header.lines)?);
        }
        Ok(())
    }

    fn check(&self) -> Result<(), CaseError> {
        let error = |message: String| Err(CaseError::at(1, message));
        if self.covers.is_empty() && self.folder() != Some(EXTENSIONS) {
            return error("`covers` is missing".to_owned());
        }
        if self.about.is_empty() {
            return error("`about` is missing".to_owned());
        }
        match (&self.trace, self.has_errors()) {
            (None, _) if self.messages.is_empty() => {
                return error("neither a trace nor a message is expected".to_owned());
            }
            (Some(_), true) => return error("what has errors cannot run".to_owned()),
            (Some(trace), false) => self.check_trace(trace)?,
            (None, _) => {}
        }
        self.check_name()
    }

    fn check_trace(&self, trace: &Trace) -> Result<(), CaseError> {
        let last = trace.rows.last().expect("at least one scan");
        match self.fault {
            None if trace.outputs.is_empty() => {
                Err(CaseError::at(trace.line, "the table checks no value"))
            }
            Some(_) if last.outputs.iter().any(Option::is_some) => {
                let message = "a scan that ends with a fault gives no values";
                Err(CaseError::at(last.line, message))
            }
            None | Some(_) => Ok(()),
        }
    }

    fn folder(&self) -> Option<&str> {
        self.name.split_once('/').map(|(folder, _)| folder)
    }

    /// What is no part of the standard proves nothing about it.
    fn check_extension(&self) -> Result<(), CaseError> {
        if self.covers.is_empty() {
            return Ok(());
        }
        let message = format!("a case in {EXTENSIONS} covers no feature of the standard");
        Err(CaseError::at(1, message))
    }

    /// A case lies with the table of a feature that it covers.
    fn check_name(&self) -> Result<(), CaseError> {
        if self.folder() == Some(EXTENSIONS) {
            return self.check_extension();
        }
        let table = self.folder().and_then(|folder| folder.strip_prefix('t'));
        let Some(table) = table.filter(|table| table.len() == 2) else {
            let message = format!("a case lies in a folder tNN, or in {EXTENSIONS}");
            return Err(CaseError::at(1, message));
        };
        let table = table.trim_start_matches('0');
        let own = |id: &FeatureId| id.edition == Edition::Three && id.table == table;
        if self.covers.iter().any(own) {
            Ok(())
        } else {
            let message = format!("the case covers no feature of table {table} of edition 3");
            Err(CaseError::at(1, message))
        }
    }

    /// Whether errors are expected, and so nothing runs.
    pub fn has_errors(&self) -> bool {
        let mut messages = self.messages.iter();
        messages.any(|message| message.severity == Severity::Error)
    }

    /// Whether engines of the family may refuse the case.
    pub fn may_be_refused_by(&self, family: Family) -> bool {
        match &self.only {
            None => family == Family::Verilog,
            Some(only) => !only.families.contains(&family),
        }
    }
}

fn covers(key: &Key) -> Result<Vec<FeatureId>, CaseError> {
    let mut ids = Vec::new();
    for text in key.value.split([',', ' ']).filter(|text| !text.is_empty()) {
        let id = FeatureId::parse(text).filter(|id| feature(id).is_some());
        let error = |what: &str| CaseError::at(key.line, format!("`{text}` {what}"));
        let id = id.ok_or_else(|| error("is no row of the feature tables"))?;
        if ids.contains(&id) {
            return Err(error("is there twice"));
        }
        ids.push(id);
    }
    Ok(ids)
}

fn only(key: &Key) -> Result<Only, CaseError> {
    let family = |name: &str| {
        Family::parse(name)
            .ok_or_else(|| CaseError::at(key.line, format!("there is no engine `{name}`")))
    };
    let families: Result<Vec<_>, _> = key.value.split_whitespace().map(family).collect();
    Ok(Only {
        families: families?,
        because: String::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "covers: ed3:71:8, ed2:55:6\nabout: it multiplies\n";
    const TABLE: &str = "trace:\n t | a | x\n 0ms | 2 | 6\n";

    fn parse(keys: &str) -> Result<Case, CaseError> {
        let text = format!("(*! {keys}*)\nPROGRAM p\nEND_PROGRAM\n");
        Case::parse("t71/product", &text)
    }

    #[test]
    fn a_case_says_what_it_covers_and_expects() {
        let keys = "edition: 2\nentry: Main\non_fault: continue\nulp: 2\nonly: interp jit\nbecause: it divides\n";
        let case = parse(&format!("{HEAD}{keys}{TABLE}")).unwrap();
        let covers: Vec<String> = case.covers.iter().map(ToString::to_string).collect();
        assert_eq!(covers, ["ed3:71:8", "ed2:55:6"]);
        assert_eq!(case.about, "it multiplies");
        assert_eq!(case.dialect, Dialect::IecEdition2);
        assert_eq!(case.entry.as_deref(), Some("Main"));
        assert!(!case.stops_at_faults && !case.has_errors());
        assert_eq!(case.ulp, 2);
        assert!(case.may_be_refused_by(Family::Verilog));
        assert!(!case.may_be_refused_by(Family::Jit));
        assert_eq!(case.trace.unwrap().rows.len(), 1);
    }

    #[test]
    fn errors_stand_where_they_are_expected() {
        let text = format!("(*! {HEAD}*)\nPROGRAM p (*~ E0010 *)\n");
        let case = Case::parse("t71/wrong", &text).unwrap();
        assert!(case.has_errors() && case.trace.is_none());
        assert_eq!(case.messages[0].line, 4);
    }

    #[test]
    fn what_is_no_case_is_refused() {
        for (keys, words) in [
            (format!("about: x\n{TABLE}"), "`covers` is missing"),
            (format!("covers: ed3:71:8\n{TABLE}"), "`about` is missing"),
            (HEAD.to_owned(), "neither a trace nor a message"),
            (format!("covers: ed3:71:99\nabout: x\n{TABLE}"), "no row"),
            (
                format!("covers: ed3:72:4\nabout: x\n{TABLE}"),
                "of table 71",
            ),
            (format!("{HEAD}colour: red\n{TABLE}"), "no key `colour`"),
            (format!("{HEAD}edition: 4\n{TABLE}"), "no edition"),
            (format!("{HEAD}fault: none\n{TABLE}"), "no fault"),
            (format!("{HEAD}fault: divide\n{TABLE}"), "gives no values"),
            (format!("{HEAD}only: jit\n{TABLE}"), "needs `because`"),
            (
                format!("{HEAD}only: gpu\nbecause: x\n{TABLE}"),
                "no engine `gpu`",
            ),
            (
                format!("{HEAD}trace:\nt | a |\n0ms | 1 |\n"),
                "checks no value",
            ),
        ] {
            let error = parse(&keys).unwrap_err();
            assert!(error.message.contains(words), "{keys}: {error}");
        }
        let text = format!("(*! {HEAD}{TABLE}*)\n");
        for name in ["product", "t7/product", "x71/product", "codesys/product"] {
            assert!(Case::parse(name, &text).is_err(), "{name}");
        }
        let text = format!("(*! about: it sets\n{TABLE}*)\n");
        assert!(Case::parse("codesys/set", &text).is_ok());
        assert!(Case::parse("t71/set", &text).is_err());
        let text = format!("(*! {HEAD}{TABLE}*)\nPROGRAM p (*~ E0010 *)\n");
        let error = Case::parse("t71/product", &text).unwrap_err();
        assert!(error.message.contains("cannot run"), "{error}");
    }
}
