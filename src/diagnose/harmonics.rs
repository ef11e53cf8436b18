//! Lack of fit without a library of effects: residual power at the trajectory's harmonics against the power of the bins
//! beside them.
//!
//! With a trajectory that is flown several times, everything that the model lacks is at multiples of its frequency;
//! noise is also between them. The test does not see causes that do not repeat.

use super::channels::{AXES, CHANNELS};
use super::trace::Trace;
use crate::stats::{f_tail, joint_chance, median_step, power_at};

/// Highest frequency of the test, Hz: the kernel of 0.4 s passes little above.
const HIGHEST_HZ: f64 = 2.0;
/// Least number of periods. With fewer, a bin between two harmonics is the neighbour of both.
const LEAST_PERIODS: usize = 3;
/// Number of periods up to which the second neighbours of two harmonics are the same bin.
const LEAST_PERIODS_OF_TWO: usize = 4;
/// Least autocorrelation at one period for a flight that counts as periodic. With less the harmonics would be those
/// of nothing; a flight that counts as aperiodic is tested by spectra.
const PERIODIC: f64 = 0.35;
/// Shortest period that is searched for, s. Shorter ones are vibration.
const SHORTEST_S: f64 = 3.0;

/// One harmonic of one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Hz
    pub frequency_hz: f64,
    /// ratio of its power to that of its neighbours
    pub ratio: f64,
    /// energy above that of the neighbours, in sigma squared of the channel
    pub excess: f64,
}

/// The test's outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct LackOfFit {
    /// s
    pub period_s: f64,
    /// whole periods used
    pub periods: usize,
    /// p-value of the power at the harmonics if the residual is noise, each channel
    pub p_value: [f64; CHANNELS],
    /// root mean square at the harmonics beyond the noise, each channel, in its sigma
    pub excess_rms: [f64; CHANNELS],
    /// each channel's lines
    pub lines: [Vec<Line>; CHANNELS],
    /// energy at the harmonics beyond the noise, all axes of the first reading, sigma squared
    pub excess_energy: f64,
}

impl LackOfFit {
    /// Smallest p-value of the channels, times their number (Bonferroni).
    #[must_use]
    pub fn p_least(&self) -> f64 {
        (self.p_value.iter().fold(1.0_f64, |least, p| least.min(*p)) * CHANNELS as f64).min(1.0)
    }
}

/// The period of a repeated trajectory by the autocorrelation of `signals` (rows at `time_s`); `None` where
/// nothing repeats at least three times.
#[must_use]
pub fn period_s(time_s: &[f64], signals: &[&[f64]]) -> Option<f64> {
    let (first, last) = middle(time_s)?;
    let used: Vec<usize> = (0..time_s.len()).filter(|&row| (first..=last).contains(&time_s[row])).collect();
    let step_s = Some(median_step(time_s)).filter(|step_s| *step_s > 0.0)?;
    let mut index = Vec::with_capacity(used.len());
    let (mut slot, mut at_s) = (0usize, first);
    for time in used.iter().map(|&row| &time_s[row]) {
        while at_s + 0.5 * step_s < *time {
            at_s += step_s;
            slot += 1;
        }
        index.push(slot);
    }
    let count = slot + 1;
    // of the whole flight
    let longest_s = 1.5 * (last - first) / LEAST_PERIODS as f64;
    let series: Vec<Vec<f64>> = signals
        .iter()
        .map(|signal| onto(&index, &used.iter().map(|&row| signal[row]).collect::<Vec<f64>>(), count))
        .collect();
    let correlation = |lag: usize| {
        let (mut sum, mut power) = (0.0, 0.0);
        for series in &series {
            let scale: f64 = series.iter().map(|v| v * v).sum::<f64>() / count as f64;
            if scale <= 0.0 {
                continue;
            }
            let product: f64 = series.iter().zip(&series[lag..]).map(|(a, b)| a * b).sum();
            sum += product / scale;
            power += (count - lag) as f64;
        }
        if power > 0.0 { sum / power } else { 0.0 }
    };
    let lags: Vec<(f64, f64)> = (1..count)
        .map(|lag| (lag, lag as f64 * step_s))
        .filter(|(_, lag_s)| (SHORTEST_S..=longest_s).contains(lag_s))
        .map(|(lag, lag_s)| (lag_s, correlation(lag)))
        .collect();
    let best = lags.iter().map(|(_, r)| *r).fold(0.0, f64::max);
    if best < PERIODIC {
        return None;
    }
    // the first peak that is nearly as high: its multiples are as high
    let peak = (1..lags.len().saturating_sub(1))
        .find(|&i| lags[i].1 > 0.9 * best && lags[i].1 >= lags[i - 1].1 && lags[i].1 >= lags[i + 1].1)?;
    let (before, at, after) = (lags[peak - 1].1, lags[peak].1, lags[peak + 1].1);
    let curve = before - 2.0 * at + after;
    let shift = if curve < 0.0 { 0.5 * (before - after) / curve } else { 0.0 };
    Some(lags[peak].0 + shift * step_s)
}

