//! Whether two recordings hold the same flight, or parts of one.

use super::flight::Recording;
use super::quantity::Quantity;
use super::stream::Stream;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

/// Samples in a row that are the same in both only if they were recorded once: sensors are noisy. Telemetry rounds body rates to a thousandth
/// of a rad/s, and six in a row of a calm flight were found in another one by chance.
const RUN: usize = 10;
/// Sensors whose noise makes every sample another.
const NOISY: [Quantity; 2] = [Quantity::AngularRate, Quantity::SpecificForce];

/// Flights that go on for so long after the last sample that both hold are two, s, if they have less than [`ALIKE_AT_FIRST`] in common: a
/// simulator repeats the noise of its sensors from its start, and two of its flights may begin alike.
const PARTED_S: f64 = 5.0;
/// See [`PARTED_S`]. A takeoff is less of a flight.
const ALIKE_AT_FIRST: f64 = 0.2;

/// Most samples of a stream that are looked for in another recording, spread evenly over it.
const LOOKED_FOR: usize = 4096;

/// What a recording's inertial sensors said, by which a part of it is known in another recording.
#[derive(Debug, Clone)]
pub struct Overlap {
    /// of each of [`NOISY`]
    sensors: [Sensor; 2],
}

/// Hashes of what one kind of sensor said, all streams of it.
#[derive(Debug, Clone, Default)]
struct Sensor {
    /// of all times, in ascending order
    known: Vec<u64>,
    /// of each stream, of the times that count, with these in s: at most [`LOOKED_FOR`]
    counted: Vec<Vec<(f64, u64)>>,
}

impl Sensor {
    fn holds(&self, run: u64) -> bool {
        self.known.binary_search(&run).is_ok()
    }

    /// Seconds that count after the last sample that the other one holds as well; of several streams the least.
    fn after_shared_with(&self, other: &Self) -> f64 {
        let after = |of: &Vec<(f64, u64)>| {
            let last_s = of.iter().rev().find(|(_, run)| other.holds(*run))?.0;
            Some(of.last()?.0 - last_s)
        };
        self.counted.iter().filter_map(after).fold(f64::INFINITY, f64::min)
    }
}

impl Overlap {
    /// Of a recording; `counts` says at which times (s) its samples are looked for in others.
    #[must_use]
    pub fn of(recording: &Recording, counts: impl Fn(f64) -> bool) -> Self {
        let sensor = |quantity| {
            let mut sensor = Sensor::default();
            for stream in streams(recording, quantity) {
                let of_stream: Vec<(f64, u64)> = runs(stream).collect();
                sensor.known.extend(of_stream.iter().map(|(_, run)| run));
                let counted: Vec<(f64, u64)> =
                    of_stream.into_iter().filter(|(time_s, _)| counts(*time_s)).collect();
                let every = counted.len().div_ceil(LOOKED_FOR).max(1);
                sensor.counted.push(counted.into_iter().step_by(every).collect());
            }
            sensor.known.sort_unstable();
            sensor
        };
        Self { sensors: NOISY.map(sensor) }
    }

    /// Share (0..1) of its samples that count that the other recording holds as well, in the same order with the same values, whatever
    /// their times; of several streams the largest. 0 where neither body rates nor specific force are in both, and where both begin alike
    /// and part then.
    #[must_use]
    pub fn share_in(&self, other: &Self) -> f64 {
        let of_sensor = |(own, other): (&Sensor, &Sensor)| {
            let goes_on_s = own.after_shared_with(other).min(other.after_shared_with(own));
            let share = |runs: &Vec<(f64, u64)>| {
                let same = runs.iter().filter(|(_, run)| other.holds(*run)).count();
                let share = if runs.is_empty() { 0.0 } else { same as f64 / runs.len() as f64 };
                if goes_on_s > PARTED_S && share < ALIKE_AT_FIRST { 0.0 } else { share }
            };
            own.counted.iter().map(share).fold(0.0, f64::max)
        };
        self.sensors.iter().zip(&other.sensors).map(of_sensor).fold(0.0, f64::max)
    }
}

fn streams(recording: &Recording, quantity: Quantity) -> impl Iterator<Item = &Stream> {
    recording.streams.iter().filter(move |(key, _)| key.quantity == quantity).map(|(_, stream)| stream)
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
        let whole = Overlap::of(&recording(0, 1000, 0.0), |_| true);
        let share = |of: &Recording| Overlap::of(of, |_| true).share_in(&whole);
        assert_eq!(share(&recording(100, 300, 7.0)), 1.0);
        let half = share(&recording(500, 1500, 0.0));
        assert!((half - 0.5).abs() < 0.01, "{half}");
        assert_eq!(share(&recording(2000, 2500, 0.0)), 0.0);
        assert_eq!(share(&Recording::default()), 0.0);
    }

    #[test]
    fn flights_that_begin_alike_and_part_are_two() {
        let begin = recording(0, 200, 0.0);
        let with = |from: u32| {
            let mut all = begin.clone();
            let rest = recording(from, from + 1000, 2.0 - 0.01 * f64::from(from));
            for (key, stream) in &mut all.streams {
                let rest = &rest.streams[key];
                stream.time_s.extend(&rest.time_s);
                stream.values.extend(&rest.values);
            }
            Overlap::of(&all, |_| true)
        };
        let (one, other) = (with(2000), with(5000));
        assert_eq!((one.share_in(&other), other.share_in(&one)), (0.0, 0.0));
        // what ends where both do is a part
        let part = Overlap::of(&begin, |_| true);
        assert!(part.share_in(&one) == 1.0 && one.share_in(&part) > 0.1);
    }

    #[test]
    fn a_long_recording_is_looked_for_in_samples() {
        let (long, half) = (recording(0, 20_000, 0.0), recording(0, 10_000, 3.0));
        let [long, half] = [long, half].map(|of| Overlap::of(&of, |_| true));
        assert!((long.share_in(&half) - 0.5).abs() < 0.01 && half.share_in(&long) == 1.0);
    }

    #[test]
    fn only_what_counts_is_compared() {
        // a simulator repeats its noise from its start, until the vehicle moves at 10 s
        let (whole, half) = (Overlap::of(&recording(0, 1000, 0.0), |_| true), recording(500, 1500, 0.0));
        assert_eq!(Overlap::of(&half, |time_s| time_s > 10.0).share_in(&whole), 0.0);
        assert_eq!(Overlap::of(&half, |time_s| time_s < 9.0).share_in(&whole), 1.0);
    }
}
