//! The work on one log: what goes into the function that makes its rows.

use std::path::PathBuf;

use super::vehicles::Vehicles;
use crate::study::Depth;
use crate::text;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The work on one log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LogTask {
    /// where it was found, which names it in the tables
    pub uri: String,
    /// the file
    pub path: PathBuf,
    /// SHA-256 of its bytes
    pub sha256: String,
    /// its size
    pub bytes: u64,
    /// how it is studied
    pub settings: LogSettings,
}

/// How each log is studied. Two runs with the same settings make the same rows of the same bytes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LogSettings {
    /// how deep
    pub depth: Depth,
    /// the vehicles that are known
    pub vehicles: Vehicles,
    /// meaning of the columns of tables
    pub csv_map: Option<PathBuf>,
    /// SHA-256 of the files that these name
    pub files: Vec<String>,
}

impl LogSettings {
    /// SHA-256 over all of it and the program's version, hexadecimal.
    #[must_use]
    pub fn digest(&self) -> String {
        let written = text::json_line(self).unwrap_or_default();
        hexadecimal(&Sha256::digest(format!("{} {written}", program()).as_bytes()))
    }
}

/// Name and version of this program.
#[must_use]
pub fn program() -> String {
    format!("mavid {}", env!("CARGO_PKG_VERSION"))
}

/// Bytes as text.
#[must_use]
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
