//! What the instruction table says, for people.

use iecc_sema::hir::{CounterKind, Prescan, TimerKind};
use iecc_sema::logix::instructions::{INSTRUCTIONS, Meaning, OperandKind, Row, RungRule, find};
use std::fmt::Write;

/// A page on one instruction, under its old name or its new one; `None` if there is none.
pub fn explain_instruction(mnemonic: &str) -> Option<String> {
    let row = find(mnemonic)?;
    let mut page = format!("{}\n\n{}\n", title(row), rule(row.rule));
    for &(name, kind) in row.operands {
        if let Some(kind) = operand(kind) {
            writeln!(page, "  {name}: {kind}").expect("writing to memory");
        }
    }
    for &(index, prescan) in row.prescan {
        let name = row.operands[index].0;
        writeln!(page, "In prescan: {}", prescan_of(name, prescan)).expect("writing to memory");
    }
    page.push('\n');
    page.push_str(&status(row));
    page.push('\n');
    Some(page)
}

/// Every instruction on a line, with whether it is compiled.
pub fn list_instructions() -> String {
    let lines = INSTRUCTIONS.iter().map(|row| {
        let renamed = row.renamed.unwrap_or("");
        let line = format!("{:8}{renamed:8}{}", row.name, status(row));
        format!("{}\n", line.trim_end())
    });
    lines.collect()
}

fn title(row: &Row) -> String {
    let operands: Vec<_> = row.operands.iter().map(|(name, _)| *name).collect();
    let call = format!("{}({})", row.name, operands.join(", "));
    match row.renamed {
        Some(renamed) => format!("{call}, from revision 36 on {renamed}"),
        None => call,
    }
}

fn status(row: &Row) -> String {
    let Meaning::Refused(reason) = row.meaning else {
        return "compiled".to_owned();
    };
    format!("refused: {}", reason.explain())
}

fn rule(rule: RungRule) -> &'static str {
    match rule {
        RungRule::Input => "An input instruction: it may make the condition of the rung false.",
        RungRule::Output => "An output instruction: it passes on the condition of the rung.",
    }
}

fn operand(kind: OperandKind) -> Option<&'static str> {
    Some(match kind {
        OperandKind::Bit => "a BOOL or a bit of an integer",
        OperandKind::BitTarget => "a BOOL or a bit of an integer, written to",
        OperandKind::Number => "a number or a tag",
        OperandKind::Integer => "a whole number or an integer tag",
        OperandKind::NumberTarget => "a tag, written to",
        OperandKind::IntegerTarget => "an integer tag, written to",
        OperandKind::TimerTag => "a TIMER",
        OperandKind::CounterTag => "a COUNTER",
        OperandKind::Resettable => "a TIMER, COUNTER or CONTROL",
        OperandKind::InTag => {
            "`?`: the value stands in the tag; a number here was written at download"
        }
        OperandKind::Variable => "any number of them",
        OperandKind::Any => return None,
    })
}

fn prescan_of(name: &str, prescan: Prescan) -> String {
    let what = match prescan {
        Prescan::Clear => "becomes 0",
        Prescan::Set => "becomes 1",
        Prescan::Timer(TimerKind::OnDelay) => "gets EN, TT, DN and ACC 0",
        Prescan::Timer(TimerKind::OffDelay) => "gets EN, TT and DN 0, and ACC equal to PRE",
        Prescan::Timer(TimerKind::Retentive) => "gets EN, TT and DN 0, and keeps ACC",
        Prescan::Counter(CounterKind::Up) => "gets CU 1, so that a true rung does not count",
        Prescan::Counter(CounterKind::Down) => "gets CD 1, so that a true rung does not count",
    };
    format!("the {name} {what}.")
}
