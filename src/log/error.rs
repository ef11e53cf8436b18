//! Why a log cannot be read.

use crate::text;
use std::path::PathBuf;

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
    /// nothing in it
    #[error("expected a telemetry log, got an empty file")]
    Empty,
    /// not a telemetry log
    #[error(
        "expected a telemetry log (8-byte stamp in microseconds, then a MAVLink frame, repeated), got a file that \
         begins with {first:02x?}{}",
        if *raw_capture { ": MAVLink frames without stamps" } else { "" }
    )]
    NotTlog {
        /// its first bytes
        first: Vec<u8>,
        /// it begins with a frame: a raw capture
        raw_capture: bool,
    },
    /// the file's name does not say what it is
    #[error("expected a log named *.tlog or *.csv, got {}", text::path(&path))]
    UnknownFormat {
        /// which file
        path: PathBuf,
    },
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
    },
    /// the chosen vehicle does not speak in it
    #[error("expected frames of system {wanted}, got system(s) {}", list(systems))]
    SystemAbsent {
        /// which was chosen
        wanted: SystemId,
        /// who speaks
        systems: Vec<SystemId>,
    },
}

fn list(systems: &[SystemId]) -> String {
    systems.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
