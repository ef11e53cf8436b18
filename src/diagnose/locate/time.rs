//! The residual in time: sudden changes of its mean, slope or gain on thrust, drift, and where it exceeds noise.

use super::super::channels::AXES;
use super::view::View;
use crate::diagnose::correlation::OVERLAP;
use crate::stats::normal_sigma;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// What changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChangeKind {
    /// the mean: N or N m
    Mean,
    /// the slope from then on: N/s or N m/s
    Slope,
    /// the gain on thrust: N/N or m
    Gain,
}

/// One change point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// number of the flight
    pub flight: usize,
    /// s, vehicle clock
    pub time_s: f64,
    /// what
    pub kind: ChangeKind,
    /// size of the change, in the kind's unit
    pub size: f64,
    /// energy that it explains, in units of the long-run variance
    pub statistic: f64,
}

/// Drift of one channel over a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// number of the flight
    pub flight: usize,
    /// N/s or N m/s
    pub per_s: f64,
    /// standard error
    pub std_per_s: f64,
}

/// A stretch in which a channel's residual is larger than noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// number of the flight
    pub flight: usize,
    /// s, vehicle clock
    pub from_s: f64,
    /// s, vehicle clock
    pub to_s: f64,
    /// root mean square in units of the noise's
    pub rms: f64,
}

/// Distance of the differences from which the long-run variance is computed, in means (2 s). It is longer than the
/// residual is correlated.
const APART: usize = 5;
/// Penalty of a change, times the logarithm of the number of means, in long-run variances. Only what is shown depends
/// on it.
const PENALTY: f64 = 6.0;
/// Largest number of changes of one channel of one flight. Only what is shown depends on it.
const MOST: usize = 4;
/// Least number of means on each side of a change (2 s). Only what is shown depends on it.
const SIDE: usize = 5;
/// Window of a span, in means (2 s). Only what is shown depends on it.
const WINDOW: usize = 5;

/// One mean of neighbouring rows.
#[derive(Debug, Clone, Copy)]
struct Mean {
    time_s: f64,
    value: f64,
    square: f64,
    thrust_n: f64,
}

/// Changes and drift of all channels.
pub(super) fn changes(view: &View) -> (Vec<Change>, Vec<Drift>) {
    let (mut out, mut drifts) = (Vec::new(), Vec::new());
    for channel in 0..AXES {
        for (flight, (rows, period_s)) in view.flights.iter().enumerate() {
            let means = means(view, channel, rows);
            let means = period_s.map_or_else(|| means.clone(), |period_s| folded(&means, period_s));
            let Some(long_run) = long_run_variance(&means) else { continue };
            let mut found = Vec::new();
            segment(&means, long_run, &mut found);
            out.extend(found.into_iter().map(|(time_s, kind, size, statistic)| Change {
                channel,
                flight,
                time_s,
                kind,
                size,
                statistic,
            }));
            if let Some((per_s, std_per_s)) = slope(&means, long_run) {
                drifts.push(Drift { channel, flight, per_s, std_per_s });
            }
        }
    }
    out.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    (out, drifts)
}

/// Where each channel exceeds its noise (N or N m).
pub(super) fn spans(view: &View, noise: &[f64; AXES]) -> Vec<Span> {
    let mut out: Vec<Span> = Vec::new();
    // nearly independent values in a window, whose mean square scatters so
    let most = 1.0 + 4.0 * (2.0 / (2 * WINDOW) as f64).sqrt();
    for (channel, noise) in noise.iter().enumerate().filter(|(_, noise)| **noise > 0.0) {
        for (flight, (rows, _)) in view.flights.iter().enumerate() {
            let means = means(view, channel, rows);
            let mut open: Option<Span> = None;
            for window in means.windows(WINDOW) {
                let square =
                    window.iter().map(|mean| mean.square).sum::<f64>() / (WINDOW as f64 * noise * noise);
                let (from_s, to_s) = (window[0].time_s, window[WINDOW - 1].time_s);
                if square <= most {
                    continue;
                }
                match &mut open {
                    Some(span) if from_s <= span.to_s => {
                        span.to_s = to_s;
                        span.rms = span.rms.max(square.sqrt());
                    }
                    _ => {
                        out.extend(open.take());
                        open = Some(Span { channel, flight, from_s, to_s, rms: square.sqrt() });
                    }
                }
            }
            out.extend(open);
        }
    }
    out
}

