//! How serious warnings are taken: as the table of codes says, as errors, or not at all.

use iecc_diag::{Code, Diagnostics, Severity};
use std::collections::BTreeMap;

/// What becomes of a warning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// It is not shown.
    Allow,
    /// It is shown.
    Warn,
    /// It is an error.
    Error,
}

/// What becomes of warnings. Errors stay errors.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Levels {
    /// Of all that are not listed.
    others: Level,
    listed: BTreeMap<Code, Level>,
}

impl Default for Levels {
    fn default() -> Self {
        Self {
            others: Level::Warn,
            listed: BTreeMap::new(),
        }
    }
}

impl Levels {
    /// Sets the level of all codes that are not set on their own.
    pub fn set_others(&mut self, level: Level) {
        self.others = level;
    }

    /// Sets the level of a code. The last setting counts.
    ///
    /// # Errors
    /// The code is an error, which no level changes; says so.
    pub fn set(&mut self, code: Code, level: Level) -> Result<(), String> {
        if code.severity() == Severity::Error && level != Level::Error {
            return Err(format!("{code} is an error, which cannot be turned off"));
        }
        self.listed.insert(code, level);
        Ok(())
    }

    /// The level of a warning.
    fn of(&self, code: Code) -> Level {
        self.listed.get(&code).copied().unwrap_or(self.others)
    }

    /// Raises or removes warnings.
    pub fn apply(&self, diagnostics: &mut Diagnostics) {
        diagnostics.retain(|diagnostic| {
            if diagnostic.severity != Severity::Warning {
                return true;
            }
            let level = self.of(diagnostic.code);
            if level == Level::Error {
                diagnostic.severity = Severity::Error;
                diagnostic
                    .notes
                    .push("a warning that was made an error by an option".to_owned());
            }
            level != Level::Allow
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use iecc_diag::Diagnostic;

    fn found() -> Diagnostics {
        let mut found = Diagnostics::new();
        for code in [Code::E6023, Code::E6028, Code::E6020] {
            found.push(Diagnostic::without_place(code, ""));
        }
        found
    }

    fn shown(levels: &Levels) -> Vec<(Code, Severity)> {
        let mut found = found();
        levels.apply(&mut found);
        found.iter().map(|d| (d.code, d.severity)).collect()
    }

    #[test]
    fn warnings_are_raised_and_removed_one_by_one_or_together() {
        use Severity::{Error, Warning};
        let mut levels = Levels::default();
        let usual = [
            (Code::E6023, Warning),
            (Code::E6028, Warning),
            (Code::E6020, Error),
        ];
        assert_eq!(shown(&levels), usual);
        levels.set_others(Level::Error);
        levels.set(Code::E6028, Level::Allow).unwrap();
        assert_eq!(shown(&levels), [(Code::E6023, Error), (Code::E6020, Error)]);
        levels.set_others(Level::Allow);
        levels.set(Code::E6028, Level::Warn).unwrap();
        assert_eq!(
            shown(&levels),
            [(Code::E6028, Warning), (Code::E6020, Error)]
        );
    }

    #[test]
    fn errors_cannot_be_turned_off() {
        let refused = Levels::default().set(Code::E6020, Level::Allow);
        assert_eq!(
            refused.unwrap_err(),
            "E6020 is an error, which cannot be turned off"
        );
    }
}
