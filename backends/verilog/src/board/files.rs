//! The files a tool needs beside the Verilog: a Quartus project, or pins and a script for the open
//! tools.

use super::wrapper::{Wrapper, wrapper};
use super::{Assignment, Board, Flow, Pin};
use crate::design::Design;
use crate::emit::module::ModuleText;
use iecc_target::Artifact;
use std::fmt::Write;

/// The wrapper and the project around it.
pub(crate) fn files(
    board: &Board,
    assignment: &Assignment,
    design: &Design,
    text: &ModuleText,
) -> Vec<Artifact> {
    let wrapper = wrapper(board, assignment, design, text);
    let mut sources = vec![format!("{}.v", wrapper.name), format!("{}.v", text.name)];
    sources.extend(text.runtime.iter().map(|(name, _)| (*name).to_owned()));
    let project = Project {
        board,
        name: &text.name,
        pins: pins(board, assignment, &wrapper),
        sources,
        top: &wrapper.name,
        clock: &wrapper.clock,
    };
    let mut files = match board.flow {
        Flow::Quartus => project.quartus(),
        Flow::Icestorm => project.icestorm(),
    };
    files.push(Artifact::text(format!("{}.v", wrapper.name), wrapper.text));
    files
}

/// A port of the wrapper, its pin, and whether it is an input.
struct Placed<'a> {
    port: &'a str,
    pin: &'a Pin,
    input: bool,
}

fn pins<'a>(board: &'a Board, assignment: &'a Assignment, wrapper: &'a Wrapper) -> Vec<Placed<'a>> {
    let placed = |port: &'a String, pin: &'a Pin, input: bool| Placed { port, pin, input };
    let mut pins = Vec::new();
    pins.extend(
        wrapper
            .reset
            .as_ref()
            .zip(board.reset.as_ref())
            .map(|(port, pin)| placed(port, pin, true)),
    );
    let inputs = wrapper.inputs.iter().zip(&assignment.inputs);
    pins.extend(inputs.map(|(port, carried)| placed(port, &carried.pin, true)));
    let outputs = wrapper.outputs.iter().zip(&assignment.outputs);
    pins.extend(outputs.map(|(port, carried)| placed(port, &carried.pin, false)));
    pins
}

struct Project<'a> {
    board: &'a Board,
    name: &'a str,
    pins: Vec<Placed<'a>>,
    sources: Vec<String>,
    top: &'a str,
    clock: &'a str,
}

impl Project<'_> {
    fn quartus(&self) -> Vec<Artifact> {
        let name = self.name;
        vec![
            Artifact::text(
                format!("{name}.qpf"),
                format!("PROJECT_REVISION = \"{name}\"\n"),
            ),
            Artifact::text(format!("{name}.qsf"), self.settings()),
            Artifact::text(format!("{name}.sdc"), self.timing()),
        ]
    }

    fn settings(&self) -> String {
        let Board { device, family, .. } = self.board;
        let mut out = format!(
            "# {} on the board {}\n\
             set_global_assignment -name FAMILY \"{family}\"\n\
             set_global_assignment -name DEVICE {device}\n\
             set_global_assignment -name TOP_LEVEL_ENTITY {}\n",
            self.name, self.board.name, self.top
        );
        for file in &self.sources {
            let _ = writeln!(out, "set_global_assignment -name VERILOG_FILE {file}");
        }
        let _ = writeln!(
            out,
            "set_global_assignment -name SDC_FILE {}.sdc",
            self.name
        );
        let clock = (self.clock, &self.board.clock);
        let others = self.pins.iter().map(|placed| (placed.port, placed.pin));
        for (port, pin) in std::iter::once(clock).chain(others) {
            let (location, standard) = (&pin.location, &pin.standard);
            let _ = writeln!(out, "set_location_assignment PIN_{location} -to {port}");
            let _ = writeln!(
                out,
                "set_instance_assignment -name IO_STANDARD \"{standard}\" -to {port}"
            );
        }
        out
    }

    fn timing(&self) -> String {
        let clock = self.clock;
        let period_ns = 1e9 / self.board.clock_hz as f64;
        let mut out = format!(
            "create_clock -name {clock} -period {period_ns:.3} [get_ports {{{clock}}}]\n\
             derive_clock_uncertainty\n\
             # Inputs go through synchronisers and outputs drive slow devices: no timing to keep.\n"
        );
        for placed in &self.pins {
            let direction = if placed.input { "-from" } else { "-to" };
            let _ = writeln!(
                out,
                "set_false_path {direction} [get_ports {{{}}}]",
                placed.port
            );
        }
        out
    }

    fn icestorm(&self) -> Vec<Artifact> {
        vec![
            Artifact::text(format!("{}.pcf", self.name), self.constraints()),
            Artifact::text("build.sh", self.script()),
        ]
    }

    fn constraints(&self) -> String {
        let mut out = format!("# {} on the board {}\n", self.name, self.board.name);
        let clock = &self.board.clock.location;
        let _ = writeln!(out, "set_io {} {clock}", self.clock);
        for placed in &self.pins {
            // What is tied to ground when active needs something that holds it high otherwise.
            let pull = if placed.input && placed.pin.active_low {
                "-pullup yes "
            } else {
                ""
            };
            let _ = writeln!(out, "set_io {pull}{} {}", placed.port, placed.pin.location);
        }
        out
    }

    fn script(&self) -> String {
        let Board {
            device,
            family,
            clock_hz,
            ..
        } = self.board;
        let (name, top) = (self.name, self.top);
        let megahertz = *clock_hz as f64 / 1e6;
        format!(
            "#!/bin/sh\n# Makes {name}.bin with the open tools (yosys, nextpnr-ice40, icepack).\n\
             set -eu\ncd \"$(dirname \"$0\")\"\n\
             yosys -q -p 'read_verilog {}; synth_ice40 -abc9 -device hx -top {top} -json {name}.json'\n\
             nextpnr-ice40 --{device} --package {family} --json {name}.json --pcf {name}.pcf \\\n    \
             --asc {name}.asc --freq {megahertz}\n\
             icepack {name}.asc {name}.bin\n",
            self.sources.join(" ")
        )
    }
}
