//! `mavid`: parses the command line, runs the verb, and turns its outcome into the exit status.

mod cli;
mod commands;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match cli::Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) => return commands::usage(usage),
    };
    match commands::run(&cli) {
        Ok(outcome) => outcome.into(),
        Err(error) => error.report().into(),
    }
}
