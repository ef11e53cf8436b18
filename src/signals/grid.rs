//! Uniform time grids and interpolation of recorded streams onto them.

use crate::recording::Stream;
use crate::stats::median_step;

/// Uniformly spaced instants on the vehicle's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// s, first instant
    pub start_s: f64,
    /// s between instants
    pub step_s: f64,
    /// number of instants
    pub count: usize,
}

impl Grid {
    /// Instants that a flight has at most: an hour at 500 Hz and more. A grid of more is of a recording that was not divided
    /// into its flights.
    pub const LONGEST: usize = 1 << 21;

    /// Covers `start_s..=end_s` with the given step; at most some [`Self::LONGEST`] instants of it.
    #[must_use]
    pub fn covering(start_s: f64, end_s: f64, step_s: f64) -> Self {
        let is_inside = |index: usize| start_s + step_s * index as f64 <= end_s + 1e-9;
        let (mut inside, mut beyond) = (0, 1);
        while beyond < Self::LONGEST && is_inside(beyond) {
            (inside, beyond) = (beyond, 2 * beyond);
        }
        while inside + 1 < beyond {
            let middle = usize::midpoint(inside, beyond);
            if is_inside(middle) { inside = middle } else { beyond = middle }
        }
        Self { start_s, step_s, count: if is_inside(0) { beyond } else { 0 } }
    }

    /// The instant of this index, s.
    #[must_use]
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + self.step_s * index as f64
    }

    /// Runs of consecutive true entries of at least `least` instants, as index ranges.
    #[must_use]
    pub fn runs(mask: &[bool], least: usize) -> Vec<std::ops::Range<usize>> {
        let mut runs = Vec::new();
        let mut start = None;
        for (index, &good) in mask.iter().chain(std::iter::once(&false)).enumerate() {
            match (good, start) {
                (true, None) => start = Some(index),
                (false, Some(first)) => {
                    if index - first >= least {
                        runs.push(first..index);
                    }
                    start = None;
                }
                _ => {}
            }
        }
        runs
    }
}

/// Values beyond this are damage and count as missing, in SI units: no signal of a flying vehicle reaches it.
pub const LARGEST_VALUE: f64 = 1e5;

/// A stream with less than this share of the grid's step between its samples is averaged over a step: samples alone
/// would fold its vibration into the band that is used.
const AVERAGED: f64 = 0.75;

/// Natural cubic spline through a stream's samples, evaluated at the grid's instants plus `shift_s`. Where the stream is
/// faster than the grid, the mean over one step around each instant instead.
///
/// Returns `width` values an instant, one after the other. Outside the samples the nearest value is
/// held; samples with a missing or absurd value are passed over. `None` with fewer than four whole samples.
#[must_use]
pub fn cubic_onto(stream: &Stream, shift_s: f64, grid: &Grid) -> Option<Vec<f64>> {
    let whole: Vec<usize> =
        (0..stream.len()).filter(|&i| stream.sample(i).iter().all(|v| v.abs() < LARGEST_VALUE)).collect();
    if whole.len() < 4 {
        return None;
    }
    let time: Vec<f64> = whole.iter().map(|&i| stream.time_s[i]).collect();
    let width = stream.width;
    let mut out = vec![0.0; grid.count * width];
    let fast = is_fast(&time, grid);
    let brackets = if fast { Vec::new() } else { brackets(&time, shift_s, grid) };
    let mut values = vec![0.0; time.len()];
    for channel in 0..width {
        for (value, &index) in values.iter_mut().zip(&whole) {
            *value = stream.sample(index)[channel];
        }
        if fast {
            let means = means_over_steps(&time, &values, shift_s, grid);
            means.enumerate().for_each(|(instant, mean)| out[instant * width + channel] = mean);
            continue;
        }
        let curvature = natural_spline_curvature(&time, &values);
        for (instant, bracket) in brackets.iter().enumerate() {
            out[instant * width + channel] = on_spline(&time, (&values, &curvature), *bracket);
        }
    }
    Some(out)
}

/// Natural cubic spline through a stream's samples, at these times in rising order. See [`cubic_onto`] for the layout; `None` with fewer
/// than four samples.
pub(super) fn cubic_at(stream: &Stream, times_s: &[f64]) -> Option<Vec<f64>> {
    if stream.len() < 4 {
        return None;
    }
    let (time_s, width) = (&stream.time_s, stream.width);
    let brackets = brackets_at(time_s, times_s.iter().copied());
    let mut out = vec![0.0; times_s.len() * width];
    for channel in 0..width {
        let values: Vec<f64> = stream.values.iter().skip(channel).step_by(width).copied().collect();
        let curvature = natural_spline_curvature(time_s, &values);
        for (index, bracket) in brackets.iter().enumerate() {
            out[index * width + channel] = on_spline(time_s, (&values, &curvature), *bracket);
        }
    }
    Some(out)
}

