//! A stream during reading.

use super::stream::{Stream, StreamKey};
use super::value_range::most;

/// What putting a stream's samples in order took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StreamRepair {
    /// samples with a stamp that the stream has already, dropped
    pub duplicates: u64,
    /// samples that came after a later one, sorted in
    pub out_of_order: u64,
    /// samples with a value that no vehicle has, left out
    pub impossible: u64,
}

/// A stream while samples come to it.
#[derive(Debug)]
pub struct Growing {
    key: StreamKey,
    stream: Stream,
    repair: StreamRepair,
    /// a larger value is damage
    most: f64,
}

impl Growing {
    pub(super) fn new(key: StreamKey) -> Self {
        let most = most(key.quantity);
        Self { key, stream: Stream::default(), repair: StreamRepair::default(), most }
    }

    pub(super) fn key(&self) -> &StreamKey {
        &self.key
    }

    /// Stamps and values held so far.
    pub(super) fn numbers(&self) -> usize {
        self.stream.time_s.len() + self.stream.values.len()
    }

    /// Adds a sample at `time_s`, s of the recording's clock. Values that are missing at the end are zero.
    #[inline]
    pub fn push(&mut self, time_s: f64, values: &[f64]) {
        if values.iter().any(|value| value.abs() > self.most) {
            self.repair.impossible += 1;
            return;
        }
        if let Some(&last_s) = self.stream.time_s.last() {
            if time_s == last_s {
                self.repair.duplicates += 1;
                return;
            }
            self.repair.out_of_order += u64::from(time_s < last_s);
        }
        if values.len() > self.stream.width {
            self.widen(values.len());
        }
        self.stream.time_s.push(time_s);
        // of a length that is known they are stored without a call
        match *values {
            [one] => self.stream.values.push(one),
            [x, y, z] => self.stream.values.extend_from_slice(&[x, y, z]),
            [w, x, y, z] => self.stream.values.extend_from_slice(&[w, x, y, z]),
            _ => self.stream.values.extend_from_slice(values),
        }
        if values.len() < self.stream.width {
            self.stream.values.resize(self.stream.time_s.len() * self.stream.width, 0.0);
        }
    }

    /// The stream in the order of time, and what putting it in order took.
    pub(super) fn finish(mut self) -> (StreamKey, Stream, StreamRepair) {
        if self.repair.out_of_order > 0 {
            self.sort();
        }
        (self.key, self.stream, self.repair)
    }

    /// Makes room for channels that were zero so far.
    fn widen(&mut self, width: usize) {
        let stream = &mut self.stream;
        let mut values = Vec::with_capacity(stream.len().max(64) * width);
        for index in 0..stream.len() {
            values.extend_from_slice(stream.sample(index));
            values.resize((index + 1) * width, 0.0);
        }
        stream.values = values;
        stream.width = width;
    }

    /// Sorts by time; of samples with the same stamp the first stays.
    fn sort(&mut self) {
        let stream = &mut self.stream;
        let mut order: Vec<usize> = (0..stream.len()).collect();
        order.sort_by(|&a, &b| stream.time_s[a].total_cmp(&stream.time_s[b]));
        order.dedup_by(|b, a| stream.time_s[*a] == stream.time_s[*b]);
        self.repair.duplicates += (stream.len() - order.len()) as u64;
        let time_s = order.iter().map(|&index| stream.time_s[index]).collect();
        let values = order.iter().flat_map(|&index| stream.sample(index).iter().copied()).collect();
        *stream = Stream { time_s, width: stream.width, values };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Quantity;

    #[test]
    fn what_no_vehicle_has_is_left_out_and_counted() {
        let of = |quantity, values: &[f64]| {
            let mut growing = Growing::new(StreamKey { quantity, source: "IMU", instance: 0 });
            growing.push(0.0, &[1.0, 2.0, 3.0]);
            growing.push(0.1, values);
            let (_, stream, repair) = growing.finish();
            (stream.len(), repair.impossible)
        };
        assert_eq!(of(Quantity::SpecificForce, &[0.1, f64::NEG_INFINITY, 9.8]), (1, 1));
        assert_eq!(of(Quantity::SpecificForce, &[0.1, -1e30, 9.8]), (1, 1));
        // full scale of a sensor, a value that is not known, and where any value may be meant
        assert_eq!(of(Quantity::SpecificForce, &[320.0, f64::NAN, 9.8]), (2, 0));
        assert_eq!(of(Quantity::PositionSetpoint, &[1e30, 0.0, 0.0]), (2, 0));
    }
}
