//! How a stream runs: rate, jitter, gaps. Fed sample by sample, in bounded memory.

use super::stream::Stream;

/// Periods are sorted into bins of 1/64 octave from a microsecond to 4.7 hours.
const BINS_AN_OCTAVE: f64 = 64.0;
const SHORTEST_S: f64 = 1e-6;
const BINS: usize = 34 * 64;
/// A period this many times the median is a gap.
const GAP_PERIODS: f64 = 3.0;
/// Periods of which more than this share are so long come in bursts: then none is a gap, and the mean tells the rate.
/// A link that loses a fifth of its frames is still a stream with gaps; with more there is no period to compare with.
const RARE: f64 = 0.2;
/// Fewer samples have no rate. Of fewer a median period is chance.
pub const LEAST_SAMPLES: u64 = 10;
/// Samples over less time, s, have no rate.
pub const LEAST_SPAN_S: f64 = 0.1;

/// How a stream runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreamStats {
    /// samples
    pub count: u64,
    /// first and last stamp, s; NaN where there is none
    pub span_s: (f64, f64),
    /// samples a second over the span, without gaps; NaN below ten samples or a tenth of a second
    pub rate_hz: f64,
    /// s; NaN below two samples
    pub median_period_s: f64,
    /// half the width of the middle 68 % of periods, s: one standard deviation were they Gaussian
    pub jitter_s: f64,
    /// periods longer than three medians
    pub gaps: u64,
    /// longest of them, s; 0 where there is none
    pub largest_gap_s: f64,
    /// time that the gaps miss, s
    pub missing_s: f64,
    /// steps back in time
    pub backward: u64,
    /// stamps that came twice in a row
    pub repeated_stamps: u64,
    /// restarts of the vehicle's clock while it ran
    pub resets: u64,
    /// samples that differ from their predecessor
    pub changes: u64,
    /// every value of every sample is zero or NaN
    pub all_zero: bool,
}

impl StreamStats {
    /// Of a finished stream.
    #[must_use]
    pub fn of(stream: &Stream) -> Self {
        let mut tally = StreamTally::default();
        for index in 0..stream.len() {
            tally.add(stream.time_s[index], stream.sample(index));
        }
        tally.stats()
    }

    /// The values never change: a sensor that is not there, or a message that nothing feeds.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.count > 1 && self.changes == 0
    }
}

/// Collects what [`StreamStats`] says.
#[derive(Debug, Clone, Default)]
pub struct StreamTally {
    count: u64,
    first_s: f64,
    last_s: f64,
    /// the next period spans a restart of the clock and is none
    restarted: bool,
    bins: Vec<Bin>,
    backward: u64,
    repeated_stamps: u64,
    resets: u64,
    changes: u64,
    nonzero: bool,
    last_values: Vec<f64>,
}

/// Periods of about the same length.
#[derive(Debug, Clone, Copy, Default)]
struct Bin {
    count: u64,
    sum_s: f64,
    longest_s: f64,
}

impl Bin {
    fn mean_s(&self) -> f64 {
        self.sum_s / self.count as f64
    }
}

impl StreamTally {
    /// Adds one sample, in the order of the log.
    pub fn add(&mut self, time_s: f64, values: &[f64]) {
        if self.count == 0 {
            self.first_s = time_s;
        } else if !std::mem::take(&mut self.restarted) {
            self.add_period(time_s - self.last_s);
        }
        if self.last_values != values {
            // NaN differs from itself: compare by bits before a change is counted
            let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
            let equal =
                self.last_values.len() == values.len() && self.last_values.iter().zip(values).all(same);
            self.changes += u64::from(self.count > 0 && !equal);
            self.last_values.clear();
            self.last_values.extend_from_slice(values);
        }
        self.nonzero |= values.iter().any(|value| *value != 0.0 && !value.is_nan());
        self.count += 1;
        self.last_s = time_s;
    }

    /// The vehicle's clock started anew: the period across is not one of the stream's.
    pub fn reset(&mut self) {
        if self.count > 0 {
            self.resets += 1;
            self.restarted = true;
        }
    }

    /// What was collected so far.
    #[must_use]
    pub fn stats(&self) -> StreamStats {
        let median_period_s = self.quantile_s(0.5);
        let is_gap = |bin: &&Bin| bin.count > 0 && bin.longest_s > GAP_PERIODS * median_period_s;
        let gaps = || self.bins.iter().filter(is_gap);
        let periods: u64 = self.bins.iter().map(|bin| bin.count).sum();
        let long: u64 = gaps().map(|bin| bin.count).sum();
        let in_bursts = long as f64 > RARE * periods as f64;
        let gaps = || gaps().filter(|_| !in_bursts);
        let gap_count: u64 = gaps().map(|bin| bin.count).sum();
        let gap_s: f64 = gaps().map(|bin| bin.sum_s).sum();
        let running_s = self.bins.iter().map(|bin| bin.sum_s).sum::<f64>() - gap_s;
        let has_rate = self.count >= LEAST_SAMPLES && running_s >= LEAST_SPAN_S;
        let any = self.count > 0;
        StreamStats {
            count: self.count,
            span_s: if any { (self.first_s, self.last_s) } else { (f64::NAN, f64::NAN) },
            rate_hz: if has_rate { (periods - gap_count) as f64 / running_s } else { f64::NAN },
            median_period_s,
            jitter_s: (self.quantile_s(0.84) - self.quantile_s(0.16)) / 2.0,
            gaps: gap_count,
            largest_gap_s: gaps().map(|bin| bin.longest_s).fold(0.0, f64::max),
            missing_s: if gap_count > 0 { gap_s - gap_count as f64 * median_period_s } else { 0.0 },
            backward: self.backward,
            repeated_stamps: self.repeated_stamps,
            resets: self.resets,
            changes: self.changes,
            all_zero: any && !self.nonzero,
        }
    }