/// A natural cubic spline's value between two knots.
fn on_spline(time_s: &[f64], (values, curvature): (&[f64], &[f64]), (left, share): (usize, f64)) -> f64 {
    let h = time_s[left + 1] - time_s[left];
    let (a, b) = (1.0 - share, share);
    a * values[left]
        + b * values[left + 1]
        + ((a * a * a - a) * curvature[left] + (b * b * b - b) * curvature[left + 1]) * h * h / 6.0
}

/// Linear interpolation between samples; the mean over a step where the stream is faster than the grid. See
/// [`cubic_onto`] for the layout.
#[must_use]
pub fn linear_onto(stream: &Stream, shift_s: f64, grid: &Grid) -> Option<Vec<f64>> {
    if stream.len() < 2 {
        return None;
    }
    let width = stream.width;
    if is_fast(&stream.time_s, grid) && stream.values.iter().all(|value| value.abs() < LARGEST_VALUE) {
        let mut out = vec![0.0; grid.count * width];
        for channel in 0..width {
            let values: Vec<f64> = stream.values.iter().skip(channel).step_by(width).copied().collect();
            let means = means_over_steps(&stream.time_s, &values, shift_s, grid);
            means.enumerate().for_each(|(instant, mean)| out[instant * width + channel] = mean);
        }
        return Some(out);
    }
    let mut out = Vec::with_capacity(grid.count * width);
    for (left, s) in brackets(&stream.time_s, shift_s, grid) {
        let (before, after) = (stream.sample(left), stream.sample(left + 1));
        out.extend(before.iter().zip(after).map(|(x, y)| x + s * (y - x)));
    }
    Some(out)
}

/// The last sample at or before each instant, without interpolation (states and modes).
#[must_use]
pub fn hold_onto(stream: &Stream, grid: &Grid) -> Option<Vec<f64>> {
    if stream.is_empty() {
        return None;
    }
    let mut out = Vec::with_capacity(grid.count * stream.width);
    let mut at = 0;
    for index in 0..grid.count {
        let t = grid.time_s(index);
        while at + 1 < stream.len() && stream.time_s[at + 1] <= t {
            at += 1;
        }
        out.extend_from_slice(stream.sample(at));
    }
    Some(out)
}

fn is_fast(time_s: &[f64], grid: &Grid) -> bool {
    median_step(time_s) < AVERAGED * grid.step_s
}

/// Mean of the straight lines between samples over one step around each instant plus `shift_s`; the first and last sample
/// are held outside.
fn means_over_steps(time_s: &[f64], values: &[f64], shift_s: f64, grid: &Grid) -> impl Iterator<Item = f64> {
    let mut integral = Vec::with_capacity(time_s.len());
    let mut sum = 0.0;
    for index in 0..time_s.len() {
        if index > 0 {
            sum += 0.5 * (values[index] + values[index - 1]) * (time_s[index] - time_s[index - 1]).max(0.0);
        }
        integral.push(sum);
    }
    let edges = Grid { start_s: grid.start_s - 0.5 * grid.step_s, count: grid.count + 1, ..*grid };
    let (first_s, last_s) = (time_s[0], time_s[time_s.len() - 1]);
    let until = |(index, (left, share)): (usize, (usize, f64))| {
        let t = edges.time_s(index) + shift_s;
        let h = (time_s[left + 1] - time_s[left]).max(0.0);
        let within = h * share * (values[left] + 0.5 * share * (values[left + 1] - values[left]));
        let held = (t - first_s).min(0.0) * values[0] + (t - last_s).max(0.0) * values[values.len() - 1];
        integral[left] + within + held
    };
    let until: Vec<f64> = brackets(time_s, shift_s, &edges).into_iter().enumerate().map(until).collect();
    let step_s = grid.step_s;
    (0..grid.count).map(move |instant| (until[instant + 1] - until[instant]) / step_s)
}

/// For each instant the index of the sample on its left and the share (0..1) of the way to the next.
fn brackets(time_s: &[f64], shift_s: f64, grid: &Grid) -> Vec<(usize, f64)> {
    brackets_at(time_s, (0..grid.count).map(|index| grid.time_s(index) + shift_s))
}

