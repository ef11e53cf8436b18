//! Hover as a check of a force that is fixed in the body: the accelerometer of a vehicle that stands in the air shows it.
//!
//! A thrust that leans pushes the accelerometer sideways in hover as well as in motion. An error of the attitude, or of the velocity, looks like
//! it in the motion, and the accelerometer does not feel it.

use crate::signals::Signals;
use nalgebra::{Vector2, Vector3};

/// Largest speed of a hover, m/s. The drag of usual vehicles is then below 2 % of the weight.
const HOVER_M_S: f64 = 0.5;
/// Least time of it, s, of all flights together: the mean of the sway of a controller that holds a place.
const LEAST_S: f64 = 4.0;
/// Share of the force that hover has to show: less than a half is nearer to none.
const SHOWN: f64 = 0.5;

/// Mean of the specific force across body z over that along it (-), body x and y, while the vehicle hovers. `None` where no accelerometer was
/// recorded, and where no flight hovers for long enough.
pub(super) fn sideways(flights: &[Signals]) -> Option<Vector2<f64>> {
    let (mut sum, mut seconds) = (Vector3::zeros(), 0.0);
    for signals in flights {
        let (Some(force), Some(velocity)) = (&signals.specific_force, &signals.velocity) else { continue };
        let flies = |index: usize| {
            let time_s = signals.grid.time_s(index);
            signals.quality.airborne_s.iter().any(|(from_s, to_s)| (*from_s..=*to_s).contains(&time_s))
        };
        for index in
            (0..signals.grid.count).filter(|&index| flies(index) && velocity[index].norm() < HOVER_M_S)
        {
            sum += force[index] * signals.grid.step_s;
            seconds += signals.grid.step_s;
        }
    }
    (seconds >= LEAST_S && sum.z > 0.0).then(|| sum.xy() / sum.z)
}

/// Whether hover excludes a force by what the accelerometer shows there: both across body z over the force along it (-).
pub(super) fn excludes(shown: Vector2<f64>, expected: Vector2<f64>) -> bool {
    shown.dot(&expected) < SHOWN * expected.norm_squared()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::made_flights::{conceal, flown};
    use crate::simulate::RandomTrajectory;

    fn shown(tilt: Option<[f64; 2]>) -> Vector2<f64> {
        let (signals, _) = flown(17, &RandomTrajectory::default(), |truth, _| {
            conceal(truth, tilt.as_ref().map(|tilt| ("thrust_tilt", tilt as &[f64])));
        });
        sideways(&[signals]).unwrap()
    }

    #[test]
    fn the_accelerometer_shows_a_thrust_that_leans_in_hover() {
        let (straight, leaning) = (shown(None), shown(Some([0.0, 0.05])));
        assert!(straight.norm() < 0.01, "{straight}");
        // a turn about y leans the thrust towards x
        let expected = Vector2::new(0.05, 0.0);
        assert!((leaning - expected).norm() < 0.01, "{leaning}");
        assert!(!excludes(leaning, expected) && excludes(straight, expected) && excludes(leaning, -expected));
    }

    #[test]
    fn a_flight_without_a_hover_says_nothing() {
        let (mut signals, _) = flown(17, &RandomTrajectory::default(), |_, _| {});
        signals.quality.airborne_s.clear();
        assert_eq!(sideways(&[signals]), None);
    }
}
