//! The program `iecc`: arguments in, files and messages out.
//!
//! Each command is one file. Results go to files or standard output, messages to standard error.
//! Exit code 0: done; 1: the program has errors and nothing was built; 2: wrong usage; 101: a
//! mistake in iecc itself, with a request to report it.

mod build;
mod check;
mod conformance;
mod explain;
mod ir;
mod messages;
mod program;
mod run;
mod terminal;
mod test;

use clap::{Parser, Subcommand};
use messages::{Format, Messages};
use std::process::ExitCode;

/// A compiler makes and drops many small things; this takes about a fifth off its time.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Compiles programs for industrial controllers.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,

    /// How messages are written to standard error
    #[arg(
        long,
        global = true,
        value_enum,
        value_name = "FORMAT",
        default_value = "text"
    )]
    message_format: Format,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 the program has errors, nothing was built; 2 wrong usage.";

#[derive(Debug, Subcommand)]
enum Command {
    Build(build::Arguments),
    Check(check::Arguments),
    Run(run::Arguments),
    Test(test::Arguments),
    Ir(ir::Arguments),
    Explain(explain::Arguments),
    Conformance(conformance::Arguments),
}

fn main() -> ExitCode {
    terminal::report_own_mistakes();
    let Arguments {
        command,
        message_format,
    } = Arguments::parse();
    let mut messages = Messages::default();
    match command {
        Command::Build(arguments) => build::run(&arguments, &mut messages),
        Command::Check(arguments) => check::run(&arguments, &mut messages),
        Command::Run(arguments) => run::run(&arguments, &mut messages),
        Command::Test(arguments) => {
            if let Err(error) = test::run(&arguments, &mut messages) {
                return terminal::wrong_usage(&error);
            }
        }
        Command::Ir(arguments) => {
            if let Err(error) = ir::run(&arguments, &mut messages) {
                return terminal::wrong_usage(&error.to_string());
            }
        }
        Command::Conformance(arguments) => conformance::run(&arguments, &mut messages),
        Command::Explain(arguments) => {
            if let Err(error) = explain::run(&arguments) {
                return terminal::wrong_usage(&error);
            }
        }
    }
    messages.finish(message_format)
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        super::Arguments::command().debug_assert();
    }
}
