//! The one table of ladder instructions.
//!
//! Every mnemonic of the vendor's ladder set is a row: its name, its name from revision 36 on, what
//! it does to the rung's condition, its operands, its effect in prescan, and its meaning, or why
//! it is refused. Checking, prescan, documentation and suggestions read it; adding an instruction
//! is one row and, if its meaning is new, what follows from the exhaustive matches on [`Meaning`].

use crate::hir::{
    Arithmetic, CoilKind, CompareOp, CounterKind, Logical, Prescan, TimerKind, Unary,
};
use Calculation::{Bitwise, Single, Two, Zero};
use Meaning::{
    AlwaysFalse, Band, Coil, Comparison, Compute, Contact, Control, Counting, Edge, MaskedEqual,
    Nothing, OneShot, Refused, Reset, Timing,
};
use OperandKind::{
    Any, Bit, BitTarget, CounterTag, InTag, Integer, IntegerTarget, Number, NumberTarget,
    Resettable, TimerTag, Variable,
};
use Prescan::{Clear, Counter, Set, Timer};
use Reason::{Later, Motion, Phase, Safety, Serial};
use RungRule::{Input, Output};

/// What an instruction passes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RungRule {
    /// A condition of its own, at most the one it got.
    Input,
    /// The condition it got.
    Output,
}

/// What may stand in an operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OperandKind {
    /// A BOOL or a bit of an integer.
    Bit,
    /// The same, written to.
    BitTarget,
    /// A number: literal or tag.
    Number,
    /// A whole number: literal or tag.
    Integer,
    /// A number, written to.
    NumberTarget,
    /// A whole number, written to.
    IntegerTarget,
    /// A TIMER.
    TimerTag,
    /// A COUNTER.
    CounterTag,
    /// A TIMER, COUNTER or CONTROL.
    Resettable,
    /// `?`, or a number that was written into the tag at download.
    InTag,
    /// Any number of operands, checked with the meaning.
    Variable,
    /// Not checked, because the instruction is refused.
    Any,
}

/// Why an instruction is known but not compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// It will be.
    Later,
    /// It moves axes.
    Motion,
    /// It is part of equipment phases.
    Phase,
    /// It is safety-rated.
    Safety,
    /// It drives the serial port.
    Serial,
}

impl Reason {
    /// The reason as a sentence for the user.
    pub fn explain(self) -> &'static str {
        match self {
            Reason::Later => "this version of iecc does not compile it yet",
            Reason::Motion => "motion control needs the vendor's drives and is not compiled",
            Reason::Phase => "equipment phases are not compiled",
            Reason::Safety => "safety logic is not compiled: the result would not be safety-rated",
            Reason::Serial => "the ASCII serial port exists on the vendor's controllers only",
        }
    }
}

/// What an instruction does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// XIC, XIO
    Contact {
        /// XIO
        normally_closed: bool,
    },
    /// OTE, OTL, OTU
    Coil(CoilKind),
    /// ONS
    OneShot,
    /// OSR, OSF
    Edge {
        /// OSF
        falling: bool,
    },
    /// TON, TOF, RTO
    Timing(TimerKind),
    /// CTU, CTD
    Counting(CounterKind),
    /// RES
    Reset,
    /// EQU and its kin
    Comparison(CompareOp),
    /// LIM
    Band,
    /// MEQ
    MaskedEqual,
    /// MOV, ADD, AND, CLR and their kin
    Compute(Calculation),
    /// JSR, SBR, RET
    Control(Passing),
    /// AFI
    AlwaysFalse,
    /// NOP
    Nothing,
    /// Known, but not compiled.
    Refused(Reason),
}

/// Instructions that compute a value into a destination, their last operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Calculation {
    /// MOV, NEG, ABS, NOT
    Single(Unary),
    /// ADD, SUB, MUL, DIV, MOD
    Two(Arithmetic),
    /// AND, OR, XOR
    Bitwise(Logical),
    /// CLR
    Zero,
}

