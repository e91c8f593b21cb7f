//! What may be done with variables, from inside and from outside of their units.

use crate::st::body::Rights;
use crate::st::signature::Var;
use iecc_ast::st::SectionKind;

/// What a unit may do with its own variable.
pub(super) fn own_rights(var: &Var) -> Rights {
    if var.constant {
        return Rights::Constant;
    }
    match var.section {
        SectionKind::Input => Rights::OwnInput,
        SectionKind::Var
        | SectionKind::Output
        | SectionKind::InOut
        | SectionKind::Temp
        | SectionKind::External
        | SectionKind::Global
        | SectionKind::Access
        | SectionKind::Config
        | SectionKind::Static
        | SectionKind::Instance => Rights::All,
    }
}

/// What others may do with a variable of an instance.
pub(super) fn outside_rights(var: &Var) -> Rights {
    if var.constant && var.section != SectionKind::Input {
        return Rights::Constant;
    }
    match var.section {
        SectionKind::Output => Rights::OtherOutput,
        SectionKind::Var
        | SectionKind::Input
        | SectionKind::InOut
        | SectionKind::Temp
        | SectionKind::External
        | SectionKind::Global
        | SectionKind::Access
        | SectionKind::Config
        | SectionKind::Static
        | SectionKind::Instance => Rights::All,
    }
}
