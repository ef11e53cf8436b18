//! Result of an explanation.

use super::harmonics::LackOfFit;
use super::latency::{LatencyFinding, finding_of};
use super::locate::{Aperiodic, FieldTest, Localisation};
use super::named::{DetectionLimit, Named};
use super::signatures::is_irregular;
use super::slight::Slight;
use super::tested::Search;
use super::torque_law::TorqueLaw;

/// The answer in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// nothing above the detection limits
    NothingMissing,
    /// what was missing has a name, and nothing certain is left
    Explained,
    /// part of it has a name
    PartlyExplained,
    /// a deviation that no effect of the library explains
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
    /// Without its names, which flights that were not used refute: the model is the rigid body alone. What the names left is left
    /// without them, too.
    #[must_use]
    pub fn refuted(mut self) -> Self {
        self.verdict = match self.verdict {
            Verdict::NothingMissing | Verdict::Explained => Verdict::NothingMissing,
            Verdict::PartlyExplained | Verdict::Unexplained => Verdict::Unexplained,
        };
        let names = std::mem::take(&mut self.named);
        self.closest = if self.verdict == Verdict::Unexplained { names } else { Vec::new() };
        self.slight.clear();
        self.located_after.clone_from(&self.located_before);
        self.search.after = self.search.before.clone();
        let unsure_s = self.search.latency.std_s;
        let alone = finding_of(&self.search.before);
        self.search.latency = LatencyFinding { std_s: alone.std_s.max(unsure_s), ..alone };
        self.search.steps.clear();
        self.torque_law = self.torque_law_alone;
        self
    }

    /// Without the name of a wind that changes irregularly: it is in no model, and nothing else changes.
    #[must_use]
    pub fn without_gust(mut self) -> Self {
        self.named.retain(|named| !is_irregular(named.id));
        self.aperiodic.gust = None;
        if self.named.is_empty() {
            self.verdict = match self.verdict {
                Verdict::Explained => Verdict::NothingMissing,
                Verdict::PartlyExplained => Verdict::Unexplained,
                verdict => verdict,
            };
        }
        self
    }

    /// Where names were taken back because the flight shows them too little, and all was explained with them: what they explained is no
    /// deviation without a cause.
    #[must_use]
    pub fn of_unsure_cause(mut self) -> Self {
        match self.verdict {
            Verdict::NothingMissing | Verdict::Explained => {}
            Verdict::PartlyExplained => self.verdict = Verdict::Explained,
            Verdict::Unexplained if self.closest.is_empty() => {
                self = self.refuted();
                self.verdict = Verdict::NothingMissing;
            }
            // the others are shown as well as before
            Verdict::Unexplained => {
                self.named = std::mem::take(&mut self.closest);
                self.verdict = Verdict::Explained;
            }
        }
        self
    }

    /// Emits it as tracing events: each name with its evidence and sizes, the remaining deviations, and the verdict.
    pub(super) fn emit(&self) {
        self.named.iter().for_each(|named| named.emit());
        if let Some(lack) = &self.lack_of_fit {
            tracing::debug!(p = lack.p_least(), excess_energy = lack.excess_energy, "left at the harmonics");
        }
        if let Some(field) = &self.field {
            let FieldTest { certain, beats_named, .. } = field;
            tracing::debug!(certain, beats_named, "a force of the room tested");
        }
        self.aperiodic.emit();
        let (named, too_little_excitation) = (self.named.len(), self.too_little_excitation);
        tracing::info!(verdict = self.verdict.name(), named, too_little_excitation, "explained");
    }
}

/// The whole result.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// the answer in one word
    pub verdict: Verdict,
    /// effects that the rigid body lacks
    pub named: Vec<Named>,
    /// certain effects that are too small to matter: traces, without a name
    pub slight: Vec<Slight>,
    /// the effects that come closest, if none explains the residual
    pub closest: Vec<Named>,
    /// detection limits of the effects without a name
    pub limits: Vec<DetectionLimit>,
    /// no effect that appears only in motion could have been detected at its usual size, and none was found
    pub too_little_excitation: bool,
    /// hardly anything but the controller's answer to the gyroscopes' noise turned the vehicle: neither moments of inertia nor a
    /// latency come from that
    pub turned_by_control: bool,
    /// residual power at the trajectory's harmonics
    pub lack_of_fit: Option<LackOfFit>,
    /// localisation of the rigid body's residual
    pub located_before: Option<Localisation>,
    /// localisation of the final residual
    pub located_after: Option<Localisation>,
    /// test of a force that depends on the position in the room
    pub field: Option<FieldTest>,
    /// tests of causes that do not repeat
    pub aperiodic: Aperiodic,
    /// mean airspeed of the flights by the final model, m/s; zero where no velocity was recorded
    pub airspeed_m_s: f64,
    /// where the rotors' torque certainly does not go with their thrust, by the model that serves: of an unexplained flight the rigid body
    /// alone
    pub torque_law: Option<TorqueLaw>,
    /// the same by the rigid body alone
    pub torque_law_alone: Option<TorqueLaw>,
    /// the search with its fits and evidence
    pub search: Search,
}