/// Instructions that call routines and pass values, with any number of operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passing {
    /// JSR
    Call,
    /// SBR
    Subroutine,
    /// RET
    Return,
}

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// The mnemonic.
    pub name: &'static str,
    /// The mnemonic from revision 36 on, if it was renamed.
    pub renamed: Option<&'static str>,
    /// What it passes on.
    pub rule: RungRule,
    /// Operands, each with its name in messages.
    pub operands: &'static [(&'static str, OperandKind)],
    /// What prescan does to the n-th place the operation names.
    pub prescan: &'static [(usize, Prescan)],
    /// What it does.
    pub meaning: Meaning,
}

const fn row(
    name: &'static str,
    renamed: &'static str,
    rule: RungRule,
    operands: &'static [(&'static str, OperandKind)],
    prescan: &'static [(usize, Prescan)],
    meaning: Meaning,
) -> Row {
    let renamed = if renamed.is_empty() {
        None
    } else {
        Some(renamed)
    };
    Row {
        name,
        renamed,
        rule,
        operands,
        prescan,
        meaning,
    }
}

type Operands = &'static [(&'static str, OperandKind)];

const VARIABLE: Operands = &[("operands", Variable)];
const TIMER: Operands = &[
    ("timer", TimerTag),
    ("preset", InTag),
    ("accumulator", InTag),
];
const COUNTER: Operands = &[
    ("counter", CounterTag),
    ("preset", InTag),
    ("accumulator", InTag),
];
const COMPARE: Operands = &[("source A", Number), ("source B", Number)];
const UNARY: Operands = &[("source", Number), ("destination", NumberTarget)];
const BINARY: Operands = &[
    ("source A", Number),
    ("source B", Number),
    ("destination", NumberTarget),
];
const LOGICAL: Operands = &[
    ("source A", Integer),
    ("source B", Integer),
    ("destination", IntegerTarget),
];

