//! The flights that were used to measure the improvement.

use crate::study::InputFile;

/// What the improvement is shown on.
#[derive(Debug, Clone, PartialEq)]
pub enum ValidationData {
    /// flights that were not used otherwise, by their files
    Flights(Vec<InputFile>),
    /// the end of the flight that was explained, held back from it
    HeldBack {
        /// s, from where on
        from_s: f64,
        /// s of flight
        seconds: f64,
    },
    /// each flight that was explained, predicted by models that rest on the others; without those whose effects no other shows
    LeftOut {
        /// how many
        flights: usize,
    },
    /// nothing was left to show it on
    Nothing {
        /// why
        reason: String,
    },
}

impl ValidationData {
    /// Words for a sentence.
    #[must_use]
    pub fn words(&self) -> &'static str {
        match self {
            Self::Flights(_) => "the hold-out",
            Self::HeldBack { .. } => "the part of the flight held back",
            Self::LeftOut { flights: 1 } => "the one flight that the others predict",
            Self::LeftOut { .. } => "each flight by models of the others",
            Self::Nothing { .. } => "nothing",
        }
    }

    /// Words for a heading.
    #[must_use]
    pub fn heading(&self) -> String {
        match self {
            Self::Flights(inputs) if inputs.len() == 1 => "hold-out flight".to_owned(),
            Self::Flights(inputs) => format!("{} hold-out flights", inputs.len()),
            Self::HeldBack { from_s, seconds } => {
                format!("held back: {seconds:.0} s from {from_s:.0} s on")
            }
            Self::LeftOut { flights: 1 } => "one flight by models of the others".to_owned(),
            Self::LeftOut { flights } => format!("each of {flights} flights by models of the others"),
            Self::Nothing { reason } => format!("no hold-out: {reason}"),
        }
    }
}
