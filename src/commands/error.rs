//! The failure of a verb.

use mavid::onboard::OnboardError;
use mavid::plan::PlanError;

/// Why a verb did not do its work.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// what the user gave cannot be used
    #[error("{0}")]
    Input(String),
    /// the same, several errors at once: a line each
    #[error("{}", .0.join("; "))]
    Inputs(Vec<String>),
    /// the program or the machine failed
    #[error("{0}")]
    Failure(String),
    /// a signal, or the end of standard input at a question, ended it before it was done
    #[error("{0}")]
    Ended(String),
    /// it failed and said so; the exit status
    #[error("it failed, and said why")]
    Reported(u8),
}

impl From<mavid::config::ConfigError> for CommandError {
    fn from(error: mavid::config::ConfigError) -> Self {
        let mut lines = error.lines();
        match (lines.pop(), lines.is_empty()) {
            (Some(one), true) => Self::Input(one),
            (last, _) => {
                lines.extend(last);
                Self::Inputs(lines)
            }
        }
    }
}

/// A setting is named as on the command line.
impl From<mavid::study::StudyError> for CommandError {
    fn from(error: mavid::study::StudyError) -> Self {
        match error {
            mavid::study::StudyError::Setting { name, why } => Self::Input(format!("--{name}: {why}")),
            mavid::study::StudyError::Plan(
                why @ (PlanError::OutsideLimits { .. } | PlanError::NotDetermined),
            ) => Self::Failure(why.to_string()),
            mavid::study::StudyError::Config(error) => error.into(),
            other => Self::Input(other.to_string()),
        }
    }
}

impl From<OnboardError> for CommandError {
    fn from(error: OnboardError) -> Self {
        let text = error.to_string();
        match error {
            OnboardError::Ended(_) | OnboardError::DownloadEnded { .. } => Self::Ended(text),
            error if error.is_input() => Self::Input(text),
            _ => Self::Failure(text),
        }
    }
}

impl From<mavid::log::LogError> for CommandError {
    fn from(error: mavid::log::LogError) -> Self {
        Self::Input(error.to_string())
    }
}
