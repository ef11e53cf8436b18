//! Highest frequency of a trajectory.

use super::Signals;
use crate::stats::hann_power;
use nalgebra::Vector3;

/// Highest frequency of the search, Hz. The weak form passes little of faster motion.
const HIGHEST_HZ: f64 = 5.0;
/// Share of the power below the result. The rest is the tail of noise.
const SHARE: f64 = 0.98;

/// Least rms of a commanded acceleration that tells a trajectory, m/s^2. Setpoints of positions alone carry zeros in
/// its place. Less than any motion that a person would call one.
const LEAST_COMMANDED_M_S2: f64 = 0.02;

/// The trajectory's highest harmonic, Hz: 98 % of the power of the commanded acceleration is below it, or of the
/// measured velocity if no acceleration was commanded. `None` without both.
#[must_use]
pub fn highest_harmonic_hz(signals: &Signals) -> Option<f64> {
    // positions that are held from one command to the next have steps
    let commanded = signals.reference.as_ref().filter(|reference| !reference.is_of_positions);
    let commanded = commanded.map(|reference| -> &[Vector3<f64>] { &reference.acceleration });
    let commanded = commanded.filter(|series| rms(series, &signals.usable) >= LEAST_COMMANDED_M_S2);
    let series: &[Vector3<f64>] = match (commanded, &signals.velocity) {
        (Some(acceleration), _) => acceleration,
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
    let power = hann_power(&used, block as f64 * signals.grid.step_s, HIGHEST_HZ);
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

/// Root mean square over the usable instants; 0 without one.
fn rms(series: &[Vector3<f64>], usable: &[bool]) -> f64 {
    let used = series.iter().zip(usable).filter(|(_, usable)| **usable);
    let (count, sum) =
        used.fold((0.0, 0.0), |(count, sum), (value, _)| (count + 1.0, sum + value.norm_squared()));
    if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
}
