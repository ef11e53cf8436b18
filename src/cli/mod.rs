//! The command line: one struct a verb.

mod live;

use clap::{Args, Parser, Subcommand, ValueEnum};
pub use live::{ArduPilotVersion, AutopilotName, DemoArgs, RecordArgs, ReplayArgs, SitlArgs};
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
    /// Plan, fly, identify and explain a simulated vehicle with something wrong about it, in under two minutes
    Demo(DemoArgs),
    /// Check a vehicle file (or a model) and say what it means
    Vehicle(VehicleArgs),
    /// Plan an excitation trajectory inside limits, or check one
    Plan(PlanArgs),
    /// Identify mass and inertia from recorded flights
    Identify(IdentifyArgs),
    /// Fly a vehicle along a trajectory in simulation and write its log
    Simulate(SimulateArgs),
    /// Fly a vehicle along a trajectory, record the flight and identify the vehicle from it
    Fly(FlyArgs),
    /// Run the embedded simulated vehicle, for any ground station
    Sitl(SitlArgs),
    /// Compare models with recorded flights: flown again, predicted, played back
    Validate(ValidateArgs),
    /// Say what is in a log and what can be identified from it
    Inspect(InspectArgs),
    /// Record a MAVLink link until interrupted
    Record(RecordArgs),
    /// Play a recorded flight back as live traffic; nothing is commanded
    Replay(ReplayArgs),
    /// Say where simulation and recording differ and which physics was left out
    Explain(ExplainArgs),
    /// Write a model for another simulator
    Export(ExportArgs),
    /// Explain a folder of cases and score the sealed verdicts against their answers
    Prove(ProveArgs),
}

/// Arguments of `mavid vehicle`.
#[derive(Debug, Args)]
pub struct VehicleArgs {
    /// vehicle.toml or model.toml
    pub file: PathBuf,
}

/// Arguments of `mavid plan`.
#[derive(Debug, Args)]
pub struct PlanArgs {
    /// vehicle.toml or model.toml
    pub vehicle: PathBuf,
    /// Where to write the trajectory
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// File with a [limits] table, instead of the vehicle's
    #[arg(long)]
    pub limits: Option<PathBuf>,
    /// What is minimised
    #[arg(long, value_enum, default_value = "cond")]
    pub criterion: CriterionName,
    /// Seed of the random starts
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Number of random starts
    #[arg(long, default_value_t = 16)]
    pub starts: u64,
    /// Periods to fly; comparing periods with each other needs four
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    pub repeats: u32,
    /// Period, s
    #[arg(long, default_value_t = 10.0, allow_negative_numbers = true)]
    pub period: f64,
    /// Harmonics of the series
    #[arg(long, default_value_t = 5)]
    pub harmonics: u32,
    /// Where the series starts and ends: metres and degrees; without Z the height is chosen
    #[arg(long, value_name = "X,Y[,Z[,YAW]]", value_delimiter = ',', allow_hyphen_values = true)]
    pub start: Option<Vec<f64>>,
    /// Check and assess this trajectory instead of planning one
    #[arg(long, value_name = "TRAJECTORY", conflicts_with_all = ["out", "start"])]
    pub check: Option<PathBuf>,
    /// The circular validation path (44) instead of a plan: metres, seconds a turn, metres of height;
    /// without HEIGHT the middle of the room's
    #[arg(long, value_name = "RADIUS,PERIOD[,HEIGHT]", value_delimiter = ',', allow_hyphen_values = true,
        conflicts_with_all = ["check", "start"])]
    pub circle: Option<Vec<f64>>,
    /// Where it hovers after takeoff, metres and degrees; without it at the series' mean
    #[arg(long, value_name = "X,Y,Z[,YAW]", value_delimiter = ',', allow_hyphen_values = true)]
    pub takeoff: Option<Vec<f64>>,
    /// Where it hovers before it lands; without it where it took off
    #[arg(long, value_name = "X,Y,Z[,YAW]", value_delimiter = ',', allow_hyphen_values = true)]
    pub landing: Option<Vec<f64>>,
}

