//! Direct addresses: `%IX0.3`, `%QW4`, `%MD5`.
//!
//! Addresses count units of their own size, the lowest byte first. An address that nothing else
//! overlaps is a tag of its own. Where several overlap, and one structure or array holds all others in
//! its elements, that is the tag; else their bytes are one array of bytes.

mod layout;
mod linked;
mod part;
mod values;

pub(crate) use layout::Addresses;

use super::analysis::Analysis;
use super::elementary::El;
use super::signature::UnitId;
use super::types::TypeId;
use iecc_ast::st::{self, AddressSize, Area, Direct, ExprKind};
use iecc_diag::Code;

/// Some bits of an area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Address {
    /// I, Q or M.
    pub area: Area,
    /// The first bit, counted from the start of the area.
    pub first: u64,
    /// How wide the unit of the address is.
    pub bits: u64,
}

impl Address {
    /// The address in its usual form.
    pub(crate) fn text(self) -> String {
        let letter = letter(self.area);
        match self.bits {
            1 => format!("%{letter}X{}.{}", self.first / 8, self.first % 8),
            8 => format!("%{letter}B{}", self.first / 8),
            16 => format!("%{letter}W{}", self.first / 16),
            32 => format!("%{letter}D{}", self.first / 32),
            _ => format!("%{letter}L{}", self.first / 64),
        }
    }

    /// The type of what has no other.
    pub(crate) fn plain_type(self) -> TypeId {
        TypeId::of(match self.bits {
            1 => El::Bool,
            8 => El::Byte,
            16 => El::Word,
            32 => El::Dword,
            _ => El::Lword,
        })
    }
}

fn letter(area: Area) -> char {
    match area {
        Area::Input => 'I',
        Area::Output => 'Q',
        Area::Memory => 'M',
    }
}

pub(crate) fn unit_bits(size: Option<AddressSize>) -> u64 {
    match size {
        None | Some(AddressSize::Bit) => 1,
        Some(AddressSize::Byte) => 8,
        Some(AddressSize::Word) => 16,
        Some(AddressSize::DoubleWord) => 32,
        Some(AddressSize::LongWord) => 64,
    }
}

impl Analysis<'_> {
    /// The address that is written somewhere; `None` for one that VAR_CONFIG gives, and after a
    /// message.
    pub(crate) fn address(&mut self, unit: UnitId, id: st::Id<st::Expr>) -> Option<Address> {
        let written = self.unit(unit).arena[id];
        let ExprKind::Direct(direct) = written.kind else {
            return None;
        };
        if let Some(resource) = direct.resource
            && !self.outer_names(unit).contains(&resource)
        {
            let span = self.span(unit, written.range);
            let message = format!("no resource is named `{}`", self.text(resource));
            self.error(Code::E1012, span, message);
            return None;
        }
        match self.read_address(unit, direct) {
            Ok(address) => address,
            Err((code, message)) => {
                let span = self.span(unit, written.range);
                self.error(code, span, message);
                None
            }
        }
    }

    fn read_address(
        &self,
        unit: UnitId,
        direct: Direct,
    ) -> Result<Option<Address>, (Code, String)> {
        let Some(area) = direct.area else {
            let message = "an address outside of a structure begins with %I, %Q or %M";
            return Err((Code::E2003, message.to_owned()));
        };
        let Some(fields) = direct.fields else {
            return Ok(None);
        };
        let bits = unit_bits(direct.size);
        let fields = &self.unit(unit).arena[fields];
        let first = match (bits, fields) {
            (1, &[byte, bit]) if bit < 8 => u64::from(byte) * 8 + u64::from(bit),
            (1, &[_, bit]) => {
                let message = format!("a byte has bits 0 to 7, not {bit}");
                return Err((Code::E2003, message));
            }
            (_, &[number]) => u64::from(number) * bits,
            _ => {
                let message = "an address has one number (%IW3), or a byte and a bit (%IX0.5)";
                return Err((Code::E2003, message.to_owned()));
            }
        };
        Ok(Some(Address { area, first, bits }))
    }

    /// The area of an address that VAR_CONFIG gives.
    pub(crate) fn partly_area(&self, unit: UnitId, id: st::Id<st::Expr>) -> Option<Area> {
        let ExprKind::Direct(direct) = self.unit(unit).arena[id].kind else {
            return None;
        };
        direct.area.filter(|_| direct.fields.is_none())
    }

    /// Whether an address is one that VAR_CONFIG gives.
    pub(crate) fn is_partly(&self, unit: UnitId, id: st::Id<st::Expr>) -> bool {
        self.partly_area(unit, id).is_some()
    }

    /// The area of the address that VAR_CONFIG gives a member; others are at a place in the structure.
    pub(crate) fn member_location(&mut self, unit: UnitId, decl: &st::VarDecl) -> Option<Area> {
        let location = decl.location?;
        let written = self.unit(unit).arena[location];
        if let ExprKind::Direct(direct) = written.kind
            && (direct.area.is_none() || direct.fields.is_none())
        {
            // `overlay` looks at places in the structure, which have no area.
            return direct.area;
        }
        let span = self.span(unit, written.range);
        let message = "a member is at a place in the structure (%B4), or at `*`";
        self.error(Code::E2003, span, message);
        None
    }
}
