//! What a synthetic flight is asked to fly: hover, then a Fourier trajectory, with a smooth change-over.

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::SimulateError;
use super::controller::Setpoint;
use super::setting::positive;
use crate::trajectory::{FourierAxis, FourierTrajectory};

/// Bounds of a random Fourier trajectory (18); each axis is scaled until it touches its first bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomTrajectory {
    /// T, s
    pub period_s: f64,
    /// N
    pub harmonics: usize,
    /// greatest |x'|, |y'|, |z'|, m/s
    pub speed_max_m_s: f64,
    /// greatest |x''|, |y''|, |z''|, m/s^2
    pub acceleration_max_m_s2: f64,
    /// least and greatest height, m
    pub height_m: (f64, f64),
    /// greatest |yaw|, rad
    pub yaw_max_rad: f64,
    /// greatest |yaw rate|, rad/s
    pub yaw_rate_max_rad_s: f64,
}

impl Default for RandomTrajectory {
    fn default() -> Self {
        Self {
            period_s: 10.0,
            harmonics: 5,
            speed_max_m_s: 1.6,
            acceleration_max_m_s2: 3.5,
            height_m: (1.0, 2.2),
            yaw_max_rad: 0.3,
            yaw_rate_max_rad_s: 0.7,
        }
    }
}

/// Samples a period on which the bounds are checked: 100 of the fifth harmonic's 20 ms at 10 s.
const CHECKS: u32 = 500;

impl RandomTrajectory {
    /// Draws the coefficients. x and y start at 0, yaw is centred, z fills its range as far as speed allows.
    ///
    /// # Errors
    /// If a bound is not positive or the height range is empty.
    pub fn draw(&self, seed: u64) -> Result<FourierTrajectory, SimulateError> {
        positive("period_s", self.period_s)?;
        positive("speed_max_m_s", self.speed_max_m_s)?;
        positive("acceleration_max_m_s2", self.acceleration_max_m_s2)?;
        positive("yaw_max_rad", self.yaw_max_rad)?;
        positive("yaw_rate_max_rad_s", self.yaw_rate_max_rad_s)?;
        let range_m = positive("height_m range", self.height_m.1 - self.height_m.0)?;
        positive("harmonics", self.harmonics as f64)?;
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let horizontal = [f64::INFINITY, self.speed_max_m_s, self.acceleration_max_m_s2];
        let mut x = self.axis(&mut rng, horizontal);
        let mut y = self.axis(&mut rng, horizontal);
        let mut z = self.axis(&mut rng, [range_m / 2.0, self.speed_max_m_s, self.acceleration_max_m_s2]);
        let mut yaw = self.axis(&mut rng, [self.yaw_max_rad, self.yaw_rate_max_rad_s, f64::INFINITY]);
        let w_rad_s = std::f64::consts::TAU / self.period_s;
        for axis in [&mut x, &mut y] {
            axis.c = -axis.derivatives(w_rad_s, 0.0)[0];
        }
        z.c = f64::midpoint(self.height_m.0, self.height_m.1) - self.middle(&z);
        yaw.c = -self.middle(&yaw);
        Ok(FourierTrajectory { period_s: self.period_s, axes: [x, y, z, yaw] })
    }

    /// One axis, scaled to the bounds on half its range, its rate and its acceleration.
    fn axis(&self, rng: &mut Pcg64Mcg, bounds: [f64; 3]) -> FourierAxis {
        let mut draw = || (0..self.harmonics).map(|_| StandardNormal.sample(rng)).collect::<Vec<f64>>();
        let mut axis = FourierAxis { a: draw(), b: draw(), c: 0.0 };
        let (low, high) = self.extremes(&axis, 0);
        let (rate_low, rate_high) = self.extremes(&axis, 1);
        let (acceleration_low, acceleration_high) = self.extremes(&axis, 2);
        let scale = (bounds[0] / ((high - low) / 2.0))
            .min(bounds[1] / rate_high.max(-rate_low))
            .min(bounds[2] / acceleration_high.max(-acceleration_low));
        for coefficient in axis.a.iter_mut().chain(&mut axis.b) {
            *coefficient *= scale;
        }
        axis
    }

