//! The vehicle's parameters as far as they matter for identification.

use std::collections::{BTreeMap, BTreeSet};

use super::inspection::ParameterSummary;
use crate::autopilot::{Autopilot, STACKS};
use crate::note::Note;
use crate::recording::ParameterChange;
use crate::signals::{changes_in_the_air, in_flight_parameters, resting_on_defaults};

/// Parameters kept; autopilots have about 1500.
const KEPT: usize = 10_000;
/// All that the log holds, in bounds.
#[derive(Debug, Clone, Default)]
pub(super) struct Parameters {
    values: BTreeMap<String, f64>,
    /// names of those that are defaults
    defaulted: BTreeSet<String>,
    dropped: u64,
    /// those that matter, while samples came
    changes: Vec<ParameterChange>,
    /// time of the last sample, s
    now_s: Option<f64>,
}

/// Changes kept.
const KEPT_CHANGES: usize = 1000;

impl Parameters {
    /// A sample of this time came, s.
    pub(super) fn at(&mut self, time_s: f64) {
        self.now_s = Some(time_s);
    }

    /// Those of an earlier reading of the same log.
    pub(super) fn read_again(self) -> Self {
        Self { changes: Vec::new(), now_s: None, ..self }
    }

    /// What is to be told of them: changes in the air (spans in s), and defaults in place of values.
    pub(super) fn notes(&self, autopilot: Autopilot, airborne_s: &[(f64, f64)]) -> Vec<Note> {
        let mut notes = changes_in_the_air(autopilot, &self.changes, airborne_s, &self.values);
        notes.extend(resting_on_defaults(autopilot, &self.defaulted, &self.values));
        notes
    }

    /// Takes the default of one; says whether it changes what identification reads.
    pub(super) fn take_default(&mut self, name: &str, value: f64) -> bool {
        if self.values.contains_key(name) || self.values.len() >= KEPT {
            return false;
        }
        self.values.insert(name.to_owned(), value);
        self.defaulted.insert(name.to_owned());
        is_relevant(name, value)
    }

    /// Of what changed, the values that stood longest in the air.
    pub(super) fn keep_airborne(&mut self, autopilot: Autopilot, airborne_s: &[(f64, f64)]) {
        self.values.extend(in_flight_parameters(autopilot, &self.changes, airborne_s));
    }

    /// Takes one; says whether it changes what identification reads.
    pub(super) fn take(&mut self, name: &str, value: f64) -> bool {
        if self.defaulted.remove(name) {
            self.values.remove(name);
        }
        if let Some(known) = self.values.get_mut(name) {
            let before = std::mem::replace(known, value);
            let changed = before.to_bits() != value.to_bits();
            let is_gain = || STACKS.iter().any(|stack| stack.outputs.is_gain(name));
            if let Some(time_s) = self.now_s.filter(|_| changed && self.changes.len() < KEPT_CHANGES)
                && (is_relevant(name, before) || is_relevant(name, value) || is_gain())
            {
                self.changes.push(ParameterChange { time_s, name: name.to_owned(), before, after: value });
            }
            return changed && is_relevant(name, value);
        }
        if self.values.len() >= KEPT {
            self.dropped += 1;
            return false;
        }
        self.values.insert(name.to_owned(), value);
        is_relevant(name, value)
    }

    /// Name and value of all.
    pub(super) fn values(&self) -> &BTreeMap<String, f64> {
        &self.values
    }

    /// What of the way from command to thrust the log should hold and does not.
    pub(super) fn missing_curve(&self, autopilot: Autopilot) -> Option<&'static str> {
        let outputs = &autopilot.stack()?.outputs;
        (!self.values.contains_key(outputs.expo)).then_some(outputs.recorded)
    }

    /// What to tell.
    pub(super) fn summary(&self) -> ParameterSummary {
        let relevant = self.values.iter().filter(|(name, value)| is_relevant(name, **value));
        ParameterSummary {
            count: self.values.len(),
            relevant: relevant.map(|(name, value)| (name.clone(), *value)).collect(),
            dropped: self.dropped,
        }
    }
}

/// It tells how a command becomes thrust or how the vehicle is built, of any autopilot.
fn is_relevant(name: &str, value: f64) -> bool {
    STACKS.iter().any(|stack| stack.outputs.is_relevant(name, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_matters_is_told_and_its_change_noticed() {
        let mut parameters = Parameters::default();
        assert!(parameters.take("MOT_THST_EXPO", 0.65));
        assert!(!parameters.take("MOT_THST_EXPO", 0.65));
        assert!(parameters.take("MOT_THST_EXPO", 0.6));
        assert!(!parameters.take("SERVO9_FUNCTION", 0.0));
        assert!(parameters.take("SERVO1_FUNCTION", 33.0));
        let summary = parameters.summary();
        assert_eq!((summary.count, summary.relevant.len()), (3, 2));
    }
}
