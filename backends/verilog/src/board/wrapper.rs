//! `top`: the program on a board. It turns pins that are active low, and resets the program at
//! power-up and when the reset key is held.

use super::assign::Carried;
use super::{Assignment, Board};
use crate::design::{Design, OutputPort};
use crate::emit::module::ModuleText;
use crate::emit::vector;
use crate::names::{Names, identifier};

/// The wrapper and the names of its ports with their pins.
pub(super) struct Wrapper {
    pub(super) text: String,
    pub(super) name: String,
    /// Port of the wrapper and position of the pin: clock, reset if any, inputs, outputs.
    pub(super) clock: String,
    pub(super) reset: Option<String>,
    pub(super) inputs: Vec<String>,
    pub(super) outputs: Vec<String>,
}

/// Writes the wrapper.
pub(super) fn wrapper(
    board: &Board,
    assignment: &Assignment,
    design: &Design,
    text: &ModuleText,
) -> Wrapper {
    let mut names = Names::default();
    names.claim(&text.name);
    let name = names.claim("top");
    for reserved in ["power_up", "held", "rst", "controller"] {
        names.claim(reserved);
    }
    let clock = names.claim(&identifier(&board.clock.name));
    let reset = board.reset.as_ref().map(|pin| names.claim(&pin.name));
    let mut pins = |carried: &[Carried]| -> Vec<String> {
        carried
            .iter()
            .map(|c| names.claim(&format!("pin_{}", c.pin.name)))
            .collect()
    };
    let (inputs, outputs) = (pins(&assignment.inputs), pins(&assignment.outputs));
    let mut wrapper = Wrapper {
        text: String::new(),
        name,
        clock,
        reset,
        inputs,
        outputs,
    };
    wrapper.text = wrapper.write(board, assignment, design, text);
    wrapper
}

impl Wrapper {
    fn write(
        &self,
        board: &Board,
        assignment: &Assignment,
        design: &Design,
        text: &ModuleText,
    ) -> String {
        let mut ports = vec![format!("    input  wire {}", self.clock)];
        ports.extend(
            self.reset
                .iter()
                .map(|name| format!("    input  wire {name}")),
        );
        ports.extend(
            self.inputs
                .iter()
                .map(|name| format!("    input  wire {name}")),
        );
        ports.extend(
            self.outputs
                .iter()
                .map(|name| format!("    output wire {name}")),
        );
        format!(
            "// {name} on the board {board}: active levels of the pins, and reset.\n\
             module {top} (\n{ports}\n);\n\n{reset}\n{values}\n{instance}\n{pins}\nendmodule\n",
            name = text.name,
            board = board.name,
            top = self.name,
            ports = ports.join(",\n"),
            reset = self.reset_logic(board),
            values = values(design, text),
            instance = self.instance(assignment, design, text),
            pins = self.output_pins(assignment, design, text),
        )
    }

    fn instance(&self, assignment: &Assignment, design: &Design, text: &ModuleText) -> String {
        let mut ports = vec![format!(".clk({}), .rst(rst)", self.clock)];
        for (index, (port, input)) in text.inputs.iter().zip(&design.inputs).enumerate() {
            let bits = input.port.ty.bits();
            let bits = bits_of(&assignment.inputs, &self.inputs, index, bits);
            ports.push(format!(".{port}({bits})"));
        }
        ports.extend(
            text.outputs
                .iter()
                .map(|port| format!(".{port}({port}_value)")),
        );
        let ports = ports.join(",\n        ");
        format!("    {} controller (\n        {ports}\n    );\n", text.name)
    }

    fn output_pins(&self, assignment: &Assignment, design: &Design, text: &ModuleText) -> String {
        let pin = |(carried, pin): (&Carried, &String)| {
            let bits = design.outputs[carried.port].port.ty.bits();
            let select = if bits == 1 {
                String::new()
            } else {
                format!("[{}]", carried.bit)
            };
            let not = if carried.pin.active_low { "~" } else { "" };
            let port = &text.outputs[carried.port];
            format!("    assign {pin} = {not}{port}_value{select};\n")
        };
        assignment
            .outputs
            .iter()
            .zip(&self.outputs)
            .map(pin)
            .collect()
    }

    /// Chips start with registers at 0, so a counter from 0 marks the time after power-up; a key is
    /// brought into the clock domain like any input.
    fn reset_logic(&self, board: &Board) -> String {
        let clock = &self.clock;
        let key = board.reset.as_ref().zip(self.reset.as_ref());
        let (shift, rst) = match key {
            None => (String::new(), "~&power_up"),
            Some((pin, name)) => {
                let not = if pin.active_low { "~" } else { "" };
                let text = format!(
                    "    reg [1:0] held;\n\n    always @(posedge {clock})\n        held <= {{held[0], {not}{name}}};\n\n"
                );
                (text, "~&power_up | held[1]")
            }
        };
        format!(
            "    // Reset for 15 clocks after power-up, and while the key is held.\n{shift}    reg [3:0] power_up;\n\n    \
             initial power_up = 4'd0;\n\n    always @(posedge {clock})\n        if (!(&power_up))\n            \
             power_up <= power_up + 4'd1;\n\n    wire rst = {rst};\n"
        )
    }
}

/// Wires for the output ports.
fn values(design: &Design, text: &ModuleText) -> String {
    let wire = |(port, output): (&String, &OutputPort)| {
        format!("    wire {}{port}_value;\n", vector(output.port.ty.bits()))
    };
    text.outputs.iter().zip(&design.outputs).map(wire).collect()
}

/// The value of an input port from its pins.
fn bits_of(carried: &[Carried], pins: &[String], port: usize, bits: u32) -> String {
    let bit = |(carried, pin): (&Carried, &String)| {
        let not = if carried.pin.active_low { "~" } else { "" };
        format!("{not}{pin}")
    };
    let own = carried
        .iter()
        .zip(pins)
        .filter(|(carried, _)| carried.port == port);
    let mut parts: Vec<String> = own.map(bit).collect();
    if bits == 1 {
        return parts.remove(0);
    }
    // Concatenation begins with the highest bit.
    parts.reverse();
    format!("{{{}}}", parts.join(", "))
}
