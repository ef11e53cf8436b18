//! How fast a trajectory moves.

use super::Signals;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Highest frequency that is looked at, Hz.
const HIGHEST_HZ: f64 = 5.0;
/// Share of the power that must lie below the result.
const SHARE: f64 = 0.98;

/// The trajectory's highest harmonic, Hz: 98 % of the power of the commanded acceleration lies below
/// it; where no command was recorded, of the measured velocity. `None` where neither is there.
#[must_use]
pub fn highest_harmonic_hz(signals: &Signals) -> Option<f64> {
    let series: &[Vector3<f64>] = match (&signals.reference, &signals.velocity) {
        (Some(reference), _) => &reference.acceleration,
        (None, Some(velocity)) => velocity,
        (None, None) => return None,
    };
    // block means at about 25 Hz: enough below 5 Hz, and cheap
    let mut block = 1;
    while (block as f64 + 0.5) * signals.grid.step_s < 0.04 {
        block += 1;
    }
    let used: Vec<Vector3<f64>> = series
        .chunks(block)
        .zip(signals.usable.chunks(block))
        .filter(|(_, mask)| mask.iter().all(|m| *m))
        .map(|(chunk, _)| chunk.iter().sum::<Vector3<f64>>() / chunk.len() as f64)
        .collect();
    if used.len() < 50 {
        return None;
    }
    let mean: Vector3<f64> = used.iter().sum::<Vector3<f64>>() / used.len() as f64;
    let step_s = block as f64 * signals.grid.step_s;
    let span_s = used.len() as f64 * step_s;
    let mut power = Vec::new();
    let mut bin = 1.0;
    while bin / span_s <= HIGHEST_HZ {
        power.push((bin / span_s, windowed_power(&used, &mean, bin)));
        bin += 1.0;
    }
    let total: f64 = power.iter().map(|(_, p)| p).sum();
    let mut below = 0.0;
    power
        .iter()
        .find(|(_, p)| {
            below += p;
            below >= SHARE * total
        })
        .map(|(f, _)| *f)
}

/// Power of the Hann-windowed series, less its mean, at one bin (whole turns over its length).
#[must_use]
pub fn windowed_power(series: &[Vector3<f64>], mean: &Vector3<f64>, bin: f64) -> f64 {
    let n = series.len() as f64;
    let (s1, c1) = (TAU * bin / n).sin_cos();
    let (mut s, mut c) = (0.0, 1.0);
    let (mut real, mut imaginary) = (Vector3::zeros(), Vector3::zeros());
    for (i, value) in series.iter().enumerate() {
        let window = 0.5 - 0.5 * (TAU * i as f64 / n).cos();
        let centred = (value - mean) * window;
        real += centred * c;
        imaginary += centred * s;
        (s, c) = (s * c1 + c * s1, c * c1 - s * s1);
    }
    real.norm_squared() + imaginary.norm_squared()
}
