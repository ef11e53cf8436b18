//! Arguments of the verbs for logs that a vehicle keeps.

use super::address::ADDRESS;
use clap::{Args, Subcommand, ValueEnum};
use mavid::fetch::Protocol;
use std::path::PathBuf;

/// Arguments of `mavid log`.
#[derive(Debug, Clone, Args)]
pub struct LogArgs {
    /// what to do with them
    #[command(subcommand)]
    pub verb: LogVerb,
}

/// What `mavid log` does.
#[derive(Debug, Clone, Subcommand)]
pub enum LogVerb {
    /// List the logs that a vehicle keeps
    #[command(after_help = "Example:\n  mavid log list --connect udpin:0.0.0.0:14550")]
    List(LogListArgs),
    /// Fetch a log from a vehicle; nothing on it is erased
    #[command(after_help = "Example:\n  mavid log fetch --connect udpin:0.0.0.0:14550 --last --out logs")]
    Fetch(LogFetchArgs),
    /// Say what a vehicle will log in flight, set what an identification needs, or put it back
    #[command(
        after_help = "Examples:\n  mavid log prepare --connect udpin:0.0.0.0:14550\n  mavid log prepare --connect udpin:0.0.0.0:14550 --restore"
    )]
    Prepare(LogPrepareArgs),
}

/// The vehicle whose logs are meant.
#[derive(Debug, Clone, Args)]
pub struct VehicleLinkArgs {
    #[arg(long, value_name = "ADDRESS", help = ADDRESS)]
    pub connect: String,
    /// the vehicle's MAVLink system id; without it the only vehicle on the link
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u32).range(1..=255))]
    pub system_id: Option<u32>,
    /// key that signs what is sent
    #[arg(long, value_name = "FILE")]
    pub signing_key_file: Option<PathBuf>,
}

/// Arguments of `mavid log list`.
#[derive(Debug, Clone, Args)]
pub struct LogListArgs {
    /// the vehicle
    #[command(flatten)]
    pub link: VehicleLinkArgs,
    /// how; without it by file transfer where the vehicle has it
    #[arg(long, value_enum)]
    pub protocol: Option<ProtocolName>,
}

/// Arguments of `mavid log prepare`.
#[derive(Debug, Clone, Args)]
pub struct LogPrepareArgs {
    /// the vehicle
    #[command(flatten)]
    pub link: VehicleLinkArgs,
    /// set the parameters that an identification needs, without asking
    #[arg(long, conflicts_with = "restore")]
    pub set_logging: bool,
    /// with --set-logging: restart the autopilot where what is set counts only then, and wait until it is back
    #[arg(long, requires = "set_logging")]
    pub restart: bool,
    /// put back what an earlier run changed on this vehicle
    #[arg(long)]
    pub restore: bool,
}

/// Arguments of `mavid log fetch`.
#[derive(Debug, Clone, Args)]
pub struct LogFetchArgs {
    /// the vehicle
    #[command(flatten)]
    pub link: VehicleLinkArgs,
    /// the last log; so it is without --id, unless the folder holds a part of another: the rest of that is fetched
    #[arg(long, conflicts_with = "id")]
    pub last: bool,
    /// the log of this number of the list
    #[arg(long, value_name = "N")]
    pub id: Option<u32>,
    /// folder for the log
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub out: PathBuf,
    /// how; without it by file transfer where the vehicle has it
    #[arg(long, value_enum)]
    pub protocol: Option<ProtocolName>,
}

/// Names of the protocols.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ProtocolName {
    /// MAVLink's file transfer, in bursts and with a checksum
    Ftp,
    /// the older log messages
    Log,
}

impl From<ProtocolName> for Protocol {
    fn from(name: ProtocolName) -> Self {
        match name {
            ProtocolName::Ftp => Self::Ftp,
            ProtocolName::Log => Self::Log,
        }
    }
}
