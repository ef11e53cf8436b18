//! The last check before a setpoint is sent: nothing is sent outside the room, below the floor, or with a value that is
//! not a number.

use nalgebra::Vector3;

use crate::fly::setpoint::Setpoint;
use crate::vehicle::Limits;

/// The permitted region of setpoints; the vehicle's local frame, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetpointBounds {
    low_m: Vector3<f64>,
    high_m: Vector3<f64>,
}

impl SetpointBounds {
    /// The room of `limits`, whose origin is at `offset_m`. A wall that is not stated does not exist; the default floor
    /// is the ground.
    #[must_use]
    pub fn room(limits: &Limits, offset_m: &Vector3<f64>) -> Self {
        let wall = |max: Option<f64>| max.unwrap_or(f64::INFINITY);
        let high = Vector3::new(wall(limits.x_max_m), wall(limits.y_max_m), wall(limits.z_max_m));
        let low = Vector3::new(-high.x, -high.y, limits.z_min_m.unwrap_or(0.0).max(0.0));
        Self { low_m: low + offset_m, high_m: high + offset_m }
    }

    /// The region reduced by these distances (m) at each wall and at the ceiling, as long as something is left.
    #[must_use]
    pub fn smaller(self, side_m: f64, up_m: f64) -> Self {
        let middle = Vector3::from_fn(|axis, _| f64::midpoint(self.low_m[axis], self.high_m[axis]));
        let (low, high) = (Vector3::new(side_m, side_m, 0.0), Vector3::new(side_m, side_m, up_m));
        let Self { low_m, high_m } = self;
        let finite = middle.map(|value| if value.is_finite() { value } else { 0.0 });
        Self {
            low_m: (low_m + low).inf(&finite.sup(&low_m)),
            high_m: (high_m - high).sup(&finite.inf(&high_m)),
        }
    }

    /// The region extended to a place, such as the ground where the vehicle stands before it takes off.
    #[must_use]
    pub fn with(self, place_m: &Vector3<f64>) -> Self {
        Self { low_m: self.low_m.inf(place_m), high_m: self.high_m.sup(place_m) }
    }

    /// Whether the place (m) is inside.
    #[must_use]
    pub fn contains(&self, place_m: &Vector3<f64>) -> bool {
        self.nearest(place_m) == *place_m
    }

    /// The nearest place inside, m.
    #[must_use]
    pub fn nearest(&self, place_m: &Vector3<f64>) -> Vector3<f64> {
        place_m.sup(&self.low_m).inf(&self.high_m)
    }

    /// The setpoint as it may be sent: at the nearest place inside, without a velocity or an acceleration that leads
    /// out from there; `None` if a number is not finite.
    #[must_use]
    pub fn keep(&self, setpoint: &Setpoint) -> Option<Setpoint> {
        let Setpoint { position_m, velocity_m_s, acceleration_m_s2, .. } = *setpoint;
        let numbers = [position_m, velocity_m_s, acceleration_m_s2];
        let yaw = [setpoint.yaw_rad, setpoint.yaw_rate_rad_s];
        if !numbers.iter().flatten().chain(&yaw).all(|value| value.is_finite()) {
            return None;
        }
        let mut kept = Setpoint { position_m: self.nearest(&position_m), ..*setpoint };
        for axis in 0..3 {
            let beyond_m = position_m[axis] - kept.position_m[axis];
            for vector in [&mut kept.velocity_m_s, &mut kept.acceleration_m_s2] {
                if beyond_m * vector[axis] > 0.0 {
                    vector[axis] = 0.0;
                }
            }
        }
        Some(kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fly::setpoint::Place;
    use proptest::prelude::*;
    use std::time::Duration;

    fn bounds() -> SetpointBounds {
        let limits = Limits {
            x_max_m: Some(2.0),
            y_max_m: Some(1.5),
            z_min_m: Some(0.7),
            z_max_m: Some(4.0),
            ..Limits::default()
        };
        SetpointBounds::room(&limits, &Vector3::new(10.0, -3.0, 0.2))
    }

    fn at(position_m: Vector3<f64>, velocity_m_s: Vector3<f64>) -> Setpoint {
        let place = Place { position_m, yaw_rad: 0.0 };
        Setpoint { velocity_m_s, acceleration_m_s2: velocity_m_s, ..Setpoint::hold(Duration::ZERO, &place) }
    }

    proptest! {
        /// Whatever comes: what is sent is finite, inside, and does not lead out from a wall.
        #[test]
        fn nothing_leaves_the_room(
            p in proptest::array::uniform3(-100.0..100.0_f64),
            v in proptest::array::uniform3(-9.0..9.0_f64),
        ) {
            let kept = bounds().keep(&at(p.into(), v.into())).unwrap();
            let place = kept.position_m;
            prop_assert!((8.0..=12.0).contains(&place.x) && (-4.5..=-1.5).contains(&place.y));
            prop_assert!((0.7 + 0.2..=4.0 + 0.2).contains(&place.z), "{place}");
            for axis in 0..3 {
                let beyond = p[axis] - place[axis];
                prop_assert!(beyond * kept.velocity_m_s[axis] <= 0.0 && beyond * kept.acceleration_m_s2[axis] <= 0.0);
            }
        }
    }

    #[test]
    fn inside_nothing_changes_and_what_is_no_number_is_not_sent() {
        let inside = at(Vector3::new(10.5, -3.0, 2.0), Vector3::new(1.0, 2.0, -1.0));
        assert_eq!(bounds().keep(&inside), Some(inside));
        for wrong in [f64::NAN, f64::INFINITY] {
            let setpoint = at(Vector3::new(10.0, wrong, 2.0), Vector3::zeros());
            assert_eq!(bounds().keep(&setpoint), None);
            assert_eq!(bounds().keep(&Setpoint { yaw_rad: wrong, ..inside }), None);
        }
    }

    #[test]
    fn the_ground_below_a_vehicle_that_takes_off_is_within() {
        let stand = Vector3::new(10.5, -3.0, 0.2);
        let climbing = at(stand, Vector3::zeros());
        assert_eq!(bounds().with(&stand).keep(&climbing), Some(climbing));
        assert!(bounds().keep(&climbing).unwrap().position_m.z > 0.8);
    }
}
