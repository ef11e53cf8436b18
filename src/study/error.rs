//! Why a study has no result.

use crate::config::ConfigError;
use crate::diagnose::ExplainError;
use crate::diagnose::joint::JointError;
use crate::estimate::EstimateError;
use crate::log::LogError;
use crate::plan::PlanError;
use crate::signals::SignalsError;

/// Why a study has no result. Each is of what went in: files, flights or settings.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// a vehicle file, model or mapping
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// a recording
    #[error(transparent)]
    Log(LogError),
    /// a setting of the request
    #[error("{name}: {why}")]
    Setting {
        /// as on the command line, without its hyphens
        name: &'static str,
        /// what was expected and what came
        why: String,
    },
    /// a file that cannot be used
    #[error("{file}: {why}")]
    File {
        /// its name as given
        file: String,
        /// what was expected and what came
        why: String,
    },
    /// a log in which no flight can be
    #[error("{file}: {why}")]
    NoFlight {
        /// its name as given
        file: String,
        /// what was expected and what came
        why: String,
    },
    /// a flight that shows no balance
    #[error("{file}: {why}")]
    NoBalance {
        /// name of the log, and which flight of it
        file: String,
        /// what was expected and what came
        why: String,
    },
    /// one recording was given twice
    #[error("{one} and {other} are the same recording byte for byte; expected different flights")]
    Twins {
        /// one name
        one: String,
        /// the other
        other: String,
    },
    /// fewer than two flights to compare
    #[error(
        "expected at least two flights, {came}: give two logs or more for a history, or BEFORE --with AFTER"
    )]
    TooFewFlights {
        /// what came
        came: String,
    },
    /// two recordings of one flight that are no two flights
    #[error("expected another flight, but {other} is another log of the flight of {one}, or of a part of it")]
    OneFlight {
        /// one name
        one: String,
        /// the other
        other: String,
    },
    /// a flight that cannot be conditioned for this vehicle
    #[error("{flight} with {vehicle}: {source}{}", lost(.losses))]
    Flight {
        /// name of the log, and which flight of it
        flight: String,
        /// name of the vehicle's file
        vehicle: String,
        /// why
        source: Box<SignalsError>,
        /// what of the log was not read
        losses: Vec<String>,
    },
    /// no flight keeps the limits, or the search cannot be asked for
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// a case that cannot be explained, or whose hold-out shows nothing
    #[error("{0}")]
    Case(String),
    /// nothing can be identified
    #[error(transparent)]
    Identify(#[from] EstimateError),
    /// nothing can be identified from logs that are damaged
    #[error("{error}{}", lost(losses))]
    IdentifyDamaged {
        /// why
        error: EstimateError,
        /// what of the logs could not be read
        losses: Vec<String>,
    },
    /// effects cannot be identified together with the rigid body
    #[error("{logs}: {source}")]
    Joint {
        /// names of the logs
        logs: String,
        /// why
        source: JointError,
    },
    /// settings of two kinds of methods at once
    #[error(
        "--cutoff, --fir and --sigma are for the methods LS, GD, FMLS and FMGD; expected them without --with, which fits the \
         weak form, where nothing is differentiated and nothing is low-passed"
    )]
    FilterWithEffects,
    /// the flights cannot be explained
    #[error("{logs}: {mismatch}{source}")]
    Explain {
        /// names of the logs
        logs: String,
        /// that they contradict the vehicle, as the beginning of the sentence; empty where they do not
        mismatch: String,
        /// why
        source: Box<ExplainError>,
    },
}

impl StudyError {
    /// Why nothing can be identified, with what of the logs could not be read.
    pub(super) fn of_estimate(error: EstimateError, losses: &[String]) -> Self {
        if losses.is_empty() {
            Self::Identify(error)
        } else {
            Self::IdentifyDamaged { error, losses: losses.to_vec() }
        }
    }

    /// Name of the log that it is about, and why that cannot be used; no name where it is about no single log.
    pub(super) fn of_log(&self) -> (String, String) {
        match self {
            Self::File { file, why } | Self::NoFlight { file, why } | Self::NoBalance { file, why } => {
                (file.clone(), why.clone())
            }
            Self::Flight { flight, source, losses, .. } => {
                (flight.clone(), format!("{source}{}", lost(losses)))
            }
            other => (String::new(), other.to_string()),
        }
    }
}

fn lost(losses: &[String]) -> String {
    if losses.is_empty() { String::new() } else { format!("; not read of the log: {}", losses.join("; ")) }
}
