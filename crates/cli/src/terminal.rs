//! What is printed, and how iecc speaks of its own mistakes.

use std::io::{self, Write};
use std::panic;
use std::process::ExitCode;

/// Exit code: the program has errors.
const ERRORS: u8 = 1;
/// Exit code: wrong usage. clap uses the same.
const USAGE: u8 = 2;

/// The exit code of a run whose program has errors.
pub(crate) fn errors() -> ExitCode {
    ExitCode::from(ERRORS)
}

/// Says what is wrong with the arguments, as clap does.
pub(crate) fn wrong_usage(message: &str) -> ExitCode {
    complain(&format!("error: {message}"));
    ExitCode::from(USAGE)
}

/// Prints results. A reader that has gone away (`iecc explain | head`) is no mistake.
pub(crate) fn print(text: &str) {
    drop(io::stdout().lock().write_all(text.as_bytes()));
}

/// Prints a line for the person at the terminal.
pub(crate) fn complain(line: &str) {
    drop(writeln!(io::stderr().lock(), "{line}"));
}

/// Whatever panics is a mistake of ours: say so, and what helps to find it.
pub(crate) fn report_own_mistakes() {
    let standard = panic::take_hook();
    panic::set_hook(Box::new(move |information| {
        standard(information);
        complain(concat!(
            "error: this is a mistake in iecc ",
            env!("CARGO_PKG_VERSION"),
            ", not in your program\nPlease report it with the lines above and the file: ",
            env!("CARGO_PKG_REPOSITORY"),
            "/issues"
        ));
    }));
}
