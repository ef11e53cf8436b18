//! The command line as a whole: a verb, and what holds for each.

use clap::{Parser, Subcommand};

use super::compare::CompareArgs;
use super::convert::ConvertArgs;
use super::fleet::{FleetArgs, FleetLogArgs};
use super::flight::FlyArgs;
use super::live::{DemoArgs, RecordArgs, ReplayArgs, SitlArgs};
use super::model::{ExportArgs, SimulateArgs, VehicleArgs};
use super::onboard::LogArgs;
use super::plan::PlanArgs;
use super::recording::{ExplainArgs, IdentifyArgs, InspectArgs, ProveArgs, RedactArgs, ValidateArgs};
use super::run::RunArgs;
use super::verbosity::Verbosity;

/// Identifies a multirotor's parameters from a flight and names the physical effects that the model lacks
#[derive(Debug, Parser)]
#[command(name = "mavid", version, arg_required_else_help = true, after_help = AFTER_HELP)]
pub struct Cli {
    /// Print one JSON document on standard output and nothing else there
    #[arg(long, global = true)]
    pub json: bool,
    /// how much is said
    #[command(flatten)]
    pub verbosity: Verbosity,
    /// what to do
    #[command(subcommand)]
    pub verb: Verb,
}

const AFTER_HELP: &str = "Exit status: 0 done, 1 failure, 2 bad usage or input, 3 done with loss, 4 done and something changed (compare, fleet report).";

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// From a vehicle to what its model lacks, step by step: plan, check, fly, explain, until every name is certain
    Run(RunArgs),
    /// Plan, fly, identify and explain the flight of a simulated vehicle with a concealed fault, in under two minutes
    Demo(DemoArgs),
    /// Check a vehicle file (or a model) and print what follows from it
    Vehicle(VehicleArgs),
    /// Plan an excitation trajectory inside limits, or check one
    Plan(PlanArgs),
    /// Identify mass and inertia from recorded flights
    Identify(IdentifyArgs),
    /// Simulate the flight of a vehicle along a trajectory and write its log
    Simulate(SimulateArgs),
    /// Fly a vehicle along a trajectory, record the flight and identify the vehicle from it
    Fly(FlyArgs),
    /// Run the embedded simulated vehicle, for any ground station
    Sitl(SitlArgs),
    /// Compare models with recorded flights: closed loop, output prediction, open-loop playback
    Validate(ValidateArgs),
    /// Report what is in a log and what can be identified from it
    Inspect(InspectArgs),
    /// Record a MAVLink link until interrupted
    Record(RecordArgs),
    /// List and fetch the logs that a vehicle keeps of its flights
    Log(LogArgs),
    /// Play a recorded flight back as live traffic; nothing is commanded
    Replay(ReplayArgs),
    /// Locate the mismatch between model and recording and name the missing physical effects
    Explain(ExplainArgs),
    /// Say what changed of a vehicle between flights: which rotor, the centre of mass, which parameter
    Compare(CompareArgs),
    /// Write the streams of a log as CSV, MCAP or Parquet, with what an explanation leaves of them
    Convert(ConvertArgs),
    /// Make tables of the logs of many vehicles, and say which of them changed
    Fleet(FleetArgs),
    /// Study one log for `mavid fleet`, in a process of its own
    #[command(hide = true)]
    FleetLog(FleetLogArgs),
    /// Write a model for another simulator
    Export(ExportArgs),
    /// Explain a folder of cases and score the sealed verdicts against their answers
    Prove(ProveArgs),
    /// Write a log to share: without positions on the Earth, serial numbers and keys
    Redact(RedactArgs),
}

impl Verb {
    /// It talks to vehicles: nothing in it waits for standard error.
    pub fn is_live(&self) -> bool {
        matches!(
            self,
            Self::Run(_) | Self::Demo(_) | Self::Fly(_) | Self::Sitl(_) | Self::Record(_) | Self::Replay(_)
        )
    }
}
