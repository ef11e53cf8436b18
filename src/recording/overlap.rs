//! Whether two recordings hold the same flight, or parts of one.

use super::flight::Recording;
use super::quantity::Quantity;
use super::stream::Stream;
use std::collections::HashSet;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

/// Samples in a row that are the same in both only if they were recorded once: sensors are noisy.
const RUN: usize = 6;
/// Sensors whose noise makes every sample another.
const NOISY: [Quantity; 2] = [Quantity::AngularRate, Quantity::SpecificForce];

/// Share (0..1) of a recording's inertial samples at the times that count (s) that the other holds as well, in the same order with
/// the same values, whatever their times; of several streams the largest. 0 where neither body rates nor specific force are in both.
#[must_use]
pub fn shared_share(of: &Recording, other: &Recording, counts: impl Fn(f64) -> bool) -> f64 {
    NOISY
        .iter()
        .filter_map(|quantity| {
            let known: HashSet<u64> = streams(other, *quantity).flat_map(runs).map(|(_, run)| run).collect();
            streams(of, *quantity).filter_map(|stream| share(stream, &known, &counts)).reduce(f64::max)
        })
        .fold(0.0, f64::max)
}

fn streams(recording: &Recording, quantity: Quantity) -> impl Iterator<Item = &Stream> {
    recording.streams.iter().filter(move |(key, _)| key.quantity == quantity).map(|(_, stream)| stream)
}

fn share(stream: &Stream, known: &HashSet<u64>, counts: impl Fn(f64) -> bool) -> Option<f64> {
    let (mut all, mut same) = (0_usize, 0_usize);
    for (_, run) in runs(stream).filter(|(time_s, _)| counts(*time_s)) {
        all += 1;
        same += usize::from(known.contains(&run));
    }
    (all > 0).then(|| same as f64 / all as f64)
}

/// Hashes of every few samples in a row, each with the time of the first, s; a sensor that stands still is left out.
fn runs(stream: &Stream) -> impl Iterator<Item = (f64, u64)> {
    let width = stream.width.max(1);
    let samples: Vec<&[f64]> = stream.values.chunks_exact(width).collect();
    (0..samples.len().saturating_sub(RUN - 1)).filter_map(move |first| {
        let run = &samples[first..first + RUN];
        if run.windows(2).any(|pair| pair[0] == pair[1]) {
            return None;
        }
        let mut hasher = DefaultHasher::new();
        run.iter().flat_map(|sample| sample.iter()).for_each(|value| value.to_bits().hash(&mut hasher));
        Some((stream.time_s[first], hasher.finish()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::StreamKey;

    /// Samples `from..to` of a sensor that never shows the same twice.
    fn recording(from: u32, to: u32, shift_s: f64) -> Recording {
        let mut stream = Stream { width: 3, ..Stream::default() };
        for index in from..to {
            let t = f64::from(index);
            stream.time_s.push(0.01 * t + shift_s);
            stream.values.extend([(0.7 * t).sin(), (1.3 * t).cos(), (t * t).sin()]);
        }
        let key = StreamKey { quantity: Quantity::AngularRate, source: "TEST", instance: 0 };
        Recording { streams: [(key, stream)].into(), ..Recording::default() }
    }

    #[test]
    fn a_part_of_a_flight_is_found_whatever_its_clock_says() {
        let whole = recording(0, 1000, 0.0);
        let share = |of: &Recording| shared_share(of, &whole, |_| true);
        assert_eq!(share(&recording(100, 300, 7.0)), 1.0);
        let half = share(&recording(500, 1500, 0.0));
        assert!((half - 0.5).abs() < 0.01, "{half}");
        assert_eq!(share(&recording(2000, 2500, 0.0)), 0.0);
        assert_eq!(share(&Recording::default()), 0.0);
    }

    #[test]
    fn only_what_counts_is_compared() {
        // a simulator repeats its noise from its start, until the vehicle moves at 10 s
        let (whole, half) = (recording(0, 1000, 0.0), recording(500, 1500, 0.0));
        assert_eq!(shared_share(&half, &whole, |time_s| time_s > 10.0), 0.0);
        assert_eq!(shared_share(&half, &whole, |time_s| time_s < 9.0), 1.0);
    }
}
