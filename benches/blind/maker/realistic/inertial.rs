//! The inertial unit: white noise, biases that walk, vibration at the rotors' frequency and its double, mounted askew.

use nalgebra::{Matrix3, Rotation3, Vector3};
use rand::{Rng, RngExt};

use super::super::GRAVITY;
use super::super::flight::TICK;
use super::low_pass::LowPass;
use super::{drawn, drawn_three, spread};

/// Levels of a unit.
#[derive(Debug, Clone)]
pub struct Unit {
    /// m/s^2 and rad/s, of a sample
    pub white: [f64; 2],
    /// m/s^2 at the rotors' speed in hover
    pub vibration: f64,
    /// m/s^2 and rad/s when the flight begins
    pub bias: [Vector3<f64>; 2],
    /// of each in a second
    pub walk: [f64; 2],
    /// how it sits in the body
    pub mount: Rotation3<f64>,
    /// Hz, of the rates that are believed and sent
    pub cut: f64,
}

impl Unit {
    pub fn random(dice: &mut impl Rng) -> Self {
        let way = drawn_three(1.0, dice);
        let askew = dice.random_range(0.2..0.5_f64).to_radians();
        Self {
            white: [noisy(0.1, 1.5, dice), noisy(0.005, 0.1, dice)],
            vibration: spread(0.05, 0.6, dice),
            bias: [drawn_three(0.15, dice), drawn_three(0.008, dice)],
            walk: [0.004, 0.0002],
            mount: Rotation3::new(way.normalize() * askew),
            cut: dice.random_range(30.0..80.0),
        }
    }
}

/// Between two levels, more often near the upper one.
fn noisy(low: f64, high: f64, dice: &mut impl Rng) -> f64 {
    low * (high / low).powf(dice.random_range(0.0..1.0_f64).powf(0.7))
}

/// What the unit says at a tick.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sample {
    /// m/s^2
    pub force: Vector3<f64>,
    /// rad/s
    pub rates: Vector3<f64>,
    /// behind a low-pass of 20 Hz
    pub slow_force: Vector3<f64>,
    /// behind the low-pass of the rates
    pub slow_rates: Vector3<f64>,
}

/// A unit at work.
pub struct Inertial {
    unit: Unit,
    bias: [Vector3<f64>; 2],
    /// rad, and direction of the shaking, of each rotor
    shaking: [(f64, Vector3<f64>); 4],
    /// rad/s
    hover: f64,
    slow: [LowPass; 2],
}

/// Of the 20 Hz that a unit's slow stream has, Hz.
const SLOW_FORCE: f64 = 20.0;

impl Inertial {
    pub fn new(unit: &Unit, hover: f64, dice: &mut impl Rng) -> Self {
        let shaking = std::array::from_fn(|_| {
            let way = drawn_three(1.0, dice).normalize();
            (dice.random_range(0.0..std::f64::consts::TAU), way)
        });
        let still = Vector3::new(0.0, 0.0, GRAVITY);
        Self {
            bias: unit.bias,
            shaking,
            hover,
            slow: [
                LowPass::new(SLOW_FORCE, TICK, still + unit.bias[0]),
                LowPass::new(unit.cut, TICK, unit.bias[1]),
            ],
            unit: unit.clone(),
        }
    }

    /// What it says of the tick in which velocity and attitude went from one to the other.
    pub fn next(
        &mut self,
        (velocity, rotation): ([Vector3<f64>; 2], [Matrix3<f64>; 2]),
        speeds: &[f64; 4],
        dice: &mut impl Rng,
    ) -> Sample {
        let between = Rotation3::from_matrix_unchecked(rotation[0].transpose() * rotation[1]);
        let turned = between.scaled_axis();
        let middle = rotation[0] * Rotation3::new(0.5 * turned).matrix();
        let gained = (velocity[1] - velocity[0]) / TICK + Vector3::new(0.0, 0.0, GRAVITY);
        let shake = self.shake(speeds);
        let of_body = [middle.transpose() * gained + shake, turned / TICK + 0.03 * shake];
        let mut said = [Vector3::zeros(); 2];
        for kind in 0..2 {
            let walked = drawn_three(self.unit.walk[kind] * TICK.sqrt(), dice);
            self.bias[kind] += walked;
            let white = drawn_three(self.unit.white[kind], dice);
            said[kind] = self.unit.mount * of_body[kind] + self.bias[kind] + white;
        }
        let [force, rates] = said;
        Sample { force, rates, slow_force: self.slow[0].next(force), slow_rates: self.slow[1].next(rates) }
    }

    /// m/s^2 of what the rotors shake, as the samples alias it.
    fn shake(&mut self, speeds: &[f64; 4]) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for ((phase, way), speed) in self.shaking.iter_mut().zip(speeds) {
            *phase = (*phase + speed * TICK).rem_euclid(std::f64::consts::TAU);
            let size = self.unit.vibration * (speed / self.hover).powi(2);
            sum += size * (phase.sin() + 0.5 * (2.0 * *phase).sin()) * *way;
        }
        sum
    }
}

/// A value that wanders about nothing.
#[derive(Debug, Clone, Copy)]
pub struct Wander {
    sigma: f64,
    keep: f64,
    pub value: f64,
}

impl Wander {
    /// Of this size and time, s, in steps of `step` s.
    pub fn new((sigma, time): (f64, f64), step: f64, dice: &mut impl Rng) -> Self {
        Self { sigma, keep: (-step / time).exp(), value: drawn(sigma, dice) }
    }

    pub fn next(&mut self, dice: &mut impl Rng) -> f64 {
        let fresh = (1.0 - self.keep * self.keep).sqrt();
        self.value = self.keep * self.value + drawn(fresh * self.sigma, dice);
        self.value
    }
}
