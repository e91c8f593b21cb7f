//! The harness through which an engine drives the module in a simulator: one line of hexadecimal
//! digits in, one scan, one line out.
//!
//! A line holds the ports of one direction as one number, the first port in the lowest bits.

use super::module::ModuleText;
use crate::design::Design;
use iecc_ir::Type;
use std::fmt::Write;

/// Name of the harness module; the module under test never has it.
pub(crate) const HARNESS: &str = "iecc_harness";

/// Writes the harness.
pub(crate) fn emit(design: &Design, text: &ModuleText) -> String {
    let inputs: Vec<u32> = design.inputs.iter().map(|i| i.port.ty.bits()).collect();
    let outputs: Vec<u32> = design.outputs.iter().map(|o| o.port.ty.bits()).collect();
    let total = |widths: &[u32]| widths.iter().sum::<u32>().max(1);
    let mut connections = String::new();
    for (names, widths, bus) in [
        (&text.inputs, &inputs, "in"),
        (&text.outputs, &outputs, "out"),
    ] {
        let mut low = 0;
        for (name, width) in names.iter().zip(widths) {
            let high = low + width - 1;
            write!(connections, ",\n        .{name}({bus}[{high}:{low}])").expect("a string");
            low += width;
        }
    }
    let undriven = if outputs.is_empty() {
        "\n    assign out = 1'b0;"
    } else {
        ""
    };
    format!(
        "// Drives {name} from standard input: a line of inputs, one scan, a line of outputs.\n\
         module {HARNESS};\n    reg clk, rst;\n    reg [{in_top}:0] in;\n    wire [{out_top}:0] out;{undriven}\n\
         \n    {name} scan (\n        .clk(clk), .rst(rst){connections}\n    );\n\
         \n    integer got;\n\
         \n    initial begin\n        clk = 0;\n        rst = 1;\n        in = 0;\n        repeat (4) begin\n            \
         #1 clk = 1;\n            #1 clk = 0;\n        end\n        rst = 0;\n        \
         got = $fscanf(32'h8000_0000, \"%h\", in);\n        while (got == 1) begin\n            \
         #1 clk = 1;\n            #1 clk = 0;\n            $display(\"%h\", out);\n            $fflush;\n            \
         got = $fscanf(32'h8000_0000, \"%h\", in);\n        end\n        $finish(0);\n    end\nendmodule\n",
        name = text.name,
        in_top = total(&inputs) - 1,
        out_top = total(&outputs) - 1,
    )
}

/// One line of digits for the ports of a region.
pub(crate) fn encode(fields: &[(usize, Type)], bytes: &[u8]) -> String {
    let mut bits = Vec::new();
    for &(offset, ty) in fields {
        let value = |bit: u32| bytes[offset + (bit / 8) as usize] >> (bit % 8) & 1;
        bits.extend((0..ty.bits()).map(value));
    }
    let digit = |nibble: &[u8]| {
        let value = nibble
            .iter()
            .rev()
            .fold(0, |sum, bit| sum << 1 | u32::from(*bit));
        char::from_digit(value, 16).expect("four bits")
    };
    if bits.is_empty() {
        return "0".to_owned();
    }
    bits.chunks(4).rev().map(digit).collect()
}

/// Fills a region from a line of digits; `None` if it does not consist of such.
pub(crate) fn decode(fields: &[(usize, Type)], line: &str, bytes: &mut [u8]) -> Option<()> {
    let mut digits = line.trim().chars().rev();
    let mut bits = Vec::new();
    let total: u32 = fields.iter().map(|(_, ty)| ty.bits()).sum();
    while bits.len() < total as usize {
        let digit = digits.next()?.to_digit(16)?;
        bits.extend((0..4).map(|bit| (digit >> bit & 1) as u8));
    }
    let mut bits = bits.into_iter();
    for &(offset, ty) in fields {
        bytes[offset..offset + ty.bytes() as usize].fill(0);
        for (index, bit) in bits.by_ref().take(ty.bits() as usize).enumerate() {
            bytes[offset + index / 8] |= bit << (index % 8);
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_hold_ports_from_the_lowest_bit_up() {
        let fields = [(0, Type::I1), (2, Type::I16), (1, Type::I1)];
        let bytes = [1, 1, 0x34, 0x12];
        // 1, then 0x1234 above it, then 1 above that.
        let line = encode(&fields, &bytes);
        assert_eq!(
            u32::from_str_radix(&line, 16),
            Ok(1 | 0x1234 << 1 | 1 << 17)
        );
        let mut back = [0; 4];
        assert_eq!(decode(&fields, &line, &mut back), Some(()));
        assert_eq!(back, bytes);
    }

    #[test]
    fn unknown_bits_are_not_numbers() {
        assert_eq!(decode(&[(0, Type::I8)], "x3", &mut [0]), None);
        assert_eq!(decode(&[(0, Type::I8)], "3", &mut [0]), None);
    }
}