    fn extremes(&self, axis: &FourierAxis, order: usize) -> (f64, f64) {
        let w_rad_s = std::f64::consts::TAU / self.period_s;
        let step_s = self.period_s / f64::from(CHECKS);
        (0..CHECKS).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), check| {
            let value = axis.derivatives(w_rad_s, f64::from(check) * step_s)[order];
            (low.min(value), high.max(value))
        })
    }

    fn middle(&self, axis: &FourierAxis) -> f64 {
        let (low, high) = self.extremes(axis, 0);
        f64::midpoint(low, high)
    }
}

/// Hover at the trajectory's first point, then the trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// what is flown
    pub trajectory: FourierTrajectory,
    /// how long it hovers first, s
    pub hover_s: f64,
    /// change-over after hover, s; position, velocity and acceleration stay continuous
    pub ramp_s: f64,
}

impl Reference {
    /// What is asked for at `time_s`.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Setpoint {
        let since_s = (time_s - self.hover_s).max(0.0);
        let start = self.trajectory.derivatives(0.0);
        let now = self.trajectory.derivatives(since_s);
        let [s0, s1, s2] = smooth_step(since_s, self.ramp_s);
        let blend = |axis: usize| {
            let away = now[axis][0] - start[axis][0];
            let (rate, acceleration) = (now[axis][1], now[axis][2]);
            [
                start[axis][0] + s0 * away,
                s1 * away + s0 * rate,
                s2 * away + 2.0 * s1 * rate + s0 * acceleration,
            ]
        };
        let (x, y, z, yaw) = (blend(0), blend(1), blend(2), blend(3));
        Setpoint {
            position_m: Vector3::new(x[0], y[0], z[0]),
            velocity_m_s: Vector3::new(x[1], y[1], z[1]),
            acceleration_m_s2: Vector3::new(x[2], y[2], z[2]),
            yaw_rad: yaw[0],
            yaw_rate_rad_s: yaw[1],
        }
    }
}

/// From 0 to 1 with two continuous derivatives, `10 x^3 - 15 x^4 + 6 x^5`, and those derivatives.
fn smooth_step(time_s: f64, length_s: f64) -> [f64; 3] {
    if time_s >= length_s {
        return [1.0, 0.0, 0.0];
    }
    let x = time_s / length_s;
    [
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * x * x * (1.0 - x).powi(2) / length_s,
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (length_s * length_s),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_trajectories_keep_their_bounds() {
        let bounds = RandomTrajectory { speed_max_m_s: 2.5, ..RandomTrajectory::default() };
        for seed in 0..20 {
            let trajectory = bounds.draw(seed).unwrap();
            let mut touched = 0.0_f64;
            for check in 0..1000_u32 {
                let [x, y, z, yaw] = trajectory.derivatives(f64::from(check) * 0.01);
                for axis in [x, y, z] {
                    assert!(axis[1].abs() < 2.5 * 1.001 && axis[2].abs() < 3.5 * 1.001);
                }
                assert!(z[0] > 0.99 && z[0] < 2.21 && yaw[0].abs() < 0.301 && yaw[1].abs() < 0.701);
                touched = touched.max(x[1].abs() / 2.5).max(x[2].abs() / 3.5);
            }
            assert!(touched > 0.99);
        }
        assert!(bounds.draw(1).unwrap() != bounds.draw(2).unwrap());
    }

    #[test]
    fn the_change_over_is_smooth_and_consistent() {
        let trajectory = RandomTrajectory::default().draw(3).unwrap();
        let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
        let h = 1e-4;
        for step in 0..60 {
            let t = 3.5 + 0.0501 * f64::from(step);
            let (a, b, c) = (reference.at(t - h), reference.at(t), reference.at(t + h));
            assert!(((c.position_m - a.position_m) / (2.0 * h) - b.velocity_m_s).norm() < 1e-4);
            assert!(((c.velocity_m_s - a.velocity_m_s) / (2.0 * h) - b.acceleration_m_s2).norm() < 2e-3);
            assert!(((c.yaw_rad - a.yaw_rad) / (2.0 * h) - b.yaw_rate_rad_s).abs() < 1e-4);
        }
        assert_eq!(reference.at(0.0).velocity_m_s, Vector3::zeros());
    }
}
