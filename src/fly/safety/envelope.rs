//! The flown path against the vehicle's limits: a control loop overshoots what was planned.

use std::time::Duration;

use nalgebra::Vector3;

use super::Sustained;
use crate::fly::outcome::Cause;
use crate::frames::Attitude;
use crate::plan::Wall;
use crate::units::deg_from_rad;
use crate::vehicle::Limits;

/// Time for which a limit may be exceeded: a single sample does not count.
const PATIENCE: Duration = Duration::from_millis(200);

/// Tilt and room.
#[derive(Debug)]
pub struct Envelope {
    limits: Limits,
    margin_m: f64,
    tilt_max_rad: f64,
    tilted: Sustained,
    outside: Sustained,
    greatest_rad: f64,
}

impl Envelope {
    /// Within `margin_m` around the room of `limits` and up to `tilt_max_rad` from upright.
    #[must_use]
    pub fn new(limits: Limits, margin_m: f64, tilt_max_rad: f64) -> Self {
        let (tilted, outside) = (Sustained::default(), Sustained::default());
        Self { limits, margin_m, tilt_max_rad, tilted, outside, greatest_rad: 0.0 }
    }

    /// Checks the present attitude.
    pub fn check_tilt(&mut self, now: Duration, attitude: &Attitude) -> Option<Cause> {
        let tilt_rad = attitude.up_in_body().z.clamp(-1.0, 1.0).acos();
        self.greatest_rad = self.greatest_rad.max(tilt_rad);
        (self.tilted.update(now, tilt_rad > self.tilt_max_rad) >= PATIENCE).then(|| {
            let (tilt, limit) = (deg_from_rad(tilt_rad), deg_from_rad(self.tilt_max_rad));
            Cause::Tilt(format!("{tilt:.1} degrees, {limit:.1} are allowed"))
        })
    }

    /// Checks the present position in the plan's frame, m. The floor is not checked: takeoff and landing are below it.
    pub fn check_room(&mut self, now: Duration, place_m: &Vector3<f64>) -> Option<Cause> {
        let sides = [
            (Wall::NorthOrSouth, place_m.x.abs()),
            (Wall::WestOrEast, place_m.y.abs()),
            (Wall::Ceiling, place_m.z),
        ];
        let margin_m = self.margin_m;
        let broken = sides.into_iter().find_map(|(wall, value)| {
            let limit = wall.of(&self.limits)?;
            (value > limit + margin_m).then_some((wall, value, limit))
        });
        let lasts = self.outside.update(now, broken.is_some());
        broken.filter(|_| lasts >= PATIENCE).map(|(wall, value, limit)| {
            Cause::Room(format!(
                "{:.2} m beyond {}, a margin of {margin_m:.2} m is allowed",
                value - limit,
                wall.words()
            ))
        })
    }

    /// The greatest tilt seen, rad.
    #[must_use]
    pub fn greatest_tilt_rad(&self) -> f64 {
        self.greatest_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    #[test]
    fn a_tilt_that_lasts_ends_the_flight_and_a_single_sample_does_not() {
        let mut envelope = Envelope::new(Limits::default(), 1.0, 0.5);
        let (level, tilted) = (Attitude::identity(), Attitude::from_euler(0.4, 0.4, 1.0));
        assert!(envelope.check_tilt(ms(0), &tilted).is_none());
        assert!(envelope.check_tilt(ms(100), &level).is_none());
        assert!(envelope.check_tilt(ms(200), &tilted).is_none());
        assert!(envelope.check_tilt(ms(400), &tilted).is_some());
        assert!((envelope.greatest_tilt_rad() - (0.4_f64.cos().powi(2)).acos()).abs() < 1e-9);
    }

    #[test]
    fn the_room_has_a_margin() {
        let limits = Limits { y_max_m: Some(2.0), ..Limits::default() };
        let mut envelope = Envelope::new(limits, 0.5, 0.5);
        for t in [0, 300] {
            assert!(envelope.check_room(ms(t), &Vector3::new(90.0, -2.4, 5.0)).is_none());
        }
        assert!(envelope.check_room(ms(600), &Vector3::new(0.0, -2.6, 0.0)).is_none());
        let cause = envelope.check_room(ms(900), &Vector3::new(0.0, -2.6, 0.0)).unwrap();
        assert!(
            cause.to_string().contains("0.60 m beyond the wall to the west or east, a margin of 0.50 m"),
            "{cause}"
        );
    }
}
