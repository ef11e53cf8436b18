//! Arguments of the verbs that take a vehicle or a model alone.

use super::given::{DraftArgs, ShapeArgs, kilograms};
use super::onboard::VehicleLinkArgs;
use super::recording::ReadArgs;
use clap::{ArgGroup, Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Arguments of `mavid vehicle`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct VehicleArgs {
    /// vehicle.toml or model.toml
    #[arg(required = true)]
    pub file: Option<PathBuf>,
    /// what else to do
    #[command(subcommand)]
    pub verb: Option<VehicleVerb>,
}

/// What `mavid vehicle` does beside checking a file.
#[derive(Debug, Subcommand)]
pub enum VehicleVerb {
    /// Write a first vehicle file from a log: rotors and thrust curve from the autopilot's parameters, thrust from the
    /// flight, the rest from rules of thumb, marked as guesses
    #[command(
        after_help = "Examples:\n  mavid vehicle init --from flight.ulg --mass 2.0 --out vehicle.toml\n  mavid vehicle init --from udpin:0.0.0.0:14550 --mass 2.0 --size 0.5 --out vehicle.toml"
    )]
    Init(InitArgs),
    /// Set the parameters of a file on a vehicle: shows old and new values, asks, keeps what was found, reads back
    #[command(
        after_help = "Examples:\n  mavid vehicle load --connect udpin:0.0.0.0:14550 vehicle.params\n  mavid vehicle load --connect udpin:0.0.0.0:14550 --undo"
    )]
    Load(LoadArgs),
}

/// Arguments of `mavid vehicle load`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("what").required(true).args(["file", "undo"]))]
pub struct LoadArgs {
    /// the vehicle
    #[command(flatten)]
    pub link: VehicleLinkArgs,
    /// the parameters, as `mavid export --to px4-params` or `ardupilot-params` or a ground station writes them
    pub file: Option<PathBuf>,
    /// put back what was found before a file was loaded onto this vehicle
    #[arg(long)]
    pub undo: bool,
    /// with --undo: put back also what somebody changed since; without it this stays as it is, and noted
    #[arg(long, requires = "undo")]
    pub overwrite: bool,
    /// set them without a question; --undo asks none
    #[arg(long)]
    pub yes: bool,
    /// leave out what the vehicle does not have; without it nothing is set then
    #[arg(long, conflicts_with = "undo")]
    pub known_only: bool,
    /// the vehicle is a simulator: take also a file with a simulator's own parameters (SIH_*, SIM_*). Without it that is refused, unless
    /// the vehicle's parameters say that it is a simulator
    #[arg(long, conflicts_with = "undo")]
    pub simulator: bool,
}

/// Arguments of `mavid vehicle init`.
#[derive(Debug, Args)]
pub struct InitArgs {
    /// a log that contains the vehicle's parameters, preferably with a flight; or the address of a vehicle, whose parameters
    /// are read
    #[arg(long, value_name = "LOG|ADDRESS")]
    pub from: PathBuf,
    /// mass with battery, kg: weigh it
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: f64,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
    /// what a thrust stand measured of one rotor, with command, thrust, torque, rotor speed and voltage by the header: in
    /// place of guesses
    #[arg(long, value_name = "FILE.CSV")]
    pub thrust_stand: Option<PathBuf>,
    /// where to write it
    #[arg(long, value_name = "VEHICLE.TOML")]
    pub out: PathBuf,
    /// replace an existing file
    #[arg(long)]
    pub force: bool,
    /// how the log is read
    #[command(flatten)]
    pub read: ReadArgs,
}

/// Arguments of `mavid simulate`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("simulated").required(true).args(["vehicle", "mass"]))]
pub struct SimulateArgs {
    /// vehicle.toml or model.toml of the simulated vehicle; required without --mass
    pub vehicle: Option<PathBuf>,
    /// in its place
    #[command(flatten)]
    pub draft: DraftArgs,
    /// trajectory.toml
    #[arg(long, value_name = "FILE")]
    pub trajectory: PathBuf,
    /// further effects: [[effect]] tables with `id` and the parameters by name
    #[arg(long, value_name = "FILE")]
    pub effects: Option<PathBuf>,
    /// the vehicle that the controller assumes; without it the simulated one
    #[arg(long, value_name = "FILE")]
    pub nominal: Option<PathBuf>,
    /// telemetry log to write
    #[arg(long, value_name = "LOG.TLOG")]
    pub out: PathBuf,
    /// seed of the noise; the same seed gives the same noise
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// factor on the sensors' noise
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub noise: f64,
}

/// Arguments of `mavid export`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("exported").required(true).args(["model", "mass"]))]
pub struct ExportArgs {
    /// model.toml or vehicle.toml; required without --mass
    pub model: Option<PathBuf>,
    /// in its place
    #[command(flatten)]
    pub draft: DraftArgs,
    /// for what: a simulator, or the aircraft's own autopilot (px4-params, ardupilot-params)
    #[arg(long, value_enum)]
    pub to: ExportFormat,
    /// with px4-params and ardupilot-params: height of the flight's place above the sea, m, for the density of its air
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub altitude: Option<f64>,
    /// file to write; without it standard output
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Names of the simulators and of the aircraft's own autopilots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ExportFormat {
    /// parameters of PX4's simulation in hardware
    Px4Sih,
    /// frame of ArduPilot's simulator: --model "x:frame.json"
    ArdupilotSitl,
    /// Gazebo
    Sdf,
    /// MuJoCo
    Mjcf,
    /// RotorPy
    Rotorpy,
    /// parameters of the aircraft's PX4 that follow from the model, each with its error and its reason
    Px4Params,
    /// parameters of the aircraft's ArduPilot that follow from the model, each with its error and its reason
    ArdupilotParams,
}
