//! The circular validation paths (44).

use super::{FourierAxis, FourierTrajectory};
use std::f64::consts::{PI, TAU};

/// One of (44): a circle flown in 5 s, the height swinging once a turn after a first turn of climbing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CirclePath {
    /// radius of the circle, m
    pub radius_m: f64,
    /// height about which the path swings, m
    pub height_m: f64,
}

/// One turn, s.
const TURN_S: f64 = 5.0;
/// Height at which (44) starts, m.
const START_HEIGHT_M: f64 = 0.3;
/// Swing of the height, m.
const SWING_M: f64 = 0.1;
/// Swing of the yaw, rad (15 degrees).
const YAW_RAD: f64 = 15.0 * PI / 180.0;
/// Rate of the climb, 1/s^3.
const CLIMB_1_S3: f64 = 0.1;

impl CirclePath {
    /// For x, y, z, psi at `t_s`: value and first four derivatives. At 5 s the height changes its law;
    /// there the printed path steps by some micrometres and its velocity by 0.13 m/s.
    #[must_use]
    pub fn derivatives(&self, t_s: f64) -> [[f64; 5]; 4] {
        let w = TAU / TURN_S;
        let cosine = harmonic(w, w * t_s + 0.5 * PI);
        let sine = harmonic(w, w * t_s);
        let z = if t_s < TURN_S {
            let decay = cubic_decay(t_s).map(|value| (START_HEIGHT_M - self.height_m) * value);
            [self.height_m + decay[0], decay[1], decay[2], decay[3], decay[4]]
        } else {
            let swing = sine.map(|value| SWING_M * value);
            [self.height_m + swing[0], swing[1], swing[2], swing[3], swing[4]]
        };
        [
            cosine.map(|value| self.radius_m * value),
            sine.map(|value| self.radius_m * value),
            z,
            sine.map(|value| YAW_RAD * value),
        ]
    }
}

impl CirclePath {
    /// The turns after the climb as a series (18) of one harmonic, flown in `turn_s` (s; 5 in the paper).
    /// It starts at full speed: a transition leads there in place of the printed climb.
    #[must_use]
    pub fn steady_turns(&self, turn_s: f64) -> FourierTrajectory {
        let w = TAU / turn_s;
        let axis =
            |sine: f64, cosine: f64, c: f64| FourierAxis { a: vec![sine * w], b: vec![-cosine * w], c };
        let axes = [
            axis(0.0, self.radius_m, 0.0),
            axis(self.radius_m, 0.0, 0.0),
            axis(SWING_M, 0.0, self.height_m),
            axis(YAW_RAD, 0.0, 0.0),
        ];
        FourierTrajectory { period_s: turn_s, axes }
    }
}

/// `sin(phase)` and its derivatives for `phase' = w`.
fn harmonic(w: f64, phase: f64) -> [f64; 5] {
    let (s, c) = phase.sin_cos();
    [s, w * c, -w * w * s, -w.powi(3) * c, w.powi(4) * s]
}

/// `exp(-0.1 t^3)` and its derivatives.
fn cubic_decay(t: f64) -> [f64; 5] {
    let value = (-CLIMB_1_S3 * t.powi(3)).exp();
    let (u1, u2, u3) = (-3.0 * CLIMB_1_S3 * t * t, -6.0 * CLIMB_1_S3 * t, -6.0 * CLIMB_1_S3);
    let first = u1 * value;
    let second = u2 * value + u1 * first;
    let third = u3 * value + 2.0 * u2 * first + u1 * second;
    let fourth = 3.0 * u3 * first + 3.0 * u2 * second + u1 * third;
    [value, first, second, third, fourth]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_and_swings_as_printed() {
        let path = CirclePath { radius_m: 0.5, height_m: 1.0 };
        let start = path.derivatives(0.0);
        assert!((start[0][0] - 0.5).abs() < 1e-15 && start[1][0].abs() < 1e-15);
        assert!((start[2][0] - 0.3).abs() < 1e-15);
        let later = path.derivatives(6.25);
        assert!((later[2][0] - 1.1).abs() < 1e-12);
        assert!((later[3][0].to_degrees() - 15.0).abs() < 1e-10);
    }

    #[test]
    fn steady_turns_are_the_printed_path_after_its_climb() {
        let path = CirclePath { radius_m: 0.5, height_m: 1.0 };
        let turns = path.steady_turns(TURN_S);
        for t in [5.1, 6.0, 8.3, 9.9] {
            let (series, printed) = (turns.derivatives(t), path.derivatives(t));
            for axis in 0..4 {
                for order in 0..5 {
                    assert!((series[axis][order] - printed[axis][order]).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let path = CirclePath { radius_m: 0.8, height_m: 0.9 };
        let h = 1e-4;
        for t in [0.4, 1.9, 3.1, 7.7] {
            let (before, now, after) =
                (path.derivatives(t - h), path.derivatives(t), path.derivatives(t + h));
            for axis in 0..4 {
                for order in 0..4 {
                    let numeric = (after[axis][order] - before[axis][order]) / (2.0 * h);
                    assert!((numeric - now[axis][order + 1]).abs() < 1e-5, "axis {axis} order {order}");
                }
            }
        }
    }
}
