//! Equality of reals that were computed: rounding decides whether it holds. Comparing a variable with
//! another one, or with a number that is exact in binary, is a test for change or for a mark.

use crate::hir::CompareOp;
use crate::hir::code::{ExprId, ExprKind};
use crate::st::body::Body;
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// Warns where two reals, of which one is rounded, are compared for equality.
    pub(in crate::st) fn real_equality(
        &mut self,
        op: CompareOp,
        left: ExprId,
        right: ExprId,
        range: TextRange,
    ) {
        let equality = matches!(op, CompareOp::Equal | CompareOp::NotEqual);
        if !equality || self.an.is_library(self.unit) {
            return;
        }
        if self.is_rounded(left) || self.is_rounded(right) {
            let span = self.an.span(self.unit, range);
            let message = "this compares a rounded real for equality";
            let diagnostic = Diagnostic::new(Code::E3054, span, message)
                .note("test whether the magnitude of the difference is small");
            self.an.warn(diagnostic);
        }
    }

    fn is_rounded(&self, value: ExprId) -> bool {
        match self.code.expr(value).kind {
            ExprKind::Binary(..) => true,
            ExprKind::Unary(_, operand) => self.is_rounded(operand),
            ExprKind::Const(_)
            | ExprKind::Load(_)
            | ExprKind::Compare(..)
            | ExprKind::Convert(..)
            | ExprKind::Select(..)
            | ExprKind::Choose(..)
            | ExprKind::Within { .. }
            | ExprKind::Call(_)
            | ExprKind::After(..)
            | ExprKind::Address(_)
            | ExprKind::Exists(_)
            | ExprKind::Now
            | ExprKind::Elapsed(_)
            | ExprKind::ElapsedUnits(_) => false,
        }
    }
}
