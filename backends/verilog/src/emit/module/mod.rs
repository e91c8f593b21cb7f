//! The module that runs a scan in every clock.
//!
//! Order of the text: ports, synchronisers, tick dividers, registers with what they hold, the logic
//! rung by rung, the one clocked block, outputs.

mod dividers;
mod ports;

use super::expression::{Expressions, Naming, constant, declaration, unread, write};
use super::{comment_lines, vector};
use crate::design::{Design, Purpose, Register, StepUnit};
use crate::names::{Names, identifier};
use crate::net::Net;
use crate::options::Options;
use iecc_ir::{Module, Origin};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Write};

/// The counter of whole ratios and the accumulator of others.
pub(crate) const TICK: (&str, &str) = ("iecc_tick.v", include_str!("../../../runtime/iecc_tick.v"));
pub(crate) const TICK_FRACTION: (&str, &str) = (
    "iecc_tick_fraction.v",
    include_str!("../../../runtime/iecc_tick_fraction.v"),
);

/// The module's text and what others need to know of it.
pub(crate) struct ModuleText {
    pub(crate) text: String,
    /// Name of the module.
    pub(crate) name: String,
    /// Identifiers of the ports, as in the design.
    pub(crate) inputs: Vec<String>,
    pub(crate) outputs: Vec<String>,
    /// Identifiers of the registers, as in the design.
    pub(crate) registers: Vec<String>,
    /// Files of the runtime it needs.
    pub(crate) runtime: Vec<(&'static str, &'static str)>,
}

impl ModuleText {
    /// Identifiers of all ports but clock and reset.
    pub(crate) fn ports(&self) -> impl Iterator<Item = &str> {
        self.inputs.iter().chain(&self.outputs).map(String::as_str)
    }
}

/// Writes the module of a design.
pub(crate) fn emit(module: &Module, design: &Design, options: &Options) -> ModuleText {
    let mut names = Names::default();
    let name = identifier(&module.name);
    for reserved in [
        "clk",
        "rst",
        "started",
        &name,
        "iecc_tick",
        "iecc_tick_fraction",
    ] {
        names.claim(reserved);
    }
    let claim = |names: &mut Names, name: &str| names.claim(name);
    let inputs: Vec<String> = design
        .inputs
        .iter()
        .map(|input| claim(&mut names, &input.port.name))
        .collect();
    let outputs: Vec<String> = design
        .outputs
        .iter()
        .map(|output| claim(&mut names, &output.port.name))
        .collect();
    let registers = register_names(design, &outputs, &mut names);
    let synchronised = synchronised_names(design, options, &inputs, &mut names);
    let ticks = design
        .units
        .iter()
        .map(|unit| names.claim(&format!("{}_{}", unit_stem(unit), unit_text(unit.unit_ns))))
        .collect();
    let roots: Vec<Net> = design
        .registers
        .iter()
        .map(|register| register.next)
        .collect();
    let mut emitter = Emitter {
        module,
        design,
        options,
        inputs,
        outputs,
        registers,
        synchronised,
        ticks,
        runtime: BTreeSet::new(),
        out: String::new(),
    };
    let stem = |origin| emitter.stem(origin);
    let naming = Naming {
        sources: emitter.sources(),
        hints: emitter.hints(),
        stem: &stem,
    };
    let expressions = write(design, &roots, &naming, &mut names);
    emitter
        .write(&name, &expressions)
        .expect("writing to a string");
    ModuleText {
        text: emitter.out,
        name,
        inputs: emitter.inputs,
        outputs: emitter.outputs,
        registers: emitter.registers,
        runtime: emitter.runtime.into_iter().collect(),
    }
}

/// A register that is as wide as an output it drives has the output's name.
fn register_names(design: &Design, outputs: &[String], names: &mut Names) -> Vec<String> {
    let name = |(index, register): (usize, &Register)| {
        let driven = design.outputs.iter().position(|output| {
            output.register == Some(index) && output.port.ty.bits() == register.width()
        });
        driven.map_or_else(
            || names.claim_or(&register.tag, "_reg"),
            |port| outputs[port].clone(),
        )
    };
    design.registers.iter().enumerate().map(name).collect()
}

/// Names of the two stages, for inputs that are read.
fn synchronised_names(
    design: &Design,
    options: &Options,
    inputs: &[String],
    names: &mut Names,
) -> Vec<Option<[String; 2]>> {
    let stage = |names: &mut Names, input: &str| {
        [
            names.claim(&format!("{input}_meta")),
            names.claim(&format!("{input}_sync")),
        ]
    };
    design
        .inputs
        .iter()
        .zip(inputs)
        .map(|(input, name)| {
            (options.synchronisers && input.net.is_some()).then(|| stage(names, name))
        })
        .collect()
}

