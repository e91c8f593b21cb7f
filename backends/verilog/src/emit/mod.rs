//! The design as text: the module itself, its testbench, and the simulator's harness.

mod expression;
pub(crate) mod module;
pub(crate) mod simulator;
pub(crate) mod testbench;

/// `[11:0] `, or nothing for a single bit.
pub(crate) fn vector(width: u32) -> String {
    if width == 1 {
        String::new()
    } else {
        format!("[{}:0] ", width - 1)
    }
}

/// Text that can stand behind `//` whatever it contains.
pub(crate) fn comment_lines(text: &str) -> Vec<String> {
    let clean = |c: char| if c.is_control() { ' ' } else { c };
    let line = |line: &str| {
        let line: String = line.chars().map(clean).collect();
        // A backslash at the end would continue the line in some preprocessors.
        line.trim_end().trim_end_matches('\\').to_owned()
    };
    text.lines().map(line).collect()
}
