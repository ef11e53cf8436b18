//! A reference that keeps within speed, acceleration and jerk on its way to what is asked for.
//!
//! As ArduPilot shapes it (`AP_Math/control.cpp`: `shape_pos_vel_accel`, `shape_vel_accel`, `shape_accel`,
//! `sqrt_controller`): each error is answered by the next derivative, linearly where it is small and by the
//! square root of the distance in which one can still stop where it is large. What is fed forward comes on top and is
//! bounded by the jerk alone.

use crate::units::STANDARD_GRAVITY_M_S2;
use nalgebra::{SVector, Vector1, Vector2, Vector3};

/// How a position error becomes a velocity: the releases differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ShaperLaw {
    /// ArduPilot up to 4.6
    #[default]
    UpTo4_6,
    /// ArduPilot 4.7
    From4_7,
}

impl ShaperLaw {
    /// Gain of the position loop over that of the velocity loop, and share of the acceleration kept for braking (-).
    fn shares(self) -> (f64, f64) {
        match self {
            Self::UpTo4_6 => (0.25, 0.75),
            Self::From4_7 => (0.5, 0.5),
        }
    }
}

/// Bounds of the reference; horizontal and vertical apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShaperLimits {
    /// horizontal, m/s
    pub speed_m_s: f64,
    /// m/s
    pub climb_m_s: f64,
    /// positive, m/s
    pub descent_m_s: f64,
    /// horizontal, m/s^2
    pub acceleration_m_s2: f64,
    /// m/s^2
    pub vertical_acceleration_m_s2: f64,
    /// horizontal, m/s^3
    pub jerk_m_s3: f64,
    /// m/s^3
    pub vertical_jerk_m_s3: f64,
    /// how it answers a position error
    pub law: ShaperLaw,
}

/// A horizontal jerk (m/s^3) as far as a vehicle of this greatest angular acceleration (rad/s^2; zero or less: not
/// limited) can make it while it keeps `acceleration_m_s2` (`AC_PosControl::set_max_speed_accel_NE_m`).
#[must_use]
pub fn jerk_within(jerk_m_s3: f64, acceleration_m_s2: f64, angular_acceleration_rad_s2: f64) -> f64 {
    if angular_acceleration_rad_s2 > 0.0 {
        jerk_m_s3.min(0.5 * (acceleration_m_s2 * angular_acceleration_rad_s2 * STANDARD_GRAVITY_M_S2).sqrt())
    } else {
        jerk_m_s3
    }
}

/// What the reference shall reach, world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// m; a component that is NaN is not asked for
    pub position_m: Vector3<f64>,
    /// m/s, beside what the position error asks for
    pub velocity_m_s: Vector3<f64>,
    /// m/s^2, beside what the velocity error asks for
    pub acceleration_m_s2: Vector3<f64>,
}

/// What GUIDED flies to: the last setpoint, moved on by its velocity and acceleration while no other comes, until its
/// time-out makes both zero and leaves the place to which it has moved (`ModeGuided::posvelaccel_control_run`; a
/// component that is NaN was not asked for).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GuidedTarget {
    /// m, world
    pub position_m: Vector3<f64>,
    /// m/s
    pub velocity_m_s: Vector3<f64>,
    /// m/s^2
    pub acceleration_m_s2: Vector3<f64>,
}

impl GuidedTarget {
    /// The time-out has passed.
    pub fn time_out(&mut self) {
        // without a place it is by its velocity that it stops
        let stops = self.position_m.x.is_nan();
        self.velocity_m_s = self.velocity_m_s.map(|value| if stops { 0.0 } else { at_rest(value) });
        self.acceleration_m_s2 = self.acceleration_m_s2.map(at_rest);
    }

    /// One period on.
    pub fn step(&mut self, period_s: f64) {
        let known = |vector: &Vector3<f64>| vector.map(|value| if value.is_nan() { 0.0 } else { value });
        let (velocity, acceleration) = (known(&self.velocity_m_s), known(&self.acceleration_m_s2));
        self.position_m += velocity * period_s + acceleration * (0.5 * period_s * period_s);
        self.velocity_m_s += acceleration * period_s;
    }
}