/// Names of the criteria.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CriterionName {
    /// condition number of W, the paper's
    Cond,
    /// condition number of W with columns of unit norm
    ScaledCond,
    /// volume of the error ellipsoid
    DOpt,
    /// sum of squared relative standard errors
    AOpt,
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
    /// write the identified vehicle here, and a report beside it under the same name with .html
    #[arg(long, value_name = "MODEL.TOML")]
    pub out: Option<PathBuf>,
    /// write the report here
    #[arg(long, value_name = "FILE.HTML")]
    pub report: Option<PathBuf>,
    /// write the parameters along time here as a chart
    #[arg(long, value_name = "FILE.SVG")]
    pub chart: Option<PathBuf>,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
    /// s of flight left out at the beginning [default: 10, at most a fifth of the flight]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub transient: Option<f64>,
    /// cut-off of the zero-phase low-pass, Hz; without it ten times the trajectory's highest harmonic
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub cutoff: Option<f64>,
    /// use the 31-tap windowed filter in place of the Butterworth
    #[arg(long)]
    pub fir: bool,
    /// adaptation gain of gradient descent
    #[arg(long, default_value_t = mavid::estimate::PAPER_SIGMA, allow_negative_numbers = true)]
    pub sigma: f64,
    /// use commands even where rotor speeds are measured
    #[arg(long)]
    pub commands: bool,
    /// identify these physical effects together with the rigid body, by the names that `explain` gives them
    #[arg(long, value_name = "EFFECT,...", value_delimiter = ',')]
    pub with: Vec<String>,
}

/// Arguments of `mavid fly`.
#[derive(Debug, Clone, Args)]
pub struct FlyArgs {
    #[arg(long, value_name = "ADDRESS", help = live::ADDRESS)]
    pub connect: String,
    /// trajectory.toml
    #[arg(long, value_name = "FILE")]
    pub trajectory: PathBuf,
    /// vehicle.toml, or a model
    #[arg(long, value_name = "FILE")]
    pub vehicle: PathBuf,
    /// new folder for recording, events, parameters and results
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// arm the vehicle; without it everything is checked and nothing is armed
    #[arg(long)]
    pub arm: bool,
    /// do not ask for the word `arm` at a terminal before arming
    #[arg(long)]
    pub yes: bool,
    /// the vehicle's MAVLink system id; without it the only vehicle on the link
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u32).range(1..=255))]
    pub system_id: Option<u32>,
    /// our own MAVLink system id
    #[arg(long, value_name = "ID", default_value_t = 255, value_parser = clap::value_parser!(u32).range(1..=255))]
    pub station_id: u32,
    /// periods to fly, instead of the trajectory's own
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub repeats: Option<u32>,
    /// setpoints a second
    #[arg(long, value_name = "HZ", default_value_t = 50, value_parser = clap::value_parser!(u32).range(20..=200))]
    pub setpoint_hz: u32,
    /// where the trajectory's horizontal origin lies; its heights count from the ground
    #[arg(long, value_enum, default_value = "local")]
    pub origin: OriginName,
    /// distance to the reference at which the flight is aborted, m
    #[arg(long, value_name = "M", default_value_t = 1.0, allow_negative_numbers = true)]
    pub tracking_max: f64,
    /// tilt at which the flight is aborted, degrees [default: 20 more than planned]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub tilt_max: Option<f64>,
    /// s that the vehicle hovers on a full battery: the flight is then refused where the charge does not last for it
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub hover_time: Option<f64>,
    /// how near to its start the vehicle must hover before the trajectory begins, m [default: 0.3, or what it can do]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub gate_distance: Option<f64>,
    /// how slow it must be there, m/s [default: 0.2, or what it can do]
    #[arg(long, value_name = "M/S", allow_negative_numbers = true)]
    pub gate_speed: Option<f64>,
    /// a check whose refusal is taken for a warning; may be given several times
    #[arg(long, value_enum, value_name = "CHECK")]
    pub accept: Vec<CheckName>,
    /// key that signs what is sent
    #[arg(long, value_name = "FILE")]
    pub signing_key_file: Option<PathBuf>,
    /// lines instead of the terminal view
    #[arg(long)]
    pub plain: bool,
}

