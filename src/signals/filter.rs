//! Zero-phase filters and central differences of the paper's section II-C, and the filter pair
//! (35), (36) of its filtered regression model.

use std::f64::consts::{PI, TAU};

/// A second-order section, direct form II transposed.
#[derive(Debug, Clone, Copy)]
struct Biquad {
    b: [f64; 3],
    a: [f64; 2],
}

impl Biquad {
    /// Filters in place, starting from the steady state of the first sample.
    fn run(&self, column: &mut [f64]) {
        let Some(&first) = column.first() else { return };
        let mut memory = self.steady(first);
        for value in column {
            *value = self.step(&mut memory, *value);
        }
    }

    /// Memory of the filter after a constant input; with unit gain at zero frequency the output equals the input.
    fn steady(&self, input: f64) -> [f64; 2] {
        [input * (1.0 - self.b[0]), input * (self.b[2] - self.a[1])]
    }

    fn step(&self, [z1, z2]: &mut [f64; 2], input: f64) -> f64 {
        let output = self.b[0] * input + *z1;
        *z1 = self.b[1] * input - self.a[0] * output + *z2;
        *z2 = self.b[2] * input - self.a[1] * output;
        output
    }
}

/// Forward-backward fourth-order Butterworth low-pass: no phase, -6 dB at the cut-off.
#[derive(Debug, Clone)]
pub struct Butterworth {
    sections: [Biquad; 2],
    pad: usize,
}

impl Butterworth {
    /// `None` unless `0 < cutoff_hz < sample_rate_hz / 2`.
    #[must_use]
    pub fn new(cutoff_hz: f64, sample_rate_hz: f64) -> Option<Self> {
        if !(cutoff_hz > 0.0 && cutoff_hz < 0.5 * sample_rate_hz) {
            return None;
        }
        // bilinear transform with pre-warping of the analogue prototype's two pole pairs
        let k = (PI * cutoff_hz / sample_rate_hz).tan();
        let sections = [1.0, 3.0].map(|pole| {
            let damping = 2.0 * (pole * PI / 8.0).cos();
            let norm = 1.0 / (1.0 + damping * k + k * k);
            Biquad {
                b: [k * k * norm, 2.0 * k * k * norm, k * k * norm],
                a: [2.0 * (k * k - 1.0) * norm, (1.0 - damping * k + k * k) * norm],
            }
        });
        let mut pad = 0;
        while (pad as f64) < 4.0 * sample_rate_hz / cutoff_hz {
            pad += 1;
        }
        Some(Self { sections, pad })
    }

    /// Samples after which a disturbance has died away: two periods of the cut-off.
    #[must_use]
    pub fn settling_count(&self) -> usize {
        self.pad / 2
    }

    /// Causal filter, sample by sample, with the same phase for all signals. Starts from the steady state of its first
    /// sample.
    pub fn step(&self, memory: &mut ButterworthMemory, input: f64) -> f64 {
        let mut value = input;
        let sections = memory.0.get_or_insert_with(|| self.sections.map(|section| section.steady(input)));
        for (section, memory) in self.sections.iter().zip(sections) {
            value = section.step(memory, value);
        }
        value
    }

    /// The filtered column, as long as the input; the ends are extended by odd reflection.
    #[must_use]
    pub fn filtfilt(&self, column: &[f64]) -> Vec<f64> {
        let mut work = odd_reflection(column, self.pad);
        for _ in 0..2 {
            for section in &self.sections {
                section.run(&mut work);
            }
            work.reverse();
        }
        let pad = (work.len() - column.len()) / 2;
        work[pad..pad + column.len()].to_vec()
    }
}

/// State of [`Butterworth::step`] for one signal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ButterworthMemory(Option<[[f64; 2]; 2]>);

/// Extends both ends by point reflection, at most by the column's length less one.
fn odd_reflection(column: &[f64], pad: usize) -> Vec<f64> {
    let n = column.len();
    let pad = pad.min(n.saturating_sub(1));
    let mut out = Vec::with_capacity(n + 2 * pad);
    if let (Some(&first), Some(&last)) = (column.first(), column.last()) {
        out.extend((1..=pad).rev().map(|i| 2.0 * first - column[i]));
        out.extend_from_slice(column);
        out.extend((1..=pad).map(|i| 2.0 * last - column[n - 1 - i]));
    }
    out
}

