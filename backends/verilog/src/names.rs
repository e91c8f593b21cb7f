//! Verilog identifiers from the names users gave: as written where that is legal, readable where it
//! is not, and never two things under one name.
//!
//! Accepted: `Start`. Changed: `Local:2:I.Data.3` becomes `Local_2_I_Data_3`, `reg` becomes `reg_`.
//! `a.b` and `a_b` in one module become `a_b` and `a_b_2`. Names that differ in case only are kept
//! apart too, because several tools fold case.

use iecc_ir::{Index, MemType, Module, Place, Projection, Root};
use std::collections::BTreeSet;

/// Longest identifier made; tools must take 1024 characters.
const MAX_LENGTH: usize = 200;

/// The identifiers of one module.
#[derive(Debug, Default)]
pub(crate) struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// An identifier for a name, as close to it as possible.
    pub(crate) fn claim(&mut self, name: &str) -> String {
        let base = identifier(name);
        let mut candidate = base.clone();
        let mut number = 1;
        while !self.taken.insert(candidate.to_ascii_lowercase()) {
            number += 1;
            candidate = format!("{base}_{number}");
        }
        candidate
    }

    /// An identifier with a suffix that is added only if the plain name is taken.
    pub(crate) fn claim_or(&mut self, name: &str, suffix: &str) -> String {
        if self.taken.contains(&identifier(name).to_ascii_lowercase()) {
            self.claim(&format!("{name}{suffix}"))
        } else {
            self.claim(name)
        }
    }
}

/// A legal identifier for a name, the same for the same name.
pub(crate) fn identifier(name: &str) -> String {
    let legal = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let mut text: String = name.chars().take(MAX_LENGTH).map(legal).collect();
    if !text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        text.insert(0, '_');
    }
    if KEYWORDS.contains(&text.as_str()) {
        text.push('_');
    }
    text
}

/// The name of a place as a user reads it: `tonp1.ACC`, `recipe[3].time`, `word.5`.
pub fn place_text(module: &Module, place: &Place) -> String {
    let region = match place.root {
        Root::State => module.state,
        Root::Input => module.input,
        Root::Output => module.output,
        Root::Ref(_) => panic!("the scan function has no references"),
        Root::Local(_) | Root::Deref { .. } => panic!("refused by the check"),
    };
    let mut at = MemType::Struct(region);
    let mut text = String::new();
    for step in &place.path {
        match (at, step) {
            (MemType::Struct(id), Projection::Field(field)) => {
                let field = &module.types.structs[id].fields[*field as usize];
                if !text.is_empty() {
                    text.push('.');
                }
                text.push_str(&field.name);
                at = field.ty;
            }
            (MemType::Array(id), Projection::Index(Index::Const(index))) => {
                text.push_str(&format!("[{index}]"));
                at = module.types.array_type(id).element;
            }
            (MemType::Scalar(_), Projection::Bit(Index::Const(bit))) => {
                text.push_str(&format!(".{bit}"));
            }
            (MemType::Struct(_) | MemType::Array(_) | MemType::Scalar(_), _) => {
                panic!("static places follow their types")
            }
        }
    }
    text
}

