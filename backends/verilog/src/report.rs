//! What the hardware consists of and why: for people as text, for programs as JSON. Both are
//! written from the same facts.

use crate::design::{Design, Purpose, Register, StepUnit};
use crate::emit::module::{ModuleText, unit_text};
use crate::options::Options;
use iecc_ir::analysis::Range;
use serde_json::{Value, json};
use std::fmt::Write;

/// The text and the JSON report.
pub(crate) fn report(design: &Design, text: &ModuleText, options: &Options) -> (String, String) {
    let facts = Facts::new(design, text, options);
    let json = serde_json::to_string_pretty(&facts.json()).expect("plain data");
    (facts.text(), json + "\n")
}

struct Facts<'a> {
    design: &'a Design,
    text: &'a ModuleText,
    options: &'a Options,
    synchroniser_bits: u32,
    divider_bits: u32,
}

/// A register with its words.
struct Row<'a> {
    name: &'a str,
    tag: &'a str,
    width: u32,
    range: Range,
    initial: i64,
    reason: String,
}

impl<'a> Facts<'a> {
    fn new(design: &'a Design, text: &'a ModuleText, options: &'a Options) -> Self {
        let read = design.inputs.iter().filter(|input| input.net.is_some());
        let bits: u32 = read.map(|input| input.port.ty.bits()).sum();
        Self {
            design,
            text,
            options,
            synchroniser_bits: if options.synchronisers { 2 * bits } else { 0 },
            divider_bits: divider_bits(&design.units),
        }
    }

    fn state_bits(&self) -> u32 {
        self.design.registers.iter().map(Register::width).sum()
    }

    fn edges(&self) -> u32 {
        if self.options.synchronisers { 3 } else { 1 }
    }