fn at_rest(value: f64) -> f64 {
    if value.is_nan() { value } else { 0.0 }
}

/// The reference, world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaper {
    /// m
    pub position_m: Vector3<f64>,
    /// m/s
    pub velocity_m_s: Vector3<f64>,
    /// m/s^2
    pub acceleration_m_s2: Vector3<f64>,
}

impl Shaper {
    /// A reference that continues as the vehicle moves now.
    #[must_use]
    pub fn at(position_m: Vector3<f64>, velocity_m_s: Vector3<f64>) -> Self {
        Self { position_m, velocity_m_s, acceleration_m_s2: Vector3::zeros() }
    }

    /// One period on its way to `wish`.
    pub fn step(&mut self, wish: &Wish, limits: &ShaperLimits, period_s: f64) {
        let axis = |v: &Vector3<f64>| (v.xy(), Vector1::new(v.z));
        let (wish_p, wish_v, wish_a) =
            (axis(&wish.position_m), axis(&wish.velocity_m_s), axis(&wish.acceleration_m_s2));
        let (p, v, a) = (axis(&self.position_m), axis(&self.velocity_m_s), axis(&self.acceleration_m_s2));
        let (level, upright) = (Bounds::level(limits), Bounds::upright(limits));
        let side: Vector2<f64> =
            shaped([&wish_p.0, &wish_v.0, &wish_a.0], [&p.0, &v.0, &a.0], &level, period_s);
        let up: Vector1<f64> =
            shaped([&wish_p.1, &wish_v.1, &wish_a.1], [&p.1, &v.1, &a.1], &upright, period_s);
        self.acceleration_m_s2 = Vector3::new(side.x, side.y, up.x);
        self.position_m +=
            self.velocity_m_s * period_s + self.acceleration_m_s2 * (0.5 * period_s * period_s);
        self.velocity_m_s += self.acceleration_m_s2 * period_s;
    }

    /// The place at rest (m) towards which the reference, as it is now, would continue with just its own acceleration: what
    /// to ask for, beside no velocity and no acceleration, of one that is to follow a motion. An acceleration beyond
    /// the bounds counts as the bound.
    #[must_use]
    pub fn place_ahead(&self, limits: &ShaperLimits) -> Vector3<f64> {
        let (level, upright) = (Bounds::level(limits), Bounds::upright(limits));
        let (v, a) = (&self.velocity_m_s, &self.acceleration_m_s2);
        let side = ahead(&v.xy(), &a.xy(), &level);
        let up = ahead(&Vector1::new(v.z), &Vector1::new(a.z), &upright);
        self.position_m + Vector3::new(side.x, side.y, up.x)
    }
}

/// Bounds of one axis group.
struct Bounds {
    /// least (as a positive number) and greatest
    speed: (f64, f64),
    acceleration: f64,
    jerk: f64,
    law: ShaperLaw,
}

impl Bounds {
    fn level(limits: &ShaperLimits) -> Self {
        Self {
            speed: (limits.speed_m_s, limits.speed_m_s),
            acceleration: limits.acceleration_m_s2,
            jerk: limits.jerk_m_s3,
            law: limits.law,
        }
    }

    fn upright(limits: &ShaperLimits) -> Self {
        Self {
            speed: (limits.descent_m_s, limits.climb_m_s),
            acceleration: limits.vertical_acceleration_m_s2,
            jerk: limits.vertical_jerk_m_s3,
            law: limits.law,
        }
    }

    /// Gain of the velocity loop, that of the position loop (1/s), and the acceleration kept for braking.
    fn gains(&self) -> (f64, f64, f64) {
        let pole = self.jerk / self.acceleration;
        let (slower, braking) = self.law.shares();
        (pole, slower * pole, braking * self.acceleration)
    }
}

