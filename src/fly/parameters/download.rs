//! Download of parameters by name, until each has answered or was requested often enough.

use super::{Parameters, RequestedParameter};
use crate::fly::address::is_from;
use crate::fly::target::{ParameterName, Target};
use crate::recording::Event;
use crate::wire::message_id::PARAM_ERROR;
use crate::wire::{Frame, Vehicle};
use mavlink::dialects::ardupilotmega::MavMessage;
use std::collections::BTreeMap;
use std::time::Duration;

/// The error that says that there is no such parameter: MAV_PARAM_ERROR_DOES_NOT_EXIST.
const DOES_NOT_EXIST: u8 = 1;
/// Largest probability with which an existing parameter is given up. A parameter that is given up is told as absent:
/// one false word in ten thousand downloads.
const GIVEN_UP: f64 = 1e-4;
/// Least and largest number of requests of a parameter.
const TRIES: (u32, u32) = (3, 12);

/// Timing of the requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DownloadSettings {
    /// between two requests
    pub spacing: Duration,
    /// time until a request counts as lost
    pub timeout: Duration,
}

impl Default for DownloadSettings {
    /// 100 requests a second, 3 kB/s; an answer within a second.
    fn default() -> Self {
        Self { spacing: Duration::from_millis(10), timeout: Duration::from_secs(1) }
    }
}

/// Progress of a download.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// parameters that answered, or that the vehicle does not have
    pub settled: usize,
    /// parameters asked for
    pub total: usize,
}

/// One parameter.
#[derive(Debug)]
struct Item {
    names: Vec<Name>,
    value: Option<(usize, f64)>,
    tries: u32,
    asked: Option<Duration>,
}

#[derive(Debug)]
struct Name {
    text: String,
    absent: bool,
}

impl Item {
    fn is_known(&self) -> bool {
        self.value.is_some() || self.names.iter().all(|name| name.absent)
    }
}

/// The download of one vehicle's parameters. Repeat: call [`Self::poll`] until it gives nothing, and pass on the
/// decoder's events ([`Self::take`]) and each frame ([`Self::take_frame`]).
#[derive(Debug)]
pub struct Download {
    vehicle: Vehicle,
    settings: DownloadSettings,
    items: Vec<Item>,
    /// item and name of it by every name
    by_name: BTreeMap<String, (usize, usize)>,
    /// requests of the current try of an item that are still to be sent
    pending: Vec<(usize, usize)>,
    last_sent: Option<Duration>,
}

impl Download {
    /// A download of these parameters.
    #[must_use]
    pub fn new(vehicle: Vehicle, wanted: Vec<RequestedParameter>, settings: DownloadSettings) -> Self {
        let items: Vec<Item> = wanted
            .into_iter()
            .map(|wanted| Item {
                names: wanted.names.into_iter().map(|text| Name { text, absent: false }).collect(),
                value: None,
                tries: 0,
                asked: None,
            })
            .collect();
        let by_name = items
            .iter()
            .enumerate()
            .flat_map(|(item, entry)| {
                entry.names.iter().enumerate().map(move |(name, entry)| (entry.text.clone(), (item, name)))
            })
            .collect();
        Self { vehicle, settings, items, by_name, pending: Vec::new(), last_sent: None }
    }

    /// The next request that is due, if any.
    pub fn poll(&mut self, now: Duration) -> Option<MavMessage> {
        if self.last_sent.is_some_and(|sent| now < sent + self.settings.spacing) {
            return None;
        }
        let (item, name) = self.next_request(now)?;
        self.last_sent = Some(now);
        // what is no parameter's name, or a vehicle that no message can name, is not asked and stays unanswered
        let name = ParameterName::new(&self.items[item].names[name].text).ok()?;
        Some(Target::of(&self.vehicle)?.parameter_request(&name))
    }

