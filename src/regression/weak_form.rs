//! The weak form of (11), the right way round.
//!
//! A logged command is one sample of a loop that runs faster than the log, so it is by far the
//! noisiest signal: it stands on the left, alone. Accelerations, hardly noisy under the weak form's
//! kernel, stand on the right. With the command on the right the inertia would come out too large.
//!
//! ```text
//! K(F) = [D Phi_a + K Phi_b] Theta + latency * d/dt[...] Theta + trim torques
//! ```
//!
//! `latency` is the time by which the body follows the recorded command: a first-order lag gives
//! `F_command = F + tau F'` exactly, a pure delay gives it to first order.

use super::filtered::{RATE_PAIRS, gyroscopic_from_products, momentum_regressor};
use crate::signals::{Grid, Series, Signals, WeakKernel, stride};
use nalgebra::{SMatrix, Vector3, Vector4};

/// Fz, `tau_x`, `tau_y`, `tau_z`.
pub const CHANNELS: usize = 4;

/// What the regressor needs of the motion, on the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakMotion {
    /// rad/s, body
    pub omega: Option<Series<Vector3<f64>>>,
    /// m/s^2, what an ideal accelerometer on body z shows
    pub vertical: Option<VerticalMotion>,
}

/// Vertical specific force, measured or from velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct VerticalMotion {
    /// accelerometer z (bias removed where velocity is known), m/s^2
    pub specific_force_z: Option<Vec<f64>>,
    /// body velocity w and `p v - q u + g_bz`
    pub kinematic: Option<(Vec<f64>, Vec<f64>)>,
    /// share of the accelerometer, 0..1
    pub accelerometer_share: f64,
    /// m/s^2, mean of accelerometer less kinematics, where both are there
    pub accelerometer_bias: Option<f64>,
}

/// Weak-form rows of one flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WeakRows {
    /// s, vehicle clock, of each row
    pub time_s: Vec<f64>,
    /// `K(F)`: rows x 4 (N, N m)
    pub output: Vec<Vector4<f64>>,
    /// `D Phi_a + K Phi_b` and its first two time derivatives
    pub regressor: [Vec<SMatrix<f64, 4, 7>>; 3],
    /// `K(w)`, rad/s: what angular damping acts on
    pub rate: Vec<Vector3<f64>>,
    /// what drag along body z acts on: `K` of the body's velocity w (m/s), and of the north and west
    /// components of the thrust axis, by which a wind reaches it (-); zero where attitude is not known
    pub heave: Vec<Vector3<f64>>,
    /// `K` of what the commands' jitter adds if the rotors follow all of it (N, N m); zero where unknown
    pub jitter: Vec<Vector4<f64>>,
    /// what the gyroscopic torques about body x, y and z have coefficients of their own on, `K(w_y w_z)`, `K(w_z w_x)`, `K(w_x w_y)`,
    /// (rad/s)^2; empty where they are those of the moments of inertia
    pub gyroscopic: Vec<Vector3<f64>>,
    /// rows without a break between them
    pub runs: Vec<std::ops::Range<usize>>,
}

impl WeakRows {
    /// Gives the gyroscopic torques coefficients of their own in place of differences of the moments of inertia. A simulator may not have these
    /// torques, and then they say that izz is near ixx and iyy, whatever turns the vehicle about z.
    pub fn free_gyroscopic_torque(&mut self) {
        // torque about x, y, z, and the moments about the two other axes: the first of them with a positive sign
        const OTHERS: [(usize, [usize; 2]); 3] = [(1, [6, 4]), (2, [1, 6]), (3, [4, 1])];
        let of = |phi: &SMatrix<f64, 4, 7>| {
            Vector3::from(OTHERS.map(|(channel, [moment, _])| phi[(channel, moment)]))
        };
        self.gyroscopic = self.regressor[0].iter().map(of).collect();
        for phi in self.regressor.iter_mut().flatten() {
            for (channel, moments) in OTHERS {
                moments.into_iter().for_each(|moment| phi[(channel, moment)] = 0.0);
            }
        }
    }
}

impl WeakMotion {
    /// From what was measured.
    #[must_use]
    pub fn measured(signals: &Signals, kernel: &WeakKernel, gravity_m_s2: f64) -> Self {
        Self {
            omega: signals.rate.clone().filter(|_| signals.quality.torques),
            vertical: VerticalMotion::measured(signals, kernel, gravity_m_s2),
        }
    }
}