fn unit_stem(unit: &StepUnit) -> &'static str {
    if unit.divider.is_tick() {
        "tick"
    } else {
        "step"
    }
}

/// `1ms`, `500ns`.
pub(crate) fn unit_text(unit_ns: u64) -> String {
    for (factor, suffix) in [(1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "us")] {
        if unit_ns.is_multiple_of(factor) {
            return format!("{}{suffix}", unit_ns / factor);
        }
    }
    format!("{unit_ns}ns")
}

struct Emitter<'a> {
    module: &'a Module,
    design: &'a Design,
    options: &'a Options,
    inputs: Vec<String>,
    outputs: Vec<String>,
    registers: Vec<String>,
    synchronised: Vec<Option<[String; 2]>>,
    ticks: Vec<String>,
    runtime: BTreeSet<(&'static str, &'static str)>,
    out: String,
}

impl Emitter<'_> {
    /// `Deposit_r5` for what comes from rung 5 of a routine `Deposit`.
    fn stem(&self, origin: Option<Origin>) -> String {
        let label = origin.map_or("", |origin| &self.module.origins[origin].label);
        let parts = label.rsplit_once(" rung ");
        let digits = |n: &str| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit());
        match parts.filter(|(_, number)| digits(number)) {
            Some((place, number)) => {
                let routine = place.rsplit('/').next().unwrap_or(place);
                format!("{}_r{number}", identifier(routine))
            }
            None => "w".to_owned(),
        }
    }

    fn sources(&self) -> BTreeMap<Net, String> {
        let mut sources = BTreeMap::new();
        for (register, name) in self.design.registers.iter().zip(&self.registers) {
            sources.extend(register.net.map(|net| (net, name.clone())));
        }
        for (index, input) in self.design.inputs.iter().enumerate() {
            let name = match &self.synchronised[index] {
                Some([_, second]) => second,
                None => &self.inputs[index],
            };
            sources.extend(input.net.map(|net| (net, name.clone())));
        }
        for (unit, name) in self.design.units.iter().zip(&self.ticks) {
            sources.extend(unit.net.map(|net| (net, name.clone())));
        }
        sources
    }

    fn hints(&self) -> BTreeMap<Net, String> {
        let mut hints = BTreeMap::new();
        for (register, name) in self.design.registers.iter().zip(&self.registers) {
            hints
                .entry(register.next)
                .or_insert_with(|| format!("{name}_next"));
        }
        hints
    }

    fn write(&mut self, name: &str, expressions: &Expressions) -> fmt::Result {
        self.header(name)?;
        self.ports(name)?;
        self.synchronisers()?;
        self.dividers()?;
        self.registers()?;
        self.logic(expressions)?;
        self.clocked(expressions)?;
        self.drive_outputs()?;
        self.unused(expressions)?;
        self.assertions()?;
        writeln!(self.out, "\nendmodule")
    }

    fn header(&mut self, name: &str) -> fmt::Result {
        let out = &mut self.out;
        writeln!(out, "// {name}: one scan of the program in every clock.")?;
        writeln!(out, "//")?;
        writeln!(
            out,
            "// Made by iecc for a clock of {}.",
            self.options.clock
        )?;
        writeln!(
            out,
            "// A wire called x_next is what x holds after the scan; x itself is what it held before."
        )?;
        writeln!(
            out,
            "// All vectors are plain bits: signs are extended by hand, comparisons say $signed.\n"
        )
    }

    fn registers(&mut self) -> fmt::Result {
        let rows: Vec<(String, String)> = self
            .design
            .registers
            .iter()
            .zip(&self.registers)
            .filter(|(_, name)| !self.outputs.contains(name))
            .map(|(register, name)| {
                let row = format!("    reg {}{name};", vector(register.width()));
                (row, register_comment(register, name))
            })
            .collect();
        if rows.is_empty() {
            return Ok(());
        }
        writeln!(self.out, "\n    // Kept from scan to scan.")?;
        for (row, comment) in rows {
            writeln!(self.out, "{row:<40}  // {comment}")?;
        }
        Ok(())
    }

    fn logic(&mut self, expressions: &Expressions) -> fmt::Result {
        // Instructions of one rung have origins of their own with one label.
        let label = |origin: Option<Origin>| origin.map(|o| &self.module.origins[o].label);
        let mut last = None;
        for wire in &expressions.wires {
            if last != Some(label(wire.origin)) {
                last = Some(label(wire.origin));
                self.group(wire.origin)?;
            }
            writeln!(self.out, "    {}", declaration(wire))?;
        }
        Ok(())
    }

    fn group(&mut self, origin: Option<Origin>) -> fmt::Result {
        let Some(origin) = origin else {
            return writeln!(self.out);
        };
        writeln!(self.out)?;
        for line in comment_lines(&self.module.origins[origin].label) {
            writeln!(self.out, "    // -- {line}")?;
        }
        let comment = self.options.source_comments.get(&origin);
        for line in comment.map(|text| comment_lines(text)).unwrap_or_default() {
            writeln!(self.out, "    //    {line}")?;
        }
        Ok(())
    }

    fn clocked(&mut self, expressions: &Expressions) -> fmt::Result {
        if self.design.registers.is_empty() {
            return Ok(());
        }
        let out = &mut self.out;
        writeln!(
            out,
            "\n    // The end of the scan: everything changes at once."
        )?;
        writeln!(out, "    always @(posedge clk)\n        if (rst) begin")?;
        let pairs = || self.design.registers.iter().zip(&self.registers);
        for (register, name) in pairs() {
            let initial = constant(
                register.width(),
                u128::from(register.initial) & crate::net::mask(register.width()),
            );
            writeln!(out, "            {name} <= {initial};")?;
        }
        writeln!(out, "        end else begin")?;
        for (register, name) in pairs() {
            writeln!(
                out,
                "            {name} <= {};",
                expressions.text(register.next)
            )?;
        }
        writeln!(out, "        end")
    }

    /// Lint tools want to hear that something is not read on purpose.
    fn unused(&mut self, expressions: &Expressions) -> fmt::Result {
        let mut parts = Vec::new();
        for (input, name) in self.design.inputs.iter().zip(&self.inputs) {
            if input.net.is_none() {
                parts.push(name.clone());
            }
        }
        let driving: BTreeSet<Net> = self
            .design
            .outputs
            .iter()
            .filter_map(|output| self.design.registers[output.register?].net)
            .collect();
        for (net, name) in &expressions.named {
            if let Some(read) = expressions.read.get(net)
                && !driving.contains(net)
                && read.contains(&false)
            {
                parts.extend(unread(name, read));
            }
        }
        if self.design.registers.is_empty() {
            parts.extend(["clk".to_owned(), "rst".to_owned()]);
        }
        if parts.is_empty() {
            return Ok(());
        }
        writeln!(self.out, "\n    // Bits the program does not look at.")?;
        writeln!(
            self.out,
            "    wire unused = &{{1'b0, {}}};",
            parts.join(", ")
        )
    }

    /// What range analysis knows, for provers; other tools do not see it.
    fn assertions(&mut self) -> fmt::Result {
        let pairs = self.design.registers.iter().zip(&self.registers);
        let claims: Vec<String> = pairs
            .filter_map(|(register, name)| claim(register, name))
            .collect();
        if claims.is_empty() {
            return Ok(());
        }
        writeln!(self.out, "\n`ifdef FORMAL\n    always @(posedge clk) begin")?;
        for claim in claims {
            writeln!(self.out, "        if (!rst) assert ({claim});")?;
        }
        writeln!(self.out, "    end\n`endif")
    }
}

