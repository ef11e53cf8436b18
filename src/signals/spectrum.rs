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
    let windowed = hann_windowed(&used);
    let step_s = block as f64 * signals.grid.step_s;
    let span_s = used.len() as f64 * step_s;
    let mut power = Vec::new();
    let mut bin = 1.0;
    while bin / span_s <= HIGHEST_HZ {
        power.push((bin / span_s, power_at(&windowed, bin)));
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

/// A series less its mean under Hann's window.
#[must_use]
pub fn hann_windowed(series: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let n = series.len() as f64;
    let mean = series.iter().sum::<Vector3<f64>>() / n.max(1.0);
    let window = |i: usize| 0.5 - 0.5 * (TAU * i as f64 / n).cos();
    series.iter().enumerate().map(|(i, value)| (value - mean) * window(i)).collect()
}

/// Power of a series, windowed already, at one bin (whole turns over its length).
#[must_use]
pub fn power_at(windowed: &[Vector3<f64>], bin: f64) -> f64 {
    let (s1, c1) = (TAU * bin / windowed.len() as f64).sin_cos();
    let (mut s, mut c) = (0.0, 1.0);
    let (mut real, mut imaginary) = (Vector3::zeros(), Vector3::zeros());
    for value in windowed {
        real += value * c;
        imaginary += value * s;
        (s, c) = (s * c1 + c * s1, c * c1 - s * s1);
    }
    real.norm_squared() + imaginary.norm_squared()
}