/// The next acceleration of one axis group.
fn shaped<const D: usize>(
    [position, velocity, acceleration]: [&SVector<f64, D>; 3],
    [p, v, a]: [&SVector<f64, D>; 3],
    bounds: &Bounds,
    period_s: f64,
) -> SVector<f64, D> {
    let (pole, gain, braking) = bounds.gains();
    let error = (position - p).map(|error| if error.is_nan() { 0.0 } else { error });
    let wanted = root_law(&error, gain, braking);
    let wanted = capped(&wanted, bounds) + velocity;
    let turn = root_law(&(wanted - v), pole, bounds.jerk).cap_magnitude(bounds.acceleration);
    // what is fed forward is not bounded
    let target = turn + acceleration;
    a + (target - a).cap_magnitude(bounds.jerk * period_s)
}

/// How far ahead a place at rest has to be for the law to ask for this acceleration at this velocity, m.
fn ahead<const D: usize>(v: &SVector<f64, D>, a: &SVector<f64, D>, bounds: &Bounds) -> SVector<f64, D> {
    let (pole, gain, braking) = bounds.gains();
    let wanted = v + inverse_root_law(&a.cap_magnitude(bounds.acceleration), pole, bounds.jerk);
    inverse_root_law(&capped(&wanted, bounds), gain, braking)
}

fn capped<const D: usize>(wanted: &SVector<f64, D>, bounds: &Bounds) -> SVector<f64, D> {
    if D == 1 {
        return wanted.map(|speed| speed.clamp(-bounds.speed.0, bounds.speed.1));
    }
    wanted.cap_magnitude(bounds.speed.1)
}

/// Linear with `gain` near zero, farther off such that a deceleration of `second` suffices to stop.
fn root_law<const D: usize>(error: &SVector<f64, D>, gain: f64, second: f64) -> SVector<f64, D> {
    let distance = error.norm();
    let linear = second / (gain * gain);
    if distance > linear {
        error * ((2.0 * second * (distance - 0.5 * linear)).sqrt() / distance)
    } else {
        error * gain
    }
}