/// The windowed FIR of section II-C: a low-pass of `length` taps (odd) under the four-term symmetric
/// Blackman-Harris window, applied without phase shift.
#[derive(Debug, Clone)]
pub struct WindowedFir {
    taps: Vec<f64>,
}

impl WindowedFir {
    /// Number of taps in the paper.
    pub const PAPER_LENGTH: usize = 31;

    /// `None` for an even or zero length or a cut-off that is not in `0..rate/2`.
    #[must_use]
    pub fn new(length: usize, cutoff_hz: f64, sample_rate_hz: f64) -> Option<Self> {
        if length.is_multiple_of(2) || !(cutoff_hz >= 0.0 && cutoff_hz < 0.5 * sample_rate_hz) {
            return None;
        }
        let middle = (length / 2) as f64;
        let mut taps: Vec<f64> = (0..length)
            .map(|i| {
                let x = TAU * cutoff_hz / sample_rate_hz * (i as f64 - middle);
                let sinc = if x.abs() < 1e-12 { 1.0 } else { x.sin() / x };
                sinc * blackman_harris(i, length)
            })
            .collect();
        let sum: f64 = taps.iter().sum();
        taps.iter_mut().for_each(|tap| *tap /= sum);
        Some(Self { taps })
    }

    /// The filtered column; the ends are extended by odd reflection.
    #[must_use]
    pub fn apply(&self, column: &[f64]) -> Vec<f64> {
        let padded = odd_reflection(column, self.taps.len() / 2);
        padded
            .windows(self.taps.len())
            .map(|window| window.iter().zip(&self.taps).map(|(x, tap)| x * tap).sum())
            .collect()
    }
}

/// Four-term symmetric Blackman-Harris window (Harris 1978, minimum four-term, -92 dB).
fn blackman_harris(index: usize, length: usize) -> f64 {
    if length < 2 {
        return 1.0;
    }
    let x = TAU * index as f64 / (length as f64 - 1.0);
    0.358_75 - 0.488_29 * x.cos() + 0.141_28 * (2.0 * x).cos() - 0.011_68 * (3.0 * x).cos()
}

/// Central differences (33); one-sided at the two ends.
#[must_use]
pub fn central_difference(column: &[f64], step_s: f64) -> Vec<f64> {
    let n = column.len();
    (0..n)
        .map(|i| {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(n - 1));
            if after == before {
                0.0
            } else {
                (column[after] - column[before]) / (step_s * (after - before) as f64)
            }
        })
        .collect()
}

/// The paper's discrete filters `f_D(z)` (35) and `g_D(z)` (36).
///
/// Printed, both are zero-order-hold equivalents, and signals are not held but smooth. (36) then reads
/// every rate too large by `lambda T / (1 - exp(-lambda T))`, its gain on a ramp (3.0 % at 500 Hz, 12.4 %
/// at 125 Hz with lambda = 30 rad/s), so that inertia comes out too small by as much; and (36) over
/// that gain is (35) of the forward difference, which belongs half a sample later than (35) of the
/// signal. [`FilterPair::new`] divides the gain out and gives (35) the mean of two neighbours, which makes
/// the pair exact on straight lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilterPair {
    pole: f64,
    rate_gain: f64,
}

impl FilterPair {
    /// The cut-off of the paper, rad/s.
    pub const PAPER_LAMBDA_RAD_S: f64 = 30.0;

    /// (35) and (36), consistent on straight lines.
    #[must_use]
    pub fn new(lambda_rad_s: f64, step_s: f64) -> Self {
        let pole = (-lambda_rad_s * step_s).exp();
        Self { pole, rate_gain: (1.0 - pole) / step_s }
    }

    /// `f_D` sample by sample; starts from zero.
    pub fn step_low_pass(&self, memory: &mut PairMemory, input: f64) -> f64 {
        self.step(memory, input, true)
    }

    /// `g_D` sample by sample: `gain (input - f_D input)`.
    pub fn step_rate(&self, memory: &mut PairMemory, input: f64) -> f64 {
        self.rate_gain * (input - self.step(memory, input, false))
    }

