//! The program `iecc`: arguments in, files and messages out.
//!
//! Each command is one file. Results go to files or standard output, messages to standard error.
//! Exit code 0: done; 1: the program has errors and nothing was written; 2: wrong usage;
//! 101: a mistake in iecc itself, with a request to report it.

mod explain;
mod terminal;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Compiles programs for industrial controllers.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 the program has errors, nothing was written; 2 wrong usage.";

#[derive(Debug, Subcommand)]
enum Command {
    Explain(explain::Arguments),
}

fn main() -> ExitCode {
    terminal::report_own_mistakes();
    match Arguments::parse().command {
        Command::Explain(arguments) => explain::run(&arguments),
    }
}
