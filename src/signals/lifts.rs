//! Check that the thrust of a vehicle file lifts its weight in a flight that the log shows.

use super::SignalsError;
use super::actuation::Actuation;
use super::reported_state::ReportedState;
use super::select::best;
use super::usable::FLYING_SHARE;
use crate::recording::landed::MOVES;
use crate::recording::{Quantity, Recording, Stream};
use crate::vehicle::Vehicle;

/// Time of such motion that is a flight, s. Less is a knock, or a vehicle that is carried.
const LEAST_S: f64 = 2.0;

/// The contradiction of a log that shows a flight with a vehicle file by which none of it was one; `None` where the log shows
/// no flight either.
pub(super) fn too_little(
    recording: &Recording,
    actuation: &Actuation,
    vehicle: &Vehicle,
) -> Option<SignalsError> {
    let said = ReportedState::of(recording);
    let stream = actuation.stream();
    let spans_s = stream.time_s.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    let asked_s: f64 = spans_s.filter(|(t_s, _)| said.may_fly(*t_s)).map(|(_, step_s)| step_s).sum();
    let moves = || {
        [Quantity::Velocity, Quantity::AngularRate].into_iter().any(|quantity| {
            best(recording, quantity, |stream| stream.width == 3)
                .is_some_and(|(_, stream)| moving_s(stream, &said) >= LEAST_S)
        })
    };
    let most_n = (0..stream.len())
        .filter(|index| said.may_fly(stream.time_s[*index]))
        .map(|index| actuation.collective_n(index))
        .fold(0.0, f64::max);
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let is_contradiction =
        asked_s >= LEAST_S && most_n > 0.0 && most_n < weight_n && (said.tells_landed() || moves());
    is_contradiction.then_some(SignalsError::ThrustTooLow { most_n, weight_n, share: FLYING_SHARE })
}

/// Time in which it moved while it may have flown, s.
fn moving_s(stream: &Stream, said: &ReportedState<'_>) -> f64 {
    let size = |index: usize| stream.sample(index).iter().map(|value| value * value).sum::<f64>().sqrt();
    let moved = |index: &usize| size(*index) > MOVES && said.may_fly(stream.time_s[*index]);
    let step_s =
        |index: usize| stream.time_s.get(index + 1).map_or(0.0, |next_s| next_s - stream.time_s[index]);
    // a gap counts for a tenth of a second at most
    (0..stream.len()).filter(moved).map(|index| step_s(index).clamp(0.0, 0.1)).sum()
}
