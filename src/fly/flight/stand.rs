//! The vehicle's place before its takeoff, which must be inside the room from the checks to the climb.

use super::phase::Phase;
use super::state::Flight;
use crate::fly::outcome::Cause;
use crate::fly::safety::{Lead, SetpointBounds};
use nalgebra::Vector3;

/// Largest distance of a standing vehicle outside the room's walls, m, for the error of its estimate. With more a
/// vehicle could start outside of the room.
const OUTSIDE_MAX_M: f64 = 0.1;

impl Flight {
    /// The cause if it is no longer in the room for which it was checked: its estimate may have jumped, or somebody may
    /// have moved it.
    pub(super) fn check_stand(&self) -> Option<Cause> {
        let told = self.guide.lead != Lead::Silent || matches!(self.phase, Phase::Arm);
        let on_ground = matches!(self.phase, Phase::Prime | Phase::Engage | Phase::Ready | Phase::Arm);
        let place = self.place_now().filter(|_| told && on_ground)?;
        self.stands_outside(&place.position_m).map(Cause::Refused)
    }

    /// A message if it stands beyond the walls of the room.
    pub(super) fn stands_outside(&self, stand_m: &Vector3<f64>) -> Option<String> {
        let room = SetpointBounds::room(&self.sortie.limits, &self.offset_m(stand_m));
        let beyond_m = (stand_m - room.nearest(stand_m)).xy().norm();
        (beyond_m > OUTSIDE_MAX_M).then(|| {
            format!(
                "it stands {beyond_m:.2} m outside the room (--origin here takes the room to where it stands)"
            )
        })
    }
}