fn means(view: &View, channel: usize, rows: &Range<usize>) -> Vec<Mean> {
    let values = &view.residual[channel];
    let mut out = Vec::new();
    for run in view.runs.iter().filter(|run| rows.contains(&run.start)) {
        let mut from = run.start;
        while from + OVERLAP <= run.end {
            let piece = from..from + OVERLAP;
            let mean = |series: &[f64]| series[piece.clone()].iter().sum::<f64>() / OVERLAP as f64;
            out.push(Mean {
                time_s: mean(&view.time_s),
                value: mean(values),
                square: values[piece.clone()].iter().map(|v| v * v).sum::<f64>() / OVERLAP as f64,
                thrust_n: if view.thrust_n.is_empty() { 0.0 } else { mean(&view.thrust_n) },
            });
            from += OVERLAP;
        }
    }
    out
}

/// Means without the part that repeats in every period, so that only changes with time remain. Only whole periods are
/// used.
fn folded(means: &[Mean], period_s: f64) -> Vec<Mean> {
    let (Some(first), Some(last)) = (means.first(), means.last()) else { return Vec::new() };
    let mut from_s = last.time_s;
    while from_s - period_s >= first.time_s - 1e-6 {
        from_s -= period_s;
    }
    let used: Vec<Mean> = means.iter().filter(|mean| mean.time_s > from_s).copied().collect();
    let phase = |mean: &Mean| (mean.time_s - from_s).rem_euclid(period_s);
    used.iter()
        .map(|mean| {
            let here = phase(mean);
            let same: Vec<f64> = used
                .iter()
                .filter(|other| {
                    let apart = (phase(other) - here).abs();
                    apart.min(period_s - apart) < 0.25
                })
                .map(|other| other.value)
                .collect();
            let repeated = same.iter().sum::<f64>() / same.len().max(1) as f64;
            Mean { value: mean.value - repeated, ..*mean }
        })
        .collect()
}

/// Long-run variance by differences over two seconds, which a sudden change does not enlarge.
fn long_run_variance(means: &[Mean]) -> Option<f64> {
    let mut apart: Vec<f64> =
        means.iter().zip(means.get(APART..)?).map(|(a, b)| (b.value - a.value).abs()).collect();
    if apart.len() < 4 * SIDE {
        return None;
    }
    let deviation = normal_sigma(&mut apart);
    Some(0.5 * deviation * deviation).filter(|variance| *variance > 0.0)
}

/// Binary segmentation.
fn segment(means: &[Mean], long_run: f64, out: &mut Vec<(f64, ChangeKind, f64, f64)>) {
    if means.len() < 2 * SIDE || out.len() >= MOST {
        return;
    }
    let penalty = PENALTY * (means.len() as f64).ln().max(4.0);
    let best = (SIDE..means.len() - SIDE)
        .flat_map(|at| {
            [ChangeKind::Mean, ChangeKind::Slope, ChangeKind::Gain].into_iter().filter_map(move |kind| {
                explained(means, at, kind).map(|(size, energy)| (at, kind, size, energy))
            })
        })
        .max_by(|a, b| a.3.total_cmp(&b.3));
    let Some((at, kind, size, energy)) = best else { return };
    if energy < penalty * long_run {
        return;
    }
    out.push((0.5 * (means[at - 1].time_s + means[at].time_s), kind, size, energy / long_run));
    segment(&means[..at], long_run, out);
    segment(&means[at..], long_run, out);
}

