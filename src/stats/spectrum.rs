//! Transforms and power of evenly sampled series, and power at any frequency of any series.

use nalgebra::{Complex, Vector3};
use realfft::RealFftPlanner;
use std::f64::consts::TAU;

/// Fourier coefficients of a series and their frequencies (Hz): at whole turns over its length, from one turn on, to
/// `highest_hz` at most and below half the sampling rate.
#[must_use]
pub fn transform(series: &[f64], step_s: f64, highest_hz: f64) -> Vec<(f64, Complex<f64>)> {
    let length_s = series.len() as f64 * step_s;
    let bins = 1..series.len().div_ceil(2);
    let frequencies_hz = bins.map(|bin| bin as f64 / length_s).take_while(|hz| *hz <= highest_hz);
    // the first coefficient is the sum
    frequencies_hz.zip(coefficients(series).into_iter().skip(1)).collect()
}

/// The discrete Fourier transform of a series from zero to half the sampling rate; empty of an empty one.
fn coefficients(series: &[f64]) -> Vec<Complex<f64>> {
    if series.is_empty() {
        return Vec::new();
    }
    let plan = RealFftPlanner::new().plan_fft_forward(series.len());
    // the plan works in its input
    let (mut values, mut out) = (series.to_vec(), plan.make_output_vec());
    match plan.process(&mut values, &mut out) {
        Ok(()) => out,
        // only buffers of other lengths are refused
        Err(_) => Vec::new(),
    }
}

/// A series less its mean under Hann's window.
#[must_use]
pub fn hann_windowed(series: &[f64]) -> Vec<f64> {
    let n = series.len() as f64;
    let mean = series.iter().sum::<f64>() / n.max(1.0);
    let window = |i: usize| 0.5 - 0.5 * (TAU * i as f64 / n).cos();
    series.iter().enumerate().map(|(i, value)| (value - mean) * window(i)).collect()
}

/// Power of a series of vectors, less its mean under Hann's window, and its frequency (Hz) at each bin of [`transform`].
#[must_use]
pub fn hann_power(series: &[Vector3<f64>], step_s: f64, highest_hz: f64) -> Vec<(f64, f64)> {
    let axis = |axis: usize| {
        let values: Vec<f64> = series.iter().map(|value| value[axis]).collect();
        transform(&hann_windowed(&values), step_s, highest_hz)
    };
    let (x, y, z) = (axis(0), axis(1), axis(2));
    x.iter()
        .zip(&y)
        .zip(&z)
        .map(|(((frequency_hz, x), (_, y)), (_, z))| {
            (*frequency_hz, x.norm_sqr() + y.norm_sqr() + z.norm_sqr())
        })
        .collect()
}

/// Power at one frequency of a series that need not be evenly sampled: its times (s) and values.
pub fn power_at(series: impl IntoIterator<Item = (f64, f64)>, frequency_hz: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (time_s, value) in series {
        let (s, c) = (TAU * frequency_hz * time_s).sin_cos();
        re += value * c;
        im += value * s;
    }
    re * re + im * im
}

/// Less the least-squares line.
#[must_use]
pub fn without_line(values: &[f64]) -> Vec<f64> {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = values.iter().sum::<f64>() / count.max(1.0);
    let (mut up, mut down) = (0.0, 0.0);
    for (index, value) in values.iter().enumerate() {
        let x = index as f64 - middle;
        up += x * value;
        down += x * x;
    }
    let slope = if down > 0.0 { up / down } else { 0.0 };
    values.iter().enumerate().map(|(index, value)| value - mean - slope * (index as f64 - middle)).collect()
}

/// How much of a series moves with another, linearly and at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coherence {
    /// mean of the squared coherence, weighted by the series' power (0..1)
    pub mean: f64,
    /// Hz, where power times coherence is greatest; 0 where nothing moves
    pub frequency_hz: f64,
}

/// Coherence of a series with an input by Welch's method: of both, the transforms of the same windows.
#[must_use]
pub fn coherence(series: &[Vec<(f64, Complex<f64>)>], input: &[Vec<(f64, Complex<f64>)>]) -> Coherence {
    let bins = series.first().map_or(0, Vec::len);
    let (mut weighted, mut power, mut best) = (0.0, 0.0, (0.0, 0.0));
    for bin in 0..bins {
        let (mut of_series, mut of_input, mut across) = (0.0, 0.0, Complex::new(0.0, 0.0));
        for ((_, s), (_, i)) in series.iter().zip(input).map(|(s, i)| (s[bin], i[bin])) {
            of_series += s.norm_sqr();
            of_input += i.norm_sqr();
            across += s * i.conj();
        }
        let moved = if of_input > 0.0 { across.norm_sqr() / of_input } else { 0.0 };
        weighted += moved;
        power += of_series;
        if moved > best.1 {
            best = (series[0][bin].0, moved);
        }
    }
    Coherence { mean: if power > 0.0 { weighted / power } else { 0.0 }, frequency_hz: best.0 }
}