impl VerticalMotion {
    fn measured(signals: &Signals, kernel: &WeakKernel, gravity_m_s2: f64) -> Option<Self> {
        let mut specific_force_z: Option<Vec<f64>> =
            signals.specific_force.as_ref().map(|f| f.iter().map(|f| f.z).collect());
        if specific_force_z.is_none() && signals.attitude.is_none() {
            // without attitude the size of the world's specific force is still the thrust's
            specific_force_z = signals
                .world_acceleration
                .as_ref()
                .map(|a| a.iter().map(|a| (a + Vector3::new(0.0, 0.0, gravity_m_s2)).norm()).collect());
        }
        let kinematic = kinematic(signals, gravity_m_s2);
        let (mut bias, mut share) = (None, 1.0);
        match (&mut specific_force_z, &kinematic) {
            (Some(force), Some((w, rest))) => {
                let centers = kernel.centers(&signals.usable, stride(signals.grid.step_s));
                let difference: Vec<f64> = centers
                    .iter()
                    .map(|&c| kernel.at(0, force, c) - kernel.at(1, w, c) - kernel.at(0, rest, c))
                    .collect();
                let mean = difference.iter().sum::<f64>() / difference.len().max(1) as f64;
                force.iter_mut().for_each(|f| *f -= mean);
                bias = Some(mean);
                share = 0.8;
            }
            (None, Some(_)) => share = 0.0,
            (None, None) => return None,
            (Some(_), None) => {}
        }
        Some(Self { specific_force_z, kinematic, accelerometer_share: share, accelerometer_bias: bias })
    }

    /// Specific force on body z (order 0) or its derivatives, at one centre.
    fn at(&self, kernel: &WeakKernel, order: usize, center: usize) -> f64 {
        let measured = self.specific_force_z.as_ref().map_or(0.0, |f| kernel.at(order, f, center));
        let kinematic = self
            .kinematic
            .as_ref()
            .map_or(0.0, |(w, rest)| kernel.at(order + 1, w, center) + kernel.at(order, rest, center));
        self.accelerometer_share * measured + (1.0 - self.accelerometer_share) * kinematic
    }
}

/// `w` and `p v - q u + g_bz`, where attitude, rates and velocity are known.
fn kinematic(signals: &Signals, gravity_m_s2: f64) -> Option<(Vec<f64>, Vec<f64>)> {
    let (attitude, rate) = (signals.attitude.as_ref()?, signals.rate.as_ref()?);
    let velocity = signals.velocity.as_ref()?;
    let mut w = Vec::with_capacity(rate.len());
    let mut rest = Vec::with_capacity(rate.len());
    for ((q, omega), v) in attitude.iter().zip(rate.iter()).zip(velocity.iter()) {
        let body = q.inverse_transform_vector(v);
        let up = q.inverse_transform_vector(&Vector3::z());
        w.push(body.z);
        rest.push(omega.x * body.y - omega.y * body.x + gravity_m_s2 * up.z);
    }
    Some((w, rest))
}