/// Reserved words of Verilog-2005 and SystemVerilog-2017, which most tools assume for any file.
const KEYWORDS: &[&str] = &[
    "accept_on",
    "alias",
    "always",
    "always_comb",
    "always_ff",
    "always_latch",
    "and",
    "assert",
    "assign",
    "assume",
    "automatic",
    "before",
    "begin",
    "bind",
    "bins",
    "binsof",
    "bit",
    "break",
    "buf",
    "bufif0",
    "bufif1",
    "byte",
    "case",
    "casex",
    "casez",
    "cell",
    "chandle",
    "checker",
    "class",
    "clocking",
    "cmos",
    "config",
    "const",
    "constraint",
    "context",
    "continue",
    "cover",
    "covergroup",
    "coverpoint",
    "cross",
    "deassign",
    "default",
    "defparam",
    "design",
    "disable",
    "dist",
    "do",
    "edge",
    "else",
    "end",
    "endcase",
    "endchecker",
    "endclass",
    "endclocking",
    "endconfig",
    "endfunction",
    "endgenerate",
    "endgroup",
    "endinterface",
    "endmodule",
    "endpackage",
    "endprimitive",
    "endprogram",
    "endproperty",
    "endsequence",
    "endspecify",
    "endtable",
    "endtask",
    "enum",
    "event",
    "eventually",
    "expect",
    "export",
    "extends",
    "extern",
    "final",
    "first_match",
    "for",
    "force",
    "foreach",
    "forever",
    "fork",
    "forkjoin",
    "function",
    "generate",
    "genvar",
    "global",
    "highz0",
    "highz1",
    "if",
    "iff",
    "ifnone",
    "ignore_bins",
    "illegal_bins",
    "implements",
    "implies",
    "import",
    "incdir",
    "include",
    "initial",
    "inout",
    "input",
    "inside",
    "instance",
    "int",
    "integer",
    "interconnect",
    "interface",
    "intersect",
    "join",
    "join_any",
    "join_none",
    "large",
    "let",
    "liblist",
    "library",
    "local",
    "localparam",
    "logic",
    "longint",
    "macromodule",
    "matches",
    "medium",
    "modport",
    "module",
    "nand",
    "negedge",
    "nettype",
    "new",
    "nexttime",
    "nmos",
    "nor",
    "noshowcancelled",
    "not",
    "notif0",
    "notif1",
    "null",
    "or",
    "output",
    "package",
    "packed",
    "parameter",
    "pmos",
    "posedge",
    "primitive",
    "priority",
    "program",
    "property",
    "protected",
    "pull0",
    "pull1",
    "pulldown",
    "pullup",
    "pulsestyle_ondetect",
    "pulsestyle_onevent",
    "pure",
    "rand",
    "randc",
    "randcase",
    "randsequence",
    "rcmos",
    "real",
    "realtime",
    "ref",
    "reg",
    "reject_on",
    "release",
    "repeat",
    "restrict",
    "return",
    "rnmos",
    "rpmos",
    "rtran",
    "rtranif0",
    "rtranif1",
    "s_always",
    "s_eventually",
    "s_nexttime",
    "s_until",
    "s_until_with",
    "scalared",
    "sequence",
    "shortint",
    "shortreal",
    "showcancelled",
    "signed",
    "small",
    "soft",
    "solve",
    "specify",
    "specparam",
    "static",
    "string",
    "strong",
    "strong0",
    "strong1",
    "struct",
    "super",
    "supply0",
    "supply1",
    "sync_accept_on",
    "sync_reject_on",
    "table",
    "tagged",
    "task",
    "this",
    "throughout",
    "time",
    "timeprecision",
    "timeunit",
    "tran",
    "tranif0",
    "tranif1",
    "tri",
    "tri0",
    "tri1",
    "triand",
    "trior",
    "trireg",
    "type",
    "typedef",
    "union",
    "unique",
    "unique0",
    "unsigned",
    "until",
    "until_with",
    "untyped",
    "use",
    "uwire",
    "var",
    "vectored",
    "virtual",
    "void",
    "wait",
    "wait_order",
    "wand",
    "weak",
    "weak0",
    "weak1",
    "while",
    "wildcard",
    "wire",
    "with",
    "within",
    "wor",
    "xnor",
    "xor",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legal_names_stay_and_others_stay_readable() {
        let mut names = Names::default();
        for (name, expected) in [
            ("Start", "Start"),
            ("a.b", "a_b"),
            ("a_b", "a_b_2"),
            ("A_B", "A_B_3"),
            ("reg", "reg_"),
            ("logic", "logic_"),
            ("1st", "_1st"),
            ("Local:2:I.Data.3", "Local_2_I_Data_3"),
            ("Ventil ü", "Ventil__"),
            ("", "_"),
        ] {
            assert_eq!(names.claim(name), expected);
        }
    }

    #[test]
    fn keywords_are_sorted_and_unique() {
        assert!(KEYWORDS.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
