//! The answer to a command line that asks for help, or that cannot be parsed.

use std::process::ExitCode;

use mavid::text;

use crate::cli::Cli;

/// Help and version on standard output with status 0, a mistake on standard error with status 2.
pub fn usage(usage: clap::Error) -> ExitCode {
    // an argument may command the terminal as any other text: told is what is wrong with one that does not
    let shown = std::env::args_os().map(|argument| text::path(&argument).into());
    let usage = Cli::of(shown).err().unwrap_or(usage);
    let printed = usage.print();
    match (usage.use_stderr(), printed) {
        (true, _) => ExitCode::from(2),
        (false, Ok(())) => ExitCode::SUCCESS,
        (false, Err(_)) => ExitCode::FAILURE,
    }
}
