//! What callers need to know of functions, methods and blocks.

use super::types::{Elementary, Type, Types};

/// Which way a parameter goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    In,
    Out,
    InOut,
}

#[derive(Debug, Clone)]
pub(super) struct Param {
    pub(super) name: String,
    pub(super) ty: Type,
    pub(super) way: Way,
    /// `R_EDGE` or `F_EDGE` behind its type, or nothing.
    pub(super) edge: &'static str,
}

impl Param {
    pub(super) fn new(name: &str, ty: Type, way: Way) -> Self {
        Self {
            name: name.to_owned(),
            ty,
            way,
            edge: "",
        }
    }
}

/// Something that can be called.
#[derive(Debug, Clone)]
pub(super) struct Signature {
    pub(super) name: String,
    pub(super) result: Option<Type>,
    pub(super) params: Vec<Param>,
    /// Statements it executes at most.
    pub(super) cost: u64,
}

impl Signature {
    pub(super) fn of(&self, way: Way) -> impl Iterator<Item = &Param> {
        self.params.iter().filter(move |param| param.way == way)
    }
}

/// A block, class or interface. Its position is that of its name among the types.
#[derive(Debug, Clone)]
pub(super) struct Unit {
    /// What a call of an instance runs; classes and interfaces have nothing.
    pub(super) body: Option<Signature>,
    pub(super) methods: Vec<Signature>,
    /// Whether variables of it are references to instances.
    pub(super) is_interface: bool,
    /// The units it extends or implements, those they extend included.
    pub(super) above: Vec<usize>,
}

/// The blocks of the standard library.
pub(super) fn standard_blocks(types: &mut Types) -> Vec<Unit> {
    let table: [(&str, &str, &str); 16] = [
        ("TON", "IN:BOOL PT:TIME", "Q:BOOL ET:TIME"),
        ("TOF", "IN:BOOL PT:TIME", "Q:BOOL ET:TIME"),
        ("TP", "IN:BOOL PT:TIME", "Q:BOOL ET:TIME"),
        ("TON_LTIME", "IN:BOOL PT:LTIME", "Q:BOOL ET:LTIME"),
        ("CTU", "CU:BOOL R:BOOL PV:INT", "Q:BOOL CV:INT"),
        ("CTD", "CD:BOOL LD:BOOL PV:INT", "Q:BOOL CV:INT"),
        (
            "CTUD",
            "CU:BOOL CD:BOOL R:BOOL LD:BOOL PV:INT",
            "QU:BOOL QD:BOOL CV:INT",
        ),
        ("CTU_DINT", "CU:BOOL R:BOOL PV:DINT", "Q:BOOL CV:DINT"),
        ("CTD_UDINT", "CD:BOOL LD:BOOL PV:UDINT", "Q:BOOL CV:UDINT"),
        (
            "CTUD_ULINT",
            "CU:BOOL CD:BOOL R:BOOL LD:BOOL PV:ULINT",
            "QU:BOOL QD:BOOL CV:ULINT",
        ),
        ("CTU_LINT", "CU:BOOL R:BOOL PV:LINT", "Q:BOOL CV:LINT"),
        ("R_TRIG", "CLK:BOOL", "Q:BOOL"),
        ("F_TRIG", "CLK:BOOL", "Q:BOOL"),
        ("SR", "S1:BOOL R:BOOL", "Q1:BOOL"),
        ("RS", "S:BOOL R1:BOOL", "Q1:BOOL"),
        ("TP_LTIME", "IN:BOOL PT:LTIME", "Q:BOOL ET:LTIME"),
    ];
    let units = table.iter().map(|(name, inputs, outputs)| {
        types.instances.push((*name).to_owned());
        let inputs = params(inputs, Way::In);
        Unit {
            body: Some(Signature {
                name: (*name).to_owned(),
                result: None,
                params: inputs.chain(params(outputs, Way::Out)).collect(),
                cost: 10,
            }),
            methods: Vec::new(),
            is_interface: false,
            above: Vec::new(),
        }
    });
    units.collect()
}

/// Functions of the library whose parameters have one type each.
pub(super) fn standard_functions() -> Vec<Signature> {
    let table: [(&str, &str, &str, &str); 25] = [
        ("CONCAT_DATE", "DATE", "YEAR:INT MONTH:INT DAY:INT", ""),
        (
            "CONCAT_TOD",
            "TOD",
            "HOUR:INT MINUTE:INT SECOND:INT MILLISECOND:INT",
            "",
        ),
        ("CONCAT_DATE_TOD", "DT", "IN1:DATE IN2:TOD", ""),
        ("SPLIT_DATE", "", "IN:DATE", "YEAR:INT MONTH:INT DAY:INT"),
        (
            "SPLIT_TOD",
            "",
            "IN:TOD",
            "HOUR:INT MINUTE:INT SECOND:INT MILLISECOND:INT",
        ),
        ("DAY_OF_WEEK", "INT", "IN:DATE", ""),
        ("ADD_TIME", "TIME", "IN1:TIME IN2:TIME", ""),
        ("SUB_DT_DT", "TIME", "IN1:DT IN2:DT", ""),
        ("ADD_TOD_TIME", "TOD", "IN1:TOD IN2:TIME", ""),
        ("BCD_TO_UINT", "UINT", "IN:WORD", ""),
        ("TO_BCD_WORD", "WORD", "IN:UINT", ""),
        ("IS_VALID_BCD", "BOOL", "IN:DWORD", ""),
        ("ADD", "INT", "IN1:INT IN2:INT", ""),
        ("SUB", "DINT", "IN1:DINT IN2:DINT", ""),
        ("MUL", "INT", "IN1:INT IN2:INT", ""),
        ("DIV", "INT", "IN1:INT IN2:INT", ""),
        ("DIV", "REAL", "IN1:REAL IN2:REAL", ""),
        ("ABS", "INT", "IN:INT", ""),
        ("SQRT", "LREAL", "IN:LREAL", ""),
        ("SEL", "REAL", "G:BOOL IN0:REAL IN1:REAL", ""),
        ("LIMIT", "INT", "MN:INT IN:INT MX:INT", ""),
        ("MUX", "DINT", "K:INT IN0:DINT IN1:DINT", ""),
        ("SHL", "WORD", "IN:WORD N:INT", ""),
        ("ROR", "BYTE", "IN:BYTE N:INT", ""),
        ("GT", "BOOL", "IN1:INT IN2:INT", ""),
    ];
    let functions = table.iter().map(|(name, result, inputs, outputs)| {
        let result = (!result.is_empty()).then(|| Type::Elementary(elementary(result)));
        let inputs = params(inputs, Way::In);
        Signature {
            name: (*name).to_owned(),
            result,
            params: inputs.chain(params(outputs, Way::Out)).collect(),
            cost: 5,
        }
    });
    functions.collect()
}

fn elementary(word: &str) -> Elementary {
    let known = Elementary::ALL.iter().find(|known| known.word() == word);
    *known.expect("an elementary type")
}

fn params(text: &str, way: Way) -> impl Iterator<Item = Param> + use<'_> {
    let words = text.split(' ').filter(|word| !word.is_empty());
    words.map(move |param| {
        let (name, ty) = param.split_once(':').expect("NAME:TYPE");
        Param::new(name, Type::Elementary(elementary(ty)), way)
    })
}
