//! Counters that make ticks out of the clock.

use super::{Emitter, TICK, TICK_FRACTION, unit_text};
use crate::design::StepUnit;
use crate::emit::expression::constant;
use std::fmt::{self, Write};

impl Emitter<'_> {
    pub(super) fn dividers(&mut self) -> fmt::Result {
        let units = &self.design.units;
        if units.is_empty() {
            return Ok(());
        }
        if units.iter().any(|unit| unit.divider.whole > 0) {
            writeln!(
                self.out,
                "\n    // No time has passed in the first scan.\n    reg started;\n\n    \
                 always @(posedge clk)\n        started <= ~rst;"
            )?;
        }
        for (index, unit) in units.iter().enumerate() {
            self.divider(index, unit)?;
        }
        Ok(())
    }

    fn divider(&mut self, index: usize, unit: &StepUnit) -> fmt::Result {
        let name = self.ticks[index].clone();
        let text = unit_text(unit.unit_ns);
        let divider = unit.divider;
        writeln!(
            self.out,
            "\n    // {name}: boundaries of {text} passed since the scan before."
        )?;
        if divider.numerator > 0 {
            self.wrap(index, unit)?;
        }
        if divider.whole == 0 {
            if unit.net.is_none() {
                return Ok(());
            }
            return writeln!(
                self.out,
                "    reg {name};\n\n    always @(posedge clk)\n        {name} <= ~rst & {name}_wrap;"
            );
        }
        if divider.is_tick() {
            return writeln!(self.out, "    wire {name} = started;");
        }
        let width = 64 - divider.max_step().leading_zeros();
        let whole = constant(width, u128::from(divider.whole));
        let zero = constant(width, 0);
        if divider.numerator == 0 {
            return writeln!(
                self.out,
                "    wire [{}:0] {name} = started ? {whole} : {zero};",
                width - 1
            );
        }
        let pad = if width > 1 {
            format!("{{{}, {name}_more}}", constant(width - 1, 0))
        } else {
            format!("{name}_more")
        };
        writeln!(
            self.out,
            "    reg {name}_more;\n\n    always @(posedge clk)\n        {name}_more <= ~rst & {name}_wrap;\n\n    \
             wire [{}:0] {name} = started ? {whole} + {pad} : {zero};",
            width - 1
        )
    }

    /// The counter whose `wrap` marks a boundary.
    fn wrap(&mut self, index: usize, unit: &StepUnit) -> fmt::Result {
        let name = self.ticks[index].clone();
        let divider = unit.divider;
        let (period, enable) = match unit.counts {
            Some((base, times)) => (times, format!("{}_wrap", self.ticks[base])),
            None => (divider.denominator, "1'b1".to_owned()),
        };
        let width = (64 - (period - 1).leading_zeros()).max(2);
        let number = |n: u64| constant(width, u128::from(n));
        writeln!(self.out, "    wire {name}_wrap;")?;
        if unit.counts.is_some() || divider.numerator == 1 {
            self.runtime.insert(TICK);
            return writeln!(
                self.out,
                "    iecc_tick #(.WIDTH({width}), .LAST({})) {name}_divider (\n        \
                 .clk(clk), .rst(rst), .enable({enable}), .wrap({name}_wrap)\n    );",
                number(period - 1)
            );
        }
        self.runtime.insert(TICK_FRACTION);
        writeln!(
            self.out,
            "    iecc_tick_fraction #(.WIDTH({width}), .ADD({}), .REST({})) {name}_divider (\n        \
             .clk(clk), .rst(rst), .wrap({name}_wrap)\n    );",
            number(divider.numerator),
            number(divider.denominator - divider.numerator)
        )
    }
}
