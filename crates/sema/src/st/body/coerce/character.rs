//! Characters as strings of one character: where a string is needed, a character will do.

use crate::st::body::{Body, Operand};
use crate::st::elementary::El;
use crate::st::types::{TypeId, TypeKind};

impl Body<'_, '_> {
    /// A character as a string, where a string of such characters is needed.
    pub(crate) fn character_as_text(&mut self, operand: &Operand, to: TypeId) -> Option<Operand> {
        let TypeKind::Text { wide, .. } = *self.an.types.base(to) else {
            return None;
        };
        let known = operand.as_const().is_some();
        (!known && self.character_width(operand) == Some(wide))
            .then(|| self.character_text(operand))
    }

    /// Whether a character is a wide one; `None` if it is no character.
    pub(crate) fn character_width(&self, operand: &Operand) -> Option<bool> {
        let el = self.an.types.elementary(operand.ty)?;
        let known = [(El::Char, false), (El::Wchar, true)];
        let found = known.into_iter().find(|(character, _)| *character == el);
        found.map(|(_, wide)| wide)
    }

    /// A character as a string.
    pub(crate) fn character_text(&mut self, operand: &Operand) -> Operand {
        let wide = self.character_width(operand) == Some(true);
        let name = if wide { "TO_WSTRING" } else { "TO_STRING" };
        self.stdlib_call(name, vec![operand.clone()], operand.range, None)
    }
}