/// Checks that may be overruled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CheckName {
    /// that the vehicle file's thrust carries its weight by what the vehicle hovers on
    HoverThrust,
    /// that the vehicle file's rotors are as many and as far out as the autopilot's
    Rotors,
}

/// Where a trajectory's horizontal origin lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OriginName {
    /// at the origin of the vehicle's local position
    Local,
    /// so that the vehicle stands below the place of its takeoff
    Here,
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
    /// write report.html, and charts of each flight flown again, into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
    /// s of flight left out at the beginning
    #[arg(long, value_name = "S", default_value_t = 10.0, allow_negative_numbers = true)]
    pub transient: f64,
}

/// How recordings are read.
#[derive(Debug, Default, Args)]
pub struct ReadArgs {
    /// what the columns of a CSV mean; without it the names in configs/csv/default.toml
    #[arg(long, value_name = "FILE")]
    pub csv_map: Option<PathBuf>,
    /// MAVLink system id of the vehicle; without it the only one of the log that flew
    #[arg(long = "system-id", alias = "system", value_name = "ID")]
    pub system: Option<u32>,
}

/// Arguments of `mavid inspect`.
#[derive(Debug, Args)]
pub struct InspectArgs {
    /// flight.tlog or flight.csv
    pub log: PathBuf,
    /// vehicle.toml or model.toml: says how well each parameter can be identified
    #[arg(long)]
    pub vehicle: Option<PathBuf>,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
}

/// Arguments of `mavid explain`.
#[derive(Debug, Args)]
pub struct ExplainArgs {
    /// recordings of one vehicle: .tlog, or .csv with known columns
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// vehicle.toml, or a model
    #[arg(long)]
    pub vehicle: PathBuf,
    /// other flights of the same vehicle, on which the improvement is shown; without them the end of the
    /// flight is held back for it
    #[arg(long, value_name = "LOG", num_args = 1..)]
    pub holdout: Vec<PathBuf>,
    /// design the flight that best tells apart what these flights cannot, and write its trajectory here
    #[arg(long, value_name = "TRAJECTORY.TOML")]
    pub next: Option<PathBuf>,
    /// write report.html, model.toml and explanation.json into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
    /// s of flight left out at the beginning
    #[arg(long, value_name = "S", default_value_t = 1.0, allow_negative_numbers = true)]
    pub transient: f64,
}

/// Arguments of `mavid export`.
#[derive(Debug, Args)]
pub struct ExportArgs {
    /// model.toml or vehicle.toml
    pub model: PathBuf,
    /// for which simulator
    #[arg(long, value_enum)]
    pub to: ExportFormat,
    /// where to write it; without it standard output
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Names of the simulators.
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
}

/// Arguments of `mavid simulate`.
#[derive(Debug, Args)]
pub struct SimulateArgs {
    /// vehicle.toml or model.toml: what flies
    pub vehicle: PathBuf,
    /// trajectory.toml
    #[arg(long, value_name = "FILE")]
    pub trajectory: PathBuf,
    /// further effects: [[effect]] tables with `id` and the parameters by name
    #[arg(long, value_name = "FILE")]
    pub effects: Option<PathBuf>,
    /// the vehicle that the controller believes it flies; without it the one that flies
    #[arg(long, value_name = "FILE")]
    pub nominal: Option<PathBuf>,
    /// telemetry log to write
    #[arg(long, value_name = "LOG.TLOG")]
    pub out: PathBuf,
    /// same seed, same noise
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// factor on the sensors' noise
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub noise: f64,
}

/// Arguments of `mavid prove`.
#[derive(Debug, Args)]
pub struct ProveArgs {
    /// folder of cases, each with vehicle.toml, identify.tlog (or other logs) and, where there is one, holdout.tlog
    pub cases: PathBuf,
    /// what was concealed; opened after all verdicts are written and hashed
    #[arg(long, value_name = "FILE")]
    pub answers: Option<PathBuf>,
    /// write the verdicts into this folder
    #[arg(long, value_name = "DIR", default_value = "verdicts")]
    pub out: PathBuf,
}
