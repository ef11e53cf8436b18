//! What comes out of it.

use super::harmonics::LackOfFit;
use super::locate::{Aperiodic, FieldTest, Localisation};
use super::named::{DetectionLimit, Named};
use super::tested::Search;

/// The answer in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// nothing above the detection limits
    NothingMissing,
    /// what was missing has a name, and nothing certain is left
    Explained,
    /// part of it has a name
    PartlyExplained,
    /// something is there that no effect of the library accounts for
    Unexplained,
}

impl Verdict {
    /// As in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NothingMissing => "nothing_missing",
            Self::Explained => "explained",
            Self::PartlyExplained => "partly_explained",
            Self::Unexplained => "unexplained",
        }
    }
}

impl Explanation {
    /// Emits it as tracing events: each name with its evidence and sizes, what is left, and the verdict.
    pub(super) fn emit(&self) {
        self.named.iter().for_each(|named| named.emit());
        if let Some(lack) = &self.lack_of_fit {
            tracing::debug!(p = lack.p_least(), excess_energy = lack.excess_energy, "left at the harmonics");
        }
        if let Some(field) = &self.field {
            let FieldTest { certain, beats_named, .. } = field;
            tracing::debug!(certain, beats_named, "a force of the room tested");
        }
        let (named, too_little_excitation) = (self.named.len(), self.too_little_excitation);
        tracing::info!(verdict = self.verdict.name(), named, too_little_excitation, "explained");
    }
}

/// The whole result.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// in one word
    pub verdict: Verdict,
    /// what was left out
    pub named: Vec<Named>,
    /// where nothing serves: what comes closest
    pub closest: Vec<Named>,
    /// for what was not named
    pub limits: Vec<DetectionLimit>,
    /// nothing that shows only where the vehicle moves could have been seen at its usual size, nor was it found
    pub too_little_excitation: bool,
    /// what repeats with the trajectory and is left over
    pub lack_of_fit: Option<LackOfFit>,
    /// where the rigid body's residual lives
    pub located_before: Option<Localisation>,
    /// where what is left lives
    pub located_after: Option<Localisation>,
    /// a force of the room against the named effects
    pub field: Option<FieldTest>,
    /// what never repeats
    pub aperiodic: Aperiodic,
    /// the fits and the evidence
    pub search: Search,
}
