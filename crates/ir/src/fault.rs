//! Language errors that end a scan.

use std::fmt;

macro_rules! faults {
    ($($variant:ident $code:literal $name:literal $meaning:literal;)*) => {
        /// Why a scan was abandoned.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum FaultCode {
            $(#[doc = $meaning] $variant = $code,)*
        }

        impl FaultCode {
            /// Every fault, in the order of the table.
            pub const ALL: &'static [FaultCode] = &[$(Self::$variant),*];

            /// The word in the text form.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// What happened, for people.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

faults! {
    Index 1 "index" "array index or bit number outside its bounds";
    Divide 2 "divide" "division by zero";
    Range 3 "range" "value outside its subrange";
    Preset 4 "preset" "timer preset or accumulator is negative";
    Reference 5 "reference" "reference is NULL";
    Call 6 "call" "too few parameters passed to or returned from a routine";
    Bound 7 "bound" "loop ran past its bound";
}

impl FaultCode {
    /// Stable number: the exit register of hardware and the return value of machine code, where 0
    /// is no fault.
    pub fn number(self) -> u8 {
        self as u8
    }

    /// The fault with this number.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|fault| fault.number() == number)
    }

    /// The fault with this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|fault| fault.name() == name)
    }
}

impl fmt::Display for FaultCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
