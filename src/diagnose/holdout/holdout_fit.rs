//! The fit on flights that were not used.

use super::agreement::Agreement;
use super::bootstrap::{Compared, Interval};
use super::closed_loop::ClosedLoop;
use super::difference::{Difference, OtherVehicle};
use super::open_loop::OpenLoop;
use crate::note::Note;

/// The fit on flights that were not used.
#[derive(Debug, Clone)]
pub struct HoldoutFit {
    /// open-loop prediction, one entry a length of window; none where `no_open_loop` says why
    pub open_loop: Vec<OpenLoop>,
    /// where the flights were predicted with an empirical term: the same without it; otherwise none
    pub without_empirical: Vec<OpenLoop>,
    /// where the flights were predicted with a load of their own: the same by the model as it is written, without it and without an
    /// empirical term; otherwise none
    pub as_written: Vec<OpenLoop>,
    /// reason why nothing could be predicted
    pub no_open_loop: Option<String>,
    /// mean over the four quantities at 0.5 s of `100 (1 - after/before)`
    pub improvement_percent: Option<Interval>,
    /// residual of the weak form, N and N m, in the order of [`crate::diagnose::CHANNEL_NAMES`]
    pub weak: Vec<Option<Compared>>,
    /// closed-loop simulation from the recorded setpoints; `Err`: the reason why there is none
    pub closed_loop: Result<ClosedLoop, String>,
    /// the held-out flights' own values against those of the model
    pub agreement: Vec<Agreement>,
    /// the reason why the held-out flights cannot be of the identified vehicle
    pub other_vehicle: Option<OtherVehicle>,
    /// a flight begins with another mass than the model's, with which it is predicted here: a payload, or another battery
    pub other_mass: bool,
    /// mean speed over the mean airspeed of the flights explained, -
    pub speed_share: f64,
    /// notes on parameters that were not kept or are not known
    pub notes: Vec<Note>,
}

impl HoldoutFit {
    /// Open loop over windows of 0.5 s.
    #[must_use]
    pub fn half_second(&self) -> Option<&OpenLoop> {
        OpenLoop::half_second(&self.open_loop)
    }

    /// Whether the held-out flights may be of the identified vehicle and contain something that the others do not: no parameter of the
    /// model differs, and their own fit leaves far more.
    #[must_use]
    pub fn holds_more(&self) -> bool {
        self.other_vehicle.as_ref().is_some_and(|other| matches!(other.by, Difference::Residual { .. }))
    }
}
