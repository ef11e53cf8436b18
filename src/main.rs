//! `mavid`: parses the command line, runs the verb, and turns its outcome into the exit status. It installs the
//! subscriber of the program: the library says what it does as tracing spans and events.

mod cli;
mod commands;

use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match cli::Cli::of(std::env::args_os()) {
        Ok(cli) => cli,
        Err(usage) => return commands::usage(usage),
    };
    let stderr = match commands::install(&cli.verbosity, cli.color, cli.verb.is_live()) {
        Ok(stderr) => stderr,
        Err(error) => return commands::failed(&error, cli.json).into(),
    };
    let status = match commands::run(&cli, &stderr) {
        Ok(outcome) => outcome.into(),
        Err(error) => commands::failed(&error, cli.json).into(),
    };
    stderr.finish();
    status
}