    /// When the next request may become due; `None` when done.
    #[must_use]
    pub fn next_due(&self) -> Option<Duration> {
        if self.is_done_after(Duration::MAX) {
            return None;
        }
        let spaced = self.last_sent.map_or(Duration::ZERO, |sent| sent + self.settings.spacing);
        let waiting = |item: &Item| item.asked.map_or(Duration::ZERO, |asked| asked + self.settings.timeout);
        let first = self.items.iter().filter(|item| !item.is_known()).map(waiting).min()?;
        Some(if self.pending.is_empty() { spaced.max(first) } else { spaced })
    }

    /// Takes an event of the decoder.
    pub fn take(&mut self, event: &Event<'_>) {
        if let Event::Parameter { name, value } = event
            && let Some(&(item, name)) = self.by_name.get(*name)
        {
            self.items[item].value = Some((name, *value));
        }
    }

    /// Takes a frame: newer autopilots report parameters that they do not have.
    pub fn take_frame(&mut self, frame: &Frame<'_>) {
        let payload = frame.payload();
        if !is_from(&self.vehicle, frame)
            || frame.header().message_id != PARAM_ERROR
            || payload.u8(20) != DOES_NOT_EXIST
        {
            return;
        }
        if let Some(&(item, name)) = self.by_name.get(&payload.text(4, 16)) {
            self.items[item].names[name].absent = true;
        }
    }

    /// Its progress.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let settled = self.items.iter().filter(|item| item.is_known()).count();
        Progress { settled, total: self.items.len() }
    }

    /// Whether nothing is left to request or to wait for.
    #[must_use]
    pub fn is_done(&self, now: Duration) -> bool {
        self.pending.is_empty() && self.is_done_after(now)
    }

    /// The received parameters.
    #[must_use]
    pub fn finish(self) -> Parameters {
        let mut out = Parameters { autopilot: self.vehicle.autopilot, ..Parameters::default() };
        for item in self.items {
            match item.value {
                Some((name, value)) => {
                    out.values.extend(item.names.into_iter().nth(name).map(|name| (name.text, value)));
                }
                None if item.names.iter().all(|name| name.absent) => {
                    out.absent.extend(item.names.into_iter().map(|name| name.text));
                }
                None => out.unanswered.extend(item.names.into_iter().take(1).map(|name| name.text)),
            }
        }
        out
    }

    fn next_request(&mut self, now: Duration) -> Option<(usize, usize)> {
        while let Some((item, name)) = self.pending.pop() {
            if !self.items[item].is_known() && !self.items[item].names[name].absent {
                return Some((item, name));
            }
        }
        let limit = self.tries_limit();
        let timeout = self.settings.timeout;
        let due = |item: &Item| {
            !item.is_known() && item.tries < limit && item.asked.is_none_or(|asked| now >= asked + timeout)
        };
        // the one that was asked least: every parameter gets its first chance before any gets its second
        let (index, item) =
            self.items.iter_mut().enumerate().filter(|(_, item)| due(item)).min_by_key(|(_, i)| i.tries)?;
        item.tries += 1;
        item.asked = Some(now);
        self.pending = (0..item.names.len()).rev().map(|name| (index, name)).collect();
        let first = self.pending.pop().filter(|(_, name)| !item.names[*name].absent);
        first.or_else(|| self.pending.pop())
    }

    /// Largest number of requests, by the losses so far: on a bad link, silence proves little.
    fn tries_limit(&self) -> u32 {
        let answered = self.items.iter().filter(|item| item.value.is_some());
        let (tries, count) = answered.fold((0, 0_u32), |(t, n), item| (t + item.tries, n + 1));
        if count == 0 {
            return TRIES.1;
        }
        let lost = f64::from(tries.saturating_sub(count)) / f64::from(tries.max(1));
        let mut limit = TRIES.0;
        while limit < TRIES.1 && lost.powi(i32::try_from(limit).unwrap_or(i32::MAX)) > GIVEN_UP {
            limit += 1;
        }
        limit
    }

    fn is_done_after(&self, now: Duration) -> bool {
        let limit = self.tries_limit();
        let timed_out =
            |item: &Item| item.asked.is_some_and(|asked| now.saturating_sub(asked) >= self.settings.timeout);
        self.items.iter().all(|item| item.is_known() || item.tries >= limit && timed_out(item))
    }
}
