//! Noise of the measured state, from the recording itself.

use crate::compare::{CommandNoise, StateNoise};
use crate::physics::MAX_ROTORS;
use crate::recording::{Quantity, Stream};
use crate::signals::{Series, Signals, ThrustSource, white_level};
use crate::stats::median;
use crate::vehicle::Propulsion;
use nalgebra::{SMatrix, SVector, Vector3};

/// White noise of each part of the state; zero if it is not recorded. Estimates of real autopilots are smoother than
/// white noise, so the result is a lower bound for them.
#[must_use]
pub fn state_noise(signals: &Signals) -> StateNoise {
    let vectors = |series: &Option<Series<Vector3<f64>>>, quantity: Quantity| {
        series.as_ref().map_or(0.0, |series| {
            let flat: Vec<f64> = series.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
            rms(&levels(signals, flat, 3, quantity))
        })
    };
    let attitude_rad = signals.attitude.as_ref().map_or(0.0, |series| {
        let flat: Vec<f64> = series.iter().flat_map(|q| [q.w, q.i, q.j, q.k]).collect();
        // three small angles spread over four components, each half as large
        2.0 * rms(&levels(signals, flat, 4, Quantity::Attitude)) * (4.0_f64 / 3.0).sqrt()
    });
    StateNoise {
        position_m: vectors(&signals.position, Quantity::Position),
        velocity_m_s: vectors(&signals.velocity, Quantity::Velocity),
        attitude_rad,
        rates_rad_s: vectors(&signals.rate, Quantity::AngularRate),
    }
}

/// Share of the variance of the logged commands' jitter that the rotors do not follow. A loop twice as fast as the log
/// gives one half; slower logs give more, up to one.
const OTHERWISE: f64 = 0.5;
/// Fourth differences beyond this many medians are manoeuvres or gaps. White noise does not reach it.
const OUTLIER: f64 = 6.0;

/// Jitter of logged commands, by the covariance of their fourth differences over the rotors. `None` if rotor speeds
/// were measured, or if there is too little data. It has the scale of the propulsion.
#[must_use]
pub fn command_noise(signals: &Signals, propulsion: &Propulsion) -> Option<CommandNoise> {
    if signals.quality.thrust_source != ThrustSource::Command || signals.rotor_thrust_n.is_empty() {
        return None;
    }
    let rotors = signals.rotor_thrust_n.len() / signals.grid.count.max(1);
    let every = signals.samples_apart(Quantity::ActuatorCommand);
    let factor = signals.thrust_factor(propulsion);
    let at = |index: usize, rotor: usize| factor * signals.rotor_thrust_n[index * rotors + rotor];
    let differences: Vec<SVector<f64, MAX_ROTORS>> = (4 * every..signals.grid.count)
        .step_by(every)
        .filter(|&index| signals.usable[index - 4 * every..=index].iter().all(|usable| *usable))
        .map(|index| {
            let back = |n: usize, rotor: usize| at(index - n * every, rotor);
            SVector::from_fn(|rotor, _| {
                if rotor >= rotors {
                    return 0.0;
                }
                back(0, rotor) - 4.0 * back(1, rotor) + 6.0 * back(2, rotor) - 4.0 * back(3, rotor)
                    + back(4, rotor)
            })
        })
        .collect();
    let mut sizes: Vec<f64> = differences.iter().map(SVector::norm).collect();
    let most = OUTLIER * median(&mut sizes);
    let kept: Vec<&SVector<f64, MAX_ROTORS>> =
        differences.iter().filter(|difference| difference.norm() <= most).collect();
    if kept.len() < 50 {
        return None;
    }
    let mut covariance = SMatrix::<f64, MAX_ROTORS, MAX_ROTORS>::zeros();
    for difference in &kept {
        covariance += *difference * difference.transpose();
    }
    // white noise enlarges a fourth difference's variance by 70
    covariance *= OTHERWISE / (70.0 * kept.len() as f64);
    let least = 1e-9 * covariance.trace().max(f64::MIN_POSITIVE);
    let factor_n = (covariance + SMatrix::identity() * least).cholesky()?.l();
    Some(CommandNoise { factor_n, period_s: signals.grid.step_s * every as f64 })
}

/// Noise level at the rate of the stream's samples, because the grid is interpolated between them.
fn levels(signals: &Signals, flat: Vec<f64>, width: usize, quantity: Quantity) -> Vec<f64> {
    let every = signals.samples_apart(quantity);
    let mut stream = Stream { time_s: Vec::new(), width, values: Vec::new() };
    for (index, sample) in flat.chunks_exact(width).enumerate().step_by(every) {
        if signals.usable[index] {
            stream.time_s.push(signals.grid.time_s(index));
            stream.values.extend_from_slice(sample);
        }
    }
    white_level(&stream)
}

fn rms(levels: &[f64]) -> f64 {
    let count = levels.len().max(1) as f64;
    (levels.iter().map(|level| level * level).sum::<f64>() / count).sqrt()
}
