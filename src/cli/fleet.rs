//! Arguments of the verbs for many logs of many vehicles.

use super::given::{ShapeArgs, kilograms};
use clap::{Args, Subcommand, ValueEnum};
use mavid::fleet::Shard;
use mavid::study::Depth;
use std::path::PathBuf;

/// Arguments of `mavid fleet`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct FleetArgs {
    /// what to do with tables that are there
    #[command(subcommand)]
    pub verb: Option<FleetVerb>,
    /// what to make tables of
    #[command(flatten)]
    pub run: FleetRunArgs,
}

/// What `mavid fleet` does beside making tables.
#[derive(Debug, Subcommand)]
pub enum FleetVerb {
    /// Say which vehicles of a fleet changed, when, and which differ from the others of their type
    #[command(after_help = "Example:\n  mavid fleet report tables")]
    Report(FleetReportArgs),
    /// Print the rows of one log, as JSON lines table by table: what an engine that spreads logs over computers calls for each
    #[command(after_help = "Example:\n  mavid fleet rows flight.ulg --uri s3://flights/flight.ulg --json")]
    Rows(Box<FleetRowsArgs>),
    /// Print the tables with their columns, units and meanings
    #[command(after_help = "Example:\n  mavid fleet schema")]
    Schema,
}

/// Arguments of `mavid fleet SOURCE...`.
#[derive(Debug, Args)]
pub struct FleetRunArgs {
    /// logs: files, folders, patterns as 'logs/**/*.ulg', or addresses as 's3://flights/2026/*.ulg' (s3, gs, az, http, https; with the
    /// feature `fleet`)
    #[arg(required = true, value_name = "SOURCE")]
    pub sources: Vec<String>,
    /// write the tables into this folder, here or in a store; what is there already is not done again
    #[arg(long, value_name = "DIR", required = true)]
    pub out: Option<PathBuf>,
    /// how each log is studied
    #[command(flatten)]
    pub study: FleetStudyArgs,
    /// form of the tables; without it Parquet, or jsonl where this program was built without the feature `fleet`
    #[arg(long, value_enum)]
    pub format: Option<FormName>,
    /// logs that are studied at once [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// logs of one part of the tables
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub part_logs: u32,
    /// only this part of the logs: I of N, I from 0
    #[arg(long, value_name = "I/N", conflicts_with = "shards")]
    pub shard: Option<Shard>,
    /// so many runs share the logs; which one this is, JOB_COMPLETION_INDEX or SLURM_ARRAY_TASK_ID says
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub shards: Option<u32>,
}

/// How one log is studied, and what that may take.
#[derive(Debug, Args)]
pub struct FleetStudyArgs {
    /// what is known of the vehicles: [[vehicle]] with `name`, `file` or `mass`, and `logs`, `system` or `parameters`
    #[arg(long, value_name = "FILE")]
    pub vehicles: Option<PathBuf>,
    /// mass with battery of every vehicle that is not listed, kg; they are told apart by their logs
    #[arg(long, value_name = "KG", value_parser = kilograms, allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// their shape
    #[command(flatten)]
    pub shape: ShapeArgs,
    /// how deep each log is studied
    #[arg(long, value_enum, default_value_t)]
    pub depth: DepthName,
    /// processor time that one log may take, s; one that takes more is a row with that error
    #[arg(long, value_name = "S", default_value_t = 300, value_parser = clap::value_parser!(u64).range(1..=86_400))]
    pub log_time: u64,
    /// memory that one log may take, MB
    #[arg(long, value_name = "MB", default_value_t = 2048, value_parser = clap::value_parser!(u64).range(128..=1_048_576))]
    pub log_memory: u64,
    /// size that a log may have, MB
    #[arg(long, value_name = "MB", default_value_t = 4096, value_parser = clap::value_parser!(u64).range(1..=1_048_576))]
    pub log_size: u64,
    /// meaning of the columns of CSV files; without it the names in configs/csv/default.toml
    #[arg(long, value_name = "FILE")]
    pub csv_map: Option<PathBuf>,
}

/// Arguments of `mavid fleet rows LOG`.
#[derive(Debug, Args)]
pub struct FleetRowsArgs {
    /// the log
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
    /// name of the log in the tables [default: its path]
    #[arg(long, value_name = "URI")]
    pub uri: Option<String>,
    /// how it is studied
    #[command(flatten)]
    pub study: FleetStudyArgs,
}

/// How deep a log is studied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum DepthName {
    /// what is in it
    Inspect,
    /// the balance of each flight, power and vibration
    Balance,
    /// the parameters of its motion as well, and missing effects, where mass and lengths are known
    #[default]
    Explain,
}

impl From<DepthName> for Depth {
    fn from(name: DepthName) -> Self {
        match name {
            DepthName::Inspect => Self::Inspect,
            DepthName::Balance => Self::Balance,
            DepthName::Explain => Self::Explain,
        }
    }
}

/// Form of tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FormName {
    /// one JSON object a line
    Jsonl,
    /// Parquet
    Parquet,
}

/// Arguments of `mavid fleet report`.
#[derive(Debug, Args)]
pub struct FleetReportArgs {
    /// folder that `mavid fleet ... --out` wrote, here or in a store
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// write report.html and fleet.json into this folder [default: that of the tables]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// most unchanged vehicles that may be called changed, as a share
    #[arg(long, value_name = "SHARE", default_value_t = mavid::fleet::FALSE_ALARMS)]
    pub false_alarms: f64,
    /// shuffled histories by which that is calibrated
    #[arg(long, value_name = "N", default_value_t = mavid::fleet::SHUFFLES, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub shuffles: u32,
}

/// Arguments of the process that studies one log.
#[derive(Debug, Args)]
pub struct FleetLogArgs {
    /// processor time that it may take, s
    #[arg(long, value_name = "S")]
    pub time: u64,
    /// memory that it may take, MB
    #[arg(long, value_name = "MB")]
    pub memory: u64,
}
