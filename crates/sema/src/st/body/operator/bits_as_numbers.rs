//! Bit strings as numbers (CODESYS): BYTE, WORD, DWORD and LWORD count like the unsigned integers of
//! their width. What loses nothing happens without being asked; what could is still to be asked for.

use crate::st::body::{Body, Operand};
use crate::st::elementary::El;
use crate::st::types::TypeId;

impl Body<'_, '_> {
    /// Whether a value becomes one of another type without being asked.
    pub(crate) fn widens(&self, from: El, to: El) -> bool {
        if from.widens_to(to) {
            return true;
        }
        let alike = |a: El, b: El| a == b || a.widens_to(b);
        self.an.options.codesys
            && (from.is_bits() || to.is_bits())
            && from != El::Bool
            && to != El::Bool
            && alike(counts_as(from), counts_as(to))
    }

    /// The type both operands of an operator become.
    pub(crate) fn common(&self, a: El, b: El) -> Option<El> {
        if let Some(common) = a.common(b) {
            return Some(common);
        }
        if !self.an.options.codesys || a == El::Bool || b == El::Bool {
            return None;
        }
        counts_as(a).common(counts_as(b))
    }

    /// Whether values of a type are whole numbers.
    pub(crate) fn counts(&self, el: El) -> bool {
        el.is_int() || (self.an.options.codesys && el.is_bits() && el != El::Bool)
    }

    /// Whether an operand is a whole number, or a literal that may be one.
    pub(crate) fn is_whole(&self, operand: &Operand) -> bool {
        let el = self.an.types.elementary(operand.ty);
        operand.ty == TypeId::UNTYPED_INT || el.is_some_and(|el| self.counts(el))
    }
}

/// The number with the bits of a bit string; others as they are.
pub(crate) fn counts_as(el: El) -> El {
    if !el.is_bits() || el == El::Bool {
        return el;
    }
    match el.bits() {
        8 => El::Usint,
        16 => El::Uint,
        32 => El::Udint,
        _ => El::Ulint,
    }
}
