//! Flights as an autopilot's telemetry is: the controller flies on what an estimator believes, and the telemetry
//! carries that belief. The estimator errs as such do: its delay is a little wrong, its noise levels are set by hand,
//! its inertial unit shakes and sits askew. The controller answers its errors with tilt and thrust, so that commands and
//! estimates share them.

pub mod case;
pub mod estimator;
pub mod flight;
pub mod inertial;
pub mod low_pass;
pub mod one_vehicle;
pub mod position;
pub mod streams;
pub mod telemetry;
pub mod visibility;

use nalgebra::Vector3;
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};

/// Of a normal distribution.
pub fn drawn(sigma: f64, dice: &mut impl Rng) -> f64 {
    let drawn: f64 = StandardNormal.sample(dice);
    sigma * drawn
}

/// Three of a normal distribution.
pub fn drawn_three(sigma: f64, dice: &mut impl Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| drawn(sigma, dice))
}

/// Between two numbers, even in the logarithm.
pub fn spread(low: f64, high: f64, dice: &mut impl Rng) -> f64 {
    low * (high / low).powf(dice.random_range(0.0..1.0))
}
