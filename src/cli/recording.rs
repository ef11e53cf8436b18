//! Arguments of the verbs that read recordings of flights.

use super::given::{GivenArgs, ShapeArgs, kilograms};
use clap::{ArgGroup, Args};
use mavid::study::ReadSettings;
use mavid::wire::SystemId;
use std::path::PathBuf;

/// Arguments of `mavid identify`.
#[derive(Debug, Args)]
pub struct IdentifyArgs {
    /// recordings of one vehicle: .tlog, .ulg, .bin, or .csv with known columns
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// the vehicle
    #[command(flatten)]
    pub given: GivenArgs,
    /// write the identified vehicle here, and a report beside it under the same name with .html
    #[arg(long, value_name = "MODEL.TOML")]
    pub out: Option<PathBuf>,
    /// write the report here
    #[arg(long, value_name = "FILE.HTML")]
    pub report: Option<PathBuf>,
    /// write the parameters over time here as a chart
    #[arg(long, value_name = "FILE.SVG")]
    pub chart: Option<PathBuf>,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
    /// time left out at the beginning of the flight, s [default: 10, at most a fifth of the flight]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub transient: Option<f64>,
    /// cut-off of the zero-phase low-pass, Hz; without it ten times the trajectory's highest harmonic
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub cutoff: Option<f64>,
    /// use the 31-tap windowed filter in place of the Butterworth filter
    #[arg(long)]
    pub fir: bool,
    /// adaptation gain of gradient descent
    #[arg(long, default_value_t = mavid::estimate::PAPER_SIGMA, allow_negative_numbers = true)]
    pub sigma: f64,
    /// use commands even if rotor speeds are measured
    #[arg(long)]
    pub commands: bool,
    /// identify these physical effects together with the rigid body, by the names that `explain` gives them
    #[arg(long, value_name = "EFFECT,...", value_delimiter = ',')]
    pub with: Vec<String>,
}

/// Arguments of `mavid explain`.
#[derive(Debug, Args)]
pub struct ExplainArgs {
    /// recordings of one vehicle: .tlog, .ulg, .bin, or .csv with known columns
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// the vehicle
    #[command(flatten)]
    pub given: GivenArgs,
    /// other flights of the same vehicle, on which the improvement is shown; without them the end of the
    /// flight is held back for it
    #[arg(long, value_name = "LOG", num_args = 1..)]
    pub holdout: Vec<PathBuf>,
    /// design the flight that best separates what these flights cannot separate, and write its trajectory here
    #[arg(long, value_name = "TRAJECTORY.TOML")]
    pub next: Option<PathBuf>,
    /// with --next: file with a [limits] table, instead of the vehicle's
    #[arg(long, value_name = "FILE", requires = "next")]
    pub limits: Option<PathBuf>,
    /// write report.html, report.md (the text of --format md), report.txt, model.toml and explanation.json into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// what is printed: text for a terminal, or md, a summary in Markdown to paste into a forum or an issue
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = PageFormat::Text, conflicts_with = "json")]
    pub format: PageFormat,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
    /// time left out at the beginning of the flight, s
    #[arg(long, value_name = "S", default_value_t = mavid::study::ExplainRequest::TRANSIENT_S, allow_negative_numbers = true)]
    pub transient: f64,
}

/// Arguments of `mavid redact`.
#[derive(Debug, Args)]
pub struct RedactArgs {
    /// recording: .tlog, .ulg or .bin
    pub log: PathBuf,
    /// write the redacted log here
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// replace --out if it exists
    #[arg(long)]
    pub force: bool,
}

/// How an answer is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum PageFormat {
    /// for a terminal
    Text,
    /// Markdown
    Md,
}

/// Arguments of `mavid validate`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("compared").required(true).multiple(true).args(["models", "mass"]))]
pub struct ValidateArgs {
    /// recordings of one vehicle: .tlog, .ulg, .bin, or .csv with known columns
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// a vehicle or model file; the first is the reference for the others
    #[arg(long = "model", value_name = "FILE")]
    pub models: Vec<PathBuf>,
    /// a vehicle of this mass with battery, kg, as a further model, before all others. The rest comes from the first log's
    /// parameters, its flight and rules of thumb
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
    /// write report.html, and charts of each flight simulated in closed loop, into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
    /// time left out at the beginning of the flight, s
    #[arg(long, value_name = "S", default_value_t = 10.0, allow_negative_numbers = true)]
    pub transient: f64,
}

/// Arguments of `mavid inspect`.
#[derive(Debug, Args)]
pub struct InspectArgs {
    /// recording: .tlog, .ulg, .bin, or .csv with known columns
    pub log: PathBuf,
    /// vehicle.toml or model.toml: adds how well each parameter can be identified
    #[arg(long, conflicts_with_all = ["mass", "size", "frame"])]
    pub vehicle: Option<PathBuf>,
    /// in place of --vehicle: mass with battery, kg
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// its shape
    #[command(flatten)]
    pub shape: ShapeArgs,
    /// how the recordings are read
    #[command(flatten)]
    pub read: ReadArgs,
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

/// How recordings are read.
#[derive(Debug, Default, Args)]
pub struct ReadArgs {
    /// meaning of the columns of a CSV file; without it the names in configs/csv/default.toml
    #[arg(long, value_name = "FILE")]
    pub csv_map: Option<PathBuf>,
    /// MAVLink system id of the vehicle; without it the only vehicle in the log that flew
    #[arg(long = "system-id", alias = "system", value_name = "ID")]
    pub system: Option<u32>,
}

impl ReadArgs {
    /// As a study takes them.
    pub fn settings(&self) -> ReadSettings {
        ReadSettings { csv_map: self.csv_map.clone(), system: self.system.map(SystemId) }
    }
}
