//! The last samples of one stream.

use std::collections::VecDeque;

/// Values of one sample: as many channels as MAVLink's actuator messages have in use.
pub(super) const WIDTH: usize = 16;
/// One sample; channels that were not sent are zero.
pub(super) type Sample = [f64; WIDTH];

/// Samples kept: more than a second at 100 Hz, half a second at 250 Hz.
const KEPT: usize = 128;
/// A longer pause is a gap, s. Twelve samples at 100 Hz; only the live view depends on it.
const GAP_S: f64 = 0.12;

/// The value of a stream at an instant.
pub(super) enum At {
    /// between two samples, by linear interpolation
    Value(Sample),
    /// in a gap, or before the first kept sample
    Gap,
}

/// The last samples of one stream, in the order of their time stamps.
#[derive(Debug)]
pub(super) struct Track {
    samples: VecDeque<(f64, Sample)>,
}

impl Track {
    pub(super) fn new() -> Self {
        Self { samples: VecDeque::with_capacity(KEPT) }
    }

    /// Adds a sample; one that is not later than the last is left out.
    pub(super) fn push(&mut self, time_s: f64, values: &[f64]) {
        if self.newest_s().is_some_and(|newest_s| time_s <= newest_s) {
            return;
        }
        if self.samples.len() == KEPT {
            self.samples.pop_front();
        }
        let mut sample = [0.0; WIDTH];
        for (to, from) in sample.iter_mut().zip(values) {
            *to = *from;
        }
        self.samples.push_back((time_s, sample));
    }

    pub(super) fn newest_s(&self) -> Option<f64> {
        self.samples.back().map(|(time_s, _)| *time_s)
    }

    /// The samples on both sides of an instant, and its relative position between them (0..1).
    pub(super) fn around(&self, time_s: f64) -> Option<(&Sample, &Sample, f64)> {
        let next = self.samples.partition_point(|(stamp_s, _)| *stamp_s < time_s);
        let (after_s, after) = self.samples.get(next)?;
        if *after_s <= time_s {
            return Some((after, after, 0.0));
        }
        let (before_s, before) = self.samples.get(next.checked_sub(1)?)?;
        let period_s = after_s - before_s;
        (period_s <= GAP_S).then(|| (before, after, (time_s - before_s) / period_s))
    }

    pub(super) fn at(&self, time_s: f64) -> At {
        let Some((before, after, share)) = self.around(time_s) else { return At::Gap };
        let mut sample = [0.0; WIDTH];
        for (channel, value) in sample.iter_mut().enumerate() {
            *value = before[channel] + share * (after[channel] - before[channel]);
        }
        if sample.iter().all(|value| value.is_finite()) { At::Value(sample) } else { At::Gap }
    }

    pub(super) fn clear(&mut self) {
        self.samples.clear();
    }
}
