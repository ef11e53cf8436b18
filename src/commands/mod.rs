//! One file a verb: loads, calls the library, prints. Nothing else of the program prints.
//!
//! To add a verb: a variant in [`Verb`], a file here with `run(json, args)`, and an arm in [`run`].

mod after_flight;
mod demo;
mod effects;
mod explain;
mod export;
mod flights;
mod fly;
mod identify;
mod inspect;
mod leftover;
mod live;
mod network;
mod output;
mod plan;
mod prove;
mod record;
mod replay;
mod simulate;
mod sitl;
mod teller;
mod validate;
mod vehicle;

use std::process::ExitCode;

use clap::Parser;
use mavid::text;

use crate::cli::{Cli, Verb};

/// How a verb ended that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// all of it
    Done,
    /// done, but something was lost or left out; the output says what
    DoneWithLoss,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Done => Self::SUCCESS,
            Outcome::DoneWithLoss => Self::from(3),
        }
    }
}

/// Why a verb did not do its work.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// what the user gave cannot be used
    #[error("{0}")]
    Input(String),
    /// the program or the machine failed
    #[error("{0}")]
    Failure(String),
    /// it failed and said so; the exit status
    #[error("it failed, and said why")]
    Told(u8),
}

impl From<mavid::config::ConfigError> for CommandError {
    fn from(error: mavid::config::ConfigError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<mavid::log::LogError> for CommandError {
    fn from(error: mavid::log::LogError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<mavid::log::csv::CsvError> for CommandError {
    fn from(error: mavid::log::csv::CsvError) -> Self {
        Self::Input(error.to_string())
    }
}

impl CommandError {
    /// Says it on standard error, unless that was done, and gives the exit status.
    pub fn report(&self) -> u8 {
        let status = match self {
            Self::Input(_) => 2,
            Self::Failure(_) => 1,
            Self::Told(status) => return *status,
        };
        output::message(&format!("mavid: {self}"));
        status
    }
}

/// Runs the verb.
pub fn run(cli: &Cli) -> Result<Outcome, CommandError> {
    match &cli.verb {
        Verb::Demo(args) => demo::run(cli.json, args),
        Verb::Vehicle(args) => vehicle::run(cli.json, args),
        Verb::Plan(args) => plan::run(cli.json, args),
        Verb::Identify(args) => identify::run(cli.json, args),
        Verb::Simulate(args) => simulate::run(cli.json, args),
        Verb::Fly(args) => fly::run(cli.json, args),
        Verb::Sitl(args) => sitl::run(cli.json, args),
        Verb::Validate(args) => validate::run(cli.json, args),
        Verb::Inspect(args) => inspect::run(cli.json, args),
        Verb::Record(args) => record::run(cli.json, args),
        Verb::Replay(args) => replay::run(cli.json, args),
        Verb::Explain(args) => explain::run(cli.json, args),
        Verb::Export(args) => export::run(cli.json, args),
        Verb::Prove(args) => prove::run(cli.json, args),
    }
}

/// Help and version on standard output with status 0, a mistake on standard error with status 2.
pub fn usage(usage: clap::Error) -> ExitCode {
    // an argument may command the terminal as any other text: told is what is wrong with one that does not
    let shown = std::env::args_os().map(|argument| text::path(&argument));
    let usage = Cli::try_parse_from(shown).err().unwrap_or(usage);
    let printed = usage.print();
    match (usage.use_stderr(), printed) {
        (true, _) => ExitCode::from(2),
        (false, Ok(())) => ExitCode::SUCCESS,
        (false, Err(_)) => ExitCode::FAILURE,
    }
}
