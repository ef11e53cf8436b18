//! Requests by SET_MESSAGE_INTERVAL, one after the other, then a measurement of the rates that arrive.

use super::report::{RatesReport, StreamReport};
use super::{Answer, Capacity, StreamRequest};
use crate::fly::address::is_from;
use crate::fly::target::{MessageId, Order, OutOfRange, Period, Target};
use crate::wire::command::{ACCEPTED, IN_PROGRESS, SET_MESSAGE_INTERVAL, TEMPORARILY_REJECTED};
use crate::wire::message_id::{
    ACTUATOR_OUTPUT_STATUS, COMMAND_ACK, ESC_STATUS, ESC_TELEMETRY_1_TO_4, SERVO_OUTPUT_RAW,
};
use crate::wire::{Frame, Vehicle};
use mavlink::dialects::ardupilotmega::MavMessage;
use std::time::Duration;

/// A refused rate above this is requested once more at half of it, Hz. Half of less than 50 Hz is too slow for what
/// is asked for.
const WORTH_HALVING_HZ: f64 = 50.0;

/// Timing of the requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RequestSettings {
    /// until a request counts as lost
    pub timeout: Duration,
    /// requests of one message
    pub tries: u32,
    /// time until streams have their new rates
    pub settling_time: Duration,
    /// time over which arrivals are counted
    pub window: Duration,
    /// the ground station's system and component: acknowledgements for others are not ours
    pub own: (u8, u8),
}

impl Default for RequestSettings {
    fn default() -> Self {
        Self {
            timeout: Duration::from_millis(1500),
            tries: 6,
            settling_time: Duration::from_millis(500),
            window: Duration::from_secs(4),
            own: (255, 190),
        }
    }
}

/// One message of the set.
#[derive(Debug)]
struct Asked {
    request: StreamRequest,
    answer: Answer,
    rate_hz: f64,
    tries: u32,
    halved: bool,
    count: u32,
    /// frames with values other than zero
    telling: u32,
}

/// Ranges of the values of actuator messages in their payloads; the rest are time stamps and indices.
const VALUES: [(u32, std::ops::Range<usize>); 4] = [
    (SERVO_OUTPUT_RAW, 4..20),
    (ESC_STATUS, 8..56),
    (ACTUATOR_OUTPUT_STATUS, 12..140),
    (ESC_TELEMETRY_1_TO_4, 0..44),
];

/// Whether a message of actuators has only zeros: no outputs or sensors are behind it.
fn is_blank(id: u32, frame: &Frame<'_>) -> bool {
    let values = VALUES.into_iter().find(|(of, _)| *of == id).map(|(_, values)| values);
    values.is_some_and(|mut values| values.all(|at| frame.payload().u8(at) == 0))
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Asking { index: usize, sent: Option<Duration> },
    Settling { until: Duration },
    Measuring { since: Duration, until: Duration },
    Done,
}

/// Requests a set of messages from a vehicle. Repeat until [`Self::is_done`]: call [`Self::poll`] until it gives
/// nothing, and pass on each frame.
#[derive(Debug)]
pub struct Requests {
    vehicle: Vehicle,
    capacity: Capacity,
    settings: RequestSettings,
    streams: Vec<Asked>,
    phase: Phase,
    bytes: f64,
    window_s: f64,
}

impl Requests {
    /// Requests of a set over a link.
    #[must_use]
    pub fn new(
        vehicle: Vehicle,
        set: Vec<StreamRequest>,
        capacity: Capacity,
        settings: RequestSettings,
    ) -> Self {
        let streams = set
            .into_iter()
            .map(|request| Asked {
                request,
                answer: Answer::NotAsked,
                rate_hz: request.rate_hz,
                tries: 0,
                halved: false,
                count: 0,
                telling: 0,
            })
            .collect();
        let phase = Phase::Asking { index: 0, sent: None };
        Self { vehicle, capacity, settings, streams, phase, bytes: 0.0, window_s: 0.0 }
    }

    /// The next request that is due, if any; moves on with the clock.
    pub fn poll(&mut self, now: Duration) -> Option<MavMessage> {
        loop {
            match self.phase {
                Phase::Asking { index, sent } => {
                    if index >= self.streams.len() {
                        self.phase = Phase::Settling { until: now + self.settings.settling_time };
                    } else if !self.is_wanted(index) {
                        self.phase = Phase::Asking { index: index + 1, sent: None };
                    } else if sent.is_some_and(|sent| now < sent + self.settings.timeout) {
                        return None;
                    } else if self.streams[index].tries >= self.settings.tries {
                        self.streams[index].answer = Answer::Silent;
                    } else if let Some(message) = self.message(index) {
                        self.streams[index].tries += 1;
                        self.phase = Phase::Asking { index, sent: Some(now) };
                        return Some(message);
                    } else {
                        self.streams[index].answer = Answer::OutOfRange;
                    }
                }
                Phase::Settling { until } if now >= until => {
                    self.bytes = 0.0;
                    self.streams.iter_mut().for_each(|stream| (stream.count, stream.telling) = (0, 0));
                    self.phase = Phase::Measuring { since: now, until: now + self.settings.window };
                }
                Phase::Measuring { since, until } if now >= until => {
                    self.window_s = (now - since).as_secs_f64();
                    self.phase = match self.first_replacement() {
                        Some(index) => Phase::Asking { index, sent: None },
                        None => Phase::Done,
                    };
                }
                Phase::Settling { .. } | Phase::Measuring { .. } | Phase::Done => return None,
            }
        }
    }

