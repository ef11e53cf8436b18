//! The wind gusts.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Effect, Hook, Input, Own, Parameter};

documented! {
    /// The wind along each world axis is a sum of sines with the spectrum of a first-order Gauss-Markov process,
    /// `2 sigma^2 T / (1 + (w T)^2)`, where T is `correlation_time`. It is smooth, and the seed makes it repeatable. A
    /// real gust does not repeat, so an estimate gives `sigma` and `correlation_time` only.
    ///
    /// Dryden's longitudinal form, MIL-F-8785C.
    #[derive(Debug, Clone, Copy)]
    pub struct Gust;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "sigma", unit: "m/s", bounds: Bounds::of(0.0, 10.0) },
    Parameter { name: "correlation_time", unit: "s", bounds: Bounds::of(0.05, 30.0) },
    Parameter { name: "seed", unit: "-", bounds: Bounds::of(0.0, 1e9) },
];

/// Lines a decade and axis are enough that no period shows within a flight.
const LINES: usize = 24;
/// Lowest frequency times correlation time; 2 % of the variance lies below it.
const LOWEST: f64 = 0.03;
/// Ratio of neighbouring lines: 24 of them reach 30 over the correlation time, 2 % of the variance beyond.
const STEP: f64 = 1.333_521_432_163_324;

/// A stream of shares in 0..1 by a linear congruential generator (Numerical Recipes' constants).
struct Phases(u32);

impl Phases {
    fn seeded(seed: f64) -> Self {
        let bits = seed.to_bits();
        let [a, b, c, d, e, f, g, h] = bits.to_le_bytes();
        let mut phases = Self(u32::from_le_bytes([a, b, c, d]) ^ u32::from_le_bytes([e, f, g, h]));
        // seeds that differ in few bits part ways
        for _ in 0..4 {
            phases.next_share();
        }
        phases
    }

    fn next_share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0) / 4_294_967_296.0
    }
}

impl Effect for Gust {
    fn id(&self) -> &'static str {
        "gust"
    }

    fn sentence(&self) -> &'static str {
        "The wind is gusty: the drag changes irregularly and does not repeat."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Air]
    }

    fn wind_m_s(&self, input: &Input, own: &Own) -> Vector3<f64> {
        let [sigma_m_s, correlation_s, seed] = [own.parameters[0], own.parameters[1], own.parameters[2]];
        let mut random = Phases::seeded(seed);
        let mut wind_m_s = Vector3::zeros();
        let mut low = LOWEST;
        for _ in 0..LINES {
            let high = low * STEP;
            // variance of the process between both frequencies
            let amplitude = sigma_m_s * (4.0 / std::f64::consts::PI * (high.atan() - low.atan())).sqrt();
            for wind in &mut wind_m_s {
                let frequency = (low + (high - low) * random.next_share()) / correlation_s;
                let phase = std::f64::consts::TAU * random.next_share();
                *wind += amplitude * (frequency * input.time_s + phase).sin();
            }
            low = high;
        }
        wind_m_s
    }
}
