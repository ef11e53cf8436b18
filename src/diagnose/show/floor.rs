//! Noise of the measured state, from the recording itself.

use crate::compare::StateNoise;
use crate::log::{Quantity, Stream};
use crate::signals::{Signals, white_level};
use nalgebra::Vector3;

/// White noise of each part of the state; zero where it is not recorded. Real autopilots' estimates are
/// smoother than white noise, so what comes of this is a lower bound there.
#[must_use]
pub fn state_noise(signals: &Signals) -> StateNoise {
    let vectors = |series: &Option<Vec<Vector3<f64>>>, quantity: Quantity| {
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

/// Of every so many instants as the stream had samples: between its samples the grid is interpolated.
fn levels(signals: &Signals, flat: Vec<f64>, width: usize, quantity: Quantity) -> Vec<f64> {
    let rate_hz = signals.quality.sources.iter().find(|(q, ..)| *q == quantity).map(|(.., rate)| *rate);
    let period_s = rate_hz.filter(|rate| *rate > 0.0).map_or(signals.grid.step_s, |rate| 1.0 / rate);
    let every = (1..1000)
        .find(|n| f64::from(*n) * signals.grid.step_s > 0.75 * period_s)
        .and_then(|n| usize::try_from(n).ok())
        .unwrap_or(1);
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
