//! How the force goes with the commanded thrust, where both have noise.
//!
//! Commands that answer noise move no vehicle for long, and least squares then finds a slope that is too small: that looks like a bent
//! thrust curve. Regression the other way round finds one that is too great. The true slope lies between them (Frisch 1934).

use super::fit::Fitted;
use super::trace::Trace;
use crate::physics::Airframe;

/// Whether the noise of commands and accelerometer alone may have bent the thrust curve: the slope of the stated law lies between those
/// of both regressions.
pub(super) fn may_be_noise(flights: &[Trace], fitted: &Fitted) -> bool {
    let Ok(airframe) = Airframe::new(&fitted.base.vehicle) else { return false };
    let mass_kg = fitted.base.vehicle.body.mass_kg;
    let (mut commanded, mut measured, mut both) = (0.0, 0.0, 0.0);
    for trace in flights {
        let thrust = trace.felt_n(&airframe, fitted.base.latency);
        let thrust: Vec<f64> = thrust.each().map(|rotors| rotors.iter().sum()).collect();
        let Some(force) = trace.weak_specific_force().first() else { return false };
        let (x, y) = (about_mean(trace.weak(0, &thrust)), about_mean(force[2].clone()));
        for (x, y) in x.iter().zip(&y) {
            let y = mass_kg * y;
            commanded += x * x;
            measured += y * y;
            both += x * y;
        }
    }
    both > 0.0 && lies_between(1.0, both / commanded, measured / both)
}

fn lies_between(value: f64, one: f64, other: f64) -> bool {
    (one.min(other)..=one.max(other)).contains(&value)
}

fn about_mean(mut values: Vec<f64>) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter_mut().for_each(|value| *value -= mean);
    values
}
