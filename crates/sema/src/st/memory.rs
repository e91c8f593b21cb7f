//! No program takes more memory than a controller could have: variables that would are refused where
//! they are declared, before anything is made that is as large as they are.

use super::analysis::Analysis;
use super::signature::{PouId, Storage};
use super::types::{TypeId, TypeKind};
use iecc_diag::Code;
use iecc_source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// Most bytes that all variables together may take.
pub(crate) const MAX_BYTES: u64 = 64 << 20;

/// Most values that are exchanged by name.
pub(crate) const MAX_POINTS: usize = 1 << 20;

/// What is known of the memory that is needed.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    /// The bytes of types.
    types: FxHashMap<TypeId, u64>,
    /// Types that are complete and not too large.
    known: FxHashSet<TypeId>,
    /// The bytes of all variables that outlive a scan so far.
    total: u64,
}

impl Memory {
    /// Whether a type was found to be complete and not too large.
    pub(crate) fn is_known(&self, ty: TypeId) -> bool {
        self.known.contains(&ty)
    }
}

impl Analysis<'_> {
    /// Whether a variable of a type, which is complete, may be; a message if not.
    pub(crate) fn fits_memory(&mut self, ty: TypeId, span: Span) -> bool {
        let fits = self.types.is_scalar(ty) || self.bytes_of(ty) <= MAX_BYTES;
        if fits {
            self.memory.known.insert(ty);
        } else {
            self.too_large(span, "this variable takes");
        }
        fits
    }

    /// Counts a variable that outlives a scan; a message if there are too many now.
    pub(crate) fn take_memory(&mut self, ty: TypeId, span: Span) {
        let bytes = self.bytes_of(ty);
        let before = self.memory.total;
        self.memory.total = before.saturating_add(bytes);
        if before <= MAX_BYTES && self.memory.total > MAX_BYTES {
            self.too_large(span, "with this, all variables together take");
        }
    }

    fn too_large(&mut self, span: Span, what: &str) {
        let message = format!("{what} more than {MAX_BYTES} bytes");
        self.error(Code::E2007, span, message);
    }

    /// The bytes of the values in a type, each in its own size.
    fn bytes_of(&mut self, ty: TypeId) -> u64 {
        let ty = self.types.strip(ty);
        if let Some(&known) = self.memory.types.get(&ty) {
            return known;
        }
        let bytes = self.count_bytes(ty);
        self.memory.types.insert(ty, bytes);
        bytes
    }

    fn count_bytes(&mut self, ty: TypeId) -> u64 {
        match self.types.base(ty).clone() {
            TypeKind::Elementary(el) | TypeKind::Subrange { base: el, .. } => {
                u64::from(el.bits().div_ceil(8))
            }
            TypeKind::Enum(index) => {
                u64::from(self.types.enums[index as usize].base.bits().div_ceil(8))
            }
            TypeKind::Text { wide, length } => 4 + (1 + u64::from(wide)) * u64::from(length),
            TypeKind::Array {
                dimensions,
                element,
            } => {
                let element = self.bytes_of(element);
                let extents = dimensions.iter().map(|(low, high)| high.abs_diff(*low) + 1);
                extents.fold(element, u64::saturating_mul)
            }
            TypeKind::Struct(index) => {
                let def = &self.types.structs[index as usize];
                if let Some(overlay) = &def.overlay {
                    return u64::from(overlay.bytes);
                }
                let members: Vec<TypeId> = def.members.iter().map(|member| member.ty).collect();
                self.sum_of_bytes(members)
            }
            TypeKind::Instance(pou) => self.instance_bytes(pou),
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::OpenArray { .. }
            | TypeKind::Interface(_)
            | TypeKind::Reference(..)
            | TypeKind::Alias(_) => 8,
        }
    }

    fn instance_bytes(&mut self, pou: PouId) -> u64 {
        let lineage = self.lineage(pou);
        let vars = lineage.iter().flat_map(|pou| &self.pou(*pou).vars);
        let stored = vars.filter(|var| matches!(var.storage, Storage::Field(_)));
        let types = stored.map(|var| var.ty).collect();
        self.sum_of_bytes(types)
    }

    fn sum_of_bytes(&mut self, types: Vec<TypeId>) -> u64 {
        let bytes = types.into_iter().map(|ty| self.bytes_of(ty));
        bytes.fold(0, u64::saturating_add)
    }
}
