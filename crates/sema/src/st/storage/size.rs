//! How many bytes variables take, for SIZEOF (CODESYS): those of the layout that all engines share.
//! Values are aligned to their own sizes, members lie in their order, and a structure ends at a
//! multiple of its largest alignment. BOOL takes one byte, times and dates take eight.

use crate::hir::Type;
use crate::st::analysis::Analysis;
use crate::st::types::{Parts, TypeId, TypeKind};
use iecc_source::Span;

impl Analysis<'_> {
    /// The bytes of a type, or why they are not told.
    pub(crate) fn size_of(&mut self, ty: TypeId) -> Result<u64, &'static str> {
        if matches!(
            self.types.base(ty),
            TypeKind::Error | TypeKind::Nothing | TypeKind::OpenArray { .. }
        ) {
            return Err("it has no size of its own");
        }
        if let Some(why) = self.packed_inside(ty) {
            return Err(why);
        }
        let inside = self.complete_contained(ty, self.nowhere());
        if inside == TypeId::ERROR {
            return Err("it contains itself");
        }
        let storage = self.storage(ty);
        Ok(self.extent_of(storage).0)
    }

    fn nowhere(&self) -> Span {
        Span::point(self.units[0].unit.file, 0)
    }

    /// Size and alignment. Recursion is bounded by the nesting of types.
    fn extent_of(&self, ty: Type) -> (u64, u64) {
        match ty {
            Type::Elementary(elementary) => {
                let bytes = u64::from(elementary.bits().div_ceil(8));
                (bytes, bytes)
            }
            Type::Array(id) => {
                let array = self.hir.types.array_def(id);
                let (size, align) = self.extent_of(array.element);
                (size.saturating_mul(u64::from(array.len)), align)
            }
            Type::Struct(id) => {
                let (mut size, mut align) = (0u64, 1);
                for member in &self.hir.types.struct_def(id).members {
                    let (bytes, own) = self.extent_of(member.ty);
                    size = size.next_multiple_of(own).saturating_add(bytes);
                    align = align.max(own);
                }
                (size.next_multiple_of(align), align)
            }
        }
    }

    /// Why the size in CODESYS would be another one, if it is.
    fn packed_inside(&self, ty: TypeId) -> Option<&'static str> {
        if let TypeKind::Alias(index) = self.types.kind(ty) {
            let alias = &self.types.aliases[*index as usize];
            if alias.name == self.words.bit {
                return Some("a BIT takes a whole byte here, and one bit in CODESYS");
            }
            return self.packed_inside(alias.base);
        }
        match self.types.parts(ty) {
            Parts::Elements { element, .. } => self.packed_inside(element),
            Parts::Members(def) => {
                if def.packed {
                    return Some("its attribute 'pack_mode' is not heeded");
                }
                def.members.iter().find_map(|m| self.packed_inside(m.ty))
            }
            Parts::Variables(_) | Parts::None => None,
        }
    }
}