/// The period of a flight from its measured motion, s, with rows at `time_s`.
#[must_use]
pub fn flown_period_s(trace: &Trace, time_s: &[f64]) -> Option<f64> {
    let series =
        |pick: &dyn Fn(usize) -> f64| -> Vec<f64> { trace.centers.iter().map(|&c| pick(c)).collect() };
    let mut motion: Vec<Vec<f64>> = Vec::new();
    for axis in 0..3 {
        if trace.known.velocity {
            motion.push(series(&|center| trace.states[center].velocity_m_s[axis]));
        } else {
            motion.push(series(&|center| trace.states[center].rates_rad_s[axis]));
        }
    }
    let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
    period_s(time_s, &motion)
}

/// Span of the flight without its first and last sixth, s: the transitions at both ends do not repeat.
fn middle(time_s: &[f64]) -> Option<(f64, f64)> {
    let (first, last) = (*time_s.first()?, *time_s.last()?);
    let edge = (last - first) / 6.0;
    Some((first + edge, last - edge))
}

/// The signal without its mean on a grid of `count` slots, zero in slots without a measurement.
fn onto(index: &[usize], signal: &[f64], count: usize) -> Vec<f64> {
    let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
    let mut out = vec![0.0; count];
    for (slot, value) in index.iter().zip(signal) {
        out[*slot] = value - mean;
    }
    out
}

/// Tests the residual (one series a channel, in units of its sigma) of one flight.
#[must_use]
pub fn lack_of_fit(time_s: &[f64], residual: [&[f64]; CHANNELS], period_s: f64) -> Option<LackOfFit> {
    let (first, last) = (*time_s.first()?, *time_s.last()?);
    let step_s = Some(median_step(time_s)).filter(|step_s| *step_s > 0.0)?;
    let periods = whole_periods(last - first + step_s, period_s);
    if periods < LEAST_PERIODS {
        return None;
    }
    // the last whole periods: the beginning may hold the way to the start
    let from_s = last + step_s - periods as f64 * period_s;
    let used: Vec<usize> = (0..time_s.len()).filter(|&row| time_s[row] >= from_s - 1e-9).collect();
    let rest = Periodogram { time_s, used: &used, from_s };
    let mut out = LackOfFit {
        period_s,
        periods,
        p_value: [1.0; CHANNELS],
        excess_rms: [0.0; CHANNELS],
        lines: Default::default(),
        excess_energy: 0.0,
    };
    let count = used.len() as f64;
    for (channel, series) in residual.into_iter().enumerate() {
        let (p_value, lines) = rest.harmonics(series, (period_s, periods));
        let excess = lines.iter().map(|line| line.excess).sum::<f64>().max(0.0);
        out.p_value[channel] = p_value;
        out.lines[channel] = lines;
        out.excess_rms[channel] = (excess / count).sqrt();
        if channel < AXES {
            out.excess_energy += excess;
        }
    }
    Some(out)
}

/// Number of whole periods in a span (both s).
fn whole_periods(span_s: f64, period_s: f64) -> usize {
    let mut periods = 0;
    while (periods + 1) as f64 * period_s <= span_s {
        periods += 1;
    }
    periods
}

/// Rows of a residual for the power at single frequencies.
struct Periodogram<'a> {
    time_s: &'a [f64],
    used: &'a [usize],
    from_s: f64,
}

