//! Initial values: from the data of an export to the bits of the leaves that are not 0.
//!
//! The decorated form is read, because it has names; where a file holds only the form of bracketed
//! lists, that is. With a cold start only presets, lengths and constants are kept. A value that
//! does not fit its type is an error at its place, reported when the tag is used.

use super::types::Slot;
use super::{Analysis, Init};
use crate::hir::{Elementary, MemberDef, Step, StructId, StructKind, Type};
use iecc_ast::{
    Initial, L5kValue, Name, Number, StringData, StringLiteral, Value, ValueKind, parse_number,
};
use iecc_diag::{Code, Diagnostic};
use iecc_source::{Span, Spanned};

type Leaves = Vec<(Vec<Step>, u64)>;

impl Analysis<'_> {
    /// The leaves of a tag that are not 0.
    pub(crate) fn initial_values(&mut self, ty: Type, initial: &Initial, constant: bool) -> Leaves {
        let mut reader = Reader {
            analysis: self,
            leaves: Vec::new(),
            path: Vec::new(),
        };
        let keep = constant || reader.analysis.options.init == Init::Export;
        if let Some(value) = &initial.decorated {
            reader.value(ty, value, keep);
        } else if let Some(text) = &initial.string {
            reader.string(ty, text, keep);
        } else if let Some(value) = &initial.l5k {
            reader.list(ty, value, keep);
        } else if let Some(image) = &initial.hex {
            reader.image(ty, image, keep);
        }
        reader.leaves
    }
}

struct Reader<'a, 'p> {
    analysis: &'a mut Analysis<'p>,
    leaves: Leaves,
    path: Vec<Step>,
}

impl Reader<'_, '_> {
    /// Recursion is bounded by the depth of types.
    fn value(&mut self, ty: Type, value: &Value, keep: bool) {
        match (ty, &value.kind) {
            (Type::Elementary(elementary), ValueKind::Scalar(text)) => {
                self.scalar(elementary, text, keep);
            }
            (Type::Array(_), ValueKind::Scalar(text)) => self.characters(ty, text, keep),
            (Type::Struct(id), ValueKind::Struct(members)) => {
                let def = self.analysis.types.table.struct_def(id);
                let (kind, declared) = (def.kind, def.members.clone());
                for (name, member) in members {
                    let found = declared
                        .iter()
                        .position(|def| def.name.eq_ignore_ascii_case(&name.node));
                    // What is not stored has no value either.
                    if let Some(index) = found {
                        let keep = keep || kept_when_cold(kind, &declared[index].name);
                        self.path.push(Step::Field(index as u32));
                        self.value(declared[index].ty, member, keep);
                        self.path.pop();
                    }
                }
            }
            (Type::Array(_), ValueKind::Array { elements, .. }) => {
                for (indexes, element) in elements {
                    self.element(ty, indexes, element, keep);
                }
            }
            (Type::Elementary(_) | Type::Struct(_) | Type::Array(_), _) => {
                self.misfit(ty, value.span);
            }
        }
    }

    fn element(&mut self, array: Type, indexes: &[u32], value: &Value, keep: bool) {
        let depth = self.path.len();
        let mut at = array;
        for &index in indexes {
            let Type::Array(id) = at else {
                return self.misfit(array, value.span);
            };
            let def = self.analysis.types.table.array_def(id);
            if index >= def.len {
                self.path.truncate(depth);
                return self.misfit(array, value.span);
            }
            self.path.push(Step::Index(index));
            at = def.element;
        }
        self.value(at, value, keep);
        self.path.truncate(depth);
    }

    fn misfit(&mut self, ty: Type, span: Span) {
        let name = self.analysis.types.table.name(ty);
        let message = format!("this value does not have the shape of its type {name}");
        self.analysis
            .report(Diagnostic::new(Code::E2008, span, message));
    }

    fn scalar(&mut self, ty: Elementary, text: &Name, keep: bool) {
        // What is not kept need not be understood: dates, for one, are no numbers.
        if !keep {
            return;
        }
        match parse_number(&text.node).and_then(|number| bits_of(ty, &number)) {
            Some(bits) => self.leaf(bits, keep),
            None => {
                let message = format!("`{}` is no value of type {}", text.node, ty.name());
                self.analysis
                    .report(Diagnostic::new(Code::E2008, text.span, message));
            }
        }
    }

