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
    /// Identify mass and inertia from recorded flights
    Identify(IdentifyArgs),
    /// Compare models with recorded flights: flown again, predicted, played back
    Validate(ValidateArgs),
}

/// Arguments of `mavid vehicle`.
#[derive(Debug, Args)]
pub struct VehicleArgs {
    /// vehicle.toml or model.toml
    pub file: PathBuf,
}

/// Arguments of `mavid identify`.
#[derive(Debug, Args)]
pub struct IdentifyArgs {
    /// recordings of one vehicle: .tlog, or .csv with known columns
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// vehicle.toml, or a model
    #[arg(long)]
    pub vehicle: PathBuf,
    /// write the identified vehicle here
    #[arg(long, value_name = "MODEL.TOML")]
    pub out: Option<PathBuf>,
    /// write the parameters along time here as a chart
    #[arg(long, value_name = "FILE.SVG")]
    pub chart: Option<PathBuf>,
    /// what the columns of a CSV mean; without it the names in configs/csv/default.toml
    #[arg(long, value_name = "FILE")]
    pub csv_map: Option<PathBuf>,
    /// system id of the vehicle, where a log holds several
    #[arg(long, value_name = "ID")]
    pub system: Option<u8>,
    /// s of flight left out at the beginning
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    pub transient: f64,
    /// cut-off of the zero-phase low-pass, Hz; without it ten times the trajectory's highest harmonic
    #[arg(long, value_name = "HZ")]
    pub cutoff: Option<f64>,
    /// use the 31-tap windowed filter in place of the Butterworth
    #[arg(long)]
    pub fir: bool,
    /// adaptation gain of gradient descent
    #[arg(long, default_value_t = mavid::estimate::PAPER_SIGMA)]
    pub sigma: f64,
    /// use commands even where rotor speeds are measured
    #[arg(long)]
    pub commands: bool,
}

/// Arguments of `mavid validate`.
#[derive(Debug, Args)]
pub struct ValidateArgs {
    /// recordings of one vehicle: .tlog, or .csv with known columns
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// a vehicle or model file; the first is what the others are compared with
    #[arg(long = "model", required = true, value_name = "FILE")]
    pub models: Vec<PathBuf>,
    /// write charts of each flight flown again into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// what the columns of a CSV mean; without it the names in configs/csv/default.toml
    #[arg(long, value_name = "FILE")]
    pub csv_map: Option<PathBuf>,
    /// system id of the vehicle, where a log holds several
    #[arg(long, value_name = "ID")]
    pub system: Option<u8>,
    /// s of flight left out at the beginning
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    pub transient: f64,
}
