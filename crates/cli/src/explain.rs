//! `iecc explain`: the page of a code, or the list of all codes.

use crate::terminal;
use iecc_diag::Code;
use std::fmt::Write;
use std::process::ExitCode;

/// Explain a message code, or list all of them
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A code such as E5003
    topic: Option<String>,
}

pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    let Some(topic) = &arguments.topic else {
        terminal::print(&list_of_codes());
        return ExitCode::SUCCESS;
    };
    match Code::parse(topic) {
        Some(code) => terminal::print(code.explanation()),
        None => return unknown(topic),
    }
    ExitCode::SUCCESS
}

fn list_of_codes() -> String {
    let mut text = String::new();
    for code in Code::ALL {
        let severity = code.severity().as_str();
        writeln!(text, "{code}  {severity:7}  {}", code.title()).expect("writing to memory");
    }
    text
}

fn unknown(topic: &str) -> ExitCode {
    terminal::complain(&format!(
        "error: there is no code `{topic}`; `iecc explain` lists all"
    ));
    ExitCode::from(terminal::USAGE)
}
