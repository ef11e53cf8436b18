//! What comes out of it.

use super::harmonics::LackOfFit;
use super::locate::{Aperiodic, FieldTest, Localisation};
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

/// A parameter of a named effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedParameter {
    /// as [`crate::physics::Parameter`] has it
    pub name: &'static str,
    /// in `unit`
    pub value: f64,
    /// standard error; 0 where it was set, not estimated
    pub std: f64,
    /// SI
    pub unit: &'static str,
}

/// How strong the evidence was when the effect was taken.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strength {
    /// normal deviate
    pub z: f64,
    /// share of the residual energy that it explains (0..1)
    pub gain: f64,
    /// energy in sigma squared
    pub energy: f64,
    /// coefficients
    pub count: usize,
}

/// Another effect that explains the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Confusable {
    /// which
    pub id: &'static str,
    /// standard deviations by which this flight tells them apart, where that could be computed
    pub distinguishability: Option<f64>,
}

/// A named effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// which
    pub id: &'static str,
    /// what a person reads
    pub sentence: &'static str,
    /// values
    pub parameters: Vec<NamedParameter>,
    /// evidence
    pub strength: Strength,
    /// what it may be taken for
    pub confusable_with: Vec<Confusable>,
}

/// The smallest size at which an effect would have been named in this flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetectionLimit {
    /// which effect
    pub id: &'static str,
    /// which parameter
    pub parameter: &'static str,
    /// in `unit`
    pub limit: f64,
    /// size on ordinary vehicles, in `unit`, of what shows only where the vehicle moves
    pub usual: Option<f64>,
    /// SI
    pub unit: &'static str,
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