/// What the squared coherence of noise alone stays below in 95 of 100 single frequencies, by so many Hann windows that
/// overlap by half.
#[must_use]
pub fn coherence_of_noise(windows: usize) -> f64 {
    // neighbouring Hann windows that overlap by half share a little: they count for this much
    let free = 0.95 * windows as f64;
    1.0 - 0.05_f64.powf(1.0 / (free - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_its_power_at_its_frequency() {
        // 3 turns over 100 samples of 0.1 s
        let sine: Vec<f64> = (0..100).map(|i| 2.0 * (TAU * 0.3 * f64::from(i) * 0.1).sin()).collect();
        let bins = transform(&sine, 0.1, 1.0);
        assert_eq!(bins.len(), 10);
        for (bin, (frequency_hz, value)) in bins.iter().enumerate() {
            let expected = if bin == 2 { 100.0_f64.powi(2) } else { 0.0 };
            assert!((frequency_hz - 0.1 * (bin as f64 + 1.0)).abs() < 1e-12);
            assert!((value.norm_sqr() - expected).abs() < 1e-9, "{frequency_hz} {value}");
        }
        let timed = sine.iter().enumerate().map(|(i, value)| (0.1 * i as f64, *value));
        assert!((power_at(timed, 0.3) - 1e4).abs() < 1e-6);
        // to half the sampling rate, which itself is left out
        assert_eq!(transform(&sine, 0.1, 100.0).len(), 49);
        assert_eq!(transform(&sine[..99], 0.1, 100.0).len(), 49);
        assert!(transform(&[1.0], 0.1, 100.0).is_empty() && transform(&[], 0.1, 100.0).is_empty());
    }

    /// A sum over the samples with every sine and cosine of its own.
    fn direct(series: &[f64], bin: usize) -> Complex<f64> {
        let wave = |i: usize| {
            // whole turns left out exactly
            let part = (bin * i % series.len()) as f64 / series.len() as f64;
            Complex::from_polar(1.0, -TAU * part)
        };
        series.iter().enumerate().map(|(i, value)| wave(i) * *value).sum()
    }

    #[test]
    fn the_transform_is_the_direct_sum() {
        // short, even, odd, prime, and of many factors
        for length in [2_usize, 3, 7, 50, 97, 167, 625, 1009, 1024] {
            let series: Vec<f64> = (0..length).map(|i| (0.3 * (i * i % 101) as f64).sin() + 0.5).collect();
            let found = transform(&series, 1.0, 1.0);
            let expected: Vec<Complex<f64>> =
                (1..length.div_ceil(2)).map(|bin| direct(&series, bin)).collect();
            assert_eq!(found.len(), expected.len());
            let largest = expected.iter().map(|value| value.norm()).fold(0.0, f64::max);
            for (bin, ((frequency_hz, found), expected)) in found.iter().zip(&expected).enumerate() {
                assert_eq!(*frequency_hz, (bin + 1) as f64 / length as f64);
                assert!((found - expected).norm() <= 1e-12 * largest, "{length} {bin}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_line_goes_and_the_rest_stays() {
        let values: Vec<f64> = (0..50).map(|i| 3.0 - 0.2 * f64::from(i)).collect();
        assert!(without_line(&values).iter().all(|value| value.abs() < 1e-12));
    }

    #[test]
    fn a_copy_is_coherent_and_a_stranger_is_not() {
        use rand::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        let mut white = || -> Vec<f64> { (0..4000).map(|_| StandardNormal.sample(&mut rng)).collect() };
        let (first, second) = (white(), white());
        let spectra = |series: &[f64]| -> Vec<_> {
            series.chunks_exact(100).map(|window| transform(&hann_windowed(window), 0.1, 2.0)).collect()
        };
        let doubled: Vec<f64> = first.iter().map(|value| 2.0 * value).collect();
        assert!((coherence(&spectra(&first), &spectra(&doubled)).mean - 1.0).abs() < 1e-9);
        let strange = coherence(&spectra(&first), &spectra(&second)).mean;
        assert!(strange < coherence_of_noise(40), "{strange}");
    }
}