impl Periodogram<'_> {
    /// Power of a series without its mean at a frequency (Hz).
    fn power(&self, series: &[f64], mean: f64, frequency_hz: f64) -> f64 {
        let used = self.used.iter().map(|&row| (self.time_s[row] - self.from_s, series[row] - mean));
        power_at(used, frequency_hz)
    }

    /// Each harmonic against its neighbours between the harmonics, and Fisher's combined p-value.
    fn harmonics(&self, series: &[f64], (period_s, periods): (f64, usize)) -> (f64, Vec<Line>) {
        // no bin is the neighbour of two harmonics: Fisher's sum takes their ratios as independent
        let neighbours: &[i32] = if periods > LEAST_PERIODS_OF_TWO { &[-2, -1, 1, 2] } else { &[-1, 1] };
        let count = self.used.len() as f64;
        let mean = self.used.iter().map(|&row| series[row]).sum::<f64>() / count;
        let spacing_hz = 1.0 / (periods as f64 * period_s);
        let (mut chances, mut lines, mut harmonic) = (Vec::new(), Vec::new(), 1.0);
        while harmonic / period_s <= HIGHEST_HZ {
            let frequency_hz = harmonic / period_s;
            let beside = neighbours
                .iter()
                .map(|shift| self.power(series, mean, frequency_hz + f64::from(*shift) * spacing_hz));
            let noise = beside.sum::<f64>() / neighbours.len() as f64;
            let at = self.power(series, mean, frequency_hz);
            let ratio = if noise > 0.0 { at / noise } else { 0.0 };
            chances.push(f_tail(ratio, (2.0, 2.0 * neighbours.len() as f64)));
            lines.push(Line { frequency_hz, ratio, excess: 2.0 * (at - noise) / count });
            harmonic += 1.0;
        }
        (joint_chance(chances), lines)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const STEP_S: f64 = 0.05;
    /// Five periods of 4 s, after one row that belongs to none.
    const ROWS: i32 = 400;

    fn times() -> Vec<f64> {
        (0..=ROWS).map(|row| STEP_S * f64::from(row)).collect()
    }

    /// The test with one series in the first channel, a function of the row within the periods.
    fn lack_of(series: impl Fn(i32) -> f64) -> LackOfFit {
        let first: Vec<f64> = (-1..ROWS).map(series).collect();
        let none = vec![0.0; first.len()];
        let residual = std::array::from_fn(|channel| if channel == 0 { &first[..] } else { &none[..] });
        lack_of_fit(&times(), residual, 4.0).unwrap()
    }

    fn is_near(found: f64, expected: f64, relative: f64) -> bool {
        (found - expected).abs() < relative * expected.abs()
    }

    /// Every bin of 1/20 Hz holds a line of amplitude 1, the first harmonic one of 3. By hand: its ratio is 9, its excess
    /// `N / 2 (3^2 - 1)`, and F of 2 and 8 degrees of freedom exceeds r with chance `(1 + r / 4)^-4`, so that Fisher's sum is
    /// `8 ln(13 / 4) + 56 ln(5 / 4)`. SciPy: `scipy.stats.chi2.sf(8 * log(3.25) + 56 * log(1.25), 16)`
    #[test]
    fn one_harmonic_over_even_lines_has_its_amplitude() {
        let found = lack_of(|row| {
            let bin = |m: i32| (TAU * f64::from(m) / 20.0 * STEP_S * f64::from(row)).cos();
            (1..=42).map(bin).sum::<f64>() + 2.0 * bin(5)
        });
        assert_eq!((found.periods, found.lines[0].len()), (5, 8));
        let [first, others @ ..] = &found.lines[0][..] else { panic!("no lines") };
        assert!(is_near(first.ratio, 9.0, 1e-9) && is_near(first.excess, 1600.0, 1e-9), "{first:?}");
        assert!(others.iter().all(|line| is_near(line.ratio, 1.0, 1e-9) && line.excess.abs() < 1e-6));
        assert!(is_near(found.excess_rms[0], 2.0, 1e-9) && is_near(found.excess_energy, 1600.0, 1e-9));
        assert!(is_near(found.p_value[0], 0.145_620_605_030_294_2, 1e-9), "{}", found.p_value[0]);
        // nothing in the other channels
        assert!(found.p_value[1..].iter().all(|p| *p == 1.0) && is_near(found.p_least(), 1.0, 1e-12));
    }

    /// NumPy and SciPy: `python3 tests/peers/evidence_numbers.py harmonics`
    #[test]
    fn powers_and_chance_are_those_of_a_fourier_transform() {
        let found = lack_of(|row| {
            let j = row + 1;
            f64::from((j * j * 74 + j * 362) % 1009) / 1009.0 - 0.5
                + 0.2 * (TAU * 0.5 * STEP_S * f64::from(row)).cos()
        });
        let ratios = [
            0.20297852320532356,
            51.18261738057817,
            0.9931784585361385,
            4.103188774116524,
            1.2410647040166283,
            1.8125278890403131,
            2.1359939842021385,
            4.726527986659753,
        ];
        for (line, ratio) in found.lines[0].iter().zip(ratios) {
            assert!(is_near(line.ratio, ratio, 1e-7), "{line:?}, not {ratio}");
        }
        assert!(is_near(found.p_value[0], 0.00022462913333210247, 1e-7), "{}", found.p_value[0]);
        assert!(is_near(found.excess_energy, 9.084857377741157, 1e-7), "{}", found.excess_energy);
    }

    #[test]
    fn the_period_of_a_sum_of_two_harmonics_is_found() {
        let time_s: Vec<f64> = (0..1000).map(|row| STEP_S * f64::from(row)).collect();
        let of = |period_s: f64| -> Vec<f64> {
            let w = TAU / period_s;
            time_s.iter().map(|t| (w * t).sin() + 0.6 * (2.0 * w * t).cos()).collect()
        };
        // what the ends cut off moves the peak: by less than a row over four periods and more, by 2 % over three
        for (truth_s, within_s) in [(5.3, STEP_S), (8.0, STEP_S), (11.17, 0.25)] {
            let found = period_s(&time_s, &[&of(truth_s)]).unwrap();
            assert!((found - truth_s).abs() < within_s, "{found} s, not {truth_s} s");
        }
        // longer than the middle of the flight
        assert_eq!(period_s(&time_s, &[&of(40.0)]), None);
    }
}
