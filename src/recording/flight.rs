//! A flight as typed streams on the vehicle's own clock.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::leaps::{leave_out, leave_out_strays};
use super::quantity::Quantity;
use super::stream::{Stream, StreamKey};
use crate::autopilot::Autopilot;

/// A parameter that got another value while a flight was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterChange {
    /// s of the recording's clock: of the sample before it
    pub time_s: f64,
    /// name
    pub name: String,
    /// value until then, in the autopilot's own unit
    pub before: f64,
    /// value since then
    pub after: f64,
}

/// A flight of one vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// all streams
    pub streams: BTreeMap<StreamKey, Stream>,
    /// the vehicle's parameters as far as they were sent
    pub parameters: BTreeMap<String, f64>,
    /// names of those of them whose value was not sent: they are the defaults that the autopilot stated
    pub defaulted: BTreeSet<String>,
    /// what of them changed while it was recorded, in the order of time; [`Self::parameters`] has the last values
    pub parameter_changes: Vec<ParameterChange>,
    /// which autopilot wrote it
    pub autopilot: Autopilot,
    /// times at which the vehicle's clock started anew (reboot); no flight segment may span one
    pub clock_resets_s: Vec<f64>,
    /// times at which the position estimate jumped (ODOMETRY.reset_counter)
    pub estimator_resets_s: Vec<f64>,
    /// its log is damaged and has no checksums: a word of it may be missing or wrong
    pub is_damaged: bool,
    /// what the vehicle said
    pub texts: Vec<(f64, String)>,
}

impl Recording {
    /// Of a damaged log: leaves out the samples that leap away from those around them and back; how many these are.
    pub fn leave_out_leaps(&mut self) -> u64 {
        self.is_damaged = true;
        let strays = leave_out_strays(&mut self.streams);
        let streams: Vec<_> = self.streams.iter_mut().collect();
        let leaps: u64 = streams.into_par_iter().map(|(key, stream)| leave_out(key.quantity, stream)).sum();
        strays + leaps
    }

    /// Leaves out everything from this time on, s.
    pub fn end_at(&mut self, time_s: f64) {
        for stream in self.streams.values_mut() {
            let kept = stream.time_s.partition_point(|stamp_s| *stamp_s < time_s);
            stream.time_s.truncate(kept);
            stream.values.truncate(kept * stream.width);
        }
        self.parameter_changes.retain(|change| change.time_s < time_s);
    }

    /// Whether the vehicle said last that it is disarmed.
    #[must_use]
    pub fn ends_disarmed(&self) -> bool {
        let said = self.streams.iter().filter(|(key, _)| key.quantity == Quantity::Armed);
        said.filter_map(|(_, stream)| Some((*stream.time_s.last()?, *stream.values.last()?)))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .is_some_and(|(_, armed)| armed < 0.5)
    }

    /// Adds the streams of another log of the same flight, its stamps brought to this recording's clock by `to_own_s` (s to s).
    /// Of streams and parameters that both have, its own stay. Times of resets are in order, those of both logs.
    pub fn add_log(&mut self, other: Recording, to_own_s: impl Fn(f64) -> f64) {
        for (key, mut stream) in other.streams {
            stream.time_s.iter_mut().for_each(|time_s| *time_s = to_own_s(*time_s));
            self.streams.entry(key).or_insert(stream);
        }
        for (name, value) in other.parameters {
            let is_default = other.defaulted.contains(&name);
            if !self.parameters.contains_key(&name) || self.defaulted.contains(&name) && !is_default {
                if is_default {
                    self.defaulted.insert(name.clone());
                } else {
                    self.defaulted.remove(&name);
                }
                self.parameters.insert(name, value);
            }
        }
        let resets = [
            (&mut self.clock_resets_s, other.clock_resets_s),
            (&mut self.estimator_resets_s, other.estimator_resets_s),
        ];
        for (own, other) in resets {
            own.extend(other.into_iter().map(&to_own_s));
            own.sort_by(f64::total_cmp);
        }
        if self.texts.is_empty() {
            self.texts = other.texts.into_iter().map(|(time_s, text)| (to_own_s(time_s), text)).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resets_of_two_logs_are_in_order() {
        let with = |clock: [f64; 2], estimator: [f64; 1]| Recording {
            clock_resets_s: clock.to_vec(),
            estimator_resets_s: estimator.to_vec(),
            ..Recording::default()
        };
        let mut own = with([5.0, 40.0], [30.0]);
        own.add_log(with([11.0, 61.0], [21.0]), |time_s| time_s - 1.0);
        assert_eq!(own.clock_resets_s, [5.0, 10.0, 40.0, 60.0]);
        assert_eq!(own.estimator_resets_s, [20.0, 30.0]);
    }

    #[test]
    fn the_last_word_of_all_streams_says_whether_the_vehicle_is_disarmed() {
        let said = |source, samples: [(f64, f64); 2]| {
            let (time_s, values) = samples.into_iter().unzip();
            (
                StreamKey { quantity: Quantity::Armed, source, instance: 0 },
                Stream { time_s, width: 1, values },
            )
        };
        let of = |streams: &[(StreamKey, Stream)]| Recording {
            streams: streams.iter().cloned().collect(),
            ..Recording::default()
        };
        let (armed, disarmed) = (said("EV", [(1.0, 0.0), (3.0, 1.0)]), said("ARM", [(1.0, 1.0), (9.0, 0.0)]));
        assert!(of(&[armed.clone(), disarmed]).ends_disarmed());
        assert!(!of(&[armed]).ends_disarmed() && !of(&[]).ends_disarmed());
    }
}
