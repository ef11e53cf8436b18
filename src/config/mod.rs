//! Configuration files: what the user wrote (TOML, unknown keys refused), then what it means (checked, SI).

mod check;
mod csv_mapping;
mod trajectory;
mod vehicle;
mod vehicle_file;
mod vehicle_writer;

pub use csv_mapping::{default_csv_mapping, load_csv_mapping, parse_csv_mapping};
pub use trajectory::{
    StoredTrajectory, StoredTransitions, parse_limits, parse_trajectory, read_limits, read_trajectory,
    trajectory_to_toml,
};
pub use vehicle::{LoadedVehicle, ModelTables, load_vehicle, parse_vehicle, read_vehicle};
pub use vehicle_writer::vehicle_to_toml;

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
    /// not TOML, a key that does not exist, a key that is missing, or a value of the wrong kind
    #[error("{origin}: {source}")]
    Parse {
        /// file name, or what the text is
        origin: String,
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

/// The text of a configuration file.
fn read_text(path: &Path) -> Result<String, ConfigError> {
    std::fs::read_to_string(path).map_err(|source| ConfigError::Read { path: path.to_owned(), source })
}

/// TOML text to the form `T`, with `origin` named in the error.
fn parse_toml<T: serde::de::DeserializeOwned>(text: &str, origin: &str) -> Result<T, ConfigError> {
    toml::from_str(text)
        .map_err(|source| ConfigError::Parse { origin: origin.to_owned(), source: Box::new(source) })
}
