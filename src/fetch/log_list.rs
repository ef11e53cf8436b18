//! The logs of a vehicle by LOG_REQUEST_LIST.

use std::collections::BTreeMap;
use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::asked::Asked;
use super::pace::Pace;
use super::peer::Peer;
use super::remote::{Place, RemoteLog};
use super::{Dialogue, FetchError};
use crate::wire::Frame;

/// Logs of a vehicle, at most.
const MOST: u16 = 8192;

/// Lists the logs.
#[derive(Debug)]
pub(super) struct LogList {
    peer: Peer,
    pace: Pace,
    asked: Asked,
    /// when an entry came last
    heard: Option<Duration>,
    /// first and last number, once told
    range: Option<(u16, u16)>,
    /// numbers begin one below what the vehicle tells of the last one: PX4 counts from 0 and tells the number of logs
    one_below: bool,
    found: BTreeMap<u16, (u32, u32)>,
    is_empty: bool,
}

impl LogList {
    pub(super) fn new(peer: Peer) -> Self {
        let (pace, asked, found) = (Pace::default(), Asked::default(), BTreeMap::new());
        Self { peer, pace, asked, heard: None, range: None, one_below: false, found, is_empty: false }
    }

    /// The first run of entries that are missing.
    fn missing(&self) -> Option<(u16, u16)> {
        let Some((first, last)) = self.range else { return Some((0, u16::MAX)) };
        let from = (first..=last).find(|id| !self.found.contains_key(id))?;
        let to = (from..=last).take_while(|id| !self.found.contains_key(id)).last()?;
        Some((from, to))
    }

    pub(super) fn logs(&self) -> Vec<RemoteLog> {
        let log = |(id, (size, time_s)): (&u16, &(u32, u32))| RemoteLog {
            id: Some((*id).into()),
            place: Place::Number(*id),
            size: u64::from(*size),
            time_s: Some(*time_s).filter(|time_s| *time_s > 0),
        };
        self.found.iter().map(log).collect()
    }
}

impl Dialogue for LogList {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if self.is_done() {
            return Ok(None);
        }
        let is_silent = self.heard.is_none_or(|heard| now.saturating_sub(heard) >= self.pace.silence(0));
        if !is_silent || !self.asked.is_due(now, &self.pace) {
            return Ok(None);
        }
        let Some((from, to)) = self.missing() else { return Ok(None) };
        self.asked.send(now, "the list of logs")?;
        Ok(Some(self.peer.request_list(from, to)))
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        let Some(entry) = self.peer.heard_entry(frame) else { return };
        match self.heard.replace(now) {
            Some(before) => self.pace.spaced(now.saturating_sub(before)),
            None => self.asked.answered(now, &mut self.pace),
        }
        if entry.count == 0 {
            self.is_empty = true;
            return;
        }
        let count = entry.count.min(MOST);
        let told = (entry.last.saturating_sub(count - 1), entry.last);
        if !self.one_below && told.0.checked_sub(1) == Some(entry.id) {
            (self.one_below, self.range) = (true, None);
        }
        let below = u16::from(self.one_below);
        let range = (told.0.saturating_sub(below), told.1.saturating_sub(below));
        if *self.range.get_or_insert(range) == range
            && (range.0..=range.1).contains(&entry.id)
            && self.found.insert(entry.id, (entry.size, entry.time_s)).is_none()
        {
            // something new: the tries begin again
            self.asked = Asked::default();
        }
    }

    fn is_done(&self) -> bool {
        self.is_empty || self.missing().is_none()
    }
}
