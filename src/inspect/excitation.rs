//! How lively a flight was: sums over windows, seen through the identification's kernel.

use super::inspection::Excitation;
use super::motion::Motion;
use crate::signals::{Grid, WEAK_HALF_WIDTH_S, WeakKernel, stride};
use crate::stats::hann_power;
use crate::units::STANDARD_GRAVITY_M_S2;
use nalgebra::Vector3;

/// Width of the bins of spectra, Hz. Only what is shown depends on it.
const BIN_HZ: f64 = 0.05;
const BINS: usize = 100;
/// Share of the power below the band's lower and upper end. Only what is shown depends on it.
const BAND: (f64, f64) = (0.05, 0.95);
/// Step of the series for spectra and periods, s. Only what is shown depends on it: motions of up to 5 Hz.
const SERIES_STEP_S: f64 = 0.1;
/// Least correlation with the motion one period later for a trajectory that repeats. Only what is shown depends on
/// it.
const LEAST_RESEMBLANCE: f64 = 0.8;
/// Shortest period, s: shorter ones are vibration. Only what is shown depends on it.
const SHORTEST_PERIOD_S: f64 = 1.5;

/// Sums of what [`Excitation`] says.
#[derive(Debug, Clone)]
pub(super) struct ExcitationTally {
    seconds: f64,
    rate: Option<Moments>,
    acceleration: Option<Moments>,
    /// count, sum and sum of squares of what is beyond gravity: a small difference of squares stays exact
    thrust: Option<(f64, f64, f64)>,
    speed: Option<(f64, f64, f64)>,
    altitude_m: Option<(f64, f64)>,
    power: Vec<f64>,
    /// resemblance and period, the best of all windows
    repeats: Option<(f64, f64)>,
}

/// Count and sum of squares about x, y, z.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    count: f64,
    square: [f64; 3],
}

impl Moments {
    fn add(&mut self, value: &Vector3<f64>) {
        self.count += 1.0;
        for (square, value) in self.square.iter_mut().zip(value.iter()) {
            *square += value * value;
        }
    }

    fn rms(&self) -> [f64; 3] {
        self.square.map(|square| (square / self.count).sqrt())
    }
}

impl Default for ExcitationTally {
    fn default() -> Self {
        Self {
            seconds: 0.0,
            rate: None,
            acceleration: None,
            thrust: None,
            speed: None,
            altitude_m: None,
            power: vec![0.0; BINS],
            repeats: None,
        }
    }
}

impl ExcitationTally {
    /// Adds the instants of a window that count.
    pub(super) fn add(&mut self, motion: &Motion) {
        let step_s = motion.grid.step_s;
        let kernel = WeakKernel::new(WEAK_HALF_WIDTH_S, step_s);
        let centers = kernel.centers(&motion.usable, stride(step_s));
        if centers.is_empty() {
            return;
        }
        self.seconds += motion.usable.iter().filter(|good| **good).count() as f64 * step_s;
        if let Some(rate) = &motion.rate {
            self.add_rates(rate, &kernel, &centers);
        }
        if let Some(thrust) = &motion.thrust {
            let (count, sum, square) = self.thrust.get_or_insert((0.0, 0.0, 0.0));
            for value in kernel.apply(0, thrust, &centers).iter().map(|f| f - STANDARD_GRAVITY_M_S2) {
                *count += 1.0;
                *sum += value;
                *square += value * value;
            }
        }
        if let Some(velocity) = &motion.velocity {
            let (count, square, most) = self.speed.get_or_insert((0.0, 0.0, 0.0));
            for speed in centers.iter().map(|&center| velocity[center].norm()) {
                *count += 1.0;
                *square += speed * speed;
                *most = most.max(speed);
            }
        }
        for z in motion.altitude.iter().flat_map(|altitude| centers.iter().map(|&center| altitude[center])) {
            let (low, high) = self.altitude_m.get_or_insert((z, z));
            *low = low.min(z);
            *high = high.max(z);
        }
        self.add_series(motion, &kernel);
    }

