//! The scalars of a region by the names the text form gives them, and their values as text.

use iecc_ir::{Layout, MemType, Module, Place, Region, Root, Scalar, Type, print_place};

/// A scalar of a region.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Leaf {
    /// Name behind the region's: `t.ACC`, `a[3]`, `"Local:1:I"`.
    pub name: String,
    /// Byte offset.
    pub offset: u64,
    /// Type.
    pub ty: Type,
}

impl Leaf {
    /// Its value in the bytes of the region.
    pub fn get(&self, bytes: &[u8]) -> Scalar {
        Scalar::read(bytes, self.offset as usize, self.ty)
    }

    /// Changes its value in the bytes of the region.
    pub fn set(&self, bytes: &mut [u8], bits: u64) {
        Scalar::new(self.ty, bits).write(bytes, self.offset as usize);
    }
}

/// All scalars of a region in memory order.
pub fn leaves(module: &Module, region: Region) -> Vec<Leaf> {
    let root = match region {
        Region::State => Root::State,
        Region::Input => Root::Input,
        Region::Output => Root::Output,
    };
    let (layout, func) = (Layout::new(&module.types), &module.funcs[module.scan]);
    let mut found = Vec::new();
    layout.for_each_leaf(
        &module.types,
        &Place::root(root),
        MemType::Struct(module.region(region)),
        &mut |place, offset, ty| {
            let text = print_place(module, func, place);
            let (_, name) = text.split_once('.').expect("regions are structs");
            let name = name.to_owned();
            found.push(Leaf { name, offset, ty });
        },
    );
    found
}

/// A scalar or one bit of it, found by name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spot {
    leaf: Leaf,
    bit: Option<u32>,
}

impl Spot {
    /// Finds `t.ACC`, or bit 3 as `t.ACC.3`.
    pub fn find(leaves: &[Leaf], name: &str) -> Option<Self> {
        let named = |name: &str| leaves.iter().find(|leaf| leaf.name == name).cloned();
        if let Some(leaf) = named(name) {
            return Some(Self { leaf, bit: None });
        }
        let (word, bit) = name.rsplit_once('.')?;
        let (leaf, bit) = (named(word)?, bit.parse().ok()?);
        (leaf.ty.is_int() && bit < leaf.ty.bits()).then_some(Self {
            leaf,
            bit: Some(bit),
        })
    }

    /// The type of the value.
    pub fn ty(&self) -> Type {
        self.bit.map_or(self.leaf.ty, |_| Type::I1)
    }

    /// The value in the bytes of the region.
    pub fn get(&self, bytes: &[u8]) -> u64 {
        let word = self.leaf.get(bytes).bits;
        self.bit.map_or(word, |bit| (word >> bit) & 1)
    }

    /// Changes the value in the bytes of the region.
    pub fn set(&self, bytes: &mut [u8], value: u64) {
        let word = self.leaf.get(bytes).bits;
        let word = match self.bit {
            Some(bit) => (word & !(1 << bit)) | (value << bit),
            None => value,
        };
        self.leaf.set(bytes, word);
    }
}

/// Bits as a person writes them: decimal, or hexadecimal where decimal loses something.
pub fn value_text(ty: Type, bits: u64) -> String {
    match ty {
        Type::I1 => bits.to_string(),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => ty.signed(bits).to_string(),
        Type::F32 => float_text(f64::from(f32::from_bits(bits as u32)), bits),
        Type::F64 => float_text(f64::from_bits(bits), bits),
    }
}

fn float_text(number: f64, bits: u64) -> String {
    if number.is_nan() {
        format!("{bits:#x}")
    } else {
        format!("{number:?}")
    }
}

/// The bits of a value in decimal (signed or unsigned) or, for all types, hexadecimal.
pub fn parse_value(ty: Type, text: &str) -> Option<u64> {
    if let Some(digits) = text.strip_prefix("0x") {
        let bits = u64::from_str_radix(digits, 16).ok()?;
        return (bits & !ty.mask() == 0).then_some(bits);
    }
    match ty {
        Type::F32 => text.parse().ok().map(|x: f32| x.to_bits().into()),
        Type::F64 => text.parse().ok().map(f64::to_bits),
        Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => {
            let number: i128 = text.parse().ok()?;
            let (lowest, highest) = (-(i128::from(ty.mask() / 2) + 1), i128::from(ty.mask()));
            let lowest = if ty == Type::I1 { 0 } else { lowest };
            (lowest..=highest)
                .contains(&number)
                .then_some(number as u64 & ty.mask())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_within_their_type() {
        let table = [
            (Type::I1, "1", Some(1)),
            (Type::I1, "-1", None),
            (Type::I1, "2", None),
            (Type::I8, "-128", Some(0x80)),
            (Type::I8, "255", Some(0xff)),
            (Type::I8, "256", None),
            (Type::I8, "-129", None),
            (Type::I16, "0x1ffff", None),
            (Type::I64, "18446744073709551615", Some(u64::MAX)),
            (Type::I64, "-9223372036854775808", Some(1 << 63)),
            (Type::F32, "1.5", Some(0x3fc0_0000)),
            (Type::F32, "0x7fc00000", Some(0x7fc0_0000)),
            (Type::F64, "-0.0", Some(1 << 63)),
            (Type::F64, "x", None),
        ];
        for (ty, text, expected) in table {
            assert_eq!(parse_value(ty, text), expected, "{ty} {text}");
        }
    }
}
