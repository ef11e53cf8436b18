//! From messages to events.

use super::clock::{Clock, Placed};
use super::message::Message;
use super::resets::ResetCounters;
use super::schema::Subscription;
use super::topics::{Bound, streams_of};
use crate::autopilot::Autopilot;
use crate::log::flights::is_state;
use crate::recording::Event;
use crate::text;

/// `sys_name` of PX4, and a parameter that it alone has.
const PX4: (&str, &str) = ("PX4", "SYS_AUTOSTART");
/// Beginnings of the names of a simulator's own parameters, which hold its truth.
const TRUTH: [&str; 2] = ["SIM_", "SIH_"];

fn is_truth(name: &str) -> bool {
    TRUTH.iter().any(|beginning| name.starts_with(beginning))
}

/// Turns messages into events.
#[derive(Debug, Default)]
pub(super) struct Decoder {
    clock: Clock,
    topics: Vec<Option<Topic>>,
    /// said before the first sample
    autopilot: Option<Autopilot>,
    told: bool,
    report: DecodeReport,
}

/// A topic whose messages hold streams.
#[derive(Debug)]
struct Topic {
    streams: Vec<Bound>,
    resets: ResetCounters,
    last_us: Option<u64>,
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
                self.topics.clear();
                if self.clock.begin(start_us) {
                    self.restarted(start_us, sink);
                }
            }
            Message::Info { key, value, .. } => self.info(key, value),
            Message::Parameter { name, value } => self.parameter(name, value, sink),
            Message::Subscribe(subscription) => {
                self.tell_autopilot(sink);
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
        if !std::mem::replace(&mut self.told, true) {
            sink(Event::Autopilot(self.autopilot.unwrap_or_default()));
        }
    }

    fn subscribe(&mut self, subscription: &Subscription) {
        let slot = usize::from(subscription.id);
        if slot >= self.topics.len() {
            self.topics.resize_with(slot + 1, || None);
        }
        let streams = streams_of(subscription);
        let resets = ResetCounters::of(subscription);
        self.topics[slot] = (!streams.is_empty()).then_some(Topic { streams, resets, last_us: None });
    }

    fn data(&mut self, subscription: &Subscription, bytes: &[u8], sink: &mut dyn FnMut(Event<'_>)) {
        let slot = usize::from(subscription.id);
        let Some(topic) = self.topics.get_mut(slot).and_then(Option::as_mut) else { return };
        let Some(stamp_us) = subscription.layout.stamp_us(bytes) else { return };
        match self.clock.place(stamp_us, topic.last_us) {
            Placed::At => topic.last_us = Some(stamp_us),
            Placed::Restarted => {
                self.report.ran_back = (self.clock.ran_back, self.clock.ran_back_most_us);
                self.restarted(stamp_us, sink);
            }
            Placed::Stale => {
                self.report.stale_stamps += 1;
                return;
            }
        }
        let Some(topic) = self.topics.get_mut(slot).and_then(Option::as_mut) else { return };
        if topic.resets.jumped(bytes) {
            sink(Event::EstimatorReset { time_s: self.clock.seconds(stamp_us) });
        }
        for bound in &topic.streams {
            let Some((stamp_us, shift_s)) = bound.moment(bytes, stamp_us) else { continue };
            let stream = bound.key();
            let mut time_s = self.clock.seconds(stamp_us) + shift_s;
            if is_state(stream.quantity) {
                // the log begins with the state at its beginning, whenever that was entered
                time_s = time_s.max(0.0);
            }
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
        sink(Event::ClockReset { time_s, stamp_s: crate::units::seconds_from_us(stamp_us as f64) });
    }
}