    fn add_rates(&mut self, rate: &[Vector3<f64>], kernel: &WeakKernel, centers: &[usize]) {
        let columns: [Vec<f64>; 3] = std::array::from_fn(|axis| rate.iter().map(|w| w[axis]).collect());
        let (mut rates, mut accelerations) =
            (self.rate.unwrap_or_default(), self.acceleration.unwrap_or_default());
        for &center in centers {
            rates.add(&Vector3::from_fn(|axis, _| kernel.at(0, &columns[axis], center)));
            accelerations.add(&Vector3::from_fn(|axis, _| kernel.at(1, &columns[axis], center)));
        }
        (self.rate, self.acceleration) = (Some(rates), Some(accelerations));
    }

    /// Spectrum and period, from the first to the last instant that counts: a short end stop or a transient in
    /// between is no end of the motion.
    fn add_series(&mut self, motion: &Motion, kernel: &WeakKernel) {
        let runs = Grid::runs(&motion.usable, 2 * kernel.half_count + 1);
        let (Some(first), Some(last)) = (runs.first(), runs.last()) else { return };
        let run = first.start..last.end;
        let mut step = 1;
        while (step as f64 + 0.5) * motion.grid.step_s < SERIES_STEP_S {
            step += 1;
        }
        let step_s = step as f64 * motion.grid.step_s;
        let centers: Vec<usize> =
            (run.start + kernel.half_count..run.end - kernel.half_count).step_by(step).collect();
        let series = |order: usize, vectors: &[Vector3<f64>]| -> Vec<Vector3<f64>> {
            let columns: [Vec<f64>; 3] =
                std::array::from_fn(|axis| vectors[run.clone()].iter().map(|w| w[axis]).collect());
            let at = |center: usize| {
                Vector3::from_fn(|axis, _| kernel.at(order, &columns[axis], center - run.start))
            };
            centers.iter().map(|&center| at(center)).collect()
        };
        if let Some(rate) = &motion.rate {
            self.add_spectrum(&series(1, rate), step_s);
        }
        let moving = motion.velocity.as_ref().or(motion.rate.as_ref()).map(|vectors| series(0, vectors));
        // twice the step: a period is found between the lags
        let sparse = |moving: Vec<Vector3<f64>>| moving.into_iter().step_by(2).collect::<Vec<_>>();
        let found = moving.and_then(|moving| repetition(&sparse(moving), 2.0 * step_s));
        if found.is_some_and(|(alike, _)| self.repeats.is_none_or(|(best, _)| alike > best)) {
            self.repeats = found;
        }
    }

    fn add_spectrum(&mut self, series: &[Vector3<f64>], step_s: f64) {
        if series.len() < 50 {
            return;
        }
        let mut bins = hann_power(series, step_s, BIN_HZ * BINS as f64).into_iter().peekable();
        // Hann's window spreads a line over the length: longer windows weigh more, as they should
        for (index, sum) in self.power.iter_mut().enumerate() {
            let top_hz = BIN_HZ * (index as f64 + 1.0);
            while let Some((_, power)) = bins.next_if(|(frequency_hz, _)| *frequency_hz <= top_hz) {
                *sum += power / series.len() as f64;
            }
        }
    }

    fn band_hz(&self) -> Option<(f64, f64)> {
        let total: f64 = self.power.iter().sum();
        let below = |share: f64| {
            let mut sum = 0.0;
            self.power.iter().position(|power| {
                sum += power;
                sum >= share * total
            })
        };
        let (low, high) = (below(BAND.0)?, below(BAND.1)?);
        (total > 0.0).then_some((BIN_HZ * (low as f64 + 0.5), BIN_HZ * (high as f64 + 0.5)))
    }

    /// What was collected; `None` where no instant counted.
    pub(super) fn summary(&self) -> Option<Excitation> {
        (self.seconds > 0.0).then(|| Excitation {
            seconds: self.seconds,
            rate_rms_rad_s: self.rate.map(|rate| rate.rms()),
            angular_acceleration_rms_rad_s2: self.acceleration.map(|acceleration| acceleration.rms()),
            angular_acceleration_band_hz: self.band_hz(),
            thrust_mean_m_s2: self.thrust.map(|(count, sum, _)| STANDARD_GRAVITY_M_S2 + sum / count),
            thrust_variation_m_s2: self
                .thrust
                .map(|(count, sum, square)| (square / count - (sum / count).powi(2)).max(0.0).sqrt()),
            speed_rms_m_s: self.speed.map(|(count, square, _)| (square / count).sqrt()),
            speed_max_m_s: self.speed.map(|(_, _, most)| most),
            altitude_m: self.altitude_m,
            period_s: self.repeats.map(|(_, period_s)| period_s),
        })
    }
}

