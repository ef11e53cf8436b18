//! Loads recordings, whatever their format.

use mavid::config::{default_csv_mapping, load_csv_mapping};
use mavid::log::{LoadOptions, Recording, SystemId, csv, shared_share};
use mavid::report::InputFile;
use mavid::signals::{ConditionSettings, Signals, condition};
use mavid::text;
use mavid::vehicle::Vehicle;
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::path::Path;

use super::CommandError;
use crate::cli::ReadArgs;

/// A recording and the file that it came from.
#[derive(Debug)]
pub struct Flight {
    /// the recording
    pub recording: Recording,
    /// name, hash, losses
    pub input: InputFile,
}

impl Flight {
    /// Conditioned for a vehicle of this file. A refusal names the log, the vehicle's file, and what was lost of
    /// the log in reading.
    pub fn conditioned(
        &self,
        (vehicle, file): (&Vehicle, &Path),
        settings: &ConditionSettings,
    ) -> Result<Signals, CommandError> {
        condition(&self.recording, vehicle, settings).map_err(|error| {
            let InputFile { path, losses, .. } = &self.input;
            let lost = if losses.is_empty() {
                String::new()
            } else {
                format!("; not read of the log: {}", losses.join("; "))
            };
            CommandError::Input(format!("{path} with {}: {error}{lost}", text::path(&file)))
        })
    }
}

/// Read by a mapping of its columns.
pub fn is_csv(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
}

/// Reads one recording.
pub fn load(path: &Path, read: &ReadArgs) -> Result<Flight, CommandError> {
    let named =
        |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", text::path(&path)));
    let (recording, losses) = if is_csv(path) {
        let mapping =
            read.csv_map.as_ref().map_or_else(default_csv_mapping, |file| load_csv_mapping(file))?;
        let (recording, report) =
            csv::read_csv(path, &mapping).map_err(|error| CommandError::Input(error.to_string()))?;
        (recording, report.losses())
    } else {
        let options = LoadOptions { system: read.system.map(SystemId) };
        let loaded = mavid::log::load(path, &options).map_err(|error| named(&error))?;
        (loaded.recording, loaded.report.losses())
    };
    let sha256 = sha256_of(path).map_err(|error| named(&error))?;
    Ok(Flight { recording, input: InputFile { path: text::path(&path), sha256, losses } })
}

/// A file that is no recording, for the provenance.
pub fn file(path: &Path) -> Result<InputFile, CommandError> {
    let sha256 =
        sha256_of(path).map_err(|error| CommandError::Input(format!("{}: {error}", text::path(&path))))?;
    Ok(InputFile { path: text::path(&path), sha256, losses: Vec::new() })
}

/// Share of a hold-out's samples that may be in an explained flight: none are, but for chance.
const MOST_SHARED: f64 = 0.02;

/// The share (0..1) of a recording that the other holds as well, where it is more than chance.
pub fn shared(of: &Recording, other: &Recording) -> Option<f64> {
    Some(shared_share(of, other)).filter(|share| *share > MOST_SHARED)
}

/// The same file twice is refused.
pub fn refuse_twins(inputs: &[&InputFile]) -> Result<(), CommandError> {
    for (index, input) in inputs.iter().enumerate() {
        if let Some(twin) = inputs[..index].iter().find(|other| other.sha256 == input.sha256) {
            return Err(CommandError::Input(format!(
                "{} and {} are the same recording byte for byte; expected different flights",
                twin.path, input.path
            )));
        }
    }
    Ok(())
}

fn sha256_of(path: &Path) -> std::io::Result<String> {
    let mut hasher = Sha256::new();
    std::io::copy(&mut std::fs::File::open(path)?, &mut hasher)?;
    Ok(hasher.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}
