//! What may be done with variables, from inside and from outside of their units.

use crate::st::body::{Body, Rights};
use crate::st::signature::{Storage, Var};
use iecc_ast::st::{Direction, PouKind, SectionKind};

impl Body<'_, '_> {
    /// What a unit may do with its own variable. In CODESYS its inputs are as good as its other
    /// variables, unless they are not its own: those of a program come from outside, and arrays, structures
    /// and strings of a function are those of the caller.
    pub(super) fn own_rights(&self, var: &Var) -> Rights {
        if var.constant {
            return Rights::Constant;
        }
        let shared = matches!(var.storage, Storage::Ref(_) | Storage::Located(_));
        let changed = self.an.options.codesys && !shared && !self.is_in_program();
        match var.section.direction() {
            Some(Direction::In) if !changed => Rights::OwnInput,
            Some(Direction::In | Direction::Out | Direction::InOut) | None => Rights::All,
        }
    }

    fn is_in_program(&self) -> bool {
        let home = self.pou.map(|pou| self.an.pou(pou).owner.unwrap_or(pou));
        home.is_some_and(|home| self.an.pou(home).kind == PouKind::Program)
    }
}

/// What others may do with a variable of an instance.
pub(super) fn outside_rights(var: &Var) -> Rights {
    if var.constant && var.section != SectionKind::Input {
        return Rights::Constant;
    }
    match var.section.direction() {
        Some(Direction::Out) => Rights::OtherOutput,
        Some(Direction::In | Direction::InOut) | None => Rights::All,
    }
}
