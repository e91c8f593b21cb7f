//! The one table of codes.
//!
//! Groups by thousands: 0 text and syntax, 1 names, 2 types and constants, 3 statements and flow,
//! 4 IL, 5 ladder and L5X, 6 configuration, tasks and addresses, 7 target cannot express this,
//! 8 dialect policy, 9 internal. A row needs `explain/<code>.md` (the build fails without it) and
//! an example under `tests/codes/` that gives the code.

use std::fmt;

/// How bad a diagnostic is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing; the program is compiled as written.
    Warning,
    /// Nothing is built.
    Error,
}

impl Severity {
    /// The word used in rendered messages.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

macro_rules! codes {
    ($($code:ident $severity:ident $title:literal;)*) => {
        /// A stable code. Codes are never reused for another meaning.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code {
            $(#[doc = $title] $code,)*
        }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &'static [Code] = &[$(Code::$code),*];

            /// The code as printed, for example `E5001`.
            pub fn as_str(self) -> &'static str {
                match self { $(Self::$code => stringify!($code),)* }
            }

            /// The severity a diagnostic with this code has unless a switch changes it.
            pub fn severity(self) -> Severity {
                match self { $(Self::$code => Severity::$severity,)* }
            }

            /// One line that says what the code is about.
            pub fn title(self) -> &'static str {
                match self { $(Self::$code => $title,)* }
            }

            /// The page that `iecc explain` prints, in Markdown.
            pub fn explanation(self) -> &'static str {
                match self {
                    $(Self::$code => include_str!(concat!("../explain/", stringify!($code), ".md")),)*
                }
            }
        }
    };
}

codes! {
    // 0 text and syntax
    E0001 Error "file cannot be read";
    E0002 Error "file is not UTF-8 text";
    E0003 Error "file is too large";
    // 5 ladder and L5X
    E5001 Error "XML is malformed";
    E5002 Error "file is not an L5X export";
    E5003 Error "rung text does not follow the rung grammar";
    E5004 Error "nesting is too deep";
    E5005 Error "number does not fit 64 bits";
    E5006 Error "attribute or element is missing or malformed";
    E5007 Error "tag data is malformed";
    // 6 configuration, tasks and addresses
    E6001 Error "duration is malformed";
    E6002 Error "period or length of the run is out of range";
    E6003 Error "stimulus has no header with a time column";
    E6004 Error "stimulus row has the wrong number of cells";
    E6005 Error "stimulus time is malformed";
    E6006 Error "stimulus times do not ascend";
    E6007 Error "value is malformed";
    E6008 Error "value does not fit the type";
    E6009 Error "no tag or point has this name";
    E6010 Error "path does not fit the type of the tag";
    E6011 Error "stimulus column is given twice";
    E6012 Error "stimulus cannot set this";
    E6013 Error "file cannot be written";
    E6014 Error "scan was abandoned by a fault";
    E6015 Error "format of the trace is unknown";
}

impl Code {
    /// The code with this name, ignoring case.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|code| code.as_str().eq_ignore_ascii_case(name))
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}
