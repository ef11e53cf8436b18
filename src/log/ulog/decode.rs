//! From messages to events.

use super::clock::{Clock, Placed};
use super::message::Message;
use super::resets::ResetCounters;
use super::schema::{Cell, Subscription};
use super::topics::{Bound, streams_of};
use crate::autopilot::Autopilot;
use crate::log::date::Date;
use crate::log::flights::is_state;
use crate::log::leap::{Leap, LeapCause};
use crate::recording::Event;
use crate::text;
use crate::units::seconds_from_us;

/// `sys_name` of PX4, and a parameter that it alone has.
const PX4: (&str, &str) = ("PX4", "SYS_AUTOSTART");
/// Field of a satellite receiver's time.
const UTC: &str = "time_utc_usec";
/// Beginnings of the names of a simulator's own parameters, which hold its truth.
const TRUTH: [&str; 2] = ["SIM_", "SIH_"];

fn is_truth(name: &str) -> bool {
    TRUTH.iter().any(|beginning| name.starts_with(beginning))
}

/// Which stream of which topic goes to each place of a recording.
pub(super) type Places = Vec<Option<(usize, usize)>>;

/// Turns messages into events.
#[derive(Debug, Default)]
pub(super) struct Decoder {
    pub(super) clock: Clock,
    pub(super) date: Date,
    /// by number; none where nothing is read of it
    pub(super) topics: Vec<Option<Topic>>,
    /// of each number
    pub(super) streams: Vec<Vec<Bound>>,
    /// a stamp leapt: messages wait until it is known what that was
    pub(super) leap: Option<Leap<Waiting>>,
    /// of a log that is read whole; empty until they are known
    pub(super) places: Places,
    /// said before the first sample
    autopilot: Option<Autopilot>,
    is_reported: bool,
    report: DecodeReport,
}

/// A topic whose messages hold streams.
#[derive(Debug)]
pub(super) struct Topic {
    pub(super) resets: ResetCounters,
    /// a satellite receiver's time, microseconds since 1970 UTC
    pub(super) utc: Option<Cell>,
    pub(super) last_us: Option<u64>,
    behind: Option<Behind>,
    /// no other topic has streams of the same key
    pub(super) is_alone: bool,
}

/// Stamps in a row that are far behind a topic's last one.
#[derive(Debug, Clone, Copy)]
struct Behind {
    last_us: u64,
    stamp_us: u64,
    count: u8,
}

/// So many in a row that agree with each other: damage put the last one ahead, or the topic would be lost until then.
const BEHIND: u8 = 3;
/// They follow one another within this.
const FOLLOWS_US: u64 = 2_000_000;

impl Topic {
    /// Takes a stamp that does not go on from the topic's last one; `true` where that was damaged.
    fn was_ahead(&mut self, stamp_us: u64) -> bool {
        let Some(last_us) = self.last_us.filter(|last_us| stamp_us < *last_us) else { return false };
        let follows = |behind: &Behind| {
            behind.last_us == last_us
                && (behind.stamp_us..=behind.stamp_us.saturating_add(FOLLOWS_US)).contains(&stamp_us)
        };
        let count = self.behind.filter(follows).map_or(1, |behind| behind.count + 1);
        self.behind = Some(Behind { last_us, stamp_us, count });
        count >= BEHIND
    }
}

/// A message of a topic that waits.
#[derive(Debug)]
pub(super) struct Waiting {
    slot: usize,
    stamp_us: u64,
    bytes: Vec<u8>,
}

/// What became of the messages.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct DecodeReport {
    /// messages of topics that are read whose stamps fit no clock
    pub(super) stale_stamps: u64,
    /// times that stamps ran back for good, and the furthest of these, microseconds
    pub(super) ran_back: (u64, u64),
    /// parameters of a simulator's truth: counted, never read
    pub(super) withheld_truth: u64,
}

impl Decoder {
    /// What became of the messages so far.
    pub(super) fn report(&self) -> &DecodeReport {
        &self.report
    }

