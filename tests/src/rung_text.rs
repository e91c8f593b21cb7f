//! Random rung texts that follow the grammar, with nesting kept small.

use crate::rng::Rng;

const MNEMONICS: [&str; 10] = [
    "XIC", "ote", "TON", "AND", "Not", "MOD", "CPT", "GSV", "My_AOI", "JSR",
];
const NAMES: [&str; 8] = [
    "a",
    "Start",
    "_x1",
    "ALL",
    "S:FS",
    "Local:2:I",
    "\\Main.tag",
    "Mod:I1",
];
const LITERALS: [&str; 10] = [
    "0",
    "16#ffff_0000",
    "2#1010",
    "8#17",
    "1.5",
    ".6",
    "2.",
    "1.#QNAN",
    "5UL",
    "'a$'b,]'",
];
const OPERATORS: [&str; 18] = [
    "+", "-", "*", "/", " MOD ", "**", "=", "<>", "<", "<=", ">", ">=", " AND ", "&", " or ",
    " XOR ", "&&", "||",
];

/// One rung with its semicolon.
pub fn rung(rng: &mut Rng) -> String {
    let mut text = String::new();
    series(&mut text, 3, rng);
    text.push(';');
    text
}

fn series(text: &mut String, depth: usize, rng: &mut Rng) {
    for _ in 0..rng.below(4) {
        if depth > 0 && rng.one_in(3) {
            branch(text, depth - 1, rng);
        } else {
            instruction(text, rng);
        }
    }
}

fn branch(text: &mut String, depth: usize, rng: &mut Rng) {
    text.push('[');
    for leg in 0..=rng.below(3) {
        if leg > 0 {
            text.push_str(" ,");
        }
        series(text, depth, rng);
    }
    text.push_str(" ]");
}

fn instruction(text: &mut String, rng: &mut Rng) {
    text.push_str(rng.pick(&MNEMONICS));
    text.push('(');
    for operand in 0..rng.below(4) {
        if operand > 0 {
            text.push(',');
        }
        match rng.below(8) {
            0 => text.push('?'),
            1 => text.push_str("% of Maximum"),
            2 => text.push_str("Units per sec2"),
            _ => expression(text, 3, rng),
        }
    }
    text.push(')');
}

fn expression(text: &mut String, depth: usize, rng: &mut Rng) {
    if depth == 0 {
        return text.push_str(rng.pick(&LITERALS));
    }
    match rng.below(8) {
        0 => text.push_str(rng.pick(&LITERALS)),
        1 => {
            text.push_str(rng.pick(&["-", "NOT ", "!"]));
            expression(text, depth - 1, rng);
        }
        2 => wrapped("(", depth, ")", text, rng),
        3 => wrapped("SQR(", depth, ")", text, rng),
        4 => {
            expression(text, depth - 1, rng);
            text.push_str(rng.pick(&OPERATORS));
            expression(text, depth - 1, rng);
        }
        _ => reference(text, depth, rng),
    }
}

fn wrapped(open: &str, depth: usize, close: &str, text: &mut String, rng: &mut Rng) {
    text.push_str(open);
    expression(text, depth - 1, rng);
    text.push_str(close);
}

fn reference(text: &mut String, depth: usize, rng: &mut Rng) {
    text.push_str(rng.pick(&NAMES));
    for _ in 0..rng.below(3) {
        match rng.below(4) {
            0 => text.push_str(".member"),
            1 => text.push_str(".31"),
            2 => wrapped(".[", depth, "]", text, rng),
            _ => wrapped("[", depth, "]", text, rng),
        }
    }
}