/// Builds the rows of one flight; the motion's missing parts leave zero columns.
#[must_use]
pub fn weak_rows(signals: &Signals, motion: &WeakMotion, kernel: &WeakKernel) -> WeakRows {
    let stride = stride(signals.grid.step_s);
    let mut rows = WeakRows::default();
    let columns = |series: &[Vector4<f64>]| -> [Vec<f64>; CHANNELS] {
        std::array::from_fn(|channel| series.iter().map(|w| w[channel]).collect())
    };
    // without body rates no torque is compared
    let acting = |mut columns: [Vec<f64>; CHANNELS]| {
        if motion.omega.is_none() {
            columns.iter_mut().skip(1).for_each(|torque| torque.fill(0.0));
        }
        columns
    };
    let wrench = acting(columns(&signals.wrench));
    let jitter = signals.jitter_wrench.as_deref().map(|jitter| acting(columns(jitter)));
    let heave = heave_columns(signals);
    let smooth = |columns: &[Vec<f64>; CHANNELS], center| {
        Vector4::from_fn(|channel, _| kernel.at(0, &columns[channel], center))
    };
    let products = motion.omega.as_ref().map(|omega| GyroscopicColumns::from(omega));
    for run in Grid::runs(&signals.usable, 2 * kernel.half_count + 1) {
        let first = rows.time_s.len();
        for center in (run.start + kernel.half_count..run.end - kernel.half_count).step_by(stride) {
            rows.time_s.push(signals.grid.time_s(center));
            rows.output.push(smooth(&wrench, center));
            rows.heave.push(heave.as_ref().map_or_else(Vector3::zeros, |columns| {
                Vector3::from_fn(|i, _| kernel.at(0, &columns[i], center))
            }));
            rows.jitter.push(jitter.as_ref().map_or_else(Vector4::zeros, |jitter| smooth(jitter, center)));
            rows.rate.push(products.as_ref().map_or_else(Vector3::zeros, |p| p.rate(kernel, center)));
            for order in 0..3 {
                let mut phi = SMatrix::<f64, 4, 7>::zeros();
                if let Some(products) = &products {
                    phi += products.at(kernel, order, center);
                }
                if let Some(vertical) = &motion.vertical {
                    phi[(0, 0)] = vertical.at(kernel, order, center);
                }
                rows.regressor[order].push(phi);
            }
        }
        rows.runs.push(first..rows.time_s.len());
    }
    rows
}

/// Body velocity w, and the thrust axis' north and west components.
fn heave_columns(signals: &Signals) -> Option<[Vec<f64>; 3]> {
    let (attitude, velocity) = (signals.attitude.as_ref()?, signals.velocity.as_ref()?);
    let axes: Vec<Vector3<f64>> = attitude.iter().map(|q| q.transform_vector(&Vector3::z())).collect();
    let w = axes.iter().zip(velocity.iter()).map(|(axis, v)| axis.dot(v)).collect();
    Some([w, axes.iter().map(|axis| axis.x).collect(), axes.iter().map(|axis| axis.y).collect()])
}

/// `Phi_a` and `Phi_b` as scalar columns, so that each is filtered once: Phi_a is linear in p, q, r,
/// Phi_b in their six products.
struct GyroscopicColumns {
    rates: [Vec<f64>; 3],
    /// pp, qq, rr, pq, pr, qr
    products: [Vec<f64>; 6],
}

impl GyroscopicColumns {
    fn from(omega: &[Vector3<f64>]) -> Self {
        Self {
            rates: std::array::from_fn(|i| omega.iter().map(|w| w[i]).collect()),
            products: RATE_PAIRS.map(|(i, j)| omega.iter().map(|w| w[i] * w[j]).collect()),
        }
    }

    fn rate(&self, kernel: &WeakKernel, center: usize) -> Vector3<f64> {
        Vector3::from_fn(|i, _| kernel.at(0, &self.rates[i], center))
    }