    /// One step over the last interval, with its first value held, or with the mean of its ends (`midpoint`).
    fn step(&self, memory: &mut PairMemory, input: f64, midpoint: bool) -> f64 {
        if let Some(last) = memory.last.replace(input) {
            let held = if midpoint { f64::midpoint(last, input) } else { last };
            memory.state = self.pole * memory.state + (1.0 - self.pole) * held;
        }
        memory.state
    }
}

/// State of the filters of a [`FilterPair`] for one signal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PairMemory {
    state: f64,
    last: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(rate_hz: f64, f_hz: f64, count: u32) -> Vec<f64> {
        (0..count).map(|i| (TAU * f_hz * f64::from(i) / rate_hz).sin()).collect()
    }

    #[test]
    fn butterworth_keeps_phase_and_has_its_gain() {
        let filter = Butterworth::new(5.0, 125.0).unwrap();
        // |H|^2 of forward-backward 4th order at the (pre-warped) cut-off is exactly 1/2
        for (f, gain) in [(0.5, 1.0), (5.0, 0.5), (30.0, 0.0)] {
            let x = sine(125.0, f, 2000);
            let y = filter.filtfilt(&x);
            for i in 800..1200 {
                assert!((y[i] - gain * x[i]).abs() < 2e-3, "{f} Hz at {i}: {} {}", y[i], x[i]);
            }
        }
        assert!(Butterworth::new(70.0, 125.0).is_none());
    }

    #[test]
    fn straight_lines_pass_unchanged() {
        let line: Vec<f64> = (0..300).map(|i| 2.0 + 0.1 * f64::from(i)).collect();
        for y in [
            Butterworth::new(4.0, 100.0).unwrap().filtfilt(&line),
            WindowedFir::new(31, 4.0, 100.0).unwrap().apply(&line),
        ] {
            assert_eq!(y.len(), line.len());
            assert!(y.iter().zip(&line).all(|(a, b)| (a - b).abs() < 2e-3));
        }
    }

    #[test]
    fn central_difference_is_exact_on_parabolas() {
        let x: Vec<f64> = (0..10).map(|i| f64::from(i * i) * 0.01).collect();
        let d = central_difference(&x, 0.1);
        assert!((d[4] - 0.8).abs() < 1e-12);
    }

    fn low_pass(pair: &FilterPair, column: &[f64]) -> Vec<f64> {
        let mut memory = PairMemory::default();
        column.iter().map(|input| pair.step_low_pass(&mut memory, *input)).collect()
    }

    fn rate(pair: &FilterPair, column: &[f64]) -> Vec<f64> {
        let mut memory = PairMemory::default();
        column.iter().map(|input| pair.step_rate(&mut memory, *input)).collect()
    }

    #[test]
    fn the_pair_is_exact_on_a_ramp() {
        let ramp: Vec<f64> = (0..2000).map(|i| 0.002 * f64::from(i)).collect();
        let pair = FilterPair::new(30.0, 0.002);
        assert!((rate(&pair, &ramp)[1999] - 1.0).abs() < 1e-9);
        // consistent: f_D of the true rate is one
        assert!((low_pass(&pair, &vec![1.0; 2000])[1999] - 1.0).abs() < 1e-9);
        // the gain that the paper prints, lambda, is 3 % larger
        assert!((30.0 / pair.rate_gain - 1.0303).abs() < 1e-4);
    }

    #[test]
    fn rate_and_low_pass_agree_on_a_sine_to_second_order() {
        let (w, step_s) = (6.0, 0.008);
        let time = |i: u32| f64::from(i) * step_s;
        let x: Vec<f64> = (0..3000).map(|i| (w * time(i)).sin()).collect();
        let true_rate: Vec<f64> = (0..3000).map(|i| w * (w * time(i)).cos()).collect();
        let pair = FilterPair::new(30.0, step_s);
        let (by_filter, low) = (rate(&pair, &x), low_pass(&pair, &true_rate));
        let worst = (1000..2900).map(|i| (by_filter[i] - low[i]).abs()).fold(0.0, f64::max);
        assert!(worst / w < 3e-4);
    }
}