    fn leaf(&mut self, bits: u64, keep: bool) {
        if keep && bits != 0 {
            self.leaves.push((self.path.clone(), bits));
        }
    }

    /// Text in an array of SINT, the `DATA` of a string.
    fn characters(&mut self, ty: Type, text: &Name, keep: bool) {
        // Text stands between quotes; an empty text may stand without them.
        let quoted = text.node.trim();
        let inner = match quoted {
            "" => Some(""),
            _ => quoted.strip_prefix('\'').and_then(|t| t.strip_suffix('\'')),
        };
        let bytes = inner.and_then(|raw| {
            StringLiteral {
                raw: raw.to_owned(),
            }
            .bytes()
        });
        let lengths = self.analysis.dimensions(ty);
        match (bytes, lengths.as_slice()) {
            (Some(bytes), [len]) if bytes.len() <= *len as usize => {
                for (index, byte) in bytes.into_iter().enumerate() {
                    self.path.push(Step::Index(index as u32));
                    self.leaf(u64::from(byte), keep);
                    self.path.pop();
                }
            }
            _ => self.misfit(ty, text.span),
        }
    }

    /// Raw memory says nothing without the vendor's layout, unless it is all 0. Structures may hold
    /// presets, which a cold start keeps.
    fn image(&mut self, ty: Type, image: &Spanned<Vec<u8>>, keep: bool) {
        let may_matter = keep || !matches!(ty, Type::Elementary(_));
        if may_matter && image.node.iter().any(|byte| *byte != 0) {
            let message = "the value is given as a memory image only, which is not read";
            self.analysis.report(
                Diagnostic::new(Code::E2008, image.span, message)
                    .note("export the project with the option for decorated data"),
            );
        }
    }

    /// The `LEN` and `DATA` of a string tag.
    fn string(&mut self, ty: Type, text: &StringData, keep: bool) {
        let Type::Struct(id) = ty else {
            return self.misfit(ty, text.text.span);
        };
        let def = self.analysis.types.table.struct_def(id);
        let (len, data) = (def.member("LEN"), def.member("DATA"));
        let (Some(len), Some(data)) = (len, data) else {
            return self.misfit(ty, text.text.span);
        };
        let data_ty = def.members[data as usize].ty;
        self.path.push(Step::Field(len));
        self.leaf(u64::from(text.length.unwrap_or(0)), keep);
        self.path.pop();
        self.path.push(Step::Field(data));
        self.characters(data_ty, &text.text, keep);
        self.path.pop();
    }

    /// The bracketed form, in storage order.
    fn list(&mut self, ty: Type, value: &L5kValue, keep: bool) {
        match (ty, value) {
            (Type::Elementary(elementary), L5kValue::Scalar(text)) => {
                self.scalar(elementary, text, keep);
            }
            (Type::Array(_), L5kValue::Scalar(text)) => self.characters(ty, text, keep),
            (Type::Array(id), L5kValue::List(values, _)) => {
                let def = self.analysis.types.table.array_def(id);
                for (index, value) in (0..def.len).zip(values) {
                    self.path.push(Step::Index(index));
                    self.list(def.element, value, keep);
                    self.path.pop();
                }
            }
            (Type::Struct(id), L5kValue::List(values, span)) => {
                self.structure(id, values, *span, keep);
            }
            (Type::Elementary(_) | Type::Struct(_), _) => {
                let span = match value {
                    L5kValue::Scalar(text) => text.span,
                    L5kValue::List(_, span) => *span,
                };
                self.misfit(ty, span);
            }
        }
    }

