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
    E0010 Error "text does not follow the grammar";
    E0011 Error "block is not closed";
    E0012 Error "end of a block that is not open";
    E0013 Error "program nests too deeply";
    E0014 Error "character has no meaning here";
    E0015 Error "string is not closed";
    E0016 Error "comment or pragma is not closed";
    E0017 Error "name has letters outside ASCII";
    E0018 Error "reserved word is used as a name";
    E0019 Error "number is malformed";
    E0020 Error "number does not fit 64 bits";
    E0021 Error "duration is malformed";
    E0022 Error "date or time of day is malformed";
    E0023 Error "string cannot hold this character";
    E0024 Error "semicolon is missing";
    E0025 Error "bracket is not closed, or not open";
    E0026 Error "direct address is malformed";
    E0027 Error "declaration stands behind statements";
    E0028 Error "value is not used";
    E0029 Error "assignment to something that is no variable";
    E0030 Error "text stands outside of every unit";
    E0031 Error "THEN, DO or OF is missing";
    E0032 Error "name is missing";
    E0033 Error "declaration stands outside of a section";
    E0034 Error "underline is misplaced in a name";
    E0035 Warning "comment stands in a comment";
    E0036 Error "body is in a language that is not compiled";
    E0037 Error "keyword is misspelled";
    // 1 names
    E1001 Error "tag does not exist";
    E1002 Error "member does not exist";
    E1003 Error "name is declared twice";
    E1004 Error "alias stands for itself";
    E1005 Error "alias does not stand for a tag";
    E1007 Error "routine does not exist";
    E1008 Error "instruction does not exist";
    E1009 Error "program does not exist";
    E1010 Error "type does not exist";
    E1011 Error "section cannot stand here";
    E1012 Error "variable does not exist";
    E1013 Error "variable exists only while its block runs";
    E1014 Error "global variable is not declared in this unit";
    E1015 Error "member is private";
    E1016 Error "enumeration has no such value";
    E1017 Error "enumerator is ambiguous";
    E1018 Error "function or instance does not exist";
    E1019 Error "parameter does not exist";
    E1040 Error "class, block or interface extends itself";
    E1041 Error "unit cannot be extended or implemented like this";
    E1042 Error "namespace does not exist";
    E1043 Error "name is in several namespaces that are used";
    E1044 Error "name is internal to its namespace";
    E1045 Error "FINAL class, block or method is changed";
    E1046 Error "abstract class, block or method is used";
    E1047 Error "abstract method has no body";
    E1048 Error "words of a declaration do not go together";
    E1049 Error "name is inherited already";
    E1050 Error "OVERRIDE is missing, or overrides nothing";
    E1051 Error "method does not fit the one it stands for";
    E1052 Error "method of an interface is missing";
    E1053 Error "instance with relatives lives for one call only";
    // 2 types and constants
    E2001 Error "operand is of the wrong kind";
    E2002 Error "index is outside the array";
    E2003 Error "bit does not exist";
    E2004 Error "wrong number of indexes";
    E2005 Error "number does not fit its type";
    E2006 Error "constant is written";
    E2007 Error "tags are too large";
    E2008 Error "initial value does not fit its type";
    E2009 Error "type contains itself";
    E2010 Error "tag or member is of a type that is not compiled";
    E2020 Error "value is of the wrong type";
    E2021 Error "name is no type";
    E2022 Error "type does not fit here";
    E2023 Error "limits are the wrong way round";
    E2024 Error "string length is out of range";
    E2025 Error "bounds of an array do not go together";
    E2026 Error "value is outside its subrange";
    E2027 Error "operator does not take this type";
    E2028 Error "division by zero";
    E2029 Error "operands have no common type";
    E2030 Error "constant is needed";
    E2031 Error "value has no elements";
    E2032 Error "subscript is no integer";
    E2033 Error "value has no such bits";
    E2034 Error "value is no reference";
    E2035 Error "?= between types it is not for";
    E2036 Error "?= that always gives NULL";
    E2037 Error "something is computed with a pointer";
    // 3 statements and flow
    E3001 Error "value stands outside of a declaration";
    E3002 Error "reference to something that has none";
    E3003 Error "THIS or SUPER has no meaning here";
    E3004 Error "call without parentheses";
    E3005 Error "EXIT or CONTINUE outside of a loop";
    E3006 Error "variable cannot be changed from here";
    E3007 Error "control variable of a loop is changed";
    E3008 Error "loop counts in something that is no integer";
    E3009 Error "step of a loop is 0";
    E3010 Error "selector of CASE is of the wrong type";
    E3011 Error "label of CASE stands twice";
    E3012 Error "statement does nothing";
    E3013 Error "block is used as a value";
    E3014 Error "function gives no value";
    E3015 Error "in-out is given something that is no variable";
    E3016 Error "in-out has no argument";
    E3017 Error "arguments by name and by position are mixed";
    E3018 Error "too many arguments";
    E3019 Error "argument is given twice";
    E3020 Error "argument has the wrong direction";
    E3021 Error "function does not take these arguments";
    E3022 Error "too few arguments";
    E3023 Error "property is used against its kind";
    E3040 Error "recursion";
    E3041 Error "loop never ends";
    E3060 Error "statement of tests outside of a test";
    E3061 Error "assertion is written wrongly";
    E3062 Error "nothing there that could be mocked";
    E3050 Warning "variable is not used";
    E3051 Warning "statement is never reached";
    E3052 Warning "function does not give its result";
    E3053 Warning "CASE leaves out values of an enumeration";
    E3054 Warning "reals are compared for equality";
    E3055 Warning "instance is never called";
    E3056 Warning "variable is read before it is assigned";
    E3057 Warning "instance is copied";
    // 5 ladder and L5X
    E5001 Error "XML is malformed";
    E5002 Error "file is not an L5X export";
    E5003 Error "rung text does not follow the rung grammar";
    E5004 Error "nesting is too deep";
    E5005 Error "number does not fit 64 bits";
    E5006 Error "attribute or element is missing or malformed";
    E5007 Error "tag data is malformed";
    E5020 Error "wrong number of operands";
    E5021 Error "instruction is not compiled";
    E5022 Error "not a Logix instruction";
    E5023 Error "computed index is not compiled";
    E5024 Error "Add-On Instruction is not compiled";
    E5025 Error "language of a routine is not compiled";
    E5026 Error "routine is encrypted";
    E5027 Error "routine calls itself";
    E5028 Warning "routine is not checked";
    E5029 Error "status flag is not compiled";
    E5030 Error "call does not fit the routine";
    E5031 Error "SBR is not the first instruction";
    E5032 Warning "routine has pending edits";
    E5033 Error "form of operand is not compiled";
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
    E6020 Error "nothing to run";
    E6021 Error "more than one active task";
    E6022 Error "kind of task is not compiled";
    E6023 Warning "program is not scheduled";
    E6024 Error "tag of a module is not compiled";
    E6025 Error "configuration of a module is written";
    E6026 Error "task setting is not compiled";
    E6027 Error "kind of program is not compiled";
    E6028 Warning "program has no main routine";
    E6029 Error "parameter connection is not compiled";
    E6030 Error "timer of the time base does not exist";
    E6031 Warning "module is inhibited";
    E6050 Error "kind of a file is not known";
    E6051 Error "files do not go together";
    E6052 Error "no source file is there";
    E6053 Warning "file in a folder is left out";
    E6054 Error "folder is too deep or too large";
    E6060 Error "project file is not TOML";
    E6061 Error "key of the project file does not exist";
    E6062 Error "value in the project file is wrong";
    E6063 Error "source of the project does not exist";
    E6064 Error "name for an input or output is taken";
    E6065 Error "option means nothing for this language";
    E6090 Error "assertion failed";
    E6091 Error "test was abandoned by a fault";
    E6080 Error "file is no case of the conformance suite";
    E6081 Error "case of the conformance suite failed";
    E6040 Error "declarations of a global variable differ";
    E6041 Error "global variable does not exist";
    E6042 Error "task does not exist";
    E6043 Error "connection of the configuration does not fit";
    E6044 Error "variable has no address";
    E6045 Error "configuration is not the only one";
    // 7 target cannot express this
    E7001 Error "target cannot express a loop";
    E7002 Error "target cannot express a division";
    E7003 Error "target has no floating-point numbers";
    E7004 Error "target cannot express a variable index";
    E7005 Error "target cannot express a fault";
    E7006 Error "target has no absolute time";
    E7007 Error "program is too large for the target";
    E7008 Error "option does not fit the program, the target or the board";
    E7009 Error "simulator cannot be started";
    E7010 Error "target cannot express a reference";
    // 8 dialect policy
    E8001 Error "form belongs to another dialect";
    E8002 Error "form of CODESYS is not compiled";
    E8003 Warning "pragma means nothing here";
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