/// Size of a change before mean `at`, and the energy that it explains.
fn explained(means: &[Mean], at: usize, kind: ChangeKind) -> Option<(f64, f64)> {
    let thrust_n = means.iter().map(|mean| mean.thrust_n).sum::<f64>() / means.len() as f64;
    let start_s = means[at].time_s;
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for (index, mean) in means.iter().enumerate() {
        let since = index >= at;
        let gain = mean.thrust_n - thrust_n;
        let column = match kind {
            ChangeKind::Mean => f64::from(u8::from(since)),
            ChangeKind::Slope => (mean.time_s - start_s).max(0.0),
            ChangeKind::Gain if since => gain,
            ChangeKind::Gain => 0.0,
        };
        let base = if kind == ChangeKind::Gain { gain } else { 0.0 };
        let row = Vector3::new(column, 1.0, base);
        normal += row * row.transpose();
        right += row * mean.value;
    }
    if kind != ChangeKind::Gain {
        normal[(2, 2)] = 1.0;
    }
    let inverse = normal.try_inverse()?;
    let size = (inverse * right)[0];
    Some((size, size * size / inverse[(0, 0)]))
        .filter(|(size, energy)| size.is_finite() && energy.is_finite() && inverse[(0, 0)] > 0.0)
}

fn slope(means: &[Mean], long_run: f64) -> Option<(f64, f64)> {
    let count = means.len() as f64;
    let middle_s = means.iter().map(|mean| mean.time_s).sum::<f64>() / count.max(1.0);
    let (mut up, mut down) = (0.0, 0.0);
    for mean in means {
        up += (mean.time_s - middle_s) * mean.value;
        down += (mean.time_s - middle_s).powi(2);
    }
    (down > 0.0).then(|| (up / down, (long_run / down).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::{synthetic, white};
    use super::*;
    use crate::diagnose::followed::Followed;

    #[test]
    fn a_step_is_found_beside_what_repeats() {
        let noise = white(3);
        let force = |i: usize, t: f64| {
            noise[i] + (0.2 * std::f64::consts::PI * t).sin() + if t > 23.0 { 0.5 } else { 0.0 }
        };
        let view = synthetic(force, Some(10.0), (Followed::WorldX, &f64::sin));
        let (found, _) = changes(&view);
        let first = found.iter().find(|change| change.channel == 2).unwrap();
        assert_eq!(first.kind, ChangeKind::Mean);
        assert!((first.time_s - 23.0).abs() < 1.5 && (first.size - 0.5).abs() < 0.2, "{first:?}");
    }

    #[test]
    fn noise_does_not_change_and_a_drift_has_its_size() {
        let mut found = 0;
        for seed in 0..20 {
            let noise = white(seed);
            let view = synthetic(|i, t| noise[i] + 0.002 * t, None, (Followed::WorldX, &f64::sin));
            let (changes, drifts) = changes(&view);
            found += changes.len();
            let drift = drifts.iter().find(|drift| drift.channel == 2).unwrap();
            assert!((drift.per_s - 0.002).abs() < 4.5 * drift.std_per_s, "{drift:?}");
        }
        assert!(found <= 1, "{found}");
    }

    #[test]
    fn a_push_of_some_seconds_is_a_span() {
        let noise = white(4);
        let push = |t: f64| if (20.0..26.0).contains(&t) { 2.0 } else { 0.0 };
        let view = synthetic(|i, t| noise[i] + push(t), None, (Followed::WorldX, &f64::sin));
        let mut sigma = [0.0; AXES];
        sigma[2] = view.kernel.noise_covariance(0, 0).sqrt();
        let spans = spans(&view, &sigma);
        let [span] = spans.as_slice() else { panic!("{spans:?}") };
        assert!((span.from_s - 20.0).abs() < 2.5 && (span.to_s - 26.0).abs() < 2.5, "{span:?}");
    }
}
