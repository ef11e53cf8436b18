//! Gives out what messages hold.

use super::topics::Topic;
use super::values::Values;
use crate::log::format::{Place, Sink};
use crate::recording::{Event, Quantity, StreamKey};

/// Gives pieces of a flight to a sink.
pub(super) struct Outlet<'a, 'b> {
    sink: &'a mut Sink<'b>,
    place: Place,
}

impl<'a, 'b> Outlet<'a, 'b> {
    pub(super) fn new(sink: &'a mut Sink<'b>) -> Self {
        Self { sink, place: Place::default() }
    }

    /// What follows is of the message at this byte.
    pub(super) fn at(&mut self, offset: u64) {
        self.place.offset = offset;
    }

    pub(super) fn give(&mut self, event: Event<'_>) {
        (self.sink)(self.place, event);
    }

    /// One sample, unless no value in it is finite.
    pub(super) fn sample(
        &mut self,
        quantity: Quantity,
        source: &'static str,
        instance: u8,
        time_s: f64,
        values: &[f64],
    ) {
        if values.iter().any(|value| value.is_finite()) {
            let stream = StreamKey { quantity, source, instance };
            self.give(Event::Sample { stream, time_s, values });
        }
    }

    /// One sample of a topic.
    pub(super) fn values(&mut self, topic: &Topic, instance: u8, time_s: f64, values: &Values) {
        self.sample(topic.quantity, topic.source, instance, time_s, values.get());
    }
}
