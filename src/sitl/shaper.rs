//! A reference that keeps within speed, acceleration and jerk on its way to what is asked for.
//!
//! As ArduPilot shapes it (`AP_Math/control.cpp`: `shape_pos_vel_accel`, `shape_vel_accel`, `shape_accel`,
//! `sqrt_controller`): each error is answered by the next derivative, linearly where it is small and by the
//! square root of the distance in which one can still stop where it is large.

use nalgebra::{SVector, Vector1, Vector2, Vector3};

/// Bounds of the reference; horizontal and vertical apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ShaperLimits {
    /// horizontal, m/s
    pub(super) speed_m_s: f64,
    /// m/s
    pub(super) climb_m_s: f64,
    /// positive, m/s
    pub(super) descent_m_s: f64,
    /// horizontal, m/s^2
    pub(super) acceleration_m_s2: f64,
    /// m/s^2
    pub(super) vertical_acceleration_m_s2: f64,
    /// m/s^3
    pub(super) jerk_m_s3: f64,
}

/// What the reference shall reach, world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wish {
    /// m; a component that is NaN is not asked for
    pub(super) position_m: Vector3<f64>,
    /// m/s, beside what the position error asks for
    pub(super) velocity_m_s: Vector3<f64>,
    /// m/s^2, beside what the velocity error asks for
    pub(super) acceleration_m_s2: Vector3<f64>,
}

/// How much slower the position's loop is than the velocity's (ArduPilot's `CONTROL_TIME_CONSTANT_RATIO`).
const LOOP_RATIO: f64 = 4.0;

/// The reference, world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shaper {
    /// m
    pub(super) position_m: Vector3<f64>,
    /// m/s
    pub(super) velocity_m_s: Vector3<f64>,
    /// m/s^2
    pub(super) acceleration_m_s2: Vector3<f64>,
}

impl Shaper {
    /// A reference that goes on as the vehicle moves now.
    pub(super) fn at(position_m: Vector3<f64>, velocity_m_s: Vector3<f64>) -> Self {
        Self { position_m, velocity_m_s, acceleration_m_s2: Vector3::zeros() }
    }

    /// One period on its way to `wish`.
    pub(super) fn step(&mut self, wish: &Wish, limits: &ShaperLimits, period_s: f64) {
        let axis = |v: &Vector3<f64>| (v.xy(), Vector1::new(v.z));
        let (wish_p, wish_v, wish_a) =
            (axis(&wish.position_m), axis(&wish.velocity_m_s), axis(&wish.acceleration_m_s2));
        let (p, v, a) = (axis(&self.position_m), axis(&self.velocity_m_s), axis(&self.acceleration_m_s2));
        let level = Bounds {
            speed: (limits.speed_m_s, limits.speed_m_s),
            acceleration: limits.acceleration_m_s2,
            jerk: limits.jerk_m_s3,
        };
        let upright = Bounds {
            speed: (limits.descent_m_s, limits.climb_m_s),
            acceleration: limits.vertical_acceleration_m_s2,
            jerk: limits.jerk_m_s3,
        };
        let side: Vector2<f64> =
            shaped([&wish_p.0, &wish_v.0, &wish_a.0], [&p.0, &v.0, &a.0], &level, period_s);
        let up: Vector1<f64> =
            shaped([&wish_p.1, &wish_v.1, &wish_a.1], [&p.1, &v.1, &a.1], &upright, period_s);
        self.acceleration_m_s2 = Vector3::new(side.x, side.y, up.x);
        self.position_m +=
            self.velocity_m_s * period_s + self.acceleration_m_s2 * (0.5 * period_s * period_s);
        self.velocity_m_s += self.acceleration_m_s2 * period_s;
    }
}

/// Bounds of one axis group.
struct Bounds {
    /// least (as a positive number) and greatest
    speed: (f64, f64),
    acceleration: f64,
    jerk: f64,
}

/// The next acceleration of one axis group.
fn shaped<const D: usize>(
    [position, velocity, acceleration]: [&SVector<f64, D>; 3],
    [p, v, a]: [&SVector<f64, D>; 3],
    bounds: &Bounds,
    period_s: f64,
) -> SVector<f64, D> {
    let pole = bounds.jerk / bounds.acceleration;
    let braking = bounds.acceleration * (1.0 - 1.0 / LOOP_RATIO);
    let error = (position - p).map(|error| if error.is_nan() { 0.0 } else { error });
    let wanted = root_law(&error, pole / LOOP_RATIO, braking);
    let wanted = capped(&wanted, bounds) + velocity;
    let turn = root_law(&(wanted - v), pole, bounds.jerk).cap_magnitude(bounds.acceleration);
    let target = (turn + acceleration).cap_magnitude(bounds.acceleration);
    a + (target - a).cap_magnitude(bounds.jerk * period_s)
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
    };

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