    /// Gives what a message says to `sink`.
    pub(super) fn decode(&mut self, message: Message<'_>, sink: &mut dyn FnMut(Event<'_>)) {
        match message {
            Message::Data { subscription, bytes } => self.data(subscription, bytes, sink),
            Message::Begin { start_us } => {
                self.finish(sink);
                self.topics.clear();
                self.streams.clear();
                self.places.clear();
                if self.clock.begin(start_us) {
                    self.restarted(start_us, sink);
                }
            }
            Message::Info { key, value, .. } => self.info(key, value),
            Message::Parameter { name, value } => self.parameter(name, value, sink),
            Message::Subscribe(subscription) => {
                self.tell_autopilot(sink);
                self.finish(sink);
                self.subscribe(subscription);
            }
            Message::Text { severity, stamp_us, text } => {
                let time_s = self.clock.seconds(stamp_us);
                let text = text::clean(String::from_utf8_lossy(text).trim_end());
                sink(Event::Text { time_s, severity, text: &text });
            }
            Message::ParameterDefault { name, value } => {
                if !is_truth(name) {
                    sink(Event::ParameterDefault { name, value });
                }
            }
            Message::Dropout { .. } | Message::Other { .. } => {}
        }
    }

    fn info(&mut self, key: &str, value: &[u8]) {
        if key == "sys_name" {
            let is_px4 = value == PX4.0.as_bytes();
            self.autopilot = Some(if is_px4 { Autopilot::Px4 } else { Autopilot::Other });
        }
    }

    fn parameter(&mut self, name: &str, value: f64, sink: &mut dyn FnMut(Event<'_>)) {
        if is_truth(name) {
            self.report.withheld_truth += 1;
            return;
        }
        if name == PX4.1 {
            self.autopilot.get_or_insert(Autopilot::Px4);
        }
        sink(Event::Parameter { name, value });
    }

    fn tell_autopilot(&mut self, sink: &mut dyn FnMut(Event<'_>)) {
        if !std::mem::replace(&mut self.is_reported, true) {
            sink(Event::Autopilot(self.autopilot.unwrap_or_default()));
        }
    }

    fn subscribe(&mut self, subscription: &Subscription) {
        let slot = usize::from(subscription.id);
        if slot >= self.topics.len() {
            self.topics.resize_with(slot + 1, || None);
            self.streams.resize_with(slot + 1, Vec::new);
        }
        self.streams[slot] = streams_of(subscription);
        let resets = ResetCounters::of(subscription);
        let utc = subscription.layout.cell(UTC);
        let topic = Topic { resets, utc, last_us: None, behind: None, is_alone: false };
        self.topics[slot] = (!self.streams[slot].is_empty()).then_some(topic);
        self.places.clear();
    }

    fn data(&mut self, subscription: &Subscription, bytes: &[u8], sink: &mut dyn FnMut(Event<'_>)) {
        if let Some(stamp_us) = subscription.layout.stamp_us(bytes) {
            self.dated(subscription.id.into(), stamp_us, bytes, sink);
        }
    }

    /// A message of a topic with its stamp.
    fn dated(&mut self, slot: usize, stamp_us: u64, bytes: &[u8], sink: &mut dyn FnMut(Event<'_>)) {
        let Some(topic) = self.topics.get_mut(slot).and_then(Option::as_mut) else { return };
        let stamp_s = seconds_from_us(stamp_us as f64);
        let waiting = || Waiting { slot, stamp_us, bytes: bytes.to_vec() };
        if let Some(leap) = &mut self.leap {
            if leap.wait(Some(stamp_s), waiting()) {
                self.resolve(sink);
            }
            return;
        }
        match self.clock.place(stamp_us, topic.last_us) {
            Placed::At => topic.last_us = Some(stamp_us),
            Placed::Restarted => {
                self.report.ran_back = (self.clock.ran_back, self.clock.ran_back_most_us);
                self.restarted(stamp_us, sink);
            }
            Placed::Stale if topic.was_ahead(stamp_us) => topic.last_us = Some(stamp_us),
            Placed::Stale => {
                self.report.stale_stamps += 1;
                return;
            }
            Placed::Leaps => {
                self.leap = Some(Leap::new(self.clock.last_s(), stamp_s, waiting()));
                return;
            }
        }
        self.samples(slot, stamp_us, bytes, sink);
    }

    /// No message waits any longer: the log, or what its numbers mean, ends here.
    pub(super) fn finish(&mut self, sink: &mut dyn FnMut(Event<'_>)) {
        while self.leap.is_some() {
            self.resolve(sink);
        }
    }

    fn resolve(&mut self, sink: &mut dyn FnMut(Event<'_>)) {
        let messages = match self.leap.take().map(Leap::resolve) {
            Some(LeapCause::Passed(messages)) => {
                messages.first().into_iter().for_each(|first| self.clock.leap(first.stamp_us));
                messages
            }
            Some(LeapCause::Damage(damaged, others)) => {
                self.report.stale_stamps += damaged as u64;
                others
            }
            None => Vec::new(),
        };
        for Waiting { slot, stamp_us, bytes } in messages {
            self.dated(slot, stamp_us, &bytes, sink);
        }
    }

    fn samples(&mut self, slot: usize, stamp_us: u64, bytes: &[u8], sink: &mut dyn FnMut(Event<'_>)) {
        let Some(topic) = self.topics.get_mut(slot).and_then(Option::as_mut) else { return };
        if topic.resets.jumped(bytes) {
            sink(Event::EstimatorReset { time_s: self.clock.seconds(stamp_us) });
        }
        if let Some(utc) = topic.utc.filter(|_| !self.date.is_known()) {
            self.date.utc_us(utc.read(bytes), self.clock.seconds(stamp_us));
        }
        for bound in &self.streams[slot] {
            let Some(time_s) = time_s(&self.clock, bound, bytes, stamp_us) else { continue };
            let stream = bound.key();
            bound.sample(bytes, |values| sink(Event::Sample { stream, time_s, values }));
        }
    }

    /// No topic's last stamp says anything of the new clock.
    fn restarted(&mut self, stamp_us: u64, sink: &mut dyn FnMut(Event<'_>)) {
        for topic in self.topics.iter_mut().flatten() {
            topic.last_us = None;
            topic.resets.forget();
        }
        let time_s = self.clock.seconds(stamp_us);
        sink(Event::ClockReset { time_s, stamp_s: seconds_from_us(stamp_us as f64) });
    }
}

/// The time of a message's sample, s; `None` where it is not said.
#[inline]
pub(super) fn time_s(clock: &Clock, bound: &Bound, bytes: &[u8], stamp_us: u64) -> Option<f64> {
    let (stamp_us, shift_s) = bound.moment(bytes, stamp_us)?;
    let time_s = clock.seconds(stamp_us) + shift_s;
    // the log begins with the state at its beginning, whenever that was entered
    Some(if is_state(bound.key().quantity) { time_s.max(0.0) } else { time_s })
}
