//! Durations, dates and times of day: where they stand, and what is reported about them.

use super::Build;
use iecc_ast::st::time::nanoseconds;
use iecc_ast::st::{Expr, ExprKind, Id, Literal, TimeKind, TimeLiteral, TimeShape};
use iecc_diag::{Code, Diagnostic};

impl Build<'_, '_> {
    pub(crate) fn time(&mut self, start: u32, end: u32) -> Id<Expr> {
        let text = self.text(start, end);
        let (prefix, value) = text.split_once('#').expect("the token has a number sign");
        let kind = TimeKind::of_prefix(prefix).expect("the lexer knows the prefix");
        match nanoseconds(kind.shape(), value) {
            Ok(ns) => self.literal(start, Literal::Time(TimeLiteral { kind, ns }), end),
            Err(message) => {
                let code = match kind.shape() {
                    TimeShape::Duration => Code::E0021,
                    TimeShape::Date | TimeShape::Clock | TimeShape::DateAndClock => Code::E0022,
                };
                let span = self.span(start, end);
                let diagnostic = Diagnostic::new(code, span, message)
                    .label(format!("expected something like `{}`", example(kind)));
                self.report(diagnostic);
                self.expr(start, ExprKind::Error, end)
            }
        }
    }
}

fn example(kind: TimeKind) -> String {
    let value = match kind.shape() {
        TimeShape::Duration => "1h30m1s500ms",
        TimeShape::Date => "2024-02-29",
        TimeShape::Clock => "12:30:00.5",
        TimeShape::DateAndClock => "2024-02-29-12:30:00.5",
    };
    format!("{}#{value}", kind.prefix())
}
