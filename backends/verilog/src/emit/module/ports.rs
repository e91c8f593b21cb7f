//! What the module has to do with the world: ports, the synchronisers of inputs, the registers of outputs.

use super::{Emitter, register_comment, renamed, widened};
use crate::emit::expression::constant;
use crate::emit::vector;
use std::fmt::{self, Write};

impl Emitter<'_> {
    pub(super) fn ports(&mut self, name: &str) -> fmt::Result {
        let mut lines = vec![
            (
                "input  wire clk".to_owned(),
                "one scan per rising edge".to_owned(),
            ),
            (
                "input  wire rst".to_owned(),
                "synchronous, high; at least 3 clocks".to_owned(),
            ),
        ];
        for (input, name) in self.design.inputs.iter().zip(&self.inputs) {
            let bits = vector(input.port.ty.bits());
            lines.push((
                format!("input  wire {bits}{name}"),
                renamed(&input.port.name, name),
            ));
        }
        for (output, name) in self.design.outputs.iter().zip(&self.outputs) {
            let own = self.registers.iter().position(|register| register == name);
            let kind = if own.is_some() { "reg " } else { "wire" };
            let bits = vector(output.port.ty.bits());
            let mut comment = renamed(&output.port.name, name);
            if let Some(register) = own.map(|index| &self.design.registers[index]) {
                let separator = if comment.is_empty() { "" } else { "; " };
                comment = comment + separator + &register_comment(register, name);
            }
            lines.push((format!("output {kind} {bits}{name}"), comment));
        }
        let last = lines.len() - 1;
        writeln!(self.out, "module {name} (")?;
        for (index, (port, comment)) in lines.iter().enumerate() {
            let comma = if index == last { "" } else { "," };
            let line = format!("    {port}{comma}");
            if comment.is_empty() {
                writeln!(self.out, "{line}")?;
            } else {
                writeln!(self.out, "{line:<40}  // {comment}")?;
            }
        }
        writeln!(self.out, ");")
    }

    pub(super) fn synchronisers(&mut self) -> fmt::Result {
        let inputs = self.design.inputs.iter().zip(&self.synchronised);
        let stages: Vec<(&str, &[String; 2], u32)> = inputs
            .zip(&self.inputs)
            .filter_map(|((input, stages), name)| {
                Some((name.as_str(), stages.as_ref()?, input.port.ty.bits()))
            })
            .collect();
        if stages.is_empty() {
            return Ok(());
        }
        let out = &mut self.out;
        writeln!(
            out,
            "\n    // Inputs come from another world: two registers each before use."
        )?;
        for (_, [first, second], width) in &stages {
            writeln!(out, "    reg {}{first}, {second};", vector(*width))?;
        }
        writeln!(out, "\n    always @(posedge clk) begin")?;
        for (name, [first, second], _) in &stages {
            writeln!(out, "        {first} <= {name};")?;
            writeln!(out, "        {second} <= {first};")?;
        }
        writeln!(out, "    end")
    }

    pub(super) fn drive_outputs(&mut self) -> fmt::Result {
        let mut first = true;
        for (output, name) in self.design.outputs.iter().zip(&self.outputs) {
            let width = output.port.ty.bits();
            let value = match output.register {
                None => constant(width, 0),
                Some(index) if self.registers[index] == *name => continue,
                Some(index) => {
                    widened(&self.design.registers[index], &self.registers[index], width)
                }
            };
            if std::mem::take(&mut first) {
                writeln!(self.out)?;
            }
            writeln!(self.out, "    assign {name} = {value};")?;
        }
        Ok(())
    }
}
