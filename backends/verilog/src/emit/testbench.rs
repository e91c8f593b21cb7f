//! A testbench that replays a stimulus in any simulator.
//!
//! It reads `<name>_stimulus.hex`, one number a row that holds all inputs, and gives each scan its
//! row: the rows begin to go in during the reset, so that the first scan works with the first row
//! although inputs pass through synchronisers. It prints a row and what the outputs are after its
//! scan: one comma-separated line a row after a line of names.

use super::module::ModuleText;
use super::simulator::encode;
use super::vector;
use crate::design::Design;
use crate::names::Names;
use crate::options::Options;
use std::fmt::Write;

/// Writes the testbench.
pub(crate) fn emit(design: &Design, text: &ModuleText, options: &Options) -> String {
    let bench = Bench::new(design, text, options);
    bench.text()
}

/// The stimulus file: one line of digits a row, at least one.
pub(crate) fn stimulus(design: &Design, options: &Options) -> String {
    let inputs = design.inputs.iter();
    let fields: Vec<_> = inputs
        .map(|input| (input.port.offset as usize, input.port.ty))
        .collect();
    if options.stimulus.is_empty() {
        return "0\n".to_owned();
    }
    let rows = options.stimulus.iter();
    rows.map(|bytes| encode(&fields, bytes) + "\n").collect()
}

struct Bench<'a> {
    text: &'a ModuleText,
    /// Names and widths of inputs, then of outputs.
    inputs: Vec<(&'a str, u32)>,
    outputs: Vec<(&'a str, u32)>,
    rows: usize,
    latency: u32,
    /// Names of the testbench's own things, apart from those of the ports.
    row: String,
    all: String,
    memory: String,
    dut: String,
}

impl<'a> Bench<'a> {
    fn new(design: &Design, text: &'a ModuleText, options: &Options) -> Self {
        let mut names = Names::default();
        for port in ["clk", "rst"].into_iter().chain(text.ports()) {
            names.claim(port);
        }
        let inputs = text.inputs.iter().zip(&design.inputs);
        let outputs = text.outputs.iter().zip(&design.outputs);
        Self {
            text,
            inputs: inputs
                .map(|(name, input)| (name.as_str(), input.port.ty.bits()))
                .collect(),
            outputs: outputs
                .map(|(name, output)| (name.as_str(), output.port.ty.bits()))
                .collect(),
            rows: options.stimulus.len().max(1),
            latency: if options.synchronisers { 3 } else { 1 },
            row: names.claim("row"),
            all: names.claim("all_inputs"),
            memory: names.claim("stimulus"),
            dut: names.claim("dut"),
        }
    }

    fn text(&self) -> String {
        let name = &self.text.name;
        format!(
            "// Replays {name}_stimulus.hex and prints the ports after each row.\n\
             // One row is one scan is one clock. An input reaches an output in LATENCY edges, so a row goes in\n\
             // LATENCY - 1 clocks before its scan.\n\
             `timescale 1ns / 1ps\n\
             module {name}_tb;\n\n{declarations}\n{instance}\n{process}endmodule\n",
            declarations = self.declarations(),
            instance = self.instance(),
            process = self.process(),
        )
    }

    fn declarations(&self) -> String {
        let total: u32 = self.inputs.iter().map(|(_, bits)| bits).sum();
        let top = total.max(1) - 1;
        let mut out = format!(
            "    parameter ROWS = {};\n    parameter LATENCY = {};\n\n    reg clk, rst;\n    \
             reg [{top}:0] {};\n    reg [{top}:0] {} [0:ROWS-1];\n    integer {};\n\n",
            self.rows, self.latency, self.all, self.memory, self.row
        );
        let mut low = 0;
        for (port, bits) in &self.inputs {
            let (vector, all) = (vector(*bits), &self.all);
            let high = low + bits - 1;
            line(
                &mut out,
                &format!("    wire {vector}{port} = {all}[{high}:{low}];"),
            );
            low += bits;
        }
        for (port, bits) in &self.outputs {
            line(&mut out, &format!("    wire {}{port};", vector(*bits)));
        }
        out
    }

    fn instance(&self) -> String {
        let ports = self.text.ports();
        let connections: String = ports.map(|port| format!(", .{port}({port})")).collect();
        let (name, dut) = (&self.text.name, &self.dut);
        format!("    {name} {dut} (.clk(clk), .rst(rst){connections});\n")
    }

    fn process(&self) -> String {
        let (row, all, memory) = (&self.row, &self.all, &self.memory);
        let ports: Vec<&str> = self.text.ports().collect();
        let header: String = ports.iter().map(|port| format!(",{port}")).collect();
        let formats = ",%0d".repeat(ports.len());
        let mut low = 0;
        let inputs = self.inputs.iter().map(|&(_, bits)| {
            low += bits;
            let value = format!("{memory}[{row}][{}:{}]", low - 1, low - bits);
            (value, bits)
        });
        let outputs = self.outputs.iter();
        let values: String = inputs
            .chain(outputs.map(|&(port, bits)| (port.to_owned(), bits)))
            .map(|(value, bits)| match bits {
                1 => format!(", {value}"),
                _ => format!(", $signed({value})"),
            })
            .collect();
        let name = &self.text.name;
        format!(
            "    always #10 clk = ~clk;\n\n    initial begin\n        \
             $readmemh(\"{name}_stimulus.hex\", {memory});\n        \
             if ($test$plusargs(\"vcd\")) begin\n            $dumpfile(\"{name}.vcd\");\n            \
             $dumpvars;\n        end\n        clk = 0;\n        rst = 1;\n        \
             {all} = {memory}[0];\n        repeat (4) @(negedge clk);\n        \
             $display(\"row{header}\");\n        \
             for ({row} = 1 - LATENCY; {row} < ROWS; {row} = {row} + 1) begin\n            \
             rst = {row} < 0;\n            \
             {all} = {memory}[{row} + LATENCY <= ROWS ? {row} + LATENCY - 1 : ROWS - 1];\n            \
             @(negedge clk);\n            \
             if ({row} >= 0)\n                \
             $display(\"%0d{formats}\", {row}{values});\n        end\n        $finish(0);\n    end\n"
        )
    }
}

fn line(out: &mut String, text: &str) {
    writeln!(out, "{text}").expect("writing to a string");
}