    /// When [`Self::poll`] has something to do again; `None` when done.
    #[must_use]
    pub fn next_due(&self) -> Option<Duration> {
        match self.phase {
            Phase::Asking { sent, .. } => {
                Some(sent.map_or(Duration::ZERO, |sent| sent + self.settings.timeout))
            }
            Phase::Settling { until } | Phase::Measuring { until, .. } => Some(until),
            Phase::Done => None,
        }
    }

    /// Takes a frame that arrived.
    pub fn take_frame(&mut self, frame: &Frame<'_>) {
        if !is_from(&self.vehicle, frame) {
            return;
        }
        self.bytes += frame.bytes().len() as f64;
        let id = frame.header().message_id;
        if let Some(stream) = self.streams.iter_mut().find(|stream| stream.request.message_id == id) {
            stream.count += 1;
            stream.telling += u32::from(!is_blank(id, frame));
        }
        if id == COMMAND_ACK {
            self.acknowledged(frame);
        }
    }

    /// Whether the window is over and nothing is left to request.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.phase == Phase::Done
    }

    /// Starts a new measurement of the rates, from now on.
    pub fn measure_again(&mut self, now: Duration) {
        self.phase = Phase::Settling { until: now + self.settings.settling_time };
    }

    /// Messages answered and asked for.
    #[must_use]
    pub fn progress(&self) -> (usize, usize) {
        let settled = self.streams.iter().filter(|stream| stream.answer != Answer::NotAsked).count();
        (settled, self.streams.len())
    }

    /// Report of the rates, and whether they are sufficient.
    #[must_use]
    pub fn report(&self) -> RatesReport {
        let window_s = if self.window_s > 0.0 { self.window_s } else { f64::NAN };
        let streams = self.streams.iter().map(|stream| StreamReport {
            request: StreamRequest { rate_hz: stream.rate_hz, ..stream.request },
            answer: stream.answer,
            arrived_hz: f64::from(stream.count) / window_s,
            blank: stream.count > 0 && stream.telling == 0,
        });
        RatesReport::new(streams.collect(), self.vehicle.autopilot, self.capacity, self.bytes / window_s)
    }

    fn acknowledged(&mut self, frame: &Frame<'_>) {
        let payload = frame.payload();
        let (for_system, for_component) = (payload.u8(8), payload.u8(9));
        let (own_system, own_component) = self.settings.own;
        let for_others = for_system != 0 && for_system != own_system
            || for_component != 0 && for_component != own_component;
        let Phase::Asking { index, sent: Some(_) } = self.phase else { return };
        if payload.u16(0) != SET_MESSAGE_INTERVAL || for_others {
            return;
        }
        let stream = &mut self.streams[index];
        match payload.u8(2) {
            ACCEPTED => stream.answer = Answer::Accepted,
            // to be asked again after the time-out
            TEMPORARILY_REJECTED | IN_PROGRESS => return,
            _ if !stream.halved && stream.rate_hz > WORTH_HALVING_HZ => {
                stream.halved = true;
                stream.rate_hz /= 2.0;
                stream.tries = 0;
            }
            result => {
                stream.rate_hz = stream.request.rate_hz;
                stream.answer = Answer::Refused(result);
            }
        }
        self.phase = Phase::Asking { index, sent: None };
    }

    /// Whether a request is not answered yet and is not a replacement of a message that arrives.
    fn is_wanted(&self, index: usize) -> bool {
        let stream = &self.streams[index];
        stream.answer == Answer::NotAsked
            && stream.request.instead_of.is_none_or(|id| {
                let replaced = self.streams.iter().find(|other| other.request.message_id == id);
                replaced.is_none_or(|replaced| self.is_missing(replaced))
            })
    }

    /// Whether a message was refused or does not arrive; before the first window, accepted ones do not count as
    /// missing.
    fn is_missing(&self, stream: &Asked) -> bool {
        match stream.answer {
            Answer::Refused(_) | Answer::Silent | Answer::OutOfRange => true,
            Answer::Accepted => self.window_s > 0.0 && stream.count == 0,
            Answer::NotAsked => false,
        }
    }

    /// The first replacement that was not requested for an accepted message that did not arrive.
    fn first_replacement(&self) -> Option<usize> {
        (0..self.streams.len()).find(|index| self.is_wanted(*index))
    }

    fn message(&self, index: usize) -> Option<MavMessage> {
        let stream = &self.streams[index];
        let order = order(stream.request.message_id, stream.rate_hz).ok()?;
        Some(Target::of(&self.vehicle)?.command(&order, 0))
    }
}

fn order(message_id: u32, rate_hz: f64) -> Result<Order, OutOfRange> {
    Ok(Order::interval(MessageId::new(message_id)?, Period::of_rate(rate_hz)?))
}
