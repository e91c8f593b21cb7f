//! CASE: whole numbers and enumerators by their labels, strings and reals by comparisons.

use crate::hir::code::{ExprKind, StmtKind};
use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::types::TypeId;
use iecc_ast::st::{self};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    pub(super) fn case(
        &mut self,
        selector: st::Id<st::Expr>,
        arms: st::List<st::CaseArm>,
        otherwise: Option<st::Block>,
    ) -> Option<StmtKind> {
        let operand = self.expr(selector, None);
        let ty = self.settle(&operand);
        let compared =
            self.an.types.is_text(ty) || self.an.types.elementary(ty).is_some_and(El::is_real);
        if compared && !operand.is_error() {
            return Some(self.case_by_comparison(operand, arms, otherwise));
        }
        let types = &self.an.types;
        let whole =
            types.enumeration(ty).is_some() || types.elementary(ty).is_some_and(|el| !el.is_real());
        if !whole && !operand.is_error() {
            let message = format!(
                "CASE takes whole numbers and enumerators, not {}",
                self.type_name(ty)
            );
            self.error(Message::E3010, operand.range, message);
        }
        let known = whole && !operand.is_error();
        let ty = if known { ty } else { TypeId::ERROR };
        let selector = if known {
            self.raw(&operand)
        } else {
            self.add_const(0, crate::hir::Elementary::Dint, operand.range)
        };
        let mut made = Vec::with_capacity(arms.len());
        let mut taken: Vec<(i128, i128, TextRange)> = Vec::new();
        for arm in &self.arena()[arms] {
            let mut ranges = Vec::with_capacity(arm.labels.len());
            for label in &self.arena()[arm.labels] {
                if let Some((low, high, range)) = self.label(label, ty) {
                    self.overlap(&mut taken, low, high, range);
                    let bits = |value: i128| Const::Int(value);
                    let (low, high) = (bits(low), bits(high));
                    ranges.push((self.const_bits(&low, ty), self.const_bits(&high, ty)));
                }
            }
            made.push((ranges, self.block(arm.body)));
        }
        if otherwise.is_none() {
            self.missing_enumerators(ty, &taken, operand.range);
        }
        Some(StmtKind::Case {
            selector,
            arms: made,
            otherwise: otherwise.map_or_else(Vec::new, |block| self.block(block)),
        })
    }

    /// Warns of a CASE without ELSE that leaves out values of its enumeration.
    fn missing_enumerators(
        &mut self,
        ty: TypeId,
        taken: &[(i128, i128, TextRange)],
        range: TextRange,
    ) {
        let Some(def) = self.an.types.enumeration(ty) else {
            return;
        };
        let is_taken = |value: i128| {
            taken
                .iter()
                .any(|(low, high, _)| (*low..=*high).contains(&value))
        };
        let missing = def.values.iter().filter(|(_, value)| !is_taken(*value));
        let names: Vec<&str> = missing.map(|(name, _)| self.text(*name)).collect();
        if def.named_values || names.is_empty() || self.an.is_library(self.unit) {
            return;
        }
        let message = format!("nothing is done for `{}`", names.join("`, `"));
        let diagnostic = Diagnostic::new(Message::E3053, self.span(range), message)
            .note("ELSE with `;` says that nothing is meant");
        self.an.warn(diagnostic);
    }

    /// CASE of strings and reals: labels are compared in their order.
    fn case_by_comparison(
        &mut self,
        selector: Operand,
        arms: st::List<st::CaseArm>,
        otherwise: Option<st::Block>,
    ) -> StmtKind {
        let selector = self.hold(selector);
        let mut made = Vec::with_capacity(arms.len());
        for arm in &self.arena()[arms] {
            let outer = std::mem::take(&mut self.pending);
            let mut condition: Option<Operand> = None;
            for label in &self.arena()[arm.labels] {
                let next = self.label_condition(&selector, label);
                condition = Some(match condition {
                    None => next,
                    Some(before) => {
                        let range = next.range;
                        self.binary_on(st::BinaryOp::Or, before, next, range, None)
                    }
                });
            }
            let condition = condition.unwrap_or_else(|| Operand::error(arm.range));
            let mut value = self.condition(&condition);
            let inner = std::mem::replace(&mut self.pending, outer);
            if !inner.is_empty() {
                let kind = ExprKind::After(inner, value);
                value = self.add_expr(kind, crate::hir::Elementary::Bool, arm.range);
            }
            made.push((value, self.block(arm.body)));
        }
        StmtKind::If {
            arms: made,
            otherwise: otherwise.map_or_else(Vec::new, |block| self.block(block)),
        }
    }

    fn label_condition(&mut self, selector: &Operand, label: &st::Label) -> Operand {
        let low = self.expr(label.low, Some(selector.ty));
        let range = low.range;
        let Some(high) = label.high else {
            return self.binary_on(st::BinaryOp::Equal, selector.clone(), low, range, None);
        };
        let high = self.expr(high, Some(selector.ty));
        let above = st::BinaryOp::GreaterEqual;
        let above = self.binary_on(above, selector.clone(), low, range, None);
        let below = self.binary_on(st::BinaryOp::LessEqual, selector.clone(), high, range, None);
        self.binary_on(st::BinaryOp::And, above, below, range, None)
    }

    /// The first and last value of a label.
    fn label(&mut self, label: &st::Label, ty: TypeId) -> Option<(i128, i128, TextRange)> {
        let arena = self.arena();
        let mut range = arena[label.low].range;
        let low = self.label_value(label.low, ty);
        let high = match label.high {
            None => low,
            Some(high) => {
                range = range.to(arena[high].range);
                self.label_value(high, ty)
            }
        };
        let (low, high) = (low?, high?);
        if low > high {
            let message = format!("the range begins at {low}, above its end {high}");
            self.error(Message::E2023, range, message);
            return None;
        }
        Some((low, high, range))
    }

    fn label_value(&mut self, id: st::Id<st::Expr>, ty: TypeId) -> Option<i128> {
        let operand = self.expr(id, (ty != TypeId::ERROR).then_some(ty));
        if operand.is_error() || ty == TypeId::ERROR {
            return None;
        }
        if operand.as_const().is_none() {
            self.error(Message::E2030, operand.range, "a label is a constant");
            return None;
        }
        // Labels of a subrange may be any values of its base.
        let subrange = self.an.types.subrange(ty);
        let ty = subrange.map_or(ty, |(base, _)| TypeId::of(base));
        self.constant_to(&operand, ty)?.as_int()
    }

    fn overlap(
        &mut self,
        taken: &mut Vec<(i128, i128, TextRange)>,
        low: i128,
        high: i128,
        range: TextRange,
    ) {
        let at = taken.partition_point(|(_, last, _)| *last < low);
        if let Some(&(first, _, other)) = taken.get(at)
            && first <= high
        {
            let diagnostic = Diagnostic::new(
                Message::E3011,
                self.span(range),
                "another label stands for this value",
            );
            let other = self.span(other);
            self.report(diagnostic.also(other, "here first"));
            return;
        }
        taken.insert(at, (low, high, range));
    }
}
