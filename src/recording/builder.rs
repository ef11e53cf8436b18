//! Collects events into a recording.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::event::Event;
use super::flight::{ParameterChange, Recording};
use super::growing::{Growing, StreamRepair};
use super::stream::StreamKey;

/// Collects events into a [`Recording`].
#[derive(Debug, Default)]
pub struct RecordingBuilder {
    streams: Vec<Growing>,
    /// for each quantity, where its streams are in `streams`
    by_quantity: Vec<Vec<usize>>,
    rest: Recording,
    numbers: usize,
    /// time of the last sample, s: when a parameter changes is not said otherwise
    now_s: Option<f64>,
}

/// Changes of parameters that are kept: a vehicle that tunes itself makes hundreds.
const MOST_CHANGES: usize = 10_000;

impl RecordingBuilder {
    /// Nothing collected yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds what one event says.
    pub fn add(&mut self, event: Event<'_>) {
        match event {
            Event::Autopilot(autopilot) => self.rest.autopilot = autopilot,
            Event::Sample { stream, time_s, values } => {
                let place = self.place(stream);
                let growing = &mut self.streams[place];
                let before = growing.numbers();
                growing.push(time_s, values);
                let added = growing.numbers() - before;
                self.numbers += added;
                self.now_s = Some(time_s);
            }
            Event::Parameter { name, value } => self.parameter(name, value),
            Event::ParameterDefault { name, value } => self.default_value(name, value),
            Event::Text { time_s, text, .. } => self.rest.texts.push((time_s, text.to_owned())),
            Event::ClockReset { time_s, .. } => self.rest.clock_resets_s.push(time_s),
            Event::EstimatorReset { time_s } => self.rest.estimator_resets_s.push(time_s),
        }
    }

    fn default_value(&mut self, name: &str, value: f64) {
        if !self.rest.parameters.contains_key(name) {
            self.rest.parameters.insert(name.to_owned(), value);
            self.rest.defaulted.insert(name.to_owned());
        }
    }

    fn parameter(&mut self, name: &str, value: f64) {
        let before = self.rest.parameters.insert(name.to_owned(), value);
        if self.rest.defaulted.remove(name) {
            return;
        }
        let changed = before.filter(|before| before.to_bits() != value.to_bits()).zip(self.now_s);
        let changes = &mut self.rest.parameter_changes;
        if let Some((before, time_s)) = changed.filter(|_| changes.len() < MOST_CHANGES) {
            changes.push(ParameterChange { time_s, name: name.to_owned(), before, after: value });
        }
    }

    /// Stamps and values held so far.
    #[must_use]
    pub fn numbers(&self) -> usize {
        self.numbers
    }

    /// The recording, each stream in the order of time, and what putting it in order took.
    #[must_use]
    pub fn finish(mut self) -> (Recording, BTreeMap<StreamKey, StreamRepair>) {
        let mut repairs = BTreeMap::new();
        let given = self.streams.into_iter().filter(|growing| growing.numbers() > 0);
        for (key, stream, repair) in given.map(Growing::finish) {
            repairs.insert(key, repair);
            self.rest.streams.insert(key, stream);
        }
        (self.rest, repairs)
    }

    /// Fills streams side by side, each by `fill` from its [place](Self::place): what it gives is the samples' order in the log
    /// and the time, s, of the last one that it added, or `None` where it added none.
    pub fn fill(&mut self, fill: impl Fn(usize, &mut Growing) -> Option<(usize, f64)> + Sync) {
        let filled = self.streams.par_iter_mut().with_max_len(1).enumerate();
        let last = filled.filter_map(|(place, growing)| fill(place, growing)).max_by_key(|(order, _)| *order);
        self.now_s = last.map(|(_, time_s)| time_s).or(self.now_s);
        self.numbers = self.streams.iter().map(Growing::numbers).sum();
    }

    /// Where the stream of a key is among those that are collected. One that no sample comes to is not in the recording.
    pub fn place(&mut self, key: StreamKey) -> usize {
        let quantity = key.quantity as usize;
        if quantity >= self.by_quantity.len() {
            self.by_quantity.resize(quantity + 1, Vec::new());
        }
        let of_quantity = &mut self.by_quantity[quantity];
        // names are compared by where they stand first: a reader gives the same one each time
        let at = |is_same: fn(&StreamKey, &StreamKey) -> bool| {
            of_quantity.iter().copied().find(|&index| is_same(self.streams[index].key(), &key))
        };
        let stands_there =
            |a: &StreamKey, b: &StreamKey| a.instance == b.instance && std::ptr::eq(a.source, b.source);
        at(stands_there).or_else(|| at(|a, b| a == b)).unwrap_or_else(|| {
            of_quantity.push(self.streams.len());
            self.streams.push(Growing::new(key));
            self.streams.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Quantity;

    #[test]
    fn a_parameter_that_changes_while_samples_come_keeps_both_values_and_the_time() {
        let mut builder = RecordingBuilder::new();
        let stream = StreamKey { quantity: Quantity::Armed, source: "EV", instance: 0 };
        let told = |value| Event::Parameter { name: "MOT_THST_EXPO", value };
        let sample = |time_s| Event::Sample { stream, time_s, values: &[1.0] };
        // before the first sample, the same again, and another one
        for event in [told(0.5), told(0.65), sample(1.0), told(0.65), sample(2.0), told(0.7), sample(3.0)] {
            builder.add(event);
        }
        let (recording, _) = builder.finish();
        let change =
            ParameterChange { time_s: 2.0, name: "MOT_THST_EXPO".to_owned(), before: 0.65, after: 0.7 };
        assert_eq!(recording.parameter_changes, [change]);
        assert_eq!(recording.parameters["MOT_THST_EXPO"], 0.7);
    }

    #[test]
    fn a_default_stands_where_no_value_was_sent() {
        let told = |name, value| Event::Parameter { name, value };
        let default = |name, value| Event::ParameterDefault { name, value };
        let built = |events: &[Event<'_>]| {
            let mut builder = RecordingBuilder::new();
            events.iter().for_each(|event| builder.add(*event));
            builder.finish().0
        };
        let mut recording =
            built(&[told("A", 1.0), default("A", 0.0), default("B", 2.0), default("C", 3.0), told("C", 4.0)]);
        let stands = |recording: &Recording| {
            let names: Vec<String> = recording.defaulted.iter().cloned().collect();
            (recording.parameters.values().copied().collect::<Vec<_>>(), names.join(" "))
        };
        assert_eq!(stands(&recording), (vec![1.0, 2.0, 4.0], "B".to_owned()));
        assert_eq!(recording.parameter_changes, []);
        // another log of the flight has it
        recording.add_log(built(&[told("B", 5.0), default("A", 9.0), default("D", 6.0)]), |time_s| time_s);
        assert_eq!(stands(&recording), (vec![1.0, 5.0, 4.0, 6.0], "D".to_owned()));
    }
}
