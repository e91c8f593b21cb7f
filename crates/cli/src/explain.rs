//! `iecc explain`: the page of a code or an instruction, or the list of all.

use crate::terminal;
use iecc_diag::Code;
use iecc_driver::{explain_instruction, list_instructions};
use std::fmt::Write;

/// Explain a message code or an instruction, or list all codes
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A code such as E5003, an instruction such as TON, or `instructions` for the list of these
    topic: Option<String>,
}

/// Prints the page.
///
/// # Errors
/// There is no such topic.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let page = match &arguments.topic {
        None => list_of_codes(),
        Some(topic) if topic.eq_ignore_ascii_case("instructions") => list_instructions(),
        Some(topic) => page(topic)?,
    };
    terminal::print(&page);
    Ok(())
}

fn page(topic: &str) -> Result<String, String> {
    if let Some(code) = Code::parse(topic) {
        return Ok(code.explanation().to_owned());
    }
    explain_instruction(topic).ok_or_else(|| {
        format!(
            "there is no code or instruction `{topic}`; `iecc explain` lists the codes and \
             `iecc explain instructions` the instructions"
        )
    })
}

fn list_of_codes() -> String {
    let mut text = String::new();
    for code in Code::ALL {
        let severity = code.severity().as_str();
        writeln!(text, "{code}  {severity:7}  {}", code.title()).expect("writing to memory");
    }
    text
}
