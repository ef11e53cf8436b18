//! The residual over frequency: the band in which it exceeds noise, and its coherence with states.

use super::super::channels::AXES;
use super::super::followed::Followed;
use super::super::trace::Trace;
use super::spectrum::{Ordinate, noise_shapes};
use super::view::View;
use crate::stats::{coherence, coherence_of_noise, hann_windowed, transform};
use rayon::prelude::*;

/// Frequencies between which most of a channel's misfit lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// frequency below which a tenth of the energy above noise lies, Hz
    pub low_hz: f64,
    /// frequency above which a tenth lies, Hz
    pub high_hz: f64,
    /// share of this energy at the trajectory's harmonics, if the flight is periodic (0..1)
    pub harmonic: Option<f64>,
}

/// Linear dependence of a channel's residual on a state, by frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coherence {
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// the state
    pub with: Followed,
    /// mean of the squared coherence to 2 Hz, weighted by the residual's power (0..1)
    pub mean: f64,
    /// 95 % quantile of the squared coherence of noise at a single frequency
    pub noise: f64,
    /// Hz, where residual power times coherence is greatest
    pub frequency_hz: f64,
}

/// Length of a window, s. It resolves an eighth of a hertz; only what is shown depends on it.
const WINDOW_S: f64 = 8.0;
/// Highest frequency of the mean, Hz. Only what is shown depends on it. The highest of the harmonics' test is one of its own:
/// a decision depends on that.
const HIGHEST_HZ: f64 = 2.0;
/// Least number of windows for a coherence. Of fewer a coherence is near one by chance.
const LEAST_WINDOWS: usize = 5;

/// The band of one channel; `None` if nothing exceeds noise.
pub(super) fn band(view: &View, ordinates: &[Ordinate], noise_variance: f64) -> Option<Band> {
    let [force, _] = noise_shapes(view, ordinates);
    let total: f64 = force.iter().sum();
    let count = ordinates.len() as f64;
    // the same variance as white noise of the force would have it
    let share = 2.0 * super::spectrum::HIGHEST_HZ * view.step_s;
    let scale = noise_variance / share * count / total.max(f64::MIN_POSITIVE);
    let beyond: Vec<f64> =
        ordinates.iter().zip(&force).map(|(o, shape)| (o.power - 3.0 * scale * shape).max(0.0)).collect();
    let energy: f64 = beyond.iter().sum();
    if energy <= 0.0 {
        return None;
    }
    let mut order: Vec<usize> = (0..ordinates.len()).collect();
    order.sort_by(|&a, &b| ordinates[a].frequency_hz.total_cmp(&ordinates[b].frequency_hz));
    let at = |level: f64| {
        let mut sum = 0.0;
        order
            .iter()
            .find(|&&i| {
                sum += beyond[i];
                sum >= level * energy
            })
            .map_or(0.0, |&i| ordinates[i].frequency_hz)
    };
    let repeats = view.flights.iter().any(|(_, period_s)| period_s.is_some());
    let harmonic: f64 = ordinates.iter().zip(&beyond).filter(|(o, _)| o.harmonic).map(|(_, b)| b).sum();
    Some(Band { low_hz: at(0.1), high_hz: at(0.9), harmonic: repeats.then_some(harmonic / energy) })
}

/// Coherence of every channel with thrust, its rate, airspeed and body rates by Welch's method.
pub(super) fn coherences(view: &View, traces: &[Trace]) -> Vec<Coherence> {
    let inputs: Vec<&(Followed, Vec<f64>)> = view
        .states
        .iter()
        .filter(|(state, _)| {
            matches!(
                state,
                Followed::Thrust | Followed::ThrustRate | Followed::Airspeed(_) | Followed::Rate(_)
            )
        })
        .collect();
    let length = (0..view.len()).find(|&rows| rows as f64 * view.step_s >= WINDOW_S);
    let Some(length) = length.filter(|_| !traces.is_empty()) else { return Vec::new() };
    let windows = windows(view, length);
    if windows.len() < LEAST_WINDOWS {
        return Vec::new();
    }
    let noise = coherence_of_noise(windows.len());
    let spectra = |series: &[f64]| -> Vec<Vec<_>> {
        let windowed = windows.iter().map(|&from| hann_windowed(&series[from..from + length]));
        windowed.map(|window| transform(&window, view.step_s, HIGHEST_HZ)).collect()
    };
    let of_inputs: Vec<_> = inputs.par_iter().map(|(_, values)| spectra(values)).collect();
    let of_channels: Vec<_> =
        (0..AXES).into_par_iter().map(|channel| spectra(&view.residual[channel])).collect();
    let mut out = Vec::new();
    for (channel, residual) in of_channels.iter().enumerate() {
        for ((state, _), input) in inputs.iter().zip(&of_inputs) {
            let found = coherence(residual, input);
            let (mean, frequency_hz) = (found.mean, found.frequency_hz);
            out.push(Coherence { channel, with: *state, mean, noise, frequency_hz });
        }
    }
    out.sort_by(|a, b| b.mean.total_cmp(&a.mean));
    out
}

/// First rows of half-overlapping windows.
fn windows(view: &View, length: usize) -> Vec<usize> {
    let mut out = Vec::new();
    for run in &view.runs {
        let mut from = run.start;
        while from + length <= run.end {
            out.push(from);
            from += length / 2;
        }
    }
    out
}
