//! What belongs to the CODESYS dialect is refused in the others, with the switch that allows it.

use super::analysis::Analysis;
use super::signature::UnitId;
use iecc_ast::st::{BinaryOp, Expr, ExprKind, TypeDecl, TypeKind, TypeSpec, UnitKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;

impl Analysis<'_> {
    /// Looks through the nodes of every unit of the user.
    pub(crate) fn check_dialect(&mut self) {
        if self.options.codesys {
            return;
        }
        for index in self.first_user_unit..self.units.len() as u32 {
            for (range, what) in self.foreign(UnitId(index)) {
                let span = self.span(UnitId(index), range);
                let message = format!("{what} belongs to the CODESYS dialect");
                let diagnostic = Diagnostic::new(Code::E8001, span, message);
                self.report(diagnostic.note("`--dialect codesys` allows it"));
            }
        }
    }

    fn foreign(&self, unit: UnitId) -> Vec<(TextRange, &'static str)> {
        let unit = self.unit(unit);
        let arena = &unit.arena;
        let mut found = Vec::new();
        if let UnitKind::Globals(section) = &unit.kind {
            found.push((section.range, "VAR_GLOBAL outside of a CONFIGURATION"));
        }
        for expr in arena.all::<Expr>() {
            if let ExprKind::Binary {
                op: op @ (BinaryOp::AndThen | BinaryOp::OrElse),
                ..
            } = expr.kind
            {
                found.push((expr.range, op.as_str()));
            }
        }
        for ty in arena.all::<TypeSpec>() {
            let what = match ty.kind {
                TypeKind::PointerTo(_) => "POINTER TO",
                TypeKind::ReferenceTo(_) => "REFERENCE TO",
                TypeKind::Sized { round: true, .. } => "a length in round brackets",
                _ => continue,
            };
            found.push((ty.range, what));
        }
        for decl in arena.all::<TypeDecl>() {
            if decl.extends.is_some() {
                found.push((decl.range, "EXTENDS of a structure"));
            }
        }
        found
    }
}
