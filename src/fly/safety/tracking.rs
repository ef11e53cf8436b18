//! How far the vehicle is from where it was told to be.

use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::Vector3;

use super::Sustained;
use crate::fly::outcome::Cause;

/// A vehicle follows its reference with a delay and its position arrives with another. It is compared with
/// the nearest of the references of this time, so that a delay along the path is no error.
const DELAY: Duration = Duration::from_millis(500);
/// For how long it may be off.
const PATIENCE: Duration = Duration::from_millis(500);
/// A standard error of this many is what an error must exceed to be one.
const SIGMAS: f64 = 3.0;

/// Distance to the reference.
#[derive(Debug, Default)]
pub struct Tracking {
    references: VecDeque<(Duration, Vector3<f64>)>,
    off: Sustained,
    off_vertically: Sustained,
    latest_m: f64,
    squares_m2: f64,
    count: f64,
    greatest_m: f64,
}

impl Tracking {
    /// What the vehicle is told at `now`, m, world.
    pub fn record_reference(&mut self, now: Duration, reference_m: Vector3<f64>) {
        self.references.push_back((now, reference_m));
        while self.references.front().is_some_and(|(at, _)| now.saturating_sub(*at) > DELAY) {
            self.references.pop_front();
        }
    }

    /// Forgets what it was told: another path begins.
    pub fn restart(&mut self) {
        self.references.clear();
        self.off = Sustained::default();
        self.off_vertically = Sustained::default();
    }

    /// Distance of a place to the nearest reference of the last half second, m; along z; `None` without a
    /// reference.
    fn distance_m(&self, position_m: &Vector3<f64>) -> Option<(f64, f64)> {
        let error = self.references.iter().map(|(_, reference)| position_m - reference);
        let nearest = error.clone().map(|error| error.norm()).min_by(f64::total_cmp)?;
        let vertical = error.map(|error| error.z.abs()).min_by(f64::total_cmp)?;
        Some((nearest, vertical))
    }

    /// Takes where the vehicle is. `limit_m` is the distance allowed, `noise_m` the standard error of the
    /// position itself; the greater of the limit and three standard errors holds.
    pub fn check(
        &mut self,
        now: Duration,
        position_m: &Vector3<f64>,
        limit_m: f64,
        noise_m: f64,
    ) -> Option<Cause> {
        let (distance_m, vertical_m) = self.distance_m(position_m)?;
        self.latest_m = distance_m;
        let limit_m = limit_m.max(SIGMAS * noise_m);
        let text = |what: f64, way: &str| {
            let patience_s = PATIENCE.as_secs_f64();
            Some(Cause::Tracking(format!(
                "{what:.2} m {way}for more than {patience_s} s, {limit_m:.2} m are allowed"
            )))
        };
        if self.off_vertically.update(now, vertical_m > limit_m) > PATIENCE {
            return text(vertical_m, "in height ");
        }
        if self.off.update(now, distance_m > limit_m) > PATIENCE {
            return text(distance_m, "");
        }
        None
    }

    /// Counts the latest distance into the flight's figures.
    pub fn count(&mut self) {
        self.squares_m2 += self.latest_m * self.latest_m;
        self.count += 1.0;
        self.greatest_m = self.greatest_m.max(self.latest_m);
    }

    /// The latest distance, m.
    #[must_use]
    pub fn latest_m(&self) -> f64 {
        self.latest_m
    }

    /// Root mean square and greatest of what was counted, m.
    #[must_use]
    pub fn figures_m(&self) -> (f64, f64) {
        ((self.squares_m2 / self.count.max(1.0)).sqrt(), self.greatest_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    /// Flies along x at 3 m/s, seen `delay_ms` late and `aside_m` off; when it is stopped, in ms.
    fn stopped_at(delay_ms: u64, aside_m: f64) -> Option<u64> {
        let mut tracking = Tracking::default();
        let place = |t: u64| Vector3::new(3e-3 * t as f64, 0.0, 1.0);
        (1000..3000).step_by(10).find(|t| {
            tracking.record_reference(ms(*t), place(*t));
            let seen = place(t - delay_ms) + Vector3::new(0.0, aside_m, 0.0);
            tracking.check(ms(*t), &seen, 1.0, 0.0).is_some()
        })
    }

    #[test]
    fn a_delay_is_no_error() {
        assert_eq!(stopped_at(400, 0.0), None, "1.2 m behind, on the path");
        assert_eq!(stopped_at(0, 0.9), None);
    }

    #[test]
    fn an_error_stops_the_flight_after_half_a_second() {
        assert_eq!(stopped_at(0, 1.2), Some(1510));
    }

    #[test]
    fn a_position_of_great_noise_is_given_more_room() {
        let mut tracking = Tracking::default();
        for t in (0..2000).step_by(10) {
            tracking.record_reference(ms(t), Vector3::zeros());
            assert!(tracking.check(ms(t), &Vector3::new(1.4, 0.0, 0.0), 1.0, 0.5).is_none());
        }
    }
}
