//! A few parameters of a vehicle: read, and set to other values.

use std::collections::BTreeMap;
use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::asked::Asked;
use super::pace::Pace;
use super::parameter_value::ParameterValue;
use super::peer::Peer;
use super::{Dialogue, FetchError};
use crate::wire::{Frame, Vehicle};

/// Tries of each: a parameter that the vehicle does not have never answers.
const READ_TRIES: u32 = 6;
const SET_TRIES: u32 = 12;
/// Between two requests: autopilots keep few of them.
const SPACING: Duration = Duration::from_millis(10);

/// Values by name; those that did not answer are not in it.
#[derive(Debug, Clone, Default)]
pub struct Known(BTreeMap<String, ParameterValue>);

impl Known {
    /// The value of a parameter.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.0.get(name).map(|parameter| parameter.value)
    }

    /// Whether a parameter takes whole numbers alone.
    #[must_use]
    pub fn is_whole(&self, name: &str) -> bool {
        self.0.get(name).is_some_and(ParameterValue::is_whole)
    }
}

/// Reads some parameters.
#[derive(Debug)]
pub struct ReadParameters {
    peer: Peer,
    pace: Pace,
    items: Vec<(String, Asked, bool)>,
    known: Known,
    sent: Option<Duration>,
}

impl ReadParameters {
    /// Of this vehicle, by their names.
    ///
    /// # Errors
    /// No message can name the vehicle.
    pub fn new(vehicle: Vehicle, names: &[&str]) -> Result<Self, FetchError> {
        let items = names.iter().map(|name| ((*name).to_owned(), Asked::default(), false)).collect();
        Ok(Self {
            peer: Peer::of(vehicle)?,
            pace: Pace::default(),
            items,
            known: Known::default(),
            sent: None,
        })
    }

    /// How many have answered, or are not waited for any more, of how many.
    #[must_use]
    pub fn progress(&self) -> (usize, usize) {
        (self.items.iter().filter(|(.., settled)| *settled).count(), self.items.len())
    }

    /// What came.
    #[must_use]
    pub fn known(self) -> Known {
        self.known
    }
}

impl Dialogue for ReadParameters {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if self.sent.is_some_and(|sent| now < sent + SPACING) {
            return Ok(None);
        }
        for (name, asked, settled) in &mut self.items {
            if *settled || !asked.is_due(now, &self.pace) {
                continue;
            }
            if asked.send_at_most(READ_TRIES, now, "").is_err() {
                *settled = true;
                continue;
            }
            self.sent = Some(now);
            return Ok(Some(self.peer.request_parameter(name)));
        }
        Ok(None)
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        let Some((name, value)) = ParameterValue::heard(&self.peer, frame) else { return };
        if let Some((_, asked, settled)) = self.items.iter_mut().find(|(wanted, ..)| *wanted == name) {
            asked.answered(now, &mut self.pace);
            *settled = true;
            self.known.0.insert(name, value);
        }
    }

    fn is_done(&self) -> bool {
        self.items.iter().all(|(.., settled)| *settled)
    }
}

#[derive(Debug)]
struct Setting {
    name: String,
    was: ParameterValue,
    requested: f64,
    came: Option<f64>,
    asked: Asked,
    /// it was asked for often enough
    given_up: bool,
}

impl Setting {
    /// To the precision of the message.
    fn is_settled(&self) -> bool {
        self.came.is_some_and(|came| (came - self.requested).abs() <= 1e-6 * self.requested.abs().max(1.0))
    }
}

/// Sets some parameters, and waits until the vehicle says each new value or was asked for it often enough.
#[derive(Debug)]
pub struct SetParameters {
    peer: Peer,
    pace: Pace,
    items: Vec<Setting>,
}

impl SetParameters {
    /// Of this vehicle; those that are not known are left out, their type being not known.
    ///
    /// # Errors
    /// No message can name the vehicle.
    pub fn new(vehicle: Vehicle, known: &Known, wanted: &[(&str, f64)]) -> Result<Self, FetchError> {
        let setting = |(name, wanted): &(&str, f64)| {
            let was = *known.0.get(*name)?;
            Some(Setting {
                name: (*name).to_owned(),
                was,
                requested: *wanted,
                came: None,
                asked: Asked::default(),
                given_up: false,
            })
        };
        let items = wanted.iter().filter_map(setting).collect();
        Ok(Self { peer: Peer::of(vehicle)?, pace: Pace::default(), items })
    }

    /// Names of those that are not what was asked for, and why.
    pub fn failures(&self) -> impl Iterator<Item = (&str, FetchError)> {
        self.items.iter().filter(|item| !item.is_settled()).map(|item| {
            let came =
                item.came.map_or_else(|| "nothing".to_owned(), |came| format!("{} = {came}", item.name));
            let failure = FetchError::NotSet { name: item.name.clone(), requested: item.requested, came };
            (item.name.as_str(), failure)
        })
    }
}

impl Dialogue for SetParameters {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        for item in &mut self.items {
            if item.is_settled() || item.given_up || !item.asked.is_due(now, &self.pace) {
                continue;
            }
            if item.asked.send_at_most(SET_TRIES, now, "").is_err() {
                // the others are set all the same
                item.given_up = true;
                continue;
            }
            let value = item.was.encoded(&self.peer, item.requested);
            return Ok(Some(self.peer.set_parameter(&item.name, value, item.was.of_type)));
        }
        Ok(None)
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        let Some((name, value)) = ParameterValue::heard(&self.peer, frame) else { return };
        if let Some(item) = self.items.iter_mut().find(|item| item.name == name) {
            item.asked.answered(now, &mut self.pace);
            item.came = Some(value.value);
        }
    }

    fn is_done(&self) -> bool {
        self.items.iter().all(|item| item.is_settled() || item.given_up)
    }
}
