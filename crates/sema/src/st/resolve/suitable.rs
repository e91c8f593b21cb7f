//! Whether what a variable is goes with where it is declared.

use crate::st::analysis::Analysis;
use crate::st::signature::{PouId, Var};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{PouKind, SectionKind};
use iecc_diag::Code;

impl Analysis<'_> {
    /// Instances change and outlast a call: they are no constants, and not in functions.
    pub(crate) fn check_place_of_instance(&mut self, id: PouId, var: &Var) {
        if !self.holds_instance(var.ty) {
            return;
        }
        let inner = matches!(var.section, SectionKind::Var | SectionKind::Temp);
        let pou = self.pou(id);
        let lost = pou.kind == PouKind::Function && pou.owner.is_none() && inner;
        let what = if var.constant {
            "as a constant: it could not run"
        } else if lost && !self.options.codesys {
            "in a function, which keeps nothing from call to call"
        } else {
            return;
        };
        let span = self.span(self.pou(id).unit, var.range);
        let name = self.type_name(var.ty);
        self.error(Code::E2022, span, format!("{name} cannot stand {what}"));
    }

    /// Whether a type is a block or class, or an array of such.
    fn holds_instance(&self, ty: TypeId) -> bool {
        let mut at = ty;
        while let TypeKind::Array { element, .. } = self.types.base(at) {
            at = *element;
        }
        matches!(self.types.base(at), TypeKind::Instance(_))
    }
}
