//! Why a log cannot be read.

use std::path::PathBuf;

use super::csv::CsvError;
use crate::text;
use crate::wire::SystemId;

/// Why a log cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// the file cannot be opened
    #[error("cannot open {}: {source}", text::path(&path))]
    Open {
        /// which file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// reading stopped midway
    #[error("reading failed at byte {offset}: {source}")]
    Read {
        /// bytes read until then
        offset: u64,
        /// what the system said
        source: std::io::Error,
    },
    /// a file of no known format
    #[error("expected a {expected}, got {came}: {advice}")]
    UnknownFormat {
        /// the formats that are read
        expected: String,
        /// what it is
        came: String,
        /// what to do with it
        advice: &'static str,
    },
    /// what stands in it is not of its format
    #[error("expected a {format} ({expected}), got {came}")]
    WrongContent {
        /// the format
        format: &'static str,
        /// what stands in a file of it
        expected: &'static str,
        /// what stands in this one
        came: String,
    },
    /// nothing in it
    #[error("expected a telemetry log, got an empty file")]
    Empty,
    /// no vehicle speaks in it
    #[error("expected a HEARTBEAT of a vehicle, got frames of system(s) {} only", list(systems))]
    NoVehicle {
        /// who speaks
        systems: Vec<SystemId>,
    },
    /// more than one vehicle and none chosen
    #[error(
        "expected one vehicle that flew, got systems {}, which {}: name the one that is meant (--system-id)",
        list(systems),
        if *flew { "all flew" } else { "all send motion and none of which flew" }
    )]
    SeveralVehicles {
        /// they flew; otherwise nobody did
        flew: bool,
        /// the vehicles
        systems: Vec<SystemId>,
        /// the first vehicle that speaks in the log
        first: SystemId,
    },
    /// what was streamed is of another vehicle than the one that flew
    #[error(
        "expected the first vehicle of the log to be the one that flew, got system {system} in the air (--system-id)"
    )]
    OtherFlew {
        /// the one that flew
        system: SystemId,
    },
    /// the chosen vehicle does not speak in it
    #[error("expected frames of system {requested}, got system(s) {}", list(systems))]
    SystemAbsent {
        /// which was chosen
        requested: SystemId,
        /// who speaks
        systems: Vec<SystemId>,
    },
    /// a table that cannot be read
    #[error(transparent)]
    Table(#[from] CsvError),
}

fn list(systems: &[SystemId]) -> String {
    systems.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
