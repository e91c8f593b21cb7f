//! The types of a random program: the elementary ones, strings, and those the program declares.

use crate::rng::Rng;

/// What operations a type has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Bool,
    Signed,
    Unsigned,
    Bits,
    Real,
    Duration,
    Date,
    Clock,
    Moment,
    Character,
}

// The times of edition 3 count as one bit longer than those they hold.
macro_rules! elementary {
    ($($name:ident $kind:ident $bits:literal $word:literal;)*) => {
        /// An elementary type.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub(super) enum Elementary { $($name),* }

        impl Elementary {
            pub(super) const ALL: &'static [Self] = &[$(Self::$name),*];

            pub(super) fn kind(self) -> Kind {
                match self { $(Self::$name => Kind::$kind,)* }
            }

            pub(super) fn bits(self) -> u32 {
                match self { $(Self::$name => $bits,)* }
            }

            pub(super) fn word(self) -> &'static str {
                match self { $(Self::$name => $word,)* }
            }
        }
    };
}

elementary! {
    Bool Bool 1 "BOOL";
    Sint Signed 8 "SINT";
    Int Signed 16 "INT";
    Dint Signed 32 "DINT";
    Lint Signed 64 "LINT";
    Usint Unsigned 8 "USINT";
    Uint Unsigned 16 "UINT";
    Udint Unsigned 32 "UDINT";
    Ulint Unsigned 64 "ULINT";
    Byte Bits 8 "BYTE";
    Word Bits 16 "WORD";
    Dword Bits 32 "DWORD";
    Lword Bits 64 "LWORD";
    Real Real 32 "REAL";
    Lreal Real 64 "LREAL";
    Time Duration 64 "TIME";
    Ltime Duration 65 "LTIME";
    Date Date 64 "DATE";
    Ldate Date 65 "LDATE";
    Tod Clock 64 "TOD";
    Ltod Clock 65 "LTOD";
    Dt Moment 64 "DT";
    Ldt Moment 65 "LDT";
    Char Character 8 "CHAR";
    Wchar Character 16 "WCHAR";
}

impl Elementary {
    pub(super) fn is_integer(self) -> bool {
        matches!(self.kind(), Kind::Signed | Kind::Unsigned)
    }

    pub(super) fn is_real(self) -> bool {
        self.kind() == Kind::Real
    }

    /// Whether it belongs to the times of 64 bits that edition 3 added.
    pub(super) fn is_long(self) -> bool {
        self.bits() == 65
    }

    /// Whether a value becomes one of another type without being told to.
    pub(super) fn widens_to(self, to: Self) -> bool {
        use Kind::{Bits, Bool, Character, Clock, Date, Duration, Moment, Real, Signed, Unsigned};
        let (from_bits, to_bits) = (self.bits(), to.bits());
        match (self.kind(), to.kind()) {
            (Signed, Signed)
            | (Unsigned, Unsigned | Signed)
            | (Bits | Bool, Bits)
            | (Duration, Duration)
            | (Date, Date)
            | (Clock, Clock)
            | (Moment, Moment) => from_bits < to_bits,
            (Real, Real) => from_bits < to_bits,
            (Signed | Unsigned, Real) => from_bits < to_bits,
            (
                Bool | Signed | Unsigned | Bits | Real | Duration | Date | Clock | Moment
                | Character,
                _,
            ) => false,
        }
    }

    /// What stands for it in a shrunk program.
    pub(super) fn plain(self) -> &'static str {
        match self {
            Self::Bool => "FALSE",
            Self::Sint => "SINT#1",
            Self::Int => "INT#1",
            Self::Dint => "DINT#1",
            Self::Lint => "LINT#1",
            Self::Usint => "USINT#1",
            Self::Uint => "UINT#1",
            Self::Udint => "UDINT#1",
            Self::Ulint => "ULINT#1",
            Self::Byte => "BYTE#1",
            Self::Word => "WORD#1",
            Self::Dword => "DWORD#1",
            Self::Lword => "LWORD#1",
            Self::Real => "REAL#1.0",
            Self::Lreal => "LREAL#1.0",
            Self::Time => "T#1s",
            Self::Ltime => "LT#1s",
            Self::Date => "D#2000-01-01",
            Self::Ldate => "LD#2000-01-01",
            Self::Tod => "TOD#0:0:0",
            Self::Ltod => "LTOD#0:0:0",
            Self::Dt => "DT#2000-01-01-0:0:0",
            Self::Ldt => "LDT#2000-01-01-0:0:0",
            Self::Char => "CHAR#'a'",
            Self::Wchar => "WCHAR#\"a\"",
        }
    }
}

/// A type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    Elementary(Elementary),
    Text {
        wide: bool,
        length: u32,
    },
    Enumeration(usize),
    Subrange(usize),
    Array(usize),
    /// `ARRAY [*]` of an elementary type, for in-outs.
    Open(Elementary),
    Structure(usize),
    Reference(usize),
    /// An instance of a block or class, or what an interface stands for.
    Instance(usize),
}