    /// `D^(order+1) Phi_a + D^order Phi_b` without the force row.
    fn at(&self, kernel: &WeakKernel, order: usize, center: usize) -> SMatrix<f64, 4, 7> {
        let accelerations = Vector3::from_fn(|i, _| kernel.at(order + 1, &self.rates[i], center));
        let products = std::array::from_fn(|k| kernel.at(order, &self.products[k], center));
        momentum_regressor(0.0, &accelerations) + gyroscopic_from_products(&products)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Quantity;
    use crate::signals::{
        AsRecorded, OwnOfFlight, Quality, ThrustSource, TorqueError, Usable, VelocityHeldBy,
    };
    use nalgebra::SVector;

    const STEP_S: f64 = 0.01;

    /// 4 s with body rates (rad/s), specific force along z (m/s^2) and wrench as functions of time.
    fn rows_of(
        rate: impl Fn(f64) -> Vector3<f64>,
        lift: impl Fn(f64) -> f64,
        wrench: Vector4<f64>,
    ) -> (WeakRows, WeakKernel) {
        let count = 400;
        let series = |of: &dyn Fn(f64) -> Vector3<f64>| -> Vec<Vector3<f64>> {
            (0..count).map(|i| of(STEP_S * i as f64)).collect()
        };
        let signals = Signals {
            grid: Grid { start_s: 0.0, step_s: STEP_S, count },
            usable: vec![true; count],
            attitude: None,
            rate: Some(series(&rate).into()),
            specific_force: Some(series(&|t| Vector3::new(0.0, 0.0, lift(t))).into()),
            world_acceleration: None,
            position: None,
            velocity: None,
            rotor_thrust_n: Vec::new().into(),
            full_thrust_n: 1.0,
            wrench: vec![wrench; count].into(),
            jitter_wrench: None,
            battery_voltage_v: None,
            as_recorded: AsRecorded::default(),
            reference: None,
            own: OwnOfFlight::default(),
            air_m_s: Vector3::zeros(),
            quality: Quality {
                sources: vec![(Quantity::ActuatorCommand, "by hand", 1.0 / STEP_S)],
                thrust_source: ThrustSource::Command,
                offsets: Vec::new(),
                airborne_s: Vec::new(),
                usable: Usable::default(),
                torques: true,
                torque_error: TorqueError::default(),
                gyro_noise_rad_s: None,
                velocity_held_by: VelocityHeldBy::default(),
                position_by_receiver: false,
                steady_voltage_v: None,
                simulated: false,
                notes: Vec::new(),
            },
        };
        let kernel = WeakKernel::new(0.2, STEP_S);
        let motion = WeakMotion::measured(&signals, &kernel, 9.81);
        (weak_rows(&signals, &motion, &kernel), kernel)
    }

    /// `regressor * Theta` of a row and order.
    fn acting(rows: &WeakRows, order: usize, row: usize, theta: [f64; 7]) -> Vector4<f64> {
        rows.regressor[order][row] * SVector::<f64, 7>::from(theta)
    }

    /// By hand: Euler's equations without torque let the rate of a body with moments (a, a, c) turn about z at
    /// `(c - a) / a` of its spin. Its rows hold no torque, in any order; its thrust is what it is.
    #[test]
    fn a_symmetric_top_turns_without_torque() {
        let (a, c, spin) = (0.02, 0.035, 2.0);
        let w = (c - a) / a * spin;
        let rate = |t: f64| Vector3::new((w * t).cos(), (w * t).sin(), spin);
        let thrust = Vector4::new(18.5, 0.0, 0.0, 0.0);
        let (rows, _) = rows_of(rate, |_| 18.5 / 1.6, thrust);
        let theta = [1.6, a, 0.0, 0.0, a, 0.0, c];
        assert!(rows.time_s.len() > 60);
        for row in 0..rows.time_s.len() {
            assert!((acting(&rows, 0, row, theta) - rows.output[row]).norm() < 1e-7);
            // against what each of the two terms has
            for (order, size, sampled) in [(1, a * w.powi(2), 1e-6), (2, a * w.powi(3), 5e-5)] {
                let left = acting(&rows, order, row, theta).norm();
                assert!(left < sampled * size, "order {order}: {left} of {size}");
            }
            assert!((rows.output[row] - thrust).norm() < 1e-9);
        }
    }

    /// By hand: at a rate `A t` about x the torque is `A (Ixx, Ixy, Ixz) + A^2 t^2 (0, -Ixz, Ixy)`, and the test function
    /// of half width H makes `t^2 + H^2 / 11` of `t^2`. A specific force that grows by 0.5 m/s^3 stays what it is.
    #[test]
    fn a_steady_spin_up_takes_the_torque_of_the_products_of_inertia() {
        let (up, xx, xy, xz) = (0.9, 0.02, 0.001, -0.002);
        let (rows, kernel) = rows_of(|t| Vector3::new(up * t, 0.0, 0.0), |t| 9.0 + 0.5 * t, Vector4::zeros());
        let theta = [1.6, xx, xy, xz, 0.03, 0.0015, 0.045];
        let h = (kernel.half_count as f64 + 1.0) * STEP_S;
        for (row, t) in rows.time_s.iter().enumerate() {
            let square = up * up * (t * t + h * h / 11.0);
            let expected =
                Vector4::new(1.6 * (9.0 + 0.5 * t), up * xx, up * xy - square * xz, up * xz + square * xy);
            let found = acting(&rows, 0, row, theta);
            assert!((found - expected).norm() < 1e-8, "{found}, not {expected}");
            let slope = 2.0 * up * up * t;
            let expected = Vector4::new(1.6 * 0.5, 0.0, -slope * xz, slope * xy);
            let found = acting(&rows, 1, row, theta);
            assert!((found - expected).norm() < 1e-8, "{found}, not {expected}");
        }
    }
}
