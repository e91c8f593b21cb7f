//! Values at addresses inside of a structure or array at an address: `%IX0.3` in words from `%IW0`.
//!
//! Members and elements lie one behind the other, BOOLs in a bit each. A value that lies in one
//! element is that element or some of its bits.

use crate::hir::Type;
use crate::hir::code::PathStep;
use crate::st::analysis::Analysis;

impl Analysis<'_> {
    /// The way to `bits` bits at a bit offset of a type, for an integer, bit string or BOOL, or for a
    /// real where `real`; `None` where they are not in one element, or of another kind.
    pub(crate) fn part_of(
        &self,
        ty: Type,
        offset: u64,
        bits: u64,
        real: bool,
    ) -> Option<Vec<PathStep>> {
        let (mut at, mut rest, mut steps) = (ty, offset, Vec::new());
        loop {
            match at {
                Type::Array(id) => {
                    let array = self.hir.types.array_def(id);
                    let width = self.width(array.element);
                    let index = u32::try_from(rest / width).ok()?;
                    if index >= array.len {
                        return None;
                    }
                    steps.push(PathStep::Index(index));
                    (at, rest) = (array.element, rest % width);
                }
                Type::Struct(id) => {
                    let mut found = None;
                    for (field, member) in (0..).zip(&self.hir.types.struct_def(id).members) {
                        let width = self.width(member.ty);
                        if rest < width {
                            found = Some((field, member.ty));
                            break;
                        }
                        rest -= width;
                    }
                    let (field, ty) = found?;
                    steps.push(PathStep::Field(field));
                    at = ty;
                }
                Type::Elementary(of) => {
                    let whole = rest == 0 && bits == u64::from(of.bits());
                    if whole && of.is_float() == real {
                        return Some(steps);
                    }
                    let inside = of.is_integer() && rest + bits <= u64::from(of.bits());
                    if real || !inside {
                        return None;
                    }
                    steps.push(PathStep::Bits {
                        first: rest as u32,
                        count: bits as u32,
                    });
                    return Some(steps);
                }
            }
        }
    }
}