/// The error that [`root_law`] answers with this.
fn inverse_root_law<const D: usize>(answer: &SVector<f64, D>, gain: f64, second: f64) -> SVector<f64, D> {
    let size = answer.norm();
    if size > second / gain {
        answer * ((0.5 * size * size / second + 0.5 * second / (gain * gain)) / size)
    } else {
        answer / gain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: ShaperLimits = ShaperLimits {
        speed_m_s: 10.0,
        climb_m_s: 2.5,
        descent_m_s: 1.5,
        acceleration_m_s2: 2.5,
        vertical_acceleration_m_s2: 1.0,
        jerk_m_s3: 5.0,
        vertical_jerk_m_s3: 5.0,
        law: ShaperLaw::UpTo4_6,
    };

    #[test]
    fn places_ahead_at_rest_make_it_follow_a_motion_of_either_release() {
        for law in [ShaperLaw::UpTo4_6, ShaperLaw::From4_7] {
            let limits = ShaperLimits { acceleration_m_s2: 10.0, jerk_m_s3: 40.0, law, ..LIMITS };
            let motion = |t: f64| {
                let (sin, cos) = (1.5 * t).sin_cos();
                Shaper {
                    position_m: Vector3::new(sin, 2.0 - cos, 1.0 + 0.1 * sin),
                    velocity_m_s: Vector3::new(1.5 * cos, 1.5 * sin, 0.15 * cos),
                    acceleration_m_s2: Vector3::new(-2.25 * sin, 2.25 * cos, -0.225 * sin),
                }
            };
            let mut shaper = motion(0.0);
            for step in 0..4000 {
                let place = motion(0.0025 * f64::from(step)).place_ahead(&limits);
                let (velocity_m_s, acceleration_m_s2) = (Vector3::zeros(), Vector3::zeros());
                shaper.step(&Wish { position_m: place, velocity_m_s, acceleration_m_s2 }, &limits, 0.0025);
                let off_m = (shaper.position_m - motion(0.0025 * f64::from(step + 1)).position_m).norm();
                assert!(off_m < 0.01, "{law:?} at step {step}: {off_m}");
            }
        }
    }

    #[test]
    fn a_target_moves_on_until_its_time_out_and_stays_where_it_came_to() {
        let mut target = GuidedTarget {
            position_m: Vector3::new(0.0, 0.0, 4.0),
            velocity_m_s: Vector3::new(1.0, 0.0, -1.0),
            acceleration_m_s2: Vector3::new(0.5, 0.0, f64::NAN),
        };
        (0..3000).for_each(|_| target.step(1e-3));
        target.time_out();
        (0..1000).for_each(|_| target.step(1e-3));
        assert!((target.position_m - Vector3::new(5.25, 0.0, 1.0)).norm() < 1e-9, "{target:?}");
        assert!(target.velocity_m_s == Vector3::zeros() && target.acceleration_m_s2.z.is_nan());
    }

    #[test]
    fn jerk_is_no_more_than_the_vehicle_can_turn_for() {
        assert_eq!(jerk_within(5.0, 2.5, 19.2), 5.0);
        assert!((jerk_within(40.0, 10.0, 19.2) - 21.695).abs() < 0.01, "{}", jerk_within(40.0, 10.0, 19.2));
        assert_eq!(jerk_within(40.0, 10.0, 0.0), 40.0);
    }

    #[test]
    fn a_far_position_is_reached_within_all_bounds_and_without_much_overshoot() {
        let goal = Vector3::new(12.0, -5.0, 6.0);
        let wish =
            Wish { position_m: goal, velocity_m_s: Vector3::zeros(), acceleration_m_s2: Vector3::zeros() };
        let mut shaper = Shaper::at(Vector3::zeros(), Vector3::zeros());
        let mut beyond: f64 = 0.0;
        for _ in 0..8000 {
            let before = shaper.acceleration_m_s2;
            shaper.step(&wish, &LIMITS, 0.0025);
            assert!(shaper.acceleration_m_s2.xy().norm() <= 2.5 + 1e-9);
            assert!(shaper.acceleration_m_s2.z.abs() <= 1.0 + 1e-9);
            assert!((shaper.acceleration_m_s2 - before).xy().norm() <= 5.0 * 0.0025 + 1e-9);
            assert!(shaper.velocity_m_s.z <= 2.5 + 0.1);
            beyond = beyond.max(shaper.position_m.x - goal.x);
        }
        assert!((shaper.position_m - goal).norm() < 0.01, "{}", shaper.position_m);
        assert!(beyond < 0.3, "{beyond}");
    }

    #[test]
    fn a_reference_within_the_bounds_is_followed_and_a_livelier_one_is_missed() {
        let worst = |acceleration_m_s2: f64| {
            let limits = ShaperLimits { acceleration_m_s2, jerk_m_s3: 2.0 * acceleration_m_s2, ..LIMITS };
            let mut shaper = Shaper::at(Vector3::zeros(), Vector3::new(4.0, 0.0, 0.0));
            let mut worst: f64 = 0.0;
            // 2 m at 2 rad/s: 8 m/s^2
            for step in 1..4000 {
                let (sin, cos) = (2.0 * f64::from(step) * 0.0025).sin_cos();
                let wish = Wish {
                    position_m: Vector3::new(2.0 * sin, 0.0, 0.0),
                    velocity_m_s: Vector3::new(4.0 * cos, 0.0, 0.0),
                    acceleration_m_s2: Vector3::new(-8.0 * sin, 0.0, 0.0),
                };
                shaper.step(&wish, &limits, 0.0025);
                worst = worst.max((shaper.position_m - wish.position_m).norm());
            }
            worst
        };
        assert!(worst(20.0) < 0.1, "{}", worst(20.0));
        assert!(worst(2.5) > 1.0, "{}", worst(2.5));
    }
}