impl Type {
    pub(super) const BOOL: Self = Self::Elementary(Elementary::Bool);
    pub(super) const INT: Self = Self::Elementary(Elementary::Int);

    pub(super) fn as_elementary(self) -> Option<Elementary> {
        if let Self::Elementary(ty) = self {
            Some(ty)
        } else {
            None
        }
    }

    /// The unit of an instance.
    pub(super) fn as_instance(self) -> Option<usize> {
        if let Self::Instance(at) = self {
            Some(at)
        } else {
            None
        }
    }

    /// Whether a variable of it is assigned and compared as one value.
    pub(super) fn is_value(self) -> bool {
        match self {
            Self::Elementary(_) | Self::Text { .. } | Self::Enumeration(_) | Self::Subrange(_) => {
                true
            }
            Self::Array(_)
            | Self::Open(_)
            | Self::Structure(_)
            | Self::Reference(_)
            | Self::Instance(_) => false,
        }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Enumeration {
    pub(super) name: String,
    pub(super) values: Vec<String>,
}

#[derive(Debug, Clone)]
pub(super) struct Subrange {
    pub(super) name: String,
    pub(super) base: Elementary,
    pub(super) low: i64,
    pub(super) high: i64,
}

#[derive(Debug, Clone)]
pub(super) struct Array {
    /// As a declaration writes it: a name, or `ARRAY … OF …`.
    pub(super) written: String,
    pub(super) bounds: Vec<(i64, i64)>,
    pub(super) element: Type,
}

#[derive(Debug, Clone)]
pub(super) struct Structure {
    pub(super) name: String,
    pub(super) members: Vec<(String, Type)>,
}

/// The types a program declares or uses.
#[derive(Debug, Clone, Default)]
pub(super) struct Types {
    pub(super) enumerations: Vec<Enumeration>,
    pub(super) subranges: Vec<Subrange>,
    pub(super) arrays: Vec<Array>,
    pub(super) structures: Vec<Structure>,
    /// What references refer to.
    pub(super) references: Vec<Type>,
    /// Names of blocks, classes and interfaces.
    pub(super) instances: Vec<String>,
}

impl Types {
    /// As a declaration writes it.
    pub(super) fn written(&self, ty: Type) -> String {
        match ty {
            Type::Elementary(ty) => ty.word().to_owned(),
            Type::Text {
                wide: false,
                length,
            } => format!("STRING[{length}]"),
            Type::Text { wide: true, length } => format!("WSTRING[{length}]"),
            Type::Enumeration(at) => self.enumerations[at].name.clone(),
            Type::Subrange(at) => self.subranges[at].name.clone(),
            Type::Array(at) => self.arrays[at].written.clone(),
            Type::Open(element) => format!("ARRAY [*] OF {}", element.word()),
            Type::Structure(at) => self.structures[at].name.clone(),
            Type::Reference(at) => format!("REF_TO {}", self.written(self.references[at])),
            Type::Instance(at) => self.instances[at].clone(),
        }
    }

    /// What stands for a value in a shrunk program; nothing, where there is no literal.
    pub(super) fn plain(&self, ty: Type) -> String {
        match ty {
            Type::Elementary(ty) => ty.plain().to_owned(),
            Type::Text { wide: false, .. } => "''".to_owned(),
            Type::Text { wide: true, .. } => "\"\"".to_owned(),
            Type::Enumeration(at) => self.enumerator(at, 0),
            Type::Subrange(at) => {
                let range = &self.subranges[at];
                format!("{}#{}", range.base.word(), range.low)
            }
            Type::Reference(_) => "NULL".to_owned(),
            Type::Array(_) | Type::Open(_) | Type::Structure(_) | Type::Instance(_) => {
                String::new()
            }
        }
    }

    pub(super) fn enumerator(&self, at: usize, value: usize) -> String {
        let ty = &self.enumerations[at];
        format!("{}#{}", ty.name, ty.values[value])
    }

    pub(super) fn reference_to(&mut self, target: Type) -> Type {
        let known = self.references.iter().position(|&ty| ty == target);
        Type::Reference(known.unwrap_or_else(|| {
            self.references.push(target);
            self.references.len() - 1
        }))
    }

    /// An elementary type, those with much arithmetic more often.
    pub(super) fn elementary(rng: &mut Rng) -> Elementary {
        use Elementary::{Bool, Dint, Dword, Int, Lreal, Real, Sint, Time, Uint, Word};
        if rng.one_in(2) {
            return rng.pick(Elementary::ALL);
        }
        rng.pick(&[
            Bool, Bool, Sint, Int, Int, Dint, Uint, Word, Dword, Real, Lreal, Time,
        ])
    }

    /// A type of one value.
    pub(super) fn value(&self, rng: &mut Rng) -> Type {
        match rng.below(12) {
            0 | 1 => Self::text(rng),
            2 if !self.enumerations.is_empty() => {
                Type::Enumeration(rng.below(self.enumerations.len()))
            }
            3 if !self.subranges.is_empty() => Type::Subrange(rng.below(self.subranges.len())),
            _ => Type::Elementary(Self::elementary(rng)),
        }
    }

    pub(super) fn text(rng: &mut Rng) -> Type {
        Type::Text {
            wide: rng.one_in(4),
            length: rng.pick(&[1, 3, 5, 10, 20]),
        }
    }

    /// A type of anything but instances.
    pub(super) fn any(&mut self, rng: &mut Rng) -> Type {
        match rng.below(10) {
            0 if !self.structures.is_empty() => Type::Structure(rng.below(self.structures.len())),
            1 | 2 => {
                let instances = |array: &Array| matches!(array.element, Type::Instance(_));
                let known = (0..self.arrays.len()).filter(|&at| !instances(&self.arrays[at]));
                let known: Vec<usize> = known.collect();
                if known.is_empty() || rng.one_in(2) {
                    self.array(rng)
                } else {
                    Type::Array(rng.pick(&known))
                }
            }
            _ => self.value(rng),
        }
    }

    /// A new array type, written where it is used.
    fn array(&mut self, rng: &mut Rng) -> Type {
        let element = match rng.below(5) {
            0 if !self.structures.is_empty() => Type::Structure(rng.below(self.structures.len())),
            _ => self.value(rng),
        };
        let bounds: Vec<(i64, i64)> = (0..rng.pick(&[1, 1, 1, 2, 2, 3]))
            .map(|_| {
                let low = rng.pick(&[0, 1, -2, 5]);
                (low, low + rng.below(4) as i64)
            })
            .collect();
        let dimensions: Vec<String> = bounds.iter().map(|(l, h)| format!("{l}..{h}")).collect();
        let element_text = self.written(element);
        self.arrays.push(Array {
            written: format!("ARRAY [{}] OF {element_text}", dimensions.join(", ")),
            bounds,
            element,
        });
        Type::Array(self.arrays.len() - 1)
    }

    /// Declares types; gives the text of their declarations, one each.
    pub(super) fn declare(&mut self, rng: &mut Rng) -> Vec<String> {
        let mut texts = Vec::new();
        for index in 0..rng.below(3) {
            texts.push(self.declare_enumeration(rng, index));
        }
        for index in 0..rng.below(3) {
            texts.push(self.declare_subrange(rng, index));
        }
        for index in 0..rng.below(3) {
            texts.push(self.declare_structure(rng, index));
        }
        if rng.one_in(3) {
            let Type::Array(at) = self.array(rng) else {
                unreachable!("an array type was asked for");
            };
            texts.push(format!("A0 : {};", self.arrays[at].written));
            self.arrays[at].written = "A0".to_owned();
        }
        texts
    }

    fn declare_enumeration(&mut self, rng: &mut Rng, index: usize) -> String {
        let name = format!("E{index}");
        let count = 1 + rng.below(5);
        let values: Vec<String> = (0..count).map(|at| format!("e{index}_{at}")).collect();
        let numbered = rng.one_in(3);
        let written = values.iter().enumerate().map(|(at, value)| {
            if numbered {
                format!("{value} := {}", 3 * at + index)
            } else {
                value.clone()
            }
        });
        let written = written.collect::<Vec<_>>().join(", ");
        let base = if numbered { "INT " } else { "" };
        let initial = rng.below(count);
        let text = format!("{name} : {base}({written}) := {};", values[initial]);
        self.enumerations.push(Enumeration { name, values });
        text
    }

    fn declare_subrange(&mut self, rng: &mut Rng, index: usize) -> String {
        use Elementary::{Dint, Int, Lint, Sint, Udint, Uint, Usint};
        let name = format!("R{index}");
        let base = rng.pick(&[Sint, Int, Dint, Lint, Usint, Uint, Udint]);
        let low = if base.kind() == Kind::Unsigned {
            rng.below(10) as i64
        } else {
            rng.below(30) as i64 - 20
        };
        let high = low + rng.below(90) as i64;
        let text = format!("{name} : {} ({low}..{high});", base.word());
        self.subranges.push(Subrange {
            name,
            base,
            low,
            high,
        });
        text
    }

    fn declare_structure(&mut self, rng: &mut Rng, index: usize) -> String {
        let name = format!("S{index}");
        let mut members = Vec::new();
        for member in 0..1 + rng.below(4) {
            members.push((format!("m{member}"), self.any(rng)));
        }
        let written = members.iter();
        let written = written.map(|(name, ty)| format!("{name} : {};", self.written(*ty)));
        let written = written.collect::<Vec<_>>().join(" ");
        let text = format!("{name} : STRUCT {written} END_STRUCT;");
        self.structures.push(Structure { name, members });
        text
    }
}
