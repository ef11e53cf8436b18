//! How each stream runs.

use super::inspection::StreamSummary;
use crate::recording::{Quantity, StreamKey, StreamStats, StreamTally};

/// Tallies of all streams of a log.
#[derive(Debug, Default)]
pub(super) struct StreamTallies {
    tallies: Vec<(StreamKey, usize, StreamTally)>,
    /// where the last sample went: messages bring their quantities in the same order again and again
    next: usize,
}

impl StreamTallies {
    /// Adds a sample.
    pub(super) fn add(&mut self, stream: StreamKey, time_s: f64, values: &[f64]) {
        let expected = self.tallies.get(self.next).is_some_and(|(id, ..)| *id == stream);
        let index = if expected { self.next } else { self.find(stream) };
        self.next = index + 1;
        let (_, width, tally) = &mut self.tallies[index];
        *width = values.len().max(*width);
        tally.add(time_s, values);
    }

    fn find(&mut self, stream: StreamKey) -> usize {
        self.tallies.iter().position(|(id, ..)| *id == stream).unwrap_or_else(|| {
            self.tallies.push((stream, 0, StreamTally::default()));
            self.tallies.len() - 1
        })
    }

    /// The vehicle's clock restarted.
    pub(super) fn reset(&mut self) {
        self.tallies.iter_mut().for_each(|(_, _, tally)| tally.reset());
    }

    /// What was collected, in the order of keys.
    pub(super) fn summary(&self) -> Vec<(StreamKey, usize, StreamStats)> {
        let mut all: Vec<_> =
            self.tallies.iter().map(|(id, width, tally)| (*id, *width, tally.stats())).collect();
        all.sort_by_key(|(key, ..)| *key);
        all
    }
}

/// Steps back in time of a stream that stand for more than late messages, at least, and as a share of its samples.
const LEAST_BACKWARD: u64 = 10;
const BACKWARD: f64 = 0.01;
/// Samples beyond which a log is not sorted in memory.
const SORTED: u64 = 20_000_000;

/// Whether samples stand in another order than that of time, as in a file whose pieces were put together wrongly.
pub(super) fn is_disordered(streams: &[(StreamKey, usize, StreamStats)]) -> bool {
    let back = |stats: &StreamStats| {
        stats.backward >= LEAST_BACKWARD && stats.backward as f64 > BACKWARD * stats.count as f64
    };
    let samples: u64 = streams.iter().map(|(.., stats)| stats.count).sum();
    samples <= SORTED && streams.iter().any(|(.., stats)| back(stats))
}

/// Of ArduPilot's states, whichever message tells them.
const REPEATED: &str = "EV";

/// A stream as it is told.
pub(super) fn summary_of((key, width, stats): &(StreamKey, usize, StreamStats)) -> StreamSummary {
    // a log that writes states when they change has no rate of them: its reader gives each again and again
    let is_repeated = key.source == REPEATED;
    let unless_repeated = |value: f64| if is_repeated { f64::NAN } else { value };
    StreamSummary {
        quantity: key.quantity.name(),
        source: key.source,
        instance: key.instance,
        width: *width,
        count: if is_repeated { stats.changes + 1 } else { stats.count },
        span_s: stats.span_s,
        rate_hz: unless_repeated(stats.rate_hz),
        median_period_s: unless_repeated(stats.median_period_s),
        jitter_s: unless_repeated(stats.jitter_s),
        gaps: if is_repeated { 0 } else { stats.gaps },
        largest_gap_s: if is_repeated { 0.0 } else { stats.largest_gap_s },
        missing_s: if is_repeated { 0.0 } else { stats.missing_s },
        backward: stats.backward,
        repeated_stamps: stats.repeated_stamps,
        resets: stats.resets,
        state: state(key.quantity, stats),
    }
}

/// `zero` and `constant` only where a value that never moves is a fault: a mode may well stay.
fn state(quantity: Quantity, stats: &StreamStats) -> &'static str {
    let may_stay = matches!(
        quantity,
        Quantity::Mode
            | Quantity::Armed
            | Quantity::LandedState
            | Quantity::BatteryVoltage
            | Quantity::BatteryCurrent
            | Quantity::PositionSetpoint
            | Quantity::VelocitySetpoint
            | Quantity::AccelerationSetpoint
            | Quantity::YawSetpoint
            | Quantity::YawRateSetpoint
            | Quantity::AttitudeSetpoint
            | Quantity::AngularRateSetpoint
            | Quantity::ThrustSetpoint
            | Quantity::TorqueSetpoint
            | Quantity::ThrustVectorSetpoint
    );
    match stats {
        _ if may_stay => "live",
        stats if stats.all_zero => "zero",
        stats if stats.is_constant() => "constant",
        _ => "live",
    }
}
