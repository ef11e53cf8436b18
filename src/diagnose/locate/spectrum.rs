//! Spectra of weak-form residuals, and their shape for white sensor noise.
//!
//! White noise of a measured force has the spectrum of the test function, and white noise of a measured velocity that
//! of its derivative. Power at low frequency above a mix of both is not sensor noise.

use super::view::View;
use crate::signals::WeakKernel;
use crate::stats::{transform, whittle, without_line};
use std::f64::consts::TAU;

/// Highest frequency of the fits, Hz: the kernel passes little above.
pub(super) const HIGHEST_HZ: f64 = 4.0;
/// Scale of the spectrum of velocity noise, s^2. With it, the spectra of force noise and velocity noise are equal at
/// the middle of the band.
pub(super) const VELOCITY_SCALE_S2: f64 = 1.0 / (TAU * 0.5 * HIGHEST_HZ * TAU * 0.5 * HIGHEST_HZ);
/// Shortest stretch that is transformed, s. Shorter ones do not resolve slow variation.
const SHORTEST_S: f64 = 10.0;

/// One ordinate of a periodogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ordinate {
    pub(super) frequency_hz: f64,
    /// white noise of variance v has v on average
    pub(super) power: f64,
    /// whether it is at a multiple of the trajectory's frequency
    pub(super) harmonic: bool,
}

/// Periodogram of a series of the view's rows, all runs together, each without its linear trend. A run of a periodic
/// flight is cut to whole periods.
pub(super) fn periodogram(view: &View, series: &[f64]) -> Vec<Ordinate> {
    let mut out = Vec::new();
    for run in &view.runs {
        let period_s = view.period_s_at(run.start);
        let run_s = run.len() as f64 * view.step_s;
        if run_s < SHORTEST_S {
            continue;
        }
        let whole_s = period_s.map_or(run_s, |period_s| {
            let mut whole_s = period_s;
            while whole_s + period_s <= run_s + 1e-6 {
                whole_s += period_s;
            }
            whole_s.min(run_s)
        });
        let mut from = run.start;
        while (run.end - from) as f64 * view.step_s > whole_s + 0.5 * view.step_s {
            from += 1;
        }
        let values = without_line(&series[from..run.end]);
        let count = values.len() as f64;
        let length_s = count * view.step_s;
        out.extend(transform(&values, view.step_s, HIGHEST_HZ).into_iter().map(|(frequency_hz, value)| {
            let harmonic = period_s.is_some_and(|period_s| {
                let turns = frequency_hz * period_s;
                turns > 0.5 && (turns - turns.round()).abs() < 0.6 * period_s / length_s
            });
            Ordinate { frequency_hz, power: value.norm_sqr() / count, harmonic }
        }));
    }
    out
}

/// Power gain of the kernel of this order at a frequency, 1 for order 0 at zero.
pub(super) fn kernel_power(
    kernel: &WeakKernel,
    (order, grid_step_s): (usize, f64),
    frequency_hz: f64,
) -> f64 {
    let half = kernel.half_count;
    let (mut re, mut im) = (0.0, 0.0);
    // the answer to a wave is the wave times the kernel's transform
    let waves: [Vec<f64>; 2] = [0.0, 0.25].map(|shift: f64| {
        (0..=2 * half)
            .map(|i| (TAU * (frequency_hz * (i as f64 - half as f64) * grid_step_s - shift)).cos())
            .collect()
    });
    re += kernel.at(order, &waves[0], half);
    im += kernel.at(order, &waves[1], half);
    re * re + im * im
}

/// Variance that white sensor noise gives a channel: the kernels' shapes fitted between 1.5 and 4 Hz, where
/// hardly any physics is, and continued to all frequencies.
pub(super) fn noise_variance(view: &View, ordinates: &[Ordinate]) -> Option<f64> {
    const FROM_HZ: f64 = 1.5;
    let high: Vec<Ordinate> =
        ordinates.iter().filter(|o| o.frequency_hz >= FROM_HZ && !o.harmonic).copied().collect();
    let power: Vec<f64> = high.iter().map(|o| o.power).collect();
    let [force, velocity] = noise_shapes(view, &high);
    let fit = whittle(&power, &[&force, &velocity])?;
    let [force, velocity] = noise_shapes(view, ordinates);
    let runs = ordinates.len() as f64;
    // both sides of the spectrum over its whole width, 1 / step
    let share = 2.0 * HIGHEST_HZ * view.step_s;
    let mean = (0..ordinates.len())
        .map(|i| fit.coefficients[0] * force[i] + fit.coefficients[1] * velocity[i])
        .sum::<f64>()
        / runs.max(1.0);
    Some(mean * share)
}

/// Spectra of white noise of force and of velocity at the ordinates.
pub(super) fn noise_shapes(view: &View, ordinates: &[Ordinate]) -> [Vec<f64>; 2] {
    [(0, 1.0), (1, VELOCITY_SCALE_S2)].map(|(order, scale)| {
        ordinates
            .iter()
            .map(|o| scale * kernel_power(&view.kernel, (order, view.grid_step_s), o.frequency_hz))
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::{synthetic, white};
    use super::*;
    use crate::diagnose::followed::Followed;

    #[test]
    fn the_noise_is_told_from_what_is_slow() {
        let noise = white(1);
        let plain = synthetic(|i, _| noise[i], Some(10.0), (Followed::WorldX, &f64::sin));
        let slow =
            synthetic(|i, t| noise[i] + 3.0 * (0.4 * t).sin(), Some(10.0), (Followed::WorldX, &f64::sin));
        let expected = plain.kernel.noise_covariance(0, 0);
        for view in [&plain, &slow] {
            let found = noise_variance(view, &periodogram(view, &view.residual[2])).unwrap();
            assert!((found / expected - 1.0).abs() < 0.25, "{found} {expected}");
        }
    }
}
