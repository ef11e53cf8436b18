//! Reads the vehicle's fence: the mission protocol with mission type fence.

use crate::fence::FenceItem;
use crate::fly::address::is_from;
use crate::fly::target::Target;
use crate::frames::Geodetic;
use crate::wire::message_id::{MISSION_ACK, MISSION_COUNT, MISSION_ITEM_INT};
use crate::wire::{Frame, Payload, Vehicle};
use mavlink::dialects::ardupilotmega::MavMessage;
use std::time::Duration;

/// MAV_MISSION_TYPE_FENCE.
const TYPE_FENCE: u8 = 1;

/// Until a request counts as lost.
const TIMEOUT: Duration = Duration::from_millis(1000);
/// Requests for one item.
const TRIES: u32 = 8;

/// How a download ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FenceOutcome {
    /// the whole fence came; it may have no item
    Complete,
    /// the vehicle said that it has none to give, with its MAV_MISSION_RESULT
    Refused(u8),
    /// answers stopped after so many of so many items; `None` where not even their number came
    Incomplete {
        /// items that came
        came: usize,
        /// items that there are
        of: Option<u16>,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Counting,
    Reading(u16),
    /// all came; the vehicle is told so
    Thanking,
    Done,
}

/// The download of one vehicle's fence. Call [`Self::poll`] until it gives nothing, pass on each frame, and
/// again, until there is an outcome.
#[derive(Debug)]
pub struct FenceDownload {
    vehicle: Vehicle,
    phase: Phase,
    sent: Option<Duration>,
    tries: u32,
    items: Vec<FenceItem>,
    outcome: Option<FenceOutcome>,
}

impl FenceDownload {
    /// Nothing asked yet.
    #[must_use]
    pub fn new(vehicle: Vehicle) -> Self {
        Self { vehicle, phase: Phase::Counting, sent: None, tries: 0, items: Vec::new(), outcome: None }
    }

    /// The next message that is due, if any.
    pub fn poll(&mut self, now: Duration) -> Option<MavMessage> {
        let Some(target) = Target::of(&self.vehicle) else {
            // an id that messages have no room for: nobody can be asked
            self.end(FenceOutcome::Incomplete { came: 0, of: None });
            return None;
        };
        if self.phase == Phase::Thanking {
            self.end(FenceOutcome::Complete);
            return Some(target.fence_thanks());
        }
        if self.phase == Phase::Done || self.sent.is_some_and(|sent| now < sent + TIMEOUT) {
            return None;
        }
        if self.tries >= TRIES {
            let of = match self.phase {
                Phase::Reading(count) => Some(count),
                _ => None,
            };
            self.end(FenceOutcome::Incomplete { came: self.items.len(), of });
            return None;
        }
        self.tries += 1;
        self.sent = Some(now);
        Some(self.request(target))
    }

    /// When [`Self::poll`] has something to do again; `None` when done.
    #[must_use]
    pub fn next_due(&self) -> Option<Duration> {
        (self.phase != Phase::Done).then(|| self.sent.map_or(Duration::ZERO, |sent| sent + TIMEOUT))
    }

    /// Takes a frame that arrived.
    pub fn take_frame(&mut self, frame: &Frame<'_>) {
        if !is_from(&self.vehicle, frame) {
            return;
        }
        let payload = frame.payload();
        match (frame.header().message_id, self.phase) {
            (MISSION_COUNT, Phase::Counting) if payload.u8(4) == TYPE_FENCE => {
                let count = payload.u16(0);
                self.phase = if count == 0 { Phase::Thanking } else { Phase::Reading(count) };
                self.answered();
            }
            // an item that was asked for twice comes twice
            (MISSION_ITEM_INT, Phase::Reading(count))
                if payload.u8(37) == TYPE_FENCE && usize::from(payload.u16(28)) == self.items.len() =>
            {
                self.items.push(item(payload));
                self.answered();
                if self.items.len() == usize::from(count) {
                    self.phase = Phase::Thanking;
                }
            }
            (MISSION_ACK, Phase::Counting | Phase::Reading(_)) if payload.u8(3) == TYPE_FENCE => {
                self.end(FenceOutcome::Refused(payload.u8(2)));
            }
            _ => {}
        }
    }

    /// How it ended; `None` while it continues.
    #[must_use]
    pub fn outcome(&self) -> Option<&FenceOutcome> {
        self.outcome.as_ref()
    }

    /// The items that came, in their order.
    #[must_use]
    pub fn items(&self) -> &[FenceItem] {
        &self.items
    }

    fn answered(&mut self) {
        self.sent = None;
        self.tries = 0;
    }

    fn end(&mut self, outcome: FenceOutcome) {
        self.phase = Phase::Done;
        self.outcome = Some(outcome);
    }

    fn request(&self, target: Target) -> MavMessage {
        match self.phase {
            Phase::Reading(_) => {
                target.fence_item_request(u16::try_from(self.items.len()).unwrap_or(u16::MAX))
            }
            _ => target.fence_request(),
        }
    }
}

fn item(payload: Payload<'_>) -> FenceItem {
    let degrees = |offset: usize| 1e-7 * f64::from(payload.i32(offset));
    FenceItem {
        command: payload.u16(30),
        parameter: payload.f32(0),
        place: Geodetic { latitude_deg: degrees(16), longitude_deg: degrees(20) },
    }
}
