//! Names that flights which were not used refute.

use crate::diagnose::{NAME_Z, called};
use crate::note::{About, Note};
use crate::text::significant;

/// Names that the flights explained would give, and that flights which were not used refute.
#[derive(Debug, Clone, PartialEq)]
pub struct Refuted {
    /// each in brief, with its size
    pub names: Vec<String>,
    /// by how much errors over 0.5 s are larger with them, mean over the quantities, %
    pub worse_percent: f64,
}

impl Refuted {
    pub(super) fn note(&self) -> Note {
        let text = format!(
            "the flights explained alone would give a name to {}; with it, errors over 0.5 s are {} % larger in the mean on the \
             hold-out, so it gets none",
            self.names.join(", "),
            significant(self.worse_percent, 2)
        );
        Note::warning(About::HoldOut, text)
    }
}

/// An effect that the flights explained would name, and that does not hold: flights that were not used do not confirm it, or no flight of
/// several shows it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Worthless {
    /// the effect
    pub(super) id: &'static str,
    /// in brief, with its size
    pub(super) name: String,
    /// by how much errors over 0.5 s are smaller, mean over the quantities, %
    pub(super) better_percent: f64,
    /// by what they are smaller
    pub(super) by: BetterBy,
}

/// What speaks against a named effect: what predicts a hold-out better than a model with it, or the flights themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BetterBy {
    /// the model without the effect
    Without,
    /// the rigid body alone, or a state that does not change
    Baseline,
    /// no single flight of several shows the effect, and all together show less than a name needs
    NoFlight,
}

impl Worthless {
    pub(super) fn note(&self) -> Note {
        let percent = significant(self.better_percent.abs(), 2);
        let why = match self.by {
            BetterBy::Without => {
                format!("without it, errors over 0.5 s are {percent} % smaller in the mean on the hold-out")
            }
            BetterBy::Baseline if self.better_percent <= 0.0 => format!(
                "it follows the height, as a thrust that drifts does, and the model with it predicts the hold-out over 0.5 s only {percent} % \
                 better in the mean than a state that does not change or the rigid body alone"
            ),
            BetterBy::Baseline => format!(
                "it follows the height, as a thrust that drifts does, and a state that does not change or the rigid body alone \
                 predicts the hold-out better than the model with it, over 0.5 s by {percent} % in the mean"
            ),
            BetterBy::NoFlight => {
                let text = format!(
                    "all flights together would give a name to {}, but no single flight shows it, and their mean is less than {NAME_Z} \
                     standard errors from none, so it gets none",
                    self.name
                );
                return Note::warning(About::Estimate, text);
            }
        };
        let text =
            format!("the flights explained alone would give a name to {}; {why}, so it gets none", self.name);
        Note::warning(About::HoldOut, text)
    }
}

/// An effect that a short flight would name, and that it does not show well enough.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unshown {
    /// the effect
    pub(super) id: &'static str,
    /// in brief, with its size
    pub(super) name: String,
    /// it is a force of the air, and the vehicle only hovers
    pub(super) hovers: bool,
    /// each half of the flight shows it by itself
    pub(super) halves: bool,
    /// by how much errors over 0.5 s on the flight itself are smaller with it, mean over the quantities, %
    pub(super) worth_percent: f64,
    /// another law of the drag that is known better, where that is why it leaves
    pub(super) beside: Option<&'static str>,
}

impl Unshown {
    pub(super) fn note(&self) -> Note {
        let why = if self.hovers {
            "the vehicle only hovers, and forces of the air cannot be told from each other there".to_owned()
        } else if let Some(other) = self.beside {
            format!("it cannot be told from {}, which is known better", called(other))
        } else if self.halves {
            format!(
                "with it, errors over 0.5 s on the flight itself are only {} % smaller in the mean",
                significant(self.worth_percent.max(0.0), 2)
            )
        } else {
            "the halves of the flight do not both show it".to_owned()
        };
        let text = format!("this short flight would give a name to {}; {why}, so it gets none", self.name);
        Note::warning(About::Estimate, text)
    }
}
