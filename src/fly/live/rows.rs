//! Rows of the filtered model (38) from one instant after the other.

use crate::regression::{RATE_PAIRS, gyroscopic_from_products, momentum_regressor};
use crate::signals::{Butterworth, ButterworthMemory, FilterPair, PairMemory};
use nalgebra::{SMatrix, UnitQuaternion, Vector3, Vector4};

/// Everything at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instant {
    /// body to world
    pub(super) attitude: UnitQuaternion<f64>,
    /// rad/s, body
    pub(super) rate_rad_s: Vector3<f64>,
    /// m/s, world
    pub(super) velocity_m_s: Vector3<f64>,
    /// N, N m
    pub(super) wrench: Vector4<f64>,
    /// N
    pub(super) collective_n: f64,
}

/// Body rates, body velocity, up in z, wrench.
const LOW_PASSED: usize = 3 + 3 + 1 + 4;

/// The paper's filters, causal, for one flight.
#[derive(Debug)]
pub(super) struct Causal {
    low_pass: Butterworth,
    pair: FilterPair,
    gravity_m_s2: f64,
    memory: Memory,
}

#[derive(Debug, Clone, Copy, Default)]
struct Memory {
    low_passed: [ButterworthMemory; LOW_PASSED],
    /// of w, p, q, r, in which the momentum is linear
    momentum: [PairMemory; 4],
    /// of `p v - q u + g_bz` and the products of the rates, in which the rest is linear
    vertical: PairMemory,
    products: [PairMemory; RATE_PAIRS.len()],
    wrench: [PairMemory; 4],
}

impl Causal {
    /// `None` where the cut-off does not fit the step.
    pub(super) fn new(cutoff_hz: f64, step_s: f64, gravity_m_s2: f64) -> Option<Self> {
        Some(Self {
            low_pass: Butterworth::new(cutoff_hz, 1.0 / step_s)?,
            pair: FilterPair::new(FilterPair::PAPER_LAMBDA_RAD_S, step_s),
            gravity_m_s2,
            memory: Memory::default(),
        })
    }

    /// Forgets what was before.
    pub(super) fn restart(&mut self) {
        self.memory = Memory::default();
    }

    /// `Gamma` and `Upsilon` of (38) at the next instant.
    pub(super) fn row(&mut self, instant: &Instant) -> (SMatrix<f64, 4, 7>, Vector4<f64>) {
        let Self { low_pass, pair, gravity_m_s2, memory } = self;
        let velocity = instant.attitude.inverse_transform_vector(&instant.velocity_m_s);
        let up_z = instant.attitude.inverse_transform_vector(&Vector3::z()).z;
        let (rate, wrench) = (instant.rate_rad_s, instant.wrench);
        let mut smooth = [
            rate.x, rate.y, rate.z, velocity.x, velocity.y, velocity.z, up_z, wrench[0], wrench[1],
            wrench[2], wrench[3],
        ];
        for (value, memory) in smooth.iter_mut().zip(&mut memory.low_passed) {
            *value = low_pass.step(memory, *value);
        }
        let [p, q, r, u, v, w, up_z, fz, tx, ty, tz] = smooth;
        let mut momentum = [w, p, q, r];
        for (value, memory) in momentum.iter_mut().zip(&mut memory.momentum) {
            *value = pair.step_rate(memory, *value);
        }
        let omega = [p, q, r];
        let mut products = RATE_PAIRS.map(|(i, j)| omega[i] * omega[j]);
        for (value, memory) in products.iter_mut().zip(&mut memory.products) {
            *value = pair.step_low_pass(memory, *value);
        }
        let mut upsilon = Vector4::new(fz, tx, ty, tz);
        for (value, memory) in upsilon.iter_mut().zip(&mut memory.wrench) {
            *value = pair.step_low_pass(memory, *value);
        }
        let [w_rate, p_rate, q_rate, r_rate] = momentum;
        let mut gamma = momentum_regressor(w_rate, &Vector3::new(p_rate, q_rate, r_rate))
            + gyroscopic_from_products(&products);
        gamma[(0, 0)] += pair.step_low_pass(&mut memory.vertical, p * v - q * u + *gravity_m_s2 * up_z);
        (gamma, upsilon)
    }
}
