//! The choices of options by name, for the command line and the project file alike.

use crate::Level;
use iecc_grammar::st::Dialect;
use iecc_lower::OnFault;
use iecc_sema::logix::{Edits, Init};

/// A value of an option.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice<T: 'static> {
    /// How it is written.
    pub name: &'static str,
    /// What it means.
    pub help: &'static str,
    /// What it stands for.
    pub value: T,
}

const fn choice<T>(name: &'static str, help: &'static str, value: T) -> Choice<T> {
    Choice { name, help, value }
}

/// Whose Structured Text it is.
pub const DIALECTS: &[Choice<Dialect>] = &[
    choice("iec", "IEC 61131-3, edition 3", Dialect::Iec),
    choice("iec2", "IEC 61131-3, edition 2", Dialect::IecEdition2),
    choice("codesys", "CODESYS and TwinCAT", Dialect::Codesys),
];

/// What tags hold at the start.
pub const INITS: &[Choice<Init>] = &[
    choice(
        "cold",
        "Zero, but presets and constants as exported",
        Init::Cold,
    ),
    choice("export", "Every value as exported", Init::Export),
];

/// Which side of pending edits runs.
pub const EDITS: &[Choice<Edits>] = &[
    choice(
        "as-exported",
        "The side that ran at export",
        Edits::AsExported,
    ),
    choice("orig", "The rungs before the edits", Edits::Original),
    choice("test", "The edited rungs", Edits::Test),
];

/// What errors of the running program do.
pub const FAULTS: &[Choice<OnFault>] = &[
    choice("trap", "Abandon the scan", OnFault::Trap),
    choice(
        "continue",
        "Go on with a value that is written down, and remember it",
        OnFault::Continue,
    ),
];

/// What becomes of warnings.
pub const LEVELS: &[Choice<Level>] = &[
    choice("error", "An error", Level::Error),
    choice("warn", "A warning", Level::Warn),
    choice("allow", "Not shown", Level::Allow),
];

/// The value of a name, ignoring case.
pub fn find<T: Copy>(choices: &[Choice<T>], name: &str) -> Option<T> {
    let found = choices
        .iter()
        .find(|choice| choice.name.eq_ignore_ascii_case(name));
    found.map(|choice| choice.value)
}