/// Every instruction.
#[rustfmt::skip]
pub const INSTRUCTIONS: &[Row] = &[
    // Bit
    row("XIC", "", Input, &[("bit", Bit)], &[], Contact { normally_closed: false }),
    row("XIO", "", Input, &[("bit", Bit)], &[], Contact { normally_closed: true }),
    row("OTE", "", Output, &[("bit", BitTarget)], &[(0, Clear)], Coil(CoilKind::Energize)),
    row("OTL", "", Output, &[("bit", BitTarget)], &[], Coil(CoilKind::Latch)),
    row("OTU", "", Output, &[("bit", BitTarget)], &[], Coil(CoilKind::Unlatch)),
    row("ONS", "", Input, &[("storage bit", BitTarget)], &[(0, Set)], OneShot),
    row("OSR", "", Output, &[("storage bit", BitTarget), ("output bit", BitTarget)], &[(0, Set), (1, Clear)], Edge { falling: false }),
    row("OSF", "", Output, &[("storage bit", BitTarget), ("output bit", BitTarget)], &[(0, Clear), (1, Clear)], Edge { falling: true }),
    // Timers and counters
    row("TON", "", Output, TIMER, &[(0, Timer(TimerKind::OnDelay))], Timing(TimerKind::OnDelay)),
    row("TOF", "", Output, TIMER, &[(0, Timer(TimerKind::OffDelay))], Timing(TimerKind::OffDelay)),
    row("RTO", "", Output, TIMER, &[(0, Timer(TimerKind::Retentive))], Timing(TimerKind::Retentive)),
    row("CTU", "", Output, COUNTER, &[(0, Counter(CounterKind::Up))], Counting(CounterKind::Up)),
    row("CTD", "", Output, COUNTER, &[(0, Counter(CounterKind::Down))], Counting(CounterKind::Down)),
    row("RES", "", Output, &[("structure", Resettable)], &[], Reset),
    // Compare
    row("EQU", "EQ", Input, COMPARE, &[], Comparison(CompareOp::Equal)),
    row("NEQ", "NE", Input, COMPARE, &[], Comparison(CompareOp::NotEqual)),
    row("GRT", "GT", Input, COMPARE, &[], Comparison(CompareOp::Greater)),
    row("GEQ", "GE", Input, COMPARE, &[], Comparison(CompareOp::GreaterEqual)),
    row("LES", "LT", Input, COMPARE, &[], Comparison(CompareOp::Less)),
    row("LEQ", "LE", Input, COMPARE, &[], Comparison(CompareOp::LessEqual)),
    row("LIM", "LIMIT", Input, &[("low limit", Number), ("test", Number), ("high limit", Number)], &[], Band),
    row("MEQ", "", Input, &[("source", Integer), ("mask", Integer), ("compare", Integer)], &[], MaskedEqual),
    // Move, compute, logical
    row("MOV", "MOVE", Output, UNARY, &[], Compute(Single(Unary::Move))),
    row("CLR", "", Output, &[("destination", NumberTarget)], &[], Compute(Zero)),
    row("ADD", "", Output, BINARY, &[], Compute(Two(Arithmetic::Add))),
    row("SUB", "", Output, BINARY, &[], Compute(Two(Arithmetic::Subtract))),
    row("MUL", "", Output, BINARY, &[], Compute(Two(Arithmetic::Multiply))),
    row("DIV", "", Output, BINARY, &[], Compute(Two(Arithmetic::Divide))),
    row("MOD", "", Output, BINARY, &[], Compute(Two(Arithmetic::Modulo))),
    row("NEG", "", Output, UNARY, &[], Compute(Single(Unary::Negate))),
    row("ABS", "", Output, UNARY, &[], Compute(Single(Unary::Absolute))),
    row("AND", "", Output, LOGICAL, &[], Compute(Bitwise(Logical::And))),
    row("OR", "", Output, LOGICAL, &[], Compute(Bitwise(Logical::Or))),
    row("XOR", "", Output, LOGICAL, &[], Compute(Bitwise(Logical::Xor))),
    row("NOT", "", Output, &[("source", Integer), ("destination", IntegerTarget)], &[], Compute(Single(Unary::Not))),
    // Program control
    row("JSR", "", Output, VARIABLE, &[], Control(Passing::Call)),
    row("SBR", "", Input, VARIABLE, &[], Control(Passing::Subroutine)),
    row("RET", "", Output, VARIABLE, &[], Control(Passing::Return)),
    row("AFI", "", Input, &[], &[], AlwaysFalse),
    row("NOP", "", Input, &[], &[], Nothing),
    // Compare, not compiled yet
    row("CMP", "", Input, &[("expression", Any)], &[], Refused(Later)),
    row("IsINF", "", Input, &[("source", Any)], &[], Refused(Later)),
    row("IsNAN", "", Input, &[("source", Any)], &[], Refused(Later)),
    // Compute, not compiled yet
    row("CPT", "", Output, &[("destination", Any), ("expression", Any)], &[], Refused(Later)),
    row("SQR", "SQRT", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("XPY", "", Output, &[("x", Any), ("y", Any), ("destination", Any)], &[], Refused(Later)),
    row("LN", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("LOG", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("SIN", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("COS", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("TAN", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("ASN", "ASIN", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("ACS", "ACOS", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("ATN", "ATAN", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("ATAN2", "", Output, &[("y", Any), ("x", Any), ("destination", Any)], &[], Refused(Later)),
    row("DEG", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("RAD", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("TRN", "TRUNC", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("TOD", "TO_BCD", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("FRD", "BCD_TO", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    // Move and logical, not compiled yet
    row("MVM", "", Output, &[("source", Any), ("mask", Any), ("destination", Any)], &[], Refused(Later)),
    row("BTD", "", Output, &[("source", Any), ("source bit", Any), ("destination", Any), ("destination bit", Any), ("length", Any)], &[], Refused(Later)),
    row("SWPB", "", Output, &[("source", Any), ("order", Any), ("destination", Any)], &[], Refused(Later)),
    // Array, not compiled yet
    row("COP", "", Output, &[("source", Any), ("destination", Any), ("length", Any)], &[], Refused(Later)),
    row("CPS", "", Output, &[("source", Any), ("destination", Any), ("length", Any)], &[], Refused(Later)),
    row("FLL", "", Output, &[("source", Any), ("destination", Any), ("length", Any)], &[], Refused(Later)),
    row("FAL", "", Output, &[("control", Any), ("length", Any), ("position", Any), ("mode", Any), ("destination", Any), ("expression", Any)], &[], Refused(Later)),
    row("FSC", "", Output, &[("control", Any), ("length", Any), ("position", Any), ("mode", Any), ("expression", Any)], &[], Refused(Later)),
    row("AVE", "", Output, &[("array", Any), ("dimension", Any), ("destination", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("STD", "", Output, &[("array", Any), ("dimension", Any), ("destination", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("SRT", "", Output, &[("array", Any), ("dimension", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("SIZE", "", Output, &[("array", Any), ("dimension", Any), ("destination", Any)], &[], Refused(Later)),
    // Shift and sequencer, not compiled yet
    row("BSL", "", Output, &[("array", Any), ("control", Any), ("bit", Any), ("length", Any)], &[], Refused(Later)),
    row("BSR", "", Output, &[("array", Any), ("control", Any), ("bit", Any), ("length", Any)], &[], Refused(Later)),
    row("FFL", "", Output, &[("source", Any), ("fifo", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("FFU", "", Output, &[("fifo", Any), ("destination", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("LFL", "", Output, &[("source", Any), ("lifo", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("LFU", "", Output, &[("lifo", Any), ("destination", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("SQO", "", Output, &[("array", Any), ("mask", Any), ("destination", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("SQL", "", Output, &[("array", Any), ("source", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    // Shift and sequencer, not compiled yet
    row("SQI", "", Input, &[("array", Any), ("mask", Any), ("source", Any), ("control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    // Program control, not compiled yet
    row("JMP", "", Output, &[("label", Any)], &[], Refused(Later)),
    row("LBL", "", Output, &[("label", Any)], &[], Refused(Later)),
    row("TND", "", Output, &[], &[], Refused(Later)),
    row("MCR", "", Output, &[], &[], Refused(Later)),
    row("FOR", "", Output, &[("routine", Any), ("index", Any), ("initial", Any), ("terminal", Any), ("step", Any)], &[], Refused(Later)),
    row("BRK", "", Output, &[], &[], Refused(Later)),
    row("UID", "", Output, &[], &[], Refused(Later)),
    row("UIE", "", Output, &[], &[], Refused(Later)),
    row("EVENT", "", Output, &[("task", Any)], &[], Refused(Later)),
    row("SUS", "", Output, &[("identifier", Any)], &[], Refused(Later)),
    row("EOT", "", Output, &[("bit", Any)], &[], Refused(Later)),
    row("SFP", "", Output, &[("routine", Any), ("state", Any)], &[], Refused(Later)),
    row("SFR", "", Output, &[("routine", Any), ("step", Any)], &[], Refused(Later)),
    // String, not compiled yet
    row("CONCAT", "", Output, &[("a", Any), ("b", Any), ("destination", Any)], &[], Refused(Later)),
    row("MID", "", Output, &[("source", Any), ("quantity", Any), ("start", Any), ("destination", Any)], &[], Refused(Later)),
    row("FIND", "", Output, &[("source", Any), ("search", Any), ("start", Any), ("result", Any)], &[], Refused(Later)),
    row("INSERT", "", Output, &[("a", Any), ("b", Any), ("start", Any), ("destination", Any)], &[], Refused(Later)),
    row("DELETE", "", Output, &[("source", Any), ("quantity", Any), ("start", Any), ("destination", Any)], &[], Refused(Later)),
    row("DTOS", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("STOD", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("RTOS", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("STOR", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("UPPER", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    row("LOWER", "", Output, &[("source", Any), ("destination", Any)], &[], Refused(Later)),
    // Special, not compiled yet
    row("PID", "", Output, &[("pid", Any), ("process variable", Any), ("tieback", Any), ("control variable", Any), ("master loop", Any), ("in-hold bit", Any), ("in-hold value", Any)], &[], Refused(Later)),
    row("FBC", "", Output, &[("source", Any), ("reference", Any), ("result", Any), ("compare control", Any), ("length", Any), ("position", Any), ("result control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("DDT", "", Output, &[("source", Any), ("reference", Any), ("result", Any), ("compare control", Any), ("length", Any), ("position", Any), ("result control", Any), ("length", Any), ("position", Any)], &[], Refused(Later)),
    row("DTR", "", Output, &[("source", Any), ("mask", Any), ("reference", Any)], &[], Refused(Later)),
    // System, not compiled yet
    row("MSG", "", Output, &[("message", Any)], &[], Refused(Later)),
    row("GSV", "", Output, &[("class", Any), ("instance", Any), ("attribute", Any), ("destination", Any)], &[], Refused(Later)),
    row("SSV", "", Output, &[("class", Any), ("instance", Any), ("attribute", Any), ("source", Any)], &[], Refused(Later)),
    row("IOT", "", Output, &[("output tag", Any)], &[], Refused(Later)),
    // Alarm, not compiled yet
    row("ALMD", "", Output, &[("tag", Any), ("acknowledge", Any), ("reset", Any), ("disable", Any), ("enable", Any)], &[], Refused(Later)),
    row("ALMA", "", Output, &[("tag", Any), ("value", Any), ("acknowledge all", Any), ("disable", Any), ("enable", Any)], &[], Refused(Later)),
    row("HMIBC", "", Output, &[("tag", Any)], &[], Refused(Later)),
    row("LV", "", Output, VARIABLE, &[], Refused(Later)),
    // Serial
    row("ABL", "", Output, VARIABLE, &[], Refused(Serial)),
    row("ACB", "", Output, VARIABLE, &[], Refused(Serial)),
    row("ACL", "", Output, VARIABLE, &[], Refused(Serial)),
    row("AHL", "", Output, VARIABLE, &[], Refused(Serial)),
    row("ARD", "", Output, VARIABLE, &[], Refused(Serial)),
    row("ARL", "", Output, VARIABLE, &[], Refused(Serial)),
    row("AWA", "", Output, VARIABLE, &[], Refused(Serial)),
    row("AWT", "", Output, VARIABLE, &[], Refused(Serial)),
    // Phase
    row("PSC", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PCMD", "", Output, VARIABLE, &[], Refused(Phase)),
    row("POVR", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PFL", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PCLF", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PXRQ", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PPD", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PRNP", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PATT", "", Output, VARIABLE, &[], Refused(Phase)),
    row("PDET", "", Output, VARIABLE, &[], Refused(Phase)),
    // Motion
    row("MSO", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MSF", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MASD", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MASR", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDO", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDF", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDS", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAFR", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAS", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAH", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAJ", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAM", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAG", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCD", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MRP", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCCP", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCSV", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAPC", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MATC", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDAC", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MGS", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MGSD", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MGSR", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MGSP", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAW", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDW", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAR", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDR", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAOC", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDOC", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAAT", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MRAT", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MAHD", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MRHD", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCS", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCLM", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCCM", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCCD", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCT", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCTP", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCTO", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCTPO", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCSD", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCSR", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MDCC", "", Output, VARIABLE, &[], Refused(Motion)),
    row("MCPM", "", Output, VARIABLE, &[], Refused(Motion)),
    // Safety
    row("DCS", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DCST", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DCSTL", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DCSTM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DCM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DCSRT", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DCA", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DCAF", "", Output, VARIABLE, &[], Refused(Safety)),
    row("SMAT", "", Output, VARIABLE, &[], Refused(Safety)),
    row("THRS", "", Output, VARIABLE, &[], Refused(Safety)),
    row("THRSE", "", Output, VARIABLE, &[], Refused(Safety)),
    row("TSAM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("TSSM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("FSBM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("ESTOP", "", Output, VARIABLE, &[], Refused(Safety)),
    row("ROUT", "", Output, VARIABLE, &[], Refused(Safety)),
    row("RIN", "", Output, VARIABLE, &[], Refused(Safety)),
    row("ENPEN", "", Output, VARIABLE, &[], Refused(Safety)),
    row("DIN", "", Output, VARIABLE, &[], Refused(Safety)),
    row("LC", "", Output, VARIABLE, &[], Refused(Safety)),
    row("CBIM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("CBSSM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("CBCM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("CSM", "", Output, VARIABLE, &[], Refused(Safety)),
    row("EPMS", "", Output, VARIABLE, &[], Refused(Safety)),
    row("AVC", "", Output, VARIABLE, &[], Refused(Safety)),
    row("MVC", "", Output, VARIABLE, &[], Refused(Safety)),
    row("MMVC", "", Output, VARIABLE, &[], Refused(Safety)),
];

/// Names that are found in ladder texts but are no instructions of this controller, and what to do
/// instead. An Add-On Instruction may have such a name.
pub const NOT_LOGIX: &[(&str, &str)] = &[
    (
        "NXT",
        "a FOR instruction calls a routine; there is no instruction that closes a loop",
    ),
    (
        "NEXT",
        "a FOR instruction calls a routine; there is no instruction that closes a loop",
    ),
    (
        "SCL",
        "scaling is an instruction of SLC controllers; compute with CPT, or MUL and ADD",
    ),
    (
        "SCP",
        "scaling is an instruction of SLC controllers; compute with CPT, or MUL and ADD",
    ),
    (
        "IIM",
        "immediate input is an instruction of SLC controllers; inputs are latched before each scan",
    ),
    (
        "IOM",
        "immediate output is an instruction of SLC controllers; outputs are published after each scan",
    ),
    (
        "DINT_TO_REAL",
        "there are no conversion instructions; MOV converts to the type of its destination",
    ),
    (
        "REAL_TO_DINT",
        "there are no conversion instructions; MOV converts to the type of its destination",
    ),
    (
        "INT_TO_REAL",
        "there are no conversion instructions; MOV converts to the type of its destination",
    ),
    (
        "OSRI",
        "it exists in function block diagrams and structured text only; use OSR",
    ),
    (
        "OSFI",
        "it exists in function block diagrams and structured text only; use OSF",
    ),
    (
        "TONR",
        "it exists in function block diagrams and structured text only; use TON and RES",
    ),
    (
        "TOFR",
        "it exists in function block diagrams and structured text only; use TOF and RES",
    ),
    (
        "RTOR",
        "it exists in function block diagrams and structured text only; use RTO and RES",
    ),
    (
        "CTUD",
        "it exists in function block diagrams and structured text only; use CTU and CTD",
    ),
];

/// The instruction with this mnemonic, old or new, ignoring case.
pub fn find(mnemonic: &str) -> Option<&'static Row> {
    INSTRUCTIONS
        .iter()
        .find(|row| row.names().any(|name| name.eq_ignore_ascii_case(mnemonic)))
}

impl Row {
    /// Both mnemonics.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + use<> {
        std::iter::once(self.name).chain(self.renamed)
    }

    /// Whether it takes a number of operands that its meaning determines.
    pub fn is_variable(&self) -> bool {
        self.operands.iter().any(|(_, kind)| *kind == Variable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_mnemonic_names_one_row() {
        let names: Vec<String> = INSTRUCTIONS
            .iter()
            .flat_map(Row::names)
            .chain(NOT_LOGIX.iter().map(|(name, _)| *name))
            .map(str::to_ascii_uppercase)
            .collect();
        let unique: BTreeSet<&String> = names.iter().collect();
        assert_eq!(unique.len(), names.len());
        assert!(names.len() > 170, "{}", names.len());
    }

    #[test]
    fn both_names_lead_to_the_row_whatever_the_case() {
        assert_eq!(find("mov"), find("Move"));
        assert_eq!(find("isinf").map(|row| row.name), Some("IsINF"));
        assert_eq!(find("NXT"), None);
    }

    /// Latches, moves and resets are left alone; an effect names an operand that is there.
    #[test]
    fn prescan_effects_are_those_of_the_manual() {
        let changed: Vec<&str> = INSTRUCTIONS
            .iter()
            .filter(|row| !row.prescan.is_empty())
            .map(|row| row.name)
            .collect();
        assert_eq!(
            changed,
            [
                "OTE", "ONS", "OSR", "OSF", "TON", "TOF", "RTO", "CTU", "CTD"
            ]
        );
        for row in INSTRUCTIONS {
            let operands = row.operands.len();
            assert!(row.prescan.iter().all(|(index, _)| *index < operands));
        }
    }
}