/// The same for times in rising order.
fn brackets_at(time_s: &[f64], times_s: impl Iterator<Item = f64>) -> Vec<(usize, f64)> {
    let mut left = 0;
    times_s
        .map(|t| {
            while left + 2 < time_s.len() && time_s[left + 1] <= t {
                left += 1;
            }
            let h = time_s[left + 1] - time_s[left];
            let share = if h > 0.0 { ((t - time_s[left]) / h).clamp(0.0, 1.0) } else { 0.0 };
            (left, share)
        })
        .collect()
}

/// Second derivatives at the knots of the natural cubic spline (tridiagonal solve).
fn natural_spline_curvature(time: &[f64], values: &[f64]) -> Vec<f64> {
    let n = time.len();
    let mut curvature = vec![0.0; n];
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let (h0, h1) = ((time[i] - time[i - 1]).max(1e-9), (time[i + 1] - time[i]).max(1e-9));
        let slope_change = (values[i + 1] - values[i]) / h1 - (values[i] - values[i - 1]) / h0;
        let diagonal = 2.0 * (h0 + h1) - h0 * upper[i - 1];
        upper[i] = h1 / diagonal;
        curvature[i] = (6.0 * slope_change - h0 * curvature[i - 1]) / diagonal;
    }
    for i in (1..n - 1).rev() {
        curvature[i] -= upper[i] * curvature[i + 1];
    }
    curvature
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(period_s: f64, count: usize, f: impl Fn(f64) -> f64) -> Stream {
        let time_s: Vec<f64> = (0..count).map(|i| period_s * i as f64).collect();
        let values = time_s.iter().map(|&t| f(t)).collect();
        Stream { time_s, width: 1, values }
    }

    #[test]
    fn what_is_faster_than_the_grid_is_averaged_without_delay() {
        let slow = |t: f64| (2.0 * t).sin();
        let fast = stream(0.001, 3000, |t| slow(t) + (std::f64::consts::TAU * 100.0 * t).cos());
        let grid = Grid { start_s: 0.5, step_s: 0.01, count: 200 };
        for out in [cubic_onto(&fast, 0.02, &grid), linear_onto(&fast, 0.02, &grid)] {
            for (index, value) in out.unwrap().iter().enumerate() {
                assert!((value - slow(grid.time_s(index) + 0.02)).abs() < 1e-4, "{index}");
            }
        }
        let outside = linear_onto(&fast, 0.0, &Grid { start_s: 3.5, step_s: 0.01, count: 1 }).unwrap();
        assert!((outside[0] - fast.values[2999]).abs() < 1e-9);
    }

    #[test]
    fn spline_follows_a_smooth_signal() {
        let s = stream(0.02, 500, |t| (3.0 * t).sin());
        let grid = Grid::covering(1.0, 8.0, 0.003);
        let out = cubic_onto(&s, 0.001, &grid).unwrap();
        for (i, v) in out.iter().enumerate() {
            assert!((v - (3.0 * (grid.time_s(i) + 0.001)).sin()).abs() < 1e-6);
        }
    }

    #[test]
    fn missing_samples_are_bridged() {
        let mut s = stream(0.02, 200, |t| t * t);
        s.values[50] = f64::NAN;
        let out = cubic_onto(&s, 0.0, &Grid { start_s: 1.0, step_s: 0.02, count: 1 }).unwrap();
        assert!((out[0] - 1.0).abs() < 1e-6);
    }

    #[test]
    fn first_order_hold_has_no_delay() {
        let s = stream(0.1, 20, |t| 2.0 * t);
        let out = linear_onto(&s, 0.0, &Grid { start_s: 0.55, step_s: 0.1, count: 3 }).unwrap();
        assert!((out[1] - 1.3).abs() < 1e-12);
    }

    #[test]
    fn a_grid_covers_its_span_and_is_never_endless() {
        let count = |end_s| Grid::covering(2.0, end_s, 0.1).count;
        assert_eq!([count(1.9), count(2.0), count(2.05), count(2.1), count(3.0)], [0, 1, 1, 2, 11]);
        for steps in 0..300 {
            assert_eq!(count(2.0 + 0.1 * f64::from(steps)), usize::try_from(steps).unwrap() + 1);
        }
        assert!(count(1e12) <= 2 * Grid::LONGEST);
        assert!(count(f64::INFINITY) <= 2 * Grid::LONGEST);
    }

    #[test]
    fn runs_need_their_length() {
        let mask = [true, false, true, true, true, false, true, true];
        assert_eq!(Grid::runs(&mask, 2), vec![2..5, 6..8]);
    }
}
