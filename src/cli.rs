//! The command line: one struct a verb.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Learns a multirotor's parameters from a recorded flight and says which physics the model left out
#[derive(Debug, Parser)]
#[command(name = "mavid", version, arg_required_else_help = true, after_help = AFTER_HELP)]
pub struct Cli {
    /// Print one JSON document on standard output and nothing else there
    #[arg(long, global = true)]
    pub json: bool,
    /// what to do
    #[command(subcommand)]
    pub verb: Verb,
}

const AFTER_HELP: &str = "Exit status: 0 done, 1 failure, 2 bad usage or input, 3 done with loss.";

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Check a vehicle file (or a model) and say what it means
    Vehicle(VehicleArgs),
    /// Say what is in a log and what can be identified from it
    Inspect(InspectArgs),
}

/// Arguments of `mavid vehicle`.
#[derive(Debug, Args)]
pub struct VehicleArgs {
    /// vehicle.toml or model.toml
    pub file: PathBuf,
}

/// Arguments of `mavid inspect`.
#[derive(Debug, Args)]
pub struct InspectArgs {
    /// flight.tlog or flight.csv
    pub log: PathBuf,
    /// vehicle.toml or model.toml: says how well each parameter can be identified
    #[arg(long)]
    pub vehicle: Option<PathBuf>,
    /// what the columns of a CSV file mean (default: configs/csv/default.toml)
    #[arg(long)]
    pub csv_map: Option<PathBuf>,
    /// the vehicle's MAVLink system id, where a log holds several
    #[arg(long)]
    pub system: Option<u32>,
}
