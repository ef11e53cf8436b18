//! Configuration files: what the user wrote (TOML, unknown keys refused), then what it means (checked, SI).

mod check;
mod csv_mapping;
mod effect_tables;
mod kind;
mod trajectory;
mod vehicle;
mod vehicle_file;
mod vehicle_writer;

pub use csv_mapping::{default_csv_mapping, load_csv_mapping, parse_csv_mapping};
pub use effect_tables::{parse_effect_tables, read_effect_tables};
pub use trajectory::{
    StoredTrajectory, StoredTransitions, parse_limits, parse_trajectory, read_limits, read_trajectory,
    trajectory_to_toml,
};
pub use vehicle::{LoadedVehicle, ModelTables, load_vehicle, parse_vehicle, read_vehicle};
pub use vehicle_writer::vehicle_to_toml;

use kind::Kind;
use std::path::{Path, PathBuf};

/// Why a configuration file was refused.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// the file could not be read
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// which file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// bytes that are no text
    #[error("{}: expected {expected}, came a file that is no text", path.display())]
    NoText {
        /// which file
        path: PathBuf,
        /// what it was to be
        expected: &'static str,
    },
    /// a file of another kind
    #[error("{origin}: expected {expected}, came {came}")]
    OtherKind {
        /// file name, or what the text is
        origin: String,
        /// what it was to be
        expected: &'static str,
        /// what it is, by its keys
        came: String,
    },
    /// not TOML, a key that does not exist, a key that is missing, or a value of the wrong kind
    #[error("{origin}: expected {expected}: {source}")]
    Parse {
        /// file name, or what the text is
        origin: String,
        /// what it was to be
        expected: &'static str,
        /// line, column and key
        source: Box<toml::de::Error>,
    },
    /// a value, or several together, that cannot be
    #[error("{origin}: `{key}`: expected {expected}, came {came}")]
    Invalid {
        /// file name, or what the text is
        origin: String,
        /// key with its table, `body.mass`
        key: String,
        /// what would have been right
        expected: String,
        /// what the file says
        came: String,
    },
    /// a value that cannot be written as TOML
    #[error("cannot write as TOML: {0}")]
    Write(#[from] toml::ser::Error),
}

/// The text of a configuration file of this kind.
fn read_text(path: &Path, kind: Kind) -> Result<String, ConfigError> {
    std::fs::read_to_string(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::InvalidData => {
            ConfigError::NoText { path: path.to_owned(), expected: kind.expected() }
        }
        _ => ConfigError::Read { path: path.to_owned(), source },
    })
}

/// TOML text to the form `T` of a file of this kind, with `origin` named in the error.
fn parse_toml<T: serde::de::DeserializeOwned>(
    text: &str,
    origin: &str,
    kind: Kind,
) -> Result<T, ConfigError> {
    toml::from_str(text).map_err(|source| {
        let (origin, expected) = (origin.to_owned(), kind.expected());
        match kind.other(text) {
            Some(came) => ConfigError::OtherKind { origin, expected, came },
            None => ConfigError::Parse { origin, expected, source: Box::new(source) },
        }
    })
}
