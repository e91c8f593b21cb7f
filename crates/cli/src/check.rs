//! `iecc check`: everything that is wrong with a program, and nothing else.

use crate::messages::Messages;
use crate::program::Program;

/// Say what is wrong with a program
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    program: Program,
}

pub(crate) fn run(arguments: &Arguments, messages: &mut Messages) {
    arguments.program.check(messages);
}