/// How much a series resembles itself a period later, and that period, s: the shortest of those that are
/// about as good as the best.
fn repetition(series: &[Vector3<f64>], step_s: f64) -> Option<(f64, f64)> {
    let mean = series.iter().sum::<Vector3<f64>>() / (series.len() as f64).max(1.0);
    let centred: Vec<Vector3<f64>> = series.iter().map(|value| value - mean).collect();
    let alike = |lag: usize| {
        let (early, late) = (&centred[..centred.len() - lag], &centred[lag..]);
        let common: f64 = early.iter().zip(late).map(|(a, b)| a.dot(b)).sum();
        let size = |part: &[Vector3<f64>]| part.iter().map(Vector3::norm_squared).sum::<f64>().sqrt();
        common / (size(early) * size(late)).max(f64::MIN_POSITIVE)
    };
    // at least one and a half periods must be there
    let resemblance: Vec<f64> = (0..2 * series.len() / 3).map(alike).collect();
    let mut peaks: Vec<(f64, f64)> = Vec::new();
    for lag in 1..resemblance.len().saturating_sub(1) {
        let [before, here, after] = [resemblance[lag - 1], resemblance[lag], resemblance[lag + 1]];
        if here >= before && here > after && here > LEAST_RESEMBLANCE {
            // the top of a parabola through the three
            let between = 0.5 * (before - after) / (before - 2.0 * here + after);
            peaks.push((here, (lag as f64 + between) * step_s));
        }
    }
    let best = peaks.iter().map(|(here, _)| *here).fold(0.0, f64::max);
    peaks.into_iter().find(|(here, period_s)| *here >= 0.95 * best && *period_s >= SHORTEST_PERIOD_S)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn wave(t: f64) -> Vector3<f64> {
        Vector3::new((TAU * t / 10.0).sin() + (TAU * t / 2.5).sin(), (TAU * t / 5.0).cos(), 0.2)
    }

    #[test]
    fn the_period_of_a_sum_of_harmonics_is_the_longest() {
        let series: Vec<Vector3<f64>> = (0..400).map(|i| wave(f64::from(i) * 0.1)).collect();
        let (alike, period_s) = repetition(&series, 0.1).unwrap();
        assert!(alike > 0.99 && (period_s - 10.0).abs() < 0.02, "{alike} {period_s}");
    }

    #[test]
    fn a_transit_does_not_repeat_itself() {
        let series: Vec<Vector3<f64>> =
            (0..400).map(|i| Vector3::new(f64::from(i * i), f64::from(i), 1.0)).collect();
        assert_eq!(repetition(&series, 0.1), None);
    }

    #[test]
    fn windows_add_up_to_what_a_sine_has() {
        let grid = Grid { start_s: 0.0, step_s: 0.01, count: 6000 };
        let sine = |i: usize| Vector3::new((TAU * 0.5 * grid.time_s(i)).sin(), 0.0, 0.0);
        let motion = Motion {
            usable: vec![true; grid.count],
            rate: Some(std::sync::Arc::new((0..grid.count).map(sine).collect())),
            thrust: Some(vec![9.8; grid.count]),
            velocity: None,
            altitude: None,
            grid,
        };
        let mut tally = ExcitationTally::default();
        tally.add(&motion);
        tally.add(&motion);
        let excitation = tally.summary().unwrap();
        assert!((excitation.seconds - 120.0).abs() < 1e-6);
        let rms = excitation.angular_acceleration_rms_rad_s2.unwrap()[0];
        // the kernel takes a few percent at 0.5 Hz
        assert!((rms / (TAU * 0.5 / 2.0_f64.sqrt()) - 0.97).abs() < 0.03, "{rms}");
        let (low, high) = excitation.angular_acceleration_band_hz.unwrap();
        assert!(low > 0.4 && high < 0.6, "{low} {high}");
        assert!((excitation.period_s.unwrap() - 2.0).abs() < 0.02);
        assert!(excitation.thrust_variation_m_s2.unwrap() < 1e-5);
    }
}