/// Says the user's name where the identifier is another one.
fn renamed(name: &str, identifier: &str) -> String {
    if name == identifier {
        String::new()
    } else {
        comment_lines(name).join(" ")
    }
}

fn register_comment(register: &Register, name: &str) -> String {
    let tag = match &register.purpose {
        Purpose::State(_) if register.tag == name => String::new(),
        Purpose::State(_) => format!("{}, ", comment_lines(&register.tag).join(" ")),
        Purpose::Output(_) => String::new(),
    };
    let initial = match register.ty.bits() {
        1 => register.initial as i64,
        _ => register.ty.signed(register.initial),
    };
    if register.width() == 1 {
        return format!("{tag}initially {initial}");
    }
    let range = register.range;
    format!("{tag}{} .. {}, initially {initial}", range.lo, range.hi)
}

/// A register's value in the bits of a port.
fn widened(register: &Register, name: &str, width: u32) -> String {
    let own = register.width();
    match width - own {
        0 => name.to_owned(),
        more if !register.signed() => format!("{{{}, {name}}}", constant(more, 0)),
        more if own == 1 => format!("{{{}{{{name}}}}}", more + 1),
        more => format!("{{{{{more}{{{name}[{}]}}}}, {name}}}", own - 1),
    }
}

fn claim(register: &Register, name: &str) -> Option<String> {
    let (range, width) = (register.range, register.width());
    let bits = |number: i64| constant(width, number as u128 & crate::net::mask(width));
    if !range.is_signed() {
        let full = width < 64 && range.hi == i64::MAX >> (63 - width);
        return (!full && range.lo == 0).then(|| format!("{name} <= {}", bits(range.hi)));
    }
    let full = range.lo == i64::MIN >> (64 - width) && range.hi == i64::MAX >> (64 - width);
    let (lo, hi) = (bits(range.lo), bits(range.hi));
    (!full).then(|| format!("$signed({name}) >= $signed({lo}) && $signed({name}) <= $signed({hi})"))
}