    fn rows(&self) -> Vec<Row<'_>> {
        let pairs = self.design.registers.iter().zip(&self.text.registers);
        pairs
            .map(|(register, name)| Row {
                name,
                tag: &register.tag,
                width: register.width(),
                range: register.range,
                initial: if register.width() == 1 && !register.signed() {
                    register.initial as i64
                } else {
                    register.ty.signed(register.initial)
                },
                reason: self.reason(register),
            })
            .collect()
    }

    fn reason(&self, register: &Register) -> String {
        let ty = register.ty;
        match &register.purpose {
            Purpose::Output(_) => "publishes an output that no state register equals".to_owned(),
            Purpose::State(place) => match self.options.reasons.get(place) {
                Some(reason) => reason.clone(),
                None if ty.bits() == 1 => "a bit".to_owned(),
                None if register.width() == ty.bits() => {
                    format!("nothing narrower than {ty} is known to hold it")
                }
                None => {
                    let Range { lo, hi } = register.range;
                    format!("{ty} that is never outside {lo} .. {hi}")
                }
            },
        }
    }

    fn json(&self) -> Value {
        let design = self.design;
        let inputs = design
            .inputs
            .iter()
            .zip(&self.text.inputs)
            .map(|(input, name)| {
                json!({
                    "name": input.port.name, "port": name, "bits": input.port.ty.bits(),
                    "read": input.net.is_some(),
                })
            });
        let outputs = design
            .outputs
            .iter()
            .zip(&self.text.outputs)
            .map(|(output, name)| {
                json!({
                    "name": output.port.name, "port": name, "bits": output.port.ty.bits(),
                    "register": output.register.map(|index| &self.text.registers[index]),
                })
            });
        let registers = self.rows().into_iter().map(|row| {
            json!({
                "name": row.name, "tag": row.tag, "bits": row.width, "initial": row.initial,
                "lowest": row.range.lo, "highest": row.range.hi, "reason": row.reason,
            })
        });
        let dividers = design.units.iter().map(
            |unit| json!({ "unit_ns": unit.unit_ns, "how": divider_words(unit, &design.units) }),
        );
        json!({
            "module": self.text.name,
            "clock": self.options.clock.to_string(),
            "clocks_per_scan": 1,
            "edges_input_to_output": self.edges(),
            "state_bits": self.state_bits(),
            "synchroniser_bits": self.synchroniser_bits,
            "divider_bits": self.divider_bits,
            "inputs": inputs.collect::<Vec<_>>(),
            "outputs": outputs.collect::<Vec<_>>(),
            "registers": registers.collect::<Vec<_>>(),
            "dividers": dividers.collect::<Vec<_>>(),
            "constants": self.constants().iter().map(|(tag, value)| json!({ "tag": tag, "value": value })).collect::<Vec<_>>(),
            "unseen": design.unseen,
        })
    }

    /// What the passes folded and what never changes.
    fn constants(&self) -> Vec<(String, String)> {
        let fixed = self.design.fixed.iter();
        let fixed = fixed.map(|(tag, value)| (tag.clone(), value.to_string()));
        let mut all: Vec<_> = self
            .options
            .constants
            .iter()
            .cloned()
            .chain(fixed)
            .collect();
        all.sort();
        all.dedup();
        all
    }

    fn text(&self) -> String {
        let mut out = String::new();
        self.summary(&mut out);
        self.ports(&mut out);
        self.registers(&mut out);
        self.dividers(&mut out);
        self.folded(&mut out);
        out
    }

    fn summary(&self, out: &mut String) {
        let total = self.state_bits() + self.synchroniser_bits + self.divider_bits;
        line(out, &format!("Hardware of {}", self.text.name));
        line(out, "");
        for (what, value) in [
            ("clock", self.options.clock.to_string()),
            ("clocks per scan", "1".to_owned()),
            ("clock edges from input to output", self.edges().to_string()),
            ("register bits", total.to_string()),
            ("  state and outputs", self.state_bits().to_string()),
            ("  input synchronisers", self.synchroniser_bits.to_string()),
            ("  tick dividers", self.divider_bits.to_string()),
        ] {
            line(out, &format!("{what:<34}{value:>10}"));
        }
    }

    fn ports(&self, out: &mut String) {
        line(out, "\nInputs");
        for (input, name) in self.design.inputs.iter().zip(&self.text.inputs) {
            let kept = if input.net.is_some() {
                ""
            } else {
                ", not read"
            };
            let bits = input.port.ty.bits();
            line(
                out,
                &format!("  {name}: {}, {bits} bit{kept}", input.port.name),
            );
        }
        line(out, "\nOutputs");
        for (output, name) in self.design.outputs.iter().zip(&self.text.outputs) {
            let from = match output.register {
                Some(index) if self.text.registers[index] == *name => "a register".to_owned(),
                Some(index) => format!("register {}", self.text.registers[index]),
                None => "always 0".to_owned(),
            };
            let bits = output.port.ty.bits();
            line(
                out,
                &format!("  {name}: {}, {bits} bit, {from}", output.port.name),
            );
        }
    }

    fn registers(&self, out: &mut String) {
        line(
            out,
            "\nRegisters (bits, name, tag, initial value, why so wide)",
        );
        for row in self.rows() {
            let Row {
                name,
                tag,
                width,
                initial,
                reason,
                ..
            } = row;
            line(
                out,
                &format!("  {width:>2}  {name}: {tag}, {initial}; {reason}"),
            );
        }
    }

    fn dividers(&self, out: &mut String) {
        if self.design.units.is_empty() {
            return;
        }
        line(out, "\nTick dividers");
        for unit in &self.design.units {
            let words = divider_words(unit, &self.design.units);
            line(out, &format!("  {}: {words}", unit_text(unit.unit_ns)));
        }
    }

    fn folded(&self, out: &mut String) {
        let constants = self.constants();
        if !constants.is_empty() {
            line(out, "\nConstants: no register, no logic");
        }
        for (tag, value) in constants {
            line(out, &format!("  {tag} = {value}"));
        }
        if !self.design.unseen.is_empty() {
            line(out, "\nLeft out: reaches no output");
        }
        for tag in &self.design.unseen {
            line(out, &format!("  {tag}"));
        }
    }
}

fn line(out: &mut String, text: &str) {
    writeln!(out, "{text}").expect("writing to a string");
}

fn divider_words(unit: &StepUnit, units: &[StepUnit]) -> String {
    let divider = unit.divider;
    if let Some((base, times)) = unit.counts {
        return format!("every {times} ticks of {}", unit_text(units[base].unit_ns));
    }
    match (divider.whole, divider.numerator) {
        (0, 1) => format!("every {} clocks, exactly", divider.denominator),
        (0, add) => format!("{add} ticks in {} clocks, exactly", divider.denominator),
        (whole, 0) => format!("{whole} in every clock"),
        (whole, add) => format!(
            "{whole} in every clock and {add} more in {} clocks, exactly",
            divider.denominator
        ),
    }
}

/// Bits of counters and of the ticks they make.
fn divider_bits(units: &[StepUnit]) -> u32 {
    let started = u32::from(units.iter().any(|unit| unit.divider.whole > 0));
    let bits = |unit: &StepUnit| {
        let period = unit
            .counts
            .map_or(unit.divider.denominator, |(_, times)| times);
        let counter = (64 - (period - 1).leading_zeros()).max(2);
        let tick = u32::from(unit.net.is_some());
        if unit.divider.numerator > 0 {
            counter + tick
        } else {
            0
        }
    };
    units.iter().map(bits).sum::<u32>() + started
}