    fn structure(&mut self, id: StructId, values: &[L5kValue], span: Span, keep: bool) {
        let types = &self.analysis.types;
        let def = types.table.struct_def(id);
        let (kind, members) = (def.kind, def.members.clone());
        let slots = match (kind, types.storage(id)) {
            (StructKind::Text | StructKind::Plain, Some(slots)) => slots.to_vec(),
            // The only predefined one, STRING, holds its members in order.
            (StructKind::Text | StructKind::Plain, None) => {
                (0..members.len() as u32).map(Slot::Member).collect()
            }
            (StructKind::Timer | StructKind::Counter | StructKind::Control, _) => {
                flags_then_numbers(&members)
            }
        };
        if slots.len() != values.len() {
            return self.misfit(Type::Struct(id), span);
        }
        for (slot, value) in slots.iter().zip(values) {
            match slot {
                Slot::Member(index) => {
                    let member = &members[*index as usize];
                    let keep = keep || kept_when_cold(kind, &member.name);
                    self.path.push(Step::Field(*index));
                    self.list(member.ty, value, keep);
                    self.path.pop();
                }
                Slot::Bits(bits) => self.flags(bits, value, keep),
                Slot::Skipped => {}
            }
        }
    }

    fn flags(&mut self, bits: &[(u32, u32)], value: &L5kValue, keep: bool) {
        let (text, span) = match value {
            L5kValue::Scalar(text) => (text.node.as_str(), text.span),
            L5kValue::List(_, span) => ("", *span),
        };
        // Hidden integers are SINT or DINT; their bits fit both.
        let word = parse_number(text).and_then(|number| match number {
            Number::Int { value, .. } => Some(value as u64),
            Number::Real { .. } => None,
        });
        let Some(word) = word else {
            return self.misfit(Type::Elementary(Elementary::Dint), span);
        };
        for &(bit, index) in bits {
            self.path.push(Step::Field(index));
            self.leaf(word >> bit & 1, keep);
            self.path.pop();
        }
    }
}

/// `[flags, PRE, ACC]`: flags from bit 31 downwards, then the numbers.
fn flags_then_numbers(members: &[MemberDef]) -> Vec<Slot> {
    let is_flag = |member: &MemberDef| member.ty == Type::Elementary(Elementary::Bool);
    let shown = || (0..).zip(members).filter(|(_, member)| !member.hidden);
    let flags = shown().filter(|(_, member)| is_flag(member));
    let bits = (0..=31).rev().zip(flags.map(|(index, _)| index)).collect();
    let numbers = shown().filter(|(_, member)| !is_flag(member));
    std::iter::once(Slot::Bits(bits))
        .chain(numbers.map(|(index, _)| Slot::Member(index)))
        .collect()
}

/// Presets and lengths are part of the program rather than of its state.
fn kept_when_cold(kind: StructKind, member: &str) -> bool {
    match kind {
        StructKind::Timer | StructKind::Counter => member == "PRE",
        StructKind::Control => member == "LEN",
        StructKind::Text | StructKind::Plain => false,
    }
}

/// The bits of a number in a type, if it fits.
pub(crate) fn bits_of(ty: Elementary, number: &Number) -> Option<u64> {
    match (ty, number) {
        (
            Elementary::Real,
            Number::Real {
                negative,
                magnitude,
            },
        ) => {
            let value = magnitude.to_f32();
            Some(u64::from(
                (if *negative { -value } else { value }).to_bits(),
            ))
        }
        (
            Elementary::Lreal,
            Number::Real {
                negative,
                magnitude,
            },
        ) => {
            let value = magnitude.to_f64();
            Some((if *negative { -value } else { value }).to_bits())
        }
        (Elementary::Real, Number::Int { value, .. }) => Some(u64::from((*value as f32).to_bits())),
        (Elementary::Lreal, Number::Int { value, .. }) => Some((*value as f64).to_bits()),
        (_, Number::Int { value, bits }) => integer_bits(ty, *value, *bits),
        (_, Number::Real { .. }) => None,
    }
}

/// A bit pattern may fill the whole width; a signed number has to be in range.
fn integer_bits(ty: Elementary, value: i128, pattern: bool) -> Option<u64> {
    let width = ty.bits();
    let top = 1i128 << width;
    let range = if ty.is_signed() && !pattern {
        -(top / 2)..top / 2
    } else {
        0..top
    };
    let mask = u64::MAX >> (64 - width);
    range.contains(&value).then_some(value as u64 & mask)
}