    fn add_period(&mut self, period_s: f64) {
        if period_s <= 0.0 {
            self.backward += u64::from(period_s < 0.0);
            self.repeated_stamps += u64::from(period_s == 0.0);
            return;
        }
        if self.bins.is_empty() {
            self.bins = vec![Bin::default(); BINS];
        }
        let bin = &mut self.bins[bin_of(period_s)];
        bin.count += 1;
        bin.sum_s += period_s;
        bin.longest_s = bin.longest_s.max(period_s);
    }

    /// Period below which a share of the periods lies, as the mean of the bin it falls into.
    fn quantile_s(&self, share: f64) -> f64 {
        let total: u64 = self.bins.iter().map(|bin| bin.count).sum();
        let mut below = 0;
        for bin in self.bins.iter().filter(|bin| bin.count > 0) {
            below += bin.count;
            if below as f64 >= share * total as f64 {
                return bin.mean_s();
            }
        }
        f64::NAN
    }
}

/// The bin of a period: the last one whose lower edge is not above it.
fn bin_of(period_s: f64) -> usize {
    let bin = ((period_s / SHORTEST_S).log2() * BINS_AN_OCTAVE).clamp(0.0, (BINS - 1) as f64);
    // a checked way from f64 to an index: `bin` is within 0..BINS
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let index = bin as usize;
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stats(times_s: &[f64]) -> StreamStats {
        let values = times_s.iter().map(|time_s| time_s * 2.0).collect();
        StreamStats::of(&Stream { time_s: times_s.to_vec(), width: 1, values })
    }

    #[test]
    fn a_regular_stream_has_its_exact_period_and_no_gap() {
        let times: Vec<f64> = (0..1000).map(|index| f64::from(index) * 0.008).collect();
        let stats = stats(&times);
        assert!((stats.median_period_s - 0.008).abs() < 1e-9);
        assert!((stats.rate_hz - 125.0).abs() < 1e-6);
        assert_eq!((stats.count, stats.gaps, stats.backward), (1000, 0, 0));
        assert!(stats.jitter_s < 1e-9 && !stats.is_constant() && !stats.all_zero);
    }

    #[test]
    fn a_gap_is_counted_and_does_not_lower_the_rate() {
        let times: Vec<f64> =
            (0..500).map(|index| f64::from(index) * 0.02 + if index >= 250 { 1.0 } else { 0.0 }).collect();
        let stats = stats(&times);
        assert_eq!(stats.gaps, 1);
        assert!((stats.largest_gap_s - 1.02).abs() < 1e-9);
        assert!((stats.missing_s - 1.0).abs() < 1e-9);
        assert!((stats.rate_hz - 50.0).abs() < 1e-6);
    }

    #[test]
    fn jitter_is_half_of_the_middle_68_percent() {
        let mut time_s = 0.0;
        let times: Vec<f64> = (0..1001)
            .map(|index| {
                time_s += if index % 2 == 0 { 0.009 } else { 0.011 };
                time_s
            })
            .collect();
        assert!((stats(&times).jitter_s - 0.001).abs() < 1e-9);
    }

    #[test]
    fn silent_and_constant_streams_are_recognised() {
        let mut tally = StreamTally::default();
        for index in 0..10 {
            tally.add(f64::from(index), &[0.0, f64::NAN]);
        }
        assert!(tally.stats().is_constant() && tally.stats().all_zero);
        tally.add(10.0, &[1.0, f64::NAN]);
        assert!(!tally.stats().is_constant() && !tally.stats().all_zero);
    }

    #[test]
    fn a_restart_is_no_gap() {
        let mut tally = StreamTally::default();
        for index in 0..10 {
            tally.add(f64::from(index) * 0.1, &[1.0]);
        }
        tally.reset();
        for index in 0..10 {
            tally.add(100.0 + f64::from(index) * 0.1, &[1.0]);
        }
        assert_eq!((tally.stats().resets, tally.stats().gaps), (1, 0));
    }

    #[test]
    fn too_few_samples_have_no_rate() {
        assert!(stats(&[]).rate_hz.is_nan() && stats(&[]).span_s.0.is_nan());
        assert!(stats(&[1.0]).median_period_s.is_nan());
        // three within a tenth of a millisecond, and a thousand within a tenth of a second
        assert!(stats(&[1.0, 1.000_062, 1.000_124]).rate_hz.is_nan());
        let close: Vec<f64> = (0..1000).map(|index| f64::from(index) * 62e-6).collect();
        assert!(stats(&close).rate_hz.is_nan());
    }

    #[test]
    fn samples_in_bursts_have_the_rate_of_their_mean() {
        let times: Vec<f64> =
            (0..100).map(|index| f64::from(index / 2) + 62e-6 * f64::from(index % 2)).collect();
        let stats = stats(&times);
        assert!((stats.rate_hz - 2.0).abs() < 0.05 && stats.gaps == 0, "{stats:?}");
    }
}
